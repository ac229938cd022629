//! The condition with which a run is complete.

use super::determinism::crowd;
use super::judge::{line, mines};
use crate::common::{scenario, start, with};
use base::engine::{BlockOptions, Runner};
use rayon::ThreadPoolBuilder;
use sim::judge::Outcome;
use sim::runner::Runs;
use sim::simulation::Simulation;
use std::sync::Arc;

/// In range of the rover at 0, 2 and 4 seconds, and never.
const PLACES: &str = "[[1, 5], [4, 5], [6, 5], [9, 9]]";

/// A rover that drives along mines and clutter, until it reaches the wall.
fn field(when: &str) -> String {
    let items = mines(PLACES, 4)
        + "[items.scrap]\ncount = 1\ntarget = false\n\
           placement = { kind = \"fixed\", at_m = [[5, 5]] }\n";
    line(60.0, &items, "") + &end(when)
}

const BREAKS: &str = "robots.rover.collision.max_collisions = 1";

fn end(when: &str) -> String {
    format!("[end]\nwhen = \"{when}\"\n")
}

fn finish(text: &str) -> (Outcome, Simulation) {
    let mut simulation = start(text);
    (simulation.finish(), simulation)
}

#[test]
fn a_run_ends_when_its_condition_holds() {
    for (when, time_s) in [
        ("found >= 2", 2.0),
        ("found > 2", 4.0),
        ("missed <= 1", 4.0),
        ("found_mine >= 1", 0.0),
        ("found_mine == 3", 4.0),
        ("missed_mine < 3", 2.0),
        ("found_scrap >= 1", 3.0),
        ("missed_scrap != 1", 3.0),
    ] {
        let (outcome, simulation) = finish(&field(when));
        assert_eq!(outcome.time_s, time_s, "{when}");
        assert!(!outcome.has_failed, "{when}");
        let tick = (10.0 * time_s).round() as u64 + 1;
        assert_eq!(simulation.state().tick(), tick, "{when}");
    }
}

#[test]
fn a_run_can_end_with_any_event_that_the_judge_counts() {
    let (collided, simulation) = finish(&field("collisions >= 1"));
    // The wall is 48.5 m ahead.
    assert!((collided.time_s - 48.5).abs() < 0.11, "{}", collided.time_s);
    assert_eq!(simulation.outcome().collisions, 1);
    assert!(!collided.has_failed);

    let (broken, _) = finish(&with(&field("robots_stopped >= 1"), BREAKS));
    assert_eq!((broken.time_s, broken.robots_stopped), (collided.time_s, 1));
    assert!(!broken.has_failed);

    let noisy = "robots.rover.sensors.eye.false_alarm_rate_per_m2_s.mine = 0.1";
    let (alarmed, simulation) = finish(&with(&field("false_alarms >= 3"), noisy));
    assert!(!alarmed.has_failed && alarmed.false_alarms >= 3);
    assert!(alarmed.time_s < 60.0 && simulation.state().tick() < 600);
}

#[test]
fn a_run_that_never_meets_its_end_has_failed() {
    let (outcome, simulation) = finish(&field("found_mine >= 4"));
    assert_eq!((outcome.has_failed, outcome.time_s), (true, 60.0));
    assert_eq!(simulation.state().tick(), 600);
    assert_eq!(outcome.found, [3, 1]);
    // Nor does a run without targets succeed.
    let none = line(3.0, "", "") + &end("collisions >= 1");
    let (outcome, _) = finish(&none);
    assert_eq!((outcome.has_failed, outcome.time_s), (true, 3.0));
    // A team that cannot move any more cannot meet it either.
    let (outcome, simulation) = finish(&with(&field("found_mine >= 4"), BREAKS));
    assert_eq!((outcome.has_failed, outcome.time_s), (true, 60.0));
    assert!(simulation.state().tick() < 500);
}

#[test]
fn a_run_that_has_found_all_targets_goes_on_until_its_end() {
    let items = mines("[[4, 5]]", 1);
    let without = finish(&line(60.0, &items, "")).0;
    let with = finish(&(line(60.0, &items, "") + &end("collisions >= 1"))).0;
    assert_eq!((without.time_s, without.has_failed), (2.0, false));
    assert!(with.time_s > 48.0 && !with.has_failed);
    assert_eq!(with.found_s, [[2.0]]);
}

#[test]
fn finding_all_targets_is_the_end_without_a_condition() {
    let items = mines("[[4, 5], [6, 5]]", 2);
    let without = line(60.0, &items, "");
    let (outcome, simulation) = finish(&without);
    for when in ["missed == 0", "found >= 2", "missed < 0.5"] {
        let (same, other) = finish(&(without.clone() + &end(when)));
        assert_eq!(same, outcome, "{when}");
        assert_eq!(other.state().hash(), simulation.state().hash(), "{when}");
    }
}

#[test]
fn an_end_that_is_not_reached_changes_no_byte() {
    let text = crowd(60, 20.0);
    let with = format!("{text}{}", end("found_mine >= 60"));
    let (mut one, mut other) = (start(&text), start(&with));
    for _ in 0..200 {
        one.step();
        other.step();
        assert_eq!(one.state().hash(), other.state().hash());
    }
}

#[test]
fn the_end_of_a_run_is_the_same_on_any_number_of_threads() {
    let text = crowd(5000, 160.0) + &end("found_mine >= 400");
    let scenario = scenario(&text);
    let on = |threads| {
        let pool = ThreadPoolBuilder::new().num_threads(threads);
        let mut simulation = Simulation::new(Arc::clone(&scenario), 3, 1).unwrap();
        let outcome = pool.build().unwrap().install(|| simulation.finish());
        (outcome, simulation.state().hash())
    };
    let alone = on(1);
    assert!(!alone.0.has_failed && alone.0.found[0] < 5000);
    for threads in [2, 8] {
        assert_eq!(on(threads), alone, "{threads} threads");
    }
    let values = Runs(scenario).run_block(3, 1..2, BlockOptions::ALONE);
    assert_eq!(values[0], [alone.0.time_s]);
}

#[test]
fn steps_after_the_end_do_not_change_its_time() {
    let (outcome, mut simulation) = finish(&field("found_mine == 2"));
    (0..30).for_each(|_| simulation.step());
    let later = simulation.outcome();
    assert_eq!(later.found[0], 3);
    assert_eq!((later.time_s, later.has_failed), (outcome.time_s, false));
}

#[test]
fn a_condition_that_changes_during_a_run_applies_from_then_on() {
    let mut simulation = start(&field("found_mine >= 4"));
    (0..30).for_each(|_| simulation.step());
    let is_over = |simulation: &Simulation| simulation.state().is_over(simulation.scenario());
    let mut change = |when: &str| {
        simulation.change(scenario(&field(when))).unwrap();
        let outcome = simulation.outcome();
        (is_over(&simulation), outcome.has_failed, outcome.time_s)
    };
    // Two mines are found by now.
    assert_eq!(change("found_mine >= 3"), (false, true, 60.0));
    assert_eq!(change("found_mine >= 2"), (true, false, 3.0));
    // It was complete before, and still is.
    assert_eq!(change("found_mine >= 1"), (true, false, 3.0));
    assert_eq!(change("found_mine >= 3"), (false, true, 60.0));
    let outcome = simulation.finish();
    assert_eq!((outcome.time_s, outcome.has_failed), (4.0, false));
}

#[test]
fn a_condition_can_be_removed_during_a_run() {
    let items = mines("[[4, 5], [6, 5]]", 2);
    let mut simulation = start(&(line(60.0, &items, "") + &end("collisions >= 1")));
    (0..100).for_each(|_| simulation.step());
    assert!(simulation.outcome().has_failed);
    simulation
        .change(scenario(&line(60.0, &items, "")))
        .unwrap();
    let outcome = simulation.outcome();
    assert_eq!((outcome.time_s, outcome.has_failed), (4.0, false));
}
