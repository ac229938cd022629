//! A valid scenario.

use super::ready::Scenario;
use super::spec::ScenarioSpec;

/// A valid scenario.
#[derive(Debug, Clone)]
pub struct Checked {
    /// As it is written; omitted keys have their defaults, or the values of the robot model.
    pub spec: ScenarioSpec,
    /// Converted for runs.
    pub scenario: Scenario,
}
