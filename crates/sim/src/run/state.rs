//! Everything that changes in a run.

use super::agent::Agent;
use super::controller::ControllerAgent;
use crate::bodies::Layer;
use crate::bodies::body_state::{BodyState, Status};
use crate::bodies::path::Orientation;
use crate::goals::placed::{Goal, Goals};
use crate::judge::Outcome;
use crate::judge::moment::Moment;
use crate::judge::tally::Tally;
use crate::radio::channel::RadioChannel;
use crate::scenario::Scenario;
use crate::world::items::Items;
use base::geometry::{Disc, Point};
use base::noise::Noise;
use base::placement::{
    EntityClass, Group, PlacementContext, PlacementError, TeamPlacementError, team,
};
use base::random::Entity;
use brain::{GoalId, RobotId};

/// One run, between two steps.
#[derive(Debug, Clone)]
pub struct State {
    pub(crate) seed: u64,
    pub(crate) run: u64,
    /// Number of steps taken.
    pub(crate) tick: u64,
    /// Robots in the order of their kinds and indices; each array below has one entry per robot.
    pub(crate) ids: Vec<RobotId>,
    /// Their footprints.
    pub(crate) discs: Vec<Disc>,
    pub(crate) orientations: Vec<Orientation>,
    pub(crate) body_states: Vec<BodyState>,
    pub(crate) noises: Vec<Noise>,
    pub(crate) agents: Vec<Agent>,
    /// Controllers in the order of their kinds and indices.
    pub(crate) controllers: Vec<ControllerAgent>,
    pub(crate) goals: Goals,
    pub(crate) items: Items,
    pub(crate) channel: RadioChannel,
    pub(crate) tally: Tally,
    /// A hash of all decisions since it was switched on; `None` while it is off.
    pub(crate) decisions: Option<u64>,
}

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
        id: RobotId,
        /// The reason.
        why: PlacementError,
    },
    /// A robot.
    #[error(transparent)]
    Robot(#[from] TeamPlacementError),
}

impl State {
    /// A new run.
    ///
    /// # Errors
    /// If there is no room for an item, a goal, a robot or a controller.
    pub fn new(scenario: &Scenario, seed: u64, run: u64) -> Result<Self, NoRoom> {
        let items = place_items(scenario, seed, run)?;
        let goals = place_goals(scenario, seed, run)?;
        let mut state = Self {
            seed,
            run,
            tick: 0,
            ids: Vec::new(),
            discs: Vec::new(),
            orientations: Vec::new(),
            body_states: Vec::new(),
            noises: Vec::new(),
            agents: Vec::new(),
            controllers: Vec::new(),
            tally: Tally::new(scenario, &items),
            goals,
            items,
            channel: RadioChannel::default(),
            decisions: None,
        };
        state.place_robots(scenario)?;
        state.place_controllers(scenario)?;
        Ok(state)
    }

    fn place_robots(&mut self, scenario: &Scenario) -> Result<(), NoRoom> {
        let draws = draws(scenario, self.seed, self.run, EntityClass::Robots);
        let places = start_places(scenario, self.seed, self.run)?;
        for (group, places) in groups(scenario).iter().zip(places) {
            for (index, place) in (0..).zip(places) {
                let id = RobotId {
                    kind: group.kind,
                    index,
                };
                let entity = Entity {
                    kind: group.key,
                    index,
                };
                let heading_rad = group.placement.heading_rad(&draws, entity);
                self.add(scenario, id, place, heading_rad);
            }
        }
        Ok(())
    }

    fn add(&mut self, scenario: &Scenario, id: RobotId, centre: Point, heading_rad: f64) {
        let kind = scenario.kind_of(id);
        let noise = Noise::of(self.seed, self.run, kind.entity(id.index));
        self.agents.push(Agent::new(kind, id, self.robots(), noise));
        self.ids.push(id);
        self.discs.push(Disc {
            centre: scenario.home(centre),
            radius_m: kind.radius_m,
        });
        self.orientations.push(Orientation::new(heading_rad));
        self.body_states.push(BodyState::default());
        self.noises.push(noise);
    }

    /// Whether the run is over: it is complete, time is up, or no robot can move.
    #[must_use]
    pub fn is_over(&self, scenario: &Scenario) -> bool {
        self.moment(scenario).is_over()
    }

    /// The outcome so far.
    #[must_use]
    pub fn outcome(&self, scenario: &Scenario) -> Outcome {
        Outcome::of(&self.moment(scenario))
    }

    /// Items found, and a number that differs when anything else was counted since: it is cheaper than an
    /// outcome.
    #[must_use]
    pub fn counts(&self) -> (u64, u64) {
        let (found, others) = self.tally.counts();
        let is_stopped = |body_state: &&BodyState| body_state.status != Status::Active;
        let stopped = self.body_states.iter().filter(is_stopped).count();
        (found, others + stopped as u64)
    }

    /// Notes if the run is complete with this step, in which the judge counted something, or nothing.
    pub(crate) fn note_completion(&mut self, scenario: &Scenario, is_counted: bool) {
        let can_complete = self.tally.complete_at.is_none() && scenario.can_complete(is_counted);
        if can_complete && self.moment(scenario).meets_end() {
            self.tally.complete_at = Some(self.tick);
        }
    }

    pub(super) fn moment<'a>(&'a self, scenario: &'a Scenario) -> Moment<'a> {
        Moment {
            scenario,
            tick: self.tick,
            items: &self.items,
            goals: &self.goals,
            goals_refused: self
                .controllers
                .iter()
                .map(|agent| agent.controller.refused())
                .sum(),
            tally: &self.tally,
            discs: &self.discs,
            orientations: &self.orientations,
            body_states: &self.body_states,
        }
    }

    /// Number of robots.
    #[must_use]
    pub fn robots(&self) -> usize {
        self.ids.len()
    }
}

fn groups(scenario: &Scenario) -> Vec<Group<'_>> {
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

fn place_items(scenario: &Scenario, seed: u64, run: u64) -> Result<Items, NoRoom> {
    let draws = draws(scenario, seed, run, EntityClass::Items);
    let mut items = Vec::new();
    for (number, kind) in (0..).zip(&scenario.items) {
        for index in 0..kind.count {
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
    Ok(Items::new(&items, world, scenario.items_reach_m()))
}

fn place_goals(scenario: &Scenario, seed: u64, run: u64) -> Result<Goals, NoRoom> {
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
