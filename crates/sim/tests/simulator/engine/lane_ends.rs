//! Why a run in which controllers were to clear a lane is over.

use super::clearance::{LANE, begin, finish, is_over, lane, with_mines};
use crate::common::{scenario, with};
use base::engine::{BlockOptions, Runner};
use sim::judge::LaneEnd;
use sim::runner::Runs;

/// Four mines and two vehicles with one charge each.
fn hopeless(controllers: u32) -> String {
    with(
        &with_mines("[[12, 8], [20, 10], [30, 12], [40, 6]]", 4),
        &format!(
            "clock.time_limit_s = 900\nrobots.ugv.tools.neutralise.charges = 1\n\
             controllers.station.count = {controllers}"
        ),
    )
}

#[test]
fn a_hopeless_lane_is_given_up_by_any_number_of_controllers() {
    for controllers in 1..=3 {
        for run in 0..4 {
            let (outcome, simulation) = finish(&hopeless(controllers), run);
            let lane = lane(&outcome);
            assert_eq!(lane.end, Some(LaneEnd::Hopeless), "{controllers}, {run}");
            assert!(
                lane.is_given_up && lane.given_up_s < 600.0,
                "{}",
                lane.given_up_s
            );
            // It is stated within the last step.
            assert!((simulation.time_s() - lane.given_up_s - 0.2).abs() < 1e-9);
            assert_eq!((lane.declared_s, lane.used[1].charges), (900.0, 2));
        }
    }
}

#[test]
fn every_end_has_one_reason_and_its_column() {
    let names = [
        "declared",
        "ended_hopeless",
        "ended_called_off",
        "ended_controllers_lost",
        "ended_robots_lost",
        "ended_time_limit",
    ];
    let cases = [
        LANE.to_owned(),
        hopeless(2),
        with(LANE, "controllers.station.clearance.called_off = true"),
        with(LANE, "controllers.station.failed = [0]"),
        with(
            LANE,
            "robots = { ugv.count = 0, oav.battery = { capacity_j = 1, idle_w = 1 } }",
        ),
        with(LANE, "clock.time_limit_s = 20"),
    ];
    for (reason, text) in cases.iter().enumerate() {
        let runs = Runs(scenario(text));
        let columns = runs.columns();
        let place = |name: &str| {
            columns
                .iter()
                .position(|column| column.name == name)
                .unwrap()
        };
        let rows = runs.run_block(1, 0..3, BlockOptions::ALONE);
        for run in [0, 1, 2] {
            let flags = names.map(|name| rows[place(name)][run]);
            let expected = std::array::from_fn(|flag| f64::from(u8::from(flag == reason)));
            assert_eq!(flags, expected, "{}", names[reason]);
            let is_given_up = (1..=2).contains(&reason);
            assert_eq!(rows[place("given_up")][run] == 1.0, is_given_up);
            let limit_s = runs.0.time_limit_s();
            assert_eq!(rows[place("given_up_s")][run] < limit_s, is_given_up);
        }
    }
}

#[test]
fn a_run_has_no_reason_of_its_end_before_it_is_over() {
    let mut simulation = begin(LANE, 0);
    while !is_over(&simulation) {
        assert_eq!(lane(&simulation.outcome()).end, None);
        simulation.step();
    }
    assert_eq!(lane(&simulation.outcome()).end, Some(LaneEnd::Declared));
}

#[test]
fn a_run_that_has_lost_its_controllers_ends_unless_it_is_complete_without_them() {
    let lost = with(LANE, "controllers.station.failed = [0]");
    let mut simulation = begin(LANE, 0);
    (0..100).for_each(|_| simulation.step());
    simulation.change(scenario(&lost)).unwrap();
    simulation.step();
    assert!(is_over(&simulation));
    // With others, it continues.
    let more = with(&lost, "controllers.station.count = 2");
    simulation.change(scenario(&more)).unwrap();
    (0..10).for_each(|_| simulation.step());
    assert!(!is_over(&simulation));
    let other_end = with(&lost, "end.when = \"neutralised >= 1\"");
    let (outcome, _) = finish(&other_end, 0);
    assert_eq!(lane(&outcome).end, Some(LaneEnd::TimeLimit));
}

#[test]
fn what_the_kinds_of_robots_have_used_sums_to_what_all_have_used() {
    let text = with(
        LANE,
        "robots.oav.battery = { capacity_j = 60000, idle_w = 50 }\n\
         robots.ugv.battery = { capacity_j = 600000, idle_w = 60, move_j_per_m = 400 }",
    );
    let fewer = with(&text, "robots.ugv.count = 1");
    for run in 0..3 {
        let mut simulation = begin(&text, run);
        (0..200).for_each(|_| simulation.step());
        simulation.change(scenario(&fewer)).unwrap();
        let outcome = simulation.finish();
        let lane = lane(&outcome);
        let energy_j: f64 = lane.used.iter().map(|used| used.energy_j).sum();
        let distance_m: f64 = lane.used.iter().map(|used| used.distance_m).sum();
        assert!((energy_j - outcome.energy_j).abs() < 1e-6 * energy_j);
        assert!((distance_m - outcome.distance_m).abs() < 1e-6 * distance_m);
        assert!(lane.used.iter().all(|used| used.distance_m > 10.0));
        let neutralised = outcome.acts.unwrap().neutralised;
        assert_eq!(lane.used[0].charges, 0);
        assert!(lane.used[1].charges >= u64::from(neutralised));
    }
}
