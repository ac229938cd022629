//! The optional parts of scenarios.

/// The optional parts of a scenario that have outcome columns.
#[expect(
    clippy::struct_excessive_bools,
    reason = "each part is there or not, whatever the others are"
)]
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Features {
    /// Kinds of goals.
    pub(crate) goals: bool,
    /// Tools of robots, hazards, or items that are completed by more than a detection.
    pub(crate) acts: bool,
    /// A lane that controllers are to clear.
    pub(crate) clearance: bool,
    /// Vehicles that are to pass that lane.
    pub(crate) passage: bool,
}
