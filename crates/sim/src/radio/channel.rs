//! Messages in transit.

use super::arrivals::Arrivals;
use base::hash::Hash;
use base::hashed::Hashed;
use brain::{Message, ReceivedMessage};
use std::collections::VecDeque;

/// Messages in transit, by the step in which they arrive.
#[derive(Debug, Clone, Default)]
pub(crate) struct RadioChannel {
    /// The next step first.
    due: VecDeque<Vec<Transmission>>,
    /// Emptied lists, for reuse.
    spare: Vec<Vec<Transmission>>,
    /// Receivers of a message; kept so that nothing is allocated.
    receivers: Vec<u32>,
    /// Of the messages that arrive in a step, how many each participant has received, by its number.
    received: Vec<usize>,
    /// Scratch for participants that receive too many.
    pub(crate) arrivals: Arrivals,
}

/// A message in transit to one participant.
#[derive(Debug, Clone, Copy, Hashed)]
pub(crate) struct Transmission {
    /// The number of the receiver.
    pub(crate) to: u32,
    pub(crate) at: u64,
    pub(crate) message: ReceivedMessage,
}

/// A message that a participant sends, and its number among those that it sends in this step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Outgoing {
    /// The number of the sender.
    pub(crate) from: u32,
    pub(crate) number: u32,
    pub(crate) message: Message,
}

impl RadioChannel {
    /// The messages that arrive in this step, in the order in which they were sent.
    pub(crate) fn arrive(&mut self) -> Vec<Transmission> {
        self.due.pop_front().unwrap_or_default()
    }

    /// Counts a message that a participant receives in this step.
    pub(crate) fn count(&mut self, to: u32) {
        let to = to as usize;
        if self.received.len() <= to {
            self.received.resize(to + 1, 0);
        }
        self.received[to] += 1;
    }

    /// Takes the count of the messages that a participant has received in this step.
    pub(crate) fn take_count(&mut self, to: u32) -> usize {
        let count = self.received.get_mut(to as usize);
        count.map_or(0, std::mem::take)
    }

    /// Takes back a list that `arrive` returned.
    pub(crate) fn reuse(&mut self, mut list: Vec<Transmission>) {
        list.clear();
        if list.capacity() > 0 {
            self.spare.push(list);
        }
    }

    /// Adds the messages in transit to a hash; nothing if there are none.
    pub(crate) fn hash_messages(&self, hash: &mut Hash) {
        for (steps, list) in self.due.iter().enumerate() {
            if !list.is_empty() {
                steps.add_to(hash);
                list.add_to(hash);
            }
        }
    }

    /// Keeps the messages for which `is_kept` returns true; it may change them.
    pub(crate) fn retain(&mut self, mut is_kept: impl FnMut(&mut ReceivedMessage) -> bool) {
        for list in &mut self.due {
            list.retain_mut(|sent| is_kept(&mut sent.message));
        }
    }

    /// Sends a message to the participants that `receivers` yields; it arrives `delay_steps` later, at
    /// least 1.
    pub(crate) fn send(
        &mut self,
        sent: ReceivedMessage,
        (tick, delay_steps): (u64, u64),
        receivers: impl Iterator<Item = u32>,
    ) {
        let steps = usize::try_from(delay_steps - 1).unwrap_or(usize::MAX);
        while self.due.len() <= steps {
            self.due.push_back(self.spare.pop().unwrap_or_default());
        }
        self.receivers.clear();
        self.receivers.extend(receivers);
        self.receivers.sort_unstable();
        self.due[steps].extend(self.receivers.iter().map(|to| Transmission {
            to: *to,
            at: tick,
            message: sent,
        }));
    }
}
