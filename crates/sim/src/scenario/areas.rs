//! Areas in which things are placed at random.

use base::geometry::{Point, Rectangle};
use base::placement::Placement;

/// Places that are examined along each side of a rectangle.
pub(super) const SIDE: u32 = 128;

/// The places of a lattice over a rectangle.
pub(crate) fn lattice(within: Rectangle) -> impl Iterator<Item = Point> {
    let size = within.size();
    let at = |step: u32| (f64::from(step) + 0.5) / f64::from(SIDE);
    let place = move |(column, row)| {
        within.min().plus(Point {
            x: size.x * at(column),
            y: size.y * at(row),
        })
    };
    let places = (0..SIDE).flat_map(|row| (0..SIDE).map(move |column| (column, row)));
    places.map(place)
}

/// A number of places.
#[expect(clippy::cast_precision_loss, reason = "far fewer than 2^53")]
pub(crate) fn number(places: usize) -> f64 {
    places as f64
}

/// The area of a placement without given places.
pub(crate) fn within(placement: &Placement, world: Rectangle) -> Option<Rectangle> {
    match placement {
        Placement::Fixed { .. } => None,
        Placement::Uniform { within_m } | Placement::Clustered { within_m, .. } => {
            Some(within_m.unwrap_or(world))
        }
    }
}
