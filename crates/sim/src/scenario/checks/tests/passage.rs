//! Vehicles that are to pass a lane.

use super::clearance::LANE;
use super::errors_in;

const PASSAGE: &str = "\n[passage]\nwidth_m = 3\nspeed_m_s = 2\n";

/// The lane with a passage, and changes of both.
fn errors(changes: &[(&str, &str)]) -> Vec<String> {
    let text = format!("{LANE}{PASSAGE}");
    let text = changes.iter().fold(text, |text, (this, that)| {
        assert!(text.contains(this), "{this}");
        text.replacen(this, that, 1)
    });
    errors_in(&text)
}

const CERTAIN: (&str, &str) = ("speed_m_s = 2", "speed_m_s = 2\ndestroy_probability = 1");

#[test]
fn a_passage_takes_the_probability_of_hazards_or_its_own() {
    assert_eq!(errors(&[CERTAIN]), [""; 0]);
    let hazard = ("completed_by", "hazard = { radius_m = 0.3 }\ncompleted_by");
    assert_eq!(errors(&[hazard]), [""; 0]);
    let without = errors(&[]);
    assert_eq!(without.len(), 1, "{without:#?}");
    assert!(
        without[0].contains("passage.destroy_probability"),
        "{without:#?}"
    );
    assert!(
        without[0].contains("items.mine has no hazard"),
        "{without:#?}"
    );
}

#[test]
fn all_errors_of_a_passage_are_reported_at_once() {
    let reported = errors(&[
        ("width_m = 3", "width_m = 13"),
        ("declare_below = 0.1", "declare_below = 0.1\ncell_m = 700"),
        (
            "target = false",
            "target = false\nhazard = { radius_m = 1 }",
        ),
    ]);
    for (path, part) in [
        ("passage.width_m = 13", "at most 12: the lane is not wider"),
        (
            "controllers.station.clearance.cell_m = 700",
            "at most 650: 50 times",
        ),
        (
            "controllers.station.clearance.cell_m = 700",
            "at most 2: robots.ugv.sensors.detector sees no farther",
        ),
        ("items.clutter.target = false", "true: "),
        ("passage.destroy_probability", "items.mine has no hazard"),
    ] {
        let mut reported = reported.iter();
        let found = reported.any(|error| error.contains(path) && error.contains(part));
        assert!(found, "{path}: {reported:#?}");
    }
    assert_eq!(reported.len(), 5, "{reported:#?}");
}

#[test]
fn without_a_lane_there_is_no_passage() {
    let lane = LANE.find("[controllers.station.clearance]").unwrap();
    let reported = errors_in(&format!("{}{PASSAGE}", &LANE[..lane]));
    let mut of_passage = reported.iter().filter(|error| error.contains("passage"));
    assert!(
        of_passage
            .next()
            .unwrap()
            .contains("controllers.NAME.clearance")
    );
    assert_eq!(of_passage.next(), None);
}

#[test]
fn obstacles_leave_room_for_the_path() {
    let wall = |to_m: f64| {
        let obstacle = format!(
            "size_m = [30, 20]\nobstacles = [{{ polygon_m = [[12, 2], [14, 2], [14, {to_m}], [12, {to_m}]] }}]"
        );
        errors(&[CERTAIN, ("size_m = [30, 20]", &obstacle)])
    };
    assert_eq!(wall(12.0), [""; 0]);
    let reported = wall(13.5);
    assert!(
        reported.concat().contains("passage.width_m = 3"),
        "{reported:#?}"
    );
    assert!(
        reported.concat().contains("leave no path of this width"),
        "{reported:#?}"
    );
}
