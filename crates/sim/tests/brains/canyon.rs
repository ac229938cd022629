//! Paths that first lead away from the destination.

use crate::scenarios::scenario;
use base::geometry::Point;
use rayon::prelude::*;
use sim::simulation::Simulation;

/// A box 12 m deep, open to the left, in which the robot starts in front of the closed side.
const CANYON: &str = "
[world]
size_m = [30, 20]
obstacles = [
    { polygon_m = [[15, 6], [15.5, 6], [15.5, 14], [15, 14]] },
    { polygon_m = [[3, 6], [15, 6], [15, 6.5], [3, 6.5]] },
    { polygon_m = [[3, 13.5], [15, 13.5], [15, 14], [3, 14]] },
]
";

/// Two walls 20 m long, 3 m apart.
const PASSAGE: &str = "
[world]
size_m = [30, 20]
obstacles = [
    { polygon_m = [[5, 8], [25, 8], [25, 8.5], [5, 8.5]] },
    { polygon_m = [[5, 11.5], [25, 11.5], [25, 12], [5, 12]] },
]
";

const FIELD: &str = "world.size_m = [40, 20]";

/// A robot at one point, facing along x, with a waypoint at another.
fn rover(world: &str, drive: &str, rays_m: f64, from: Point, to: Point) -> String {
    format!(
        "clock.time_limit_s = 1000\n{world}
[robots.rover]
radius_m = 0.25
drive = {{ max_speed_m_s = 1, max_acceleration_m_s2 = 1, {drive} }}
start = {{ at_m = [[{}, {}]], heading_deg = [0] }}
[robots.rover.sensors]
gps = {{ kind = \"position\", noise_m = 0.02 }}
compass = {{ kind = \"heading\", noise_deg = 1 }}
laser = {{ kind = \"range\", rays = 72, range_m = {rays_m}, noise_m = 0.02 }}
[robots.rover.brain]
behaviours = [{{ kind = \"navigate\", waypoints_m = [[{}, {}]] }}]
",
        from.x, from.y, to.x, to.y
    )
}

/// The time of arrival in each of 20 runs; infinite without arrival by `max_s`.
fn times_s(text: &str, to: Point, max_s: f64) -> Vec<f64> {
    let scenario = scenario(text);
    let time_s = |run| {
        let mut simulation = Simulation::new(scenario.clone(), 1, run).unwrap();
        while simulation.time_s() < max_s {
            simulation.step();
            let mut robots = simulation.state().each_robot(simulation.scenario());
            if robots.any(|robot| robot.at.to(to).length() < 0.7) {
                return simulation.time_s();
            }
        }
        f64::INFINITY
    };
    (0..20).into_par_iter().map(time_s).collect()
}

#[test]
fn a_robot_leaves_a_box_canyon_and_remembers_its_walls() {
    let to = Point { x: 25.0, y: 10.0 };
    for rays_m in [6.0, 20.0] {
        let from = Point { x: 13.0, y: 10.0 };
        let text = rover(CANYON, "max_turn_rate_deg_s = 120", rays_m, from, to);
        let times_s = times_s(&text, to, 100.0);
        // The shortest path is 39 m long; the robot does not know the walls in advance.
        assert!(times_s.iter().all(|time_s| *time_s < 70.0), "{times_s:?}");
    }
}

#[test]
fn a_robot_with_a_destination_behind_it_turns_around() {
    for y in [10.0, 1.2] {
        let [from, to] = [20.0, 5.0].map(|x| Point { x, y });
        let text = rover(FIELD, "max_turn_rate_deg_s = 30", 6.0, from, to);
        let times_s = times_s(&text, to, 100.0);
        assert!(times_s.iter().all(|time_s| *time_s < 25.0), "{times_s:?}");
    }
}

#[test]
fn a_robot_with_a_late_compass_passes_between_two_walls() {
    let [from, to] = [3.0, 26.5].map(|x| Point { x, y: 10.0 });
    for noise_deg in ["0", "1"] {
        for latency_s in ["0.5", "1.0"] {
            let text = rover(PASSAGE, "max_turn_rate_deg_s = 120", 6.0, from, to).replace(
                "noise_deg = 1",
                &format!("noise_deg = {noise_deg}, latency_s = {latency_s}"),
            );
            let times_s = times_s(&text, to, 60.0);
            // The path is 23.5 m long.
            assert!(times_s.iter().all(|time_s| *time_s < 30.0), "{times_s:?}");
        }
    }
}
