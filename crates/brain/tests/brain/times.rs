//! Percepts at other times than the period of the body: more often, more rarely, irregularly, and
//! with gaps.

use crate::{body, brain, now, percept_at};
use base::geometry::Point;
use base::trig::wrapped;
use brain::{About, Body, Brain, Motion, Percept, RangeRing, Scan, Verdict};
use proptest::prelude::*;

/// Times between percepts in seconds, repeated, for a brain of 5 Hz.
const PATTERNS: [&[f64]; 5] = [
    &[0.1],
    &[0.2],
    &[0.5],
    &[0.05, 0.3, 0.11, 0.5, 0.2],
    &[0.2, 0.2, 0.0001, 0.35],
];

/// The longest of them.
const LONGEST_S: f64 = 0.5;

fn rover() -> Body {
    Body {
        period_s: 0.2,
        position_noise_m: 0.1,
        heading_noise_rad: 0.02,
        rings: vec![RangeRing {
            bearings_rad: vec![-0.5, 0.0, 0.5],
            range_m: 3.0,
            period_s: 0.1,
            latency_s: 0.0,
        }],
        ..body()
    }
}

/// The times of percepts up to a time.
fn times(pattern: &[f64], until_s: f64) -> Vec<f64> {
    let times = pattern.iter().cycle().scan(0.0, |now_s, apart_s| {
        let this_s = *now_s;
        *now_s += apart_s;
        Some(this_s)
    });
    times.take_while(|time_s| *time_s <= until_s).collect()
}

/// At the origin, with the same range ahead in all rays.
fn facing(range_m: f64, time_s: f64) -> Percept {
    Percept {
        time_s: Some(time_s),
        scans: vec![Scan {
            age_s: Some(0.0),
            ranges_m: vec![range_m; 3],
        }],
        ..percept_at(0.0, 0.0, 0.0)
    }
}

/// The time from which the motions of a brain fulfil a condition, if an obstacle is near until a
/// time and the way is clear from then on.
fn first_s(
    spec: &str,
    pattern: &[f64],
    clear_from_s: f64,
    is_it: impl Fn(Motion) -> bool,
) -> Option<f64> {
    let mut brain = brain(spec, rover());
    let mut found = times(pattern, clear_from_s + 20.0)
        .into_iter()
        .map(|time_s| {
            let range_m = if time_s < clear_from_s { 0.3 } else { 3.0 };
            (time_s, brain.step(&facing(range_m, time_s)).motion)
        });
    let clear = found.by_ref().find(|(time_s, _)| *time_s >= clear_from_s);
    let (clear_s, _) = clear?;
    Some(found.find(|(_, motion)| is_it(*motion))?.0 - clear_s)
}

#[test]
fn hold_times_take_the_same_seconds_at_any_rate_of_percepts() {
    let spec = r#"{"limit_speed_to_stopping_distance": false, "behaviours": [
        {"kind": "cruise", "speed_m_s": 0.3}, {"kind": "avoid", "hold_s": 2.5}]}"#;
    for pattern in PATTERNS {
        let held_s = first_s(spec, pattern, 1.0, |motion| {
            (motion.speed_m_s - 0.3).abs() < 1e-9
        })
        .unwrap();
        assert!((held_s - 2.5).abs() <= LONGEST_S, "{pattern:?}: {held_s} s");
    }
}

#[test]
fn correct_waits_for_the_same_seconds_at_any_rate_of_percepts() {
    let spec = r#"{"limit_speed_to_stopping_distance": false, "behaviours": [
        {"kind": "cruise"}, {"kind": "correct", "waypoints_m": [[0, 9]], "wait_s": 4},
        {"kind": "avoid", "hold_s": 0}]}"#;
    for pattern in PATTERNS {
        let waited_s = first_s(spec, pattern, 1.0, |motion| motion.turn_rate_rad_s != 0.0);
        let waited_s = waited_s.unwrap();
        assert!(
            (waited_s - 4.0).abs() <= LONGEST_S,
            "{pattern:?}: {waited_s} s"
        );
    }
}

#[test]
fn positions_are_broadcast_once_per_second_at_any_rate_of_percepts() {
    for pattern in PATTERNS {
        let mut brain = brain(r#"{"behaviours": [], "beliefs": {}}"#, rover());
        let sent = times(pattern, 120.0)
            .into_iter()
            .flat_map(|time_s| brain.step(&facing(3.0, time_s)).outbox);
        let poses = sent.filter(|message| matches!(message.about, About::Sender { .. }));
        let count = poses.count();
        assert!(
            (115..=125).contains(&count),
            "{pattern:?}: {count} in 120 s"
        );
    }
}

#[test]
fn a_goal_becomes_impossible_after_the_same_seconds_at_any_rate_of_percepts() {
    for pattern in PATTERNS {
        let spec = r#"{"behaviours": [{"kind": "navigate", "waypoints_m": [[9, 0]]}]}"#;
        let mut brain = brain(spec, rover());
        let impossible_s = times(pattern, 60.0).into_iter().find(|time_s| {
            // Something holds the robot.
            brain.step(&Percept {
                motion: now(Motion::default()),
                ..facing(3.0, *time_s)
            });
            let goals = brain.belief_state().unwrap().goals;
            goals.iter().any(|goal| goal.verdict == Verdict::Impossible)
        });
        let impossible_s = impossible_s.unwrap();
        assert!(
            (impossible_s - 30.0).abs() <= 2.0 * LONGEST_S,
            "{pattern:?}: {impossible_s} s"
        );
    }
}

#[test]
fn a_gap_between_percepts_makes_no_goal_impossible() {
    let spec = r#"{"behaviours": [{"kind": "navigate", "waypoints_m": [[9, 0]]}]}"#;
    let mut brain = brain(spec, rover());
    for time_s in [0.0, 0.2, 0.4, 100.4] {
        brain.step(&facing(3.0, time_s));
        let goals = brain.belief_state().unwrap().goals;
        assert!(goals.iter().all(|goal| goal.verdict != Verdict::Impossible));
    }
}

#[test]
fn a_percept_that_is_not_later_changes_nothing_and_repeats_the_last_motion() {
    let spec =
        r#"{"behaviours": [{"kind": "navigate", "waypoints_m": [[3, 9]]}, {"kind": "avoid"}]}"#;
    let mut brain = brain(spec, rover());
    let commands: Vec<_> = (0..20)
        .map(|step| brain.step(&facing(3.0, 0.2 * f64::from(step))))
        .collect();
    let last = commands.last().unwrap();
    assert!(last.motion != Motion::default());
    let before = format!("{brain:?}");
    for time_s in [
        3.8,
        3.0,
        0.0,
        -1e300,
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
    ] {
        let command = brain.step(&facing(0.1, time_s));
        assert_eq!(command.motion, last.motion, "{time_s}");
        assert!(command.outbox.is_empty() && command.requests.is_empty());
        assert_eq!(format!("{brain:?}"), before, "{time_s}");
    }
}

#[test]
fn a_percept_without_a_time_comes_one_period_after_the_last() {
    let spec = r#"{"behaviours": [{"kind": "navigate", "waypoints_m": [[3, 9]]}], "beliefs": {}}"#;
    let (mut timed, mut plain) = (brain(spec, rover()), brain(spec, rover()));
    for step in 0..200 {
        let percept = facing(3.0, 0.2 * f64::from(step));
        let untimed = Percept {
            time_s: None,
            ..percept.clone()
        };
        assert_eq!(timed.step(&percept), plain.step(&untimed));
    }
    assert_eq!(timed.belief_state(), plain.belief_state());
}

/// A body that executes the commands of a brain.
struct Truth {
    at: Point,
    heading_rad: f64,
    speed_m_s: f64,
}

impl Truth {
    fn execute(&mut self, motion: Motion, body: &Body, for_s: f64) {
        const PARTS: u32 = 200;
        let part_s = for_s / f64::from(PARTS);
        let max_change = body.max_acceleration_m_s2 * part_s;
        for _ in 0..PARTS {
            let change = motion.speed_m_s - self.speed_m_s;
            self.speed_m_s += change.clamp(-max_change, max_change);
            let middle_rad = self.heading_rad + motion.turn_rate_rad_s * part_s / 2.0;
            let (y, x) = middle_rad.sin_cos();
            self.at = self.at.plus(Point { x, y }.times(self.speed_m_s * part_s));
            self.heading_rad = wrapped(self.heading_rad + motion.turn_rate_rad_s * part_s);
        }
    }

    fn percept(&self, time_s: f64, motion: Option<Motion>) -> Percept {
        let speed_m_s = self.speed_m_s;
        Percept {
            time_s: Some(time_s),
            motion: motion.and_then(|motion| {
                now(Motion {
                    speed_m_s,
                    ..motion
                })
            }),
            ..percept_at(self.at.x, self.at.y, self.heading_rad)
        }
    }
}

/// The largest error of the pose in stated deviations, for exact percepts with these times between
/// them.
fn max_deviations(apart_s: &[f64], has_wheels: bool, body: &Body) -> f64 {
    let spec = r#"{"behaviours": [{"kind": "navigate", "within_m": 1,
        "waypoints_m": [[8, 2], [-3, 6], [5, -7], [0, 9], [9, 9], [-9, 0]]}]}"#;
    let mut brain: Brain = brain(spec, body.clone());
    let mut truth = Truth {
        at: Point::default(),
        heading_rad: 0.3,
        speed_m_s: 0.0,
    };
    let (mut motion, mut time_s, mut max) = (Motion::default(), 5.0, 0.0_f64);
    for apart_s in apart_s {
        truth.execute(motion, body, *apart_s);
        time_s += apart_s;
        motion = brain
            .step(&truth.percept(time_s, has_wheels.then_some(motion)))
            .motion;
        let pose = brain.belief_state().unwrap().pose.unwrap();
        let off_rad = wrapped(pose.heading_rad - truth.heading_rad).abs();
        max = max
            .max(pose.at.to(truth.at).length() / pose.deviation_m)
            .max(off_rad / pose.deviation_rad);
    }
    max
}

fn blind() -> Body {
    Body {
        rings: Vec::new(),
        ..rover()
    }
}

#[test]
fn the_pose_of_exact_percepts_is_within_a_stated_deviation_at_any_rate() {
    for apart_s in [0.02, 0.1, 0.2, 0.4, 0.5] {
        for has_wheels in [false, true] {
            let max = max_deviations(&[apart_s; 300], has_wheels, &blind());
            // Without wheels, a lag of 0.25 s is assumed at first, and there is none.
            let limit = if has_wheels { 1.0 } else { 1.5 };
            assert!(max < limit, "{apart_s} s apart: {max} deviations");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn the_pose_of_exact_percepts_is_within_few_stated_deviations_at_any_times(
        apart_s in proptest::collection::vec(
            prop_oneof![6 => 0.01_f64..0.6, 1 => 0.6_f64..30.0, 1 => Just(0.2)], 20..120),
        has_wheels: bool,
    ) {
        let max = max_deviations(&apart_s, has_wheels, &blind());
        prop_assert!(max < 4.0, "{max} deviations");
    }
}
