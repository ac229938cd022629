//! Robots that let their lease of a goal end in silence.
//!
//! Their bids for it do not count for a time: otherwise a robot that bids and never serves would be
//! awarded the goal again and again.

use alloc::vec::Vec;
use base::hashed::Hashed;
use brain::AgentId;

/// Bids do not count for this time, in seconds; each further lapse doubles it, up to a maximum.
const MIN_REST_S: f64 = 10.0;
const MAX_REST_S: f64 = 320.0;

/// Maximum number of robots; the one with the oldest lapse is forgotten first.
const MAX_ROBOTS: usize = 64;

/// The lapses of one goal.
#[derive(Debug, Clone, Default)]
pub(crate) struct Lapses(Vec<Lapse>);

#[derive(Debug, Clone, Copy, Hashed)]
struct Lapse {
    robot: AgentId,
    rest_s: f64,
    until_s: f64,
}

impl base::hashed::Hashed for Lapses {
    fn add_to(&self, hash: &mut base::hash::Hash) {
        self.0.add_to(hash);
    }
}

impl Lapses {
    /// Notes a lapse.
    pub(crate) fn add(&mut self, robot: AgentId, now_s: f64) {
        let known = self.0.iter().position(|lapse| lapse.robot == robot);
        let rest_s = known.map_or(MIN_REST_S, |place| {
            (2.0 * self.0.remove(place).rest_s).min(MAX_REST_S)
        });
        if self.0.len() == MAX_ROBOTS {
            self.0.remove(0);
        }
        self.0.push(Lapse {
            robot,
            rest_s,
            until_s: now_s + rest_s,
        });
    }

    /// Whether the bids of a robot count.
    pub(crate) fn may_bid(&self, robot: AgentId, now_s: f64) -> bool {
        let mut lapses = self.0.iter();
        !lapses.any(|lapse| lapse.robot == robot && now_s < lapse.until_s)
    }
}
