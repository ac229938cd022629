//! The marks that a robot reports to the controllers of a lane: its tracks with own contacts.
//!
//! A track that this robot has only failed to detect is no mark: its looks there are part of its
//! coverage, where the blind share of its sensors counts.

use crate::io::agent_id::AgentId;
use crate::io::goal_id::GoalId;
use crate::io::work::lane::{Coverage, MARK_KINDS, Mark};
use crate::perception::beliefs::Beliefs;
use crate::perception::beliefs::items::kinds::KindModel;
use crate::perception::beliefs::items::track::Track;
use alloc::vec::Vec;
use base::geometry::Point;
use base::hashed::Hashed;

/// Maximum number of marks; controllers wait for those of further tracks, and declare nothing.
const MAX_MARKS: usize = 1024;

/// Log likelihood ratio of kinds that a track excludes, in nats.
const EXCLUDED: f32 = -50.0;

/// A mark is sent again when a log ratio has changed by this, in nats, its position by this part of its deviation, or
/// the expected number of further items by this, in hundredths.
const CHANGE_NATS: f32 = 0.25;
const CHANGE_DEVIATIONS: f64 = 0.5;
const CHANGE_HUNDREDTHS: u8 = 10;

/// The pose has an error of at least this part of the noise of a position reading: it changes slowly, so that all looks
/// at an item have the same one.
const MIN_POSE_ERROR: f64 = 0.5;

/// All marks of a robot.
#[derive(Debug, Clone, Default, Hashed)]
pub(super) struct LaneMarks {
    list: Vec<Reported>,
    /// Whether there were tracks beyond the maximum.
    is_full: bool,
    repeated: usize,
}

#[derive(Debug, Clone, Copy, Hashed)]
struct Reported {
    mark: Mark,
    /// How often all looks before the first contact missed a visible item there, in nats.
    missed_nats: f32,
    /// The same for all looks until its track ended; none while there is one.
    ended_nats: Option<f32>,
    /// The mark that was sent last.
    sent: Option<Mark>,
}

impl LaneMarks {
    /// Number of marks so far, including those that have not been sent.
    pub(super) fn count(&self) -> u32 {
        let count = u32::try_from(self.list.len()).unwrap_or(u32::MAX);
        count.saturating_add(self.is_full.into())
    }

    /// Updates the marks by the tracks of a robot; that of a track that no longer exists remains as it
    /// was, except for the looks since then. `missed_nats` are those of all of its looks at a
    /// place before this step.
    pub(super) fn update(
        &mut self,
        (beliefs, position_noise_m): (&Beliefs, f64),
        missed_nats: impl Fn(Point) -> f64,
    ) {
        let deviation_m = beliefs.pose().map_or(0.0, |pose| pose.deviation_m);
        let deviation_m = deviation_m.max(MIN_POSE_ERROR * position_noise_m);
        let kinds = beliefs.items.kinds.as_deref();
        for track in &beliefs.items.tracks {
            let Some(mut mark) = mark_of((track, kinds), beliefs.id, deviation_m) else {
                continue;
            };
            let known = self.list.iter().position(|known| known.mark.id == mark.id);
            if let Some(index) = known {
                mark.add_nats(-self.list[index].missed_nats);
                self.list[index].mark = mark;
                self.list[index].ended_nats = None;
            } else if self.list.len() < MAX_MARKS {
                #[expect(clippy::cast_possible_truncation, reason = "messages are short")]
                let missed_nats = missed_nats(track.at) as f32;
                mark.add_nats(-missed_nats);
                self.list.push(Reported {
                    mark,
                    missed_nats,
                    ended_nats: None,
                    sent: None,
                });
            } else {
                self.is_full = true;
            }
        }
        let tracks = beliefs.items.tracks.iter();
        let contacts = tracks.filter_map(|track| track.own_contact(beliefs.id));
        let tracked: Vec<u32> = contacts.map(|source| source.provenance.track_id).collect();
        for reported in &mut self.list {
            if !tracked.contains(&reported.mark.id.number) {
                reported.note_looks(&missed_nats);
            }
        }
    }

    /// The marks to be sent, at most a number, and whether each is new: new ones, then changed ones,
    /// then one again, as messages are lost.
    pub(super) fn due(&mut self, max: usize) -> Vec<(Mark, bool)> {
        let mut due: Vec<usize> = Vec::new();
        let new = |reported: &Reported| reported.sent.is_none();
        let changed = |reported: &Reported| reported.sent.is_some() && reported.has_changed();
        for is_due in [&new as &dyn Fn(&Reported) -> bool, &changed] {
            let numbered = self.list.iter().enumerate();
            due.extend(
                numbered
                    .filter(|(_, reported)| is_due(reported))
                    .map(|(index, _)| index),
            );
        }
        due.truncate(max.saturating_sub(1));
        if !self.list.is_empty() {
            self.repeated = (self.repeated + 1) % self.list.len();
            if !due.contains(&self.repeated) {
                due.push(self.repeated);
            }
        }
        let send = |index: usize| {
            let reported = &mut self.list[index];
            let is_new = reported.sent.replace(reported.mark).is_none();
            (reported.mark, is_new)
        };
        due.into_iter().map(send).collect()
    }
}

impl Reported {
    /// Takes the looks since its track ended: since something there has been destroyed.
    #[expect(clippy::cast_possible_truncation, reason = "messages are short")]
    fn note_looks(&mut self, missed_nats: impl Fn(Point) -> f64) {
        let nats = missed_nats(self.mark.at()) as f32;
        let ended_nats = *self.ended_nats.get_or_insert(nats);
        self.mark.missed_since = Coverage::steps((nats - ended_nats).into());
    }

    fn has_changed(&self) -> bool {
        let Some(sent) = self.sent else {
            return true;
        };
        let ratios = self.mark.log_ratios.into_iter().zip(sent.log_ratios);
        let moved = self.mark.at_m.into_iter().zip(sent.at_m);
        let max_m = CHANGE_DEVIATIONS * self.mark.deviation_m();
        let mut ratios = ratios.map(|(now, then)| (now - then).abs());
        let mut moved = moved.map(|(now, then)| (now - then).abs());
        let missed_nats = self.mark.missed_since_nats() - sent.missed_since_nats();
        let further = self.mark.further.abs_diff(sent.further);
        missed_nats > CHANGE_NATS.into()
            || further > CHANGE_HUNDREDTHS
            || ratios.any(|change| change > CHANGE_NATS)
            || moved.any(|change_m| f64::from(change_m) > max_m)
    }
}

impl Mark {
    fn add_nats(&mut self, nats: f32) {
        self.log_ratios = self.log_ratios.map(|ratio| ratio + nats);
    }
}

/// The mark of a track by own looks; `None` without an own contact.
#[expect(clippy::cast_possible_truncation, reason = "messages are short")]
fn mark_of(
    (track, kinds): (&Track, Option<&KindModel>),
    own: AgentId,
    pose_deviation_m: f64,
) -> Option<Mark> {
    let source = track.own_contact(own)?;
    let mut log_ratios = [EXCLUDED; MARK_KINDS];
    if let Some(kinds) = kinds {
        let mut of_track = track.visible_log_ratios(kinds);
        if let Some(group) = &track.group {
            group.with_several(kinds.shares(), &mut of_track);
        }
        let of_kinds = log_ratios.iter_mut().zip(of_track);
        of_kinds.for_each(|(mark, own)| *mark = (own as f32).max(EXCLUDED));
    } else {
        // Kinds are reported as they are.
        *log_ratios.get_mut(usize::from(track.kind))? = source.log_ratio as f32;
    }
    let variance_m2 = track.variance_m2 + pose_deviation_m * pose_deviation_m;
    Some(Mark {
        id: GoalId {
            issuer: own.into(),
            number: source.provenance.track_id,
        },
        at_m: [track.at.x as f32, track.at.y as f32],
        deviation_mm: Mark::millimetres(libm::sqrt(variance_m2)),
        log_ratios,
        missed_since: 0,
        further: Mark::hundredths(track.group.as_ref().map_or(0.0, |group| group.further())),
    })
}
