//! Which messages a radio receives if more arrive in a step than it can receive.

use crate::sensors::pending::Pending;
use brain::{AgentId, ReceivedMessage};
use std::cmp::Reverse;

/// Scratch of the selection; kept so that nothing is allocated.
#[derive(Debug, Clone, Default)]
pub(crate) struct Arrivals {
    all: Vec<Arrival>,
}

/// One of the messages that arrive in a step. The order of the fields is the order of precedence.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Arrival {
    /// Messages to the receiver alone come first.
    is_addressed: Reverse<bool>,
    /// Then the first message of each sender, then the second of each, and so on.
    number: usize,
    /// Senders are in random order: a fixed one would always drop the same.
    draw: u32,
    /// Its place among the messages of the step.
    pub(crate) place: usize,
}

impl Arrivals {
    /// The messages that a radio receives of those that arrive in a step, in the order of their
    /// arrival: at most `maximum`. `draw` is a random word for each sender.
    pub(crate) fn select(
        &mut self,
        arrived: &[Pending<ReceivedMessage>],
        (own, maximum): (AgentId, usize),
        draw: impl Fn(AgentId) -> u32,
    ) -> &[Arrival] {
        self.all.clear();
        let mut previous = None;
        for (place, late) in arrived.iter().enumerate() {
            let from = late.what.from;
            // The messages of one sender follow each other.
            let number = previous
                .filter(|(sender, _)| *sender == from)
                .map_or(0, |(_, number)| number + 1);
            previous = Some((from, number));
            self.all.push(Arrival {
                is_addressed: Reverse(late.what.message.to.agent() == Some(own)),
                number,
                draw: draw(from),
                place,
            });
        }
        self.all.sort_unstable();
        self.all.truncate(maximum);
        self.all.sort_unstable_by_key(|arrival| arrival.place);
        &self.all
    }
}
