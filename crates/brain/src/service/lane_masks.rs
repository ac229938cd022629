//! What looks show of an item beside one that has been detected.
//!
//! A contact that is near a track is taken for one of its item. A second item there shows only when both are detected in
//! one observation, by a contact more than the track explains:
//!
//! ```text
//! probability that a second item is revealed = p (1 - e + e q)
//! p   probability that it is detected           e   probability that the track is of an item
//! q   probability that the item of the track is detected
//! ```
//!
//! Otherwise all looks at a detected item would count as a search for a second one, which they are not. Beside an item that
//! is to be cleared, q counts as 0: when it is destroyed, the tracks there end, and the place is searched again.

use crate::io::body::Detector;
use crate::io::work::lane::Lane;
use crate::perception::beliefs::Beliefs;
use crate::perception::beliefs::coverage_map::Mask;
use crate::perception::beliefs::items::track::{MIN_DEVIATION_M, Track};
use crate::perception::beliefs::pose::Pose;
use alloc::vec::Vec;

/// A contact within this many standard deviations of a track is taken for one of its item.
const WITHIN_DEVIATIONS: f64 = 4.0;

/// A track with a lower probability of an item takes no contact of another.
const MIN_EXISTS: f64 = 0.01;

/// The places of a look at which a second item would be taken for the item of a track.
pub(super) fn masks(lane: &Lane, beliefs: &Beliefs, detector: &Detector, pose: &Pose) -> Vec<Mask> {
    let tracks = beliefs.items.tracks.iter();
    let own = tracks.filter(|track| track.own_contact(beliefs.id).is_some());
    let masks = own.filter_map(|track| {
        let range_m = pose.at.to(track.at).length();
        let radius_m = WITHIN_DEVIATIONS * deviation_m(track, detector, pose);
        let exists = track.own_probability(beliefs.id);
        let again = if lane.is_hazard(track.kind.into()) {
            0.0
        } else {
            detector.min_probability(range_m)
        };
        let is_near = exists >= MIN_EXISTS && range_m <= detector.range_m + radius_m;
        is_near.then_some(Mask {
            at: track.at,
            radius_m,
            reveals: 1.0 - exists + exists * again,
        })
    });
    masks.collect()
}

/// Standard deviation of the distance of a contact from a track whose item it is of, along each axis.
fn deviation_m(track: &Track, detector: &Detector, pose: &Pose) -> f64 {
    let lateral_m = pose.at.to(track.at).length() * pose.deviation_rad;
    let noise_m = detector.noise_m.max(MIN_DEVIATION_M);
    let squares = [lateral_m, pose.deviation_m, noise_m].map(|part_m| part_m * part_m);
    libm::sqrt(track.variance_m2 + squares.iter().sum::<f64>())
}
