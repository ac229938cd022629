//! Blocks of runs of one configuration.

use super::column::Column;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

/// How a block of runs is computed. None of it changes an outcome.
#[derive(Debug, Clone, Copy)]
pub struct BlockOptions<'s> {
    /// Set to cancel the block. The runner checks it between the steps of a run, or between runs
    /// that take less than a tenth of a second.
    pub stop: &'s AtomicBool,
    /// Whether several threads may share a single run, for blocks of fewer runs than threads.
    pub may_share: bool,
}

impl BlockOptions<'static> {
    /// One thread, never cancelled.
    pub const ALONE: Self = Self {
        stop: &NEVER,
        may_share: false,
    };
}

impl BlockOptions<'_> {
    /// Whether the block has been cancelled.
    #[must_use]
    pub fn is_stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }
}

static NEVER: AtomicBool = AtomicBool::new(false);

/// One configuration, ready to run.
///
/// ```
/// use base::engine::{BlockOptions, Bounds, Column, ColumnKind, Runner};
/// struct Coin;
/// impl Runner for Coin {
///     fn columns(&self) -> Vec<Column> {
///         let bounds = Bounds::up_to(1.0);
///         vec![Column { name: "heads".into(), kind: ColumnKind::Flag, bounds }]
///     }
///     fn run_block(&self, seed: u64, runs: std::ops::Range<u64>, _: BlockOptions) -> Vec<Vec<f64>> {
///         let heads = |run| if (seed ^ run) % 2 == 0 { 1.0 } else { 0.0 };
///         vec![runs.map(heads).collect()]
///     }
/// }
/// assert_eq!(Coin.run_block(7, 0..3, BlockOptions::ALONE), [[0.0, 1.0, 0.0]]);
/// ```
pub trait Runner: Send + Sync {
    /// The columns of its outcomes: the same names and kinds, in the same order, for every
    /// configuration of a scenario.
    fn columns(&self) -> Vec<Column>;

    /// The outcomes of `runs` (run numbers, not a count): one vector per column, in the order of the
    /// runs.
    ///
    /// NaN in all columns marks a run that became non-finite and is quarantined; +infinity marks
    /// something that never happened. An outcome depends on (configuration, seed, run) alone, so
    /// callers may split the runs into any blocks. The result of a cancelled block is meaningless.
    fn run_block(&self, seed: u64, runs: Range<u64>, options: BlockOptions) -> Vec<Vec<f64>>;
}
