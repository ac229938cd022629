//! The hash of the decisions of a run.

use super::determinism::{commands, crowd};
use super::flocks::birds;
use crate::common::{first, go, id, message, replaced, scenario, start, step_with, with};
use base::geometry::Point;
use brain::{AgentId, Brain, Command, Percept, Reading, SensorRequest};
use rayon::ThreadPoolBuilder;
use sim::scenario::Scenario;
use sim::simulation::{Simulation, StepInputs};
use std::collections::BTreeMap;
use std::sync::Arc;

/// A robot that drives straight ahead whatever it perceives, and that has no radio.
const CRUISING: &str = r#"
world.size_m = [200, 200]
[robots.rover]
start.at_m = [[100, 100], [50, 100]]
sensors.gps.kind = "position"
brain.behaviours = [{ kind = "cruise" }]
"#;

/// Its hashes after each step, from a start at 0.
fn hashes(
    scenario: &Arc<Scenario>,
    steps: u32,
    mut step: impl FnMut(&mut Simulation, u32),
) -> Vec<u64> {
    let mut simulation = Simulation::new(Arc::clone(scenario), 3, 1).unwrap();
    simulation.hash_decisions(0);
    let hash_after = |number| {
        step(&mut simulation, number);
        simulation.state().decision_hash().unwrap()
    };
    (0..steps).map(hash_after).collect()
}

fn assert_same_on_any_number_of_threads(text: &str, step: fn(&mut Simulation, u32)) {
    let scenario = scenario(text);
    let on = |threads| {
        let pool = ThreadPoolBuilder::new().num_threads(threads);
        let pool = pool.build().unwrap();
        pool.install(|| hashes(&scenario, 12, step))
    };
    let alone = on(1);
    assert!(alone.windows(2).all(|pair| pair[0] != pair[1]));
    for threads in [2, 8] {
        assert_eq!(on(threads), alone, "{threads} threads");
    }
}

#[test]
fn decisions_of_a_crowd_have_the_same_hash_on_any_number_of_threads() {
    assert_same_on_any_number_of_threads(&crowd(5000, 160.0), |simulation, step| {
        let commands = commands(simulation, step);
        simulation.step_with(BTreeMap::new(), commands).unwrap();
    });
}

#[test]
fn decisions_of_a_flock_have_the_same_hash_on_any_number_of_threads() {
    let text = birds(5000, 530.0, "noise_deg = 5");
    assert_same_on_any_number_of_threads(&text, |simulation, _| simulation.step());
    // Discs can touch each other, which takes another path of execution.
    let discs = replaced(&text, &[("radius_m = 0", "radius_m = 0.1")]);
    assert_same_on_any_number_of_threads(&discs, |simulation, _| simulation.step());
}

#[test]
fn decisions_of_belief_based_brains_have_the_same_hash_on_any_number_of_threads() {
    let text = include_str!("../../../../../scenarios/search-beliefs.toml");
    let text = replaced(
        text,
        &[("count = 4    #", "count = 80 #"), ("[25, 25]", "[60, 60]")],
    );
    assert_same_on_any_number_of_threads(&text, |simulation, _| simulation.step());
}

#[test]
fn hashing_decisions_changes_no_outcome() {
    let text = crowd(120, 40.0);
    let (mut hashed, mut plain) = (start(&text), start(&text));
    hashed.hash_decisions(0);
    for step in 0..100 {
        for simulation in [&mut hashed, &mut plain] {
            let commands = commands(simulation, step);
            simulation.step_with(BTreeMap::new(), commands).unwrap();
        }
        assert_eq!(hashed.hash(), plain.hash());
        assert_eq!(plain.state().decision_hash(), None);
    }
    assert_eq!(hashed.outcome(), plain.outcome());
}

#[test]
fn each_part_of_a_command_changes_the_hash_of_decisions_in_equal_states() {
    let with = |command: Command| {
        let mut simulation = start(CRUISING);
        simulation.hash_decisions(0);
        step_with(&mut simulation, [(id(0, 0), command)]);
        let state = simulation.state();
        (state.hash(), state.decision_hash())
    };
    let plain = go(1.0, 0.0);
    let others = [
        Command {
            heading_rad: Some(0.0),
            ..plain.clone()
        },
        Command {
            requests: vec![SensorRequest {
                sensor: 7,
                on: false,
            }],
            ..plain.clone()
        },
        // It has no radio.
        Command {
            outbox: vec![message(1.0)],
            ..plain.clone()
        },
    ];
    let (state, decisions) = with(plain);
    for other in others {
        let (same, others) = with(other.clone());
        assert_eq!(same, state, "{other:?}");
        assert_ne!(others, decisions, "{other:?}");
    }
}

#[test]
fn each_percept_of_an_external_body_changes_the_hash_of_decisions() {
    let with = |percept: Percept| {
        let mut simulation = start(CRUISING);
        simulation.hash_decisions(0);
        let percepts = BTreeMap::from([(id(0, 0), percept)]);
        simulation.step_with(percepts, BTreeMap::new()).unwrap();
        let state = simulation.state();
        (state.hash(), state.decision_hash())
    };
    let plain = Percept {
        position: Some(Reading {
            value: Point { x: 100.0, y: 100.0 },
            age_s: 0.0,
        }),
        ..Percept::default()
    };
    let other = Percept {
        battery: Some(Reading {
            value: 0.5,
            age_s: 0.0,
        }),
        ..plain.clone()
    };
    let ((state, decisions), (same, others)) = (with(plain), with(other));
    assert_eq!(same, state);
    assert_ne!(others, decisions);
}

#[test]
fn a_reading_that_changes_no_motion_changes_the_hash_of_decisions() {
    let noisy = with(CRUISING, "robots.rover.sensors.gps.noise_m = 1");
    let [plain, noisy] = [CRUISING, &noisy].map(|text| {
        let mut simulation = start(text);
        simulation.hash_decisions(0);
        simulation.step();
        simulation
    });
    assert_eq!(first(&plain), first(&noisy));
    assert_eq!(plain.hash(), noisy.hash());
    let [plain, noisy] = [plain, noisy].map(|each| each.state().decision_hash());
    assert_ne!(plain, noisy);
}

#[test]
fn a_decision_made_elsewhere_has_the_hash_of_the_same_decision_of_the_brain() {
    let (mut elsewhere, mut commanded, mut own) =
        (start(CRUISING), start(CRUISING), start(CRUISING));
    let brain = elsewhere.scenario().brain(0).cloned().unwrap();
    let mut brains: BTreeMap<AgentId, Brain> = BTreeMap::new();
    for simulation in [&mut elsewhere, &mut commanded, &mut own] {
        simulation.hash_decisions(0);
    }
    for _ in 0..20 {
        let begun = elsewhere.begin_step(StepInputs::default(), &[0]);
        let mut begun = begun.unwrap();
        let mut commands = BTreeMap::new();
        for robot in begun.decisions() {
            let own = brains.entry(robot.robot).or_insert_with(|| brain.clone());
            robot.command = own.step(&robot.percept);
            commands.insert(robot.robot, robot.command.clone());
        }
        elsewhere.finish_step(begun);
        commanded.step_with(BTreeMap::new(), commands).unwrap();
        own.step();
        let hash = own.state().decision_hash();
        assert_eq!(elsewhere.state().decision_hash(), hash);
        assert_eq!(commanded.state().decision_hash(), hash);
    }
}

#[test]
fn a_hash_of_decisions_continues_from_its_start_and_from_a_copy_of_the_state() {
    let scenario = scenario(CRUISING);
    let all = hashes(&scenario, 20, |simulation, _| simulation.step());
    let mut later = Simulation::new(scenario, 3, 1).unwrap();
    (0..10).for_each(|_| later.step());
    later.hash_decisions(all[9]);
    let copy = later.state().clone();
    for _ in 0..2 {
        later.restore(copy.clone());
        for hash in &all[10..] {
            later.step();
            assert_eq!(later.state().decision_hash(), Some(*hash));
        }
    }
}

#[test]
fn a_hash_of_decisions_continues_after_a_change_of_the_scenario() {
    let mut simulation = start(CRUISING);
    simulation.hash_decisions(0);
    simulation.step();
    let hash = simulation.state().decision_hash();
    let other = replaced(CRUISING, &[(", [50, 100]]", "]")]);
    simulation.change(scenario(&other)).unwrap();
    assert_eq!(simulation.state().decision_hash(), hash);
    simulation.step();
    assert_ne!(simulation.state().decision_hash(), hash);
}
