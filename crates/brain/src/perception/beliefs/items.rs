//! Item tracks: estimated positions and the probability that each item exists.
//!
//! Each track has sources: for each robot that observed the item, the combined log likelihood ratio
//! of its observations and their number. [Reports](crate::messaging::reports) contain the same
//! values and may therefore arrive any number of times, by any route: of each source, only the
//! report with the most observations counts.
//!
//! ```text
//! log odds = prior log odds + sum over sources of their log likelihood ratios
//! a contact adds    ln(p N(d; S) / f)    p: probability of detection at that distance,
//! a miss adds       ln(1 - p)            N: normal density of the position error d,
//!                                        f: false alarms per m2; in full: [association]
//! a report counts   as t x its confidence + (1 - t) x the prior confidence,
//!                   t: trust in the sender, times trust in the observer if that is another robot
//! ```
//!
//! The prior follows from the density of items, and from the observations that did not detect
//! anything at that position.

mod association;
mod contact;
mod duplicates;
mod group;
pub(crate) mod kinds;
mod observations;
mod own_observation;
pub(crate) mod track;
pub(crate) mod track_set;
pub(crate) mod tracks;

pub(crate) use own_observation::{OwnObservation, density};
pub(crate) use tracks::Items;

#[cfg(test)]
pub(crate) mod tests;
