//! The effect of trust on the use of messages, in brains without a simulator.

use crate::{now, percept_at};
use base::geometry::{Point, Rectangle};
use brain::{
    About, AgentId, Body, Brain, CommitmentStatus, Detector, Message, Motion, Observation, Other,
    Percept, Provenance, ReceivedMessage, Receiver,
};
use std::f64::consts::TAU;

const ME: AgentId = robot(1);
const LEADER: AgentId = robot(0);
const UNRELIABLE: AgentId = robot(7);

const fn robot(index: u32) -> AgentId {
    AgentId::robot(0, index)
}

/// A body with a detector range of 3 m in all directions, on a field of 20 m by 20 m.
fn body() -> Body {
    let eye = Detector {
        range_m: 3.0,
        width_rad: TAU,
        detection_probability: vec![vec![[0.0, 0.8], [3.0, 0.8]]],
        false_alarms_per_m2: vec![0.0],
        noise_m: 0.1,
        ..Detector::default()
    };
    let corner = Point { x: 20.0, y: 20.0 };
    Body {
        item_kinds: vec!["mine".into()],
        detectors: vec![eye.clone()],
        others: vec![Other {
            detectors: vec![eye],
            max_acceleration_m_s2: 1.0,
            radius_m: 0.25,
            is_in_the_way: true,
        }],
        field: Some(Rectangle::spanned(Point::default(), corner)),
        ..crate::body()
    }
}

/// A brain with one behaviour, in JSON, and a constant trust.
fn brain(behaviour: &str, trust: &str) -> Brain {
    let spec = format!(
        r#"{{"arbitration": {{"kind": "goals"}}, "limit_speed_to_stopping_distance": false,
            "beliefs": {{"trust": {{{trust}}}}}, "behaviours": [{behaviour}]}}"#
    );
    crate::brain(&spec, body())
}

/// A step at (10, 10); returns the goals of the outgoing messages.
fn step(brain: &mut Brain, inbox: Vec<ReceivedMessage>) -> Vec<(Point, CommitmentStatus)> {
    let goals = brain.step(&percept(inbox)).outbox.into_iter();
    let goal = |message: Message| match message.about {
        About::Goal { at, status, .. } => Some((at, status)),
        _ => None,
    };
    goals.filter_map(goal).collect()
}

fn percept(inbox: Vec<ReceivedMessage>) -> Percept {
    Percept {
        id: ME,
        team_size: 8,
        motion: now(Motion::default()),
        observations: vec![Observation {
            sensor: 0,
            age_s: 0.0,
        }],
        inbox,
        ..percept_at(10.0, 10.0, 0.0)
    }
}

/// Whether it announces a place as its destination within some seconds.
fn goes_to(brain: &mut Brain, to: Point, within_s: u32) -> bool {
    let mut steps = 0..10 * within_s;
    steps.any(|_| step(brain, Vec::new()).contains(&(to, CommitmentStatus::Active)))
}

/// Whether it announces any destination within four seconds.
fn goes_anywhere(brain: &mut Brain) -> bool {
    let mut steps = 0..40;
    steps.any(|_| {
        let goals = step(brain, Vec::new());
        goals
            .iter()
            .any(|(_, status)| *status == CommitmentStatus::Active)
    })
}

fn received(from: AgentId, about: About, [age_s, confidence]: [f64; 2]) -> ReceivedMessage {
    let message = Message {
        to: Receiver::All,
        about,
        confidence,
    };
    ReceivedMessage {
        from,
        age_s,
        message,
    }
}

fn sender(at: Point, observations: u32) -> About {
    About::Sender {
        at,
        heading_rad: 0.0,
        observations,
    }
}

/// A grid of positions over the field, two metres apart.
fn all_over() -> impl Iterator<Item = Point> {
    let odd = |number: i32| f64::from(2 * number + 1);
    (0..100).map(move |number| Point {
        x: odd(number % 10),
        y: odd(number / 10),
    })
}

const PLACE: Point = Point { x: 15.0, y: 10.0 };
const ERRAND: &str = r#"{"kind": "navigate", "assignment": "shared", "waypoints_m": [[15, 10]]}"#;

/// A message about the waypoint, with the id that every robot with this errand gives it.
fn commitment(status: CommitmentStatus) -> About {
    let mut brain = brain(ERRAND, "");
    let mut announced = (0..40).flat_map(|_| brain.step(&percept(Vec::new())).outbox);
    let ids = announced.find_map(|message| match message.about {
        About::Goal { id, .. } => Some(id),
        _ => None,
    });
    let (id, at) = (ids.unwrap(), PLACE);
    About::Goal { id, at, status }
}

fn done(confidence: f64) -> ReceivedMessage {
    let about = commitment(CommitmentStatus::Done);
    received(LEADER, about, [0.0, confidence])
}

#[test]
fn visits_reported_with_low_trust_or_confidence_are_ignored() {
    for (initial, confidence, is_believed) in [
        (0.9, 1.0, true),
        (0.0, 1.0, false),
        (0.0, 0.0, false),
        (0.9, 0.0, false),
        (0.7, 0.7, false),
    ] {
        let trust = format!(r#""initial": {initial}, "adaptive": false"#);
        let mut brain = brain(ERRAND, &trust);
        step(&mut brain, vec![done(confidence)]);
        let goes = goes_to(&mut brain, PLACE, 3);
        assert_eq!(goes, !is_believed, "{initial} {confidence}");
    }
}

#[test]
fn a_commitment_expires_if_only_poses_are_reported() {
    let mut brain = brain(ERRAND, "");
    let about = commitment(CommitmentStatus::Active);
    let here = Point { x: 3.0, y: 3.0 };
    let messages = vec![received(LEADER, about, [0.0, 1.0])];
    assert!(step(&mut brain, messages).is_empty());
    let mut waits = |steps| {
        let mut steps = 0..steps;
        steps.all(|_| {
            let where_it_is = received(LEADER, sender(here, 1), [0.0, 1.0]);
            !step(&mut brain, vec![where_it_is]).contains(&(PLACE, CommitmentStatus::Active))
        })
    };
    assert!(waits(95), "the commitment is still active");
    assert!(!waits(20), "nothing was received for ten seconds");
}

#[test]
fn old_commitments_and_those_without_a_valid_age_are_ignored() {
    for (age_s, is_held) in [
        (0.0, true),
        (5.0, true),
        (500.0, false),
        (-3.0, false),
        (f64::NAN, false),
    ] {
        let mut brain = brain(ERRAND, "");
        let about = commitment(CommitmentStatus::Active);
        step(&mut brain, vec![received(LEADER, about, [age_s, 1.0])]);
        assert_eq!(!goes_to(&mut brain, PLACE, 3), is_held, "{age_s}");
    }
}

#[test]
fn an_old_pose_of_the_leader_is_not_followed() {
    let there = Point { x: 18.0, y: 10.0 };
    for (age_s, for_steps) in [
        (0.0, 99..=101),
        (9.0, 9..=11),
        (500.0, 0..=0),
        (-3.0, 0..=0),
    ] {
        let mut brain = brain(r#"{"kind": "follow"}"#, "");
        let message = received(LEADER, sender(there, 1), [age_s, 1.0]);
        step(&mut brain, vec![message]);
        let mut steps = 1..200;
        let wants = |brain: &mut Brain| {
            step(brain, Vec::new());
            let belief_state = brain.belief_state().unwrap_or_default();
            !belief_state.goals.is_empty()
        };
        let ends = steps.find(|_| !wants(&mut brain)).unwrap_or(200) - 1;
        assert!(for_steps.contains(&ends), "{age_s}: {ends}");
    }
}

#[test]
fn reported_observations_of_an_untrusted_robot_do_not_end_a_search() {
    for (initial, confidence, ends) in [(0.9, 1.0, true), (0.05, 1.0, false), (0.9, 0.05, false)] {
        let trust = format!(r#""initial": {initial}, "adaptive": false"#);
        let mut brain = brain(r#"{"kind": "frontier"}"#, &trust);
        let mut observations = 0;
        // Three times, since repeating a report must have no effect.
        for at in all_over().chain(all_over()).chain(all_over()) {
            observations += 100_000;
            step(
                &mut brain,
                vec![received(
                    UNRELIABLE,
                    sender(at, observations),
                    [0.0, confidence],
                )],
            );
        }
        assert_eq!(!goes_anywhere(&mut brain), ends, "{initial} {confidence}");
    }
}

/// Whether a report of robot 3 is believed after robot 7 has sent wrong reports about items in view,
/// as observations of `observer`.
fn believes_3_after_lies_of_7(observer: AgentId) -> bool {
    let mut brain = brain(r#"{"kind": "frontier"}"#, "");
    for track_id in 0..12 {
        let away = base::trig::sin_cos(TAU * f64::from(track_id) / 12.0);
        let at = Point {
            x: 10.0 + 2.0 * away.1,
            y: 10.0 + 2.0 * away.0,
        };
        let provenance = Provenance {
            observer,
            track_id,
            observations: 5,
        };
        let lie = About::Item {
            kind: 0,
            at,
            provenance,
            kind_share: None,
        };
        step(&mut brain, vec![received(UNRELIABLE, lie, [0.0, 1.0])]);
        (0..9).for_each(|_| drop(step(&mut brain, Vec::new())));
    }
    for (at, observations) in all_over().zip(1..) {
        step(
            &mut brain,
            vec![received(robot(3), sender(at, observations), [0.0, 1.0])],
        );
    }
    !goes_anywhere(&mut brain)
}

#[test]
fn wrong_reports_do_not_reduce_the_trust_in_the_alleged_observer() {
    assert!(believes_3_after_lies_of_7(UNRELIABLE));
    assert!(believes_3_after_lies_of_7(robot(3)));
}
