//! Sharing the work of a step between threads where that pays off.

/// Robots per task of a thread: enough to outweigh the overhead.
pub(crate) const ROBOTS_PER_TASK: usize = 1024;

/// Worlds with fewer robots are computed by one thread.
const FEW: usize = 2 * ROBOTS_PER_TASK;

/// A robot with beliefs takes as long as this number of robots without.
const BELIEFS_WEIGHT: usize = 32;

/// Whether threads should share the work of this number of robots.
pub(crate) fn is_worth_sharing(robots: usize, has_beliefs: bool) -> bool {
    let weight = if has_beliefs { BELIEFS_WEIGHT } else { 1 };
    robots * weight >= FEW && rayon::current_num_threads() > 1
}
