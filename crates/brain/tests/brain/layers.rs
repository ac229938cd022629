//! Layers of subsumption: what a layer that is not active leaves as it is, and how long `correct` waits
//! after `avoid`.

use crate::{body, brain, now, percept_at};
use base::geometry::Point;
use brain::{Body, Brain, Motion, Percept, RangeRing, Reading, Scan};
use proptest::prelude::*;

fn rover() -> Body {
    let ring = RangeRing {
        bearings_rad: vec![-0.5, 0.0, 0.5],
        range_m: 3.0,
        period_s: 0.1,
        latency_s: 0.0,
    };
    Body {
        max_reverse_speed_m_s: 0.5,
        rings: vec![ring],
        ..body()
    }
}

/// Behaviours with further keys of a brain.
fn layers(behaviours: &[&str], rest: &str) -> Brain {
    let spec = format!(r#"{{"behaviours": [{}]{rest}}}"#, behaviours.join(", "));
    brain(&spec, rover())
}

const CRUISE: &str = r#"{"kind": "cruise", "speed_m_s": 0.6}"#;
const CORRECT: &str =
    r#"{"kind": "correct", "waypoints_m": [[4, 3], [-2, 5], [0, 0]], "wait_s": 0.5}"#;
const IDLE: &str = r#"{"kind": "correct", "waypoints_m": []}"#;
const AVOID: &str = r#"{"kind": "avoid", "near_m": 0.2, "hold_s": 1}"#;
const BRIEF_AVOID: &str = r#"{"kind": "avoid", "hold_s": 0}"#;
const REST: [&str; 3] = [
    "",
    r#", "beliefs": {}"#,
    r#", "limit_speed_to_stopping_distance": false, "arbitration": {"kind": "goals"}"#,
];

/// Seldom near enough for `avoid`, mostly far, and sometimes without a return.
fn range_m() -> impl Strategy<Value = f64> {
    prop_oneof![1 => 0.0_f64..0.6, 100 => 0.6_f64..3.0, 50 => Just(f64::INFINITY)]
}

fn reading<T: std::fmt::Debug + 'static>(
    value: impl Strategy<Value = T>,
) -> impl Strategy<Value = Option<Reading<T>>> {
    let reading = (value, prop_oneof![4 => Just(0.0), 1 => 0.0_f64..2.0]);
    let reading = reading.prop_map(|(value, age_s)| Reading { value, age_s });
    proptest::option::weighted(0.9, reading)
}

/// A percept, and the time since the one before.
fn percept() -> impl Strategy<Value = (f64, Percept)> {
    let place = (-6.0_f64..6.0, -6.0_f64..6.0).prop_map(|(x, y)| Point { x, y });
    let motion = (-0.5_f64..1.0, -1.5_f64..1.5).prop_map(|(speed_m_s, turn_rate_rad_s)| Motion {
        speed_m_s,
        turn_rate_rad_s,
    });
    let ranges_m = proptest::collection::vec(range_m(), 3);
    let readings = (reading(place), reading(-4.0_f64..4.0), reading(motion));
    let touch = reading(prop_oneof![60 => Just(false), 1 => Just(true)]);
    let apart_s = prop_oneof![6 => Just(0.1), 2 => 0.01_f64..0.5, 1 => Just(0.0)];
    (readings, touch, ranges_m, any::<[u32; 4]>(), apart_s).prop_map(
        |((position, heading_rad, motion), touch, ranges_m, random_words, apart_s)| {
            let scans = vec![Scan {
                age_s: Some(0.0),
                ranges_m,
            }];
            let percept = Percept {
                position,
                heading_rad,
                motion,
                touch,
                scans,
                random_words,
                ..Percept::default()
            };
            (apart_s, percept)
        },
    )
}

fn percepts() -> impl Strategy<Value = Vec<Percept>> {
    proptest::collection::vec(percept(), 1..120).prop_map(|percepts| {
        let mut time_s = 0.0;
        let timed = percepts.into_iter().map(|(apart_s, percept)| {
            time_s += apart_s;
            let time_s = Some(time_s);
            Percept { time_s, ..percept }
        });
        timed.collect()
    })
}

/// The number of percepts before the upper layer is active first. Until then, both brains give the
/// same commands.
fn same_until_active(
    mut without: Brain,
    mut with: Brain,
    percepts: &[Percept],
) -> Result<usize, TestCaseError> {
    let upper = u32::try_from(without.spec().behaviours.len()).unwrap();
    for (number, percept) in percepts.iter().enumerate() {
        if with.decision(percept).leading == Some(upper) {
            return Ok(number);
        }
        prop_assert_eq!(without.step(percept), with.step(percept));
    }
    Ok(percepts.len())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn an_inactive_upper_layer_leaves_every_command_as_it_is_without_that_layer(
        percepts in percepts(), rest in prop::sample::select(&REST[..]),
    ) {
        let without = layers(&[CRUISE, CORRECT], rest);
        same_until_active(without, layers(&[CRUISE, CORRECT, AVOID], rest), &percepts)?;
    }

    #[test]
    fn a_layer_without_waypoints_leaves_every_command_as_it_is_without_that_layer(
        percepts in percepts(), rest in prop::sample::select(&REST[..]),
    ) {
        let (without, with) = (layers(&[CRUISE], rest), layers(&[CRUISE, IDLE], rest));
        prop_assert_eq!(same_until_active(without, with, &percepts)?, percepts.len());
    }
}

#[test]
fn the_percepts_of_these_properties_reach_all_layers() {
    use proptest::strategy::ValueTree;
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let mut steps = [0_usize; 3];
    for _ in 0..50 {
        let mut brain = layers(&[CRUISE, CORRECT, AVOID], "");
        for percept in percepts().new_tree(&mut runner).unwrap().current() {
            if let Some(active) = brain.decision(&percept).leading {
                steps[active as usize] += 1;
            }
            brain.step(&percept);
        }
    }
    assert!(steps.iter().all(|steps| *steps > 100), "{steps:?}");
}

/// A robot at the origin that something holds or that has nothing to do: it stands, whatever its
/// command.
fn standing(time_s: f64, heading_rad: f64, range_m: f64, is_held: bool) -> Percept {
    Percept {
        time_s: Some(time_s),
        motion: now(Motion::default()),
        touch: now(is_held),
        scans: vec![Scan {
            age_s: Some(0.0),
            ranges_m: vec![range_m; 3],
        }],
        ..percept_at(0.0, 0.0, heading_rad)
    }
}

/// Range of an obstacle that approaches within 2 s, is near for 1 s, and leaves within 2 s.
fn passing_m(since_near_s: f64) -> f64 {
    let away_s = (since_near_s - 0.5).abs() - 0.5;
    3.0_f64.min(0.3 + 1.35 * away_s.max(0.0))
}

/// How long after `avoid` was last active `correct` is active first, if an obstacle is near from
/// these times on while the robot stands.
fn waited_s(
    (behaviours, rest): (&[&str], &str),
    period_s: f64,
    passes_s: &[f64],
    is_held: bool,
) -> Option<f64> {
    let mut brain = layers(behaviours, rest);
    let [correct, avoid] = ["correct", "avoid"].map(|name| {
        let mut names = behaviours.iter();
        let place = names.position(|behaviour| behaviour.contains(name));
        u32::try_from(place.unwrap()).unwrap()
    });
    let mut active_s = None;
    let times_s = (0..).map(|step| f64::from(step) * period_s);
    for time_s in times_s.take_while(|time_s| *time_s < 60.0) {
        let passes = passes_s.iter();
        let range_m = passes
            .map(|near_s| passing_m(time_s - near_s))
            .fold(3.0, f64::min);
        // On its course until something has come near; then 1 rad off.
        let heading_rad = if active_s.is_some() { 1.0 } else { 0.0 };
        let percept = standing(time_s, heading_rad, range_m, is_held && range_m < 0.5);
        let leading = brain.decision(&percept).leading;
        let motion = brain.step(&percept).motion;
        if leading == Some(avoid) {
            active_s = Some(time_s);
        } else if leading == Some(correct) {
            assert!(motion.turn_rate_rad_s < 0.0, "{motion:?}");
            return active_s.map(|active_s| time_s - active_s);
        }
    }
    None
}

#[test]
fn correct_waits_after_an_obstacle_that_approaches_while_the_robot_stands() {
    for (wait_s, avoid) in [
        (0.0, AVOID),
        (1.0, BRIEF_AVOID),
        (5.0, AVOID),
        (5.0, BRIEF_AVOID),
    ] {
        let correct =
            format!(r#"{{"kind": "correct", "waypoints_m": [[9, 0]], "wait_s": {wait_s:?}}}"#);
        for (behaviours, rest) in [
            (&[CRUISE, &correct, avoid][..], REST[0]),
            (&[&correct, avoid], REST[0]),
            (&[CRUISE, &correct, avoid], REST[1]),
            (&[CRUISE, &correct, avoid], REST[2]),
        ] {
            check_wait((behaviours, rest), wait_s);
        }
    }
}

fn check_wait(spec: (&[&str], &str), wait_s: f64) {
    for (period_s, is_held) in [(0.1, false), (0.1, true), (0.05, false), (0.3, false)] {
        for passes_s in [&[4.0][..], &[4.0, 9.0], &[4.0, 9.0, 14.0]] {
            let late_s = waited_s(spec, period_s, passes_s, is_held).unwrap() - wait_s;
            let case = format!("{spec:?} {period_s} {is_held} {passes_s:?}");
            assert!(
                (-1e-9..=2.0 * period_s).contains(&late_s),
                "{late_s} {case}"
            );
        }
    }
}
