//! Reports of items whose kind is uncertain.

use super::*;
use crate::io::body::{Body, Detector};
use crate::perception::beliefs::coverage_map::tests::detector;
use crate::perception::beliefs::items::OwnObservation;
use crate::perception::beliefs::items::kinds::KindModel;
use crate::perception::beliefs::items::tests::{FALSE_PER_M2, pose};

const KINDS_PER_M2: [f64; 2] = [PER_M2, PER_M2];
const CLUTTER: u16 = 0;
const MINE: u16 = 1;

fn eye() -> Detector {
    let table = detector(5.0, 7.0, 0.7).detection_probability.remove(0);
    Detector {
        detection_probability: vec![table; 2],
        false_alarms_per_m2: vec![FALSE_PER_M2; 2],
        confusion: vec![vec![0.9, 0.1], vec![0.1, 0.9]],
        noise_m: 0.1,
        ..detector(5.0, 7.0, 0.7)
    }
}

pub(super) fn receiver() -> Items {
    let body = Body {
        detectors: vec![eye()],
        ..Body::default()
    };
    Items::new(64, KindModel::new(&body, &KINDS_PER_M2))
}

fn look(items: &mut Items, kind: u16) {
    let own = OwnObservation {
        observer: ME,
        detector: &eye(),
        pose: pose(Point::default()),
        per_m2: &KINDS_PER_M2,
    };
    let contact = crate::io::percept::Contact {
        kind,
        ..contact(Point::default(), POSITION)
    };
    items.observe(&own, [contact].iter(), None);
}

fn receive_mine(items: &mut Items, observer: u32, confidence: f64) {
    let report = Report {
        kind: MINE,
        ..report(observer, confidence)
    };
    with_initial_trust(ME, |reception| {
        items.receive(reception, &report, 0.01, &KINDS_PER_M2);
    });
}

/// The kind of the only track, and the probability of an item of that kind.
fn belief(items: &Items) -> (u16, f64) {
    assert_eq!(items.tracks.len(), 1);
    let track = &items.tracks[0];
    let kinds = items.kinds.as_deref();
    (
        track.kind,
        with_initial_trust(ME, |reception| track.confidence(reception, kinds)),
    )
}

#[test]
fn a_reported_kind_is_believed_as_far_as_its_sender_is_trusted() {
    let mut items = receiver();
    receive_mine(&mut items, 1, 0.8);
    let (kind, confidence) = belief(&items);
    assert_eq!(kind, MINE);
    assert!((0.65..0.75).contains(&confidence), "{confidence}");
}

#[test]
fn own_contacts_as_another_kind_overrule_a_reported_kind_and_keep_the_item() {
    let mut items = receiver();
    receive_mine(&mut items, 1, 0.8);
    (0..4).for_each(|_| look(&mut items, CLUTTER));
    let (kind, confidence) = belief(&items);
    assert!(kind == CLUTTER && confidence > 0.95, "{kind} {confidence}");
}

#[test]
fn reports_and_contacts_that_agree_on_a_kind_strengthen_it() {
    let mut items = receiver();
    look(&mut items, MINE);
    let (_, alone) = belief(&items);
    receive_mine(&mut items, 1, 0.8);
    let (kind, confidence) = belief(&items);
    assert!(kind == MINE && confidence > alone, "{confidence} {alone}");
}

#[test]
fn a_message_names_the_most_probable_kind_with_the_probability_of_an_item_of_that_kind() {
    let mut items = receiver();
    look(&mut items, MINE);
    look(&mut items, CLUTTER);
    look(&mut items, MINE);
    let (kind, confidence) = belief(&items);
    let sent = sent(&mut items);
    assert_eq!((sent.len(), sent[0].kind), (1, kind));
    assert!((sent[0].confidence - confidence).abs() < 1e-9);
}

#[test]
fn liars_that_agree_on_a_kind_are_believed_no_more_than_they_are_trusted() {
    let mut items = receiver();
    (1..4).for_each(|liar| receive_mine(&mut items, liar, 1.0));
    let (_, confidence) = belief(&items);
    let prior = TAU * 0.01 * 2.0 * PER_M2;
    assert!(confidence <= 1.0 - (1.0 - prior) * 0.1_f64.powi(3) + 1e-9);
    let trust = Trust::new(&TrustSpec {
        initial: 0.3,
        adaptive: false,
    });
    let reception = Reception {
        own: ME,
        trust: &trust,
    };
    let confidence = items.tracks[0].confidence(&reception, items.kinds.as_deref());
    assert!(
        confidence <= 1.0 - (1.0 - prior) * 0.7_f64.powi(3) + 1e-9,
        "{confidence}"
    );
}
