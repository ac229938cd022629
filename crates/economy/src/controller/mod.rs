//! A controller.

use crate::settings::Settings;
use alloc::sync::Arc;
use alloc::vec::Vec;
use brain::{About, Command, Dispatch, Percept, ReceivedMessage, RobotId, Task};

/// One controller: it owns goals, and awards them to robots.
#[derive(Debug, Clone)]
pub struct Controller {
    settings: Arc<Settings>,
    owned: Vec<Task>,
    refused: u32,
}

base::hashed!(Controller { owned, refused } without { settings });

/// A goal that a controller owns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OwnedGoal {
    /// The goal.
    pub task: Task,
    /// The robot that serves it, and the remaining time of its lease in seconds; `None` if there is none.
    pub assignee: Option<(RobotId, f64)>,
}

impl Controller {
    /// A controller that has just been switched on.
    #[must_use]
    pub fn new(settings: Arc<Settings>) -> Self {
        Self {
            settings,
            owned: Vec::new(),
            refused: 0,
        }
    }

    /// The command for a percept, of which it uses time, id, position, neighbours and inbox.
    pub fn step_into(&mut self, percept: &Percept, command: &mut Command) {
        command.outbox.clear();
        for received in &percept.inbox {
            self.receive(received);
        }
    }

    /// The goals that it owns, in the order in which it received them.
    pub fn goals(&self) -> impl Iterator<Item = OwnedGoal> {
        self.owned.iter().map(|task| OwnedGoal {
            task: *task,
            assignee: None,
        })
    }

    /// Number of goals that it refused because it owned the maximum number.
    #[must_use]
    pub fn refused(&self) -> u32 {
        self.refused
    }

    fn receive(&mut self, received: &ReceivedMessage) {
        if let About::Dispatch(Dispatch::Issue(task)) = received.message.about
            && received.from == RobotId::OPERATOR
        {
            self.own(task);
        }
    }

    fn own(&mut self, task: Task) {
        let is_known = self.owned.iter().any(|owned| owned.id == task.id);
        if is_known {
            return;
        }
        if self.owned.len() < self.settings.max_goals as usize {
            self.owned.push(task);
        } else {
            self.refused += 1;
        }
    }
}
