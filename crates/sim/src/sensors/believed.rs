//! What robots and controllers believe of an item detector that differs from the truth.

use super::detection::Detection;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// These may be the values that its maker states. What is not given, for a kind of item, is believed as it is; a row of `lookalike_share` or
/// `confusion` that is given replaces the whole row of that kind. Range, positions and false alarms are always believed as they are.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BelievedSpec {
    /// Believed probability of detection per look, for each kind of item; also for kinds that the
    /// sensor never detects.
    #[serde(default)]
    pub detection_probability: BTreeMap<String, Detection>,
    /// Believed share of the items of each kind that sensors of this model never detect, 0 to 1.
    #[serde(default)]
    pub blind_share: BTreeMap<String, f64>,
    /// Believed share of the items of each kind (outer keys) that look like another kind (inner
    /// keys) to sensors of this model, 0 to 1.
    #[serde(default)]
    pub lookalike_share: BTreeMap<String, BTreeMap<String, f64>>,
    /// Believed probability of each reported kind (inner keys) by the kind of a detected item
    /// (outer keys). The probabilities of a row must sum to 1.
    #[serde(default)]
    pub confusion: BTreeMap<String, BTreeMap<String, f64>>,
}
