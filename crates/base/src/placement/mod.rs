//! Where things are put: at given places, anywhere, or in clusters.
//!
//! A place is a pure function of the seed, the run, what is placed (its kind and its index within
//! the kind) and the world, never of how many others there are: with more items, those that were
//! there stay where they are. Each entity draws from a stream of its own until a place is free
//! (rejection), at most [`MAX_TRIES`] times. Robots, which must not overlap, are placed by [`team`].

mod candidates;
mod crowd;
mod team;

pub use crowd::Crowd;
pub use team::{Group, NoPlaceFor, team};

use crate::geometry::{Point, Rectangle, Torus};
use crate::random::{self, Entity, Purpose};
use candidates::Candidates;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How often a place is drawn before none is thought to be free.
///
/// Where a thousandth of the area is free, one search in 20,000 gives up.
pub const MAX_TRIES: u32 = 10_000;

/// Where the items or robots of a kind are put.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Placement {
    /// At given places.
    Fixed {
        /// A place for each, as [x, y].
        at_m: Vec<Point>,
        /// Which way each looks: 0 along x, anticlockwise. Random if it is not given.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        heading_deg: Option<Vec<f64>>,
    },
    /// Anywhere, each place that is free as likely.
    Uniform {
        /// Only within this rectangle, given by two opposite corners. The whole world if it is not
        /// given.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        within_m: Option<Rectangle>,
    },
    /// In clusters of equal numbers: the centre of each is anywhere that is free, and its members are
    /// spread about it by a round normal distribution, where it is free.
    Clustered {
        /// How many clusters.
        #[schemars(range(min = 1, max = 1_048_576))]
        clusters: u32,
        /// Standard deviation along x, and along y.
        #[schemars(range(min = 0.0, max = 1e6))]
        spread_m: f64,
        /// Centres and members only within this rectangle, given by two opposite corners. The whole
        /// world if it is not given.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        within_m: Option<Rectangle>,
    },
}

impl Default for Placement {
    /// Anywhere in the world.
    fn default() -> Self {
        Self::Uniform { within_m: None }
    }
}

/// What places depend on besides the placement: the run, and the world.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Draws {
    /// Seed of the study.
    pub seed: u64,
    /// Number of the run.
    pub run: u64,
    /// The world.
    pub world: Rectangle,
    /// How the world goes on at its sides, if it does.
    pub torus: Option<Torus>,
    /// What is placed.
    pub things: Things,
}

/// What is placed: items and robots have streams of their own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Things {
    /// Items.
    Items,
    /// Robots.
    Robots,
}

impl Things {
    fn place(self) -> Purpose {
        match self {
            Self::Items => Purpose::Item,
            Self::Robots => Purpose::Start,
        }
    }

    fn cluster(self) -> Purpose {
        match self {
            Self::Items => Purpose::ItemCluster,
            Self::Robots => Purpose::StartCluster,
        }
    }
}

/// Why something has no place.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum NoPlace {
    /// None of the places that were drawn is free.
    #[error("no free place found after {MAX_TRIES} tries")]
    NoneFree,
    /// The given place is not free.
    #[error("its place is not free")]
    Taken,
    /// There are fewer places than things.
    #[error("only {0} places are given")]
    NotGiven(usize),
}

impl Placement {
    /// Where `entity` is put: the first place of its own that `is_free`.
    ///
    /// `is_free` must depend on the place and the kind only, for the place to be the same whatever
    /// else there is.
    ///
    /// # Errors
    /// If no place is found.
    pub fn place(
        &self,
        draws: &Draws,
        entity: Entity,
        is_free: impl Fn(Point) -> bool,
    ) -> Result<Point, NoPlace> {
        self.candidates(draws, entity, &is_free)?.first(is_free)
    }

    /// Which way `entity` looks at its start, in radians, 0 along x: as given, or else random.
    #[must_use]
    pub fn heading_rad(&self, draws: &Draws, entity: Entity) -> f64 {
        let given = match self {
            Self::Fixed { heading_deg, .. } => heading_deg.as_deref().unwrap_or_default(),
            _ => &[],
        };
        let random = || {
            let Draws { seed, run, .. } = *draws;
            let mut stream = random::stream(seed, run, entity, Purpose::StartHeading);
            std::f64::consts::PI * (2.0 * random::unit(&mut stream) - 1.0)
        };
        given
            .get(entity.index as usize)
            .map_or_else(random, |degrees| degrees.to_radians())
    }

    /// The places that are tried for `entity`, in their order.
    fn candidates(
        &self,
        draws: &Draws,
        entity: Entity,
        is_free: impl Fn(Point) -> bool,
    ) -> Result<Candidates, NoPlace> {
        let Draws { seed, run, .. } = *draws;
        let place = random::stream(seed, run, entity, draws.things.place());
        match *self {
            Self::Fixed { ref at_m, .. } => {
                let place = at_m.get(entity.index as usize);
                place.map_or(Err(NoPlace::NotGiven(at_m.len())), |&place| {
                    Ok(Candidates::Fixed(place))
                })
            }
            Self::Uniform { within_m } => {
                let within = within_m.unwrap_or(draws.world);
                Ok(Candidates::Uniform { place, within })
            }
            Self::Clustered {
                clusters,
                spread_m,
                within_m,
            } => {
                let within = within_m.unwrap_or(draws.world);
                // By turns: equal numbers, and more members leave the others where they are.
                let cluster = Entity {
                    index: entity.index % clusters.max(1),
                    ..entity
                };
                let stream = random::stream(seed, run, cluster, draws.things.cluster());
                let centres = Candidates::Uniform {
                    place: stream,
                    within,
                };
                Ok(Candidates::Normal {
                    place,
                    centre: centres.first(is_free)?,
                    spread_m,
                    within,
                })
            }
        }
    }
}

#[cfg(test)]
mod tests;
