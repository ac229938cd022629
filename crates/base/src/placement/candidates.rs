//! The places that are tried for one entity.

use super::{MAX_TRIES, NoPlace};
use crate::geometry::{Point, Rectangle};
use crate::random::{Stream, unit};
use crate::trig;

/// The places that are tried for one entity, one after another.
#[derive(Debug, Clone)]
pub(super) enum Candidates {
    Fixed(Point),
    Uniform {
        place: Stream,
        within: Rectangle,
    },
    Normal {
        place: Stream,
        centre: Point,
        spread_m: f64,
        within: Rectangle,
    },
}

impl Candidates {
    /// The first of them that `is_free`.
    pub(super) fn first(mut self, is_free: impl Fn(Point) -> bool) -> Result<Point, NoPlace> {
        if let Self::Fixed(place) = self {
            return is_free(place).then_some(place).ok_or(NoPlace::Taken);
        }
        (0..MAX_TRIES)
            .filter_map(|_| self.draw())
            .find(|&place| is_free(place))
            .ok_or(NoPlace::NoneFree)
    }

    /// The next of them, if it is where it should be.
    fn draw(&mut self) -> Option<Point> {
        match self {
            Self::Fixed(place) => Some(*place),
            Self::Uniform { place, within } => {
                let size = within.size();
                Some(within.min().plus(Point {
                    x: size.x * unit(place),
                    y: size.y * unit(place),
                }))
            }
            Self::Normal {
                place,
                centre,
                spread_m,
                within,
            } => {
                let member = centre.plus(normal(place).times(*spread_m));
                within.contains(member).then_some(member)
            }
        }
    }
}

/// A draw of the round normal distribution of standard deviation 1, by two numbers of the stream.
///
/// Box and Muller, *A note on the generation of random normal deviates*, 1958; the logarithm is
/// `libm`'s and the sines are [`trig`]'s, so it is the same bytes on every machine.
fn normal(stream: &mut Stream) -> Point {
    let distance = (-2.0 * libm::log(1.0 - unit(stream))).sqrt();
    let (sine, cosine) = trig::sin_cos(std::f64::consts::TAU * unit(stream));
    Point { x: cosine, y: sine }.times(distance)
}
