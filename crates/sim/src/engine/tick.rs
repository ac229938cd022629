//! One step of a run: sense, tell, decide, act, judge.

use super::act::{Moves, Plan, planned};
use super::asked::{Asked, Asking};
use super::decide::Desk;
use super::flocks::Flocks;
use super::glide::glide;
use super::mind::Mind;
use super::neighbours::Neighbours;
use super::outside::Outside;
use super::share_out::is_worth_sharing;
use super::state::{State, Status};
use crate::scenario::Scenario;
use brain::{Command, Percept};
use rayon::prelude::*;

/// What steps need besides the run's state: nothing in it changes what comes out. It is kept from
/// step to step, so that after the first ones a step allocates nothing.
#[derive(Debug, Clone)]
pub(crate) struct Workshop {
    pub(super) neighbours: Neighbours,
    flocks: Flocks,
    pub(super) desks: Vec<Desk>,
    /// Those of the last step for which others decided.
    pub(super) asking: Asking,
    moves: Moves,
    /// Whether threads may share the work of one step.
    may_share: bool,
    has_minds: bool,
}

/// The part of one thread: its desk, and its robots' minds and plans.
type Share<'a> = ((&'a mut Desk, &'a mut [Mind]), &'a mut [Plan]);

impl Workshop {
    pub(crate) fn new(scenario: &Scenario, may_share: bool) -> Self {
        Self {
            neighbours: Neighbours::new(scenario),
            flocks: Flocks::new(scenario),
            desks: Vec::new(),
            asking: Asking::default(),
            moves: Moves::default(),
            may_share,
            has_minds: scenario.kinds.iter().any(|kind| kind.brain.has_mind()),
        }
    }

    /// Takes one step into which nothing comes from outside.
    pub(crate) fn step(&mut self, scenario: &Scenario, state: &mut State) {
        self.tick(scenario, state, &Outside::default());
    }

    /// Begins another run, or goes on with one that has been changed.
    pub(crate) fn forget(&mut self) {
        self.neighbours.forget();
    }

    /// Takes one step.
    pub(crate) fn tick(&mut self, scenario: &Scenario, state: &mut State, outside: &Outside) {
        if scenario.is_of_flocks_of_points() && outside.is_empty() {
            self.glide(scenario, state);
        } else {
            self.refresh(scenario, state);
            self.sense_decide_and_plan(scenario, state, outside);
            self.speak(scenario, state);
            self.judge(scenario, state, &outside.asking);
            self.act(scenario, state);
        }
        state.tick += 1;
        hear(scenario, state);
    }

    fn is_shared(&self, state: &State) -> bool {
        self.may_share && is_worth_sharing(state.robots(), self.has_minds)
    }

    /// Sees to it that neighbours are known.
    pub(super) fn refresh(&mut self, scenario: &Scenario, state: &State) {
        let is_shared = self.is_shared(state);
        self.neighbours
            .refresh(scenario, &state.ids, &state.discs, is_shared);
    }

    /// A step of robots that are never in each other's way, and have nothing to tell or find.
    fn glide(&mut self, scenario: &Scenario, state: &mut State) {
        let is_shared = self.is_shared(state);
        let (view, _) = state.view(scenario, &self.neighbours);
        self.flocks.ask(&view, is_shared);
        let moved = glide(scenario, state, &self.flocks, is_shared);
        self.neighbours.note(moved.farthest_m);
    }

    /// Clears desks for all threads that share the work of a step; whether more than one does.
    pub(super) fn prepare_desks(&mut self, state: &State) -> bool {
        let is_shared = self.is_shared(state);
        let desks = if is_shared {
            4 * rayon::current_num_threads()
        } else {
            1
        };
        self.desks.resize_with(desks, Desk::default);
        self.desks.iter_mut().for_each(Desk::clear);
        is_shared
    }

    /// Lets all robots sense, decide and plan their ways, each from the same view: all of one robot
    /// before the next, so that what is known of it is read from memory once.
    fn sense_decide_and_plan(&mut self, scenario: &Scenario, state: &mut State, outside: &Outside) {
        let is_shared = self.prepare_desks(state);
        let robots = state.robots();
        let plans = self.moves.plans(robots);
        let (mut view, minds) = state.view(scenario, &self.neighbours);
        view.outside = (!outside.is_empty()).then_some(outside);
        self.flocks.ask(&view, is_shared);
        view.flocks = Some(&self.flocks);
        let share = robots.div_ceil(self.desks.len()).max(1);
        let serve = |(number, ((desk, minds), plans)): (usize, Share)| {
            for (place, (mind, plan)) in minds.iter_mut().zip(plans).enumerate() {
                let robot = number * share + place;
                desk.serve(&view, robot, mind);
                *plan = planned(scenario, view.tick, &view.body(robot, mind));
            }
        };
        if is_shared {
            let tasks = self.desks.par_iter_mut().zip(minds.par_chunks_mut(share));
            let tasks = tasks.zip(plans.par_chunks_mut(share));
            tasks.enumerate().for_each(serve);
        } else {
            let tasks = self.desks.iter_mut().zip(minds.chunks_mut(share));
            let tasks = tasks.zip(plans.chunks_mut(share));
            tasks.enumerate().for_each(serve);
        }
    }

    /// What a robot will perceive in the next step, if its brain steps in it.
    pub(crate) fn percept(
        &mut self,
        scenario: &Scenario,
        state: &mut State,
        robot: usize,
    ) -> Option<Percept> {
        self.refresh(scenario, state);
        let (view, minds) = state.view(scenario, &self.neighbours);
        if !view.is_due(robot) {
            return None;
        }
        let mind = &mut minds[robot];
        let waiting = mind.backlog.clone();
        let mut desk = Desk::default();
        desk.perceive(&view, robot, mind);
        mind.backlog = waiting;
        Some(desk.percept)
    }

    /// The robots of the last step for which others decided.
    pub(crate) fn asked(&self) -> &[Asked] {
        &self.asking.robots
    }

    /// What brains decided for bodies outside, by the robot's number.
    pub(crate) fn answers(&mut self) -> impl Iterator<Item = (usize, Command)> {
        self.desks
            .iter_mut()
            .flat_map(|desk| desk.answers.drain(..))
    }

    /// Sends what robots want to tell.
    fn speak(&self, scenario: &Scenario, state: &mut State) {
        if self.desks.iter().all(|desk| desk.outbox.is_empty()) {
            return;
        }
        let mut air = std::mem::take(&mut state.air);
        let (view, _) = state.view(scenario, &self.neighbours);
        for outgoing in self.desks.iter().flat_map(|desk| &desk.outbox) {
            if let Some(radio) = &view.kind(outgoing.from as usize).radio {
                air.send(&view, *outgoing, radio);
            }
        }
        state.air = air;
    }

    fn act(&mut self, scenario: &Scenario, state: &mut State) {
        let is_shared = self.is_shared(state);
        let moved = self.moves.act(scenario, state, &self.neighbours, is_shared);
        self.neighbours.note(moved.farthest_m);
        state.tally.collisions += moved.collisions;
    }

    /// Marks what has been found.
    fn judge(&self, scenario: &Scenario, state: &mut State, asking: &Asking) {
        state.tally.false_alarms += asking.false_alarms;
        for item in &asking.sightings {
            state.find(scenario, *item);
        }
        for desk in &self.desks {
            state.tally.false_alarms += desk.senses.false_alarms;
            for item in &desk.senses.sightings {
                state.find(scenario, *item);
            }
        }
    }
}

/// Brings messages to the robots that hear them in this step.
fn hear(scenario: &Scenario, state: &mut State) {
    let arrived = state.air.arrive();
    for sent in &arrived {
        let robot = sent.to as usize;
        let kind = &scenario.kinds[usize::from(state.ids[robot].kind)];
        let radio = kind
            .radio
            .filter(|_| state.hulls[robot].status == Status::Active);
        if let Some(radio) = radio {
            state.minds[robot].hear(sent, state.tick, radio.messages_per_step);
        }
    }
    state.air.reuse(arrived);
}
