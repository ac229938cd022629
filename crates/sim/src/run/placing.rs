//! Where the items, goals, robots and controllers of a run are when it begins.

use super::controller::ControllerAgent;
use super::participant::{Participant, Place};
use crate::bodies::Layer;
use crate::controllers::kind::{ControllerBase, ControllerKind};
use crate::goals::placed::{Goal, Goals};
use crate::scenario::Scenario;
use crate::world::items::Items;
use base::geometry::Point;
use base::noise::Noise;
use base::placement::{
    EntityClass, Group, PlacementContext, PlacementError, TeamPlacementError, team,
};
use base::random::Entity;
use brain::{AgentId, GoalId};
use economy::Controller;

/// An item, goal, robot or controller for which a run has no room.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum NoRoom {
    /// An item.
    #[error("item {index} of kind {kind}: {why}")]
    Item {
        /// Number of its kind.
        kind: u8,
        /// Its index within the kind.
        index: u32,
        /// The reason.
        why: PlacementError,
    },
    /// A goal.
    #[error("goal {index} of kind {kind}: {why}")]
    Goal {
        /// Number of its kind.
        kind: u8,
        /// Its index within the kind.
        index: u32,
        /// The reason.
        why: PlacementError,
    },
    /// A controller.
    #[error("controller {} of kind {}: {why}", .id.index, .id.kind)]
    Controller {
        /// Its id.
        id: AgentId,
        /// The reason.
        why: PlacementError,
    },
    /// A robot.
    #[error(transparent)]
    Robot(#[from] TeamPlacementError),
}

pub(super) fn groups(scenario: &Scenario) -> Vec<Group<'_>> {
    let kinds = (0..).zip(&scenario.kinds);
    let groups = kinds.map(|(number, kind)| Group {
        kind: number,
        key: kind.key,
        count: kind.count,
        radius_m: kind.radius_m,
        layer: kind.layer as u8,
        placement: &kind.start,
    });
    groups.collect()
}

/// The places where the robots of a run start, by kind.
///
/// # Errors
/// The first robot for which no place is found.
pub(crate) fn start_places(
    scenario: &Scenario,
    seed: u64,
    run: u64,
) -> Result<Vec<Vec<Point>>, TeamPlacementError> {
    let draws = draws(scenario, seed, run, EntityClass::Robots);
    team(&draws, &groups(scenario), |group, place| {
        let layer = scenario.kinds[usize::from(group.kind)].layer;
        scenario.is_free(place, group.radius_m, layer)
    })
}

pub(super) fn draws(
    scenario: &Scenario,
    seed: u64,
    run: u64,
    things: EntityClass,
) -> PlacementContext {
    PlacementContext {
        seed,
        run,
        world: scenario.world,
        torus: scenario.torus,
        things,
    }
}

pub(super) fn place_items(scenario: &Scenario, seed: u64, run: u64) -> Result<Items, NoRoom> {
    let draws = draws(scenario, seed, run, EntityClass::Items);
    let mut items = Vec::new();
    for (number, kind) in (0..).zip(&scenario.items) {
        for index in 0..kind.number.draw(kind.count, (seed, run), kind.key) {
            let thing = Entity {
                kind: kind.key,
                index,
            };
            let is_free = |place| scenario.is_free(place, 0.0, Layer::Ground);
            let place = kind.placement.place(&draws, thing, is_free);
            let place = place.map_err(|why| NoRoom::Item {
                kind: number,
                index,
                why,
            })?;
            items.push((thing, u16::from(number), scenario.home(place)));
        }
    }
    let world = (scenario.world.size(), scenario.torus);
    let reach_m = scenario.items_reach_m();
    Ok(Items::new(&items, world, reach_m, [seed, run]))
}

pub(super) fn place_goals(scenario: &Scenario, seed: u64, run: u64) -> Result<Goals, NoRoom> {
    let draws = draws(scenario, seed, run, EntityClass::Goals);
    let is_free = |place| scenario.is_free(place, 0.0, Layer::Ground);
    let mut goals = Vec::new();
    for (number, kind) in (0..).zip(&scenario.goals) {
        for index in 0..kind.count {
            let place = kind.placement.place(&draws, kind.entity(index), is_free);
            let place = place.map_err(|why| NoRoom::Goal {
                kind: number,
                index,
                why,
            })?;
            goals.push(Goal {
                id: GoalId {
                    issuer: kind.issuer,
                    number: index,
                },
                kind: number,
                index,
                at: scenario.home(place),
                arrives_at: kind.arrives_at(index, scenario.step_s),
            });
        }
    }
    Ok(Goals::new(goals))
}

/// The controllers of a run with these robots.
pub(super) fn place_controllers(
    scenario: &Scenario,
    (seed, run): (u64, u64),
    robots: &[AgentId],
) -> Result<Vec<ControllerAgent>, NoRoom> {
    let draws = draws(scenario, seed, run, EntityClass::Robots);
    let mut controllers = Vec::new();
    for (number, kind) in scenario.controllers.iter().enumerate() {
        let number = scenario.controller_number(number);
        for index in 0..kind.count {
            let id = AgentId::controller(number, index);
            let place = place_of(scenario, &draws, (kind, index), robots);
            let place = place.map_err(|why| NoRoom::Controller { id, why })?;
            let entity = kind.entity(index);
            let random = (entity, Noise::of(seed, run, entity));
            controllers.push(ControllerAgent {
                stated: None,
                is_elsewhere: false,
                participant: Participant::new(id, place, kind.radio, random),
                controller: Controller::new(kind.settings.clone()),
            });
        }
    }
    Ok(controllers)
}

fn place_of(
    scenario: &Scenario,
    draws: &PlacementContext,
    (kind, index): (&ControllerKind, u32),
    robots: &[AgentId],
) -> Result<Place, PlacementError> {
    match &kind.base {
        ControllerBase::Placed(placement) => {
            let is_free = |place| scenario.is_free(place, 0.0, Layer::Ground);
            let place = placement.place(draws, kind.entity(index), is_free)?;
            Ok(Place::Fixed(scenario.home(place), Layer::Ground))
        }
        ControllerBase::Aboard(carriers) => {
            let carrier = AgentId::robot(*carriers, index);
            let robot = robots.binary_search(&carrier).ok();
            let robot = robot.and_then(|robot| u32::try_from(robot).ok());
            // A valid scenario has a carrier for each.
            robot.map(Place::Aboard).ok_or(PlacementError::Taken)
        }
    }
}
