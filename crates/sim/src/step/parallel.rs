//! Work for each robot, shared out over threads where that pays.

/// Robots that a thread takes at once: long enough to hide what that costs.
pub(crate) const ROBOTS_PER_TASK: usize = 1024;

/// Worlds of fewer robots are left to one thread.
const FEW: usize = 2 * ROBOTS_PER_TASK;

/// One with a agent takes as long as so many without.
const MIND: usize = 32;

/// Whether threads should share the work of so many robots, if any of them has a agent or none.
pub(crate) fn is_worth_sharing(robots: usize, has_beliefs: bool) -> bool {
    let weight = if has_beliefs { MIND } else { 1 };
    robots * weight >= FEW && rayon::current_num_threads() > 1
}
