//! Warnings about lanes that are never declared clear, and about sensors and tools that may not reach.

use super::warnings;
use crate::derived::derived;
use crate::scenario::ScenarioSpec;
use base::document::{Document, Value};

/// The bundled scenario with changes of its text.
fn document(changes: &[(&str, &str)]) -> Document {
    let mut text = include_str!("../../../../scenarios/mines.toml").to_owned();
    for (this, that) in changes {
        assert!(text.contains(this), "{this}");
        text = text.replace(this, that);
    }
    Document::parse("t.toml", &text).unwrap()
}

/// Its warnings about declarations and ranges.
fn found(changes: &[(&str, &str)]) -> Vec<String> {
    let found = warnings(&document(changes), &[Vec::new()]);
    let found = found.iter().map(ToString::to_string);
    let is_meant = |text: &String| text.contains("declared clear") || text.contains("range_m");
    found.filter(is_meant).collect()
}

fn floor(changes: &[(&str, &str)]) -> String {
    let checked = ScenarioSpec::read(&document(changes)).unwrap();
    let derived = derived(&checked);
    let mut floors = derived.into_iter();
    let found = floors.find(|(path, _)| path == "controllers.station.clearance");
    found.unwrap().1
}

const WORLD: &str = "size_m = [216, 28]";
const NO_OAV: (&str, &str) = ("[robots.oav]\ncount = 2", "[robots.oav]\ncount = 0");

/// Four walls around 25 m x 20 m, an eighth of the lane.
const PEN: &str = "size_m = [216, 28]\nobstacles = [{ rectangle = { at_m = [60, 14], size_m = [0.2, 21] } },
    { rectangle = { at_m = [85, 14], size_m = [0.2, 21] } }, { rectangle = { at_m = [72.5, 3.5], size_m = [25.2, 0.2] } },
    { rectangle = { at_m = [72.5, 24.5], size_m = [25.2, 0.2] } }]";

#[test]
fn a_lane_of_which_no_robot_sees_a_part_is_never_declared_clear() {
    assert_eq!(found(&[]), [""; 0]);
    // Only air vehicles see the pen: 1 - exp(-8 (0.125 x 0.06 + 0.875 x 0.06 x 0.05)).
    let text = floor(&[(WORLD, PEN)]);
    assert!(
        text.contains("8 expected mines; the risk never falls below 7.8%"),
        "{text}"
    );
    let pen = [(WORLD, PEN), NO_OAV];
    let text = floor(&pen);
    // 1 - exp(-8 (0.125 + 0.875 x 0.05)).
    assert!(
        text.contains(
            "12.5% of the lane is out of reach of every robot; the risk never falls below 74.1%"
        ),
        "{text}"
    );
    let reported = found(&pen).concat();
    assert!(
        reported.contains(
            "controllers.station.clearance.declare_below = 0.05: 12.5% of the lane is out of reach of every robot: the risk \
             never falls below 74.1%, above 0.05: this lane is never declared clear"
        ),
        "{reported}"
    );
}

#[test]
fn a_lane_of_which_sensors_miss_too_many_mines_is_never_declared_clear() {
    let reported = found(&[NO_OAV]).concat();
    assert!(
        reported.contains("are blind to some mines: the risk never falls below 33.0%, above 0.05"),
        "{reported}"
    );
    // A study that varies their number finds that out.
    let teams = (0..=2).map(|count| vec![("robots.oav.count".to_owned(), Value::Integer(count))]);
    let teams: Vec<_> = teams.collect();
    let found = warnings(&document(&[]), &teams);
    assert!(!found.iter().any(|one| one.to_string().contains("blind")));
}

#[test]
fn the_inside_of_an_obstacle_is_no_part_of_a_lane() {
    let house =
        "size_m = [216, 28]\nobstacles = [{ rectangle = { at_m = [60, 14], size_m = [25, 20] } }]";
    let text = floor(&[(WORLD, house)]);
    assert!(
        text.starts_with("8 expected mines; the risk never falls below 2.4%"),
        "{text}"
    );
    let read = ScenarioSpec::read(&document(&[(WORLD, house)])).unwrap();
    let clearance = read.scenario.clearance().unwrap();
    assert!((clearance.free_area_m2() - 3500.0).abs() < 1e-6);
}

#[test]
fn ranges_that_hardly_reach_a_mine_have_a_warning_with_both_numbers() {
    let tool = ("neutralise = { range_m = 3", "neutralise = { range_m = 1.2");
    let reported = found(&[tool]).concat();
    assert!(
        reported.contains(
            "robots.ugv.tools.neutralise.range_m = 1.2: it may not reach mine from where that cannot destroy the robot: 1 m \
             with exact positions, 1.30 m with their errors"
        ),
        "{reported}"
    );
    let sensor = ("range_m = 4\nfov_deg", "range_m = 1.6\nfov_deg");
    let reported = found(&[sensor]).concat();
    assert!(
        reported.contains("robots.ugv.sensors.detector.range_m = 1.6: it may not reach mine")
            && reported.contains("1.67 m with their errors"),
        "{reported}"
    );
}
