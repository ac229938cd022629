//! Renewals of leases.

use super::assignee::Assignee;
use super::holder::Lease;
use crate::io::agent_id::AgentId;
use crate::io::lease::{Claim, LeaseMessage};

/// Minimum time between two attempts to renew, in seconds.
const RETRY_S: f64 = 0.5;

/// Leases are renewed when this part of their duration is left.
const RENEWED_AT: f64 = 2.0 / 3.0;

/// Maximum number of leases that are renewed one by one in a step.
const MAX_RENEWALS: usize = 8;

impl Assignee {
    /// Renews the leases of each controller when a third of one has passed.
    pub(super) fn renew(&mut self) {
        for index in 0..self.schedule.contacts.len() {
            let contact = &self.schedule.contacts[index];
            let (id, next_s) = (contact.id, contact.next_renewal_s);
            let is_due = |lease: &Lease| {
                let is_own = lease.grantor == id;
                is_own && lease.until_s - self.now_s < RENEWED_AT * lease.lasts_s
            };
            if self.now_s < next_s || !self.holder.leases().iter().any(is_due) {
                continue;
            }
            let number = self.numbers.draw();
            if let Some(renewal) = self.holder.renewal(id, number) {
                self.holder.request(number, id, None, self.now_s);
                self.send(id, LeaseMessage::Renew(renewal));
                self.schedule.contacts[index].next_renewal_s = self.now_s + RETRY_S;
            }
        }
    }

    /// Renews the leases of a controller one by one, those that end first.
    pub(super) fn renew_each(&mut self, from: AgentId) {
        for Lease { goal, .. } in self.holder.ending_first(from, MAX_RENEWALS) {
            let number = self.numbers.draw();
            self.holder.request(number, from, Some(goal), self.now_s);
            self.send(from, LeaseMessage::RenewOne(Claim { goal, number }));
        }
    }
}
