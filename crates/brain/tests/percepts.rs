//! Any percepts that can be: what brains make of them, and their way through JSON.

use base::geometry::Point;
use brain::behaviours::{Avoid, BehaviourSpec, Bounce, Cruise};
use brain::{
    About, Arbitration, Body, Brain, BrainSpec, Command, Contact, Heard, Look, Message, Motion,
    Neighbour, Percept, RangeRing, Reading, RobotId, Scan, Seen, SensorRequest, Stand,
};
use proptest::prelude::*;
use std::sync::Arc;

fn rover() -> Body {
    let bearings = (-7..=8).map(|ray: i32| f64::from(ray) * 22.5_f64.to_radians());
    Body {
        radius_m: 0.25,
        max_speed_m_s: 1.0,
        max_reverse_speed_m_s: 0.5,
        max_acceleration_m_s2: 1.0,
        max_turn_rate_rad_s: 1.5,
        period_s: 0.1,
        rings: vec![RangeRing {
            bearings_rad: bearings.collect(),
            range_m: 3.0,
            period_s: 0.1,
            latency_s: 0.0,
        }],
        ..Body::default()
    }
}

/// Brains that make motions in different ways, with a mind and without.
#[expect(clippy::unwrap_used, reason = "written here")]
fn brains(body: &Body) -> Vec<Brain> {
    let correct = r#"[{"kind": "cruise"}, {"kind": "correct", "places_m": [[5, 0], [0, 5]]}, {"kind": "avoid"}]"#;
    let navigate =
        r#"[{"kind": "cruise"}, {"kind": "navigate", "places_m": [[5, 0]]}, {"kind": "hold"}]"#;
    let specs = [
        "{}".to_owned(),
        format!(r#"{{"behaviours": {correct}}}"#),
        format!(r#"{{"arbitration": {{"kind": "schemas"}}, "behaviours": {correct}}}"#),
        format!(
            r#"{{"arbitration": {{"kind": "schemas", "noise": 2}}, "behaviours": {navigate}}}"#
        ),
    ];
    let brain = |spec: &String| {
        let spec: BrainSpec = serde_json::from_str(spec).unwrap();
        Brain::new(Arc::new(spec), Arc::new(body.clone()))
    };
    specs.iter().map(brain).collect()
}

/// Mostly a sensible number, and at times anything that fits into 64 bits.
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

fn scans(number: Numbers, most: usize) -> impl Strategy<Value = Vec<Scan>> {
    let range = prop_oneof![4 => number(0.2, 4.0), 1 => Just(f64::INFINITY)];
    let rays = prop_oneof![8 => Just(16_usize), 1 => 0_usize..20];
    let ranges = rays.prop_flat_map(move |rays| proptest::collection::vec(range.clone(), rays));
    let scan = (proptest::option::weighted(0.9, number(0.0, 0.6)), ranges);
    let scan = scan.prop_map(|(age_s, ranges_m)| Scan { age_s, ranges_m });
    proptest::collection::vec(scan, 0..=most)
}

fn robot() -> impl Strategy<Value = RobotId> {
    any::<(u8, u32)>().prop_map(|(kind, index)| RobotId { kind, index })
}

fn message(number: Numbers) -> impl Strategy<Value = Message> {
    let seen = (robot(), any::<u32>(), any::<u32>());
    let seen = seen.prop_map(|(by, mark, looks)| Seen { by, mark, looks });
    let item = (any::<u16>(), point(number), seen).prop_map(|(kind, at, seen)| About::Item {
        kind,
        at,
        seen,
    });
    let sender =
        (point(number), number(-4.0, 4.0), any::<u32>()).prop_map(|(at, heading_rad, looks)| {
            About::Sender {
                at,
                heading_rad,
                looks,
            }
        });
    let stands = [Stand::Going, Stand::Done];
    let goal = (point(number), 0_usize..2).prop_map(move |(at, stand)| About::Goal {
        at,
        stand: stands[stand],
    });
    (prop_oneof![item, sender, goal], number(0.0, 1.0))
        .prop_map(|(about, confidence)| Message { about, confidence })
}

/// What is about others: items, robots, messages.
fn others(number: Numbers) -> impl Strategy<Value = (Vec<Contact>, Vec<Neighbour>, Vec<Heard>)> {
    let seen = move || (number(0.0, 9.0), number(-3.0, 3.0), number(0.0, 1.0));
    let contact =
        (any::<u16>(), seen()).prop_map(|(kind, (range_m, bearing_rad, age_s))| Contact {
            sensor: kind % 3,
            kind,
            range_m,
            bearing_rad,
            age_s,
        });
    let neighbour = (robot(), seen()).prop_map(|(id, (range_m, bearing_rad, age_s))| Neighbour {
        range_m,
        bearing_rad,
        age_s,
        id,
    });
    let heard =
        (robot(), number(0.0, 1.0), message(number)).prop_map(|(from, age_s, message)| Heard {
            from,
            age_s,
            message,
        });
    let some = 0..3;
    (
        proptest::collection::vec(contact, some.clone()),
        proptest::collection::vec(neighbour, some.clone()),
        proptest::collection::vec(heard, some),
    )
}

fn percept(number: Numbers) -> impl Strategy<Value = Percept> {
    let readings = (
        reading(point(number), number),
        reading(number(-4.0, 4.0), number),
        reading(motion(number), number),
        reading(number(0.0, 1.0), number),
        reading(any::<bool>(), number),
    );
    let clock = (number(0.0, 1e4), any::<[u32; 4]>());
    let look = (0_u16..3, number(0.0, 1.0)).prop_map(|(sensor, age_s)| Look { sensor, age_s });
    let told = (robot(), 0_u32..4, proptest::collection::vec(look, 0..3));
    (clock, readings, scans(number, 2), others(number), told).prop_map(
        |((time_s, dice), readings, scans, (contacts, neighbours, inbox), (id, of_kind, looks))| {
            Percept {
                id,
                of_kind,
                looks,
                time_s,
                dice,
                position: readings.0,
                heading_rad: readings.1,
                motion: readings.2,
                battery: readings.3,
                touch: readings.4,
                scans,
                contacts,
                neighbours,
                inbox,
            }
        },
    )
}

fn command() -> impl Strategy<Value = Command> {
    let request = any::<(u16, bool)>().prop_map(|(sensor, on)| SensorRequest { sensor, on });
    (
        motion(finite),
        proptest::collection::vec(request, 0..3),
        proptest::collection::vec(message(finite), 0..3),
    )
        .prop_map(|(motion, requests, outbox)| Command {
            motion,
            requests,
            outbox,
        })
}

fn motions(brain: &mut Brain, percepts: &[Percept]) -> Vec<Motion> {
    let step = |percept| brain.step(percept).motion;
    percepts.iter().map(step).collect()
}

proptest! {
    #[test]
    fn a_percept_comes_back_from_json_as_it_was(percept in percept(finite)) {
        let text = serde_json::to_string(&percept).unwrap();
        prop_assert_eq!(serde_json::from_str::<Percept>(&text).unwrap(), percept);
    }

    #[test]
    fn a_command_comes_back_from_json_as_it_was(command in command()) {
        let text = serde_json::to_string(&command).unwrap();
        prop_assert_eq!(serde_json::from_str::<Command>(&text).unwrap(), command);
    }

    #[test]
    fn whatever_a_percept_holds_the_command_is_finite_and_within_the_bodys_limits(
        percepts in proptest::collection::vec(percept(absurd), 1..60),
    ) {
        let mut all = brains(&rover());
        for motion in all.iter_mut().flat_map(|brain| motions(brain, &percepts)) {
            prop_assert!((-0.5..=1.0).contains(&motion.speed_m_s), "{motion:?}");
            prop_assert!((-1.5..=1.5).contains(&motion.turn_rate_rad_s), "{motion:?}");
        }
    }

    #[test]
    fn whatever_a_body_is_the_command_is_finite(
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

#[test]
fn infinite_ranges_are_null_in_json_and_nothing_is_left_out_that_must_be_there() {
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
fn a_body_that_changes_its_speed_at_once_has_null_for_its_acceleration() {
    let mut body = rover();
    body.max_acceleration_m_s2 = f64::INFINITY;
    let text = serde_json::to_string(&body).unwrap();
    assert!(text.contains(r#""max_acceleration_m_s2":null"#), "{text}");
    assert_eq!(serde_json::from_str::<Body>(&text).unwrap(), body);
}

#[test]
fn a_brain_is_written_as_a_scenario_says_it() {
    let text = r#"{
        "rate_hz": 10,
        "behaviours": [
            {"kind": "cruise", "speed_m_s": 0.5},
            {"kind": "bounce"},
            {"kind": "avoid", "near_m": 0.3}
        ]
    }"#;
    let behaviours = vec![
        BehaviourSpec::Cruise(Cruise {
            speed_m_s: Some(0.5),
        }),
        BehaviourSpec::Bounce(Bounce::default()),
        BehaviourSpec::Avoid(Avoid {
            near_m: 0.3,
            ..Avoid::default()
        }),
    ];
    let expected = BrainSpec {
        arbitration: Arbitration::Subsumption,
        beliefs: None,
        rate_hz: Some(10.0),
        speed_limited_by_sight: true,
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
