//! Cruise, correct, avoid: the three layers of Bender (2003).

use crate::common::{first, start};
use base::geometry::Point;
use sim::simulation::Simulation;

/// One rover at the left that faces along x, with the given middle layer.
fn rover(obstacles: &str, start_y_m: f64, correct: &str) -> Simulation {
    start(&format!(
        "[clock]\nstep_s = 0.1\ntime_limit_s = 1000\n[world]\nsize_m = [24, 20]\n\
         obstacles = [{obstacles}]\n[robots.rover]\ncount = 1\nradius_m = 0.25\n\
         start = {{ kind = \"fixed\", at_m = [[3, {start_y_m}]], heading_deg = [0] }}\n\
         drive = {{ max_speed_m_s = 1, max_acceleration_m_s2 = 1, max_turn_rate_deg_s = 90 }}\n\
         [robots.rover.sensors]\nsonar = {{ kind = \"range\", rays = 24, range_m = 3 }}\n\
         gps = {{ kind = \"position\", rate_hz = 2 }}\ncompass = {{ kind = \"heading\", rate_hz = 5 }}\n\
         [robots.rover.brain]\nbehaviours = [{{ kind = \"cruise\" }}, \
         {{ kind = \"correct\", {correct} }}, {{ kind = \"avoid\" }}]\n"
    ))
}

/// Steps until it reaches a place, within two minutes, and the largest x up to then.
fn steps_to(simulation: &mut Simulation, to: Point) -> (Option<usize>, f64) {
    let mut max_x_m: f64 = 0.0;
    let is_there = |_: &usize| {
        simulation.step();
        let at = first(simulation).at;
        max_x_m = max_x_m.max(at.x);
        at.to(to).length() < 0.6
    };
    ((1..=1200).find(is_there), max_x_m)
}

/// From ten starts in front of an 8 m wide wall: the number that pass it, and the largest x of the
/// others.
fn past_the_wall(correct: &str) -> (usize, f64) {
    let wall = "{ polygon_m = [[10, 6], [10, 14], [11, 14], [11, 6]] }";
    let to = Point { x: 20.0, y: 10.0 };
    let runs = (0..10).map(|number| {
        let start_y_m = 9.5 + 0.1 * f64::from(number);
        let mut simulation = rover(
            wall,
            start_y_m,
            &format!("waypoints_m = [[20, 10]]{correct}"),
        );
        steps_to(&mut simulation, to)
    });
    let (past, locked): (Vec<_>, Vec<_>) = runs.partition(|(steps, _)| steps.is_some());
    (
        past.len(),
        locked.iter().map(|(_, x_m)| *x_m).fold(0.0, f64::max),
    )
}

#[test]
fn without_a_pause_after_avoiding_it_deadlocks_in_front_of_a_large_obstacle() {
    let (past, max_x_m) = past_the_wall(", wait_s = 0");
    assert_eq!(past, 0);
    assert!(max_x_m < 10.0, "{max_x_m}");
}

#[test]
fn with_the_default_pause_it_passes_a_large_obstacle() {
    assert_eq!(past_the_wall("").0, 10);
}

#[test]
fn waypoints_are_visited_in_order() {
    let places = [[12.0, 10.0], [12.0, 17.0], [5.0, 5.0]];
    let mut simulation = rover("", 10.0, &format!("waypoints_m = {places:?}"));
    for place in places {
        let (steps, _) = steps_to(&mut simulation, place.into());
        assert!(steps.is_some(), "{place:?}");
    }
    // Afterwards only the cruise layer is active.
    let before = first(&simulation);
    (0..10).for_each(|_| simulation.step());
    assert_eq!(first(&simulation).heading_rad, before.heading_rad);
    assert!(first(&simulation).speed_m_s > 0.9);
}
