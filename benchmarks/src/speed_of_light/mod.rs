//! Speed of light: a program that can only do the work of the sensing team.
//!
//! Disc robots of one size with sixteen exact rays of 3 m, a minimal random reactive brain, a
//! differential drive, a battery, and contacts that push back. Every quantity is an array of its own,
//! robots are sorted by position whenever neighbour lists are rebuilt, and a whole step is one function,
//! compiled for the widest vectors of the machine. It shares only sines and noise with the simulator, and
//! lacks everything that makes the simulator useful: kinds of robots, sensors, latency, layers of
//! behaviours, messages, the order of collisions, and results that do not depend on the number of
//! threads.

#![expect(
    clippy::needless_bitwise_bool,
    reason = "branches would be mispredicted"
)]

mod lists;
mod rays;
mod step;

use crate::field::Field;
use base::geometry::{Disc, Point};

/// Radius of every robot, in metres.
pub(crate) const RADIUS_M: f64 = 0.2;
/// Range of the rays, in metres.
pub(crate) const RANGE_M: f64 = 3.0;
const STEP_S: f64 = 0.1;
const SPEED_M_S: f64 = 0.5;
const TURN_RAD_S: f64 = 1.5;

/// The robots and obstacles of one world.
pub(crate) struct Team {
    x: Vec<f64>,
    y: Vec<f64>,
    heading_rad: Vec<f64>,
    front: Vec<Point>,
    /// Remaining steps of a turn; negative to the right.
    turning: Vec<i32>,
    energy_j: Vec<f64>,
    key: Vec<u32>,
    pillars: Vec<Disc>,
    walls: Vec<[Point; 2]>,
    lists: lists::Lists,
    room: step::Room,
    side_m: f64,
    tick: u64,
    has_noise: bool,
    collisions: u64,
}

impl Team {
    /// A team on a field, with or without range noise.
    pub(crate) fn new(field: &Field, starts: &[(Point, f64)], has_noise: bool) -> Self {
        let (places, headings): (Vec<Point>, Vec<f64>) = starts.iter().copied().unzip();
        let sin_cos = |heading: &f64| {
            let (y, x) = base::trig::sin_cos(*heading);
            Point { x, y }
        };
        Self {
            x: places.iter().map(|place| place.x).collect(),
            y: places.iter().map(|place| place.y).collect(),
            front: headings.iter().map(sin_cos).collect(),
            heading_rad: headings,
            turning: vec![0; places.len()],
            energy_j: vec![0.0; places.len()],
            key: (0..).take(places.len()).collect(),
            pillars: field.pillars.clone(),
            walls: field.walls(),
            lists: lists::Lists::new(field.side_m, &field.pillars, &field.walls()),
            room: step::Room::default(),
            side_m: field.side_m,
            tick: 0,
            has_noise,
            collisions: 0,
        }
    }

    /// A checksum of the state.
    pub(crate) fn sum(&self) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "a sum of checks")]
        let collisions = self.collisions as f64;
        self.x.iter().chain(&self.energy_j).sum::<f64>() + collisions
    }
}
