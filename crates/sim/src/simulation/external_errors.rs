//! Checks of how a body is external.

use crate::bodies::external::{ExternalSpec, ReadingSource};
use crate::scenario::Scenario;
use crate::sensors::{KindFacts, Sensor};
use base::document::path_of;
use base::error::InputError;
use base::geometry::Point;

/// Positions older than this count as silent in any case.
const MAX_AGE_S: f64 = 1e6;

/// A fence has this number of corners or more.
const MIN_CORNERS: usize = 3;

impl Scenario {
    /// The errors of a specification for a body of a kind, which is at the path `at`.
    #[must_use]
    pub fn errors_of_external(&self, kind: u8, spec: &ExternalSpec, at: &str) -> Vec<InputError> {
        let Some(kind) = self.kinds.get(usize::from(kind)) else {
            return Vec::new();
        };
        let sensors_at = path_of(at, "sensors");
        let mut errors = Vec::new();
        for (name, source) in &spec.sensors {
            let at = path_of(&sensors_at, name);
            let Some(sensor) = kind.sensors.iter().find(|sensor| sensor.name == *name) else {
                let names = kind.sensors.iter().map(|sensor| sensor.name.as_str());
                let error = InputError::unknown_key(at, name, shown(*source), names);
                errors.push(error);
                continue;
            };
            let others = kind.sensors.iter();
            let others = others.filter(|other| other.facts.provides_same(sensor.facts));
            let is_real = |other: &Sensor| {
                let source = spec.sensors.get(&other.name);
                source.is_none_or(|source| *source == ReadingSource::Real)
            };
            let has_real = { others }.any(is_real);
            let allowed = allowed(sensor.facts, *source, has_real);
            let error =
                |allowed: &str| InputError::new(at, Some(shown(*source)), allowed.to_owned());
            errors.extend(allowed.map(error));
        }
        if let Some(max_age_s) = spec
            .max_age_s
            .filter(|age_s| !(0.0..=MAX_AGE_S).contains(age_s))
        {
            let allowed = format!("a number from 0 to {MAX_AGE_S} (seconds)");
            let at = path_of(at, "max_age_s");
            errors.push(InputError::new(at, Some(max_age_s.to_string()), allowed));
        }
        let is_finite = |corner: &Point| corner.x.is_finite() && corner.y.is_finite();
        let corners = &spec.fence_m;
        if self.torus.is_some() && !corners.is_empty() {
            let allowed = "omitted: a periodic world has no border that a body could not cross";
            let given = format!("{} corners", corners.len());
            errors.push(InputError::new(
                path_of(at, "fence_m"),
                Some(given),
                allowed.to_owned(),
            ));
        }
        let is_fence = corners.len() >= MIN_CORNERS && corners.iter().all(is_finite);
        if !corners.is_empty() && !is_fence {
            let allowed = format!("{MIN_CORNERS} corners or more, each of two finite numbers");
            let given = format!("{} corners", corners.len());
            errors.push(InputError::new(
                path_of(at, "fence_m"),
                Some(given),
                allowed,
            ));
        }
        errors
    }
}

/// What is allowed, if this source is not; `has_real` is whether the robot has a real sensor that states the same.
fn allowed(facts: &KindFacts, source: ReadingSource, has_real: bool) -> Option<&'static str> {
    match source {
        ReadingSource::Virtual if facts.states_pose() && !has_real => Some(
            "\"real\": virtual sensors measure from the position and heading that real ones state",
        ),
        ReadingSource::Both if facts.states_pose() => {
            Some("\"real\": positions and headings cannot be merged")
        }
        ReadingSource::Both if !facts.can_be_both() => {
            Some("\"real\" or \"virtual\": its readings cannot be merged")
        }
        _ => None,
    }
}

fn shown(source: ReadingSource) -> String {
    format!("{:?}", format!("{source:?}").to_lowercase())
}
