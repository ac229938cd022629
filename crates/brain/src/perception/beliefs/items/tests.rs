use super::track::{Track, probability};
use super::*;
use crate::io::agent_id::AgentId;
use crate::io::body::Detector;
use crate::io::percept::Contact;
use crate::messaging::reports::Reception;
use crate::messaging::trust::Trust;
use crate::perception::beliefs::TrustSpec;
use crate::perception::beliefs::coverage_map::tests::detector;
use crate::perception::beliefs::map::Map;
use crate::perception::beliefs::pose::Pose;
use base::geometry::Point;
use base::random::{Entity, Purpose, Stream, stream, unit};
use core::f64::consts::TAU;

mod calibration;
mod groups;
mod observations;
mod uncertain;

/// A random number from the Poisson distribution (Knuth, *Seminumerical algorithms*, 3.4.1).
fn poisson(mean: f64, random: &mut Stream) -> u32 {
    let (min, mut product, mut number) = (libm::exp(-mean), unit(random), 0);
    while product > min {
        product *= unit(random);
        number += 1;
    }
    number
}

pub(crate) const ME: AgentId = AgentId::robot(0, 0);
pub(crate) const POSITION: Point = Point { x: 3.0, y: 0.0 };

/// Density of items and of false alarms.
pub(crate) const PER_M2: f64 = 0.01;
pub(crate) const FALSE_PER_M2: f64 = 0.02;

/// Detects 70% all around, up to 5 m.
pub(crate) fn camera() -> Detector {
    Detector {
        false_alarms_per_m2: vec![FALSE_PER_M2],
        noise_m: 0.1,
        ..detector(5.0, 7.0, 0.7)
    }
}

pub(crate) fn pose(at: Point) -> Pose {
    Pose {
        at,
        heading_rad: 0.0,
        deviation_m: 0.0,
        deviation_rad: 0.0,
        age_s: 0.0,
    }
}

pub(crate) fn contact(from: Point, at: Point) -> Contact {
    let offset = from.to(at);
    Contact {
        kind: 0,
        sensor: 0,
        range_m: offset.length(),
        bearing_rad: libm::atan2(offset.y, offset.x),
        age_s: 0.0,
    }
}

pub(crate) fn observe(items: &mut Items, observer: AgentId, from: Point, contacts: &[Contact]) {
    observe_with(items, observer, from, (contacts, None));
}

pub(crate) fn observe_with(
    items: &mut Items,
    observer: AgentId,
    from: Point,
    (contacts, map): (&[Contact], Option<&Map>),
) {
    let look = OwnObservation {
        observer,
        detector: &camera(),
        pose: pose(from),
        per_m2: &[PER_M2],
    };
    items.observe(&look, contacts.iter(), map);
}

pub(crate) fn hit(items: &mut Items, observer: AgentId) {
    observe(
        items,
        observer,
        Point::default(),
        &[contact(Point::default(), POSITION)],
    );
}

pub(crate) fn miss(items: &mut Items, observer: AgentId) {
    observe(items, observer, Point::default(), &[]);
}

pub(crate) fn random(run: u64) -> Stream {
    stream(3, run, Entity { kind: 0, index: 0 }, Purpose::Item)
}

/// The probability of the first item, of which the robot has own observations only.
fn confidence(items: &Items) -> f64 {
    probability(items.tracks[0].log_odds())
}

/// The tracks that a robot with own observations only believes in, with their probabilities.
fn believed(items: &Items) -> Vec<(&Track, f64)> {
    let trust = Trust::new(&TrustSpec::default());
    let reception = Reception {
        own: ME,
        trust: &trust,
    };
    items.believed(&reception)
}
