//! Stub until the real one is merged.
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
/// What a brain is.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct BrainSpec {
    /// Steps a second.
    pub rate_hz: Option<f64>,
}
