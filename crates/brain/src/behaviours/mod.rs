//! The behaviours, one a file: what a scenario says of it, what that comes to in a body, and what a
//! robot remembers for it.

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
mod hold_position;
mod lawnmower;
mod navigate;
mod outlook;
mod part;
mod random_bounce;
mod return_home;
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
pub use spiral::Spiral;

use crate::behaviours::behaviour::Behaviour;
use crate::goals::Verdict;
use crate::goals::proposal::Proposal;
use crate::io::body::Body;
use crate::io::command::Motion;
use crate::perception::situation::Situation;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Each behaviour: its name in scenarios, its file, and what it is for. In the file are the type
/// that scenarios read, `Ready` with its `new`, and `Memory`.
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

            /// Whether it is of use only to a robot with a mind.
            #[must_use]
            pub fn needs_beliefs(&self) -> bool {
                match self {
                    $(Self::$kind(_) => $file::Ready::NEEDS_BELIEFS,)+
                }
            }

            /// Whether it is of use only to a robot that has a position sensor and a compass.
            #[must_use]
            pub fn needs_pose(&self) -> bool {
                match self {
                    $(Self::$kind(_) => $file::Ready::NEEDS_POSE,)+
                }
            }

            /// Whether it is of use only to a robot that recognises items.
            #[must_use]
            pub fn needs_detector(&self) -> bool {
                match self {
                    $(Self::$kind(_) => $file::Ready::NEEDS_DETECTOR,)+
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

        /// What a robot remembers for a behaviour.
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

            #[inline]
            fn triggered(&self, memory: &mut Memory, situation: &Situation) -> Option<Proposal> {
                match (self, memory) {
                    $((Self::$kind(ready), Memory::$kind(memory)) => {
                        ready.triggered(memory, situation)
                    })+
                    // A robot's memories are made of its behaviours, in their order.
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
    /// Goes ahead, always.
    Cruise in cruise;
    /// Turns to the course to the next of some places, when it is off it.
    Correct in correct;
    /// Searches by random bounces: straight on, and at an obstacle to a random free course.
    RandomBounce in random_bounce;
    /// Searches lane by lane, which the team shares.
    Lawnmower in lawnmower;
    /// Searches in a spiral.
    Spiral in spiral;
    /// Searches at the nearest place that nobody has looked at.
    Frontier in frontier;
    /// Searches where beliefs say most is to be found a second.
    BayesianSearch in bayesian_search;
    /// Follows another robot.
    Follow in follow;
    /// Stays at a place.
    HoldPosition in hold_position;
    /// Goes home before the battery is empty.
    ReturnHome in return_home;
    /// Visits places, around what is known to be in the way.
    Navigate in navigate;
    /// Gets out of the way of what is too near.
    Avoid in avoid;
    /// Goes with the others: keeps apart from them, takes their course, and stays with them.
    Flock in flock;
}

#[cfg(test)]
mod example;
#[cfg(test)]
mod tests;
