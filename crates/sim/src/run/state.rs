//! Everything that changes in a run.

use super::agent::Agent;
use super::controller::ControllerAgent;
use super::placing::{
    NoRoom, draws, groups, place_controllers, place_goals, place_items, start_places,
};
use crate::bodies::body_state::{BodyState, Status};
use crate::bodies::path::Orientation;
use crate::bodies::region::Region;
use crate::goals::placed::Goals;
use crate::judge::Outcome;
use crate::judge::moment::Moment;
use crate::judge::tally::Tally;
use crate::passage::convoy::Convoy;
use crate::radio::channel::RadioChannel;
use crate::scenario::Scenario;
use crate::world::items::Items;
use base::geometry::{Disc, Point};
use base::noise::Noise;
use base::placement::EntityClass;
use base::random::Entity;
use brain::AgentId;
use economy::Controller;

/// One run, between two steps.
#[derive(Debug, Clone)]
pub struct State {
    pub(crate) seed: u64,
    pub(crate) run: u64,
    /// Number of steps taken.
    pub(crate) tick: u64,
    /// Robots in the order of their kinds and indices; each array below has one entry per robot.
    pub(crate) ids: Vec<AgentId>,
    /// Their footprints.
    pub(crate) discs: Vec<Disc>,
    pub(crate) orientations: Vec<Orientation>,
    pub(crate) body_states: Vec<BodyState>,
    /// Where external bodies may be; it follows from their states.
    pub(crate) regions: Vec<Region>,
    pub(crate) noises: Vec<Noise>,
    pub(crate) agents: Vec<Agent>,
    /// Controllers in the order of their kinds and indices.
    pub(crate) controllers: Vec<ControllerAgent>,
    pub(crate) goals: Goals,
    pub(crate) items: Items,
    pub(crate) channel: RadioChannel,
    /// Vehicles that pass a lane that was declared clear.
    pub(crate) convoy: Option<Box<Convoy>>,
    pub(crate) tally: Tally,
    /// A hash of all decisions since it was switched on; `None` while it is off.
    pub(crate) decisions: Option<u64>,
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
            regions: Vec::new(),
            noises: Vec::new(),
            agents: Vec::new(),
            controllers: Vec::new(),
            tally: Tally::new(scenario, &items),
            goals,
            items,
            channel: RadioChannel::default(),
            convoy: None,
            decisions: None,
        };
        state.place_robots(scenario)?;
        state.controllers = place_controllers(scenario, (seed, run), &state.ids)?;
        state.fail_named(scenario);
        state.order_service(scenario);
        if scenario.draws_item_numbers() && state.moment(scenario).meets_end() {
            state.tally.complete_at = Some(0);
        }
        Ok(state)
    }

    fn place_robots(&mut self, scenario: &Scenario) -> Result<(), NoRoom> {
        let draws = draws(scenario, self.seed, self.run, EntityClass::Robots);
        let places = start_places(scenario, self.seed, self.run)?;
        for (group, places) in groups(scenario).iter().zip(places) {
            for (index, place) in (0..).zip(places) {
                let id = AgentId::robot(group.kind, index);
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

    fn add(&mut self, scenario: &Scenario, id: AgentId, centre: Point, heading_rad: f64) {
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
        let mut outcome = Outcome::of(&self.moment(scenario));
        if let Some(goals) = &mut outcome.goals {
            goals.balance = self.goal_balance(scenario);
        }
        outcome
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

    /// Notes whether the judge counted something in this step, and if the run is complete with it.
    pub(crate) fn note_completion(&mut self, scenario: &Scenario, is_counted: bool) {
        self.tally.counted_steps += u64::from(is_counted);
        let can_complete = self.tally.complete_at.is_none() && scenario.can_complete(is_counted);
        if can_complete && self.moment(scenario).meets_end() {
            self.tally.complete_at = Some(self.tick);
        }
    }

    pub(super) fn moment<'a>(&'a self, scenario: &'a Scenario) -> Moment<'a> {
        let counted = |of: fn(&Controller) -> u32| {
            let controllers = self.controllers.iter();
            controllers.map(|agent| of(&agent.controller)).sum()
        };
        Moment {
            scenario,
            tick: self.tick,
            items: &self.items,
            goals: &self.goals,
            goals_refused: counted(Controller::refused),
            leases_lapsed: counted(Controller::lapses),
            tally: &self.tally,
            convoy: self.convoy.as_deref(),
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
