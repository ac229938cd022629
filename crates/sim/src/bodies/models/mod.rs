//! The bundled robot models, which the key `model` selects beside those of the scenario; docs/robots.md has the source of every
//! figure.

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// The name of a robot model: a bundled one, or one of the scenario.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct ModelName(pub String);

impl JsonSchema for ModelName {
    fn schema_name() -> Cow<'static, str> {
        "ModelName".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "anyOf": [generator.subschema_for::<Model>(), { "type": "string" }],
            "x-names": "models",
        })
    }
}

/// A bundled robot model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, JsonSchema)]
#[schemars(rename_all = "snake_case")]
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

    /// The bundled model of this name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        let found = Self::NAMES.iter().find(|(known, _)| *known == name);
        found.map(|(_, model)| *model)
    }

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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::ScenarioSpec;
    use base::document::Document;

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
        for (name, _) in Model::NAMES {
            let robot = read(&format!("model = {name:?}"));
            assert_eq!(
                robot.map(|robot| robot.model),
                Ok(Some(ModelName(name.to_owned())))
            );
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
