//! A scenario of the metric engine, gathered from the modules that own its parts.

pub(crate) mod areas;
mod checked;
mod checks;
mod counts;
mod facts;
pub(crate) mod features;
pub(crate) mod finders;
mod kinds;
mod lane_sight;
pub(crate) mod lane_work;
mod models;
mod reading;
mod ready;
mod spec;
pub(crate) mod team_reach;
mod world_hash;

pub use checked::Checked;
pub use models::ModelSpec;
pub use ready::Scenario;
pub use spec::ScenarioSpec;
