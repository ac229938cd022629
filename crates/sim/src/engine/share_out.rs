//! Work for each robot, shared out over threads where that pays.

/// Robots that a thread takes at once: long enough to hide what that costs.
pub(crate) const ROBOTS_PER_TASK: usize = 1024;

/// Worlds of fewer robots are left to one thread.
const FEW: usize = 2 * ROBOTS_PER_TASK;

/// Whether threads should share the work of so many robots.
pub(crate) fn is_worth_sharing(robots: usize) -> bool {
    robots >= FEW && rayon::current_num_threads() > 1
}
