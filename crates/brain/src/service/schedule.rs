//! When a robot bids, reports and renews.

use crate::io::agent_id::AgentId;
use crate::io::goal_id::GoalId;
use crate::io::percept::Percept;
use alloc::vec::Vec;
use base::hashed::Hashed;

/// A bid is repeated after this time, because its lease counts from sending it, in seconds.
const BID_LIFE_S: f64 = 4.0;

/// Bids are computed again after this time, in seconds.
const BID_PERIOD_S: f64 = 1.0;

/// Time between two reports to a controller, in seconds.
const REPORT_PERIOD_S: f64 = 3.0;

/// A controller gets no reports if it has sent nothing for this time, in seconds.
const SILENCE_S: f64 = 30.0;

/// The robots of a team bid in turns: this many per step.
const BIDS_PER_STEP: u32 = 4;
const MAX_TURNS: u32 = 20;

/// What a robot knows of a controller.
#[derive(Debug, Clone, Hashed)]
pub(crate) struct Contact {
    pub(crate) id: AgentId,
    received_s: f64,
    next_report_s: f64,
    pub(crate) next_renewal_s: f64,
    /// Its last bid.
    pub(crate) bid: Option<StandingBid>,
}

/// A bid that stays valid until it is replaced.
#[derive(Debug, Clone, Copy, Hashed)]
pub(crate) struct StandingBid {
    pub(crate) goal: GoalId,
    pub(crate) call: u16,
    pub(crate) sent_s: f64,
    /// [`Jobs::version`](super::jobs::Jobs::version) of that time.
    pub(crate) jobs: u32,
}

impl StandingBid {
    /// Whether another one for a goal and call need not be sent.
    pub(crate) fn stands(&self, goal: GoalId, call: u16, jobs: u32, now_s: f64) -> bool {
        let is_same = self.goal == goal && self.call == call && self.jobs == jobs;
        is_same && now_s < self.sent_s + BID_LIFE_S
    }
}

/// The controllers that a robot has received messages from.
#[derive(Debug, Clone, Default, Hashed)]
pub(crate) struct Schedule {
    pub(crate) contacts: Vec<Contact>,
    steps: u32,
    /// Versions of offers and goals at the last bids, and when these were computed.
    bid_for: Option<([u32; 2], f64)>,
    /// Whether it bids in this step, as a controller that has awarded it a goal waits for its next bid.
    is_awaited: bool,
}

impl Schedule {
    /// Counts a step, and forgets silent controllers.
    pub(crate) fn advance(&mut self, now_s: f64) {
        self.steps = self.steps.wrapping_add(1);
        self.contacts
            .retain(|contact| now_s < contact.received_s + SILENCE_S);
    }

    /// Notes a message of a controller.
    pub(crate) fn note(&mut self, id: AgentId, now_s: f64) -> &mut Contact {
        let known = self.contacts.iter().position(|contact| contact.id == id);
        let index = known.unwrap_or_else(|| {
            self.contacts.push(Contact {
                id,
                received_s: now_s,
                next_report_s: now_s,
                next_renewal_s: now_s,
                bid: None,
            });
            self.contacts.len() - 1
        });
        let contact = &mut self.contacts[index];
        contact.received_s = now_s;
        contact
    }

    /// The last bid that a controller received.
    pub(crate) fn bid_of(&self, id: AgentId) -> Option<StandingBid> {
        self.contacts.iter().find(|contact| contact.id == id)?.bid
    }

    pub(crate) fn set_bid(&mut self, id: AgentId, bid: StandingBid) {
        let mut contacts = self.contacts.iter_mut();
        if let Some(contact) = contacts.find(|contact| contact.id == id) {
            contact.bid = Some(bid);
        }
    }

    /// A controller waits for the robot's next bid.
    pub(crate) fn await_bid(&mut self) {
        self.is_awaited = true;
    }

    /// Whether it is the robot's turn to bid, and offers or goals have changed or some time has passed.
    pub(crate) fn is_turn(&mut self, percept: &Percept, versions: [u32; 2], now_s: f64) -> bool {
        let turns = (percept.team_size / BIDS_PER_STEP).clamp(1, MAX_TURNS);
        let is_same =
            |(known, at_s): &([u32; 2], f64)| *known == versions && now_s < at_s + BID_PERIOD_S;
        let is_own = self.steps % turns == percept.id.index % turns;
        let is_turn = (is_own || self.is_awaited) && !self.bid_for.as_ref().is_some_and(is_same);
        self.is_awaited = false;
        if is_turn {
            self.bid_for = Some((versions, now_s));
        }
        is_turn
    }

    /// The controllers to which a report is due.
    pub(crate) fn due(&mut self, now_s: f64) -> impl Iterator<Item = AgentId> {
        self.contacts.iter_mut().filter_map(move |contact| {
            let is_due = now_s >= contact.next_report_s;
            if is_due {
                contact.next_report_s = now_s + REPORT_PERIOD_S;
            }
            is_due.then_some(contact.id)
        })
    }

    /// All known controllers get a report.
    pub(crate) fn report_to_all(&mut self, now_s: f64) {
        for contact in &mut self.contacts {
            contact.next_report_s = now_s;
        }
    }

    /// A controller requests a report.
    pub(crate) fn report_now(&mut self, id: AgentId, now_s: f64) {
        self.note(id, now_s).next_report_s = now_s;
    }
}
