//! A robot that is watched: what its brain perceives, decides, and why.
//!
//! Whoever watches costs robots nothing: what the brain had before its last step is kept, and what it made of
//! that is found out only when it is asked for, by a copy of the brain that takes the step once more.

use super::simulation::Simulation;
use super::state::Status;
use brain::{Brain, Decision, Percept, RobotId};

/// Which robot is watched, and what its brain had before it stepped last.
#[derive(Debug, Clone, Default)]
pub(super) struct Watch {
    robot: Option<RobotId>,
    last: Option<Box<Last>>,
}

#[derive(Debug, Clone)]
struct Last {
    tick: u64,
    percept: Percept,
    brain: Brain,
}

impl Watch {
    /// What was decided so far is of another moment.
    pub(super) fn forget(&mut self) {
        self.last = None;
    }
}

/// What a robot perceived, and what its brain made of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Watched {
    /// Which robot.
    pub robot: RobotId,
    /// Steps of the run before that in which it decided so.
    pub tick: u64,
    /// What it perceived.
    pub percept: Percept,
    /// What it decided, and why.
    pub decision: Decision,
}

impl Simulation {
    /// Watches a robot from now on, or none; nothing in the run changes by that. With another scenario it
    /// ends, as robots have other numbers then.
    pub fn watch(&mut self, robot: Option<RobotId>) {
        if self.watch.robot != robot {
            self.watch = Watch { robot, last: None };
        }
    }

    /// The robot that is watched.
    #[must_use]
    pub fn watches(&self) -> Option<RobotId> {
        self.watch.robot
    }

    /// What the watched robot decides in the next step, or if its brain does not step then, what it decided
    /// when it stepped last; `None` if it has not since it is watched, or cannot go on.
    pub fn watched(&mut self) -> Option<Watched> {
        self.look();
        let robot = self.watch.robot?;
        let last = self.watch.last.as_deref()?;
        Some(Watched {
            robot,
            tick: last.tick,
            percept: last.percept.clone(),
            decision: last.brain.decision(&last.percept),
        })
    }

    /// Keeps what the watched robot's brain has before it steps.
    #[inline]
    pub(super) fn look(&mut self) {
        if let Some(robot) = self.watch.robot {
            self.look_at(robot);
        }
    }

    fn look_at(&mut self, id: RobotId) {
        let number = self.number(id).ok();
        let can_go_on = |robot: &usize| {
            let hull = &self.state.hulls[*robot];
            hull.status == Status::Active && !hull.is_external
        };
        let Some(robot) = number.filter(can_go_on) else {
            self.watch.forget();
            return;
        };
        if let Ok(Some(percept)) = self.percept(id) {
            self.watch.last = Some(Box::new(Last {
                tick: self.state.tick(),
                percept,
                brain: self.state.minds[robot].brain.clone(),
            }));
        }
    }
}
