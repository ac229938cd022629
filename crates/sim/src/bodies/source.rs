//! What moves a body: the simulation, or something outside of it.

use super::external::ExternalBody;

/// What moves a body.
#[derive(Debug, Clone, Default)]
pub(crate) enum BodySource {
    /// The simulation.
    #[default]
    Simulated,
    /// A real robot or another simulator: its pose comes from there, and its commands are returned to it.
    External(Box<ExternalBody>),
}
