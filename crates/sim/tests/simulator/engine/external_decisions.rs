//! Robots whose commands come from the caller instead of their brains.

use crate::common::{go, scenario, start};
use brain::{AgentId, Brain, Percept};
use sim::simulation::{Simulation, StepInputs};
use std::collections::BTreeMap;

/// Everything that is kept for a brain's next step: late scans and detections, messages.
const LATE: &str = r#"
clock.time_limit_s = 100
world.obstacles = [{ circle = { at_m = [10, 5], radius_m = 1 } }]
items.mine.count = 3
robots.tug = { count = 2, radius_m = 0.3 }
[robots.rover]
count = 4
radius_m = 0.3
brain.rate_hz = 4
radio = { range_m = 8, delay_s = 0.3, loss_probability = 0.1 }
sensors.sonar = { kind = "range", rays = 8, range_m = 3, latency_s = 0.3 }
sensors.eye = { kind = "items", range_m = 2, latency_s = 0.5, detection_probability.mine = 0.5,
    false_alarm_rate_per_m2_s.mine = 0.01 }
"#;

fn requests(simulation: &mut Simulation) -> Vec<(AgentId, Percept)> {
    let mut requested = simulation.begin_step(StepInputs::default(), &[0]).unwrap();
    let requested = requested.decisions().iter();
    requested
        .map(|each| (each.robot, each.percept.clone()))
        .collect()
}

#[test]
fn external_decisions_equal_to_the_brains_give_the_same_run() {
    let (mut requested, mut plain) = (start(LATE), start(LATE));
    let brain = scenario(LATE).brain(0).cloned().unwrap();
    let mut brains: BTreeMap<AgentId, Brain> = BTreeMap::new();
    for _ in 0..600 {
        let begun = requested.begin_step(StepInputs::default(), &[0]);
        let mut begun = begun.unwrap();
        for robot in begun.decisions() {
            let own = brains.entry(robot.robot).or_insert_with(|| brain.clone());
            robot.command = own.step(&robot.percept);
        }
        requested.finish_step(begun);
        plain.step();
        assert_eq!(requested.state().hash(), plain.state().hash());
    }
    assert_eq!(requested.outcome(), plain.outcome());
    assert!(plain.outcome().false_alarms > 0 && plain.outcome().found[0] > 0);
    assert_eq!(brains.len(), 4);
}

#[test]
fn a_request_without_an_answer_has_no_effect() {
    let (mut requested, mut plain) = (start(LATE), start(LATE));
    for _ in 0..200 {
        let percepts = requests(&mut requested);
        assert_eq!(requests(&mut requested), percepts);
        for (robot, percept) in percepts {
            assert_eq!(requested.percept(robot).unwrap(), Some(percept));
        }
        requested.step();
        plain.step();
    }
    assert_eq!(requested.state().hash(), plain.state().hash());
}

#[test]
fn requests_cover_robots_whose_brains_step_and_that_have_no_command() {
    let mut simulation = start(LATE);
    let counts: Vec<usize> = (0..5)
        .map(|_| {
            let count = requests(&mut simulation).len();
            simulation.step();
            count
        })
        .collect();
    assert_eq!(counts, [4, 0, 0, 4, 0]);
    let commanded = StepInputs {
        commands: BTreeMap::from([(AgentId::robot(0, 1), go(0.0, 0.0))]),
        ..StepInputs::default()
    };
    let mut begun = simulation.begin_step(commanded, &[0, 1]).unwrap();
    let robots: Vec<AgentId> = begun.decisions().iter().map(|each| each.robot).collect();
    let ids = [(0, 0), (0, 2), (0, 3), (1, 0), (1, 1)];
    assert_eq!(robots, ids.map(|(kind, index)| AgentId::robot(kind, index)));
}
