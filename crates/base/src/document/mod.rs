//! Documents in TOML, and in the plain YAML of maps, that are checked as a whole: all errors are
//! reported at once, each with its line.
//!
//! serde stops at the first error and does not keep lines. Here, the text becomes a tree of [`Node`]s
//! with their origins ([`parse`]), command-line options replace nodes ([`Document::set`]), and a
//! [`Section`] reads typed values and collects errors. [`schema`] checks a document against a JSON
//! Schema instead.
//!
//! ```
//! use base::document::{Document, Section, Value};
//! let mut document = Document::parse("job.toml", "time_limit_s = 120\n[robots]\ncount = 0")?;
//! document.set(&["time_limit_s"], Value::Float(-1.0), "--cap");
//! let errors = document
//!     .read(|root: &Section| {
//!         root.only(&["time_limit_s", "robots"]);
//!         let time_limit_s = root.number("time_limit_s", 0.0..=1e6);
//!         let count = root.section("robots").integer("count", 1..=100);
//!         Some((time_limit_s?, count?))
//!     })
//!     .unwrap_err();
//! assert_eq!(
//!     errors.to_string(),
//!     "--cap: time_limit_s = -1.0: must be a number from 0 to 1000000\n\
//!      job.toml:3: robots.count = 0: must be a whole number from 1 to 100"
//! );
//! # Ok::<(), base::error::InputErrors>(())
//! ```

mod node;
mod parse;
mod place;
pub mod renamed;
mod root;
pub mod schema;
mod section;
mod typed;
mod yaml;

pub(crate) use node::written;
pub use node::{Node, Table, Value, path_of};
pub use place::Place;
pub use root::{CreatedTable, Document, Files, Override};
pub use section::Section;

#[cfg(test)]
mod tests;
