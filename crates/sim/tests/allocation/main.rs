//! Once a run has got going, a step allocates nothing.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test may fail by a panic"
)]

use allocation_counter::measure;
use base::document::Document;
use base::geometry::Point;
use brain::{About, Command, Message, RobotId, Seen};
use sim::engine::Simulation;
use sim::scenario::ScenarioSpec;
use std::collections::BTreeMap;
use std::sync::Arc;

const WARM_UP: usize = 6000;

/// In so many of the steps after that, some list may be longer than it has ever been.
const NEW_MOSTS: usize = 3;

fn everything() -> Simulation {
    let text = include_str!("everything.toml");
    let document = Document::parse("everything.toml", text).unwrap();
    let checked = ScenarioSpec::read(&document).unwrap_or_else(|faults| panic!("{faults}"));
    Simulation::new(Arc::new(checked.scenario), 1, 0).unwrap()
}

#[test]
fn a_step_allocates_nothing() {
    let mut simulation = everything();
    (0..WARM_UP).for_each(|_| simulation.step());
    let steps = (0..3000).map(|_| measure(|| simulation.step()).count_total);
    let allocating = steps.filter(|count| *count > 0).count();
    assert!(allocating <= NEW_MOSTS, "{allocating}");
    let outcome = simulation.outcome();
    assert!(outcome.collisions > 10 && outcome.false_alarms > 10);
    assert!(outcome.found.iter().sum::<u32>() > 0);
}

#[test]
fn a_flocks_step_allocates_nothing() {
    let text = include_str!("../../../../python/agent_economy/scenarios/flock.toml");
    let document = Document::parse("flock.toml", text).unwrap();
    let scenario = ScenarioSpec::read(&document).unwrap().scenario;
    let mut simulation = Simulation::new(Arc::new(scenario), 1, 0).unwrap();
    (0..10).for_each(|_| simulation.step());
    let steps = (0..300).map(|_| measure(|| simulation.step()).count_total);
    assert_eq!(steps.sum::<u64>(), 0);
}

/// Commands of all rovers; what they hold is allocated before the step.
fn commands(messages: usize) -> BTreeMap<RobotId, Command> {
    let message = Message {
        about: About::Item {
            kind: 0,
            at: Point::default(),
            seen: Seen::default(),
        },
        confidence: 0.5,
    };
    let command = Command {
        outbox: vec![message; messages],
        ..Command::default()
    };
    let id = |index| RobotId { kind: 1, index };
    (0..12).map(|index| (id(index), command.clone())).collect()
}

/// Handing commands in takes some allocations, always as many.
#[test]
fn messages_are_sent_and_heard_without_allocating() {
    let mut simulation = everything();
    let mut count = |messages| {
        let commands = commands(messages);
        let step = || simulation.step_with(BTreeMap::new(), commands).unwrap();
        measure(|| drop(step())).count_total
    };
    for _ in 0..WARM_UP {
        count(6);
    }
    let silent = count(0);
    let others = (0..1000).filter(|_| count(6) != silent).count();
    assert!(others <= NEW_MOSTS, "{others} {silent} {}", count(6));
}
