//! Everything that changes in a run.

use super::agent::Agent;
use crate::bodies::Layer;
use crate::bodies::kind::Kind;
use crate::bodies::path::Orientation;
use crate::bodies::source::BodySource;
use crate::radio::channel::RadioChannel;
use crate::scenario::Scenario;
use crate::world::items::Items;
use base::geometry::{Disc, Point};
use base::noise::Noise;
use base::placement::{
    EntityClass, Group, PlacementContext, PlacementError, TeamPlacementError, team,
};
use base::random::Entity;
use brain::RobotId;

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
    pub(crate) items: Items,
    pub(crate) channel: RadioChannel,
    pub(crate) tally: Tally,
    /// A hash of all decisions since it was switched on; `None` while it is off.
    pub(crate) decisions: Option<u64>,
}

/// The state of a body, besides its pose.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct BodyState {
    pub(crate) speed_m_s: f64,
    pub(crate) turn_rate_rad_s: f64,
    /// Energy taken from the battery so far.
    pub(crate) energy_j: f64,
    pub(crate) distance_m: f64,
    /// It is stopped until this step, because of a collision.
    pub(crate) held_until: u64,
    pub(crate) collisions: u32,
    pub(crate) status: Status,
    pub(crate) source: BodySource,
    /// It touched something in the last step, or it has not moved freely since.
    pub(crate) is_touching: bool,
    /// Something stopped it in the last step.
    pub(crate) is_pressed: bool,
}

impl BodyState {
    pub(crate) fn is_external(&self) -> bool {
        self.source == BodySource::External
    }

    /// Remaining fraction of its battery, 0 to 1; `None` if it never runs empty.
    pub(crate) fn charge(&self, kind: &Kind) -> Option<f64> {
        let capacity_j = kind.battery?.capacity_j;
        let left = (1.0 - self.energy_j / capacity_j).max(0.0);
        capacity_j.is_finite().then_some(left)
    }
}

/// Whether a robot can still move.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Status {
    /// It can.
    #[default]
    Active,
    /// Its battery is empty.
    Empty,
    /// It has collided too often.
    Broken,
}

/// Counts of a run, besides those of each robot.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Tally {
    pub(crate) false_alarms: u64,
    pub(crate) collisions: u64,
    /// Targets that are not found.
    pub(crate) targets_left: u32,
    /// The step in which the last target was found.
    pub(crate) complete_at: Option<u64>,
    /// The cost of robots that were removed.
    pub(crate) gone: Cost,
}

/// The total cost of some robots.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Cost {
    pub(crate) energy_j: f64,
    pub(crate) distance_m: f64,
    pub(crate) stopped: u32,
}

impl Cost {
    /// Adds the cost of other robots.
    pub(crate) fn and<'a>(self, body_states: impl Iterator<Item = &'a BodyState>) -> Self {
        body_states.fold(self, |all, body_state| Self {
            energy_j: all.energy_j + body_state.energy_j,
            distance_m: all.distance_m + body_state.distance_m,
            stopped: all.stopped + u32::from(body_state.status != Status::Active),
        })
    }
}

/// A robot or an item for which a run has no room.
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
    /// A robot.
    #[error(transparent)]
    Robot(#[from] TeamPlacementError),
}

impl State {
    /// A new run.
    ///
    /// # Errors
    /// If there is no room for an item or a robot.
    pub fn new(scenario: &Scenario, seed: u64, run: u64) -> Result<Self, NoRoom> {
        let items = place_items(scenario, seed, run)?;
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
            items,
            channel: RadioChannel::default(),
            tally: Tally::default(),
            decisions: None,
        };
        state.place_robots(scenario)?;
        state.tally.targets_left = scenario.targets();
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
                let heading_rad = group.placement.heading_rad(&draws, scenario.entity(id));
                self.add(scenario, id, place, heading_rad);
            }
        }
        Ok(())
    }

    fn add(&mut self, scenario: &Scenario, id: RobotId, centre: Point, heading_rad: f64) {
        let kind = &scenario.kinds[usize::from(id.kind)];
        self.ids.push(id);
        self.discs.push(Disc {
            centre: scenario.home(centre),
            radius_m: kind.radius_m,
        });
        self.orientations.push(Orientation::new(heading_rad));
        self.body_states.push(BodyState::default());
        self.noises
            .push(Noise::of(self.seed, self.run, scenario.entity(id)));
        self.agents.push(Agent::new(kind));
    }

    /// Notes that a robot detected an item.
    pub(crate) fn find(&mut self, scenario: &Scenario, item: u32) {
        let kind = &scenario.items[usize::from(self.items.kind(item))];
        if self.items.find(item, self.tick) && kind.is_target {
            self.tally.targets_left -= 1;
            if self.tally.targets_left == 0 {
                self.tally.complete_at = Some(self.tick);
            }
        }
    }

    /// Whether the run is over: all targets are found, time is up, or no robot can move.
    #[must_use]
    pub fn is_over(&self, scenario: &Scenario) -> bool {
        let can_go_on = |body_state: &BodyState| body_state.status == Status::Active;
        self.tally.complete_at.is_some()
            || self.tick >= scenario.steps
            || !self.body_states.iter().any(can_go_on)
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
