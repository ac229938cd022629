//! Believed poses of robots that do not measure their own motion: how often they are as exact as stated,
//! and where waypoints are complete.

use crate::common::{first, id, scenario};
use base::geometry::Point;
use sim::simulation::Simulation;

/// Waypoints on an eight through a field, twice.
const WAYPOINTS: &str = "[8, 8], [22, 8], [30, 20], [22, 32], [8, 32], [22, 20], [32, 8], [32, 32], [20, 26], \
                         [8, 20], [20, 10], [8, 8], [30, 20], [8, 32]";

/// One robot that visits them, with a drive and the errors of a position sensor.
fn robot(drive: &str, gps: &str, within_m: f64, run: u64) -> Simulation {
    let text = format!(
        "[clock]\nstep_s = 0.1\ntime_limit_s = 1000\n[world]\nsize_m = [40, 40]\n\
         [robots.rover]\ncount = 1\nradius_m = 0.3\n\
         start = {{ kind = \"fixed\", at_m = [[4, 4]], heading_deg = [0] }}\n\
         drive = {{ max_speed_m_s = 0.6, max_acceleration_m_s2 = 1, max_turn_rate_deg_s = 60, {drive} }}\n\
         [robots.rover.sensors]\ngps = {{ kind = \"position\", rate_hz = 1, {gps} }}\n\
         compass = {{ kind = \"heading\", noise_deg = 1 }}\n\
         [robots.rover.brain]\nrate_hz = 5\n\
         behaviours = [{{ kind = \"navigate\", waypoints_m = [{WAYPOINTS}], within_m = {within_m} }}]\n"
    );
    Simulation::new(scenario(&text), 7, run).unwrap()
}

/// Where the brain believes the robot to be in a step, with the standard deviation, and the error of it.
fn believed(simulation: &mut Simulation) -> Option<(f64, f64)> {
    let before = first(simulation).at;
    simulation.step();
    let pose = simulation.state().belief_state(id(0, 0))?.pose?;
    Some((pose.deviation_m, pose.at.to(before).length()))
}

/// The share of steps, after the first ten seconds, in which the robot is within two standard deviations of
/// where it believes to be.
fn share_within_two_deviations(drive: &str, gps: &str) -> f64 {
    let (mut within, mut all) = (0_u32, 0_u32);
    for run in 0..12 {
        let mut simulation = robot(drive, gps, 1.5, run);
        for step in 0..1500 {
            let pose = believed(&mut simulation).filter(|_| step > 100 && step % 2 == 0);
            if let Some((deviation_m, off_m)) = pose {
                all += 1;
                within += u32::from(off_m <= 2.0 * deviation_m);
            }
        }
    }
    f64::from(within) / f64::from(all)
}

/// In the plane, a normal error is within two standard deviations in 86% of cases, 1 - exp(-2). Errors of
/// 12 runs of 140 s are correlated for some 10 s, so that a share has a standard error of 0.03.
#[test]
fn a_robot_is_where_it_believes_to_be_as_often_as_it_states() {
    let mut sum = 0.0;
    let gains = [0.5, 0.6, 0.8, 0.92, 1.0, 1.2];
    for gain in gains {
        let share =
            share_within_two_deviations(&format!("gain = {gain}, lag_s = 0.25"), "noise_m = 0.2");
        assert!((0.80..0.93).contains(&share), "{gain}: {share}");
        sum += share;
    }
    let mean = sum / 6.0;
    assert!((0.83..0.90).contains(&mean), "{mean}");
}

#[test]
fn it_also_is_with_other_lags_and_noise_and_with_unequal_tracks_and_drift() {
    for (drive, gps) in [
        ("lag_s = 0.02", "noise_m = 0.5"),
        ("lag_s = 0.5, delay_s = 0.1", "noise_m = 0.2"),
        ("gain_left_right = 1.05", "noise_m = 0.2"),
        ("gain = 0.8", "noise_m = 1.0"),
        ("gain = 0.8", "noise_m = 0.2, drift_m = 0.3, drift_s = 60"),
    ] {
        let share = share_within_two_deviations(drive, gps);
        assert!((0.78..0.95).contains(&share), "{drive} {gps}: {share}");
    }
}

/// The largest distance of the robot from the waypoints when they are complete, and their number.
fn visited(simulation: &mut Simulation) -> (f64, usize) {
    let next = |simulation: &Simulation| -> Option<Point> {
        let goals = simulation.state().belief_state(id(0, 0))?.goals;
        goals.first().map(|goal| goal.to)
    };
    let (mut farthest_m, mut count) = (0.0_f64, 0);
    let mut to = None;
    for _ in 0..6000 {
        let before = first(simulation).at;
        simulation.step();
        let then = next(simulation);
        if let Some(left) = to.filter(|_| then != to) {
            farthest_m = farthest_m.max(before.to(left).length());
            count += 1;
        }
        to = then;
    }
    (farthest_m, count)
}

#[test]
fn waypoints_are_complete_where_a_slow_robot_is() {
    let mut simulation = robot("gain = 0.92", "noise_m = 0.2", 1.5, 0);
    let (farthest_m, count) = visited(&mut simulation);
    assert_eq!(count, 14);
    // Three deviations of 0.15 m beyond.
    assert!(farthest_m < 1.95, "{farthest_m}");
}

#[test]
fn a_drift_that_the_tolerance_does_not_allow_for_makes_waypoints_impossible() {
    let mut simulation = robot("gain = 0.92", "noise_m = 0.1, drift_m = 0.5", 0.6, 0);
    let mut reasons = Vec::new();
    for _ in 0..2000 {
        simulation.step();
        let state = simulation.state().belief_state(id(0, 0)).unwrap();
        reasons.extend(state.goals.iter().filter_map(|goal| goal.reason));
    }
    assert!(reasons.contains(&brain::Reason::Position), "{reasons:?}");
}
