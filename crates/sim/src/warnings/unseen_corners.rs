//! Warnings about range sensors whose rays are so far apart where the robot stops that it may touch what is
//! between them. docs/brains.md has the measured rates.

use crate::bodies::RobotSpec;
use crate::scenario::Checked;
use crate::sensors::{Measures, SensorSpec};
use crate::world::obstacles::ObstacleSpec;
use base::document::Place;
use base::geometry::Point;
use base::trig::sin_cos;
use base::warning::Warning;
use brain::{MAX_CORNER_SINE, stopping_m};
use std::f64::consts::FRAC_PI_2;

/// Of rays between which corners do not count, by how much a corner may protrude without a warning, as a
/// fraction of the robot's radius.
const MAX_PROTRUSION: f64 = 0.75;

/// Maximum number of rays of a sensor.
const MAX_RAYS: f64 = 1440.0;

pub(super) fn warnings(checked: &Checked, at: &Place) -> Vec<Warning> {
    let spec = &checked.spec;
    if spec.world.obstacles.is_empty() {
        return Vec::new();
    }
    let widths_m = spec.world.obstacles.iter().filter_map(width_m);
    let narrowest_m = widths_m.fold(f64::INFINITY, f64::min);
    let robots = spec.robots.iter();
    let limited = robots.filter(|(_, robot)| is_limited(robot));
    let found = limited.filter_map(|(name, robot)| {
        let (sensor, rays) = finest(robot, spec.clock.step_s)?;
        let effect = rays.effect(narrowest_m, robot.radius_m)?;
        let at = at.key("robots").key(name).key("sensors").key(sensor);
        Some(at.key("rays").warning(effect))
    });
    found.collect()
}

/// Whether a robot drives itself, and no faster than it can stop within what it sees.
fn is_limited(robot: &RobotSpec) -> bool {
    let is_driven = robot.count > 0 && !robot.brain.behaviours.is_empty();
    is_driven && robot.brain.limit_speed_to_stopping_distance
}

/// The width of an obstacle between two parallel lines, about the smallest one. That of a map is not known.
fn width_m(obstacle: &ObstacleSpec) -> Option<f64> {
    match obstacle {
        ObstacleSpec::Polygon { polygon_m, .. } => {
            let ends = polygon_m.iter().skip(1).chain(polygon_m.first());
            let sides = polygon_m.iter().zip(ends);
            let widths = sides.map(|(&from, &to)| width_along_m(polygon_m, from.to(to)));
            widths.reduce(f64::min)
        }
        ObstacleSpec::Circle { circle, .. } => Some(2.0 * circle.radius_m),
        ObstacleSpec::Rectangle { rectangle, .. } => {
            let [width, height] = rectangle.size_m;
            Some(width.0.min(height.0))
        }
        ObstacleSpec::Map { .. } => None,
    }
}

/// The width of a polygon between two lines that are parallel to one of its sides.
fn width_along_m(corners: &[Point], side: Point) -> f64 {
    let across = Point {
        x: -side.y,
        y: side.x,
    };
    let at = corners.iter().map(|corner| corner.dot(across));
    let (low, high) = at.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| {
        (low.min(at), high.max(at))
    });
    (high - low) / side.length()
}

/// The range sensor of a robot with the closest rays, and its rays where the robot stops.
fn finest(robot: &RobotSpec, step_s: f64) -> Option<(&str, Rays)> {
    let sensors = robot.sensors.iter().filter_map(|(name, sensor)| {
        let rays = Rays::new(robot, sensor, step_s)?;
        Some((name.as_str(), rays))
    });
    sensors.min_by(|(_, one), (_, other)| one.gap_rad.total_cmp(&other.gap_rad))
}

/// Rays of a sensor where a robot stops.
#[derive(Debug, Clone, Copy)]
struct Rays {
    count: u32,
    gap_rad: f64,
    speed_m_s: f64,
    /// How far from its centre something must be seen for the robot to stop before it.
    stop_m: f64,
}

impl Rays {
    fn new(robot: &RobotSpec, sensor: &SensorSpec, step_s: f64) -> Option<Self> {
        let Measures::Range(range) = &sensor.measures else {
            return None;
        };
        let gap_rad = range.gap_rad()?;
        let speed_m_s = robot.drive.max_speed_m_s;
        let deceleration = robot.drive.max_acceleration_m_s2;
        let braking_m = deceleration.map_or(0.0, |rate| stopping_m(speed_m_s, rate));
        let interval_s = sensor.rate_hz.map_or(step_s, |rate_hz| 1.0 / rate_hz);
        let late_m = speed_m_s * (interval_s.max(step_s) + sensor.latency_s);
        Some(Self {
            count: range.rays,
            gap_rad,
            speed_m_s,
            stop_m: robot.radius_m + braking_m + late_m,
        })
    }

    /// What the robot may touch, and the number of rays with which it sees it in time.
    fn effect(&self, narrowest_m: f64, radius_m: f64) -> Option<String> {
        let sine = sin_cos(self.gap_rad.min(FRAC_PI_2)).0;
        let apart_m = self.stop_m * sine;
        let is_flat = sine > MAX_CORNER_SINE;
        let is_unseen = apart_m > narrowest_m;
        let is_touched = is_flat && apart_m > MAX_PROTRUSION * radius_m;
        if !is_unseen && !is_touched {
            return None;
        }
        let mut max_sine = sine.min(MAX_CORNER_SINE);
        let mut touched = "corners".to_owned();
        if is_unseen {
            max_sine = max_sine.min(narrowest_m / self.stop_m);
            touched = format!("corners and obstacles of {narrowest_m:.2} m");
        }
        let closer = self.gap_rad / libm::asin(max_sine);
        let enough = (f64::from(self.count) * closer).ceil().min(MAX_RAYS);
        let (count, speed_m_s, stop_m) = (self.count, self.speed_m_s, self.stop_m);
        Some(format!(
            "{count} rays are {apart_m:.2} m apart at {stop_m:.2} m, where the robot must see an obstacle to stop from \
             {speed_m_s} m/s: it may touch {touched} between them; set at least {enough:.0} rays, or a lower speed"
        ))
    }
}
