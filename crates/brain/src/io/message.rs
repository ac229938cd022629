//! Messages between robots.

use super::body::RobotId;
use base::geometry::Point;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What one robot tells others.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Message {
    /// What it is about.
    pub about: About,
    /// How sure the sender is, 0 to 1.
    pub confidence: f64,
}

/// What a message can be about.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum About {
    /// An item.
    Item {
        /// Place of its kind in [`Body::item_kinds`](crate::Body::item_kinds).
        kind: u16,
        /// Where it is in the world.
        at: Point,
        /// Whose looks say so.
        #[serde(default)]
        seen: Provenance,
    },
    /// The sender itself.
    Sender {
        /// Where it is in the world.
        at: Point,
        /// Its course: 0 along x, anticlockwise.
        heading_rad: f64,
        /// How often it has looked for items so far, on its way here.
        #[serde(default)]
        looks: u32,
    },
    /// A place where the sender wants to be.
    Goal {
        /// Where in the world.
        at: Point,
        /// What has become of it.
        stand: CommitmentStatus,
    },
}

/// The looks of one robot at one item: what counts once, whoever tells of it, and however often.
#[derive(
    Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema,
)]
#[serde(deny_unknown_fields)]
pub struct Provenance {
    /// Who looked.
    pub by: RobotId,
    /// The looker's own number for the item.
    pub mark: u32,
    /// How often it looked: of two reports with the same mark, the one with more looks holds.
    pub looks: u32,
}

/// What has become of a goal.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CommitmentStatus {
    /// The sender is on its way: nobody else needs to go.
    Going,
    /// The sender has been there: nobody else needs to go.
    Done,
    /// The sender no longer goes, and has not been there: others may.
    Left,
}
