//! The seam between simulators and studies: what a run tells, and how runs are asked for.

use std::borrow::Cow;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

/// How a column's values can be kept in little room.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Whole numbers.
    Whole,
    /// Any numbers.
    Real,
    /// 0 or 1.
    Flag,
}

/// What every run of one configuration tells under a name, and between which bounds.
///
/// The bounds follow from the configuration and hold for each run that is not quarantined.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Its name, with the unit.
    pub name: Cow<'static, str>,
    /// What its values are.
    pub kind: Kind,
    /// No run is below; `None` where there is no natural bound.
    pub least: Option<f64>,
    /// No run is above; `None` where there is no natural bound, and then a run may be +infinity.
    pub greatest: Option<f64>,
}

/// How a block of runs is computed; nothing of it changes an outcome.
#[derive(Debug, Clone, Copy)]
pub struct Work<'s> {
    /// Set once nobody wants the outcomes any more: whoever computes them looks at it between a
    /// run's steps, or between runs that take less than a tenth of a second, and gives up.
    pub stop: &'s AtomicBool,
    /// Whether threads may share the work of a single run: where there are fewer runs than threads.
    pub may_share: bool,
}

impl Work<'static> {
    /// On one thread, to the end.
    pub const ALONE: Self = Self {
        stop: &NEVER,
        may_share: false,
    };
}

impl Work<'_> {
    /// Whether nobody wants the outcomes any more.
    #[must_use]
    pub fn is_stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }
}

static NEVER: AtomicBool = AtomicBool::new(false);

/// One configuration, ready to be run.
///
/// ```
/// use base::runner::{Column, Kind, Runner, Work};
/// struct Coin;
/// impl Runner for Coin {
///     fn columns(&self) -> Vec<Column> {
///         let (least, greatest) = (Some(0.0), Some(1.0));
///         vec![Column { name: "heads".into(), kind: Kind::Flag, least, greatest }]
///     }
///     fn run_block(&self, seed: u64, runs: std::ops::Range<u64>, _: Work) -> Vec<Vec<f64>> {
///         let heads = |run| if (seed ^ run) % 2 == 0 { 1.0 } else { 0.0 };
///         vec![runs.map(heads).collect()]
///     }
/// }
/// assert_eq!(Coin.run_block(7, 0..3, Work::ALONE), [[0.0, 1.0, 0.0]]);
/// ```
pub trait Runner: Send + Sync {
    /// What its runs tell: the same names and kinds, in the same order, for every configuration of
    /// one engine.
    fn columns(&self) -> Vec<Column>;

    /// The outcomes of `runs` (numbers, not a count), one vector a column, in the runs' order.
    ///
    /// NaN in all columns = the run went non-finite and is quarantined; +infinity = never. A run's
    /// outcome depends on (configuration, seed, run) alone: callers share the work out as they
    /// like. Once `work` is stopped, what is returned means nothing.
    fn run_block(&self, seed: u64, runs: Range<u64>, work: Work) -> Vec<Vec<f64>>;
}
