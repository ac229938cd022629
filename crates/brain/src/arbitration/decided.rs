//! The outcome of arbitration.

use crate::io::command::Motion;

/// The index of the active behaviour, if there is a single one, and the motion.
pub(crate) type Decided = (Option<usize>, Motion);
