//! Robots for which others decide than their brains: what they perceive, and what is decided.
//!
//! A step of theirs has two halves. In the first, they sense, which changes nothing: what was waiting
//! for them is told from a copy. Only the second takes the step, so that a run is as it was if no
//! decision comes.

use super::decide::Desk;
use super::mind::{Backlog, Mind};
use super::outside::Outside;
use super::state::State;
use super::tick::Workshop;
use super::view::View;
use crate::scenario::Scenario;
use brain::{Command, Motion, Percept, RobotId};
use rayon::prelude::*;

/// A robot whose brain would step now, and for which another decides.
#[derive(Debug, Clone, Default)]
pub struct Asked {
    /// Which it is.
    pub robot: RobotId,
    /// What its brain would get.
    pub percept: Percept,
    /// What is decided; to stand, at first.
    pub command: Command,
    number: usize,
    /// What waits for it once it has perceived.
    backlog: Option<Box<Backlog>>,
}

/// All that are asked in one step, and what the judge is to know of what they perceive.
#[derive(Debug, Clone, Default)]
pub(crate) struct Asking {
    /// In the order of the robots.
    pub(crate) robots: Vec<Asked>,
    pub(crate) sightings: Vec<u32>,
    pub(crate) false_alarms: u64,
}

impl Asking {
    /// What was decided for a robot, if it was asked.
    pub(crate) fn decided(&self, robot: usize) -> Option<&Command> {
        let place = self.robots.binary_search_by_key(&robot, |each| each.number);
        Some(&self.robots[place.ok()?].command)
    }

    /// Lets time go on for those that were asked: what they were told waits no more.
    pub(crate) fn settle(&mut self, minds: &mut [Mind]) {
        for asked in &mut self.robots {
            if let Some(mind) = minds.get_mut(asked.number) {
                mind.backlog = asked.backlog.take();
            }
        }
    }

    fn note(&mut self, desks: &[Desk]) {
        self.sightings.clear();
        let seen = desks.iter().flat_map(|desk| &desk.senses.sightings);
        self.sightings.extend(seen);
        self.false_alarms = desks.iter().map(|desk| desk.senses.false_alarms).sum();
    }
}

impl Workshop {
    /// Lets the robots of some kinds sense whose brains step now; the state stays as it is.
    pub(crate) fn ask(
        &mut self,
        scenario: &Scenario,
        state: &mut State,
        kinds: &[u8],
        outside: &mut Outside,
    ) {
        self.refresh(scenario, state);
        let is_shared = self.prepare_desks(state);
        let mut asking = std::mem::take(&mut self.asking);
        let (view, minds) = state.view(scenario, &self.neighbours);
        let robots = minds.iter_mut().enumerate();
        let due = robots.filter(|(robot, _)| {
            let is_free = !outside.commands.contains_key(robot);
            is_free && kinds.contains(&view.ids[*robot].kind) && view.is_due(*robot)
        });
        let mut due: Vec<(usize, &mut Mind)> = due.collect();
        asking.robots.resize_with(due.len(), Asked::default);
        let share = due.len().div_ceil(self.desks.len()).max(1);
        let ask = |((desk, due), asked): Share| {
            for ((robot, mind), asked) in due.iter_mut().zip(asked) {
                desk.ask(&view, *robot, mind, asked);
            }
        };
        if is_shared {
            let tasks = self.desks.par_iter_mut().zip(due.par_chunks_mut(share));
            let tasks = tasks.zip(asking.robots.par_chunks_mut(share));
            tasks.for_each(ask);
        } else {
            let tasks = self.desks.iter_mut().zip(due.chunks_mut(share));
            tasks.zip(asking.robots.chunks_mut(share)).for_each(ask);
        }
        asking.note(&self.desks);
        outside.asking = asking;
    }
}

/// The part of one thread: its desk, its robots, and what they are asked.
type Share<'a, 'm> = (
    (&'a mut Desk, &'a mut [(usize, &'m mut Mind)]),
    &'a mut [Asked],
);

impl Desk {
    /// Lets one robot sense whose brain steps now, and leaves what waits for it as it is.
    fn ask(&mut self, view: &View, robot: usize, mind: &mut Mind, asked: &mut Asked) {
        let before = mind.backlog.clone();
        self.perceive(view, robot, mind);
        asked.backlog = std::mem::replace(&mut mind.backlog, before);
        std::mem::swap(&mut asked.percept, &mut self.percept);
        (asked.number, asked.robot) = (robot, view.ids[robot]);
        asked.command.motion = Motion::default();
        asked.command.requests.clear();
        asked.command.outbox.clear();
    }
}
