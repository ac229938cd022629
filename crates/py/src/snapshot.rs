//! Copies of runs that know their size.

use allocation_counter::measure;

/// A copy of a run at one step, and the bytes that it takes: those of its own, and those that copying it
/// allocated. It shares the rest, such as its scenario, with the run.
pub(crate) struct Measured<Run> {
    pub(crate) run: Run,
    pub(crate) bytes: u64,
}

impl<Run: Clone> Measured<Run> {
    /// Copies a run. Counting what this allocates includes everything that a run will ever contain, and each
    /// list with its capacity.
    pub(crate) fn of(run: &Run) -> Self {
        let mut copy = None;
        let allocated = measure(|| copy = Some(run.clone())).bytes_current;
        Self {
            run: copy.unwrap_or_else(|| run.clone()),
            bytes: size_of::<Run>() as u64 + u64::try_from(allocated).unwrap_or(0),
        }
    }
}
