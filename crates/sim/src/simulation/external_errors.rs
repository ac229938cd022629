//! Checks of how a body is external.

use crate::bodies::external::{ExternalSpec, ReadingSource};
use crate::scenario::Scenario;
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
                Some(sensor) if *source != ReadingSource::Real && !sensor.can_be_virtual() => {
                    let allowed = "\"real\": virtual sensors measure from the position and heading that real ones state";
                    errors.push(InputError::new(
                        at,
                        Some(shown(*source)),
                        allowed.to_owned(),
                    ));
                }
                Some(_) => {}
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

fn shown(source: ReadingSource) -> String {
    format!("{:?}", format!("{source:?}").to_lowercase())
}
