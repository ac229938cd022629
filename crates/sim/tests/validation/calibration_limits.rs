//! Where beliefs are not calibrated: more runs than the check has, of more detectors.

use crate::calibration::{Changes, TEXT, UNCERTAIN, believed, camera, radio, rows_of};
use crate::rows::assert_published;
use crate::setup::list;
use base::document::Value;

const AERIAL: &str = include_str!("../../../../docs/validation/aerial-camera.toml");

const RUNS: u64 = 300;

/// A detector, with a scenario and its changed values.
struct Setup {
    name: String,
    text: &'static str,
    changes: Changes,
}

impl Setup {
    fn new(name: &str, text: &'static str, changes: Changes) -> Self {
        Self {
            name: name.to_owned(),
            text,
            changes,
        }
    }
}

fn setups() -> Vec<Setup> {
    let cameras = camera().map(|(name, changes)| Setup::new(name, TEXT, changes));
    let size = list([20.0, 20.0].map(Value::Float));
    let others = [
        ("blind", UNCERTAIN, without_confusion()),
        ("confused", UNCERTAIN, without_blind_share()),
        ("blind and confused", UNCERTAIN, vec![]),
        ("aerial", AERIAL, vec![]),
        ("dense aerial", AERIAL, vec![("world.size_m", size)]),
    ];
    let others = others.map(|(name, text, changes)| Setup::new(name, text, changes));
    cameras.into_iter().chain(others).collect()
}

fn without_blind_share() -> Changes {
    let share = "robots.rover.sensors.camera.blind_share.mine";
    vec![(share, Value::Float(0.0))]
}

fn without_confusion() -> Changes {
    let shares = [
        ("robots.rover.sensors.camera.confusion.clutter.clutter", 1.0),
        ("robots.rover.sensors.camera.confusion.clutter.mine", 0.0),
        ("robots.rover.sensors.camera.confusion.mine.clutter", 0.0),
        ("robots.rover.sensors.camera.confusion.mine.mine", 1.0),
    ];
    shares
        .map(|(path, share)| (path, Value::Float(share)))
        .to_vec()
}

#[test]
#[ignore = "takes minutes: make validation"]
fn the_share_of_true_beliefs_in_more_runs() {
    let mut all = Vec::new();
    for setup in setups() {
        for (way, range_m) in [("alone", 0.0), ("with radio", 100.0)] {
            let mut changes = setup.changes.clone();
            changes.push(radio(range_m));
            let runs = believed(setup.text, &changes, RUNS);
            all.extend(rows_of(&format!("{} {way}", setup.name), &runs));
        }
    }
    assert_published("calibration-limits.csv", &all);
}
