//! After a warm-up, a step does not allocate.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test may fail by a panic"
)]

use allocation_counter::measure;
use base::document::Document;
use base::geometry::Point;
use brain::{
    About, AgentId, Body, Brain, BrainSpec, Command, Contact, Detector, Message, Neighbour,
    Observation, Percept, Provenance, RangeRing, Reading, ReceivedMessage, Receiver, Scan,
};
use sim::scenario::ScenarioSpec;
use sim::simulation::Simulation;
use std::collections::BTreeMap;
use std::sync::Arc;

const WARM_UP: usize = 6000;

/// The number of steps after the warm-up in which a list may exceed its previous maximum length.
const NEW_MAXIMA: usize = 3;

fn everything() -> Simulation {
    let text = include_str!("everything.toml");
    let document = Document::parse("everything.toml", text).unwrap();
    let checked = ScenarioSpec::read(&document).unwrap_or_else(|errors| panic!("{errors}"));
    Simulation::new(Arc::new(checked.scenario), 1, 0).unwrap()
}

#[test]
fn a_step_does_not_allocate() {
    assert_steps_do_not_allocate(everything());
}

#[test]
fn a_step_does_not_allocate_while_decisions_are_hashed() {
    let mut simulation = everything();
    simulation.hash_decisions(0);
    assert_steps_do_not_allocate(simulation);
}

fn assert_steps_do_not_allocate(mut simulation: Simulation) {
    (0..WARM_UP).for_each(|_| simulation.step());
    let steps = (0..3000).map(|_| measure(|| simulation.step()).count_total);
    let allocating = steps.filter(|count| *count > 0).count();
    assert!(allocating <= NEW_MAXIMA, "{allocating}");
    let outcome = simulation.outcome();
    assert!(outcome.collisions > 10 && outcome.false_alarms > 10);
    assert!(outcome.found.iter().sum::<u32>() > 0);
}

#[test]
fn a_step_of_a_flock_does_not_allocate() {
    let text = include_str!("../../../../python/agent_economy/scenarios/flock.toml");
    let document = Document::parse("flock.toml", text).unwrap();
    let scenario = ScenarioSpec::read(&document).unwrap().scenario;
    let mut simulation = Simulation::new(Arc::new(scenario), 1, 0).unwrap();
    simulation.hash_decisions(0);
    (0..10).for_each(|_| simulation.step());
    let steps = (0..300).map(|_| measure(|| simulation.step()).count_total);
    assert_eq!(steps.sum::<u64>(), 0);
}

/// Commands for all rovers, whose messages are allocated before the step.
fn commands(messages: usize) -> BTreeMap<AgentId, Command> {
    let message = Message {
        to: Receiver::All,
        about: About::Item {
            kind: 0,
            at: Point::default(),
            provenance: Provenance::default(),
            kind_share: None,
        },
        confidence: 0.5,
    };
    let command = Command {
        outbox: vec![message; messages],
        ..Command::default()
    };
    let id = |index| AgentId::robot(1, index);
    (0..12).map(|index| (id(index), command.clone())).collect()
}

/// Passing commands takes a constant number of allocations.
#[test]
fn messages_are_sent_and_received_without_allocation() {
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
    assert!(others <= NEW_MAXIMA, "{others} {silent} {}", count(6));
}

/// Documented maximum size of beliefs in bytes: constant part, per cell, and per ray.
const BELIEFS_BYTES: [usize; 3] = [62_000, 20, 40];

/// Documented maximum size of the history of poses with late readings, in bytes.
const HISTORY_BYTES: usize = 50_000;

/// A belief-based brain with a map of this number of cells.
fn brain_with_beliefs(cells: usize, rays: u32) -> Brain {
    let spec = format!(
        r#"{{
            "arbitration": {{"kind": "goals"}},
            "beliefs": {{"cells": {cells}, "cell_m": 0.05}},
            "behaviours": [{{"kind": "hold_position"}}, {{"kind": "bayesian_search"}}, {{"kind": "return_home", "min_charge": 0.5}}]
        }}"#
    );
    let spec: BrainSpec = serde_json::from_str(&spec).unwrap();
    let ring = RangeRing {
        bearings_rad: (0..rays)
            .map(|ray| std::f64::consts::TAU * f64::from(ray) / f64::from(rays) - 3.1)
            .collect(),
        range_m: 5.0,
        period_s: 0.1,
        latency_s: 0.0,
    };
    let eye = Detector {
        range_m: 4.0,
        width_rad: 7.0,
        detection_probability: vec![vec![[0.0, 0.9], [4.0, 0.5]]],
        false_alarms_per_m2: vec![0.01],
        noise_m: 0.1,
        ..Detector::default()
    };
    let body = Body {
        radius_m: 0.25,
        max_speed_m_s: 1.0,
        max_acceleration_m_s2: 1.0,
        max_turn_rate_rad_s: 1.5,
        period_s: 0.1,
        rings: vec![ring],
        detectors: vec![eye],
        item_kinds: vec!["mine".into()],
        field: Some(base::geometry::Rectangle::spanned(
            Point { x: -20.0, y: -20.0 },
            Point { x: 20.0, y: 20.0 },
        )),
        ..Body::default()
    };
    Brain::new(Arc::new(spec), Arc::new(body))
}

/// A percept with more items, nearby robots and senders than beliefs can hold, and with readings of
/// this age.
fn crowded_percept(step: u32, rays: u32, age_s: f64) -> Percept {
    let spread = |number: u32| f64::from((number * 7919 + step * 104_729) % 1000) / 1000.0;
    let id = |number: u32| AgentId::robot(0, 1 + (number * 31 + step * 17) % 200);
    let place = |number: u32| Point {
        x: 40.0 * spread(number) - 20.0,
        y: 40.0 * spread(number + 500) - 20.0,
    };
    let message = |number: u32| ReceivedMessage {
        from: id(number),
        age_s: 0.0,
        message: Message {
            to: Receiver::All,
            about: if number.is_multiple_of(2) {
                About::Sender {
                    at: place(number),
                    heading_rad: 0.0,
                    observations: step,
                }
            } else {
                About::Item {
                    kind: 0,
                    at: place(number),
                    provenance: Provenance {
                        observer: id(number),
                        track_id: number,
                        observations: step + 1,
                    },
                    kind_share: None,
                }
            },
            confidence: 0.9,
        },
    };
    Percept {
        position: Some(Reading {
            value: place(3),
            age_s,
        }),
        heading_rad: Some(Reading {
            value: 6.0 * spread(9) - 3.0,
            age_s,
        }),
        scans: vec![Scan {
            age_s: Some(0.0),
            ranges_m: (0..rays).map(|ray| 0.3 + 4.0 * spread(ray)).collect(),
        }],
        observations: vec![Observation {
            sensor: 0,
            age_s: 0.0,
        }],
        contacts: (0..40)
            .map(|number| Contact {
                kind: 0,
                sensor: 0,
                range_m: 4.0 * spread(number),
                bearing_rad: 6.0 * spread(number + 77) - 3.0,
                age_s: 0.0,
            })
            .collect(),
        neighbours: (0..60)
            .map(|number| Neighbour {
                range_m: 0.6 + 5.0 * spread(number),
                bearing_rad: 6.0 * spread(number + 300) - 3.0,
                course_rad: None,
                age_s: 0.0,
                uncertainty_m: 0.0,
                id: id(number),
            })
            .collect(),
        inbox: (0..60).map(message).collect(),
        ..Percept::default()
    }
}

#[test]
fn beliefs_stay_within_their_documented_size() {
    let immediate = [(16, 16, 0.0), (4096, 360, 0.0), (30_000, 16, 0.0)];
    for (cells, rays, age_s) in immediate.into_iter().chain([(16, 16, 4.95)]) {
        let percept = |step| crowded_percept(step, rays, age_s);
        let percepts: Vec<Percept> = (0..400).map(percept).collect();
        let initial = brain_with_beliefs(cells, rays);
        let mut kept = None;
        let bytes = measure(|| {
            let mut brain = initial.clone();
            let mut command = Command::default();
            for percept in &percepts {
                brain.step_into(percept, &mut command);
            }
            kept = Some(brain);
        });
        let history = if age_s > 0.0 { HISTORY_BYTES } else { 0 };
        let max = BELIEFS_BYTES[0]
            + BELIEFS_BYTES[1] * cells
            + BELIEFS_BYTES[2] * rays as usize
            + history;
        let bytes = usize::try_from(bytes.bytes_current).unwrap();
        assert!(bytes <= max, "{cells} cells, {rays} rays: {bytes} of {max}");
        let belief_state = kept.unwrap().belief_state().unwrap();
        let counts = (belief_state.items.len(), belief_state.robots.len());
        assert!(
            (20..=64).contains(&counts.0) && counts.1 == 16,
            "{counts:?}"
        );
    }
}
