//! Inspection of a brain: beliefs, goals and decisions, for pages, recordings and tests.

mod belief_state;
mod believed_map;
mod decision;
mod heading_options;

pub use belief_state::{BeliefState, GoalState};
pub use believed_map::BelievedMap;
pub use decision::Decision;
pub use heading_options::{HeadingOption, HeadingOptions};
