//! Checks a document against a JSON Schema and reports all errors at once, each with its line.
//!
//! The schema is derived from the Rust types that serde reads the document into, so that the checks, the
//! completion in editors and the reader cannot disagree.
//!
//! ```
//! use base::document::{Document, schema::Schema};
//! use schemars::JsonSchema;
//! use serde::Deserialize;
//!
//! #[derive(Debug, PartialEq, Deserialize, JsonSchema)]
//! struct Job {
//!     /// When it ends, in seconds.
//!     #[schemars(range(min = 0.0, max = 1e6))]
//!     time_limit_s: f64,
//!     count: u8,
//! }
//! let schema = Schema::of::<Job>();
//! let job = Document::parse("job.toml", "time_limit_s = 120\ncount = 3")?.typed(&schema);
//! assert_eq!(job, Ok(Job { time_limit_s: 120.0, count: 3 }));
//! let job = Document::parse("job.toml", "time_limit_s = -1\ncuont = 3")?.typed::<Job>(&schema);
//! assert_eq!(
//!     job.unwrap_err().to_string(),
//!     "job.toml:2: cuont is not a known key: expected one of time_limit_s, count; \
//!      did you mean count?\n\
//!      job.toml:1: time_limit_s = -1: must be a number from 0 to 1000000 (seconds)\n\
//!      job.toml: count is missing: expected a whole number from 0 to 255"
//! );
//! # Ok::<(), base::error::InputErrors>(())
//! ```

mod check;
mod closed;
mod expected;
mod forms;
mod keywords;
mod parameters;
mod simplified;
pub mod units;

pub use parameters::{Parameter, ParameterKind, ParameterValue, PathStep};
pub use simplified::Schema;

#[cfg(test)]
mod tests;
