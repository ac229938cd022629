//! Simulations stepped one by one.

pub(crate) use crate::scenarios::{read, scenario, with};
use base::geometry::Point;
use base::random::{Entity, Purpose, Stream, stream, unit};
use brain::{About, AgentId, Command, Message, Motion, Provenance, Receiver};
use sim::run::Robot;
use sim::simulation::Simulation;
use std::collections::BTreeMap;

/// A simulation of a scenario at tick 0.
pub(crate) fn start(text: &str) -> Simulation {
    Simulation::new(scenario(text), 1, 0).unwrap()
}

/// The current state of all robots.
pub(crate) fn robots(simulation: &Simulation) -> Vec<Robot> {
    let scenario = simulation.scenario();
    simulation.state().each_robot(scenario).collect()
}

/// The first robot of the first kind.
pub(crate) fn first(simulation: &Simulation) -> Robot {
    robots(simulation)[0]
}

pub(crate) fn id(kind: u8, index: u32) -> AgentId {
    AgentId::robot(kind, index)
}

pub(crate) fn motion(speed_m_s: f64, turn_rate_rad_s: f64) -> Motion {
    Motion {
        speed_m_s,
        turn_rate_rad_s,
    }
}

/// A command with this motion and no messages.
pub(crate) fn go(speed_m_s: f64, turn_rate_rad_s: f64) -> Command {
    Command {
        motion: motion(speed_m_s, turn_rate_rad_s),
        ..Command::default()
    }
}

/// A command to send messages without moving.
pub(crate) fn send(messages: &[Message]) -> Command {
    Command {
        outbox: messages.to_vec(),
        ..Command::default()
    }
}

/// A message identified by its number.
pub(crate) fn message(number: f64) -> Message {
    let at = Point { x: number, y: 0.0 };
    Message {
        to: Receiver::All,
        about: About::Item {
            kind: 0,
            at,
            provenance: Provenance::default(),
            kind_share: None,
        },
        confidence: 0.5,
    }
}

/// `text` with the first occurrence of each part replaced; every part must occur.
pub(crate) fn replaced(text: &str, changes: &[(&str, &str)]) -> String {
    changes.iter().fold(text.to_owned(), |text, (this, that)| {
        assert!(text.contains(this), "{this}");
        text.replacen(this, that, 1)
    })
}

/// Steps with the same speeds and turn rates; returns the state of all robots after each step.
pub(crate) fn drive(
    simulation: &mut Simulation,
    steps: u32,
    commands: &[(AgentId, f64, f64)],
) -> Vec<Vec<Robot>> {
    let step = |_| {
        let commands = commands.iter();
        step_with(
            simulation,
            commands.map(|(id, speed, turn)| (*id, go(*speed, *turn))),
        );
        robots(simulation)
    };
    (0..steps).map(step).collect()
}

/// One step with commands for some robots.
pub(crate) fn step_with(
    simulation: &mut Simulation,
    commands: impl IntoIterator<Item = (AgentId, Command)>,
) {
    let commands: BTreeMap<AgentId, Command> = commands.into_iter().collect();
    simulation.step_with(BTreeMap::new(), commands).unwrap();
}

/// Random numbers for a test.
pub(crate) struct Random(Stream);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        let entity = Entity { kind: 0, index: 0 };
        Self(stream(seed, 0, entity, Purpose::Start))
    }

    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * unit(&mut self.0)
    }

    pub(crate) fn below(&mut self, end: u32) -> u32 {
        self.0.bounded(end)
    }

    pub(crate) fn one_of<T: Copy>(&mut self, values: &[T]) -> T {
        values[self.below(u32::try_from(values.len()).unwrap()) as usize]
    }

    pub(crate) fn point(&mut self, width: f64, height: f64) -> Point {
        Point {
            x: self.between(0.0, width),
            y: self.between(0.0, height),
        }
    }
}
