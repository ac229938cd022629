//! Checks that a run ends within a reasonable number of steps.

use crate::scenario::spec::ScenarioSpec;
use base::document::Place;
use base::error::InputError;

/// Maximum number of steps of a run.
const MAX_STEPS: f64 = 1e8;

pub(super) fn errors(spec: &ScenarioSpec, at: &Place) -> Vec<InputError> {
    let step_s = spec.clock.step_s;
    if spec.clock.time_limit_s <= MAX_STEPS * step_s {
        return Vec::new();
    }
    let allowed = format!(
        "at most {}: a run has at most {MAX_STEPS} steps, here of {step_s} s",
        MAX_STEPS * step_s
    );
    vec![at.key("clock").key("time_limit_s").error(allowed)]
}
