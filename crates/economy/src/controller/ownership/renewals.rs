//! Renewals of the leases under which a controller owns goals.

use super::Ownership;
use crate::controller::context::Context;
use alloc::vec::Vec;
use brain::{AgentId, Claim, Lease, LeaseMessage};

/// Leases are renewed when this part of their duration is left.
const RENEWED_AT: f64 = 2.0 / 3.0;

/// A renewal of an ownership lease without an answer is repeated after this time, in seconds.
pub const RENEWAL_RETRY_S: f64 = 0.5;

/// Maximum number of leases that are renewed one by one in a step.
const MAX_RENEWALS: usize = 16;

impl Ownership {
    /// Renews the leases of each backup.
    pub(super) fn renew_leases(&mut self, context: &mut Context) {
        let now_s = context.now_s;
        let leases = &mut context.ledger.leases;
        let is_due = |lease: &&Lease| lease.until_s - now_s < RENEWED_AT * lease.lasts_s;
        let due = leases.leases().iter().filter(is_due);
        let mut backups: Vec<AgentId> = due.map(|lease| lease.grantor).collect();
        backups.sort_unstable();
        backups.dedup();
        if now_s < self.next_renewal_s || backups.is_empty() {
            return;
        }
        self.next_renewal_s = now_s + RENEWAL_RETRY_S;
        for backup in backups {
            let number = context.numbers.draw();
            if let Some(renewal) = context.ledger.leases.renewal(backup, number) {
                let leases = &mut context.ledger.leases;
                leases.request(number, backup, None, now_s);
                context.send(backup, LeaseMessage::Renew(renewal));
            }
        }
    }

    /// The lists of leases differ: those that end first are renewed one by one.
    pub(super) fn renew_one_by_one(context: &mut Context, from: AgentId, number: u32) {
        let now_s = context.now_s;
        let leases = &mut context.ledger.leases;
        if !leases.differs(from, number) {
            return;
        }
        for Lease { goal, .. } in leases.ending_first(from, MAX_RENEWALS) {
            let number = context.numbers.draw();
            let leases = &mut context.ledger.leases;
            leases.request(number, from, Some(goal), now_s);
            context.send(from, LeaseMessage::RenewOne(Claim { goal, number }));
        }
    }
}
