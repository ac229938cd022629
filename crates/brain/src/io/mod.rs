//! The interface of a brain: what it receives, and what it returns.

pub(crate) mod act;
pub(crate) mod agent_id;
pub(crate) mod body;
pub(crate) mod command;
pub(crate) mod contract;
pub(crate) mod goal_id;
pub(crate) mod infinite;
pub(crate) mod lease;
pub(crate) mod message;
pub(crate) mod ownership;
pub(crate) mod percept;
pub(crate) mod random_words;
pub(crate) mod reason;
pub(crate) mod trade;
pub(crate) mod verdict;
pub(crate) mod work;
