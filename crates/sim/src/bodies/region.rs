//! Where an external body may be, as others perceive it.

use super::external::ExternalBody;
use super::kind::Kind;
use crate::world::static_geometry::Wall;
use base::geometry::{Disc, Point, Segment};
use base::trig::sin_cos;
use std::f64::consts::TAU;

/// Corners of the polygon around the circle that a silent body can have reached.
const CORNERS: u16 = 32;

/// The area that the body may cover: everything within its radius of where its centre may be.
///
/// Its centre is within the uncertainty of its position. That of a silent body is where it can have come
/// since its last position at its maximum speed, but within its fence.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Region {
    /// The number of the robot.
    pub(crate) robot: usize,
    /// Around the position, as far as the body may reach in any direction.
    pub(crate) disc: Disc,
    /// How far its centre may be from the position.
    pub(crate) uncertainty_m: f64,
    is_silent: bool,
    fenced: Option<Fenced>,
}

/// The part of the disc that a fence leaves.
#[derive(Debug, Clone, PartialEq)]
struct Fenced {
    /// Where the centre may be, anticlockwise.
    corners: Vec<Point>,
    radius_m: f64,
    /// The sides of that area, moved outwards by the radius.
    walls: Vec<Wall>,
}

impl Region {
    /// The region of the body of a robot of a kind whose position is `at`.
    pub(crate) fn new(robot: usize, external: &ExternalBody, kind: &Kind, at: Point) -> Self {
        let body = kind.brain.body();
        let uncertainty_m = external.uncertainty_m(body);
        let is_silent = external.silent_s().is_some();
        let disc = Disc {
            centre: at,
            radius_m: kind.radius_m + uncertainty_m,
        };
        let fence_m = &external.spec.fence_m;
        let is_cut = is_silent && !fence_m.is_empty();
        let corners = is_cut.then(|| clipped(fence_m, at, uncertainty_m));
        // A position may be outside of the fence, by its error.
        let corners = corners.filter(|corners| !corners.is_empty());
        Self {
            robot,
            disc,
            uncertainty_m,
            is_silent,
            fenced: corners.map(|corners| Fenced {
                walls: outline(&corners, kind.radius_m),
                radius_m: kind.radius_m,
                corners,
            }),
        }
    }

    /// Whether the body may cover a place.
    pub(crate) fn covers(&self, place: Point) -> bool {
        let is_fenced = self.fenced.as_ref();
        self.disc.contains(place) && is_fenced.is_none_or(|fenced| fenced.covers(place))
    }

    /// What rays meet from a place: discs, which may overlap, and walls.
    pub(crate) fn seen_from(&self, place: Point) -> (Vec<Disc>, &[Wall]) {
        match &self.fenced {
            Some(fenced) if !self.covers(place) => {
                let round = |centre: &Point| Disc {
                    centre: *centre,
                    radius_m: fenced.radius_m,
                };
                (fenced.corners.iter().map(round).collect(), &fenced.walls)
            }
            _ => (vec![self.disc], &[]),
        }
    }

    /// Where others detect its centre from a place, and how far it may be from there: a silent one may be at
    /// the nearest place that it can have reached.
    pub(crate) fn detected_from(&self, place: Point, image: Point) -> (Point, f64) {
        if !self.is_silent {
            return (image, self.uncertainty_m);
        }
        let nearest = match &self.fenced {
            None => {
                let way = image.to(place);
                let share = self.uncertainty_m / way.length().max(f64::MIN_POSITIVE);
                image.plus(way.times(share.min(1.0)))
            }
            Some(fenced) if is_inside(&fenced.corners, place) => place,
            Some(fenced) => {
                let near = sides(&fenced.corners).map(|side| side.nearest(place));
                let near = near.min_by(|one, other| {
                    let distance_m = |at: &Point| at.to(place).length_squared();
                    distance_m(one).total_cmp(&distance_m(other))
                });
                near.unwrap_or(image)
            }
        };
        (nearest, 0.0)
    }

    /// Whether others may detect it farther away than its position is.
    pub(crate) fn is_silent(&self) -> bool {
        self.is_silent
    }

    /// The outline of where its centre may be, if its fence limits it.
    pub(crate) fn corners(&self) -> &[Point] {
        let fenced = self.fenced.as_ref();
        fenced.map_or(&[], |fenced| &fenced.corners)
    }
}

impl Fenced {
    fn covers(&self, place: Point) -> bool {
        is_inside(&self.corners, place)
            || sides(&self.corners).any(|side| side.distance_m(place) <= self.radius_m)
    }
}

/// The part of a polygon within a circle, anticlockwise; empty if there is none.
///
/// The circle is a polygon around it (I. Sutherland and G. Hodgman, *Reentrant polygon clipping*,
/// Communications of the ACM 17, 1974).
fn clipped(polygon: &[Point], centre: Point, radius_m: f64) -> Vec<Point> {
    let mut kept = polygon.to_vec();
    if area_m2(&kept) < 0.0 {
        kept.reverse();
    }
    for corner in 0..CORNERS {
        let (y, x) = sin_cos(TAU * f64::from(corner) / f64::from(CORNERS));
        kept = half(&kept, centre, Point { x, y }, radius_m);
    }
    kept
}

/// The part of a polygon that is at most `limit_m` from a place along a direction.
fn half(polygon: &[Point], from: Point, along: Point, limit_m: f64) -> Vec<Point> {
    let beyond_m = |place: Point| along.dot(from.to(place)) - limit_m;
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for side in sides(polygon) {
        let [from_m, to_m] = [beyond_m(side.from), beyond_m(side.to)];
        if from_m <= 0.0 {
            kept.push(side.from);
        }
        if (from_m <= 0.0) != (to_m <= 0.0) {
            kept.push(side.from.plus(side.way().times(from_m / (from_m - to_m))));
        }
    }
    kept
}

/// The sides of an anticlockwise polygon, moved outwards; free space is to their left.
fn outline(corners: &[Point], by_m: f64) -> Vec<Wall> {
    let moved = sides(corners).filter_map(|side| {
        let wall = Wall::of(&Segment {
            from: side.to,
            to: side.from,
        })?;
        let outwards = Point {
            x: -wall.along.y,
            y: wall.along.x,
        };
        Some(Wall {
            start: wall.start.plus(outwards.times(by_m)),
            ..wall
        })
    });
    moved.collect()
}

fn sides(corners: &[Point]) -> impl Iterator<Item = Segment> {
    let next = corners.iter().cycle().skip(1);
    let pairs = corners.iter().zip(next);
    pairs.map(|(from, to)| Segment {
        from: *from,
        to: *to,
    })
}

fn area_m2(corners: &[Point]) -> f64 {
    sides(corners)
        .map(|side| side.from.cross(side.to))
        .sum::<f64>()
        / 2.0
}

/// Whether a place is inside a polygon: whether a ray from it along x crosses an odd number of sides.
fn is_inside(corners: &[Point], place: Point) -> bool {
    let crossed = sides(corners).filter(|Segment { from, to }| {
        let is_beside = (from.y > place.y) != (to.y > place.y);
        is_beside && {
            let share = (place.y - from.y) / (to.y - from.y);
            place.x < from.x + share * (to.x - from.x)
        }
    });
    crossed.count() % 2 == 1
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const SQUARE: [Point; 4] = [
        Point { x: 0.0, y: 0.0 },
        Point { x: 10.0, y: 0.0 },
        Point { x: 10.0, y: 10.0 },
        Point { x: 0.0, y: 10.0 },
    ];

    /// A fence with an inner corner.
    const ANGLE: [Point; 6] = [
        Point { x: 0.0, y: 0.0 },
        Point { x: 10.0, y: 0.0 },
        Point { x: 10.0, y: 4.0 },
        Point { x: 4.0, y: 4.0 },
        Point { x: 4.0, y: 10.0 },
        Point { x: 0.0, y: 10.0 },
    ];

    fn region(fence: &[Point], at: Point, reach_m: f64) -> Region {
        let corners = clipped(fence, at, reach_m);
        Region {
            robot: 0,
            disc: Disc {
                centre: at,
                radius_m: 0.3 + reach_m,
            },
            uncertainty_m: reach_m,
            is_silent: true,
            fenced: Some(Fenced {
                walls: outline(&corners, 0.3),
                radius_m: 0.3,
                corners,
            }),
        }
    }

    #[test]
    fn a_region_grows_until_it_is_the_fence() {
        let at = Point { x: 5.0, y: 5.0 };
        let areas = [1.0, 4.0, 8.0, 100.0].map(|reach_m| area_m2(&clipped(&SQUARE, at, reach_m)));
        assert!((areas[0] - std::f64::consts::PI).abs() < 0.02, "{areas:?}");
        assert!(areas.is_sorted());
        assert!((areas[3] - 100.0).abs() < 1e-9);
    }

    proptest! {
        #[test]
        fn a_region_holds_each_place_of_the_fence_that_the_body_can_have_reached(
            (x, y) in (0.0..10.0, 0.0..10.0), share in 0.0..1.0, angle in 0.0..TAU, reach_m in 0.1..20.0,
        ) {
            let at = Point { x: 2.0, y: 2.0 };
            let there = Point { x, y };
            let region = region(&ANGLE, at, reach_m);
            if is_inside(&ANGLE, there) && at.to(there).length() <= reach_m {
                let (sine, cosine) = sin_cos(angle);
                let edge = there.plus(Point { x: cosine, y: sine }.times(0.299 * share));
                prop_assert!(region.covers(edge));
            }
        }

        #[test]
        fn nothing_beyond_the_fence_is_in_a_region(
            (x, y) in (-5.0..15.0, -5.0..15.0), reach_m in 0.1..20.0,
        ) {
            let place = Point { x, y };
            let region = region(&ANGLE, Point { x: 2.0, y: 2.0 }, reach_m);
            let beside_m = sides(&ANGLE).map(|side| side.distance_m(place)).fold(f64::INFINITY, f64::min);
            if !is_inside(&ANGLE, place) && beside_m > 0.301 {
                prop_assert!(!region.covers(place));
            }
        }
    }
}
