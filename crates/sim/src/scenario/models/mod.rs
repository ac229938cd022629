//! Robot models: those of the scenario, under `models`, and the bundled ones. Robot kinds and models are
//! completed from them before a document is read.

mod chain;
mod errors;
mod fill;
mod origin;
mod spec;

pub(super) use errors::errors;
pub(super) use fill::fill;
pub(super) use origin::at_models;
pub use spec::ModelSpec;

#[cfg(test)]
mod tests;
