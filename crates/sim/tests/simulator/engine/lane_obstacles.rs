//! Lanes with obstacles in them.

use super::clearance::{LANE, begin, finish, lane};
use crate::common::with;
use sim::judge::LaneEnd;

/// The lane with obstacles, which ground vehicles see.
fn among(obstacles: &str) -> String {
    let text = with(
        LANE,
        &format!(
            "clock.time_limit_s = 900\nworld.obstacles = [{obstacles}]\n\
             robots.ugv.sensors.lidar = {{ kind = \"range\", rays = 90, fov_deg = 360, range_m = 8 }}"
        ),
    );
    text.replace("declare_below = 0.1", "declare_below = 0.05")
}

const HOUSE: &str = "{ rectangle = { at_m = [24, 10], size_m = [8, 6] } }";

/// Four walls, as large as the house.
const PEN: &str = "{ rectangle = { at_m = [24, 7.1], size_m = [8, 0.2] } }, \
                   { rectangle = { at_m = [24, 12.9], size_m = [8, 0.2] } }, \
                   { rectangle = { at_m = [20.1, 10], size_m = [0.2, 6] } }, \
                   { rectangle = { at_m = [27.9, 10], size_m = [0.2, 6] } }";

#[test]
fn a_lane_around_a_house_is_declared_clear() {
    let mut declared = 0;
    for run in 0..10 {
        let (outcome, simulation) = finish(&among(HOUSE), run);
        let believed = simulation.state().each_lane().next().unwrap();
        let inside = believed.lane.nearest_cell([24.5, 10.5].into());
        assert_eq!(believed.unmarked[inside], 0.0);
        declared += u32::from(lane(&outcome).is_declared);
    }
    assert!(declared >= 9, "{declared}");
}

#[test]
fn the_expected_mines_are_on_free_ground() {
    let with_house = begin(&among(HOUSE), 0);
    let without = begin(LANE, 0);
    let [with_house, without] =
        [with_house, without].map(|one| one.state().each_lane().next().unwrap());
    let total = |unmarked: &[f64]| unmarked.iter().sum::<f64>();
    assert!((total(&with_house.unmarked) - 2.0).abs() < 1e-9);
    assert!((total(&without.unmarked) - 2.0).abs() < 1e-9);
    // 432 of 480 square metres are free.
    let denser = with_house.unmarked[0] / without.unmarked[0];
    assert!((denser - 480.0 / 432.0).abs() < 1e-9, "{denser}");
}

#[test]
fn a_lane_with_a_closed_pen_is_given_up_before_the_time_limit() {
    // Air vehicles would look into it.
    let pen = with(&among(PEN), "robots = { oav.count = 0, ugv.count = 3 }");
    for run in 0..5 {
        let (outcome, _) = finish(&pen, run);
        let lane = lane(&outcome);
        assert_eq!(lane.end, Some(LaneEnd::Hopeless), "{run}");
        assert!(lane.given_up_s < 900.0, "{}", lane.given_up_s);
    }
}
