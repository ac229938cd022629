//! Percepts of external bodies: what was read outside of the simulation, and what virtual sensors measure.

use crate::bodies::external::ExternalBody;
use crate::bodies::kind::Kind;
use brain::{Percept, Scan};

/// What an external body perceived in a step.
#[derive(Debug, Clone)]
pub struct Perceived {
    /// What was read outside of the simulation.
    pub real: Percept,
    /// What its virtual sensors measured.
    pub measured: Percept,
    /// What its brain decided from: both, and the messages that it received.
    pub whole: Percept,
}

impl Perceived {
    /// Of a body whose brain did not step.
    pub(super) fn of(read: &Percept) -> Self {
        Self {
            real: read.clone(),
            measured: Percept::default(),
            whole: read.clone(),
        }
    }
}

/// Adds what the virtual sensors of a body measured to a percept from outside.
///
/// A reading from outside is never replaced: where both have one, the nearer range counts, as old as the
/// older of the two, and a scan that is missing outside stays missing. So nothing virtual makes an input
/// look fresh.
pub(super) fn add_virtual(
    percept: &mut Percept,
    measured: &Percept,
    external: &ExternalBody,
    kind: &Kind,
) {
    percept
        .observations
        .extend_from_slice(&measured.observations);
    percept.contacts.extend_from_slice(&measured.contacts);
    percept.neighbours.extend_from_slice(&measured.neighbours);
    percept.motion = measured.motion.or(percept.motion);
    percept.battery = measured.battery.or(percept.battery);
    percept.touch = measured.touch.or(percept.touch);
    let rings = measured.scans.len();
    percept.scans.resize_with(rings, Scan::default);
    let scans = percept.scans.iter_mut().zip(&measured.scans);
    for ((scan, measured), sensor) in scans.zip(kind.ring_sensors()) {
        let bit = 1 << sensor;
        if external.virtual_sensors & bit == 0 {
            continue;
        }
        if external.real_sensors & bit == 0 {
            scan.clone_from(measured);
        } else {
            merge(scan, measured);
        }
    }
}

/// Takes the nearer range of each ray.
fn merge(scan: &mut Scan, measured: &Scan) {
    let (Some(age_s), Some(other_s)) = (scan.age_s, measured.age_s) else {
        return;
    };
    scan.age_s = Some(f64::max(age_s, other_s));
    for (range_m, other_m) in scan.ranges_m.iter_mut().zip(&measured.ranges_m) {
        *range_m = range_m.min(*other_m);
    }
}
