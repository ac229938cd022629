//! Paths from wall to wall in a square, reflected by the cosine law: a theory without the simulator.
//!
//! Koopman's law requires independent finds. But a robot passes an item at most once per path, so
//! that passes are more regular, and the rate of first passes is higher; and after a pass, another
//! pass of the same item is slightly more likely.

use crate::setup::Random;
use base::geometry::Point;
use base::trig::sin_cos;
use std::f64::consts::{FRAC_PI_4, TAU};

/// See [`correction`].
const CORRECTION: f64 = 0.616;

/// Factor by which the rate of finds in the inner quarter of a square exceeds Koopman's law, for a
/// sweep width relative to the side; correct up to terms of its square.
///
/// A renewal argument: let p = w c / A be the mean number of passes per path, with the mean path
/// length c. After a pass, the expected number of passes is below that of a constant rate by
/// p (2 d / c - E l^2 / 2 c^2), where d is the mean distance from an item to the wall along a path,
/// and above it by the excess over p of the probability of a pass on each later path. The rate of
/// first finds is higher by this deficit.
pub(crate) fn long_path_factor(width: f64) -> f64 {
    let passes = width * FRAC_PI_4;
    1.0 / (1.0 - CORRECTION * passes)
}

/// A point on the wall of a unit square, and the inward normal there.
#[derive(Clone, Copy)]
struct Wall {
    at: Point,
    inward: Point,
}

/// The path from a point to the wall: its length and end.
fn way(from: Point, along: Point) -> (f64, Wall) {
    let until = |from: f64, along: f64| {
        let wall = if along > 0.0 { 1.0 } else { 0.0 };
        (wall - from) / along
    };
    let (x, y) = (until(from.x, along.x), until(from.y, along.y));
    let inward = if x < y {
        Point {
            x: -along.x.signum(),
            y: 0.0,
        }
    } else {
        Point {
            x: 0.0,
            y: -along.y.signum(),
        }
    };
    let length = x.min(y);
    let at = from.plus(along.times(length));
    (length, Wall { at, inward })
}

/// A random direction by the cosine law.
fn away(wall: &Wall, random: &mut Random) -> Point {
    let sine = 2.0 * random.unit() - 1.0;
    let tangent = Point {
        x: -wall.inward.y,
        y: wall.inward.x,
    };
    let cosine = (1.0 - sine * sine).sqrt();
    wall.inward.times(cosine).plus(tangent.times(sine))
}

/// The deficit of passes after a pass, divided by the mean number per path, over many items.
fn correction(items: u32) -> f64 {
    const WAYS: u32 = 5;
    let mut random = Random::of_run(0);
    let (mut to_wall, mut again, mut squares) = (0.0, 0.0, 0.0);
    for _ in 0..items {
        let [x, y] = [(); 2].map(|()| 0.25 + 0.5 * random.unit());
        let item = Point { x, y };
        let (y, x) = sin_cos(TAU * (random.unit() - 0.5));
        let (length, mut wall) = way(item, Point { x, y });
        to_wall += length;
        for _ in 0..WAYS {
            // By the cosine law, a narrow angle a at an angle from the normal has the probability
            // a/2 times its cosine.
            let back = wall.at.to(item);
            let pass = wall.inward.dot(back) / (2.0 * back.length_squared());
            again += pass / FRAC_PI_4 - 1.0;
            let (length, next) = way(wall.at, away(&wall, &mut random));
            squares += length * length / f64::from(WAYS);
            wall = next;
        }
    }
    let fewer = 2.0 * to_wall / FRAC_PI_4 - squares / (2.0 * FRAC_PI_4 * FRAC_PI_4);
    (fewer - again) / f64::from(items)
}

/// The tolerance of 0.01 is eight standard errors: fails for less than one seed in 10,000.
#[test]
fn the_correction_for_long_paths_is_as_stated() {
    let correction = correction(300_000);
    assert!((correction - CORRECTION).abs() < 0.01, "{correction}");
}
