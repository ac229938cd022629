//! A hash of the world, as far as a scenario determines it.

use crate::world::obstacles::Solid;
use crate::world::terrain::Area;
use base::geometry::{Rectangle, Torus};
use base::hash::Hash;
use base::hashed::Hashed;

/// A hash of the size and the sides of a world, its obstacles and its terrain; `None` for one with
/// neither obstacles nor terrain.
pub(super) fn world_hash(
    (world, torus): (&Rectangle, Option<&Torus>),
    solids: &[Solid],
    areas: &[Area],
) -> Option<u64> {
    if solids.is_empty() && areas.is_empty() {
        return None;
    }
    let mut hash = Hash::new();
    world.add_to(&mut hash);
    torus.is_some().add_to(&mut hash);
    solids.add_to(&mut hash);
    areas.add_to(&mut hash);
    Some(hash.value())
}
