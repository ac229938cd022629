//! Sensor footprints: how far sensors see past obstacles. For display only, no brain uses them.

use super::{NoRobot, Simulation};
use crate::run::agent::is_on;
use crate::sensors::Sensor;
use crate::sensors::buffers::RingBuffers;
use crate::sensors::outline::BlockedBy;
use crate::sensors::range::{Ring, spread};
use crate::sensors::scene::Scene;
use crate::sensors::sensor_kind::Provides;
use crate::step::robot_scene::RobotScene;
use crate::step::view::View;
use base::geometry::Point;
use base::trig::sin_cos;
use brain::AgentId;
use std::f64::consts::TAU;

/// Bearings per radian along which a sector is evaluated: one per degree.
const BEARINGS_PER_RAD: f64 = 360.0 / TAU;

/// An outline is drawn straight within this fraction of the range.
const STRAIGHT: f64 = 2e-4;

/// The sensors whose footprints are requested.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sensors {
    /// Item detectors.
    Items,
    /// Item detectors and range rings.
    All,
}

/// The area that a sensor covers now: its sector, as far as nothing blocks it.
///
/// It is blocked as in the run: a ring by everything that its rays meet, robots included; an item
/// detector by obstacles, if it needs a line of sight, and otherwise by nothing. A ring of few rays
/// measures nothing between them: its footprint is what its rays could meet.
#[derive(Debug, Clone, PartialEq)]
pub struct Footprint {
    /// Index of the sensor on the robot.
    pub sensor: usize,
    /// Whether it detects items.
    pub finds_items: bool,
    /// Maximum range.
    pub range_m: f64,
    /// Field of view, at most a full turn.
    pub width_rad: f64,
    /// Direction of its centre, relative to the robot's front.
    pub facing_rad: f64,
    /// Range along each of [`Footprint::bearings_rad`].
    pub ranges_m: Vec<f64>,
}

impl Simulation {
    /// The footprints of a robot's sensors that are on, in the order of the sensors; none if it can
    /// no longer move, or if its body is external. The run does not change.
    ///
    /// # Errors
    /// If there is no such robot.
    pub fn footprints(&mut self, id: AgentId, of: Sensors) -> Result<Vec<Footprint>, NoRobot> {
        let robot = self.number(id)?;
        let (view, agents) = self.view();
        if !view.is_simulated(robot) {
            return Ok(Vec::new());
        }
        let sensors = view.kind(robot).sensors.iter().enumerate();
        let on = sensors.filter(|(number, _)| is_on(agents[robot].sensors_off, *number));
        let footprints = on.filter_map(|(number, sensor)| {
            let is_shown = of == Sensors::All || sensor.facts.provides(Provides::Items);
            is_shown.then(|| view.footprint(robot, number, sensor))?
        });
        Ok(footprints.collect())
    }
}

impl View<'_> {
    /// The footprint of a sensor; `None` if it covers no area.
    fn footprint(&self, robot: usize, number: usize, sensor: &Sensor) -> Option<Footprint> {
        let outline = sensor.measure.outline()?;
        let mut footprint = Footprint {
            sensor: number,
            finds_items: sensor.facts.provides(Provides::Items),
            range_m: outline.range_m,
            width_rad: outline.width_rad,
            facing_rad: outline.facing_rad,
            ranges_m: vec![outline.range_m; bearings(outline.width_rad) as usize],
        };
        match outline.blocked_by {
            BlockedBy::Nothing => {}
            BlockedBy::Geometry => self.end_at_geometry(robot, &mut footprint),
            BlockedBy::Bodies => self.end_at_bodies(robot, &mut footprint),
        }
        Some(footprint)
    }

    fn end_at_geometry(&self, robot: usize, footprint: &mut Footprint) {
        let full_m = footprint.range_m;
        let frame = self.sensor_frame(robot, footprint.sensor, self.tick);
        let around = frame.geometry.around(frame.at, full_m);
        let bearings_rad = footprint.bearings_rad();
        for (range_m, bearing_rad) in footprint.ranges_m.iter_mut().zip(bearings_rad) {
            let (y, x) = sin_cos(bearing_rad);
            let end = frame.world_of(Point { x, y }.times(full_m));
            *range_m *= around.open_share(end);
        }
    }

    fn end_at_bodies(&self, robot: usize, footprint: &mut Footprint) {
        let full_m = footprint.range_m;
        let mut buffers = RingBuffers::default();
        let at = self.discs[robot].centre;
        RobotScene {
            view: self,
            robot,
            at,
        }
        .gather(&mut buffers.near);
        let frame = self.sensor_frame(robot, footprint.sensor, self.tick);
        let ring = Ring::exact(full_m, &footprint.bearings_rad());
        ring.distances(&frame, &mut buffers, &mut footprint.ranges_m);
        let ranges_m = footprint.ranges_m.iter_mut();
        // A ray that meets nothing has no return.
        ranges_m.for_each(|range_m| *range_m = range_m.min(full_m));
    }
}

impl Footprint {
    /// Directions relative to the robot's front, evenly spaced over the sector, from -pi to pi: a
    /// full circle has none twice, a sector has one on each edge.
    #[must_use]
    pub fn bearings_rad(&self) -> Vec<f64> {
        spread(bearings(self.width_rad), self.width_rad, self.facing_rad)
    }

    /// Its outline, as ascending bearings relative to the robot's front, and distances: between two
    /// at full range lies an arc, between others a straight line.
    ///
    /// A full circle ends where it begins; a sector is closed by the robot's position.
    #[must_use]
    pub fn corners(&self) -> Vec<[f64; 2]> {
        let is_whole = self.width_rad >= TAU;
        let count = self.ranges_m.len();
        let parts = if is_whole { count } else { count - 1 }.max(1);
        let first_rad = self.facing_rad - if is_whole { 0.0 } else { self.width_rad / 2.0 };
        #[expect(clippy::cast_precision_loss, reason = "361 at most")]
        let corner = |place: usize| {
            let share = place as f64 / parts as f64;
            [
                first_rad + share * self.width_rad,
                self.ranges_m[place % count],
            ]
        };
        let mut last = corner(0);
        let mut corners = vec![last];
        for place in 1..parts {
            let [this, next] = [corner(place), corner(place + 1)];
            if !self.is_smooth([last, this, next]) {
                corners.push(this);
                last = this;
            }
        }
        corners.push(corner(parts));
        corners
    }

    /// Whether three corners lie on its arc, or nearly on a line.
    fn is_smooth(&self, corners: [[f64; 2]; 3]) -> bool {
        let is_full = corners.map(|[_, range_m]| range_m >= self.range_m);
        if is_full[0] && is_full[1] {
            return is_full[2];
        }
        let [last, this, next] = corners.map(|[bearing_rad, range_m]| {
            let (y, x) = sin_cos(bearing_rad);
            Point { x, y }.times(range_m)
        });
        let way = last.to(next);
        way.cross(last.to(this)).abs() <= STRAIGHT * self.range_m * way.length()
    }
}

/// Number of bearings along which a sector is evaluated.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "360 at most"
)]
fn bearings(width_rad: f64) -> u32 {
    let parts = (width_rad * BEARINGS_PER_RAD).ceil() as u32;
    if width_rad >= TAU { 360 } else { parts + 1 }
}
