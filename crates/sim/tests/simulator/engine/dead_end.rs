//! Motor schemas in a dead end: a box that is open towards the robot.

use crate::common::{first, scenario, start};
use base::geometry::Point;
use rayon::prelude::*;
use sim::simulation::Simulation;

/// One rover with a waypoint behind the box, which is 3 m deep and 4 m wide.
fn canyon(schemas: &str) -> String {
    let box_m = [
        "[[13, 8], [13, 12], [13.3, 12], [13.3, 8]]",
        "[[10, 12], [10, 12.3], [13.3, 12.3], [13.3, 12]]",
        "[[10, 7.7], [10, 8], [13.3, 8], [13.3, 7.7]]",
    ];
    let obstacles = box_m
        .map(|wall| format!("{{ polygon_m = {wall} }}"))
        .join(", ");
    format!(
        "[clock]\nstep_s = 0.1\ntime_limit_s = 1000\n[world]\nsize_m = [24, 20]\n\
         obstacles = [{obstacles}]\n[robots.rover]\ncount = 1\nradius_m = 0.25\n\
         start = {{ kind = \"fixed\", at_m = [[5, 10]], heading_deg = [0] }}\n\
         drive = {{ max_speed_m_s = 1, max_acceleration_m_s2 = 1, max_turn_rate_deg_s = 90 }}\n\
         [robots.rover.sensors]\nsonar = {{ kind = \"range\", rays = 24, range_m = 3 }}\n\
         gps = {{ kind = \"position\" }}\ncompass = {{ kind = \"heading\" }}\n\
         [robots.rover.brain]\narbitration = {{ kind = \"schemas\"{schemas} }}\n\
         behaviours = [{{ kind = \"navigate\", waypoints_m = [[20, 10]] }}]\n"
    )
}

/// Of 20 runs, the number that reach the waypoint within ten minutes.
fn out_of_the_canyon(schemas: &str) -> usize {
    let scenario = scenario(&canyon(schemas));
    let gets_there = |run: &u64| {
        let mut simulation = Simulation::new(scenario.clone(), 1, *run).unwrap();
        (0..6000).any(|_| {
            simulation.step();
            first(&simulation)
                .at
                .to(Point { x: 20.0, y: 10.0 })
                .length()
                < 0.6
        })
    };
    (0..20_u64).into_par_iter().filter(gets_there).count()
}

/// Without randomness, one run represents all of them.
#[test]
fn with_constant_gains_and_no_noise_it_stays_in_a_dead_end() {
    let mut simulation = start(&canyon(", noise = 0, max_noise = 0"));
    (0..600).for_each(|_| simulation.step());
    let before = first(&simulation).at;
    assert!(before.x > 12.0 && before.x < 12.75, "{before:?}");
    (0..6000).for_each(|_| simulation.step());
    assert!(before.to(first(&simulation).at).length() < 0.01);
}

/// It leaves in 199 of 200 runs. At a rate of 98 of 100, fewer than 17 successes of 20 would have a
/// probability of 6e-4. Low noise that does not grow is not enough.
#[test]
fn with_noise_that_grows_while_it_is_blocked_it_leaves() {
    let out = out_of_the_canyon("");
    assert!(out >= 17, "{out}");
    assert_eq!(out_of_the_canyon(", max_noise = 0"), 0);
}
