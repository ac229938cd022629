//! Checks of how a body is external.

use crate::bodies::external::{ExternalSpec, ReadingSource};
use crate::scenario::Scenario;
use crate::sensors::Sensor;
use base::document::path_of;
use base::error::InputError;
use base::geometry::Point;

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
            match kind.sensors.iter().find(|sensor| sensor.name == *name) {
                None => {
                    let names = kind.sensors.iter().map(|sensor| sensor.name.as_str());
                    let error = InputError::unknown_key(at, name, shown(*source), names);
                    errors.push(error);
                }
                Some(sensor) => {
                    let error = |allowed: &str| {
                        InputError::new(at.clone(), Some(shown(*source)), allowed.to_owned())
                    };
                    errors.extend(allowed(sensor, *source).map(error));
                }
            }
        }
        let is_finite = |corner: &Point| corner.x.is_finite() && corner.y.is_finite();
        let corners = &spec.fence_m;
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

/// What is allowed, if this source is not.
fn allowed(sensor: &Sensor, source: ReadingSource) -> Option<&'static str> {
    match source {
        ReadingSource::Real => None,
        _ if !sensor.can_be_virtual() => Some(
            "\"real\": virtual sensors measure from the position and heading that real ones state",
        ),
        ReadingSource::Both if !sensor.can_be_both() => {
            Some("\"real\" or \"virtual\": its readings cannot be merged")
        }
        _ => None,
    }
}

fn shown(source: ReadingSource) -> String {
    format!("{:?}", format!("{source:?}").to_lowercase())
}
