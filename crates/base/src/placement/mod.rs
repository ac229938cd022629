//! Positions of items and robots: fixed, uniform or clustered.
//!
//! A position is a pure function of the seed, the run, the entity (its kind and its index within the
//! kind) and the world, and does not depend on the number of other entities: adding items moves none
//! of the others. Each entity draws from its own stream until a position is free (rejection sampling),
//! at most [`MAX_TRIES`] times. [`team`] places robots, which must not overlap.

mod candidates;
mod disc_index;
mod team;

pub use candidates::{MAX_TRIES, PlacementError};
pub use disc_index::DiscIndex;
pub use team::{Group, TeamPlacementError, team};

use crate::geometry::{Point, Rectangle, Torus};
use crate::random::{self, Entity, Purpose};
use candidates::Candidates;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Positions of the items or robots of a kind.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Placement {
    /// Given positions.
    Fixed {
        /// Position of each item or robot, as [x, y].
        at_m: Vec<Point>,
        /// Heading of each robot: 0 along x, anticlockwise. Random by default.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        heading_deg: Option<Vec<f64>>,
    },
    /// Random positions, uniform over the free area.
    Uniform {
        /// Rectangle of the positions, given by two opposite corners. The whole world by default.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        within_m: Option<Rectangle>,
    },
    /// Random clusters of equal size. Centres are uniform over the free area; members are normally
    /// distributed around their centre, in the free area.
    Clustered {
        /// Number of clusters.
        #[schemars(range(min = 1, max = 1_048_576))]
        clusters: u32,
        /// Standard deviation of the members along each axis.
        #[schemars(range(min = 0.0, max = 1e6))]
        spread_m: f64,
        /// Rectangle of centres and members, given by two opposite corners. The whole world by
        /// default.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        within_m: Option<Rectangle>,
    },
}

impl Default for Placement {
    /// Uniform over the world.
    fn default() -> Self {
        Self::Uniform { within_m: None }
    }
}

/// What positions depend on, apart from the placement: the run and the world.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlacementContext {
    /// Seed of the study.
    pub seed: u64,
    /// Number of the run.
    pub run: u64,
    /// The world.
    pub world: Rectangle,
    /// The torus of a periodic world.
    pub torus: Option<Torus>,
    /// What is placed.
    pub things: EntityClass,
}

/// Items, robots or goals: they have different random streams.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EntityClass {
    /// Items.
    Items,
    /// Robots and controllers.
    Robots,
    /// Goals.
    Goals,
}

impl EntityClass {
    fn place(self) -> Purpose {
        match self {
            Self::Items => Purpose::Item,
            Self::Robots => Purpose::Start,
            Self::Goals => Purpose::Goal,
        }
    }

    fn cluster(self) -> Purpose {
        match self {
            Self::Items => Purpose::ItemCluster,
            Self::Robots => Purpose::StartCluster,
            Self::Goals => Purpose::GoalCluster,
        }
    }
}

impl Placement {
    /// The position of `entity`: the first of its candidates that `is_free`.
    ///
    /// `is_free` must depend on the position and the kind only, so that the result does not depend on
    /// other entities.
    ///
    /// # Errors
    /// If no free position is found.
    pub fn place(
        &self,
        draws: &PlacementContext,
        entity: Entity,
        is_free: impl Fn(Point) -> bool,
    ) -> Result<Point, PlacementError> {
        self.candidates(draws, entity, &is_free)?.first(is_free)
    }

    /// The heading of `entity` at its start, in radians, 0 along x: the given one, otherwise random.
    #[must_use]
    pub fn heading_rad(&self, draws: &PlacementContext, entity: Entity) -> f64 {
        let given = match self {
            Self::Fixed { heading_deg, .. } => heading_deg.as_deref().unwrap_or_default(),
            _ => &[],
        };
        let random = || {
            let PlacementContext { seed, run, .. } = *draws;
            let mut stream = random::stream(seed, run, entity, Purpose::StartHeading);
            std::f64::consts::PI * (2.0 * random::unit(&mut stream) - 1.0)
        };
        given
            .get(entity.index as usize)
            .map_or_else(random, |degrees| degrees.to_radians())
    }

    /// The candidate positions of `entity`, in their order.
    fn candidates(
        &self,
        draws: &PlacementContext,
        entity: Entity,
        is_free: impl Fn(Point) -> bool,
    ) -> Result<Candidates, PlacementError> {
        let PlacementContext { seed, run, .. } = *draws;
        let place = random::stream(seed, run, entity, draws.things.place());
        match *self {
            Self::Fixed { ref at_m, .. } => {
                let place = at_m.get(entity.index as usize);
                place.map_or(Err(PlacementError::NotGiven(at_m.len())), |&place| {
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
                // Clusters take turns: their sizes are equal, and adding members moves no others.
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
