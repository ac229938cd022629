//! What a sensor can query in the world.

use super::rays::Near;
use crate::world::items::Items;
use crate::world::static_geometry::StaticGeometry;
use base::geometry::Point;
use base::random::Entity;
use brain::AgentId;

/// The world around one robot or controller, for its sensors.
pub(crate) trait Scene {
    /// Time since the start of the run.
    fn time_s(&self) -> f64;

    /// Its true heading.
    fn heading_rad(&self) -> f64;

    /// All items.
    fn items(&self) -> &Items;

    /// Whether a place is in the world; a periodic world has no border.
    fn contains(&self, place: Point) -> bool;

    /// Fills `near` with all that its rays can meet.
    fn gather(&self, near: &mut Near);

    /// Replaces `to` by the numbers of the others that may be within a range, ascending.
    fn others_within(&self, range_m: f64, to: &mut Vec<u32>);

    /// Whether it is known that nothing hides any of the others within a range.
    fn is_clear(&self, range_m: f64, others: &[u32]) -> bool;

    /// Another robot or controller.
    fn other(&self, number: u32) -> Other<'_>;

    /// The true heading of another; called only if the other is detected.
    fn heading_rad_of(&self, number: u32) -> f64;
}

/// Another robot or controller, as a detector can meet it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Other<'a> {
    pub(crate) id: AgentId,
    /// Its key in random streams.
    pub(crate) key: Entity,
    /// Its position, or the nearest image of it in a periodic world.
    pub(crate) at: Point,
    /// How far its centre may be from there.
    pub(crate) uncertainty_m: f64,
    /// What can hide it.
    pub(crate) geometry: &'a StaticGeometry,
}
