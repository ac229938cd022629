//! The handover of a goal from its owner to the controller that owns it next.
//!
//! Each goal has at most one owner. A controller owns a goal while a majority of the controllers of its kind, itself
//! included, votes for it. A vote of another one is an ownership lease: its holder renews it, and the *voter* grants the
//! goal to no other controller before the lease has ended on its own clock. Two majorities have a member in common, so that
//! no two controllers own a goal. The members of a kind are those of the scenario, whether they work or not. (The votes of
//! an election as in Raft, Ongaro and Ousterhout 2014; leases as in Burrows 2006.)
//!
//! ```text
//! candidate or owner         voter
//!       -- Entrust (number) -->    it keeps the description, and votes if it has no vote for another
//!       <-- Entrusted (number) --  the duration of the lease, which counts from sending the request
//!       -- Renew -->
//!       <-- Renewed --             and so on
//!       -- Release -->             the vote is free again
//!       -- Ended -->               the goal has been served: the voter votes for no controller any more
//!       <-- Noted --
//! ```
//!
//! | state | leaves it when | next |
//! |---|---|---|
//! | `Candidate` | a majority votes for it | `Owner`: it awards the goal when the leases of the previous owner's robots have ended |
//! | | a candidate with a higher serial number requests its vote | kept |
//! | | no majority votes for it for a time | kept, and reported |
//! | `Owner` | its leases end, so that no majority votes for it | kept, and reported as lost |
//! | | the goal has been served | done: it informs the voters |
//! | kept ([`Kept`](super::ownership)), granted | the lease of the owner ends | kept, free |
//! | kept, free | another one requests the vote | granted |
//! | | after a time, shorter for higher serial numbers | `Candidate` |
//!
//! By [trade](super::trade), an owner transfers a goal without an assignee: it is the first voter for the next one. Where
//! controllers own goals alone (`backup = "none"`), a majority is the next owner and the previous one, until that is dismissed.
//!
//! A goal whose owner is lost is owned by the working controller in range with the highest serial number (Miller 1990), its
//! index in the kind, that a majority votes for. A controller that restarts does not know for which one it has voted: it votes
//! for none for the longest lease. n controllers survive the loss of (n - 1) / 2 of them, rounded down.

use base::hashed::Hashed;
use brain::AgentId;

/// A message without an answer is repeated after this time, in seconds.
pub(crate) const RETRY_S: f64 = 2.0;

/// A candidate without a majority lets others try after this time, and tries again after as much, in seconds.
pub(crate) const CANDIDACY_S: f64 = 10.0;

/// A voter whose owner is lost waits this time, in seconds, for each controller in range that comes first: those with
/// higher serial numbers, and the owner.
pub(crate) const TURN_S: f64 = 3.0;

/// The number of no request.
pub(crate) const NO_REQUEST: u32 = 0;

/// Whether a controller owns a goal, or requests that.
#[derive(Debug, Clone, Copy, PartialEq, Hashed)]
pub(crate) enum Role {
    /// It requests the votes of others.
    Candidate {
        since_s: f64,
        /// If it owns the goal before this time, no robot of a previous owner holds a lease of it: always for a goal that was
        /// issued to it, for a time after a transfer, and never if a previous owner was lost.
        free_until_s: f64,
    },
    /// A majority votes for it, as far as it knows.
    Owner,
}

impl Role {
    /// A candidate for a goal that others may have owned before.
    pub(crate) fn candidate(now_s: f64) -> Self {
        Self::Candidate {
            since_s: now_s,
            free_until_s: f64::NEG_INFINITY,
        }
    }
}

/// The vote of another controller for the owner of a goal, or for a candidate.
#[derive(Debug, Clone, Copy, PartialEq, Hashed)]
pub(crate) struct Vote {
    pub(crate) voter: AgentId,
    /// The number of the last request, and when it was sent first; minus infinity without one, or when its lease has ended.
    pub(crate) number: u32,
    pub(crate) requested_s: f64,
    /// When the next message is due; infinity while the voter votes for this controller, or knows that the goal has been served.
    pub(crate) next_s: f64,
}

impl Vote {
    /// A vote that has not been requested.
    pub(crate) fn new(voter: AgentId, now_s: f64) -> Self {
        Self {
            voter,
            number: NO_REQUEST,
            requested_s: f64::NEG_INFINITY,
            next_s: now_s,
        }
    }
}
