//! Collision warnings: robots that are about to collide.

use crate::common::{go, id, start};
use sim::simulation::Simulation;
use std::collections::BTreeMap;

/// Robots with a diameter of half a metre at given positions and headings.
fn team(places: &str, headings_deg: &str) -> Simulation {
    start(&format!(
        "[clock]\ntime_limit_s = 100\n[world]\nsize_m = [20, 20]\n\
         obstacles = [{{ circle = {{ at_m = [10, 15], radius_m = 1 }} }}]\n\
         [robots.rover]\nradius_m = 0.25\n\
         drive = {{ max_speed_m_s = 1, max_reverse_speed_m_s = 1, max_turn_rate_deg_s = 90 }}\n\
         start = {{ at_m = {places}, heading_deg = {headings_deg} }}\n"
    ))
}

/// The warnings after a step at these speeds.
fn warnings(simulation: &mut Simulation, speeds_m_s: &[f64]) -> Vec<bool> {
    let commands = (0..).zip(speeds_m_s);
    let commands = commands.map(|(robot, speed_m_s)| (id(0, robot), go(*speed_m_s, 0.0)));
    let commands: BTreeMap<_, _> = commands.collect();
    simulation.step_with(BTreeMap::new(), commands).unwrap();
    simulation.collision_warnings()
}

#[test]
fn driving_at_a_wall_triggers_a_warning_within_a_second_of_it() {
    // After a step of 0.1 m, the robots' edges are 0.85, 1.15 and 0.85 m from the wall.
    let mut team = team("[[18.8, 5], [18.5, 8], [18.8, 11]]", "[0, 0, 180]");
    assert_eq!(warnings(&mut team, &[1.0, 1.0, 1.0]), [true, false, false]);
}

#[test]
fn reversing_at_a_wall_triggers_a_warning_and_stopping_in_front_of_it_does_not() {
    let mut team = team("[[18.8, 5], [19.7, 8]]", "[180, 0]");
    assert_eq!(warnings(&mut team, &[-1.0, 0.0]), [true, false]);
}

#[test]
fn an_obstacle_that_only_the_side_of_the_robot_would_touch_triggers_a_warning() {
    let mut grazing = team("[[9, 13.8]]", "[0]");
    assert_eq!(warnings(&mut grazing, &[1.0]), [true]);
    let mut passing = team("[[9, 13.7]]", "[0]");
    assert_eq!(warnings(&mut passing, &[1.0]), [false]);
}

#[test]
fn robots_on_collision_courses_trigger_warnings_and_passing_ones_do_not() {
    let mut meeting = team("[[5, 5], [7, 5]]", "[0, 180]");
    assert_eq!(warnings(&mut meeting, &[1.0, 1.0]), [true, true]);
    let mut following = team("[[5, 5], [5.9, 5]]", "[0, 0]");
    assert_eq!(warnings(&mut following, &[1.0, 1.0]), [false, false]);
    let mut passing = team("[[5, 5], [7, 5.6]]", "[0, 180]");
    assert_eq!(warnings(&mut passing, &[1.0, 1.0]), [false, false]);
}
