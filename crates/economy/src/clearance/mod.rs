//! What a controller believes of a mined lane, by the messages of robots only.
//!
//! * [`settings`]: what it knows before: the lane, the prior, and the sensors of robots;
//! * [`coverage`]: what robots have searched; [`marks`]: what they have detected, fused by [`place`];
//! * [`lookalikes`]: items that look like another kind to all sensors of a model, whatever they mark;
//! * [`picture`]: all of this together; [`remaining`]: what follows for each cell; [`risk`]: the probability that at least one mine is left;
//! * [`cleared`]: the share of the mines of each kind that are cleared;
//! * [`plan`]: the goals that follow; [`declare`]: whether the lane is declared clear or given up.
//!
//! ```text
//! prior      the number of items of each kind in a part of the lane is Poisson distributed
//! coverage   of model m, the looks of its robots miss a visible item in cell c with exp(-n_mc)
//! unmarked   expected number in a cell = density x area x product over m of (b_m + (1 - b_m) exp(-n_mc))
//! marked     odds of kind k = density x product over m of its likelihood, integrated over the place
//! risk       1 - exp(-unmarked) x product over marks of (1 - P(mine))
//! ```
//!
//! The number of unmarked items does not depend on how many have been marked: marked and unmarked
//! items of a Poisson prior are independent. Models are blind to items independently of each other.

mod cleared;
mod coverage;
mod declare;
mod lookalikes;
mod marks;
mod picture;
mod place;
pub(crate) mod plan;
mod remaining;
mod risk;
mod settings;
#[cfg(test)]
mod tests;

pub use cleared::ClearedShare;
pub(crate) use declare::Decision;
pub use declare::LaneStatement;
pub use picture::{BelievedMark, LanePicture};
pub use risk::Risk;
pub use settings::{Charge, Clearance, RobotModel, Skill};
