//! Bayesian search compared with lanes, for perfect and imperfect detection.
//!
//! A file contains the times of 1,000 worlds. The test repeats some of them; the claims are based on
//! all of them.

use crate::rows::published;
use crate::setup::{list, run, scenario};
use base::document::{Node, Table, Value};
use rayon::prelude::*;
use std::fmt::Write;

const TEXT: &str = include_str!("../../../../scenarios/search-beliefs.toml");
const FILE: &str = "belief-search.csv";

const WORLDS: u64 = 1000;

/// The number of worlds that the test repeats.
const REPEATED: u64 = 10;

/// Half-width of a 99% interval, in standard errors.
const Z99: f64 = 2.576;

/// Detection probability of a camera in percent, and time limit in seconds.
const CAMERAS: [(u8, f64); 3] = [(100, 600.0), (30, 600.0), (10, 2400.0)];

const BY: [&str; 2] = ["lawnmower", "bayesian_search"];

/// Durations of the searches of a world in seconds, grouped by camera.
type Times = [f64; 2 * CAMERAS.len()];

fn behaviour(kind: &str) -> Value {
    let node = Node {
        value: Value::Text(kind.to_owned()),
        origin: "the check".to_owned(),
    };
    Value::Table(Table::from([("kind".to_owned(), node)]))
}

/// Durations in the first `worlds` worlds.
fn times_s(worlds: u64, (percent, time_limit_s): (u8, f64), search: &str) -> Vec<f64> {
    let sensor = |path, value| (path, Value::Float(value));
    let changes = [
        sensor("clock.time_limit_s", time_limit_s),
        sensor("robots.rover.sensors.camera.dropout_probability", 0.0),
        sensor("robots.rover.sensors.camera.noise_m", 0.0),
        sensor(
            "robots.rover.sensors.camera.detection_probability.mine",
            f64::from(percent) / 100.0,
        ),
        sensor("robots.rover.sensors.gps.noise_m", 0.0),
        sensor("robots.rover.sensors.compass.noise_deg", 0.0),
        (
            "robots.rover.brain.behaviours",
            list([search, "return_home", "avoid"].map(behaviour)),
        ),
    ];
    let scenario = scenario(TEXT, &changes);
    let time_s = |number| run(&scenario, 1, number).finish().time_s;
    (0..worlds).into_par_iter().map(time_s).collect()
}

fn measured(worlds: u64) -> Vec<Times> {
    let of_camera = |camera| BY.map(|search| times_s(worlds, camera, search));
    let each: Vec<Vec<f64>> = CAMERAS.into_iter().flat_map(of_camera).collect();
    let of_world = |world| std::array::from_fn(|search| each[search][world]);
    (0..each[0].len()).map(of_world).collect()
}

fn written(times: &[Times]) -> String {
    let name = |(percent, _)| BY.map(|search| format!("{percent}_{search}_s"));
    let names: Vec<String> = CAMERAS.into_iter().flat_map(name).collect();
    let mut text = format!("world,{}\n", names.join(","));
    for (world, times) in times.iter().enumerate() {
        let cells = times.map(|time_s| format!("{time_s:.1}"));
        writeln!(text, "{world},{}", cells.join(",")).unwrap();
    }
    text
}

fn read(text: &str) -> Vec<Times> {
    let times = |line: &str| {
        let mut cells = line.split(',').skip(1).map(|cell| cell.parse().unwrap());
        std::array::from_fn(|_| cells.next().unwrap())
    };
    text.lines().skip(1).map(times).collect()
}

/// The ratio of the mean durations of two searches of the same worlds, between the bounds of its 99%
/// interval.
fn ratio(times: &[Times], [slow, fast]: [usize; 2]) -> [f64; 3] {
    let count = f64::from(u32::try_from(times.len()).unwrap());
    let sum = |search: usize| times.iter().map(|times| times[search]).sum::<f64>();
    let ratio = sum(fast) / sum(slow);
    let off = times.iter().map(|times| times[fast] - ratio * times[slow]);
    let squares: f64 = off.map(|off| off * off).sum();
    let error = (squares * count / (count - 1.0)).sqrt() / sum(slow);
    [ratio - Z99 * error, ratio, ratio + Z99 * error]
}

#[test]
fn bayesian_search_is_faster_than_lanes_for_any_detection_probability() {
    let all = published(FILE, || written(&measured(WORLDS)));
    let repeated = written(&measured(REPEATED));
    assert!(
        all.starts_with(&repeated),
        "docs/validation/{FILE} differs from the simulator's results: run `make validation`"
    );
    let times = read(&all);
    assert_eq!(times.len(), 1000);
    for (camera, (percent, _)) in CAMERAS.into_iter().enumerate() {
        let [.., high] = ratio(&times, [2 * camera, 2 * camera + 1]);
        assert!(high < 1.0, "{percent}%: at most {high}");
    }
}
