//! Messages about the goals that controllers own and award to robots.
//!
//! `docs/economy.md` describes the protocol: which message answers which.

use super::agent_id::AgentId;
use super::goal_id::GoalId;
use super::lane::{Coverage, Lane, MAX_COORDINATE_M, Mark, Statement};
use super::verdict::Verdict;

use base::geometry::Point;
use base::hashed::Hashed;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A message about a goal that a controller owns or awards.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Dispatch {
    /// From the operator to a controller: a goal that it is to own from now on.
    Issue(Task),
    /// From a controller to all: it is present, and has this serial number.
    Serial(u32),
    /// From a controller to robots: a request of a report.
    Query {},
    /// From a robot to controllers: its state.
    Report(Report),
    /// From a robot to the owner of a goal that it serves: its progress.
    Fitness(Fitness),
    /// From a controller to robots: a goal that they can bid for. A call to one robot requests an
    /// answer, a bid or a refusal.
    Call {
        /// The number that the caller gave the offer; it is the same when the call is repeated.
        number: u16,
        /// The goal.
        task: Task,
    },
    /// From a robot to the caller: its best bid.
    Bid(Bid),
    /// From the owner to a bidder: it is to serve the goal.
    Award(Award),
    /// From the receiver of an award: it serves the goal.
    Commit(Claim),
    /// From a robot: it does not serve the goal, and no award or call of this number changes that. From a controller to
    /// the operator: it does not own the goal.
    Refuse(Refusal),
    /// From a robot to all, until its owner withdraws the goal: the goal has been served.
    Done(Claim),
    /// From a robot to the owner: it does not reach the goal. From a controller to the operator: no
    /// robot can serve the goal, or its owner has lost it.
    Stuck(Refusal),
    /// From a robot or an owner: its lease has ended.
    Release(Claim),
    /// From the operator to a controller: it has received what this reported of a goal.
    Acknowledge(GoalId),
    /// From the owner to all: the goal is no longer on offer, except to the robot whose bid has this number, if any has.
    /// To its assignee: it is to release it.
    Withdraw(Claim),
    /// From the holder of leases: a request to renew all that it has of the receiver.
    Renew(Renewal),
    /// The renewal of this number is granted.
    Renewed(u32),
    /// The lists of leases differ; the holder is to renew each one.
    Differs(u32),
    /// From the holder of a lease: a request to renew it.
    RenewOne(Claim),
    /// The renewal of a lease is granted.
    RenewedOne(Claim),
    /// From a controller to others: the position of a robot that they may not see.
    Seen(Seen),
    /// From an owner to another controller: it is to be the heir of a goal.
    Entrust(Task),
    /// The answer to it, and to a binding: it is ready to be the heir, and grants owner leases of this
    /// duration.
    Entrusted(Award),
    /// From an owner to its heir: a request to be the heir no longer.
    Relieve(Claim),
    /// The answer to it: it is no longer the heir.
    Relieved(Claim),
    /// From an heir that owns a goal to the previous owner: it can have it back.
    Restore(Task),
    /// From an owner to its heir: from now on, it owns the goal only while the heir renews its lease.
    /// The number is that of the answer to which it refers, the duration that of its longest service
    /// lease.
    Bind(Award),
    /// From an owner to its heir: a robot that has been awarded a goal. Of an inherited goal, only such
    /// a robot can report that it is done.
    Assigned(Assignment),
    /// From the operator to a robot: whether it is in service. Out of service, it releases its goals,
    /// bids for none, and refuses awards.
    Service(bool),
    /// From a controller to robots: a lane of which it needs coverage and marks.
    Lane(Lane),
    /// From a robot to controllers: what it has searched of the lane.
    Coverage(Coverage),
    /// From a robot to controllers: a place where it has detected something.
    Mark(Mark),
    /// From a robot to controllers: what it states about a mark.
    Statement(Statement),
    /// From a controller to others: the expected number of mines of a lane that its goals may still find or destroy.
    LaneGain(f32),
}

impl Dispatch {
    /// The goal that it describes, if it does.
    #[must_use]
    pub fn task(&self) -> Option<&Task> {
        match self {
            Self::Issue(task)
            | Self::Call { task, .. }
            | Self::Entrust(task)
            | Self::Restore(task) => Some(task),
            _ => None,
        }
    }

    /// Its rank among the messages of a step, which a radio sends until it has sent its maximum: 0 is first.
    ///
    /// 0: leases end early without it; 1: another agent waits for it, and it may not be repeated; 2: offers, which are
    /// repeated; 3: information.
    #[must_use]
    pub fn urgency(&self) -> u8 {
        match self {
            Self::Renew(_)
            | Self::Renewed(_)
            | Self::Differs(_)
            | Self::RenewOne(_)
            | Self::RenewedOne(_) => 0,
            Self::Call { .. } | Self::Bid(_) | Self::Entrust(_) | Self::Serial(_) => 2,
            Self::Query {}
            | Self::Report(_)
            | Self::Fitness(_)
            | Self::Seen(_)
            | Self::LaneGain(_) => 3,
            _ => 1,
        }
    }
}

/// A goal as it is described in messages.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(deny_unknown_fields)]
pub struct Task {
    /// Its id.
    pub id: GoalId,
    /// Its position in the world, in metres.
    pub at_m: [f32; 2],
    /// A robot is there within this distance; of a search or an interrogation, the radius of the area.
    pub radius_m: f32,
    /// Value of serving it, relative to other goals.
    pub value: f32,
    /// Time that a robot spends there.
    pub service_s: f32,
    /// Time from sending until its deadline; without one, `f32::MAX`.
    pub due_s: f32,
    /// What is to be done there.
    pub work: Work,
    /// Number of the capability that a robot needs for it, as in
    /// [`Body::capabilities`](crate::Body::capabilities); 0 if it needs none.
    pub capability: u8,
}

impl Task {
    /// Its position in the world.
    #[must_use]
    pub fn at(&self) -> Point {
        Point::from(self.at_m.map(f64::from))
    }

    /// Whether all of its numbers are finite and plausible.
    #[must_use]
    pub fn is_valid(&self) -> bool {
        let is_plausible = |number: f32| (0.0..=f32::MAX).contains(&number);
        let numbers = [self.value, self.service_s, self.due_s];
        let is_near = |along_m: f32| along_m.abs() <= MAX_COORDINATE_M;
        let is_wide = self.radius_m > 0.0 && self.radius_m <= MAX_COORDINATE_M;
        is_wide && self.at_m.into_iter().all(is_near) && numbers.into_iter().all(is_plausible)
    }
}

/// What a goal consists of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(rename_all = "snake_case")]
pub enum Work {
    /// To be there for the time of service.
    Visit,
    /// To search the area around it.
    Search,
    /// To look closer at a mark, and to confirm or reject it.
    Interrogate,
    /// To neutralise a confirmed mark.
    Neutralise,
}

impl Work {
    /// Whether a robot looks at, or acts on, an item that has been marked.
    pub(crate) fn is_at_item(self) -> bool {
        matches!(self, Self::Interrogate | Self::Neutralise)
    }
}

/// A goal, and the number of a request of the robot or controller that holds its lease.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(deny_unknown_fields)]
pub struct Claim {
    /// The goal.
    pub goal: GoalId,
    /// The number that the holder gave its request, which is different for each.
    pub number: u32,
}

/// The state of a robot.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(deny_unknown_fields)]
pub struct Report {
    /// Its position in the world, in metres.
    pub at_m: [f32; 2],
    /// The speed at which it drives to goals.
    pub speed_m_s: f32,
    /// Remaining fraction of the battery's capacity, 0 to 1.
    pub battery: f32,
    /// Number of goals that it serves, of all controllers.
    pub goals: u16,
    /// Number of goals that it can serve in addition: its free payload.
    pub payload: u16,
}

/// The progress of a robot towards a goal.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(deny_unknown_fields)]
pub struct Fitness {
    /// The goal.
    pub goal: GoalId,
    /// Its verdict.
    pub verdict: Verdict,
    /// Expected time until it has been served.
    pub remaining_s: f32,
}

/// A bid of a robot for a goal. The confidence of its message is the probability that it serves it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(deny_unknown_fields)]
pub struct Bid {
    /// The goal.
    pub goal: GoalId,
    /// The number that the robot gave the bid.
    pub number: u32,
    /// Time by which the robot's path and service become longer.
    pub time_s: f32,
    /// Time until it has served all of its goals and this one.
    pub total_s: f32,
    /// The same for the energy, as a fraction of the battery's capacity; 0 if unknown.
    pub energy: f32,
    /// The number of the call.
    pub call: u16,
}

/// The award of a goal, or the grant of its ownership.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(deny_unknown_fields)]
pub struct Award {
    /// The goal.
    pub goal: GoalId,
    /// The number of the bid or request.
    pub number: u32,
    /// Duration of the lease, from sending the bid or request, on the holder's clock.
    pub lease_s: f32,
}

/// A robot that has been awarded a goal.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(deny_unknown_fields)]
pub struct Assignment {
    /// The goal.
    pub goal: GoalId,
    /// The robot.
    pub robot: AgentId,
}

/// Why a robot or a controller does not serve a goal.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(deny_unknown_fields)]
pub struct Refusal {
    /// The goal.
    pub goal: GoalId,
    /// The number of the bid or of the lease; of a refused call, that of the call.
    pub number: u32,
    /// Why.
    pub reason: Reason,
}

/// Why a goal is not served.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(rename_all = "snake_case")]
pub enum Reason {
    /// No path leads there, or the robot does not come nearer.
    Unreachable,
    /// It lacks the capability.
    Capability,
    /// It would be too late.
    Deadline,
    /// The battery does not last.
    Battery,
    /// It serves the maximum number of goals.
    Full,
    /// The lease has ended, or is shorter than the service takes.
    Lease,
    /// It has been taken out of service.
    OutOfService,
    /// No robot is in range.
    NoRobot,
    /// Its owner has lost it: the heir did not renew the owner lease.
    Orphaned,
    /// No controller that could own it works.
    NoController,
    /// The robot does not know its position well enough.
    Position,
    /// Its numbers are impossible, such as a radius of 0.
    Invalid,
}

/// A request to renew all leases between two agents.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(deny_unknown_fields)]
pub struct Renewal {
    /// The number that the holder gave the request.
    pub number: u32,
    /// Number of leases.
    pub count: u16,
    /// Hash of the goals.
    pub hash: [u32; 2],
}

/// The position of a robot.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(deny_unknown_fields)]
pub struct Seen {
    /// The robot.
    pub robot: AgentId,
    /// Its position in the world, in metres.
    pub at_m: [f32; 2],
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::lane::MarkVerdict;
    use base::hash::Hash;

    #[test]
    fn a_dispatch_takes_at_most_44_bytes() {
        assert!(size_of::<Dispatch>() <= 44, "{}", size_of::<Dispatch>());
    }

    #[test]
    fn messages_that_differ_have_different_hashes() {
        let claim = Claim {
            goal: GoalId::default(),
            number: 7,
        };
        let lane = Lane {
            min_m: [0.0; 2],
            max_m: [20.0; 2],
            cell_m: 2.0,
            hazards: 1,
        };
        let coverage = Coverage {
            first: 0,
            marks: 0,
            missed: [0; 16],
            driven: [0; 16],
        };
        let mark = Mark {
            id: GoalId::default(),
            at_m: [0.0; 2],
            deviation_mm: 500,
            log_ratios: [0.0; 4],
            missed_since: 0,
            further: 0,
        };
        let hash = |dispatch: Dispatch| {
            let mut hash = Hash::default();
            dispatch.add_to(&mut hash);
            hash.value()
        };
        let all = [
            Dispatch::Query {},
            Dispatch::Serial(7),
            Dispatch::Renewed(7),
            Dispatch::Commit(claim),
            Dispatch::Done(claim),
            Dispatch::Done(Claim { number: 8, ..claim }),
            Dispatch::Lane(lane),
            Dispatch::Lane(Lane {
                cell_m: 3.0,
                ..lane
            }),
            Dispatch::Coverage(coverage),
            Dispatch::Coverage(Coverage {
                missed: [1; 16],
                ..coverage
            }),
            Dispatch::Mark(mark),
            Dispatch::Mark(Mark {
                log_ratios: [0.0, 0.0, 0.0, 1.0],
                ..mark
            }),
            Dispatch::Statement(Statement {
                mark: mark.id,
                at_m: [0.0; 2],
                verdict: MarkVerdict::Confirmed,
            }),
            Dispatch::Statement(Statement {
                mark: mark.id,
                at_m: [0.0; 2],
                verdict: MarkVerdict::Rejected,
            }),
            Dispatch::LaneGain(0.5),
            Dispatch::LaneGain(0.25),
        ];
        let mut hashes: Vec<u64> = all.into_iter().map(hash).collect();
        hashes.sort_unstable();
        hashes.dedup();
        assert_eq!(hashes.len(), all.len());
    }

    #[test]
    fn goals_with_absurd_numbers_are_invalid() {
        let task = Task {
            id: GoalId::default(),
            at_m: [1.0, 2.0],
            radius_m: 0.5,
            value: 1.0,
            service_s: 0.0,
            due_s: f32::MAX,
            work: Work::Visit,
            capability: 0,
        };
        assert!(task.is_valid());
        for absurd in [
            Task {
                at_m: [f32::NAN, 0.0],
                ..task
            },
            Task {
                at_m: [1e9, 0.0],
                ..task
            },
            Task {
                radius_m: 0.0,
                ..task
            },
            Task {
                value: -1.0,
                ..task
            },
            Task {
                service_s: f32::INFINITY,
                ..task
            },
            Task {
                due_s: f32::NAN,
                ..task
            },
        ] {
            assert!(!absurd.is_valid(), "{absurd:?}");
        }
    }
}
