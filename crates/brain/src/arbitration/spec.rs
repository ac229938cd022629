//! How one motion results from the behaviours.

use crate::arbitration::motor_schemas::Schemas;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How one motion results from the behaviours.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Arbitration {
    /// The highest behaviour with something to do is active, at least for its hold time.
    #[default]
    Subsumption,
    /// Behaviours that propose a destination have goals, which are served in order of precedence,
    /// and together where they do not conflict. Behaviours that propose a motion keep their places
    /// in the list.
    Goals,
    /// The proposals of all behaviours are summed as vectors, together with the repulsion of
    /// obstacles and some noise (motor schemas: Arkin, *Motor schema-based mobile robot
    /// navigation*, 1989). No behaviour waits for another.
    Schemas(Schemas),
}
