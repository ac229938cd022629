//! Pose estimation in a brain without a simulator, for correct and wrong readings of wheels, compass
//! and position sensor.

use crate::{body, now, percept_at};
use base::geometry::Point;
use base::random::{Entity, Purpose, Stream, stream, unit};
use base::trig::wrapped;
use brain::{Body, Brain, Motion, Percept, Pose, Reading};
use std::f64::consts::{PI, TAU};

const STANDING: Motion = Motion {
    speed_m_s: 0.0,
    turn_rate_rad_s: 0.0,
};

fn noisy() -> Body {
    Body {
        position_noise_m: 0.1,
        heading_noise_rad: 0.02,
        ..body()
    }
}

fn brain(behaviour: &str, body: Body) -> Brain {
    let spec = format!(
        r#"{{"behaviours": [{{"kind": "{behaviour}"}}], "beliefs": {{}},
            "limit_speed_to_stopping_distance": false}}"#
    );
    crate::brain(&spec, body)
}

/// A brain that commands zero speed.
fn still(body: Body) -> Brain {
    brain("hold_position", body)
}

fn at(x: f64, heading_rad: f64) -> Percept {
    Percept {
        motion: now(STANDING),
        ..percept_at(x, x, heading_rad)
    }
}

fn wheels(speed_m_s: f64, turn_rate_rad_s: f64, age_s: f64) -> Percept {
    let value = Motion {
        speed_m_s,
        turn_rate_rad_s,
    };
    Percept {
        motion: Some(Reading { value, age_s }),
        ..Percept::default()
    }
}

fn pose(brain: &Brain) -> Pose {
    brain.belief_state().unwrap().pose.unwrap()
}

/// The pose after a number of equal percepts.
fn after(brain: &mut Brain, steps: usize, percept: &Percept) -> Pose {
    for _ in 0..steps {
        brain.step(percept);
    }
    pose(brain)
}

/// The distance of a pose from (x, x).
fn off_m(pose: &Pose, x: f64) -> f64 {
    pose.at.to(Point { x, y: x }).length()
}

/// The estimated distance driven in 20 s at a command of 1 m/s.
fn driven_m(percept: &Percept) -> f64 {
    let mut brain = brain("cruise", noisy());
    after(&mut brain, 1, &at(0.0, 0.0));
    after(&mut brain, 200, percept).at.x
}

#[test]
fn wheel_odometry_overrides_the_commanded_speed() {
    let driven_m = driven_m(&wheels(0.5, 0.0, 0.0));
    assert!((driven_m - 10.0).abs() < 0.2, "{driven_m}");
}

#[test]
fn without_wheel_odometry_the_commanded_speed_counts_after_the_assumed_lag() {
    // 20 m, less 0.5 m of an acceleration by 1 m/s2, and less 0.25 s at 1 m/s.
    let driven_m = driven_m(&Percept::default());
    assert!((driven_m - 19.25).abs() < 0.01, "{driven_m}");
}

#[test]
fn old_and_implausible_wheel_readings_are_ignored() {
    for speed_m_s in [1e9, -1e9, f64::NAN, f64::INFINITY] {
        let driven_m = driven_m(&wheels(speed_m_s, 0.0, 0.0));
        assert!((driven_m - 19.25).abs() < 0.01, "{speed_m_s}: {driven_m}");
    }
    for (speed_m_s, age_s) in [(1.0, 1000.0), (1.0, -1.0), (1e9, 0.0), (f64::NAN, 0.0)] {
        let mut brain = still(noisy());
        after(&mut brain, 1, &at(3.0, 0.0));
        let pose = after(&mut brain, 300, &wheels(speed_m_s, speed_m_s, age_s));
        assert!(off_m(&pose, 3.0) < 1e-9, "{speed_m_s} {age_s}: {pose:?}");
        assert!(
            pose.heading_rad.abs() < 1e-9,
            "{speed_m_s} {age_s}: {pose:?}"
        );
    }
}

#[test]
fn a_single_outlier_in_position_is_rejected() {
    for absurd_m in [1e6, 500.0, 11.0] {
        let mut brain = still(noisy());
        after(&mut brain, 100, &at(10.0, 0.0));
        let pose = after(&mut brain, 1, &at(absurd_m, 0.0));
        assert!(off_m(&pose, 10.0) < 1e-9, "{absurd_m}: {pose:?}");
        let pose = after(&mut brain, 1, &at(10.0, 0.0));
        assert!(off_m(&pose, 10.0) < 1e-9, "{absurd_m}: {pose:?}");
    }
}

#[test]
fn a_wrong_first_position_is_replaced_at_the_third_consistent_one() {
    let mut brain = still(noisy());
    after(&mut brain, 1, &at(1e6, 0.0));
    assert!(off_m(&after(&mut brain, 2, &at(10.0, 0.0)), 10.0) > 1e5);
    let pose = after(&mut brain, 1, &at(10.0, 0.0));
    assert!(off_m(&pose, 10.0) < 1e-9, "{pose:?}");
    assert!((pose.deviation_m - 0.1).abs() < 1e-9, "{pose:?}");
}

#[test]
fn a_relocation_after_a_long_rest_is_accepted_after_three_readings() {
    let mut brain = still(noisy());
    after(&mut brain, 6000, &at(10.0, 0.0));
    let pose = after(&mut brain, 3, &at(15.0, 0.0));
    assert!(off_m(&pose, 15.0) < 1e-9, "{pose:?}");
}

#[test]
fn a_small_relocation_after_a_long_rest_is_tracked_within_a_minute() {
    let mut brain = still(noisy());
    after(&mut brain, 6000, &at(10.0, 0.0));
    let pose = after(&mut brain, 600, &at(10.3, 0.0));
    assert!(off_m(&pose, 10.3) < 0.1, "{pose:?}");
}

#[test]
fn a_single_outlier_in_heading_is_rejected_and_three_in_agreement_are_accepted() {
    let (west, east) = (PI - 0.01, 0.0);
    let mut brain = still(noisy());
    after(&mut brain, 100, &at(0.0, west));
    // The same distance across the wrap of angles.
    after(&mut brain, 100, &at(0.0, west - TAU));
    let pose = after(&mut brain, 2, &at(0.0, east));
    assert!(wrapped(pose.heading_rad - west).abs() < 1e-6, "{pose:?}");
    after(&mut brain, 1, &at(0.0, west));
    let pose = after(&mut brain, 2, &at(0.0, east));
    assert!(wrapped(pose.heading_rad - west).abs() < 1e-6, "{pose:?}");
    let pose = after(&mut brain, 1, &at(0.0, east));
    assert!((pose.heading_rad - east).abs() < 1e-9, "{pose:?}");
    assert!((pose.deviation_rad - 0.02).abs() < 1e-9, "{pose:?}");
}

#[test]
fn exact_sensors_are_followed_at_once_even_after_a_relocation() {
    let exact = Body {
        position_noise_m: 0.0,
        heading_noise_rad: 0.0,
        ..body()
    };
    let mut brain = still(exact);
    for (x, heading_rad) in [(10.0, 0.0), (15.0, 3.0), (-5.0, -3.0)] {
        let pose = after(&mut brain, 1, &at(x, heading_rad));
        assert!(off_m(&pose, x) < 1e-9 && (pose.heading_rad - heading_rad).abs() < 1e-9);
        assert!(pose.deviation_m < 1e-9 && pose.deviation_rad < 1e-9);
    }
}

/// A normally distributed number (Box and Muller, *A note on the generation of random normal
/// deviates*, 1958).
fn normal(random: &mut Stream) -> f64 {
    let (one, other) = (1.0 - unit(random), unit(random));
    (-2.0 * one.ln()).sqrt() * (TAU * other).cos()
}

/// The true motion of a robot; its wheels have the relative error that the brain assumes.
struct Truth {
    at: Point,
    heading_rad: f64,
    random: Stream,
}

impl Truth {
    fn new(run: u64) -> Self {
        let robot = Entity { kind: 0, index: 0 };
        Self {
            at: Point::default(),
            heading_rad: 0.0,
            random: stream(7, run, robot, Purpose::Start),
        }
    }

    /// One step with the motion of the wheels plus their error.
    fn go(&mut self, measured: Motion) {
        let mut done = |rate: f64| 0.1 * rate * (1.0 + 0.02 * normal(&mut self.random));
        let [way_m, turn_rad] = [measured.speed_m_s, measured.turn_rate_rad_s].map(&mut done);
        let (y, x) = (self.heading_rad + turn_rad / 2.0).sin_cos();
        self.at = self.at.plus(Point { x, y }.times(way_m));
        self.heading_rad = wrapped(self.heading_rad + turn_rad);
    }

    /// Readings with the stated noise.
    fn read_into(&mut self, percept: &mut Percept) {
        let [x, y, turn] = std::array::from_fn(|_| normal(&mut self.random));
        let position = self.at.plus(Point { x, y }.times(0.1));
        percept.position = now(position);
        percept.heading_rad = now(self.heading_rad + 0.02 * turn);
    }

    /// Squared errors of the pose in standard deviations: position per axis, and heading.
    fn squares(&self, pose: &Pose) -> [f64; 2] {
        let off_m2 = pose.at.to(self.at).length_squared() / 2.0;
        let off_rad = wrapped(pose.heading_rad - self.heading_rad);
        [
            off_m2 / (pose.deviation_m * pose.deviation_m),
            off_rad * off_rad / (pose.deviation_rad * pose.deviation_rad),
        ]
    }
}

/// Their root mean squares over some minutes at a speed, with readings in every `apart`-th step.
fn rms_z(speed_m_s: f64, apart: u32) -> [f64; 2] {
    let (runs, steps) = (20_u32, 600_u32);
    let mut sums = [0.0; 2];
    for run in 0..runs {
        let (mut truth, mut brain) = (Truth::new(run.into()), still(noisy()));
        for step in 0..steps {
            let turn_rate_rad_s = speed_m_s * (0.02 * f64::from(step)).sin();
            let measured = Motion {
                speed_m_s: speed_m_s.min(f64::from(step)),
                turn_rate_rad_s,
            };
            truth.go(measured);
            let mut percept = wheels(measured.speed_m_s, measured.turn_rate_rad_s, 0.0);
            if step.is_multiple_of(apart) {
                truth.read_into(&mut percept);
            }
            brain.step(&percept);
            let squares = truth.squares(&pose(&brain));
            sums = [sums[0] + squares[0], sums[1] + squares[1]];
        }
    }
    sums.map(|sum| (sum / f64::from(runs * steps)).sqrt())
}

#[test]
fn the_stated_deviations_match_the_actual_errors() {
    for (speed_m_s, apart) in [(1.0, 1), (1.0, 10), (0.0, 1), (0.0, 10)] {
        let z = rms_z(speed_m_s, apart);
        let is_as_stated = z.iter().all(|z| (0.8..1.1).contains(z));
        assert!(is_as_stated, "{speed_m_s} m/s, {apart} apart: {z:?}");
    }
}
