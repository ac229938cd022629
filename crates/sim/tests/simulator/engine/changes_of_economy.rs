//! Each key of goals and controllers that changes in a run has an effect, or is refused.

use crate::common::{self, scenario, start};
use sim::scenario::Scenario;
use sim::simulation::Simulation;
use std::collections::BTreeSet;
use std::sync::Arc;

/// Controllers of two kinds and three rovers, and a goal that no robot serves, which controllers trade in vain. Half of the goals are issued when the scenario changes.
const RUN: &str = r#"
clock.time_limit_s = 150
world.size_m = [60, 40]
robots.bird = { layer = "air", capabilities = ["wing"], radio.range_m = 9, start.at_m = [[30, 20], [31, 20]], brain.behaviours = [] }
controllers.base.count = 2
controllers.base.radio = { range_m = 80, messages_per_step = 20, loss_probability = 0.1 }
controllers.mast = { start.at_m = [[50, 30]], radio.range_m = 80 }
goals.spot = { count = 8, owner = "base", every_s = 10 }
goals.sky = { count = 1, owner = "base", requires = "wing", placement.at_m = [[5, 5]] }
goals.here = { count = 2, owner = "mast", placement.at_m = [[20, 10], [40, 10], [30, 30]] }
[robots.rover]
capabilities = ["arm"]
start.at_m = [[10, 10], [12, 12], [50, 30]]
radio = { range_m = 50, messages_per_step = 20, loss_probability = 0.1 }
sensors = { gps.kind = "position", compass.kind = "heading" }
brain.behaviours = [{ kind = "serve" }]
"#;

const CHANGED_AT_S: f64 = 25.0;

/// The run until it changes.
fn begun() -> Simulation {
    let mut simulation = start(RUN);
    while simulation.time_s() < CHANGED_AT_S {
        simulation.step();
    }
    simulation
}

fn outcome(mut simulation: Simulation) -> Vec<f64> {
    while !simulation.state().is_over(simulation.scenario()) {
        simulation.step();
    }
    let runs = sim::runner::Runs(simulation.scenario().clone());
    runs.values(&simulation.outcome()).unwrap()
}

/// The scenario in which a table has a key with another value.
fn with(table: &str, key: &str, value: &str) -> Arc<Scenario> {
    scenario(&common::with(RUN, &format!("{table}.{key} = {value}")))
}

/// The paths of the values that cannot change.
fn refused(to: &Scenario) -> Vec<String> {
    let simulation = begun();
    let errors = simulation.state().without_effect(simulation.scenario(), to);
    errors.into_iter().map(|error| error.path).collect()
}

fn has_effect(to: Arc<Scenario>) -> bool {
    let mut changed = begun();
    changed.change(to).unwrap();
    outcome(changed) != outcome(begun())
}

/// Keys with a value that changes the outcome.
const EFFECTIVE: [(&str, &str, &str); 20] = [
    ("controllers.base", "count", "3"),
    ("controllers.base", "aboard", "\"bird\""),
    ("controllers.base.radio", "range_m", "5"),
    ("controllers.base.radio", "loss_probability", "0.9"),
    ("controllers.base.radio", "delay_s", "1.5"),
    ("controllers.base.radio", "messages_per_step", "1"),
    (
        "controllers.base",
        "sensors",
        "{ eye = { kind = \"robots\", range_m = 60 } }",
    ),
    ("controllers.base", "price", "7"),
    ("controllers.base", "mean_time_between_failures_s", "2"),
    ("controllers.base", "failed", "[0]"),
    ("controllers.base", "allocation", "\"none\""),
    ("controllers.base", "service_lease_s", "5"),
    ("controllers.base", "owner_lease_s", "4"),
    ("controllers.base", "backup", "\"none\""),
    ("controllers.base", "trade", "{}"),
    ("controllers.base", "auction_s", "4"),
    ("controllers.base", "max_goals", "1"),
    ("goals.spot", "count", "4"),
    ("goals.spot", "arrive_s", "20"),
    ("goals.spot", "every_s", "2"),
];

/// Keys with a value that is refused, because agents would not notice it.
const REFUSED: [(&str, &str, &str); 13] = [
    (
        "controllers.base",
        "start",
        "{ kind = \"uniform\", within_m = [[0, 0], [9, 9]] }",
    ),
    (
        "goals.spot",
        "placement",
        "{ kind = \"uniform\", within_m = [[0, 0], [9, 9]] }",
    ),
    ("goals.spot", "work", "\"search\""),
    ("goals.spot", "value", "2"),
    ("goals.spot", "within_m", "2"),
    ("goals.spot", "service_s", "2"),
    ("goals.spot", "deadline_s", "40"),
    ("goals.spot", "requires", "\"arm\""),
    ("goals.spot", "owner", "\"mast\""),
    ("goals.here", "arrive_s", "5"),
    ("goals.here", "every_s", "5"),
    ("goals.here", "count", "1"),
    ("goals.spot", "count", "2"),
];

#[test]
fn a_key_that_changes_has_an_effect_or_is_refused() {
    let mut silent = Vec::new();
    for (table, key, value) in EFFECTIVE {
        let to = with(table, key, value);
        let path = format!("{table}.{key}");
        assert_eq!(refused(&to), [""; 0], "{path}");
        if !has_effect(to) {
            silent.push(path);
        }
    }
    assert_eq!(silent, [""; 0]);
    for (table, key, value) in REFUSED {
        assert_eq!(
            refused(&with(table, key, value)),
            [format!("{table}.{key}")]
        );
    }
}

#[test]
fn every_key_of_goals_and_controllers_is_examined() {
    let examined: BTreeSet<(&str, &str)> = EFFECTIVE
        .iter()
        .chain(&REFUSED)
        .map(|(table, key, _)| (*table, *key))
        .collect();
    let schema = serde_json::to_value(schemars::schema_for!(sim::scenario::ScenarioSpec)).unwrap();
    for (name, tables) in [
        (
            "ControllerSpec",
            vec!["controllers.base", "controllers.mast"],
        ),
        ("GoalSpec", vec!["goals.spot", "goals.here"]),
    ] {
        let keys = schema["$defs"][name]["properties"].as_object().unwrap();
        // Lanes have their own tests.
        for key in keys
            .keys()
            .filter(|key| !["radio", "clearance"].contains(&key.as_str()))
        {
            let is_known = tables
                .iter()
                .any(|table| examined.contains(&(*table, key.as_str())));
            assert!(is_known, "{name}: {key}");
        }
    }
}

#[test]
fn places_of_more_goals_and_controllers_can_be_added() {
    let more = with(
        "goals.here",
        "placement",
        "{ kind = \"fixed\", at_m = [[20, 10], [40, 10], [9, 9]] }",
    );
    assert_eq!(refused(&more), [""; 0]);
}
