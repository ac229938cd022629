//! Robots that return home before their batteries are empty.

use crate::scenarios::scenario;
use rayon::prelude::*;
use sim::simulation::Simulation;

/// A robot that searches a field from its left end, with a battery for 100 s of driving.
fn searcher(search: &str) -> String {
    format!(
        "clock.time_limit_s = 400
world.size_m = [40, 20]
items.mine.placement.at_m = [[39.5, 0.5], [39.5, 19.5], [20, 19.5]]
[robots.rover]
radius_m = 0.25
drive = {{ max_speed_m_s = 1, max_acceleration_m_s2 = 1, max_turn_rate_deg_s = 120 }}
start.at_m = [[3, 10]]
battery = {{ capacity_j = 2000, idle_w = 5, move_w = 15 }}
[robots.rover.sensors]
gps = {{ kind = \"position\", noise_m = 0.02 }}
compass = {{ kind = \"heading\", noise_deg = 1 }}
laser = {{ kind = \"range\", rays = 72, range_m = 6, noise_m = 0.02 }}
eye = {{ kind = \"items\", range_m = 2, detection_probability = {{ mine = 0.8 }} }}
[robots.rover.brain]
arbitration = {{ kind = \"goals\" }}
behaviours = [{{ kind = \"{search}\" }}, {{ kind = \"return_home\", at_m = [3, 10] }}, {{ kind = \"avoid\" }}]
"
    )
}

/// The distance from home at which the robot stops, for each run.
fn away_m(search: &str) -> Vec<f64> {
    let scenario = scenario(&searcher(search));
    let end = |run| {
        let mut simulation = Simulation::new(scenario.clone(), 1, run).unwrap();
        (0..4000).for_each(|_| simulation.step());
        let mut robots = simulation.state().each_robot(simulation.scenario());
        robots.next().unwrap().at
    };
    let ends = (0..20).into_par_iter().map(end);
    let home = base::geometry::Point { x: 3.0, y: 10.0 };
    ends.map(|at| at.to(home).length()).collect()
}

#[test]
fn a_searching_robot_with_a_battery_ends_at_home() {
    for search in ["bayesian_search", "frontier", "lawnmower"] {
        let away_m = away_m(search);
        assert!(
            away_m.iter().all(|away_m| *away_m < 1.1),
            "{search}: {away_m:?}"
        );
    }
}
