//! Two tracks of one item: the belief in the less probable one ends.

use super::track::Track;
use super::track_set::TrackSet;
use super::tracks::Items;
use crate::io::agent_id::AgentId;

/// Two tracks are of one item if their distance is within this many standard deviations, and if it is within the larger
/// number and the less probable one is rather not an item.
const SAME: f64 = 2.0;
const SAME_AND_IMPROBABLE: f64 = 4.0;

/// A track with a lower probability needs no end.
const MIN_PROBABILITY: f64 = 0.01;

impl Items {
    /// Ends the belief in each of the changed tracks that is of the same item as a more probable one. The tracks stay: other
    /// robots learn of the end.
    pub(super) fn end_duplicates(&mut self, own: AgentId, changed: &TrackSet) {
        if self.hazards.is_some() {
            // The controllers of a lane weigh all marks.
            return;
        }
        let is_any_kind = self.kinds.is_some();
        for number in changed.iter() {
            let Some(track) = self.tracks.get(number) else {
                break;
            };
            let probability = track.own_probability(own);
            let is_same = |better: &Track| {
                better.own_probability(own) > probability
                    && (is_any_kind || better.kind == track.kind)
                    && track.is_beside(better, probability)
            };
            if probability > MIN_PROBABILITY && self.tracks.iter().any(is_same) {
                self.tracks[number].end(own);
            }
        }
    }
}

impl Track {
    /// Whether it is probably of the item of a more probable track, if it is of an item itself with a `probability`.
    pub(crate) fn is_beside(&self, better: &Self, probability: f64) -> bool {
        let within = if probability < 0.5 {
            SAME_AND_IMPROBABLE
        } else {
            SAME
        };
        let all_m2 = self.variance_m2 + better.variance_m2;
        self.at.to(better.at).length_squared() < within * within * all_m2
    }

    /// Forgets what own observations have shown.
    fn end(&mut self, own: AgentId) {
        self.evidence.fill(0.0);
        let mut sources = self.sources[..self.count].iter_mut();
        if let Some(source) = sources.find(|source| source.provenance.observer == own) {
            source.log_ratio = 0.0;
            source.is_contact = false;
        }
    }
}
