//! Candidate positions of an entity.

use crate::geometry::{Point, Rectangle};
use crate::random::{Stream, unit};
use crate::trig;

/// Maximum number of positions that are drawn for an entity.
///
/// If a thousandth of the area is free, one search in 20,000 fails.
pub const MAX_TRIES: u32 = 10_000;

/// The reason why an entity has no position.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum PlacementError {
    /// None of the drawn positions is free.
    #[error("no free position found after {MAX_TRIES} tries")]
    NoneFree,
    /// The given position is not free.
    #[error("its position is not free")]
    Taken,
    /// Fewer positions are given than needed.
    #[error("only {0} positions are given")]
    NotGiven(usize),
}

/// The candidate positions of an entity, in their order.
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
    /// The first candidate that `is_free`.
    pub(super) fn first(
        mut self,
        is_free: impl Fn(Point) -> bool,
    ) -> Result<Point, PlacementError> {
        if let Self::Fixed(place) = self {
            return is_free(place).then_some(place).ok_or(PlacementError::Taken);
        }
        (0..MAX_TRIES)
            .filter_map(|_| self.draw())
            .find(|&place| is_free(place))
            .ok_or(PlacementError::NoneFree)
    }

    /// Returns the next candidate; `None` if it is outside the rectangle.
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

/// A draw from the bivariate standard normal distribution, from two numbers of the stream.
///
/// Uses the logarithm of `libm` and the sines of [`trig`], which return the same bits on every machine.
///
/// Source: G. E. P. Box and M. E. Muller, *A note on the generation of random normal deviates*, 1958.
fn normal(stream: &mut Stream) -> Point {
    let distance = (-2.0 * libm::log(1.0 - unit(stream))).sqrt();
    let (sine, cosine) = trig::sin_cos(std::f64::consts::TAU * unit(stream));
    Point { x: cosine, y: sine }.times(distance)
}
