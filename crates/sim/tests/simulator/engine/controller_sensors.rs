//! Controllers detect robots and other controllers with sensors of their own.

use crate::common::{id, replaced, start, with};
use brain::{About, AgentId, Neighbour, OwnershipMessage};
use sim::simulation::Simulation;

/// A controller with a detector, one without, and two robots, of which the second cannot send.
const SEEING: &str = r#"
clock.time_limit_s = 100
robots.rover = { start.at_m = [[38, 1]], radio.range_m = 50, brain.behaviours = [] }
controllers.mast = { start.at_m = [[20, 10]], radio.range_m = 50 }
[world]
size_m = [40, 20]
obstacles = [{ polygon_m = [[29, 0], [30, 0], [30, 5], [29, 5]] }]
[robots.mute]
start = { at_m = [[13, 14]], heading_deg = [90] }
radio = { range_m = 50, messages_per_step = 0 }
brain.behaviours = []
[controllers.base]
start.at_m = [[10, 10]]
radio.range_m = 50
sensors.eye = { kind = "robots", range_m = 15 }
"#;

const MUTE: AgentId = AgentId::robot(0, 0);
const BASE: AgentId = AgentId::controller(2, 0);
const MAST: AgentId = AgentId::controller(3, 0);

fn detected(simulation: &mut Simulation) -> Vec<Neighbour> {
    simulation.percept(BASE).unwrap().unwrap().neighbours
}

fn ids(text: &str) -> Vec<AgentId> {
    let neighbours = detected(&mut start(text));
    neighbours.iter().map(|each| each.id).collect()
}

#[test]
fn a_controller_detects_robots_and_controllers_in_range() {
    let neighbours = detected(&mut start(SEEING));
    let seen: Vec<(AgentId, f64)> = neighbours
        .iter()
        .map(|each| (each.id, each.range_m))
        .collect();
    assert_eq!(seen, [(MUTE, 5.0), (MAST, 10.0)]);
    assert!((neighbours[0].bearing_rad - 4.0_f64.atan2(3.0)).abs() < 1e-12);
    assert_eq!(neighbours[0].course_rad, None);
    let eye = "controllers.base.sensors.eye";
    assert_eq!(ids(&with(SEEING, &format!("{eye}.range_m = 4"))), []);
    let behind = with(SEEING, &format!("{eye}.range_m = 40"));
    assert_eq!(
        ids(&behind),
        [MUTE, MAST],
        "the rover is behind an obstacle"
    );
    let through = with(&behind, &format!("{eye}.needs_line_of_sight = false"));
    assert_eq!(ids(&through), [MUTE, id(1, 0), MAST]);
}

#[test]
fn detectors_of_controllers_are_noisy_and_miss_as_those_of_robots() {
    let noisy = "controllers.base.sensors.eye = \
                 { noise_m = 0.1, course_noise_deg = 1, detection_probability = 0.5 }";
    let mut simulation = start(&with(SEEING, noisy));
    let mut seen = Vec::new();
    for _ in 0..400 {
        let neighbours = detected(&mut simulation);
        seen.extend(neighbours.into_iter().find(|each| each.id == MUTE));
        simulation.step();
    }
    // 200 are expected, with a standard deviation of 10.
    assert!((150..250).contains(&seen.len()), "{}", seen.len());
    let mean_m = seen.iter().map(|each| each.range_m).sum::<f64>() / seen.len() as f64;
    assert!((mean_m - 5.0).abs() < 0.05, "{mean_m}");
    assert!(seen.iter().any(|each| (each.range_m - 5.0).abs() > 0.05));
    let courses = seen.iter().filter_map(|each| each.course_rad);
    let mean_rad = courses.sum::<f64>() / seen.len() as f64;
    assert!(
        (mean_rad - std::f64::consts::FRAC_PI_2).abs() < 0.01,
        "{mean_rad}"
    );
}

/// The places of a robot that a controller reports to another in some seconds.
fn reports(text: &str) -> Vec<[f32; 2]> {
    let mut simulation = start(text);
    let mut places = Vec::new();
    for _ in 0..100 {
        simulation.step();
        let inbox = simulation.percept(MAST).unwrap().unwrap().inbox;
        places.extend(
            inbox
                .iter()
                .filter_map(|received| match received.message.about {
                    About::Ownership(OwnershipMessage::Seen(seen))
                        if seen.robot == MUTE && received.from == BASE =>
                    {
                        Some(seen.at_m)
                    }
                    _ => None,
                }),
        );
    }
    places
}

#[test]
fn the_place_of_a_robot_without_a_radio_is_known_to_the_controllers_from_the_one_that_detects_it() {
    let places = reports(SEEING);
    assert!(places.len() > 2, "{places:?}");
    assert!(
        places
            .iter()
            .all(|[x, y]| (x - 13.0).abs() < 1e-4 && (y - 14.0).abs() < 1e-4)
    );
    let blind = replaced(
        SEEING,
        &[("sensors.eye = { kind = \"robots\", range_m = 15 }\n", "")],
    );
    assert_eq!(reports(&blind), [[0.0; 2]; 0]);
}
