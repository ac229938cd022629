//! Arbitrary percepts: the commands and beliefs that result, and serialisation as JSON.

use crate::{body, brain};
use base::geometry::{Point, Rectangle};
use brain::behaviours::{Avoid, BehaviourSpec, Cruise, RandomBounce};
use brain::{
    About, Act, ActKind, Acted, AgentId, Arbitration, BeliefsSpec, Body, Brain, BrainSpec, Command,
    CommitmentStatus, Contact, Detector, GoalId, Message, Motion, Neighbour, Observation, Other,
    Percept, Provenance, RangeRing, Reading, ReceivedMessage, Receiver, Scan, SensorRequest,
};
use proptest::prelude::*;
use std::sync::Arc;

fn rover() -> Body {
    let bearings = (-7..=8).map(|ray: i32| f64::from(ray) * 22.5_f64.to_radians());
    Body {
        max_reverse_speed_m_s: 0.5,
        rings: vec![RangeRing {
            bearings_rad: bearings.collect(),
            range_m: 3.0,
            period_s: 0.1,
            latency_s: 0.0,
        }],
        ..body()
    }
}

/// Brains with different behaviours and arbitrations, with and without beliefs.
fn brains(body: &Body) -> Vec<Brain> {
    let correct = r#"[{"kind": "cruise"}, {"kind": "correct", "waypoints_m": [[5, 0], [0, 5]]}, {"kind": "avoid"}]"#;
    let navigate = r#"[{"kind": "cruise"}, {"kind": "navigate", "waypoints_m": [[5, 0]]}, {"kind": "hold_position"}]"#;
    let specs = [
        "{}".to_owned(),
        format!(r#"{{"behaviours": {correct}}}"#),
        format!(r#"{{"arbitration": {{"kind": "schemas"}}, "behaviours": {correct}}}"#),
        format!(
            r#"{{"arbitration": {{"kind": "schemas", "noise": 2}}, "behaviours": {navigate}}}"#
        ),
    ];
    let each = specs.iter().map(|spec| brain(spec, body.clone()));
    each.collect()
}

/// A rover with a mission area and detectors for two kinds of items and two kinds of robots.
fn explorer() -> Body {
    let eye = |sensor| Detector {
        sensor,
        range_m: 4.0,
        width_rad: 3.0,
        detection_probability: vec![vec![[0.0, 0.9], [4.0, 0.5]], vec![]],
        false_alarms_per_m2: vec![0.01],
        noise_m: 0.1,
        needs_line_of_sight: true,
        ..Detector::default()
    };
    let other = |acceleration| Other {
        radius_m: 0.3,
        max_acceleration_m_s2: acceleration,
        is_in_the_way: true,
        detectors: vec![eye(0)],
    };
    let corner = |m| Point { x: m, y: m };
    Body {
        detectors: vec![eye(0), eye(1)],
        item_kinds: vec!["mine".into(), "clutter".into()],
        others: vec![other(1.0), other(f64::INFINITY)],
        field: Some(Rectangle::spanned(corner(-20.0), corner(20.0))),
        ..rover()
    }
}

/// A brain with all behaviours, rotated so that each can be the highest.
fn full_brain(arbitration: Arbitration, turn: usize, body: &Body) -> Brain {
    let mut behaviours: Vec<BehaviourSpec> = serde_json::from_str(
        r#"[
            {"kind": "cruise"}, {"kind": "random_bounce"}, {"kind": "hold_position"},
            {"kind": "lawnmower"}, {"kind": "spiral"}, {"kind": "frontier"},
            {"kind": "bayesian_search"}, {"kind": "follow"}, {"kind": "return_home"},
            {"kind": "navigate", "waypoints_m": [[5, 5], [-5, 0]]}, {"kind": "avoid"}
        ]"#,
    )
    .unwrap();
    let count = behaviours.len();
    behaviours.rotate_left(turn % count);
    let spec = BrainSpec {
        arbitration,
        behaviours,
        beliefs: Some(BeliefsSpec {
            cells: 300,
            ..BeliefsSpec::default()
        }),
        ..BrainSpec::default()
    };
    Brain::new(Arc::new(spec), Arc::new(body.clone()))
}

fn arbitration() -> impl Strategy<Value = Arbitration> {
    prop_oneof![Just(Arbitration::Subsumption), Just(Arbitration::Goals)]
}

/// Mostly a plausible number, sometimes any 64-bit value.
fn number(low: f64, high: f64) -> impl Strategy<Value = f64> {
    prop_oneof![8 => low..high, 1 => any::<f64>(), 1 => Just(f64::INFINITY)]
}

fn reading<T: std::fmt::Debug>(
    value: impl Strategy<Value = T>,
    number: fn(f64, f64) -> BoxedStrategy<f64>,
) -> impl Strategy<Value = Option<Reading<T>>> {
    proptest::option::of(
        (value, number(0.0, 2.0)).prop_map(|(value, age_s)| Reading { value, age_s }),
    )
}

type Numbers = fn(f64, f64) -> BoxedStrategy<f64>;

fn absurd(low: f64, high: f64) -> BoxedStrategy<f64> {
    number(low, high).boxed()
}

fn finite(low: f64, high: f64) -> BoxedStrategy<f64> {
    (low..high).boxed()
}

fn point(number: Numbers) -> impl Strategy<Value = Point> {
    (number(-50.0, 50.0), number(-50.0, 50.0)).prop_map(|(x, y)| Point { x, y })
}

fn motion(number: Numbers) -> impl Strategy<Value = Motion> {
    (number(-2.0, 2.0), number(-2.0, 2.0)).prop_map(|(speed_m_s, turn_rate_rad_s)| Motion {
        speed_m_s,
        turn_rate_rad_s,
    })
}

fn scans(number: Numbers, max: usize) -> impl Strategy<Value = Vec<Scan>> {
    let range = prop_oneof![4 => number(0.2, 4.0), 1 => Just(f64::INFINITY)];
    let rays = prop_oneof![8 => Just(16_usize), 1 => 0_usize..20];
    let ranges = rays.prop_flat_map(move |rays| proptest::collection::vec(range.clone(), rays));
    let scan = (proptest::option::weighted(0.9, number(0.0, 0.6)), ranges);
    let scan = scan.prop_map(|(age_s, ranges_m)| Scan { age_s, ranges_m });
    proptest::collection::vec(scan, 0..=max)
}

fn robot() -> impl Strategy<Value = AgentId> {
    any::<(u8, u32)>().prop_map(|(kind, index)| AgentId::robot(kind, index))
}

fn message(number: Numbers) -> impl Strategy<Value = Message> {
    let provenance = (known_robot(), any::<u32>(), any::<u32>());
    let provenance = provenance.prop_map(|(observer, track_id, observations)| Provenance {
        observer,
        track_id,
        observations,
    });
    let item =
        (any::<u16>(), point(number), provenance).prop_map(|(kind, at, provenance)| About::Item {
            kind,
            at,
            provenance,
            kind_share: None,
        });
    let sender = (point(number), number(-4.0, 4.0), any::<u32>()).prop_map(
        |(at, heading_rad, observations)| About::Sender {
            at,
            heading_rad,
            observations,
        },
    );
    let stands = [
        CommitmentStatus::Active,
        CommitmentStatus::Done,
        CommitmentStatus::Released,
    ];
    let id = (robot(), 0_u32..4).prop_map(|(issuer, number)| GoalId {
        issuer: issuer.into(),
        number,
    });
    let goal = (id, point(number), 0_usize..2).prop_map(move |(id, at, status)| About::Goal {
        id,
        at,
        status: stands[status],
    });
    (prop_oneof![item, sender, goal], number(0.0, 1.0)).prop_map(|(about, confidence)| Message {
        to: Receiver::All,
        about,
        confidence,
    })
}

/// Ids of existing and of unknown robots.
fn known_robot() -> impl Strategy<Value = AgentId> {
    let few = (0_u8..2, 0_u32..3).prop_map(|(kind, index)| AgentId::robot(kind, index));
    prop_oneof![4 => few, 1 => robot()]
}

/// Contacts, neighbours and messages.
fn others(
    number: Numbers,
) -> impl Strategy<Value = (Vec<Contact>, Vec<Neighbour>, Vec<ReceivedMessage>)> {
    let seen = move || (number(0.0, 9.0), number(-3.0, 3.0), number(0.0, 1.0));
    let contact =
        (any::<u16>(), seen()).prop_map(|(kind, (range_m, bearing_rad, age_s))| Contact {
            sensor: kind % 3,
            kind,
            range_m,
            bearing_rad,
            age_s,
        });
    let course = proptest::option::of(number(-3.0, 3.0));
    let neighbour = (known_robot(), seen(), course).prop_map(
        |(id, (range_m, bearing_rad, age_s), course_rad)| Neighbour {
            range_m,
            bearing_rad,
            course_rad,
            age_s,
            uncertainty_m: 0.0,
            id,
        },
    );
    let received =
        (known_robot(), number(0.0, 1.0), message(number)).prop_map(|(from, age_s, message)| {
            ReceivedMessage {
                from,
                age_s,
                message,
            }
        });
    let some = 0..3;
    (
        proptest::collection::vec(contact, some.clone()),
        proptest::collection::vec(neighbour, some.clone()),
        proptest::collection::vec(received, some),
    )
}

fn act_kind() -> impl Strategy<Value = ActKind> {
    prop_oneof![Just(ActKind::Mark), Just(ActKind::Neutralise)]
}

fn acted(number: Numbers) -> impl Strategy<Value = Acted> {
    (act_kind(), point(number), any::<bool>()).prop_map(|(kind, at, is_success)| Acted {
        kind,
        at,
        is_success,
    })
}

fn percept(number: Numbers) -> impl Strategy<Value = Percept> {
    let readings = (
        reading(point(number), number),
        reading(number(-4.0, 4.0), number),
        reading(motion(number), number),
        reading(number(0.0, 1.0), number),
        reading(any::<bool>(), number),
    );
    let time_s = proptest::option::weighted(0.3, number(0.0, 1e4));
    let clock = (time_s, any::<[u32; 4]>());
    let look =
        (0_u16..3, number(0.0, 1.0)).prop_map(|(sensor, age_s)| Observation { sensor, age_s });
    let identity = (
        known_robot(),
        0_u32..4,
        proptest::collection::vec(look, 0..3),
    );
    let results = (
        proptest::collection::vec(acted(number), 0..2),
        proptest::option::of(0_u32..9),
    );
    let others = (others(number), results);
    (clock, readings, scans(number, 2), others, identity).prop_map(
        |(
            (time_s, random_words),
            readings,
            scans,
            ((contacts, neighbours, inbox), (acted, charges)),
            (id, team_size, observations),
        )| {
            Percept {
                id,
                team_size,
                observations,
                time_s,
                random_words,
                position: readings.0,
                heading_rad: readings.1,
                motion: readings.2,
                battery: readings.3,
                touch: readings.4,
                scans,
                contacts,
                neighbours,
                inbox,
                acted,
                charges,
            }
        },
    )
}

fn command() -> impl Strategy<Value = Command> {
    let request = any::<(u16, bool)>().prop_map(|(sensor, on)| SensorRequest { sensor, on });
    let act = (act_kind(), point(finite)).prop_map(|(kind, at)| Act { kind, at });
    (
        motion(finite),
        proptest::option::of(finite(-3.0, 3.0)),
        proptest::collection::vec(request, 0..3),
        proptest::collection::vec(message(finite), 0..3),
        proptest::collection::vec(act, 0..3),
    )
        .prop_map(|(motion, heading_rad, requests, outbox, acts)| Command {
            motion,
            heading_rad,
            requests,
            outbox,
            acts,
        })
}

fn check_outbox(outbox: &[Message]) -> Result<(), TestCaseError> {
    prop_assert!(outbox.len() <= 5, "{outbox:?}");
    for message in outbox {
        prop_assert!((0.0..=1.0).contains(&message.confidence), "{message:?}");
        let (About::Item { at, .. } | About::Goal { at, .. } | About::Sender { at, .. }) =
            message.about
        else {
            return Err(TestCaseError::fail("only a person gives orders"));
        };
        prop_assert!(at.x.is_finite() && at.y.is_finite(), "{message:?}");
    }
    Ok(())
}

fn check_belief_state(brain: &Brain) -> Result<(), TestCaseError> {
    let belief_state = brain.belief_state().unwrap_or_default();
    let sizes = [
        belief_state.items.len(),
        belief_state.robots.len(),
        belief_state.goals.len(),
    ];
    prop_assert!(
        sizes[0] <= 64 && sizes[1] <= 16 && sizes[2] <= 11,
        "{sizes:?}"
    );
    for item in &belief_state.items {
        prop_assert!((0.0..=1.0).contains(&item.confidence), "{item:?}");
        prop_assert!(
            item.deviation_m.is_finite() && item.at.x.is_finite(),
            "{item:?}"
        );
    }
    for robot in &belief_state.robots {
        let numbers = [
            robot.at.x,
            robot.at.y,
            robot.velocity_m_s.x,
            robot.velocity_m_s.y,
        ];
        prop_assert!(numbers.iter().all(|number| number.is_finite()), "{robot:?}");
    }
    Ok(())
}

fn motions(brain: &mut Brain, percepts: &[Percept]) -> Vec<Motion> {
    let step = |percept| brain.step(percept).motion;
    percepts.iter().map(step).collect()
}

proptest! {
    #[test]
    fn a_percept_survives_a_round_trip_through_json(percept in percept(finite)) {
        let text = serde_json::to_string(&percept).unwrap();
        prop_assert_eq!(serde_json::from_str::<Percept>(&text).unwrap(), percept);
    }

    #[test]
    fn a_command_survives_a_round_trip_through_json(command in command()) {
        let text = serde_json::to_string(&command).unwrap();
        prop_assert_eq!(serde_json::from_str::<Command>(&text).unwrap(), command);
    }

    #[test]
    fn commands_are_finite_and_within_limits_for_any_percept(
        percepts in proptest::collection::vec(percept(absurd), 1..60),
    ) {
        let mut all = brains(&rover());
        for motion in all.iter_mut().flat_map(|brain| motions(brain, &percepts)) {
            prop_assert!((-0.5..=1.0).contains(&motion.speed_m_s), "{motion:?}");
            prop_assert!((-1.5..=1.5).contains(&motion.turn_rate_rad_s), "{motion:?}");
        }
    }

    #[test]
    fn commands_are_finite_for_any_body(
        numbers in proptest::array::uniform8(number(0.0, 3.0)),
        bearings in proptest::collection::vec(number(-4.0, 4.0), 0..20),
        percepts in proptest::collection::vec(percept(absurd), 1..9),
    ) {
        let [radius_m, ahead, back, acceleration, turn, period_s, range_m, latency_s] = numbers;
        let body = Body {
            radius_m,
            max_speed_m_s: ahead,
            max_reverse_speed_m_s: back,
            max_acceleration_m_s2: acceleration,
            max_turn_rate_rad_s: turn,
            period_s,
            rings: vec![RangeRing { bearings_rad: bearings, range_m, period_s, latency_s }],
            ..Body::default()
        };
        let mut all = brains(&body);
        for motion in all.iter_mut().flat_map(|brain| motions(brain, &percepts)) {
            prop_assert!(motion.speed_m_s.is_finite(), "{motion:?}");
            prop_assert!(motion.turn_rate_rad_s.is_finite(), "{motion:?}");
        }
    }

    #[test]
    fn the_same_percepts_give_the_same_commands_and_a_clone_has_the_same_future(
        percepts in proptest::collection::vec(percept(absurd), 2..60), at in 0_usize..60,
    ) {
        let (before, after) = percepts.split_at(at % percepts.len());
        for (mut first, mut again) in brains(&rover()).into_iter().zip(brains(&rover())) {
            let mut all = motions(&mut first, before);
            let mut clone = first.clone();
            let future = motions(&mut first, after);
            prop_assert_eq!(&motions(&mut clone, after), &future);
            all.extend(future);
            prop_assert_eq!(motions(&mut again, &percepts), all);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    #[test]
    fn beliefs_are_valid_for_any_percepts(
        percepts in proptest::collection::vec(percept(absurd), 1..50),
        arbitration in arbitration(), turn in 0_usize..11,
    ) {
        let mut brain = full_brain(arbitration, turn, &explorer());
        for percept in &percepts {
            let Command { motion, outbox, .. } = brain.step(percept);
            prop_assert!((-0.5..=1.0).contains(&motion.speed_m_s), "{motion:?}");
            prop_assert!((-1.5..=1.5).contains(&motion.turn_rate_rad_s), "{motion:?}");
            check_outbox(&outbox)?;
        }
        check_belief_state(&brain)?;
    }

    #[test]
    fn the_same_percepts_give_the_same_beliefs_and_commands(
        percepts in proptest::collection::vec(percept(absurd), 2..40),
        arbitration in arbitration(), turn in 0_usize..11, at in 0_usize..40,
    ) {
        let body = explorer();
        let mut first = full_brain(arbitration.clone(), turn, &body);
        let mut again = full_brain(arbitration, turn, &body);
        let (before, after) = percepts.split_at(at % percepts.len());
        let step = |brain: &mut Brain, percept| format!("{:?}", brain.step(percept));
        for percept in before {
            prop_assert_eq!(step(&mut first, percept), step(&mut again, percept));
        }
        let mut clone = first.clone();
        for percept in after {
            let command = step(&mut first, percept);
            prop_assert_eq!(&step(&mut again, percept), &command);
            prop_assert_eq!(&step(&mut clone, percept), &command);
        }
        let belief_state = format!("{:?}", first.belief_state());
        prop_assert_eq!(format!("{:?}", clone.belief_state()), belief_state);
    }

    #[test]
    fn beliefs_are_valid_after_renumbering(
        percepts in proptest::collection::vec(percept(absurd), 1..30), gone in 0_u32..3,
    ) {
        let mut brain = full_brain(Arbitration::Goals, 5, &explorer());
        for percept in &percepts {
            check_outbox(&brain.step(percept).outbox)?;
            brain.renumber(|id| {
                let index = if id.index > gone { id.index - 1 } else { id.index };
                (id.index != gone).then_some(AgentId { index, ..id })
            });
        }
        check_belief_state(&brain)?;
    }

    #[test]
    fn commands_with_beliefs_are_finite_for_any_body(
        numbers in proptest::array::uniform8(number(0.0, 3.0)),
        percepts in proptest::collection::vec(percept(absurd), 1..20),
    ) {
        let [radius_m, speed, back, acceleration, turn, period_s, range_m, noise_m] = numbers;
        let mut body = explorer();
        body.detectors[0].range_m = range_m.min(1e4);
        body.detectors[0].noise_m = noise_m;
        let body = Body {
            radius_m: radius_m.min(1e4),
            max_speed_m_s: speed,
            max_reverse_speed_m_s: back,
            max_acceleration_m_s2: acceleration,
            max_turn_rate_rad_s: turn,
            period_s,
            neighbour_noise_m: noise_m,
            position_noise_m: noise_m,
            ..body
        };
        let mut brain = full_brain(Arbitration::Goals, 5, &body);
        for motion in motions(&mut brain, &percepts) {
            prop_assert!(motion.speed_m_s.is_finite(), "{motion:?}");
            prop_assert!(motion.turn_rate_rad_s.is_finite(), "{motion:?}");
        }
    }
}

#[test]
fn infinite_ranges_are_null_in_json_and_required_fields_are_present() {
    let percept = Percept {
        scans: vec![Scan {
            age_s: Some(0.1),
            ranges_m: vec![1.5, f64::INFINITY],
        }],
        ..Percept::default()
    };
    let text = serde_json::to_string(&percept).unwrap();
    assert!(text.contains(r#""ranges_m":[1.5,null]"#), "{text}");
    let read = |text| serde_json::from_str::<Percept>(text);
    assert_eq!(read("{}").unwrap(), Percept::default());
    assert!(read(r#"{"scanz": []}"#).is_err());
}

#[test]
fn an_unlimited_acceleration_is_null_in_json() {
    let mut body = rover();
    body.max_acceleration_m_s2 = f64::INFINITY;
    let text = serde_json::to_string(&body).unwrap();
    assert!(text.contains(r#""max_acceleration_m_s2":null"#), "{text}");
    assert_eq!(serde_json::from_str::<Body>(&text).unwrap(), body);
}

#[test]
fn a_brain_is_serialised_as_in_a_scenario() {
    let text = r#"{
        "rate_hz": 10,
        "behaviours": [
            {"kind": "cruise", "speed_m_s": 0.5},
            {"kind": "random_bounce"},
            {"kind": "avoid", "near_m": 0.3}
        ]
    }"#;
    let behaviours = vec![
        BehaviourSpec::Cruise(Cruise {
            speed_m_s: Some(0.5),
        }),
        BehaviourSpec::RandomBounce(RandomBounce::default()),
        BehaviourSpec::Avoid(Avoid {
            near_m: 0.3,
            ..Avoid::default()
        }),
    ];
    let expected = BrainSpec {
        arbitration: Arbitration::Subsumption,
        beliefs: None,
        rate_hz: Some(10.0),
        limit_speed_to_stopping_distance: true,
        behaviours,
    };
    assert_eq!(serde_json::from_str::<BrainSpec>(text).unwrap(), expected);
    let slip = text.replace("near_m", "neer_m");
    let error = serde_json::from_str::<BrainSpec>(&slip).unwrap_err();
    assert!(
        error.to_string().contains("unknown field `neer_m`"),
        "{error}"
    );
}
