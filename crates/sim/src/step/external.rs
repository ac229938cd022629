//! External inputs of a step: percepts of bodies that are not simulated, and commands that replace
//! the decisions of brains.

use super::pending_decisions::{PendingDecision, PendingDecisions};
use brain::{Command, Percept};
use std::collections::BTreeMap;

/// External inputs of one step of a run.
#[derive(Debug, Clone, Default)]
pub struct ExternalInputs {
    /// By the number of the robot.
    pub(crate) percepts: BTreeMap<usize, Percept>,
    /// Percepts that state where external bodies are whose brains do not step, by the number of the robot.
    pub(crate) observed: BTreeMap<usize, Percept>,
    /// External bodies whose percept is not later than the one before: their last motion is repeated.
    pub(crate) repeated: Vec<usize>,
    /// By the number of the participant: robots first, then controllers.
    pub(crate) commands: BTreeMap<usize, Command>,
    pub(crate) decisions: PendingDecisions,
}

impl ExternalInputs {
    /// The robots and controllers whose decisions are made elsewhere, in the order of their numbers.
    pub fn decisions(&mut self) -> &mut [PendingDecision] {
        &mut self.decisions.all
    }

    /// Removes the percepts that are not later than those before.
    pub(crate) fn keep_later(&mut self, is_later: impl Fn(usize, &Percept) -> bool) {
        let repeated = &mut self.repeated;
        self.percepts.retain(|robot, percept| {
            let is_later = is_later(*robot, percept);
            if !is_later {
                repeated.push(*robot);
            }
            is_later
        });
    }

    pub(crate) fn is_empty(&self) -> bool {
        let has_no_decisions = self.decisions.all.is_empty();
        self.percepts.is_empty() && self.commands.is_empty() && has_no_decisions
    }
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "exact by construction")]
mod tests {
    use super::*;
    use crate::scenario::ScenarioSpec;
    use crate::sensors::pending::MAX_PENDING;
    use crate::simulation::{Simulation, StepInputs};
    use base::document::Document;
    use base::geometry::Point;
    use brain::{About, AgentId, Message, Provenance, Receiver};
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

    fn of(text: &str) -> Simulation {
        let document = Document::parse("t", text).unwrap();
        let read = ScenarioSpec::read(&document);
        Simulation::new(Arc::new(read.unwrap().scenario), 1, 0).unwrap()
    }

    fn start() -> Simulation {
        of(TWO)
    }

    const HERE: AgentId = AgentId::robot(0, 0);
    const OUT: AgentId = AgentId::robot(0, 1);

    fn saying(messages: usize) -> Command {
        let message = Message {
            to: Receiver::All,
            about: About::Item {
                kind: 0,
                at: Point::default(),
                provenance: Provenance::default(),
                kind_share: None,
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
        let inputs = &simulation.state().agents[1].inputs;
        inputs.participant.as_ref().unwrap().inbox.entries.len()
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
    fn messages_wait_while_percepts_are_not_later() {
        let mut simulation = start();
        let mut percept_at = |time_s: f64| {
            let time_s = Some(time_s);
            let percept = Percept { time_s, ..at(12.0) };
            let (percepts, commands) = ([(OUT, percept)], [(HERE, saying(1))]);
            simulation
                .step_with(percepts.into(), commands.into())
                .unwrap();
            waiting(&simulation)
        };
        let counts = [1.0, 1.0, 0.5, 1.0, 2.0].map(&mut percept_at);
        assert_eq!(counts, [1, 2, 3, 4, 1]);
    }

    fn at(x: f64) -> Percept {
        Percept {
            position: Some(brain::Reading {
                value: Point { x, y: 10.0 },
                age_s: 0.0,
            }),
            ..Percept::default()
        }
    }

    #[test]
    fn lists_of_neighbours_stay_valid_while_an_external_body_moves_a_little() {
        let mut simulation = start();
        let still = BTreeMap::from([(HERE, Command::default())]);
        let mut are_valid_at = |x: f64| {
            let inputs = StepInputs {
                percepts: [(OUT, at(x))].into(),
                commands: still.clone(),
                ..StepInputs::default()
            };
            let external = simulation.begin_step(inputs, &[]).unwrap();
            let are_valid = simulation.neighbours().are_valid();
            simulation.finish_step(external);
            are_valid
        };
        // Lists reach 0.6 m farther than needed.
        are_valid_at(12.0);
        assert!(are_valid_at(12.1) && are_valid_at(12.2) && are_valid_at(12.25));
        assert!(are_valid_at(12.25));
    }

    #[test]
    fn the_age_of_lists_of_neighbours_changes_nothing_where_external_bodies_move() {
        let text = TWO
            .replace("count = 2", "count = 12")
            .replace(", at_m = [[10, 10], [12, 10]]", "")
            .replace("\"fixed\"", "\"uniform\"")
            + "sensors.sonar = { kind = \"range\", rays = 8, range_m = 4 }\n";
        for world in ["", ", periodic = true"] {
            let text = text.replace("size_m = [40, 20]", &format!("size_m = [40, 20]{world}"));
            let mut kept = of(&text);
            let mut rebuilt = kept.clone();
            for step in 0..300 {
                let x = f64::from(step) * 0.13;
                // Now and then it jumps.
                let x = if step % 50 == 49 { 45.0 - x } else { x };
                for simulation in [&mut kept, &mut rebuilt] {
                    simulation
                        .step_with([(OUT, at(x))].into(), [].into())
                        .unwrap();
                }
                // Restoring a state forgets the lists.
                let state = rebuilt.state().clone();
                rebuilt.restore(state);
                assert_eq!(kept.state().hash(), rebuilt.state().hash(), "{step}");
            }
        }
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

    /// A percept of an external body that faces along x.
    fn facing(x: f64, time_s: f64) -> Percept {
        Percept {
            time_s: Some(time_s),
            heading_rad: Some(brain::Reading {
                value: 0.0,
                age_s: 0.0,
            }),
            ..at(x)
        }
    }

    fn x_m(simulation: &Simulation) -> f64 {
        simulation.state().discs[1].centre.x
    }

    #[test]
    fn between_percepts_a_body_moves_as_commanded_and_when_they_end_it_stands() {
        let mut simulation = of(&TWO.replace("clock = {", "clock = { step_s = 0.1,"));
        simulation
            .step_with([(OUT, facing(14.0, 0.0))].into(), [].into())
            .unwrap();
        // It cruises at 1 m/s, with the lag that is assumed, until two periods have passed.
        let places: Vec<f64> = (0..30)
            .map(|_| {
                simulation.step();
                x_m(&simulation)
            })
            .collect();
        assert!(
            places[0] > 14.01 && places[1] > places[0] + 0.01,
            "{places:?}"
        );
        assert!((places[1] - places[29]).abs() < 1e-12, "{places:?}");
        assert_eq!(simulation.state().body_states[1].speed_m_s, 0.0);
    }

    #[test]
    fn a_body_that_comes_to_be_in_another_one_or_in_the_border_has_a_collision() {
        let mut simulation = start();
        let mut collisions = |x: f64, time_s: f64| {
            let percepts = [(OUT, facing(x, time_s))].into();
            simulation
                .step_with(percepts, [(HERE, Command::default())].into())
                .unwrap();
            simulation.state().body_states[1].collisions
        };
        let mut time_s = 0.0;
        let counts = [20.0, 10.1, 10.2, 20.0, 10.1, 20.0, 39.9].map(|x| {
            time_s += 1.0;
            collisions(x, time_s)
        });
        assert_eq!(counts, [0, 1, 1, 1, 2, 2, 3]);
    }
}
