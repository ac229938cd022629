//! Warnings about user input: it is allowed, and probably not meant.

use crate::error::{place_of, shortened, shown_origin};
use std::fmt;

/// One warning: where it is, the value, and what is the matter.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Warning {
    /// The file or option that the value comes from: `scenario.toml:7`, `study.vary`.
    pub origin: String,
    /// Path of the value: `robots.rover.count`.
    pub path: String,
    /// The value as the user wrote it; `None` if it is missing.
    pub value: Option<String>,
    /// The effect of the value, and what to do.
    pub effect: String,
}

impl Warning {
    /// The file of the origin, and the line if there is one; `file` is the one that was read. `None`
    /// for an option.
    #[must_use]
    pub fn place(&self, file: &str) -> Option<(&str, Option<usize>)> {
        place_of(&self.origin, file)
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (origin, path) = (shown_origin(&self.origin), shortened(&self.path));
        write!(f, "{origin}: {path}")?;
        if let Some(value) = &self.value {
            write!(f, " = {}", shortened(value))?;
        }
        write!(f, ": {}", self.effect)
    }
}
