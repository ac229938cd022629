use super::track::Track;
use super::tracks::MAX_TRACKS;
use super::*;
use crate::io::body::{Detector, RobotId};
use crate::io::message::{About, Message, Provenance};
use crate::io::percept::Contact;
use crate::perception::beliefs::coverage_map::tests::detector;
use crate::perception::beliefs::map::Map;
use crate::perception::beliefs::pose::Pose;
use crate::perception::beliefs::trust::{Trust, TrustSpec};
use base::geometry::Point;
use base::random::{Entity, Purpose, Stream, stream, unit};
use core::f64::consts::TAU;

mod calibration;
mod observations;
mod reports;

const ME: RobotId = RobotId { kind: 0, index: 0 };
const POSITION: Point = Point { x: 3.0, y: 0.0 };

/// Density of items and of false alarms.
const PER_M2: f64 = 0.01;
const FALSE_PER_M2: f64 = 0.02;

/// Detects 70% all around, up to 5 m.
fn camera() -> Detector {
    Detector {
        false_alarms_per_m2: vec![FALSE_PER_M2],
        noise_m: 0.1,
        ..detector(5.0, 7.0, 0.7)
    }
}

fn pose(at: Point) -> Pose {
    Pose {
        at,
        heading_rad: 0.0,
        deviation_m: 0.0,
        deviation_rad: 0.0,
        age_s: 0.0,
    }
}

fn contact(from: Point, at: Point) -> Contact {
    let offset = from.to(at);
    Contact {
        kind: 0,
        sensor: 0,
        range_m: offset.length(),
        bearing_rad: libm::atan2(offset.y, offset.x),
        age_s: 0.0,
    }
}

fn observe(items: &mut Items, observer: RobotId, from: Point, contacts: &[Contact]) {
    observe_with(items, observer, from, (contacts, None));
}

fn observe_with(
    items: &mut Items,
    observer: RobotId,
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

fn hit(items: &mut Items, observer: RobotId) {
    observe(
        items,
        observer,
        Point::default(),
        &[contact(Point::default(), POSITION)],
    );
}

fn miss(items: &mut Items, observer: RobotId) {
    observe(items, observer, Point::default(), &[]);
}

fn confidence(items: &Items, own: RobotId) -> f64 {
    confidence_of(&items.tracks[0], own)
}

fn sent(items: &mut Items) -> Vec<Report> {
    let mut outbox = Vec::new();
    with_initial_trust(ME, |reception| items.report(reception, &mut outbox, 100));
    let report = |message: Message| match message.about {
        About::Item {
            kind,
            at,
            provenance,
        } => Some(Report {
            kind,
            at,
            provenance,
            confidence: message.confidence,
            from: provenance.observer,
        }),
        _ => None,
    };
    outbox.into_iter().filter_map(report).collect()
}

/// The trust after nine refuted reports of a robot.
fn distrust_of(sender: RobotId) -> (Trust, TrustSpec) {
    let (mut trust, spec) = (Trust::default(), TrustSpec::default());
    (0..9).for_each(|_| trust.learn(sender, false, &spec));
    (trust, spec)
}

/// Calls a function with the initial trust in all robots.
fn with_initial_trust<T>(own: RobotId, then: impl FnOnce(&Reception) -> T) -> T {
    let (trust, spec) = (&Trust::default(), &TrustSpec::default());
    then(&Reception { own, trust, spec })
}

fn receive(items: &mut Items, own: RobotId, report: &Report) {
    with_initial_trust(own, |reception| {
        items.receive(reception, report, 0.01, &[PER_M2]);
    });
}

fn robot(index: u32) -> RobotId {
    RobotId { kind: 0, index }
}

fn report(observer: u32, confidence: f64) -> Report {
    Report {
        kind: 0,
        at: POSITION,
        provenance: Provenance {
            observer: robot(observer),
            track_id: 1,
            observations: 1,
        },
        confidence,
        from: robot(observer),
    }
}

fn random(run: u64) -> Stream {
    stream(3, run, Entity { kind: 0, index: 0 }, Purpose::Item)
}

fn confidence_of(track: &Track, own: RobotId) -> f64 {
    with_initial_trust(own, |reception| track.confidence(reception))
}
