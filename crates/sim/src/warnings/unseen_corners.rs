//! Warnings about range sensors whose rays are, where the robot must see an obstacle to stop, farther apart than what it
//! may then touch. docs/brains.md has the measured rates.

use crate::bodies::{Layer, RobotSpec};
use crate::scenario::Checked;
use crate::sensors::SensorSpec;
use crate::sensors::range::RangeSpec;
use crate::sensors::sensor_kind::AmongKinds;
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

/// A sensor sees what is ahead if its rays reach as far to both sides, in degrees.
const MIN_SIDE_DEG: f64 = 30.0;

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
        let effect = rays.effect(narrowest_m)?;
        let at = at.key("robots").key(name).key("sensors").key(sensor);
        Some(at.key("rays").warning(effect))
    });
    found.collect()
}

/// Whether a robot on the ground drives itself, and no faster than it can stop within what it sees.
fn is_limited(robot: &RobotSpec) -> bool {
    let is_driven = robot.count > 0 && !robot.brain.behaviours.is_empty();
    is_driven && robot.layer == Layer::Ground && robot.brain.limit_speed_to_stopping_distance
}

/// The width of an obstacle between two parallel lines, about the smallest one: of the convex hull of a polygon. That of
/// a map is not known.
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

/// The range sensor of a robot with the closest rays ahead as far as where it stops, and its rays there.
fn finest(robot: &RobotSpec, step_s: f64) -> Option<(&str, Rays)> {
    let sensors = robot.sensors.iter().filter_map(|(name, sensor)| {
        let rays = Rays::new(robot, sensor, step_s)?;
        Some((name.as_str(), rays))
    });
    sensors.min_by(|(_, one), (_, other)| {
        let by_range = one.is_short.cmp(&other.is_short);
        by_range.then(one.gap_rad.total_cmp(&other.gap_rad))
    })
}

/// Rays of a sensor where a robot stops.
#[derive(Debug, Clone, Copy)]
struct Rays {
    count: u32,
    gap_rad: f64,
    /// Whether the first ray is the last one's neighbour.
    is_full: bool,
    /// Whether the robot needs more than the range of the sensor to stop.
    is_short: bool,
    radius_m: f64,
    speed_m_s: f64,
    /// How far from its centre something must be seen for the robot to stop before it.
    stop_m: f64,
}

impl Rays {
    /// `None` unless the sensor has several rays, to both sides of the direction ahead.
    fn new(robot: &RobotSpec, sensor: &SensorSpec, step_s: f64) -> Option<Self> {
        let range = RangeSpec::of(&sensor.measures)?;
        let gap_rad = range.gap_rad()?;
        if range.fov_deg < 2.0 * (range.facing_deg.abs() + MIN_SIDE_DEG) && range.fov_deg < 360.0 {
            return None;
        }
        let speed_m_s = robot.drive.max_speed_m_s;
        let deceleration = robot.drive.max_acceleration_m_s2;
        let braking_m = deceleration.map_or(0.0, |rate| stopping_m(speed_m_s, rate));
        let rates = [sensor.rate_hz, robot.brain.rate_hz].into_iter().flatten();
        let interval_s = rates.map(|rate_hz| 1.0 / rate_hz).fold(step_s, f64::max);
        let stop_m = robot.radius_m + braking_m + speed_m_s * (interval_s + sensor.latency_s);
        Some(Self {
            count: range.rays,
            gap_rad,
            is_full: range.fov_deg >= 360.0,
            is_short: range.range_m < stop_m,
            radius_m: robot.radius_m,
            speed_m_s,
            stop_m: stop_m.min(range.range_m),
        })
    }

    /// What the robot may touch, and what prevents it.
    fn effect(&self, narrowest_m: f64) -> Option<String> {
        let sine = sin_cos(self.gap_rad.min(FRAC_PI_2)).0;
        let apart_m = self.stop_m * sine;
        let is_flat = sine > MAX_CORNER_SINE;
        let is_unseen = apart_m > narrowest_m;
        let is_touched = is_flat && apart_m > MAX_PROTRUSION * self.radius_m;
        if !is_unseen && !is_touched {
            return None;
        }
        let thin = format!(" and obstacles of {narrowest_m:.3} m");
        let thin = if is_unseen { thin } else { String::new() };
        let (count, speed_m_s, stop_m) = (self.count, self.speed_m_s, self.stop_m);
        let advice = self.advice(
            sine,
            if is_unseen {
                narrowest_m
            } else {
                f64::INFINITY
            },
        );
        Some(format!(
            "{count} rays are {apart_m:.3} m apart at {stop_m:.2} m, where the robot must see an obstacle to stop from \
             {speed_m_s} m/s: it may touch corners{thin} between them; set {advice}"
        ))
    }

    /// The number of rays with which the robot sees an obstacle of a width in time, if a sensor can have as many, and a
    /// lower speed if the robot would then see it.
    fn advice(&self, sine: f64, narrowest_m: f64) -> String {
        let max_sine = sine.min(MAX_CORNER_SINE).min(narrowest_m / self.stop_m);
        let max_gap_rad = libm::asin(max_sine);
        let gaps = f64::from(self.count - u32::from(!self.is_full));
        let enough = (gaps * self.gap_rad / max_gap_rad - 1e-9).ceil();
        let enough = enough + f64::from(u8::from(!self.is_full));
        let standing_m = self.radius_m * sine;
        let has_speed = standing_m < narrowest_m.min(MAX_PROTRUSION * self.radius_m);
        match (enough <= MAX_RAYS, has_speed) {
            (true, true) => format!("at least {enough:.0} rays, or a lower speed"),
            (true, false) => format!("at least {enough:.0} rays"),
            (false, true) => "a lower speed".to_owned(),
            (false, false) => format!("up to {MAX_RAYS:.0} rays and a lower speed"),
        }
    }
}
