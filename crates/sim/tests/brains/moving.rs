//! Moving objects that no detector identifies are distinguished from static ones by their approach.

use crate::scenarios::{scenario, with};
use brain::{AgentId, BelievedRobot};
use sim::simulation::Simulation;

const WATCHER: AgentId = AgentId::robot(0, 0);

/// A robot with beliefs among pillars, and another robot that approaches.
const HALL: &str = "
clock.time_limit_s = 1000
[world]
size_m = [24, 12]
obstacles = [
    { circle = { at_m = [6, 3], radius_m = 0.2 } },
    { circle = { at_m = [9, 8], radius_m = 0.3 } },
    { circle = { at_m = [12, 4.5], radius_m = 0.15 } },
    { polygon_m = [[15, 7], [15.4, 7], [15.4, 7.4], [15, 7.4]] },
    { circle = { at_m = [18, 3.5], radius_m = 0.4 } },
]
[robots.a]
radius_m = 0.25
drive = { max_speed_m_s = 1, max_acceleration_m_s2 = 1, max_turn_rate_deg_s = 120 }
[robots.a.sensors]
lidar = { kind = \"range\", rays = 72, range_m = 6, noise_m = 0.02 }
gps = { kind = \"position\" }
compass = { kind = \"heading\" }
";

fn simulation(rest: &str, run: u64) -> Simulation {
    Simulation::new(scenario(&with(HALL, rest)), 1, run).unwrap()
}

/// The robots that the observer believes to move after a step.
fn step(simulation: &mut Simulation) -> Vec<BelievedRobot> {
    simulation.step();
    let belief_state = simulation.state().belief_state(WATCHER).unwrap();
    belief_state.robots
}

#[test]
fn an_approaching_object_is_believed_to_move_at_its_speed() {
    let mut simulation = simulation(
        "
[robots.a]
start = { at_m = [[2, 6]], heading_deg = [0] }
brain.behaviours = [{ kind = \"hold_position\" }]
[robots.b]
radius_m = 0.3
drive = { max_speed_m_s = 0.6, max_turn_rate_deg_s = 90 }
start = { at_m = [[7, 6]], heading_deg = [180] }
brain = { limit_speed_to_stopping_distance = false, behaviours = [{ kind = \"cruise\" }] }
",
        0,
    );
    let moving = (0..50).map(|_| step(&mut simulation)).last().unwrap();
    let [walker] = moving.as_slice() else {
        panic!("{moving:?}");
    };
    assert_eq!(walker.id, None);
    assert!((-0.8..-0.4).contains(&walker.velocity_m_s.x), "{walker:?}");
    assert!(walker.at.x > 1.0 && walker.at.y.abs() < 0.4, "{walker:?}");
}

#[test]
fn static_objects_are_rarely_believed_to_move_by_a_passing_robot() {
    let wrong = (0..10).map(|run| {
        let mut simulation = simulation(PASSES, run);
        (0..1200)
            .filter(|_| !step(&mut simulation).is_empty())
            .count()
    });
    // Ten runs of 120 s, in which it passes all of them more than once.
    let wrong: usize = wrong.sum();
    assert!(wrong < 120, "{wrong} of 12000 steps");
}

const PASSES: &str = "[robots.a]
start.at_m = [[2, 6]]
brain.behaviours = [{ kind = \"navigate\", waypoints_m = [[22, 6], [22, 2], [2, 2], [2, 10], [22, 10], [11, 6]] }]
";
