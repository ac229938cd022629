//! How one motion is made of what all behaviours want.

use crate::arbitration::motor_schemas::Schemas;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How one motion is made of what all behaviours want.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Arbitration {
    /// The highest behaviour with something to do has its way, for at least its hold time.
    #[default]
    Subsumption,
    /// Behaviours that want to be somewhere have goals, which are served by their precedence, together
    /// where they do not conflict; behaviours that want a motion keep their places among them.
    Goals,
    /// What all behaviours want is summed as vectors, with what obstacles repel and some noise (motor
    /// schemas: Arkin, *Motor schema-based mobile robot navigation*, 1989). None waits for another.
    Schemas(Schemas),
}
