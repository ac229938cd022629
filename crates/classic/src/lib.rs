//! The grid simulator of M. Z. Williams, *Agent-Based Simulation of Robotic Systems* (Naval
//! Postgraduate School, Monterey, June 2003): a bit-exact form, and a fast form for studies.
//!
//! | topic | modules |
//! |---|---|
//! | the world and time | [`world`], [`heading`], [`clock`] |
//! | the rules of a robot | [`robot`], `decision`, [`simulation`]: the *plain form* |
//! | finds and the end of a run | [`contact`], [`search`](mod@search) |
//! | runs that are stepped and changed | [`run`] |
//! | blocks of runs for studies | [`fast`] (tested to give the same outcomes), [`start`], [`runner`] |
//! | scenarios | [`scenario`] |

pub mod clock;
pub mod contact;
mod decision;
pub mod fast;
pub mod heading;
pub mod robot;
pub mod run;
pub mod runner;
pub mod scenario;
pub mod search;
pub mod simulation;
pub mod start;
pub mod world;

pub use contact::Contact;
pub use fast::FastSearch;
pub use heading::Heading;
pub use robot::{Colour, Robot, Speed, Start};
pub use run::Run;
pub use runner::Configuration;
pub use search::{Outcome, Search, Task, search};
pub use simulation::Simulation;
