//! What is believed of a sensor.

use super::*;
use crate::scenario::ScenarioSpec;
use crate::sensors::sensor_kind::AmongKinds;
use base::document::Document;
use std::borrow::Cow;

fn kinds() -> Vec<String> {
    ["clutter", "mine", "rock"].map(str::to_owned).to_vec()
}

/// A sensor with these lines and these of `believed`.
fn sensor(lines: &str, believed: &str) -> ItemsSpec {
    let text = format!(
        "clock = {{ step_s = 0.1, time_limit_s = 9 }}\nworld.size_m = [40, 40]\n\
         items = {{ clutter.count = 1, mine.count = 1, rock = {{ count = 1, target = false }} }}\n\
         [robots.rover]\ncount = 1\nradius_m = 0.2\n\
         drive = {{ max_speed_m_s = 1, max_turn_rate_deg_s = 90 }}\n\
         [robots.rover.sensors.eye]\nkind = \"items\"\nrange_m = 1\n{lines}\n{believed}"
    );
    let read = ScenarioSpec::read(&Document::parse("t", &text).unwrap());
    let checked = read.unwrap_or_else(|errors| panic!("{errors}"));
    let measures = &checked.spec.robots["rover"].sensors["eye"].measures;
    ItemsSpec::of(measures).expect("it detects items").clone()
}

#[test]
fn what_is_not_given_of_a_kind_is_believed_as_it_is() {
    let lines = "blind_share = { mine = 0.1, clutter = 0.2 }\n\
                 confusion = { mine = { mine = 0.9, clutter = 0.1 } }";
    let sensor = sensor(lines, "believed.blind_share.mine = 0.05");
    let believed = sensor.as_believed(kinds().iter()).into_owned();
    let shares = [("clutter", 0.2), ("mine", 0.05)];
    assert_eq!(
        believed.blind_share,
        shares.map(|(kind, share)| (kind.to_owned(), share)).into()
    );
    let rest = ItemsSpec {
        blind_share: sensor.blind_share.clone(),
        ..believed
    };
    assert_eq!(rest, sensor.as_it_is());
}

#[test]
fn a_kind_that_is_never_detected_may_be_believed_to_be_and_the_reverse() {
    let believed = "believed.detection_probability.mine = 0.3";
    let probability = |sensor: &ItemsSpec, kind: &str| {
        let detected = sensor.detection_probability.as_ref().unwrap();
        detected.get(kind).map(|each| each.probability(0.0))
    };
    let unable = sensor("detection_probability.clutter = 0.2", believed);
    let believed_of = unable.as_believed(kinds().iter());
    let of_kinds = ["clutter", "mine", "rock"].map(|kind| probability(&believed_of, kind));
    assert_eq!(of_kinds, [Some(0.2), Some(0.3), None]);
    let able = sensor("", "believed.detection_probability.mine = 0");
    let believed_of = able.as_believed(kinds().iter());
    let of_kinds = ["clutter", "mine", "rock"].map(|kind| probability(&believed_of, kind));
    assert_eq!(of_kinds, [Some(1.0), Some(0.0), Some(1.0)]);
}

#[test]
fn without_a_table_a_sensor_is_believed_as_it_is() {
    let sensor = sensor("blind_share.mine = 0.1", "");
    assert!(matches!(
        sensor.as_believed(kinds().iter()),
        Cow::Borrowed(_)
    ));
}
