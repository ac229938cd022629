//! The handover of a goal from its owner to the controller that owns it next.
//!
//! Each goal has at most one owner. Its backup, the controller in range with the highest serial number (Miller 1990), holds
//! its description, and alone grants and renews the ownership lease of the owner:
//!
//! ```text
//! owner                      backup
//!       -- Entrust -->              it keeps the description
//!       <-- Entrusted --            with a number, and the duration of its leases
//!       -- Bind (number) -->        the owner's lease counts from sending this,
//!       <-- Entrusted --            the backup's wait from receiving it
//!       -- Renew -->
//!       <-- Renewed --              and so on
//! ```
//!
//! Before it sends `Bind`, the owner needs no lease: no backup waits for its end. From then on, only the backup's `Relieved`
//! ends that. If the lease ends, the backup owns the goal (failover), and awards it when the longest service lease of the
//! previous owner has ended, too; if the backup is lost as well, the ownership is lost. A backup that has taken over the goal
//! of a controller that is in range again returns it: it sends `Restore`, and the answer is `Bind`.
//!
//! States of the owner, in [`Handover`]:
//!
//! | state | leaves it when | next | sends |
//! |---|---|---|---|
//! | `Alone` | a peer is in range | `Offered` | `Entrust` |
//! | `Offered` | the peer answers `Entrusted` | `Bound` | `Bind` |
//! | | the goal is done, or another peer is to be the backup | `Alone` | |
//! | `Bound` | the goal is done, or another peer is to be the backup | `Relieving` | `Relieve` |
//! | `Bound`, `Relieving` | its lease ends | the ownership is lost | a report |
//! | `Relieving` | the backup answers `Relieved` within the lease | `Alone` | |
//! | `Alone`, after failover | the previous owner is in range, and no robot serves the goal | | `Restore` |
//! | | it answers `Bind` | a backup | `Entrusted` |
//! | ownership lost | the backup offers `Restore`, and grants a lease by `Entrusted` | `Bound` | `Bind` |
//! | | a robot reports that it has served the goal | done | |
//!
//! States of the backup ([`Kept`](super::ownership)): described (`Entrust` came), bound (`Bind` came: it waits for the end of
//! the lease), then relieved (`Relieve` came) or the owner (the lease has ended).

use base::hashed::Hashed;
use brain::AgentId;

/// A message without an answer is repeated after this time, in seconds.
pub(super) const RETRY_S: f64 = 2.0;

/// The same for one that binds to a backup.
const BINDING_RETRY_S: f64 = 0.5;

/// The state of the owner of a goal.
#[derive(Debug, Clone, Copy, PartialEq, Hashed)]
pub(super) enum Handover {
    /// The goal has no backup.
    Alone,
    /// A peer is to be the backup, and has not answered.
    Offered { backup: AgentId, next_s: f64 },
    /// The controller owns the goal only while the backup renews its lease.
    Bound {
        backup: AgentId,
        /// The number that the backup gave its answer, and whether it knows that it is bound.
        number: u32,
        is_confirmed: bool,
        next_s: f64,
    },
    /// The backup is to be released, and has not answered.
    Relieving { backup: AgentId, next_s: f64 },
}

/// What decides about the next state.
pub(super) struct Situation {
    pub(super) now_s: f64,
    pub(super) is_done: bool,
    /// The peer that is to be the backup.
    pub(super) best: Option<AgentId>,
    /// The previous owner of the goal, if it is in range again.
    pub(super) origin: Option<AgentId>,
}

/// What the owner sends.
pub(super) enum Action {
    Entrust(AgentId),
    Bind(AgentId, u32),
    Relieve(AgentId),
    Restore(AgentId),
}

impl Handover {
    /// The backup, if the controller owns the goal only under a lease of it.
    pub(super) fn bound(&self) -> Option<AgentId> {
        match self {
            Self::Bound { backup, .. } | Self::Relieving { backup, .. } => Some(*backup),
            Self::Alone | Self::Offered { .. } => None,
        }
    }

    /// From now on, the goal is owned only under a lease of a backup.
    pub(super) fn bind(&mut self, backup: AgentId, number: u32, now_s: f64) {
        *self = Self::Bound {
            backup,
            number,
            is_confirmed: false,
            next_s: now_s + BINDING_RETRY_S,
        };
    }

    /// The next state; returns what is to be sent now.
    pub(super) fn step(&mut self, now: &Situation) -> Option<Action> {
        let now_s = now.now_s;
        let is_due = |next_s: f64| now_s >= next_s;
        match *self {
            Self::Alone if now.is_done => None,
            Self::Alone => {
                if let Some(origin) = now.origin {
                    return Some(Action::Restore(origin));
                }
                let (backup, next_s) = (now.best?, now_s);
                *self = Self::Offered { backup, next_s };
                self.step(now)
            }
            Self::Offered { backup, .. } if now.is_done || now.best != Some(backup) => {
                *self = Self::Alone;
                None
            }
            Self::Offered { backup, next_s } if is_due(next_s) => {
                let next_s = now_s + RETRY_S;
                *self = Self::Offered { backup, next_s };
                Some(Action::Entrust(backup))
            }
            Self::Bound {
                backup,
                number,
                is_confirmed: false,
                next_s,
            } if is_due(next_s) => Some(Action::Bind(backup, number)),
            Self::Bound { backup, .. } if now.wants_another(backup) => {
                let next_s = now_s;
                *self = Self::Relieving { backup, next_s };
                self.step(now)
            }
            Self::Relieving { backup, next_s } if is_due(next_s) => {
                let next_s = now_s + RETRY_S;
                *self = Self::Relieving { backup, next_s };
                Some(Action::Relieve(backup))
            }
            Self::Offered { .. } | Self::Bound { .. } | Self::Relieving { .. } => None,
        }
    }
}

impl Situation {
    /// Whether a goal needs its backup no longer, or another one.
    fn wants_another(&self, backup: AgentId) -> bool {
        let is_better = self.best.is_some_and(|best| best > backup);
        self.is_done || self.origin.is_some_and(|origin| origin != backup) || is_better
    }
}
