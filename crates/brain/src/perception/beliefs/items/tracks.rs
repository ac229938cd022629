//! All tracks: association, replacement and bookkeeping.

use super::association::Contacts;
use super::kinds::KindModel;
use super::track::Track;
use super::track_set::{MAX_TRACKS, TrackSet};
use crate::io::agent_id::AgentId;
use alloc::sync::Arc;
use alloc::vec::Vec;
use base::geometry::Point;
use base::hashed::Hashed;

/// A report farther from a track than this, in standard deviations, is not of its item.
const GATE: f64 = 4.0;

/// All item tracks of a robot.
#[derive(Debug, Clone, Hashed)]
pub(crate) struct Items {
    /// Maximum number of tracks; the least likely one is replaced first.
    #[hashed(skip)]
    max_tracks: usize,
    /// Without it, contacts have the kind of the item.
    #[hashed(skip)]
    pub(crate) kinds: Option<Arc<KindModel>>,
    /// The kinds of items that are to be cleared, one bit for each, if a controller has named a lane.
    #[hashed(skip)]
    pub(crate) hazards: Option<u8>,
    pub(crate) tracks: Vec<Track>,
    pub(crate) last_track_id: u32,
    /// Index of the track that was repeated last.
    repeated: usize,
    /// Tracks with reports to be sent, and those with reports to be judged.
    pub(crate) unsent: TrackSet,
    pub(crate) unjudged: TrackSet,
    /// Scratch memory of one observation.
    #[hashed(skip)]
    pub(super) contacts: Contacts,
}

impl Items {
    /// No tracks, a maximum number of them, and what is known of uncertain kinds.
    pub(crate) fn new(max_tracks: u32, kinds: Option<KindModel>) -> Self {
        Self {
            max_tracks: usize::try_from(max_tracks)
                .unwrap_or(MAX_TRACKS)
                .min(MAX_TRACKS),
            kinds: kinds.map(Arc::new),
            hazards: None,
            tracks: Vec::new(),
            last_track_id: 0,
            repeated: 0,
            unsent: TrackSet::default(),
            unjudged: TrackSet::default(),
            contacts: Contacts::default(),
        }
    }

    /// Marks tracks for sending and judging.
    pub(crate) fn mark_changed(&mut self, tracks: &TrackSet) {
        self.unsent.extend(tracks);
        self.unjudged.extend(tracks);
    }

    /// The track that a report of a kind, or of any kind if kinds are uncertain, is rather of than of another item.
    pub(crate) fn track_of_report(
        &self,
        kind: u16,
        (at, variance_m2): (Point, f64),
        per_m2: f64,
    ) -> Option<usize> {
        let tracks = self.tracks.iter().enumerate();
        let same = tracks.filter(|(_, track)| self.kinds.is_some() || track.kind == kind);
        let near = same.filter_map(|(number, track)| {
            let square_m2 = track.at.to(at).length_squared();
            let max_m2 = GATE * GATE * (variance_m2 + track.variance_m2);
            let log_odds = track.prior_with_another(at, variance_m2, per_m2);
            (square_m2 <= max_m2 && log_odds < 0.0).then_some((log_odds, number))
        });
        let nearest = near.min_by(|one, other| one.0.total_cmp(&other.0));
        nearest.map(|(_, number)| number)
    }

    /// Adds a track, replacing the least likely one if there are too many; returns its index.
    pub(crate) fn add_track(&mut self, track: Track) -> usize {
        let index = self.replaceable(|_| true).unwrap_or(0);
        self.insert(track, index)
    }

    /// Like [`Items::add_track`] for an item that another robot reports: it does not replace own
    /// observations. Returns `None` if there is nothing else to replace.
    pub(crate) fn add_reported_track(&mut self, track: Track, own: AgentId) -> Option<usize> {
        let index = self.replaceable(|track| !track.is_observed_by(own))?;
        Some(self.insert(track, index))
    }

    /// Index of the least likely track for which a condition holds, or of the next one while there
    /// is space.
    fn replaceable(&self, condition: impl Fn(&Track) -> bool) -> Option<usize> {
        if self.tracks.len() < self.max_tracks {
            return Some(self.tracks.len());
        }
        let numbered = self.tracks.iter().enumerate();
        let tracks = numbered.filter(|(_, track)| condition(track));
        let log_odds = tracks.map(|(number, track)| (track.log_odds(), number));
        let lowest = log_odds.min_by(|one, other| one.0.total_cmp(&other.0));
        lowest.map(|(_, number)| number)
    }

    fn insert(&mut self, track: Track, index: usize) -> usize {
        if index < self.tracks.len() {
            self.tracks[index] = track;
        } else {
            self.tracks.push(track);
        }
        index
    }

    /// Forgets the tracks within a distance of a place: what was there is destroyed.
    pub(crate) fn forget(&mut self, at: Point, radius_m: f64) {
        let count = self.tracks.len();
        // Nothing is within a distance of a place that is no number.
        let is_there = |track: &Track| track.at.to(at).length() <= radius_m;
        self.tracks.retain(|track| !is_there(track));
        if self.tracks.len() < count {
            // Indices have changed.
            self.mark_changed(&TrackSet::first(self.max_tracks));
        }
    }

    /// Renumbers the robots, and drops the sources for which `keep` returns false.
    pub(crate) fn renumber(&mut self, keep: impl Fn(&mut AgentId) -> bool) {
        for track in &mut self.tracks {
            let mut kept = 0;
            for slot in 0..track.count {
                let mut source = track.sources[slot];
                if keep(&mut source.provenance.observer) && keep(&mut source.from) {
                    track.sources[kept] = source;
                    kept += 1;
                }
            }
            track.count = kept;
        }
        self.tracks.retain(|track| track.count > 0);
        self.mark_changed(&TrackSet::first(self.max_tracks));
    }

    /// Marks the next track for repetition, in turn: messages are lost, and robots may have come
    /// into range.
    pub(crate) fn repeat_next(&mut self) {
        self.repeated = (self.repeated + 1)
            .checked_rem(self.tracks.len())
            .unwrap_or(0);
        if let Some(track) = self.tracks.get_mut(self.repeated) {
            for source in &mut track.sources {
                source.sent_confidence = f32::NEG_INFINITY;
            }
            self.unsent.insert(self.repeated);
        }
    }
}
