//! What looks show of an item beside one that has been detected.
//!
//! A contact that is near a track is taken for one of its item. A second item there shows only when both are detected in
//! one look, by a contact more than the track explains:
//!
//! ```text
//! probability that a look reveals a second item = p (1 - e + e q)
//! p   probability that a look detects it        e   probability that the track is of an item
//! q   probability that a look detects that item
//! ```
//!
//! Otherwise all looks at a detected item would count as a search for a second one, which they are not. Beside an item that
//! is to be cleared, q counts as 0: when it is destroyed, the tracks there end, and the place is searched anew.

use crate::io::body::{Detector, RobotId};
use crate::io::lane::Lane;
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
    let masks = tracks.filter_map(|track| {
        let mask = mask(track, beliefs.id, detector, pose)?;
        let exists = track.own_probability(beliefs.id);
        let again = if lane.is_hazard(track.kind.into()) {
            0.0
        } else {
            exists * detector.min_probability(pose.at.to(track.at).length())
        };
        Some(Mask {
            reveals: 1.0 - exists + again,
            ..mask
        })
    });
    masks.collect()
}

fn mask(track: &Track, own: RobotId, detector: &Detector, pose: &Pose) -> Option<Mask> {
    track.own_contact(own)?;
    let exists = track.own_probability(own);
    let range_m = pose.at.to(track.at).length();
    let lateral_m = range_m * pose.deviation_rad;
    let noise_m = detector.noise_m.max(MIN_DEVIATION_M);
    let squares = [lateral_m, pose.deviation_m, noise_m].map(|part_m| part_m * part_m);
    let variance_m2 = track.variance_m2 + squares.iter().sum::<f64>();
    let radius_m = WITHIN_DEVIATIONS * libm::sqrt(variance_m2);
    let is_near = exists >= MIN_EXISTS && range_m <= detector.range_m + radius_m;
    is_near.then(|| Mask {
        at: track.at,
        radius_m,
        reveals: 0.0,
    })
}
