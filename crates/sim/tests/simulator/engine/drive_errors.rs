//! Robots whose drives execute setpoints with errors.

use super::determinism::crowd;
use crate::common::{self, drive, first, id, robots, scenario, start, step_with};
use base::geometry::Point;
use proptest::prelude::*;
use rayon::ThreadPoolBuilder;
use sim::run::Robot;
use sim::simulation::Simulation;

const ROVER: &str = "
clock = { step_s = 0.05, time_limit_s = 600 }
world.size_m = [200, 100]
[robots.rover]
radius_m = 0.25
start = { at_m = [[100, 50]], heading_deg = [0] }
drive = { max_speed_m_s = 1, max_reverse_speed_m_s = 1, max_turn_rate_deg_s = 90 }
brain.behaviours = []
";

/// The scenario with these keys in its drive.
fn with(errors: &str) -> String {
    common::with(ROVER, &format!("robots.rover.drive = {{ {errors} }}"))
}

fn rover(errors: &str) -> Simulation {
    start(&with(errors))
}

/// Drives for some steps, and returns the robot.
fn driven(simulation: &mut Simulation, steps: u32, speed_m_s: f64, turn_rad_s: f64) -> Robot {
    drive(simulation, steps, &[(id(0, 0), speed_m_s, turn_rad_s)]);
    first(simulation)
}

fn is_near(one: f64, other: f64, tolerance: f64) {
    assert!((one - other).abs() < tolerance, "{one} {other}");
}

#[test]
fn a_lag_loses_its_time_constant_of_distance_and_gives_it_back_at_the_stop() {
    let mut simulation = rover("lag_s = 0.4");
    is_near(
        driven(&mut simulation, 200, 1.0, 0.0).distance_m,
        10.0 - 0.4,
        1e-5,
    );
    let stopped = driven(&mut simulation, 200, 0.0, 0.0);
    is_near(stopped.distance_m, 10.0, 1e-5);
    assert_eq!(stopped.speed_m_s, 0.0);
}

#[test]
fn a_delay_loses_its_time_of_distance_also_if_it_is_no_multiple_of_the_step() {
    for delay_s in [0.2, 0.11, 0.003] {
        let mut simulation = rover(&format!("delay_s = {delay_s}"));
        is_near(
            driven(&mut simulation, 100, 1.0, 0.0).distance_m,
            5.0 - delay_s,
            1e-9,
        );
        is_near(driven(&mut simulation, 100, 0.0, 0.0).distance_m, 5.0, 1e-9);
    }
}

#[test]
fn the_turn_follows_with_the_same_lag_and_delay() {
    let mut simulation = rover("lag_s = 0.3, delay_s = 0.07");
    let robot = driven(&mut simulation, 60, 0.0, 0.5);
    is_near(robot.heading_rad, 0.5 * (3.0 - 0.37), 1e-4);
}

#[test]
fn a_gain_makes_a_robot_faster_than_its_limits() {
    let mut simulation = rover("gain = 1.2");
    is_near(
        driven(&mut simulation, 100, 9.0, 0.0).distance_m,
        1.2 * 5.0,
        1e-9,
    );
    let mut simulation = rover("gain = 0.5");
    is_near(driven(&mut simulation, 20, 0.0, 1.0).heading_rad, 0.5, 1e-9);
}

/// With track gains l and r, a robot that is to drive straight drives a circle of radius (width / 2) (l + r) / (r - l).
#[test]
fn unequal_tracks_drive_a_circle_of_the_closed_form() {
    let (left, right) = (2.0 * 1.25 / 2.25, 2.0 / 2.25);
    for (width, key) in [(0.5, ""), (0.8, ", track_width_m = 0.8")] {
        let mut simulation = rover(&format!("gain_left_right = 1.25{key}"));
        let radius_m = width / 2.0 * (left + right) / (right - left);
        let centre = Point {
            x: 100.0,
            y: 50.0 + radius_m,
        };
        for _ in 0..200 {
            let robot = driven(&mut simulation, 1, 0.7, 0.0);
            is_near(centre.to(robot.at).length(), radius_m.abs(), 1e-9);
        }
        is_near(first(&simulation).distance_m, 0.7 * 10.0, 1e-9);
    }
}

/// What a robot perceives of its own motion in its first step.
fn has_motion(errors: &str) -> bool {
    let mut simulation = rover(errors);
    let percept = simulation.percept(id(0, 0)).unwrap();
    percept.unwrap().motion.is_some()
}

#[test]
fn a_robot_with_errors_measures_its_motion_only_with_odometry() {
    assert!(has_motion("odometry = true"));
    assert!(!has_motion("odometry = false"));
    assert!(!has_motion("delay_s = 0.1"));
    assert!(has_motion("delay_s = 0.1, odometry = true"));
}

#[test]
fn a_wall_stops_a_robot_with_errors_at_once() {
    let errors = "lag_s = 1, delay_s = 0.3, gain = 2";
    let text = common::with(&with(errors), "world.size_m = [110, 100]");
    let mut simulation = start(&text);
    for _ in 0..300 {
        driven(&mut simulation, 1, 1.0, 0.0);
        if first(&simulation).collisions > 0 {
            break;
        }
    }
    let robot = first(&simulation);
    is_near(robot.at.x, 110.0 - 0.25, 1e-6);
    assert_eq!(robot.speed_m_s, 0.0);
}

#[test]
fn setpoints_in_the_delay_and_the_turn_rate_are_part_of_the_hash() {
    let hashes = |errors: &str| {
        let [mut one, mut other] = [rover(errors), rover(errors)];
        driven(&mut one, 1, 1.0, 0.0);
        driven(&mut other, 1, 0.5, 0.0);
        driven(&mut one, 1, 0.0, 0.0);
        driven(&mut other, 1, 0.0, 0.0);
        let are_alike = robots(&one) == robots(&other);
        (are_alike, one.hash() == other.hash())
    };
    assert_eq!(hashes("delay_s = 0.5"), (true, false));
    let mut turning = rover("lag_s = 0.2");
    let hash = turning.hash();
    driven(&mut turning, 1, 0.0, 1e-9);
    assert_ne!(turning.hash(), hash);
}

#[test]
fn a_restored_run_continues_with_the_setpoints_of_its_snapshot() {
    let errors = "lag_s = 0.2, delay_s = 0.33, gain_left_right = 1.1";
    let mut simulation = rover(errors);
    driven(&mut simulation, 10, 1.0, 0.4);
    let state = simulation.state().clone();
    let after = driven(&mut simulation, 30, 0.0, 0.0);
    simulation.restore(state);
    assert_eq!(driven(&mut simulation, 30, 0.0, 0.0), after);
}

#[test]
fn errors_can_change_in_a_run() {
    let mut simulation = rover("lag_s = 0.2, delay_s = 0.2");
    driven(&mut simulation, 60, 1.0, 0.0);
    // What was set before is still executed: 0.5 s after the change, the setpoints of 0.2 s before it are in force.
    simulation.change(scenario(&with("delay_s = 0.5"))).unwrap();
    let before = first(&simulation);
    is_near(before.speed_m_s, 1.0, 1e-4);
    is_near(
        driven(&mut simulation, 20, 0.0, 0.0).distance_m - before.distance_m,
        0.5,
        1e-4,
    );
    // Without a delay, a setpoint has its effect at once.
    simulation.change(scenario(&with("gain = 1.5"))).unwrap();
    assert_eq!(driven(&mut simulation, 1, 1.0, 0.0).speed_m_s, 1.5);
    // What a lower gain does not allow is limited at once.
    simulation
        .change(scenario(&with("gain = 0.5, lag_s = 9")))
        .unwrap();
    assert_eq!(first(&simulation).speed_m_s, 0.5);
    simulation
        .change(scenario(&with("odometry = true")))
        .unwrap();
    assert_eq!(driven(&mut simulation, 1, 1.0, 0.0).speed_m_s, 1.0);
}

/// A crowd of robots with all errors, some of them with a delay alone.
fn erring_crowd() -> String {
    let errors = "robots.bird.drive.delay_s = 0.25\nrobots.rover.sensors.gps.drift_m = 0.5\n\
                  robots.rover.drive = { lag_s = 0.2, delay_s = 0.03, gain = 1.1, gain_left_right = 1.05 }";
    common::with(&crowd(400, 60.0), errors)
}

#[test]
fn runs_are_the_same_for_any_number_of_threads() {
    let text = erring_crowd();
    let hash = |threads: usize| {
        let pool = ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| {
            let mut simulation = start(&text);
            (0..80).for_each(|_| simulation.step());
            simulation.hash()
        })
    };
    let alone = hash(1);
    assert_eq!([hash(2), hash(7)], [alone; 2]);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Two robots that drive at each other and past a wall never overlap, however much faster they are than their
    /// limits.
    #[test]
    fn robots_with_errors_never_overlap(
        gain in 0.2..2.0, ratio in 0.5..2.0, lag in 0.0..1.0, delay in 0.0..1.0, turns: [i8; 8],
    ) {
        let errors = format!("lag_s = {lag}, delay_s = {delay}, gain = {gain}, gain_left_right = {ratio}");
        let two = "world.size_m = [5, 4]\n\
                   robots.rover.start = { at_m = [[1, 2], [4, 2]], heading_deg = [0, 180] }";
        let text = common::with(&with(&errors), two);
        let mut simulation = start(&text);
        for turn in turns {
            for _ in 0..20 {
                let command = |sign: f64| crate::common::go(1.0, sign * f64::from(turn) / 100.0);
                step_with(&mut simulation, [(id(0, 0), command(1.0)), (id(0, 1), command(-1.0))]);
                let now = robots(&simulation);
                prop_assert!(now[0].at.to(now[1].at).length() >= 0.5 - 1e-6);
                for robot in now {
                    prop_assert!((0.25 - 1e-6..=4.75 + 1e-6).contains(&robot.at.x), "{robot:?}");
                    prop_assert!((0.25 - 1e-6..=3.75 + 1e-6).contains(&robot.at.y), "{robot:?}");
                    prop_assert!(robot.speed_m_s.abs() <= gain * (1.0 + 0.34 * 1.6 * 0.25) + 1e-9);
                }
            }
        }
    }
}
