//! Messages on their way.

use brain::{Heard, Message};
use std::collections::VecDeque;

/// Messages on their way, by the step in which they are heard.
#[derive(Debug, Clone, Default)]
pub(crate) struct RadioChannel {
    /// The next step first.
    due: VecDeque<Vec<Transmission>>,
    /// Emptied lists, to be used again.
    spare: Vec<Vec<Transmission>>,
    /// Receivers of a message; kept so that nothing is allocated.
    receivers: Vec<u32>,
}

/// A message on its way to one robot.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Transmission {
    pub(crate) to: u32,
    pub(crate) at: u64,
    pub(crate) heard: Heard,
}

/// A message that a robot sends, and its place among those that it sends in this step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Outgoing {
    pub(crate) from: u32,
    pub(crate) number: u32,
    pub(crate) message: Message,
}

impl RadioChannel {
    /// What is heard in this step, in the order in which it was sent.
    pub(crate) fn arrive(&mut self) -> Vec<Transmission> {
        self.due.pop_front().unwrap_or_default()
    }

    /// Takes back a list that `arrive` gave.
    pub(crate) fn reuse(&mut self, mut list: Vec<Transmission>) {
        list.clear();
        if list.capacity() > 0 {
            self.spare.push(list);
        }
    }

    /// Keeps what `is_kept`, which may change it.
    pub(crate) fn retain(&mut self, mut is_kept: impl FnMut(&mut Heard) -> bool) {
        for list in &mut self.due {
            list.retain_mut(|sent| is_kept(&mut sent.heard));
        }
    }

    /// Sends a message to the robots that `receivers` yields; it arrives `delay_steps` later, at least 1.
    pub(crate) fn send(
        &mut self,
        sent: Heard,
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
            heard: sent,
        }));
    }
}
