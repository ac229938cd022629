//! Sensors and tools that reach mines only from nearby, and fences around mines that robots cannot neutralise.

use super::clearance::{begin, finish, is_over, lane, with_mines};
use crate::common::with;
use brain::MarkVerdict;

/// The lane with mines that destroy vehicles.
fn dangerous(changes: &str) -> String {
    with(
        &with_mines("[[12, 8], [20, 10], [30, 12], [40, 6]]", 4),
        &format!(
            "clock.time_limit_s = 1500\nitems.mine.hazard = {{ radius_m = 0.3, destroy_probability = 0.8 }}\n{changes}"
        ),
    )
}

/// The number of runs of 20 that end by a statement, and of robots that are lost in all.
fn ended_and_lost(text: &str) -> (u32, u32) {
    let (mut ended, mut lost) = (0, 0);
    for run in 0..20 {
        let (outcome, _) = finish(text, run);
        let lane = lane(&outcome);
        ended += u32::from(lane.is_declared || lane.is_given_up);
        lost += outcome.acts.as_ref().unwrap().robots_lost;
    }
    (ended, lost)
}

#[test]
fn missions_with_short_tools_and_sensors_end_without_more_losses() {
    let (ended, lost) = ended_and_lost(&dangerous(""));
    assert_eq!(ended, 20);
    for short in [
        "robots.ugv.tools.neutralise.range_m = 2",
        "robots.ugv.tools.neutralise.range_m = 1.3",
        "robots.ugv.sensors.detector.range_m = 2",
    ] {
        let (ended, of_short) = ended_and_lost(&dangerous(short));
        assert_eq!(ended, 20, "{short}");
        // With the same rate of losses, at most 5 more in 80 vehicles and mines in 99% of the cases.
        assert!(of_short <= lost + 5, "{short}: {of_short}, {lost}");
    }
}

/// The lane with a vehicle that has the tools of `tools` besides its own.
fn with_fence(tools: &str) -> String {
    with(
        &with_mines("[[14, 8], [30, 12]]", 2),
        &format!("robots.ugv = {{ count = 1, tools = {{ {tools} }} }}"),
    )
}

/// Numbers of marks with a mine that are isolated, and of mines that are neutralised, at the end of a run.
fn isolated(text: &str, run: u64) -> (usize, u32) {
    let mut simulation = begin(text, run);
    while !is_over(&simulation) {
        simulation.step();
    }
    let believed = simulation.state().each_lane().next().unwrap();
    let marks = believed.marks.iter();
    let isolated = marks.filter(|mark| mark.verdict == Some(MarkVerdict::Isolated));
    let acts = simulation.outcome().acts.unwrap();
    (isolated.count(), acts.neutralised)
}

#[test]
fn a_robot_without_charges_fences_off_the_mines_that_it_confirms() {
    let fence = "isolate = { range_m = 2.5, reach_m = 1, duration_s = 4 }";
    let one_charge = with_fence(&format!("{fence}, neutralise.charges = 1"));
    let none = with_fence("neutralise.charges = 1");
    let enough = with_fence(fence);
    let (mut fenced, mut of_those_with_charges) = (0, 0);
    for run in 0..5 {
        let (isolated_marks, neutralised) = isolated(&one_charge, run);
        assert!(neutralised <= 1);
        fenced += isolated_marks;
        assert_eq!(isolated(&none, run).0, 0);
        of_those_with_charges += isolated(&enough, run).0;
    }
    assert!(fenced >= 4, "{fenced}");
    assert_eq!(of_those_with_charges, 0);
}
