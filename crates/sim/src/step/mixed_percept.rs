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
    virtual_percept: &mut Percept,
    external: &ExternalBody,
    kind: &Kind,
) {
    percept
        .observations
        .append(&mut virtual_percept.observations);
    percept.contacts.append(&mut virtual_percept.contacts);
    percept.neighbours.append(&mut virtual_percept.neighbours);
    take(&mut percept.motion, &mut virtual_percept.motion);
    take(&mut percept.battery, &mut virtual_percept.battery);
    take(&mut percept.touch, &mut virtual_percept.touch);
    let rings = virtual_percept.scans.len();
    percept.scans.resize_with(rings, Scan::default);
    let scans = percept.scans.iter_mut().zip(&mut virtual_percept.scans);
    for ((scan, measured), sensor) in scans.zip(kind.ring_sensors()) {
        let bit = 1 << sensor;
        if external.virtual_sensors & bit == 0 {
            continue;
        }
        if external.real_sensors & bit == 0 {
            std::mem::swap(scan, measured);
        } else {
            merge(scan, measured);
        }
    }
}

/// Takes the reading of a virtual sensor, if there is one.
fn take<T>(reading: &mut Option<T>, measured: &mut Option<T>) {
    if measured.is_some() {
        *reading = measured.take();
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
