//! The heading of a command: that of the turn of `correct`, and none of any other motion.

use crate::{body, brain, now, percept_at};
use base::geometry::Point;
use base::trig::wrapped;
use brain::{Body, Brain, Command, Motion, Percept, RangeRing, Scan};
use proptest::prelude::*;
use std::f64::consts::PI;

/// One ray, to the front.
fn bender() -> Body {
    let ring = RangeRing {
        bearings_rad: vec![0.0],
        range_m: 3.0,
        period_s: 0.1,
        latency_s: 0.0,
    };
    Body {
        rings: vec![ring],
        ..body()
    }
}

/// The three layers of Bender, with a waypoint.
fn three_layers(x: f64, y: f64) -> Brain {
    let spec = format!(
        r#"{{"behaviours": [{{"kind": "cruise", "speed_m_s": 0.5}},
            {{"kind": "correct", "waypoints_m": [[{x:?}, {y:?}]]}}, {{"kind": "avoid"}}]}}"#
    );
    brain(&spec, bender())
}

fn facing(heading_rad: f64, range_m: f64) -> Percept {
    Percept {
        scans: vec![Scan {
            age_s: Some(0.0),
            ranges_m: vec![range_m],
        }],
        ..percept_at(0.0, 0.0, heading_rad)
    }
}

/// The commands of a robot that turns as commanded, until it moves; its compass is off by an error
/// that alternates.
fn turning(brain: &mut Brain, mut heading_rad: f64, error_rad: f64) -> (Vec<Command>, Command) {
    let (mut turn, mut error_rad) = (Vec::new(), error_rad);
    loop {
        let command = brain.step(&facing(heading_rad + error_rad, 3.0));
        if command.motion.speed_m_s > 0.0 {
            return (turn, command);
        }
        heading_rad = wrapped(heading_rad + 0.1 * command.motion.turn_rate_rad_s);
        error_rad = -error_rad;
        turn.push(command);
        assert!(turn.len() < 100, "it turns for 10 s: {turn:?}");
    }
}

#[test]
fn while_it_turns_the_heading_is_that_of_the_waypoint_and_then_there_is_none() {
    for (x, y) in [(0.0, 9.0), (-9.0, 0.5), (-3.0, -7.0), (5.0, -5.0)] {
        let (turn, moving) = turning(&mut three_layers(x, y), 0.0, 0.0);
        assert!(turn.len() > 3, "{x} {y}");
        let course_rad = y.atan2(x);
        let off_rad = |command: &Command| command.heading_rad.unwrap() - course_rad;
        assert!(turn.iter().all(|command| off_rad(command).abs() < 1e-12));
        assert_eq!(moving.heading_rad, None);
    }
}

#[test]
fn the_heading_does_not_change_during_a_turn_even_if_the_compass_is_noisy() {
    let (turn, _) = turning(&mut three_layers(0.0, 9.0), 0.3, 0.05);
    assert!(turn.len() > 5);
    assert!(
        turn.iter()
            .all(|command| command.heading_rad == turn[0].heading_rad)
    );
}

#[test]
fn a_heading_is_above_minus_pi() {
    for y in [0.0, -0.0] {
        let heading_rad = three_layers(-9.0, y).step(&facing(2.0, 3.0)).heading_rad;
        assert_eq!(heading_rad, Some(PI), "{y:?}");
    }
}

#[test]
fn there_is_no_heading_while_avoid_is_active_even_in_a_turn_of_correct() {
    let mut brain = three_layers(0.0, 9.0);
    assert!(brain.step(&facing(0.0, 3.0)).heading_rad.is_some());
    // Something is in the way; then it is gone, and avoid moves straight on.
    for range_m in [0.3, 0.3, 3.0, 3.0, 3.0] {
        let percept = facing(0.1, range_m);
        assert_eq!(brain.decision(&percept).leading, Some(2));
        assert_eq!(brain.step(&percept).heading_rad, None);
    }
}

#[test]
fn there_is_no_heading_while_a_turn_is_postponed() {
    // Too fast to turn to where it has no sensors.
    let mut brain = three_layers(0.0, 9.0);
    let moving = now(Motion {
        speed_m_s: 1.0,
        turn_rate_rad_s: 0.0,
    });
    for (motion, range_m) in [(moving, 0.5), (now(Motion::default()), 3.0)] {
        let command = brain.step(&Percept {
            motion,
            ..facing(0.0, range_m)
        });
        let is_turning = command.motion.turn_rate_rad_s != 0.0;
        assert_eq!(is_turning, range_m > 1.0);
        assert_eq!(command.heading_rad.is_some(), is_turning);
    }
}

#[test]
fn other_behaviours_turn_without_a_heading() {
    for behaviour in [
        r#"{"kind": "navigate", "waypoints_m": [[0, 9]]}"#,
        r#"{"kind": "random_bounce"}"#,
        r#"{"kind": "lawnmower"}"#,
    ] {
        let spec = format!(r#"{{"behaviours": [{behaviour}]}}"#);
        let mut brain = brain(&spec, bender());
        let commands: Vec<Command> = (0..20).map(|_| brain.step(&facing(0.0, 0.3))).collect();
        assert!(commands.iter().all(|command| command.heading_rad.is_none()));
    }
}

#[test]
fn a_percept_that_is_not_later_repeats_the_heading() {
    let mut brain = three_layers(0.0, 9.0);
    let at = |time_s| Percept {
        time_s: Some(time_s),
        ..facing(0.0, 3.0)
    };
    let first = brain.step(&at(1.0));
    assert!(first.heading_rad.is_some());
    assert!(brain.is_later(&at(1.5)) && !brain.is_later(&at(1.0)));
    assert_eq!(brain.step(&at(1.0)), first);
    assert_eq!(brain.last_command(), first);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn a_heading_is_the_direction_of_a_turn_on_the_spot_from_minus_pi_to_pi(
        place in (-9.0_f64..9.0, -9.0_f64..9.0),
        percepts in proptest::collection::vec(
            (-9.0_f64..9.0, -1.0_f64..1.0, -4.0_f64..4.0, 0.2_f64..9.0), 1..60),
    ) {
        let mut brain = three_layers(place.0, place.1);
        for (x, y, heading_rad, range_m) in percepts {
            let command = brain.step(&Percept {
                position: now(Point { x, y }),
                ..facing(heading_rad, range_m)
            });
            if let Some(heading_rad) = command.heading_rad {
                prop_assert!(heading_rad > -PI && heading_rad <= PI);
                prop_assert!(command.motion.speed_m_s == 0.0 || command.motion.turn_rate_rad_s != 0.0);
            }
        }
    }
}
