//! External bodies among simulated robots: what their virtual sensors measure, and what others perceive of them.

use crate::common::{go, robots, scenario, start};
use base::geometry::Point;
use brain::{AgentId, Motion, Percept, Reading, Scan};
use sim::bodies::external::{ExternalSpec, ReadingSource};
use sim::simulation::{Simulation, StepInputs};
use std::collections::BTreeMap;

/// A real robot, and a simulated one of the same kind that it faces.
const TWO: &str = r#"
clock = { step_s = 0.1, time_limit_s = 1000 }
world = { size_m = [40, 20] }
items.mine = { count = 1, placement = { kind = "fixed", at_m = [[12, 10.5]] } }
[robots.rover]
count = 2
radius_m = 0.3
start = { kind = "fixed", at_m = [[10, 10], [14, 10]], heading_deg = [0, 180] }
drive = { max_speed_m_s = 1, max_turn_rate_deg_s = 90 }
sensors.sonar = { kind = "range", rays = 8, range_m = 6 }
sensors.eye = { kind = "robots", range_m = 6 }
sensors.finder = { kind = "items", range_m = 3 }
sensors.gps = { kind = "position" }
sensors.compass = { kind = "heading" }
"#;

const REAL: AgentId = AgentId::robot(0, 0);
const OTHER: AgentId = AgentId::robot(0, 1);

const ALL: [&str; 3] = ["sonar", "eye", "finder"];

fn now<T>(value: T) -> Option<Reading<T>> {
    Some(Reading { value, age_s: 0.0 })
}

fn at(x: f64, y: f64, time_s: f64) -> Percept {
    Percept {
        time_s: Some(time_s),
        position: now(Point { x, y }),
        heading_rad: now(0.0),
        ..Percept::default()
    }
}

fn spec(sensors: &[&str], source: ReadingSource) -> ExternalSpec {
    let sensors = sensors.iter().map(|name| ((*name).to_owned(), source));
    ExternalSpec {
        sensors: sensors.collect(),
        ..ExternalSpec::default()
    }
}

fn mixed(text: &str, spec: ExternalSpec) -> Simulation {
    start(text).with_external([(REAL, spec)]).unwrap()
}

/// One step with a percept of the real robot; returns what its virtual sensors measured.
fn measured(simulation: &mut Simulation, percept: Percept) -> Percept {
    let percepts = BTreeMap::from([(REAL, percept)]);
    let stay = BTreeMap::from([(OTHER, go(0.0, 0.0))]);
    simulation.step_with(percepts, stay).unwrap();
    simulation
        .perceived(REAL)
        .unwrap()
        .unwrap()
        .measured
        .clone()
}

/// One step in which the real robot is observed, and its brain does not step.
fn observe(simulation: &mut Simulation, percept: Percept) {
    let inputs = StepInputs {
        observed: BTreeMap::from([(REAL, percept)]),
        commands: BTreeMap::from([(OTHER, go(0.0, 0.0))]),
        ..StepInputs::default()
    };
    let begun = simulation.begin_step(inputs, &[]).unwrap();
    assert!(simulation.finish_step(begun).is_empty());
}

#[test]
fn virtual_sensors_measure_what_those_of_a_simulated_robot_measure_there() {
    let simulated = start(TWO).percept(REAL).unwrap().unwrap();
    let mut simulation = mixed(TWO, spec(&ALL, ReadingSource::Virtual));
    let real = measured(&mut simulation, at(10.0, 10.0, 0.0));
    assert_eq!(real.scans, simulated.scans);
    assert_eq!(real.neighbours, simulated.neighbours);
    assert_eq!(real.contacts, simulated.contacts);
    assert_eq!((real.neighbours.len(), real.contacts.len()), (1, 1));
    // What its virtual sensors detect counts as found.
    assert_eq!(simulation.outcome().found, [1]);
}

#[test]
fn sensors_that_are_not_virtual_measure_nothing() {
    let mut simulation = mixed(TWO, ExternalSpec::default());
    let real = measured(&mut simulation, at(10.0, 10.0, 0.0));
    assert_eq!(real, Percept::default());
}

#[test]
fn the_noise_of_a_virtual_sensor_is_that_of_the_sensor_and_of_the_pose() {
    let text = TWO
        .replace(
            "range_m = 6 }\nsensors.eye",
            "range_m = 6, noise_m = 0.2 }\nsensors.eye",
        )
        .replace(
            "{ kind = \"position\" }",
            "{ kind = \"position\", noise_m = 0.3 }",
        );
    // Without a heading, the pose is unknown, and its error that of the position sensor.
    let mut simulation = mixed(&text, spec(&ALL, ReadingSource::Virtual));
    let neighbours = (0..4000_u32).map(|step| {
        let percept = Percept {
            heading_rad: None,
            ..at(10.0, 10.0, 0.1 * f64::from(step))
        };
        measured(&mut simulation, percept).neighbours[0].range_m
    });
    let ways_m: Vec<f64> = neighbours.collect();
    let deviation_m = deviation(&ways_m);
    // Along the way to the other robot, with an exact detector: the standard error of 4000 is 1.1%.
    assert!((deviation_m / 0.3 - 1.0).abs() < 0.05, "{deviation_m}");
}

fn deviation(values: &[f64]) -> f64 {
    #[expect(clippy::cast_precision_loss, reason = "some thousands")]
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let squares = values.iter().map(|value| (value - mean) * (value - mean));
    (squares.sum::<f64>() / (count - 1.0)).sqrt()
}

/// A wall beside the real robot, with the other one behind it.
const WALL: &str = "world = { size_m = [40, 20], obstacles = [{ rectangle = { at_m = [10.45, 10], size_m = [0.1, 20] } }] }";

#[test]
fn nothing_is_seen_through_walls_whatever_the_error_of_the_pose() {
    let text = TWO.replace("world = { size_m = [40, 20] }", WALL).replace(
        "{ kind = \"position\" }",
        "{ kind = \"position\", noise_m = 1 }",
    );
    let mut simulation = mixed(&text, spec(&ALL, ReadingSource::Virtual));
    for step in 0..2000_u32 {
        let percept = Percept {
            heading_rad: None,
            ..at(10.0, 10.0, 0.1 * f64::from(step))
        };
        let real = measured(&mut simulation, percept);
        assert!(real.neighbours.is_empty() && real.contacts.is_empty());
        // The farthest place in front of the wall is 0.4 m and three deviations away from it.
        assert!(real.scans[0].ranges_m[0] < 6.0, "{:?}", real.scans[0]);
    }
}

#[test]
fn a_body_that_is_believed_to_be_in_an_obstacle_sees_its_faces_from_outside() {
    let wide = WALL.replace(
        "at_m = [10.45, 10], size_m = [0.1, 20]",
        "at_m = [11.1, 10], size_m = [1.2, 20]",
    );
    let text = TWO
        .replace("[[12, 10.5]]", "[[13, 10.5]]")
        .replace("world = { size_m = [40, 20] }", &wide);
    let mut simulation = mixed(&text, spec(&ALL, ReadingSource::Virtual));
    let real = measured(&mut simulation, at(10.6, 10.0, 0.0));
    assert!(real.scans[0].ranges_m[0] < 0.1, "{:?}", real.scans[0]);
    assert!(real.neighbours.is_empty());
}

fn scan(age_s: Option<f64>, range_m: f64) -> Vec<Scan> {
    vec![Scan {
        age_s,
        ranges_m: if age_s.is_some() {
            vec![range_m; 8]
        } else {
            Vec::new()
        },
    }]
}

/// The commanded motion of a robot that avoids what its sonar measures, for a real scan.
fn commanded(source: Option<ReadingSource>, scans: Vec<Scan>) -> Motion {
    let text = TWO.to_owned()
        + "brain.behaviours = [{ kind = \"cruise\" }, { kind = \"avoid\", near_m = 1 }]\n";
    let sources = source.map_or_else(ExternalSpec::default, |source| spec(&["sonar"], source));
    let mut simulation = mixed(&text, sources);
    let percept = Percept {
        scans,
        ..at(12.8, 10.0, 0.0)
    };
    let percepts = BTreeMap::from([(REAL, percept)]);
    let stay = BTreeMap::from([(OTHER, go(0.0, 0.0))]);
    let commands = simulation.step_with(percepts, stay).unwrap();
    commands[&REAL].motion
}

#[test]
fn the_nearer_range_of_both_counts_and_a_missing_real_scan_stays_missing() {
    let fresh = Some(0.0);
    let [real, both] = [None, Some(ReadingSource::Both)];
    // The other robot is 0.9 m ahead.
    let free = commanded(real, scan(fresh, f64::INFINITY));
    assert_ne!(commanded(Some(ReadingSource::Virtual), Vec::new()), free);
    assert_ne!(commanded(both, scan(fresh, f64::INFINITY)), free);
    let near = commanded(real, scan(fresh, 0.5));
    assert_eq!(commanded(both, scan(fresh, 0.5)), near);
    // A virtual scan does not take the place of a real one that is missing.
    let missing = commanded(real, scan(None, 0.0));
    assert_eq!(commanded(both, scan(None, 0.0)), missing);
}

/// What the other robot perceives in the next step.
fn other(simulation: &mut Simulation) -> Percept {
    simulation.percept(OTHER).unwrap().unwrap()
}

#[test]
fn simulated_robots_perceive_a_real_one_grown_by_its_uncertainty() {
    let mut exact = mixed(TWO, ExternalSpec::default());
    measured(&mut exact, at(10.0, 10.0, 0.0));
    let seen = other(&mut exact);
    assert!((seen.scans[0].ranges_m[0] - 3.7).abs() < 1e-9);
    assert!(seen.neighbours[0].uncertainty_m.abs() < 1e-12);
    let text = TWO.replace(
        "{ kind = \"position\" }",
        "{ kind = \"position\", noise_m = 0.25 }",
    );
    let mut vague = mixed(&text, ExternalSpec::default());
    let percept = Percept {
        heading_rad: None,
        ..at(10.0, 10.0, 0.0)
    };
    measured(&mut vague, percept);
    let seen = other(&mut vague);
    assert!(
        (seen.scans[0].ranges_m[0] - 3.45).abs() < 1e-9,
        "{:?}",
        seen.scans[0]
    );
    assert!((seen.neighbours[0].uncertainty_m - 0.25).abs() < 1e-12);
    assert!((seen.neighbours[0].range_m - 4.0).abs() < 1e-9);
}

/// The nearest range of the other robot after some time without a percept of the real one.
fn nearest_m(simulation: &mut Simulation, steps: u32) -> f64 {
    for _ in 0..steps {
        let stay = BTreeMap::from([(OTHER, go(0.0, 0.0))]);
        simulation.step_with(BTreeMap::new(), stay).unwrap();
    }
    other(simulation).scans[0].ranges_m[0]
}

/// A percept without a heading: the body stays there until the next one.
fn stand(time_s: f64) -> Percept {
    Percept {
        heading_rad: None,
        ..at(10.0, 10.0, time_s)
    }
}

fn silent(fence_m: &[[f64; 2]]) -> ExternalSpec {
    ExternalSpec {
        max_age_s: Some(1.0),
        fence_m: fence_m
            .iter()
            .map(|[x, y]| Point { x: *x, y: *y })
            .collect(),
        ..ExternalSpec::default()
    }
}

#[test]
fn a_silent_robot_grows_at_its_maximum_speed() {
    let mut simulation = mixed(TWO, silent(&[]));
    measured(&mut simulation, stand(0.0));
    assert!((nearest_m(&mut simulation, 9) - 3.7).abs() < 1e-9);
    // 1.5 s after its last position, at 1 m/s.
    assert!((nearest_m(&mut simulation, 6) - 2.2).abs() < 1e-9);
    assert!((nearest_m(&mut simulation, 10) - 1.2).abs() < 1e-9);
    // It is back with its next position.
    measured(&mut simulation, stand(2.6));
    assert!((nearest_m(&mut simulation, 0) - 3.7).abs() < 1e-9);
}

#[test]
fn a_silent_robot_grows_no_farther_than_its_fence() {
    let fence_m = [[8.0, 8.0], [12.0, 8.0], [12.0, 12.0], [8.0, 12.0]];
    let mut simulation = mixed(TWO, silent(&fence_m));
    measured(&mut simulation, stand(0.0));
    assert!((nearest_m(&mut simulation, 15) - 2.2).abs() < 0.02);
    // Its centre is at the fence at most: 2 m away from the other one, which its radius makes 1.7 m.
    assert!((nearest_m(&mut simulation, 15) - 1.7).abs() < 1e-9);
    assert!((nearest_m(&mut simulation, 1000) - 1.7).abs() < 1e-9);
}

#[test]
fn an_observed_body_is_where_it_is_read_and_its_brain_does_not_step() {
    let mut simulation = mixed(TWO, silent(&[]));
    for step in 0..30_u32 {
        observe(&mut simulation, at(11.0, 9.0, 0.1 * f64::from(step)));
    }
    assert_eq!(robots(&simulation)[0].at, Point { x: 11.0, y: 9.0 });
    assert!((other(&mut simulation).neighbours[0].range_m - 10.0_f64.sqrt()).abs() < 1e-9);
    let perceived = simulation.perceived(REAL).unwrap().unwrap();
    assert!(perceived.real.position.is_some() && perceived.measured == Percept::default());
}

#[test]
fn a_mixed_run_is_the_same_from_a_copy_of_its_state() {
    let text = TWO
        .replace(
            "{ kind = \"position\" }",
            "{ kind = \"position\", noise_m = 0.1 }",
        )
        .replace(
            "range_m = 6 }\nsensors.eye",
            "range_m = 6, noise_m = 0.1, latency_s = 0.3 }\nsensors.eye",
        );
    let mut one = mixed(
        &text,
        ExternalSpec {
            max_age_s: Some(0.5),
            ..spec(&ALL, ReadingSource::Both)
        },
    );
    let mut hashes = [Vec::new(), Vec::new()];
    let mut copy = one.clone();
    for (run, hashes) in [&mut one, &mut copy].into_iter().zip(&mut hashes) {
        run.hash_decisions(0);
        for step in 0..100_u32 {
            let share = f64::from(step);
            let percept = Percept {
                scans: scan(Some(0.0), 5.0),
                ..at(10.0 + 0.02 * share, 10.0, 0.1 * share)
            };
            let percepts = if step % 20 < 12 {
                BTreeMap::from([(REAL, percept)])
            } else {
                BTreeMap::new()
            };
            run.step_with(percepts, BTreeMap::new()).unwrap();
            hashes.push((run.state().hash(), run.state().decision_hash()));
        }
    }
    assert_eq!(hashes[0], hashes[1]);
}

#[test]
fn what_cannot_be_virtual_or_both_is_refused_by_path() {
    let scenario = scenario(TWO);
    let sources = [
        ("gps", ReadingSource::Virtual),
        ("compass", ReadingSource::Both),
        ("sonar", ReadingSource::Both),
        ("sonra", ReadingSource::Virtual),
    ];
    let spec = ExternalSpec {
        sensors: sources
            .map(|(name, source)| (name.to_owned(), source))
            .into(),
        fence_m: vec![Point::default(); 2],
        ..ExternalSpec::default()
    };
    let errors = scenario.errors_of_external(0, &spec, "external.rover");
    let paths: Vec<&str> = errors.iter().map(|error| error.path.as_str()).collect();
    let sensors = ["compass", "gps", "sonra"].map(|name| format!("external.rover.sensors.{name}"));
    assert_eq!(paths[..3], sensors.each_ref().map(String::as_str));
    assert_eq!(paths[3], "external.rover.fence_m");
    assert_eq!(errors[2].suggestion.as_deref(), Some("sonar"));
}

/// The number of steps after which the mine counts as found, and the state hashes until then.
fn found_after(confirm_looks: &str) -> (u32, Vec<u64>) {
    let text = TWO.replace(
        "count = 1, placement",
        &format!("count = 1, {confirm_looks}placement"),
    );
    let mut simulation = mixed(&text, spec(&ALL, ReadingSource::Virtual));
    let mut hashes = Vec::new();
    for step in 0..50_u32 {
        measured(&mut simulation, stand(0.1 * f64::from(step)));
        hashes.push(simulation.state().hash());
        if simulation.outcome().found == [1] {
            return (step, hashes);
        }
    }
    (u32::MAX, hashes)
}

#[test]
fn an_item_is_found_after_the_looks_that_its_kind_needs() {
    assert_eq!(found_after("").0, 0);
    assert_eq!(found_after("confirm_looks = 1, ").0, 0);
    // The real robot and the simulated one both look in each step.
    let (steps, hashes) = found_after("confirm_looks = 5, ");
    assert_eq!(steps, 2);
    // Each look is a part of the state.
    assert!(hashes.windows(2).all(|pair| pair[0] != pair[1]));
}

#[test]
fn the_area_of_a_silent_robot_is_around_its_last_position_whatever_its_last_command_was() {
    let text = TWO.to_owned() + "brain.behaviours = [{ kind = \"cruise\" }]\n";
    let mut simulation = mixed(&text, silent(&[]));
    // It drives on at 1 m/s, by its brain, with a heading.
    measured(&mut simulation, at(10.0, 10.0, 0.0));
    assert!((nearest_m(&mut simulation, 20) - 1.7).abs() < 1e-9);
    // The other robot is 4 m ahead, and one that reverses is as far behind.
    assert!((robots(&simulation)[0].at.x - 10.0).abs() < 1e-9);
}

#[test]
fn a_robot_that_is_driven_by_hand_is_where_its_readings_are() {
    let mut simulation = mixed(TWO, silent(&[]));
    for step in 0..40_u32 {
        let time_s = 0.1 * f64::from(step);
        // A position each second, of a robot that moves at 0.8 m/s.
        let read_s = time_s.floor();
        let position = Some(Reading {
            value: Point {
                x: 5.0 + 0.8 * read_s,
                y: 10.0,
            },
            age_s: time_s - read_s,
        });
        observe(
            &mut simulation,
            Percept {
                position,
                ..at(0.0, 0.0, time_s)
            },
        );
        let view = &simulation.external_views()[0];
        assert!((view.at.x - (5.0 + 0.8 * read_s)).abs() < 1e-9);
        assert!(view.uncertainty_m >= 0.8 * (time_s - read_s));
    }
}

#[test]
fn a_robot_that_was_held_gets_no_detections_of_that_time() {
    let text = TWO.replace(
        "kind = \"items\", range_m = 3",
        "kind = \"items\", range_m = 3, latency_s = 0.2",
    );
    let mut simulation = mixed(&text, spec(&ALL, ReadingSource::Virtual));
    for step in 0..100_u32 {
        observe(&mut simulation, at(11.0, 10.0, 0.1 * f64::from(step)));
    }
    let resumed = measured(&mut simulation, at(30.0, 5.0, 10.0));
    assert!(resumed.contacts.is_empty(), "{:?}", resumed.contacts);
}

#[test]
fn a_body_that_is_believed_to_be_deep_inside_an_obstacle_sees_nothing_behind_it() {
    let wide = WALL.replace(
        "at_m = [10.45, 10], size_m = [0.1, 20]",
        "at_m = [12, 10], size_m = [20, 14]",
    );
    let text = TWO
        .replace("world = { size_m = [40, 20] }", &wide)
        .replace("[[12, 10.5]]", "[[30, 10]]")
        .replace("[[10, 10], [14, 10]]", "[[30, 15], [35, 15]]");
    let mut simulation = mixed(&text, spec(&ALL, ReadingSource::Virtual));
    let real = measured(&mut simulation, at(12.0, 10.0, 0.0));
    let nearest_m = real.scans[0]
        .ranges_m
        .iter()
        .copied()
        .fold(f64::INFINITY, f64::min);
    assert!(nearest_m < 0.3, "{:?}", real.scans[0]);
    // As far outside of the world, it is at the border.
    let real = measured(&mut simulation, at(60.0, 10.0, 5.0));
    let nearest_m = real.scans[0]
        .ranges_m
        .iter()
        .copied()
        .fold(f64::INFINITY, f64::min);
    assert!(nearest_m < 0.1, "{:?}", real.scans[0]);
}

#[test]
fn a_robot_that_never_sends_a_position_is_silent_from_the_start() {
    let mut simulation = mixed(TWO, silent(&[]));
    assert!((nearest_m(&mut simulation, 5) - 3.7).abs() < 1e-9);
    assert!((nearest_m(&mut simulation, 15) - 1.7).abs() < 1e-9);
}

#[test]
fn detectors_detect_a_silent_robot_where_it_may_be_nearest() {
    let text = TWO.replace(
        "kind = \"robots\", range_m = 6",
        "kind = \"robots\", range_m = 3",
    );
    let mut simulation = mixed(&text, silent(&[]));
    measured(&mut simulation, stand(0.0));
    nearest_m(&mut simulation, 9);
    assert!(other(&mut simulation).neighbours.is_empty());
    nearest_m(&mut simulation, 6);
    let seen = other(&mut simulation).neighbours;
    assert!((seen[0].range_m - 2.5).abs() < 1e-9, "{seen:?}");
}

#[test]
fn a_fence_in_a_periodic_world_is_refused() {
    let scenario =
        scenario(&TWO.replace("size_m = [40, 20]", "size_m = [40, 20], periodic = true"));
    let fence_m = [[8.0, 8.0], [12.0, 8.0], [12.0, 12.0]];
    let errors = scenario.errors_of_external(0, &silent(&fence_m), "external");
    assert_eq!(errors.len(), 1);
    assert_eq!(errors[0].path, "external.fence_m");
}
