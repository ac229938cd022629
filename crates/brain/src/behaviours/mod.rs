//! The behaviours, one per file: the keys in a scenario, the behaviour in a body, and the state that
//! each robot keeps for it.

mod avoid;
mod bayesian_search;
pub(crate) mod behaviour;
mod common;
mod correct;
mod cruise;
mod errands;
pub mod flock;
mod follow;
mod frontier;
mod goal_behaviour;
mod hold_position;
mod lawnmower;
mod navigate;
mod outlook;
mod part;
mod random_bounce;
mod return_home;
mod serve;
mod spiral;
mod survey;
mod turn;

pub use avoid::Avoid;
pub use bayesian_search::BayesianSearch;
pub use correct::Correct;
pub use cruise::Cruise;
pub use flock::Flock;
pub use follow::Follow;
pub use frontier::Frontier;
pub use hold_position::HoldPosition;
pub use lawnmower::Lawnmower;
pub use navigate::{Assignment, Navigate};
pub use random_bounce::RandomBounce;
pub use return_home::ReturnHome;
pub use serve::Serve;
pub use spiral::Spiral;

use crate::behaviours::behaviour::Behaviour;
use crate::goals::Verdict;
use crate::goals::orders::AssignedGoal;
use crate::goals::proposal::Proposal;
use crate::io::agent_id::AgentId;
use crate::io::body::Body;
use crate::io::command::{Command, Motion};
use crate::service::assignee::Assignee;
use crate::situation::Situation;
use alloc::vec::Vec;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// All behaviours: name in scenarios, file, and purpose. Each file has the type that scenarios
/// read, and `Ready` with its `new`.
macro_rules! behaviours {
    ($($(#[doc = $purpose:literal])+ $kind:ident in $file:ident;)+) => {
        /// A behaviour of a brain, and its parameters.
        #[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
        #[serde(tag = "kind", rename_all = "snake_case")]
        pub enum BehaviourSpec {
            $($(#[doc = $purpose])+ $kind($kind),)+
        }

        impl BehaviourSpec {
            /// Its name in scenarios.
            #[must_use]
            pub fn name(&self) -> &'static str {
                match self {
                    $(Self::$kind(_) => stringify!($file),)+
                }
            }

            /// Whether it needs a robot with beliefs.
            #[must_use]
            pub fn needs_beliefs(&self) -> bool {
                match self {
                    $(Self::$kind(_) => $file::Ready::NEEDS_BELIEFS,)+
                }
            }

            /// Whether it needs a robot with a position sensor and a compass.
            #[must_use]
            pub fn needs_pose(&self) -> bool {
                match self {
                    $(Self::$kind(_) => $file::Ready::NEEDS_POSE,)+
                }
            }

            /// Whether it needs a robot with an item detector.
            #[must_use]
            pub fn needs_detector(&self) -> bool {
                match self {
                    $(Self::$kind(_) => $file::Ready::NEEDS_DETECTOR,)+
                }
            }

            /// Whether it takes a person's orders.
            #[must_use]
            pub fn takes_orders(&self) -> bool {
                match self {
                    $(Self::$kind(_) => $file::Ready::TAKES_ORDERS,)+
                }
            }

            /// Whether it serves the goals of controllers.
            #[must_use]
            pub fn serves_controllers(&self) -> bool {
                match self {
                    $(Self::$kind(_) => $file::Ready::SERVES_CONTROLLERS,)+
                }
            }

            pub(crate) fn ready(&self, body: &Body) -> Ready {
                match self {
                    $(Self::$kind(spec) => Ready::$kind($file::Ready::new(spec, body)),)+
                }
            }
        }

        /// A behaviour in a body, the same for all robots of a kind.
        #[derive(Debug, Clone)]
        pub(crate) enum Ready {
            $($kind($file::Ready),)+
        }

        /// The state that a robot keeps for a behaviour.
        #[derive(Debug, Clone)]
        pub(crate) enum Memory {
            $($kind(<$file::Ready as Behaviour>::Memory),)+
        }

        impl Behaviour for Ready {
            type Memory = Memory;

            fn memory(&self) -> Memory {
                match self {
                    $(Self::$kind(ready) => Memory::$kind(ready.memory()),)+
                }
            }

            #[inline]
            fn hold_s(&self) -> f64 {
                match self {
                    $(Self::$kind(ready) => ready.hold_s(),)+
                }
            }

            fn serve_orders(&self, memory: &mut Memory, situation: &Situation) {
                match (self, memory) {
                    $((Self::$kind(ready), Memory::$kind(memory)) => {
                        ready.serve_orders(memory, situation)
                    })+
                    _ => {}
                }
            }

            fn assigned_goals(&self, memory: &Memory) -> Vec<AssignedGoal> {
                match (self, memory) {
                    $((Self::$kind(ready), Memory::$kind(memory)) => {
                        ready.assigned_goals(memory)
                    })+
                    _ => Vec::new(),
                }
            }

            fn communicate(&self, memory: &mut Memory, situation: &Situation) {
                match (self, memory) {
                    $((Self::$kind(ready), Memory::$kind(memory)) => {
                        ready.communicate(memory, situation)
                    })+
                    _ => {}
                }
            }

            fn publish(&self, memory: &mut Memory, command: &mut Command) {
                match (self, memory) {
                    $((Self::$kind(ready), Memory::$kind(memory)) => {
                        ready.publish(memory, command)
                    })+
                    _ => {}
                }
            }

            fn assignee<'m>(&self, memory: &'m Memory) -> Option<&'m Assignee> {
                match (self, memory) {
                    $((Self::$kind(ready), Memory::$kind(memory)) => ready.assignee(memory),)+
                    _ => None,
                }
            }

            fn renumber(
                &self,
                memory: &mut Memory,
                new_id: &dyn Fn(AgentId) -> Option<AgentId>,
            ) {
                match (self, memory) {
                    $((Self::$kind(ready), Memory::$kind(memory)) => {
                        ready.renumber(memory, new_id)
                    })+
                    _ => {}
                }
            }

            #[inline]
            fn triggered(&self, memory: &mut Memory, situation: &Situation) -> Option<Proposal> {
                match (self, memory) {
                    $((Self::$kind(ready), Memory::$kind(memory)) => {
                        ready.triggered(memory, situation)
                    })+
                    // A robot's memories are created from its behaviours, in their order.
                    _ => None,
                }
            }

            fn judged(&self, memory: &mut Memory, verdict: Verdict) {
                match (self, memory) {
                    $((Self::$kind(ready), Memory::$kind(memory)) => {
                        ready.judged(memory, verdict)
                    })+
                    _ => {}
                }
            }

            #[inline]
            fn held(&self) -> Motion {
                match self {
                    $(Self::$kind(ready) => ready.held(),)+
                }
            }

            fn idle(&self) -> Option<Motion> {
                match self {
                    $(Self::$kind(ready) => ready.idle(),)+
                }
            }

            #[inline]
            fn heading_rad(&self, memory: &Memory) -> Option<f64> {
                match (self, memory) {
                    $((Self::$kind(ready), Memory::$kind(memory)) => ready.heading_rad(memory),)+
                    _ => None,
                }
            }

            #[inline]
            fn suppressed(&self, memory: &mut Memory) {
                match (self, memory) {
                    $((Self::$kind(ready), Memory::$kind(memory)) => ready.suppressed(memory),)+
                    _ => {}
                }
            }
        }
    };
}

behaviours! {
    /// Moves straight ahead, always.
    Cruise in cruise;
    /// Turns towards the next waypoint when the heading is off.
    Correct in correct;
    /// Searches by random bounces: moves straight on, and at an obstacle turns to a random free
    /// heading.
    RandomBounce in random_bounce;
    /// Searches lane by lane; the team shares the lanes.
    Lawnmower in lawnmower;
    /// Searches in a spiral.
    Spiral in spiral;
    /// Searches at the nearest place that has not been observed.
    Frontier in frontier;
    /// Searches where the expected rate of detection is highest.
    BayesianSearch in bayesian_search;
    /// Follows another robot.
    Follow in follow;
    /// Holds a position.
    HoldPosition in hold_position;
    /// Returns to base before the battery is empty.
    ReturnHome in return_home;
    /// Visits waypoints, around known obstacles.
    Navigate in navigate;
    /// Serves the goals that controllers award.
    Serve in serve;
    /// Avoids what is too near.
    Avoid in avoid;
    /// Moves in a flock by separation, alignment and cohesion.
    Flock in flock;
}

impl BehaviourSpec {
    /// The distance within which it has reached a waypoint; `None` if it has no waypoints.
    #[must_use]
    pub fn within_m(&self) -> Option<f64> {
        match self {
            Self::Correct(correct) => Some(correct.within_m),
            Self::Navigate(navigate) => Some(navigate.within_m),
            _ => None,
        }
    }
}

#[cfg(test)]
mod example;
#[cfg(test)]
mod tests;
