//! A radio that loses, delays, duplicates and reorders messages.

use base::random::{Entity, Purpose, Stream, stream};
use brain::{AgentId, Message, ReceivedMessage};

/// What the radio does to a message.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Weather {
    pub(crate) loss: f64,
    pub(crate) duplication: f64,
    /// The shortest delay, and how much longer one can be.
    pub(crate) min_delay_s: f64,
    pub(crate) max_delay_s: f64,
}

/// Messages that have been sent, and when they arrive.
pub(crate) struct Network {
    pub(crate) weather: Weather,
    random: Stream,
    sent: Vec<(f64, AgentId, ReceivedMessage)>,
}

/// A stream of random numbers.
pub(crate) fn random(seed: u64) -> Stream {
    stream(seed, 0, Entity { kind: 0, index: 0 }, Purpose::Start)
}

/// From 0 to 1.
pub(crate) fn unit(random: &mut Stream) -> f64 {
    f64::from(random.next_u32()) / 4_294_967_296.0
}

impl Network {
    pub(crate) fn new(weather: Weather, seed: u64) -> Self {
        Self {
            weather,
            random: random(seed),
            sent: Vec::new(),
        }
    }

    /// Sends a message of one agent to another, at a true time.
    pub(crate) fn send(&mut self, from: AgentId, to: AgentId, message: Message, now_s: f64) {
        if unit(&mut self.random) < self.weather.loss {
            return;
        }
        let copies = 1 + usize::from(unit(&mut self.random) < self.weather.duplication);
        for _ in 0..copies {
            // Most arrive soon, and some very late.
            let more = unit(&mut self.random).powi(4) * self.weather.max_delay_s;
            let delay = self.weather.min_delay_s + more;
            let received = ReceivedMessage {
                from,
                age_s: 0.0,
                message,
            };
            self.sent.push((now_s + delay, to, received));
        }
    }

    /// The messages that arrive at an agent by a true time.
    pub(crate) fn arrived(&mut self, to: AgentId, now_s: f64) -> Vec<ReceivedMessage> {
        let (arrived, waiting) = std::mem::take(&mut self.sent)
            .into_iter()
            .partition(|(at_s, receiver, _)| *receiver == to && *at_s < now_s);
        self.sent = waiting;
        let mut arrived: Vec<(f64, AgentId, ReceivedMessage)> = arrived;
        arrived.sort_by(|one, other| one.0.total_cmp(&other.0));
        arrived
            .into_iter()
            .map(|(_, _, received)| received)
            .collect()
    }
}
