//! Work for each robot, shared out over threads where that pays.

use rayon::prelude::*;

/// Robots that a thread takes at once: long enough to hide what that costs.
pub(crate) const ROBOTS_PER_TASK: usize = 1024;

/// Worlds of fewer robots are left to one thread.
const FEW: usize = 2 * ROBOTS_PER_TASK;

/// Whether threads should share the work of so many robots.
pub(crate) fn is_worth_sharing(robots: usize) -> bool {
    robots >= FEW && rayon::current_num_threads() > 1
}

/// Does `work` for each entry, with its number; the order is not to matter.
pub(crate) fn share_out<T: Send>(
    entries: &mut [T],
    is_shared: bool,
    work: impl Fn(usize, &mut T) + Sync,
) {
    let task = |(number, entries): (usize, &mut [T])| {
        for (place, entry) in entries.iter_mut().enumerate() {
            work(number * ROBOTS_PER_TASK + place, entry);
        }
    };
    if is_shared {
        entries
            .par_chunks_mut(ROBOTS_PER_TASK)
            .enumerate()
            .for_each(task);
    } else {
        task((0, entries));
    }
}
