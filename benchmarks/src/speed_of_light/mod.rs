//! Speed of light: the sensing team's work by a program that can do nothing else.
//!
//! Disc robots of one size with sixteen exact rays of 3 m, a tiny reactive brain with chance, a
//! differential drive, a battery, and contacts that are pushed back. Everything is an array of its
//! own, robots are sorted by place whenever the lists of what is near are made anew, and a whole
//! step is one function, compiled for the machine's widest vectors. It shares no code with the
//! simulator but sines and noise. Whatever makes the simulator worth having is not in it: kinds of
//! robots, sensors, latency, layers of behaviours, messages, the order of collisions, steps that any
//! number of threads take to the same end.

#![expect(
    clippy::needless_bitwise_bool,
    reason = "branches would be mispredicted"
)]

mod lists;
mod rays;
mod step;

use crate::field::Field;
use base::geometry::{Disc, Point};

/// Of every robot, in metres.
pub(crate) const RADIUS_M: f64 = 0.2;
/// How far rays go.
pub(crate) const RANGE_M: f64 = 3.0;
const STEP_S: f64 = 0.1;
const SPEED_M_S: f64 = 0.5;
const TURN_RAD_S: f64 = 1.5;

/// The robots of one world, and what stands in it.
pub(crate) struct Team {
    x: Vec<f64>,
    y: Vec<f64>,
    heading_rad: Vec<f64>,
    front: Vec<Point>,
    /// Steps left of a turn; negative to the right.
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
    /// A team on a field; with noise on ranges or not.
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

    /// A number that depends on all that happened.
    pub(crate) fn sum(&self) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "a sum of checks")]
        let collisions = self.collisions as f64;
        self.x.iter().chain(&self.energy_j).sum::<f64>() + collisions
    }
}
