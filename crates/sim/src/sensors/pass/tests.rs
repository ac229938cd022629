//! Passes, compared with closed forms and with simulated ones.

use super::*;
use crate::scenario::{Checked, ScenarioSpec};
use crate::sensors::sensor_kind::AmongKinds;
use crate::simulation::Simulation;
use base::document::Document;
use brain::{AgentId, Command, Motion};
use std::collections::BTreeMap;
use std::sync::Arc;

const SPEED_M_S: f64 = 2.0;

/// Items lie from here to this distance before the end of the world, and are passed as a whole.
const MARGIN_M: f64 = 20.0;
const LENGTH_M: f64 = 1000.0;
const ITEMS: u32 = 20_000;

/// A robot that drives along x in the middle of a strip, with items at lateral distances.
fn scenario(eye: &str, [right_m, left_m]: [f64; 2]) -> Checked {
    let (low, high) = (20.0 + right_m, 20.0 + left_m);
    let text = format!(
        "clock = {{ step_s = 0.1, time_limit_s = 600 }}\nworld = {{ size_m = [{LENGTH_M}, 40] }}\n\
         [items.mine]\ncount = {ITEMS}\nplacement = {{ kind = \"uniform\", within_m = [[{MARGIN_M}, {low}], \
         [{}, {high}]] }}\n[robots.rover]\ncount = 1\nradius_m = 0\nlayer = \"air\"\n\
         start = {{ kind = \"fixed\", at_m = [[0, 20]], heading_deg = [0] }}\n\
         drive = {{ max_speed_m_s = {SPEED_M_S}, max_turn_rate_deg_s = 90 }}\nbrain = {{ behaviours = [] }}\n\
         [robots.rover.sensors.eye]\nkind = \"items\"\nneeds_line_of_sight = false\n{eye}\n",
        LENGTH_M - MARGIN_M,
    );
    let document = Document::parse("t", &text).unwrap();
    ScenarioSpec::read(&document).unwrap_or_else(|errors| panic!("{errors}"))
}

fn pass(checked: &Checked) -> Pass {
    let sensor = &checked.spec.robots["rover"].sensors["eye"];
    let items = items_of(checked);
    let always = Detection::Constant(1.0);
    let detection = items.detection_probability.as_ref();
    let path = Path {
        speed_m_s: SPEED_M_S,
        period_s: sensor.rate_hz.map_or(0.1, |rate_hz| 1.0 / rate_hz),
        dropout_probability: sensor.dropout_probability,
    };
    Pass::new(items, detection.map_or(&always, |each| &each["mine"]), path)
}

/// The share of items that a simulated pass detects.
fn simulated(checked: &Checked) -> f64 {
    let scenario = Arc::new(checked.scenario.clone());
    let mut simulation = Simulation::new(scenario, 1, 0).unwrap();
    let motion = Motion {
        speed_m_s: SPEED_M_S,
        turn_rate_rad_s: 0.0,
    };
    let forward = Command {
        motion,
        ..Command::default()
    };
    for _ in 0..5000 {
        let commands = BTreeMap::from([(AgentId::robot(0, 0), forward.clone())]);
        if simulation.step_with(BTreeMap::new(), commands).is_err() {
            break;
        }
    }
    f64::from(simulation.outcome().found[0]) / f64::from(ITEMS)
}

/// Within 5.5 standard errors, which a correct simulator exceeds for one seed in 26 million, and 0.002 for the
/// numerical integration.
fn assert_near(found: f64, expected: f64, case: &str) {
    let error = (expected * (1.0 - expected) / f64::from(ITEMS)).sqrt();
    assert!(
        (found - expected).abs() < 5.5 * error + 0.002,
        "{case}: simulated {found}, computed {expected}"
    );
}

const SENSORS: [&str; 6] = [
    "range_m = 3\ndetection_probability = { mine = 0.1 }",
    "range_m = 5\nfov_deg = 90\ndetection_probability = { mine = { peak = 0.3, half_range_m = 2 } }",
    "range_m = 4\nfov_deg = 60\nfacing_deg = 90\nrate_hz = 2\ndetection_probability = { mine = 0.4 }",
    "range_m = 3\nrate_hz = 0.5\ndetection_probability = { mine = [[0, 1], [3, 0.2]] }",
    "range_m = 6\nfov_deg = 120\nfacing_deg = -130\nrate_hz = 1",
    "range_m = 2\nrate_hz = 0.25",
];

#[test]
fn a_simulated_pass_detects_the_computed_shares() {
    for eye in SENSORS {
        let checked = scenario(eye, [0.0, 1.0]);
        let looks = Looks {
            sector: Sector::new(&items_of(&checked).sector),
            detection: &Detection::Constant(1.0),
            path: Path {
                speed_m_s: 1.0,
                period_s: 1.0,
                dropout_probability: 0.0,
            },
        };
        let expected = pass(&checked);
        let swath = scenario(eye, looks.lateral_range_m());
        assert_near(simulated(&swath), expected.in_swath, eye);
        let path = scenario(eye, [-1e-6, 1e-6]);
        assert_near(simulated(&path), expected.on_path, eye);
    }
}

fn items_of(checked: &Checked) -> &ItemsSpec {
    let measures = &checked.spec.robots["rover"].sensors["eye"].measures;
    ItemsSpec::of(measures).expect("a detector of items")
}

#[test]
fn dropouts_count_as_misses() {
    let with = |lines: &str| pass(&scenario(&format!("range_m = 3\n{lines}"), [0.0, 1.0]));
    let dropped = with("detection_probability = { mine = 0.2 }\ndropout_probability = 0.5");
    assert_eq!(dropped, with("detection_probability = { mine = 0.1 }"));
}

#[test]
fn a_certain_sensor_detects_what_it_looks_at_once() {
    // A measurement every 8 m observes 4 m of the path, and a disc of 2 m of the swath of 8 m x 4 m.
    let pass = pass(&scenario("range_m = 2\nrate_hz = 0.25", [0.0, 1.0]));
    assert!((pass.on_path - 0.5).abs() < 0.02, "{pass:?}");
    let disc = std::f64::consts::PI * 4.0 / 32.0;
    assert!((pass.in_swath - disc).abs() < 0.02, "{pass:?}");
    assert!((pass.swath_m - 4.0).abs() < 1e-12);
}

#[test]
fn looks_at_a_constant_probability_miss_as_independent_draws() {
    // 6 m at 2 m/s and 10 looks a second are 30 looks.
    let pass = pass(&scenario(
        "range_m = 3\ndetection_probability = { mine = 0.1 }",
        [0.0, 1.0],
    ));
    let expected = 1.0 - 0.9_f64.powi(30);
    assert!(
        (pass.on_path - expected).abs() < 0.003,
        "{pass:?} {expected}"
    );
}
