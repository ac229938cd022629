//! External inputs of a step: percepts of bodies that are not simulated, and commands that replace
//! the decisions of brains.

use super::pending_decisions::{PendingDecision, PendingDecisions};
use brain::{Command, Percept};
use std::collections::BTreeMap;

/// External inputs of one step of a run.
#[derive(Debug, Clone, Default)]
pub struct ExternalInputs {
    /// By the number of the robot, as are commands.
    pub(crate) percepts: BTreeMap<usize, Percept>,
    pub(crate) commands: BTreeMap<usize, Command>,
    pub(crate) decisions: PendingDecisions,
}

impl ExternalInputs {
    /// The robots whose decisions are made elsewhere, in their order.
    pub fn decisions(&mut self) -> &mut [PendingDecision] {
        &mut self.decisions.robots
    }

    pub(crate) fn is_empty(&self) -> bool {
        let has_no_decisions = self.decisions.robots.is_empty();
        self.percepts.is_empty() && self.commands.is_empty() && has_no_decisions
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::ScenarioSpec;
    use crate::sensors::pending::MAX_PENDING;
    use crate::simulation::Simulation;
    use base::document::Document;
    use base::geometry::Point;
    use brain::{About, Message, Provenance, RobotId};
    use std::sync::Arc;

    const TWO: &str = "
clock = { time_limit_s = 100 }
world = { size_m = [40, 20] }
[robots.rover]
count = 2
radius_m = 0.2
start = { kind = \"fixed\", at_m = [[10, 10], [12, 10]] }
drive = { max_speed_m_s = 1, max_turn_rate_deg_s = 90 }
radio = { range_m = 5 }
";

    fn start() -> Simulation {
        let document = Document::parse("t", TWO).unwrap();
        let read = ScenarioSpec::read(&document);
        Simulation::new(Arc::new(read.unwrap().scenario), 1, 0).unwrap()
    }

    const HERE: RobotId = RobotId { kind: 0, index: 0 };
    const OUT: RobotId = RobotId { kind: 0, index: 1 };

    fn saying(messages: usize) -> Command {
        let message = Message {
            about: About::Item {
                kind: 0,
                at: Point::default(),
                provenance: Provenance::default(),
            },
            confidence: 1.0,
        };
        Command {
            outbox: vec![message; messages],
            ..Command::default()
        }
    }

    /// One step in which the first robot sends and the other is external, at a place.
    fn speak(simulation: &mut Simulation, x: f64) {
        let command = saying(1);
        let percept = Percept {
            position: Some(brain::Reading {
                value: Point { x, y: 10.0 },
                age_s: 0.0,
            }),
            ..Percept::default()
        };
        let (percepts, commands) = ([(OUT, percept)], [(HERE, command)]);
        simulation
            .step_with(percepts.into(), commands.into())
            .unwrap();
    }

    fn waiting(simulation: &Simulation) -> usize {
        let backlog = simulation.state().agents[1].backlog.as_ref().unwrap();
        backlog.inbox.entries.len()
    }

    #[test]
    fn bodies_outside_hear_where_they_are_and_once() {
        let mut simulation = start();
        speak(&mut simulation, 12.0);
        assert_eq!(waiting(&simulation), 1);
        // Its next percept takes that message to its brain; out of range it receives no more.
        speak(&mut simulation, 39.0);
        assert_eq!(waiting(&simulation), 0);
        speak(&mut simulation, 6.0);
        assert_eq!(waiting(&simulation), 1);
    }

    #[test]
    fn what_waits_for_a_body_that_gets_no_percepts_fills_no_memory() {
        let mut simulation = start();
        speak(&mut simulation, 12.0);
        let command = saying(4);
        for step in 1..3000 {
            let commands = [(HERE, command.clone())].into();
            simulation.step_with([].into(), commands).unwrap();
            let sent = 4 * step;
            assert!((sent.min(MAX_PENDING)..=2 * MAX_PENDING).contains(&waiting(&simulation)));
        }
    }
}
