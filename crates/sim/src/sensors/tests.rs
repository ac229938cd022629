//! The list of kinds.

use super::sensor_kind::Provides;
use super::{KINDS, Measures, SensorSpec};
use crate::scenario::ScenarioSpec;
use base::document::Document;

/// A scenario whose robots have the sensor of an example.
fn document(example: &str) -> Document {
    let text = format!(
        "clock = {{ step_s = 0.1, time_limit_s = 9 }}\nworld.size_m = [40, 40]\n\
         [robots.rover]\ncount = 1\nradius_m = 0.2\n\
         drive = {{ max_speed_m_s = 1, max_turn_rate_deg_s = 90 }}\nsensors.{example}"
    );
    Document::parse("t", &text).unwrap()
}

/// The sensor of an example.
fn example(text: &str) -> SensorSpec {
    let mut spec: ScenarioSpec = document(text).typed(ScenarioSpec::schema()).unwrap();
    let rover = spec.robots.get_mut("rover").unwrap();
    rover.sensors.pop_first().unwrap().1
}

#[test]
fn the_example_of_each_kind_is_a_sensor_of_that_kind() {
    for kind in KINDS {
        let sensor = example(kind.example);
        assert_eq!(sensor.measures.facts(), kind, "{}", kind.example);
    }
}

#[test]
fn kinds_have_the_names_that_scenarios_give_them() {
    for kind in KINDS {
        let sensor: Measures = example(kind.example).measures;
        let written = serde_json::to_value(sensor).unwrap();
        assert_eq!(written["kind"], kind.name);
    }
}

#[test]
fn what_a_sensor_detects_has_a_range_and_what_it_measures_of_the_robot_has_none() {
    for kind in KINDS {
        let around = [Provides::Distances, Provides::Items, Provides::Robots];
        let detects_around = around.iter().any(|what| kind.provides(*what));
        let range_m = example(kind.example).measures.range_m();
        assert_eq!(range_m.is_some(), detects_around, "{}", kind.name);
    }
}

#[test]
fn brains_know_the_range_rings_and_no_others() {
    for kind in KINDS {
        let checked = ScenarioSpec::read(&document(kind.example)).unwrap();
        let rings = checked.scenario.brain(0).unwrap().body().rings.len();
        assert_eq!(rings, usize::from(kind.is_ring), "{}", kind.name);
    }
}
