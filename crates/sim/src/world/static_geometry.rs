//! The static geometry of one layer, indexed by place.

mod around;

use super::grid::{NearCells, Still};
use base::geometry::{Disc, Point, Rectangle, Segment, Torus};

/// Up to this number, a linear search is faster than an index.
const FEW: usize = 12;

/// A point nearer to a wall than this fraction of the segment to it is on the wall.
const HAIR: f64 = 1e-9;

/// A straight side of something solid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Wall {
    pub(crate) start: Point,
    /// Unit vector, with free space to its left.
    pub(crate) along: Point,
    pub(crate) length: f64,
}

impl Wall {
    /// The wall of a segment, if that has a length.
    pub(crate) fn of(segment: &Segment) -> Option<Self> {
        let length = segment.length_m();
        (length > 0.0).then(|| Self {
            start: segment.from,
            along: segment.way().times(1.0 / length),
            length,
        })
    }

    #[inline]
    pub(crate) fn end(&self) -> Point {
        self.start.plus(self.along.times(self.length))
    }

    fn shifted(&self, by: Point) -> Self {
        Self {
            start: self.start.plus(by),
            ..*self
        }
    }

    fn segment(&self) -> Segment {
        Segment {
            from: self.start,
            to: self.end(),
        }
    }
}

impl Still for Wall {
    fn bounds(&self) -> [Point; 2] {
        let bounds = Rectangle::spanned(self.start, self.end());
        [bounds.min(), bounds.max()]
    }

    fn distance(&self, from: Point) -> f64 {
        self.segment().distance_m(from)
    }
}

impl Still for Disc {
    fn bounds(&self) -> [Point; 2] {
        let corner = Point {
            x: self.radius_m,
            y: self.radius_m,
        };
        [corner.to(self.centre), self.centre.plus(corner)]
    }

    fn distance(&self, from: Point) -> f64 {
        self.distance_m(from)
    }
}

/// Walls and discs, indexed by place.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct StaticGeometry {
    walls: Vec<Wall>,
    /// First those that overlap no other.
    discs: Vec<Disc>,
    apart: u32,
    near_walls: NearCells,
    near_discs: NearCells,
    torus: Option<Torus>,
}

impl StaticGeometry {
    /// For queries of at most `reach_m`.
    pub(crate) fn new(size_m: Point, walls: &[Wall], discs: &[Disc], reach_m: f64) -> Self {
        let overlaps = overlaps(discs);
        let those = |overlap: bool| {
            let pairs = discs.iter().zip(&overlaps);
            pairs.filter_map(move |(disc, overlaps)| (*overlaps == overlap).then_some(*disc))
        };
        let discs: Vec<Disc> = those(false).chain(those(true)).collect();
        Self {
            near_walls: NearCells::new(size_m, walls, reach_m),
            near_discs: NearCells::new(size_m, &discs, reach_m),
            walls: walls.to_vec(),
            #[expect(clippy::cast_possible_truncation, reason = "discs have 32-bit numbers")]
            apart: those(false).count() as u32,
            discs,
            torus: None,
        }
    }

    /// The same in a periodic world that contains them all: with the images near it.
    pub(crate) fn on(torus: Torus, walls: &[Wall], discs: &[Disc], reach_m: f64) -> Self {
        let (walls, discs) = (
            with_images(torus, walls, reach_m, Wall::shifted),
            with_images(torus, discs, reach_m, shifted),
        );
        Self {
            torus: Some(torus),
            ..Self::new(torus.size_m, &walls, &discs, reach_m)
        }
    }

    /// All walls that are within reach of a place, and possibly some more.
    #[inline]
    pub(crate) fn walls_near(&self, place: Point) -> impl Iterator<Item = &Wall> + Clone {
        let numbers = self.near_walls.at(place).iter();
        numbers.map(|number| &self.walls[*number as usize])
    }

    /// All discs that are within reach of a place, and possibly some more.
    #[inline]
    pub(crate) fn discs_near(&self, place: Point) -> impl Iterator<Item = &Disc> + Clone {
        let numbers = self.near_discs.at(place).iter();
        numbers.map(|number| &self.discs[*number as usize])
    }

    /// All discs within `radius_m` of a place, their numbers and distances: those that overlap no
    /// other, and the others.
    #[inline]
    pub(crate) fn discs_within(
        &self,
        place: Point,
        radius_m: f64,
    ) -> [impl Iterator<Item = (u32, f64)>; 2] {
        // Within a cell the numbers ascend.
        let near = self.near_discs.at(place);
        let apart = near.partition_point(|number| *number < self.apart);
        let (apart, overlapping) = near.split_at(apart);
        [apart, overlapping].map(|numbers| {
            let distances = numbers
                .iter()
                .map(move |number| (*number, self.disc(*number).distance_m(place)));
            distances.filter(move |(_, distance_m)| *distance_m < radius_m)
        })
    }

    /// All walls within `radius_m` of a place whose face is visible from some place at most
    /// `gone_m` away, their numbers and distances.
    ///
    /// A point outside of something solid faces at least one of its nearest walls: so these also
    /// determine what may be touched.
    #[inline]
    pub(crate) fn faces_within(
        &self,
        place: Point,
        radius_m: f64,
        gone_m: f64,
    ) -> impl Iterator<Item = (u32, f64)> {
        let numbers = self.near_walls.at(place).iter();
        let faces = numbers.filter_map(move |number| {
            let wall = self.wall(*number);
            let height_m = place.to(wall.start).cross(wall.along);
            (height_m > -gone_m).then(|| (*number, wall.distance(place)))
        });
        faces.filter(move |(_, distance_m)| *distance_m < radius_m)
    }

    #[inline]
    pub(crate) fn disc(&self, number: u32) -> &Disc {
        &self.discs[number as usize]
    }

    #[inline]
    pub(crate) fn wall(&self, number: u32) -> &Wall {
        &self.walls[number as usize]
    }

    /// Whether the straight segment between two places crosses nothing.
    pub(crate) fn is_open(&self, from: Point, to: Point) -> bool {
        // Beyond a side of a periodic world only the nearest image is known here: there the segment
        // is checked from where it enters again.
        let images = self.torus.into_iter().flat_map(|torus| {
            let world = Rectangle::spanned(Point::default(), torus.size_m);
            let images = torus
                .shifts()
                .map(move |by| [from, to].map(|end| end.plus(by)));
            images.filter(move |[from, to]| world.overlaps(&Rectangle::spanned(*from, *to)))
        });
        self.is_open_here(from, to) && { images }.all(|[from, to]| self.is_open_here(from, to))
    }

    /// Whether nothing hides any place within `reach_m` of one, as far as a quick check can determine.
    pub(crate) fn is_clear(&self, place: Point, reach_m: f64) -> bool {
        self.torus.is_none()
            && self.walls.len() + self.discs.len() <= FEW
            && self.discs.iter().all(|disc| disc.distance(place) > reach_m)
            && self.walls.iter().all(|wall| wall.distance(place) > reach_m)
    }

    fn is_open_here(&self, from: Point, to: Point) -> bool {
        let way = from.to(to);
        if self.walls.len() + self.discs.len() <= FEW {
            let mut discs = self.discs.iter();
            let mut walls = self.walls.iter();
            let sees_past_walls = walls.all(|wall| wall.crossed_at(from, way).is_none());
            return sees_past_walls && discs.all(|disc| crossed_at(disc, from, way).is_none());
        }
        let sees_past = |cell: usize| {
            let walls = self.near_walls.of(cell).iter();
            walls
                .map(|number| &self.walls[*number as usize])
                .all(|wall| wall.crossed_at(from, way).is_none())
        };
        let sees_past_discs = |cell: usize| {
            let discs = self.near_discs.of(cell).iter();
            discs
                .map(|number| &self.discs[*number as usize])
                .all(|disc| crossed_at(disc, from, way).is_none())
        };
        self.near_walls.grid().cells_along(from, to).all(sees_past)
            && self
                .near_discs
                .grid()
                .cells_along(from, to)
                .all(sees_past_discs)
    }
}

impl Wall {
    /// The fraction of a segment from `from` at which it crosses the wall, from either side; a
    /// segment that begins or ends on it does not.
    #[inline]
    fn crossed_at(&self, from: Point, way: Point) -> Option<f64> {
        let offset = from.to(self.start);
        let across = way.cross(self.along);
        if across == 0.0 {
            return None;
        }
        let share = offset.cross(self.along) / across;
        let place = offset.cross(way) / across;
        let is_crossed =
            (HAIR..=1.0 - HAIR).contains(&share) && (0.0..=self.length).contains(&place);
        is_crossed.then_some(share)
    }
}

fn shifted(disc: &Disc, by: Point) -> Disc {
    Disc {
        centre: disc.centre.plus(by),
        ..*disc
    }
}

/// Things in a periodic world, and their images within reach of its rectangle.
fn with_images<T: Still + Clone>(
    torus: Torus,
    things: &[T],
    reach_m: f64,
    shifted: impl Fn(&T, Point) -> T,
) -> Vec<T> {
    let corner = Point {
        x: reach_m,
        y: reach_m,
    };
    let near = Rectangle::spanned(corner.times(-1.0), torus.size_m.plus(corner));
    let images = torus
        .shifts()
        .flat_map(|by| things.iter().map(move |thing| (thing, by)));
    let images = images.map(|(thing, by)| shifted(thing, by));
    let is_near = |image: &T| {
        let [low, high] = image.bounds();
        near.overlaps(&Rectangle::spanned(low, high))
    };
    things
        .iter()
        .cloned()
        .chain(images.filter(is_near))
        .collect()
}

/// Whether each disc overlaps another.
fn overlaps(discs: &[Disc]) -> Vec<bool> {
    let left_m = |disc: usize| discs[disc].centre.x - discs[disc].radius_m;
    let right_m = |disc: usize| discs[disc].centre.x + discs[disc].radius_m;
    let mut order: Vec<usize> = (0..discs.len()).collect();
    order.sort_by(|one, other| left_m(*one).total_cmp(&left_m(*other)));
    let mut overlaps = vec![false; discs.len()];
    for (place, one) in order.iter().enumerate() {
        let beside = order[place + 1..].iter();
        for other in beside.take_while(|other| left_m(**other) < right_m(*one)) {
            if discs[*one].distance_m(discs[*other].centre) < discs[*other].radius_m {
                overlaps[*one] = true;
                overlaps[*other] = true;
            }
        }
    }
    overlaps
}

/// The fraction of a segment from `from` at which it enters a disc.
#[inline]
fn crossed_at(disc: &Disc, from: Point, way: Point) -> Option<f64> {
    let to_centre = from.to(disc.centre);
    let (along, all) = (way.dot(to_centre), way.length_squared());
    let (across, square_m2) = (way.cross(to_centre), disc.radius_m * disc.radius_m);
    let is_crossed = if along <= 0.0 {
        to_centre.length_squared() < square_m2
    } else if along >= all {
        way.to(to_centre).length_squared() < square_m2
    } else {
        across * across < square_m2 * all
    };
    // Nothing precedes the beginning of a segment that starts in the disc.
    let half_chord = || (square_m2 * all - across * across).max(0.0).sqrt();
    is_crossed.then(|| ((along - half_chord()) / all.max(f64::MIN_POSITIVE)).clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests;
