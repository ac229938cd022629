//! The bundled robot models, selected by the key `model`; docs/robots.md has the source of every
//! figure.

use base::document::{Document, Value};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A bundled robot model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Model {
    /// A small tracked robot of about 2003 with sonars and a metal detector.
    Tracked,
    /// A modern small four-wheeled ground vehicle with a laser scanner and a camera.
    Ugv,
    /// A small quadrotor with a downward camera.
    Quadrotor,
}

impl Model {
    /// All bundled models and their names.
    pub const NAMES: [(&str, Self); 3] = [
        ("tracked", Self::Tracked),
        ("ugv", Self::Ugv),
        ("quadrotor", Self::Quadrotor),
    ];

    /// Its TOML, with which the table of a robot kind is completed.
    #[must_use]
    pub fn text(self) -> &'static str {
        match self {
            Self::Tracked => include_str!("tracked.toml"),
            Self::Ugv => include_str!("ugv.toml"),
            Self::Quadrotor => include_str!("quadrotor.toml"),
        }
    }
}

/// Completes each robot kind of `document` with the values of its `model`. A wrong name of a model
/// is reported where that key is read.
pub(crate) fn fill(document: &mut Document) {
    let Some(Value::Table(kinds)) = document.get(&["robots"]).map(|node| &node.value) else {
        return;
    };
    let names: Vec<String> = kinds.keys().cloned().collect();
    for name in names {
        let model = document.get(&["robots", &name, "model"]);
        // A kind whose model is unknown does not also get errors for keys that the model would
        // have.
        let model = model.map(|model| named(&model.value).unwrap_or(Model::Ugv));
        if let Some(model) = model {
            fill_with(document, &name, model);
        }
    }
}

fn named(name: &Value) -> Option<Model> {
    let Value::Text(name) = name else { return None };
    let found = Model::NAMES.iter().find(|(known, _)| known == name);
    found.map(|(_, model)| *model)
}

fn fill_with(document: &mut Document, name: &str, model: Model) {
    let found = Model::NAMES.iter().find(|(_, each)| *each == model);
    let origin = found.map_or(String::new(), |(name, _)| format!("bundled model {name}"));
    // A test checks that each is valid TOML.
    if let Ok(defaults) = Document::parse(&origin, model.text()) {
        document.fill(&["robots", name], &defaults);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::ScenarioSpec;

    const REST: &str =
        "[clock]\ntime_limit_s = 9\n[world]\nsize_m = [9, 9]\n[robots.r]\ncount = 1\n";

    fn read(more: &str) -> Result<crate::bodies::RobotSpec, String> {
        let document = Document::parse("t.toml", &format!("{REST}{more}")).unwrap();
        let read = ScenarioSpec::read(&document);
        let robots = read.map(|checked| checked.spec.robots);
        robots
            .map(|mut robots| robots.remove("r").unwrap())
            .map_err(|errors| errors.to_string())
    }

    #[test]
    fn every_model_is_a_robot_that_lacks_only_its_number() {
        for (name, model) in Model::NAMES {
            let robot = read(&format!("model = {name:?}"));
            assert_eq!(robot.map(|robot| robot.model), Ok(Some(model)));
        }
    }

    #[test]
    fn what_is_written_holds_over_the_model() {
        let robot = read("model = \"ugv\"\nradius_m = 0.5\ndrive = { max_speed_m_s = 1 }").unwrap();
        let ugv = read("model = \"ugv\"").unwrap();
        let expected = crate::bodies::RobotSpec {
            radius_m: 0.5,
            drive: crate::bodies::drive::DriveSpec {
                max_speed_m_s: 1.0,
                ..ugv.drive
            },
            ..ugv
        };
        assert_eq!(robot, expected);
    }

    #[test]
    fn an_unknown_model_is_the_only_error_reported() {
        assert_eq!(
            read("model = \"ugw\"").unwrap_err(),
            "t.toml:7: robots.r.model = \"ugw\": must be one of \"tracked\", \"ugv\", \
             \"quadrotor\"; did you mean \"ugv\"?"
        );
        assert!(
            read("model = 3")
                .unwrap_err()
                .starts_with("t.toml:7: robots.r.model = 3: must")
        );
    }

    #[test]
    fn an_error_of_a_models_value_names_the_model() {
        let reported = read("model = \"ugv\"\n[clock.x]").unwrap_err();
        assert!(reported.starts_with("t.toml:8: clock.x"), "{reported}");
        let document = format!("{REST}model = \"ugv\"")
            .replace("time_limit_s = 9", "time_limit_s = 9\nstep_s = 1");
        let document = Document::parse("t.toml", &document).unwrap();
        let reported = ScenarioSpec::read(&document).unwrap_err();
        let expected = "bundled model ugv:12: robots.r.drive.max_turn_rate_deg_s = 229: must be at \
                        most 180, half a turn in one step of 1 s";
        assert!(reported.to_string().contains(expected), "{reported}");
    }
}
