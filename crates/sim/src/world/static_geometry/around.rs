//! Static geometry around a place, for many segments from it.

use super::{StaticGeometry, Wall, crossed_at, shifted};
use crate::world::grid::Still;
use base::geometry::{Disc, Point, Rectangle};

/// Walls and discs that straight segments from a place can cross.
#[derive(Debug, Clone)]
pub(crate) struct Around {
    place: Point,
    walls: Vec<Wall>,
    discs: Vec<Disc>,
}

impl StaticGeometry {
    /// What segments from a place of at most `reach_m` can cross.
    pub(crate) fn around(&self, place: Point, reach_m: f64) -> Around {
        let mut around = Around {
            place,
            walls: Vec::new(),
            discs: Vec::new(),
        };
        around.take(self, Point::default(), reach_m);
        // Beyond a side of a periodic world only the nearest image is known at the place itself.
        if let Some(torus) = self.torus {
            let world = Rectangle::spanned(Point::default(), torus.size_m);
            for by in torus.shifts() {
                let [low, high] = corners(place.plus(by), reach_m);
                if world.overlaps(&Rectangle::spanned(low, high)) {
                    around.take(self, by, reach_m);
                }
            }
        }
        around
    }
}

impl Around {
    /// Adds what is around the image of the place with this offset.
    fn take(&mut self, geometry: &StaticGeometry, by: Point, reach_m: f64) {
        let (place, back) = (self.place, by.times(-1.0));
        let [low, high] = corners(place.plus(by), reach_m);
        let walls = geometry.near_walls.within(low, high).into_iter();
        let walls = walls.map(|number| geometry.wall(number).shifted(back));
        self.walls
            .extend(walls.filter(|wall| wall.distance(place) < reach_m));
        let discs = geometry.near_discs.within(low, high).into_iter();
        let discs = discs.map(|number| shifted(geometry.disc(number), back));
        self.discs
            .extend(discs.filter(|disc| disc.distance(place) < reach_m));
    }

    /// The fraction of the straight segment from the place to another before everything that it
    /// crosses: 1 if it is free.
    pub(crate) fn open_share(&self, to: Point) -> f64 {
        let way = self.place.to(to);
        let walls = self.walls.iter();
        let walls = walls.filter_map(|wall| wall.crossed_at(self.place, way));
        let discs = self.discs.iter();
        let discs = discs.filter_map(|disc| crossed_at(disc, self.place, way));
        walls.chain(discs).fold(1.0, f64::min)
    }
}

fn corners(place: Point, reach_m: f64) -> [Point; 2] {
    let corner = Point {
        x: reach_m,
        y: reach_m,
    };
    [corner.to(place), place.plus(corner)]
}
