//! Finds, their times, and the end of a run.

use crate::common::{go, id, scenario, start, step_with};
use base::engine::{BlockOptions, Runner};
use sim::judge::Outcome;
use sim::runner::Runs;
use sim::simulation::Simulation;

/// A robot that drives along a line of items, with a sensor range of one metre.
pub(super) fn line(time_limit_s: f64, items: &str, sensor: &str) -> String {
    format!(
        "[clock]\nstep_s = 0.1\ntime_limit_s = {time_limit_s}\n[world]\nsize_m = [50, 10]\n{items}\n\
         [robots.rover]\ncount = 1\nradius_m = 0.5\nprice = 3\n\
         start = {{ kind = \"fixed\", at_m = [[1, 5]], heading_deg = [0] }}\n\
         drive = {{ max_speed_m_s = 1, max_turn_rate_deg_s = 90 }}\n\
         brain = {{ behaviours = [{{ kind = \"cruise\" }}] }}\n\
         [robots.rover.sensors.eye]\nkind = \"items\"\nrange_m = 1.05\n{sensor}\n"
    )
}

pub(super) fn mines(places: &str, count: u32) -> String {
    format!("[items.mine]\ncount = {count}\nplacement = {{ kind = \"fixed\", at_m = {places} }}\n")
}

fn finish(text: &str) -> (Outcome, Simulation) {
    let mut simulation = start(text);
    (simulation.finish(), simulation)
}

#[test]
fn a_run_is_complete_at_the_step_that_reports_the_last_item() {
    // In range when the robot is at 2.95 m and 4.95 m: after steps 20 and 40.
    let items = mines("[[4, 5], [6, 5]]", 2);
    for (sensor, last) in [
        ("", 40),
        ("latency_s = 0.5", 45),
        ("rate_hz = 1", 40),
        ("rate_hz = 0.8", 50),
        ("rate_hz = 0.8\nlatency_s = 0.25", 53),
    ] {
        let (outcome, simulation) = finish(&line(60.0, &items, sensor));
        assert_eq!(simulation.state().tick(), last + 1, "{sensor}");
        assert_eq!(outcome.time_s, last as f64 / 10.0, "{sensor}");
        assert_eq!(
            (outcome.found.as_slice(), outcome.missed.as_slice()),
            (&[2][..], &[0][..])
        );
        assert!(!outcome.has_failed);
    }
}

#[test]
fn with_a_slow_brain_an_item_is_found_at_the_brains_next_step() {
    let text = line(60.0, &mines("[[4, 5]]", 1), "");
    let slow = text.replace("brain = { ", "brain = { rate_hz = 0.4, ");
    // Detected after step 20, but the brain steps at 0, 25, 50.
    assert_eq!(finish(&slow).0.time_s, 2.5);
    assert_eq!(finish(&text).0.time_s, 2.0);
}

#[test]
fn each_item_records_the_time_of_its_find() {
    let (_, simulation) = finish(&line(60.0, &mines("[[4, 5], [1, 5], [6, 5]]", 3), ""));
    let items = simulation.state().each_item(simulation.scenario());
    let found: Vec<Option<f64>> = items.map(|item| item.found_s).collect();
    assert_eq!(found, [Some(2.0), Some(0.0), Some(4.0)]);
}

#[test]
fn clutter_is_reported_and_does_not_complete_a_run() {
    let items = "[items.scrap]\ncount = 2\ntarget = false\n\
                 placement = { kind = \"fixed\", at_m = [[4, 5], [6, 5]] }\n"
        .to_owned()
        + &mines("[[5, 5], [9, 9]]", 2);
    let (outcome, simulation) = finish(&line(8.0, &items, ""));
    // Kinds are in alphabetical order: mine, scrap.
    assert_eq!((outcome.found, outcome.missed), (vec![1, 2], vec![1, 0]));
    assert!(outcome.has_failed && outcome.time_s == 8.0);
    assert_eq!(simulation.state().tick(), 80);
    let runs = Runs(scenario(&line(8.0, &items, "")));
    let names: Vec<_> = runs
        .columns()
        .into_iter()
        .map(|column| column.name)
        .collect();
    let values: Vec<f64> = runs
        .run_block(1, 0..1, BlockOptions::ALONE)
        .into_iter()
        .map(|column| column[0])
        .collect();
    let value = |name: &str| values[names.iter().position(|other| other == name).unwrap()];
    assert_eq!(
        [value("found"), value("missed"), value("failed")],
        [1.0, 1.0, 1.0]
    );
    assert_eq!(
        [
            value("found_scrap"),
            value("missed_scrap"),
            value("found_mine")
        ],
        [2.0, 0.0, 1.0]
    );
    assert_eq!(
        [value("robots"), value("price"), value("time_s")],
        [1.0, 3.0, 8.0]
    );
}

#[test]
fn a_run_without_targets_lasts_until_the_time_limit_and_does_not_fail() {
    let (outcome, simulation) = finish(&line(3.0, "", ""));
    assert_eq!(simulation.state().tick(), 30);
    assert_eq!((outcome.has_failed, outcome.time_s), (false, 3.0));
    assert!((outcome.distance_m - 3.0).abs() < 1e-9);
}

#[test]
fn the_last_step_of_a_run_begins_before_the_time_limit() {
    for (time_limit_s, steps) in [
        (0.0, 0),
        (0.05, 1),
        (0.1, 1),
        (0.11, 2),
        (2.0, 20),
        (2.03, 21),
    ] {
        // In range at step 20, which only the last time limit reaches.
        let (outcome, simulation) = finish(&line(time_limit_s, &mines("[[4, 5]]", 1), ""));
        assert_eq!(simulation.state().tick(), steps, "{time_limit_s}");
        let is_found = time_limit_s > 2.0;
        assert_eq!(outcome.has_failed, !is_found, "{time_limit_s}");
        assert_eq!(
            outcome.time_s,
            if is_found { 2.0 } else { time_limit_s },
            "{time_limit_s}"
        );
        assert!(outcome.time_s <= time_limit_s);
    }
}

#[test]
fn a_run_without_robots_fails_at_once() {
    let text =
        line(60.0, &mines("[[4, 5]]", 1), "").replace("count = 1\nradius", "count = 0\nradius");
    let (outcome, simulation) = finish(&text);
    assert_eq!(simulation.state().tick(), 0);
    assert!(outcome.has_failed && outcome.time_s == 60.0);
    assert_eq!(outcome.missed, [1]);
}

#[test]
fn steps_after_the_end_do_not_change_finds() {
    let mut simulation = start(&line(60.0, &mines("[[4, 5]]", 1), ""));
    let outcome = simulation.finish();
    (0..50).for_each(|_| step_with(&mut simulation, [(id(0, 0), go(1.0, 0.0))]));
    assert_eq!(simulation.outcome().time_s, outcome.time_s);
    assert!(simulation.outcome().distance_m > outcome.distance_m);
}

#[test]
fn a_run_without_room_is_quarantined() {
    // Eight robots of a metre hardly fit into 4.1 m, so that few runs can place all of them.
    let text = "[clock]\ntime_limit_s = 1\n[world]\nsize_m = [4.1, 4.1]\n[robots.rover]\ncount = 10\n\
                radius_m = 0.5\ndrive = { max_speed_m_s = 0, max_turn_rate_deg_s = 0 }\n";
    let runs = Runs(scenario(text));
    let columns = runs.run_block(1, 0..200, BlockOptions::ALONE);
    let is_out = |run: usize| columns[0][run].is_nan();
    let out = (0..200).filter(|run| is_out(*run)).count();
    assert!(out > 0 && out < 200, "{out}");
    for run in 0..200 {
        assert!(
            columns
                .iter()
                .all(|column| column[run].is_nan() == is_out(run))
        );
        assert_eq!(
            Simulation::new(scenario(text), 1, run as u64).is_err(),
            is_out(run)
        );
    }
}
