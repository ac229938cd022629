//! Queues of readings and messages that wait until the brain of a robot steps.

use base::hashed::Hashed;

/// A brain gets at most this number of the entries that arrived before a step; older ones are
/// dropped. So a brain that hardly ever steps, or never, fills no memory.
pub(crate) const MAX_PENDING: usize = 1000;

/// A queue for a brain, in the order of measurement.
#[derive(Debug, Clone)]
pub(crate) struct PendingQueue<T> {
    pub(crate) entries: Vec<Pending<T>>,
    /// At this length, old entries are dropped.
    full: usize,
}

/// A reading or message, and the step in which the robot has it.
#[derive(Debug, Clone, Copy, Hashed)]
pub(crate) struct Pending<T> {
    pub(crate) taken: u64,
    pub(crate) due: u64,
    pub(crate) what: T,
}

impl<T> Default for PendingQueue<T> {
    fn default() -> Self {
        Self {
            entries: Vec::new(),
            full: 2 * MAX_PENDING,
        }
    }
}

impl<T: Copy> PendingQueue<T> {
    /// Removes the entries that have arrived by now, and passes them to `give`.
    #[inline]
    pub(crate) fn deliver(&mut self, now: u64, mut give: impl FnMut(Pending<T>)) {
        let mut surplus = self.surplus(now);
        self.entries.retain(|late| {
            let is_due = late.due <= now;
            if is_due && surplus > 0 {
                surplus -= 1;
            } else if is_due {
                give(*late);
            }
            !is_due
        });
    }

    /// Drops entries that are too old, from time to time: the cost is proportional to what arrived.
    #[inline]
    pub(crate) fn forget(&mut self, now: u64) {
        if self.entries.len() < self.full {
            return;
        }
        let mut surplus = self.surplus(now);
        self.entries.retain(|late| {
            let is_too_old = late.due <= now && surplus > 0;
            surplus -= usize::from(is_too_old);
            !is_too_old
        });
        // Entries in transit stay, however many they are.
        self.full = 2 * self.entries.len().max(MAX_PENDING);
    }

    /// Number of arrived entries that are too old: never one that arrived in this step.
    #[inline]
    fn surplus(&self, now: u64) -> usize {
        if self.entries.len() <= MAX_PENDING {
            return 0;
        }
        let due = |by: u64| self.entries.iter().filter(|late| late.due <= by).count();
        let before = now.checked_sub(1).map_or(0, due);
        due(now).saturating_sub(MAX_PENDING).min(before)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wait(waiting: &mut PendingQueue<u64>, taken: u64, latency: u64, count: u64) {
        waiting.entries.extend((0..count).map(|number| Pending {
            taken,
            due: taken + latency,
            what: 1_000_000 * taken + number,
        }));
    }

    fn delivered(waiting: &mut PendingQueue<u64>, now: u64) -> Vec<u64> {
        let mut delivered = Vec::new();
        waiting.deliver(now, |late| delivered.push(late.what));
        delivered
    }

    #[test]
    fn the_newest_thousand_are_delivered_after_any_wait() {
        let mut waiting = PendingQueue::default();
        for now in 0..10_000 {
            waiting.forget(now);
            wait(&mut waiting, now, 0, 3);
            assert!(waiting.entries.len() <= 2 * MAX_PENDING + 3);
        }
        let delivered = delivered(&mut waiting, 10_000);
        assert_eq!(delivered.len(), MAX_PENDING);
        assert!(delivered.is_sorted());
        assert_eq!(delivered[MAX_PENDING - 1], 9_999_000_002);
        assert!(waiting.entries.is_empty());
    }

    #[test]
    fn entries_in_transit_are_never_discarded() {
        let mut waiting = PendingQueue::default();
        for now in 0..8000 {
            waiting.forget(now);
            wait(&mut waiting, now, 3000, 2);
        }
        // The first 5000 measurements have arrived, the others are in transit.
        assert_eq!(delivered(&mut waiting, 7999).len(), MAX_PENDING);
        assert_eq!(waiting.entries.len(), 2 * 3000);
        assert_eq!(
            delivered(&mut waiting, 8000),
            [5_000_000_000, 5_000_000_001]
        );
    }

    #[test]
    fn delivery_in_each_step_is_complete() {
        let mut waiting = PendingQueue::default();
        for now in 0..20 {
            wait(&mut waiting, now, 5, 3000);
            waiting.forget(now);
            let expected = if now < 5 { 0 } else { 3000 };
            assert_eq!(delivered(&mut waiting, now).len(), expected);
        }
    }
}
