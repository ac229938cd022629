//! Acts: what robots do to items, or state about them.

use base::geometry::Point;
use base::hashed::Hashed;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Something that a robot does to the item at a place, or states about it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(deny_unknown_fields)]
pub struct Act {
    /// What it does.
    pub kind: ActKind,
    /// The place in the world, as far as the robot knows its own position.
    pub at: Point,
}

/// What a robot can do to items with its tools.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema, Hashed,
)]
#[serde(rename_all = "snake_case")]
pub enum ActKind {
    /// States that there may be an item.
    Mark,
    /// States, after a closer look, that there is one.
    Confirm,
    /// States, after a closer look, that there is none.
    Reject,
    /// Fences the place off.
    Isolate,
    /// Destroys the item with a charge.
    Neutralise,
    /// Declares the lane clear; only of a controller that is to clear one. The place has no meaning.
    DeclareClear,
    /// Gives the lane up; only of a controller that is to clear one. The place has no meaning.
    GiveUp,
}

/// The result of an act.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(deny_unknown_fields)]
pub struct Acted {
    /// What the robot did.
    pub kind: ActKind,
    /// The place that its command named.
    pub at: Point,
    /// Whether it was done. Of `neutralise`: whether the charge destroyed something. A statement reveals nothing
    /// about what is there. An act without the tool, out of its range or without a charge fails.
    pub is_success: bool,
}

/// What a brain knows of a tool of its body.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Tool {
    /// What it does.
    pub act: ActKind,
    /// Maximum distance of the item or place from the centre of the robot.
    #[schemars(range(min = 0.0))]
    pub range_m: f64,
    /// Maximum distance of the item from the place that the command names.
    #[schemars(range(min = 0.0))]
    pub reach_m: f64,
    /// Time for which the robot is stationary and repeats the act.
    #[schemars(range(min = 0.0))]
    pub duration_s: f64,
}

/// Number of acts in a command that are carried out; the others are ignored.
pub const MAX_ACTS: usize = 4;

impl ActKind {
    /// Its name in events and messages of errors.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Mark => "mark",
            Self::Confirm => "confirm",
            Self::Reject => "reject",
            Self::Isolate => "isolate",
            Self::Neutralise => "neutralise",
            Self::DeclareClear => "declare_clear",
            Self::GiveUp => "give_up",
        }
    }
}
