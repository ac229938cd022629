//! What happened in a run and when, for recordings.
//!
//! A step reports what happened to the judge in the order of the robots, so that events do not depend on threads. Its
//! tallies decide what counts, and only that becomes an event: the first detection of an item does, a second one
//! does not. Events are collected only while a reader exists.

use crate::bodies::body_state::{BodyState, Status};
use crate::clock::seconds;
use crate::scenario::Scenario;
use base::geometry::Point;
use brain::{ActKind, AgentId, GoalId, MarkVerdict, Reason, Receiver};
use std::mem::replace;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};

/// Something that happened in a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Event {
    /// The step: the number of steps taken before it.
    pub tick: u64,
    /// What happened.
    pub kind: EventKind,
}

impl Event {
    /// The simulated time of the step, in seconds.
    #[must_use]
    pub fn time_s(&self, scenario: &Scenario) -> f64 {
        seconds(self.tick, scenario.step_s)
    }
}

/// What happened.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum EventKind {
    /// An item was detected for the first time: it is found.
    Detected {
        /// The number of its kind, and its index.
        item: (u16, u32),
        /// The robot.
        by: AgentId,
    },
    /// A goal was served for the first time, or again by another robot for the first time.
    Served {
        /// The number of its kind, and its index.
        goal: (u8, u32),
        /// The robot that served it.
        by: AgentId,
    },
    /// A robot acted on an item or a place with one of its tools: the first time so, or with a charge.
    Acted {
        /// What it did.
        act: ActKind,
        /// The robot.
        by: AgentId,
        /// The place that it named.
        at: Point,
        /// The number of the kind of the nearest item there, and its index.
        item: Option<(u16, u32)>,
        /// Whether it was done; of a charge, whether it destroyed the item.
        is_success: bool,
    },
    /// An item has destroyed a robot.
    Destroyed {
        /// The robot.
        robot: AgentId,
        /// The number of the kind of the item, and its index.
        item: (u16, u32),
    },
    /// A mine has destroyed a vehicle that passes a lane.
    VehicleLost {
        /// The index of the vehicle.
        vehicle: u32,
        /// The number of the kind of the item, and its index.
        item: (u16, u32),
    },
    /// A vehicle has passed a lane.
    VehiclePassed {
        /// The index of the vehicle.
        vehicle: u32,
    },
    /// A robot ran into something, or something into it.
    Collided {
        /// The robot.
        robot: AgentId,
        /// Its collisions so far.
        total: u32,
    },
    /// The status of a robot changed.
    Status {
        /// The robot.
        robot: AgentId,
        /// Its status now.
        status: Status,
    },
    /// A goal has arrived.
    Issued {
        /// The number of its kind, and its index.
        goal: (u8, u32),
    },
    /// A controller reports that no robot can serve a goal.
    Unserved {
        /// The number of its kind, and its index.
        goal: (u8, u32),
        /// Why.
        reason: Reason,
    },
    /// The deadline of a goal is over, and no robot has served it.
    Expired {
        /// The number of its kind, and its index.
        goal: (u8, u32),
    },
    /// A controller has awarded a goal to a robot.
    Awarded {
        /// The goal.
        goal: GoalName,
        /// The controller.
        by: AgentId,
        /// The robot.
        to: AgentId,
    },
    /// A controller has lost a goal that it owned: its lease has ended.
    Lost {
        /// The goal.
        goal: GoalName,
        /// The controller.
        by: AgentId,
    },
    /// A controller has failed, or the robot that carries it.
    Failed {
        /// The controller.
        controller: AgentId,
    },
    /// A controller has learned of a mark in its lane, or of a verdict on one.
    Marked {
        /// The controller.
        by: AgentId,
        /// Its number of the mark.
        number: u32,
        /// The verdict.
        verdict: Option<MarkVerdict>,
    },
    /// A controller has declared its lane clear, or given it up.
    Stated {
        /// The controller.
        by: AgentId,
        /// Whether it has declared it clear.
        is_clear: bool,
        /// The risk that it states; none if the decision was made elsewhere.
        risk: Option<f64>,
    },
    /// A participant has sent a message about a goal or a mark that changes what its receiver does or holds. Offers,
    /// renewals and information, which are repeated, are no events.
    Sent {
        /// The sender.
        from: AgentId,
        /// The receiver.
        to: Receiver,
        /// The name of its content.
        about: &'static str,
        /// The goal that it is about.
        goal: Option<GoalName>,
    },
}

/// A goal in an event.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct GoalName {
    /// Its id.
    pub id: GoalId,
    /// The number of its kind, and its index; none of a goal that a controller has planned.
    pub place: Option<(u8, u32)>,
}

/// Events of a run with the scenario in which they happened, to which their numbers belong.
pub type Episode = (Arc<Scenario>, Vec<Event>);

/// Reads the events of a run that happen after the reader was created. The run keeps them until they are read.
#[derive(Debug)]
pub struct EventReader(Arc<Mutex<Vec<Episode>>>);

impl EventReader {
    /// Removes and returns the events since the last call, in their order.
    #[must_use]
    pub fn drain(&self) -> Vec<Episode> {
        let mut episodes = locked(&self.0);
        let current = episodes.last().map(|(scenario, _)| Arc::clone(scenario));
        let next = current.map(|scenario| (scenario, Vec::new()));
        replace(&mut *episodes, next.into_iter().collect())
    }
}

/// Passes the events of a run to its readers. A copy of a run has none.
#[derive(Debug, Default)]
pub(crate) struct EventLog {
    readers: Vec<Weak<Mutex<Vec<Episode>>>>,
    /// Collisions and status of each robot before the step.
    before: Vec<(u32, Status)>,
}

impl Clone for EventLog {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl EventLog {
    /// A reader of the events from now on.
    pub(crate) fn reader(&mut self, scenario: &Arc<Scenario>) -> EventReader {
        let episodes = Arc::new(Mutex::new(vec![(Arc::clone(scenario), Vec::new())]));
        self.readers.push(Arc::downgrade(&episodes));
        EventReader(episodes)
    }

    /// Notes the robots before a step, and drops readers that no longer exist.
    #[inline]
    pub(crate) fn begin_step(&mut self, body_states: &[BodyState]) {
        if !self.has_readers() {
            return;
        }
        self.readers.retain(|reader| reader.strong_count() > 0);
        let before = body_states.iter();
        self.before.clear();
        self.before
            .extend(before.map(|body| (body.collisions, body.status)));
    }

    /// Whether there may be readers.
    #[inline]
    pub(crate) fn has_readers(&self) -> bool {
        !self.readers.is_empty()
    }

    /// Passes an event to all readers.
    pub(crate) fn note(&self, tick: u64, kind: EventKind) {
        for reader in self.readers.iter().filter_map(Weak::upgrade) {
            if let Some((_, events)) = locked(&reader).last_mut() {
                events.push(Event { tick, kind });
            }
        }
    }

    /// Notes the collisions of robots in a step, and then the changes of their status.
    #[inline]
    pub(crate) fn end_step(&self, tick: u64, ids: &[AgentId], body_states: &[BodyState]) {
        if !self.has_readers() {
            return;
        }
        let robots = || ids.iter().zip(body_states).zip(&self.before);
        for ((&robot, body), (collisions, _)) in robots() {
            let total = body.collisions;
            if total != *collisions {
                self.note(tick, EventKind::Collided { robot, total });
            }
        }
        for ((&robot, body), (_, before)) in robots() {
            let status = body.status;
            if status != *before {
                self.note(tick, EventKind::Status { robot, status });
            }
        }
    }

    /// Continues from a step with a scenario, the same or another one: later events have not happened.
    pub(crate) fn continue_from(&mut self, tick: u64, scenario: &Arc<Scenario>) {
        for reader in self.readers.iter().filter_map(Weak::upgrade) {
            let mut episodes = locked(&reader);
            for (_, events) in &mut *episodes {
                events.retain(|event| event.tick < tick);
            }
            if episodes.last().is_some_and(|(_, events)| events.is_empty()) {
                episodes.pop();
            }
            episodes.push((Arc::clone(scenario), Vec::new()));
        }
    }
}

/// Events are complete even if another thread panicked.
fn locked<T>(events: &Mutex<T>) -> MutexGuard<'_, T> {
    events.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::ScenarioSpec;
    use base::document::Document;

    const ROVER: &str = "
clock = { time_limit_s = 1 }
world = { size_m = [5, 5] }
[robots.rover]
count = 1
radius_m = 0.4
drive = { max_speed_m_s = 1, max_turn_rate_deg_s = 90 }
";

    fn scenario() -> Arc<Scenario> {
        let document = Document::parse("t.toml", ROVER).unwrap();
        Arc::new(ScenarioSpec::read(&document).unwrap().scenario)
    }

    #[test]
    fn nothing_is_collected_for_readers_that_no_longer_exist() {
        let scenario = scenario();
        let mut log = EventLog::default();
        let bodies = [BodyState::default()];
        let (one, other) = (log.reader(&scenario), log.reader(&scenario));
        log.begin_step(&bodies);
        assert_eq!((log.readers.len(), log.before.len()), (2, 1));
        drop(one);
        log.begin_step(&bodies);
        assert_eq!(log.readers.len(), 1);
        drop(other);
        log.begin_step(&bodies);
        assert_eq!(log.readers.len(), 0);
    }

    #[test]
    fn a_run_that_returns_often_keeps_no_empty_episodes() {
        let scenario = scenario();
        let mut log = EventLog::default();
        let reader = log.reader(&scenario);
        (0..100).for_each(|tick| log.continue_from(tick, &scenario));
        assert_eq!(reader.drain().len(), 1);
    }
}
