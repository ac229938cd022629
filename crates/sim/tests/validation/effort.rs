//! Search effort with a detector that misses: at random, and in lanes (equation 4 of D. W. Gage's
//! *Measuring Search Effectiveness*). The effort is the area that all robots sweep, with
//! multiplicity and relative to the searched area.

use crate::rows::{Row, assert_published, assert_right, assert_wrong};
use crate::setup::{
    Random, found, list, moving, places, robots, run, scenario, step, turning, whole,
};
use base::document::Value;
use base::geometry::Point;
use brain::Command;
use rayon::prelude::*;
use sim::simulation::Simulation;
use std::f64::consts::{FRAC_PI_2, PI};

const AT_RANDOM: &str = include_str!("../../../../docs/validation/effort-random.toml");
const IN_LANES: &str = include_str!("../../../../docs/validation/effort-lanes.toml");

const DETECTION: &str = "robots.searcher.sensors.eye.detection_probability.target";
const RANGE_M: f64 = 0.5;
const STEP_S: f64 = 0.1;

/// Distance between measurements. It is the range, so an item is in range of at most two of a pass.
const APART_M: f64 = 0.5;

/// Probabilities of detection per measurement; per pass they are 0.42 and 0.72.
const FAINT: f64 = 0.3;
const CLEAR: f64 = 0.6;

/// Runs at random, whose shares have a standard deviation of about 0.02, and in lanes.
const AT_RANDOM_RUNS: u64 = 80;
const IN_LANES_RUNS: u64 = 40;

/// Numbers of passes in lanes with which a random search is compared.
const COMPARED: [f64; 4] = [0.5, 1.0, 1.5, 2.0];

/// Passes in lanes, and the parts of each.
const PASSES: usize = 2;
const PARTS: u32 = 4;

/// The field of the random search, and its robots and items.
const FIELD_M2: f64 = 3600.0;
const SEARCHERS: f64 = 200.0;
const SCATTERED: f64 = 500.0;

/// The formation: its robots, the number of items, and the zone where they are.
const FORMATION: u32 = 41;
const ITEMS: f64 = 1000.0;
const ZONE_M: [f64; 2] = [10.0, 50.0];

/// Probability that a pass detects an item at a random distance from the path: an item whose chord
/// of the range has the length c is measured once or twice, twice with probability c / `APART_M` - 1;
/// if c is less than `APART_M`, once with probability c / `APART_M`.
fn pass(detection: f64) -> f64 {
    let slices = 10_000;
    let of_slice = |slice: u32| {
        let aside_m = RANGE_M * (f64::from(slice) + 0.5) / f64::from(slices);
        let chord_m = 2.0 * (RANGE_M * RANGE_M - aside_m * aside_m).sqrt();
        let looks = chord_m / APART_M;
        let twice = (looks - 1.0).max(0.0);
        let once = looks.min(1.0) - twice;
        once * detection + twice * (1.0 - (1.0 - detection).powi(2))
    };
    (0..slices).map(of_slice).sum::<f64>() / f64::from(slices)
}

/// Effort of a random search that finds as much as a number of passes in lanes.
fn random_effort(passes: f64, pass: f64) -> f64 {
    passes * -(1.0 - pass).ln() / pass
}

/// Share that straight paths of a length find, also by the measurement at the start.
fn by_paths(length_m: f64, detection: f64) -> f64 {
    let swept_m2 = 2.0 * RANGE_M * length_m * pass(detection) + detection * PI * RANGE_M * RANGE_M;
    1.0 - (1.0 - swept_m2 / FIELD_M2).powf(SEARCHERS)
}

/// A random search, at the efforts that find as much as whole passes in lanes.
fn at_random(series: &str, detection: f64, expected: f64) -> Vec<Row> {
    let scenario = scenario(AT_RANDOM, &[(DETECTION, Value::Float(detection))]);
    let steps = COMPARED.map(|passes| {
        let effort = random_effort(passes, pass(expected));
        let length_m = effort * FIELD_M2 / (2.0 * RANGE_M * SEARCHERS);
        let is_enough = |step: &u32| f64::from(*step) * APART_M >= length_m;
        (1..1000).find(is_enough).unwrap()
    });
    let search = |number| {
        let mut simulation = run(&scenario, 1, number);
        let mut done = 0;
        steps.map(|last| {
            // One more, because the measurement of a step is at its start.
            (done..=last).for_each(|_| simulation.step());
            done = last + 1;
            f64::from(found(&simulation)) / SCATTERED
        })
    };
    let searches: Vec<[f64; COMPARED.len()]> =
        (0..AT_RANDOM_RUNS).into_par_iter().map(search).collect();
    let row = |place: usize| {
        let length_m = f64::from(steps[place]) * APART_M;
        let effort = 2.0 * RANGE_M * length_m * SEARCHERS / FIELD_M2;
        let shares: Vec<f64> = searches.iter().map(|shares| shares[place]).collect();
        let expected = by_paths(length_m, expected);
        Row::mean(series, effort, &shares, Some(expected))
    };
    (0..COMPARED.len()).map(row).collect()
}

/// A formation of robots side by side.
struct Formation {
    simulation: Simulation,
    random: Random,
    /// Distance of the first lane from the border.
    offset_m: f64,
    /// 1 towards larger x, -1 towards smaller x.
    way: f64,
}

impl Formation {
    fn new(detection: f64, number: u64) -> Self {
        let mut random = Random::of_run(number);
        let offset_m = random.unit();
        let lane = |lane: u32| Point {
            x: 5.0,
            y: f64::from(lane) + offset_m,
        };
        let start = "robots.searcher.start";
        let ahead = list((0..FORMATION).map(|_| Value::Float(0.0)));
        let changes = [
            (DETECTION, Value::Float(detection)),
            ("robots.searcher.count", whole(FORMATION)),
            (&format!("{start}.at_m"), places((0..FORMATION).map(lane))),
            (&format!("{start}.heading_deg"), ahead),
        ];
        Self {
            simulation: run(&scenario(IN_LANES, &changes), 1, number),
            random,
            offset_m,
            way: 1.0,
        }
    }

    fn all(&mut self, command: &Command) {
        let ids = robots(&self.simulation).into_iter().map(|robot| robot.id);
        let commands = ids.map(|id| (id, command.clone())).collect();
        step(&mut self.simulation, commands);
    }

    fn drive(&mut self, by_m: f64) {
        self.all(&moving(by_m / STEP_S, 0.0));
    }

    /// Turns back in the margin, to lanes with another random offset: otherwise an item would be as
    /// far from its lane in every pass, and passes would not be independent.
    fn turn_back(&mut self) {
        let offset_m = self.random.unit();
        let aside_m = offset_m - self.offset_m;
        let turn = turning(FRAC_PI_2 * self.way * aside_m.signum(), STEP_S);
        self.all(&turn);
        self.drive(aside_m.abs() / 2.0);
        self.drive(aside_m.abs() / 2.0);
        self.all(&turn);
        self.offset_m = offset_m;
        self.way = -self.way;
    }

    /// The covered fraction of the zone and the share found, after each part of a pass.
    fn pass(&mut self) -> [[f64; 2]; PARTS as usize] {
        // Measurements of each pass have another phase, for the same reason.
        let phase = self.random.unit();
        self.drive(phase * APART_M);
        let mut part = 0;
        [(); PARTS as usize].map(|()| {
            part += 1;
            let covered = self.cover(f64::from(part) / f64::from(PARTS));
            [covered, f64::from(found(&self.simulation)) / ITEMS]
        })
    }

    /// Drives until this fraction of the zone is covered; returns the covered fraction.
    fn cover(&mut self, fraction: f64) -> f64 {
        let size_m = ZONE_M[1] - ZONE_M[0];
        // All of it is covered when no item is in range.
        let margin_m = if fraction < 1.0 { 0.0 } else { 2.0 };
        loop {
            let x_m = robots(&self.simulation)[0].at.x;
            let entered_m = if self.way > 0.0 {
                x_m - ZONE_M[0]
            } else {
                ZONE_M[1] - x_m
            };
            if entered_m >= fraction * size_m + margin_m {
                // The last measurement was a step ago, and covers half a step ahead.
                return ((entered_m - APART_M / 2.0) / size_m).min(1.0);
            }
            self.drive(APART_M);
        }
    }
}

/// Passes in lanes, with the shares that `law` expects of the number of passes and their detection.
fn in_lanes(series: &str, detection: f64, law: impl Fn(f64) -> f64) -> Vec<Row> {
    let search = |number| {
        let mut formation = Formation::new(detection, number);
        [(); PASSES].map(|()| {
            let parts = formation.pass();
            formation.turn_back();
            parts
        })
    };
    let searches: Vec<_> = (0..IN_LANES_RUNS).into_par_iter().map(search).collect();
    let row = |pass: usize, part: usize| {
        let done = [0.0, 1.0][pass];
        let each = searches.iter().map(|search| search[pass][part]);
        let (efforts, shares): (Vec<f64>, Vec<f64>) =
            each.map(|[covered, found]| (done + covered, found)).unzip();
        let effort = Row::mean("", 0.0, &efforts, None).measured;
        Row::mean(series, effort, &shares, Some(law(effort)))
    };
    let parts = |pass| (0..PARTS as usize).map(move |part| row(pass, part));
    (0..PASSES).flat_map(parts).collect()
}

/// 1 - (1 - p)^S at whole passes, linear between them.
fn lanes(effort: f64, pass: f64) -> f64 {
    let whole = effort.floor();
    1.0 - (1.0 - pass).powf(whole) * (1.0 - pass * (effort - whole))
}

#[test]
fn random_search_and_lanes_find_as_much_at_efforts_in_the_ratio_of_gage() {
    let all = [
        at_random("at random (p = 0.42)", FAINT, FAINT),
        in_lanes("in lanes (p = 0.42)", FAINT, |effort| {
            lanes(effort, pass(FAINT))
        }),
        at_random("at random (p = 0.72)", CLEAR, CLEAR),
        in_lanes("in lanes (p = 0.72)", CLEAR, |effort| {
            lanes(effort, pass(CLEAR))
        }),
    ];
    let all = all.concat();
    assert_published("search-effort.csv", &all);
    assert_right(&all);
    for (passes, pass) in [(1.0, pass(FAINT)), (2.0, pass(CLEAR))] {
        let at_random = 1.0 - (-pass * random_effort(passes, pass)).exp();
        assert!((at_random - lanes(passes, pass)).abs() < 1e-12);
    }
}

#[test]
fn a_detection_probability_5_percent_off_is_detected_at_random_and_in_lanes() {
    assert_wrong(&at_random("", 0.95 * CLEAR, CLEAR));
    let law = |effort| lanes(effort, pass(CLEAR));
    assert_wrong(&in_lanes("", 0.95 * CLEAR, law));
}

/// The wrong model is the random search's law for lanes.
#[test]
fn lanes_do_not_follow_the_law_of_random_search() {
    let law = |effort: f64| 1.0 - (-pass(CLEAR) * effort).exp();
    assert_wrong(&in_lanes("", CLEAR, law));
}
