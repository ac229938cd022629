//! The robots and obstacles of one world.

use super::lists::Lists;
use super::room::Room;
use crate::field::Field;
use base::geometry::{Disc, Point};

/// The robots and obstacles of one world.
pub(crate) struct Team {
    pub(super) x: Vec<f64>,
    pub(super) y: Vec<f64>,
    pub(super) heading_rad: Vec<f64>,
    pub(super) front: Vec<Point>,
    /// Remaining steps of a turn; negative to the right.
    pub(super) turning: Vec<i32>,
    pub(super) energy_j: Vec<f64>,
    pub(super) key: Vec<u32>,
    pub(super) pillars: Vec<Disc>,
    pub(super) walls: Vec<[Point; 2]>,
    pub(super) lists: Lists,
    pub(super) room: Room,
    pub(super) side_m: f64,
    pub(super) tick: u64,
    pub(super) has_noise: bool,
    pub(super) collisions: u64,
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
            lists: Lists::new(field.side_m, &field.pillars, &field.walls()),
            room: Room::default(),
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

    /// Rebuilds the neighbour lists if necessary.
    pub(super) fn refresh(&mut self) {
        if !self.lists.are_outdated() {
            return;
        }
        let order = self.lists.sort(&self.x, &self.y);
        for values in [
            &mut self.x,
            &mut self.y,
            &mut self.heading_rad,
            &mut self.energy_j,
        ] {
            reordered(values, order);
        }
        reordered(&mut self.front, order);
        reordered(&mut self.turning, order);
        reordered(&mut self.key, order);
        let places = [&self.x[..], &self.y[..]];
        self.lists.rebuild(places, &self.pillars, &self.walls);
    }
}

fn reordered<T: Copy>(values: &mut Vec<T>, order: &[u32]) {
    *values = order.iter().map(|robot| values[*robot as usize]).collect();
}
