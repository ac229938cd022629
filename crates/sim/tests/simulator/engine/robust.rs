//! No valid scenario makes a run panic or exceed its bounds.

use super::random;
use crate::common::{Random, motion, read, robots};
use base::engine::{BlockOptions, ColumnKind, Runner};
use base::geometry::Point;
use brain::{About, Act, ActKind, Command, Message, Provenance, SensorRequest};
use sim::run::{State, Status};
use sim::runner::Runs;
use sim::scenario::Scenario;
use sim::simulation::Simulation;
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::sync::Arc;

/// Random scenarios without errors.
fn scenarios(count: u64) -> Vec<(u64, Arc<Scenario>)> {
    let read =
        (0..count).filter_map(|seed| Some((seed, Arc::new(read(&random::text(seed)).ok()?))));
    let all: Vec<_> = read.collect();
    assert!(
        2 * all.len() as u64 > count,
        "{} of {count} pass the checks",
        all.len()
    );
    all
}

/// Any motion, requests and messages, absurd ones among them.
fn command(random: &mut Random) -> Command {
    let values = [0.0, 1.0, -1.0, 1e300, f64::NAN, f64::INFINITY];
    let at = Point {
        x: random.one_of(&values),
        y: 2.0,
    };
    let about = match random.below(2) {
        0 => About::Item {
            kind: 3,
            at,
            provenance: Provenance::default(),
            kind_share: None,
        },
        _ => About::Sender {
            at,
            heading_rad: 1.0,
            observations: random.below(9),
        },
    };
    let message = Message {
        to: brain::Receiver::All,
        about,
        confidence: random.one_of(&values),
    };
    let request = SensorRequest {
        sensor: u16::try_from(random.below(40)).unwrap(),
        on: random.below(2) == 0,
    };
    let acts = (0..random.below(6)).map(|_| act(random)).collect();
    Command {
        motion: motion(random.one_of(&values), random.one_of(&values)),
        heading_rad: Some(random.one_of(&values)),
        requests: vec![request],
        outbox: vec![message; random.below(4) as usize],
        acts,
    }
}

/// Any act, at a place in the world or at an absurd one.
fn act(random: &mut Random) -> Act {
    let kinds = [
        ActKind::Mark,
        ActKind::Confirm,
        ActKind::Reject,
        ActKind::Isolate,
        ActKind::Neutralise,
    ];
    let absurd = [-1.0, 1e300, f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
    let along = |random: &mut Random| match random.below(4) {
        0 => random.one_of(&absurd),
        _ => random.between(0.0, 20.0),
    };
    let [x, y] = [along(random), along(random)];
    Act {
        kind: random.one_of(&kinds),
        at: Point { x, y },
    }
}

fn assert_sane(simulation: &Simulation, seed: u64) {
    let world = simulation.scenario().world();
    for robot in robots(simulation) {
        let beside_m = world.distance_m(robot.at);
        assert!(beside_m < 1e-6, "{seed}: {robot:?}");
        assert!(robot.heading_rad.abs() <= PI + 1e-9, "{seed}: {robot:?}");
        assert!(
            robot.battery.is_none_or(|left| (0.0..=1.0).contains(&left)),
            "{seed}: {robot:?}"
        );
        assert!(robot.speed_m_s.is_finite() && robot.distance_m.is_finite());
        assert!(
            robot.status == Status::Active || robot.speed_m_s == 0.0 || robot.battery.is_some()
        );
    }
}

#[test]
fn no_scenario_without_errors_makes_a_run_panic() {
    let (mut stepped, mut done, mut lost) = (0, 0, 0);
    for (seed, scenario) in scenarios(150) {
        let Ok(mut simulation) = Simulation::new(scenario, seed, 0) else {
            continue;
        };
        let mut random = Random::new(seed);
        for step in 0..200_u32 {
            let ids: Vec<_> = robots(&simulation).iter().map(|robot| robot.id).collect();
            let commanded = ids.iter().filter(|_| step % 3 == 0 && random.below(2) == 0);
            let commanded: Vec<_> = commanded.copied().collect();
            let commands: BTreeMap<_, _> = commanded
                .into_iter()
                .map(|id| (id, command(&mut random)))
                .collect();
            simulation.step_with(BTreeMap::new(), commands).unwrap();
            if let Some(id) = ids.first() {
                let _ = simulation.percept(*id).unwrap();
            }
            assert_sane(&simulation, seed);
            stepped += ids.len();
        }
        let outcome = simulation.outcome();
        assert!(outcome.is_finite(), "{seed}");
        if let Some(acts) = outcome.acts {
            done += acts.marked + acts.false_marks + acts.confirmed + acts.neutralised;
            lost += acts.robots_lost;
        }
    }
    assert!(stepped > 60_000, "{stepped}");
    assert!(done > 200 && lost > 10, "{done} acts, {lost} robots lost");
}

#[test]
fn every_outcome_is_within_the_bounds_of_its_columns() {
    let mut compared = 0;
    for (seed, scenario) in scenarios(150) {
        let runs = Runs(Arc::clone(&scenario));
        let columns = runs.columns();
        let values = runs.run_block(seed, 5..8, BlockOptions::ALONE);
        assert_eq!(columns.len(), values.len());
        for (column, values) in columns.iter().zip(&values) {
            assert_eq!(values.len(), 3);
            for (value, run) in values.iter().zip(5..) {
                if State::new(&scenario, seed, run).is_err() {
                    assert!(value.is_nan());
                    continue;
                }
                let is_within = column.bounds.min.is_none_or(|min| *value >= min)
                    && column.bounds.max.is_none_or(|max| *value <= max);
                assert!(is_within, "{seed}: {value} {column:?}");
                let is_kind = match column.kind {
                    ColumnKind::Whole => value.fract() == 0.0,
                    ColumnKind::Flag => [0.0, 1.0].contains(value),
                    ColumnKind::Real => true,
                };
                assert!(is_kind, "{seed}: {value} {column:?}");
                compared += 1;
            }
        }
    }
    assert!(compared > 2500, "{compared}");
}
