//! Ids of agents, and the receivers of messages.

use base::hash::Hash;
use base::hashed::Hashed;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// In hashes, the kind of persons, and that of all receivers: no scenario has that many kinds.
pub(super) const NO_KIND: u8 = u8::MAX;

/// What an agent is.
#[derive(
    Debug,
    Clone,
    Copy,
    Default,
    PartialEq,
    Eq,
    PartialOrd,
    Ord,
    Hash,
    Serialize,
    Deserialize,
    JsonSchema,
)]
#[serde(rename_all = "snake_case")]
pub enum AgentRole {
    /// A robot.
    #[default]
    Robot,
    /// A controller.
    Controller,
    /// A person: the operator.
    Person,
}

impl AgentRole {
    /// Its name in messages.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Robot => "robot",
            Self::Controller => "controller",
            Self::Person => "person",
        }
    }
}

/// The id of an agent: the `index`-th of its kind, both counted from 0.
#[derive(
    Debug,
    Clone,
    Copy,
    Default,
    PartialEq,
    Eq,
    PartialOrd,
    Ord,
    Hash,
    Serialize,
    Deserialize,
    JsonSchema,
)]
#[serde(deny_unknown_fields)]
pub struct AgentId {
    /// What it is; without it, a robot.
    #[serde(default, skip_serializing_if = "is_robot")]
    pub role: AgentRole,
    /// Index of the kind in the scenario, in which kinds of controllers are numbered after those of robots; 0 of
    /// persons.
    pub kind: u8,
    /// Index within the kind.
    pub index: u32,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "as serde calls it")]
fn is_robot(role: &AgentRole) -> bool {
    *role == AgentRole::Robot
}

impl AgentId {
    /// The person that issues goals and orders, and receives reports.
    pub const OPERATOR: Self = Self {
        role: AgentRole::Person,
        kind: 0,
        index: 0,
    };

    /// A robot of a kind.
    #[must_use]
    pub const fn robot(kind: u8, index: u32) -> Self {
        Self {
            role: AgentRole::Robot,
            kind,
            index,
        }
    }

    /// A controller of a kind, whose number is counted after those of robots.
    #[must_use]
    pub const fn controller(kind: u8, index: u32) -> Self {
        Self {
            role: AgentRole::Controller,
            kind,
            index,
        }
    }

    /// Whether it is a robot.
    #[must_use]
    pub fn is_robot(self) -> bool {
        self.role == AgentRole::Robot
    }

    /// Whether it is a controller.
    #[must_use]
    pub fn is_controller(self) -> bool {
        self.role == AgentRole::Controller
    }
}

impl Hashed for AgentId {
    /// Kinds of robots and controllers have different numbers, so that their role adds nothing.
    fn add_to(&self, hash: &mut Hash) {
        let kind = match self.role {
            AgentRole::Robot | AgentRole::Controller => self.kind,
            AgentRole::Person => NO_KIND,
        };
        (kind, self.index).add_to(hash);
    }
}

/// The agents that a message is for.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(from = "Option<AgentId>", into = "Option<AgentId>")]
pub enum Receiver {
    /// All that it reaches.
    #[default]
    All,
    /// One of them.
    Agent(AgentId),
}

impl Receiver {
    /// Whether a message is for all that it reaches.
    #[must_use]
    pub fn is_all(&self) -> bool {
        *self == Self::All
    }

    /// Whether an agent is a receiver.
    #[must_use]
    pub fn includes(self, id: AgentId) -> bool {
        match self {
            Self::All => true,
            Self::Agent(only) => only == id,
        }
    }

    /// The only receiver.
    #[must_use]
    pub fn agent(self) -> Option<AgentId> {
        self.into()
    }
}

impl From<AgentId> for Receiver {
    fn from(id: AgentId) -> Self {
        Self::Agent(id)
    }
}

impl From<Option<AgentId>> for Receiver {
    fn from(id: Option<AgentId>) -> Self {
        id.map_or(Self::All, Self::Agent)
    }
}

impl From<Receiver> for Option<AgentId> {
    fn from(receiver: Receiver) -> Self {
        match receiver {
            Receiver::All => None,
            Receiver::Agent(id) => Some(id),
        }
    }
}

impl Hashed for Receiver {
    fn add_to(&self, hash: &mut Hash) {
        match self {
            Self::All => (NO_KIND, u32::MAX).add_to(hash),
            Self::Agent(id) => id.add_to(hash),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_id_takes_eight_bytes_and_so_does_a_receiver() {
        assert_eq!([size_of::<AgentId>(), size_of::<Receiver>()], [8, 8]);
    }

    #[test]
    fn a_message_to_one_agent_is_for_no_other() {
        let [robot, controller] = [AgentId::robot(0, 1), AgentId::controller(0, 1)];
        assert!(Receiver::All.includes(robot) && Receiver::Agent(robot).includes(robot));
        assert!(!Receiver::Agent(robot).includes(controller));
    }
}
