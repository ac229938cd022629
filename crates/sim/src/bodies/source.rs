//! What moves a body: the simulation, or something outside of it.

/// What moves a body.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) enum BodySource {
    /// The simulation.
    #[default]
    Simulated,
    /// A real robot or another simulator: its percepts come from there, and its commands are returned
    /// to it.
    External,
}
