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
    /// Renews the leases of each voter.
    pub(super) fn renew_leases(&mut self, context: &mut Context) {
        let now_s = context.now_s;
        if now_s < self.next_renewal_s {
            return;
        }
        let is_due = |lease: &Lease| lease.until_s - now_s < RENEWED_AT * lease.lasts_s;
        let voters = context.ledger.voters.iter();
        let due = voters.filter(|voter| voter.leases.leases().iter().any(is_due));
        let due: Vec<AgentId> = due.map(|voter| voter.id).collect();
        for voter in due {
            self.next_renewal_s = now_s + RENEWAL_RETRY_S;
            let number = context.numbers.draw();
            let leases = context.ledger.leases_of(voter);
            if let Some(renewal) = leases.renewal(voter, number) {
                leases.request(number, voter, None, now_s);
                context.send(voter, LeaseMessage::Renew(renewal));
            }
        }
    }

    /// The answer of a voter to renewals.
    pub(super) fn take_renewal(context: &mut Context, from: AgentId, message: LeaseMessage) {
        let now_s = context.now_s;
        let leases = context.ledger.leases_of(from);
        match message {
            LeaseMessage::Renewed(number) => {
                leases.renew(from, number, now_s);
                context.count_votes();
            }
            LeaseMessage::RenewedOne(claim) => {
                leases.renew_one(from, claim, now_s);
                context.count_votes_for(claim.goal);
            }
            LeaseMessage::Differs(number) => renew_one_by_one(context, from, number),
            LeaseMessage::Renew(_) | LeaseMessage::RenewOne(_) => {}
        }
    }
}

/// The lists of leases differ: those that end first are renewed one by one.
fn renew_one_by_one(context: &mut Context, from: AgentId, number: u32) {
    let now_s = context.now_s;
    let leases = context.ledger.leases_of(from);
    if !leases.differs(from, number) {
        return;
    }
    for Lease { goal, .. } in leases.ending_first(from, MAX_RENEWALS) {
        let number = context.numbers.draw();
        let leases = context.ledger.leases_of(from);
        leases.request(number, from, Some(goal), now_s);
        context.send(from, LeaseMessage::RenewOne(Claim { goal, number }));
    }
}
