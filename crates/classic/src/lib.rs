//! The grid simulator of M. Z. Williams, *Agent-Based Simulation of Robotic Systems* (Naval
//! Postgraduate School, Monterey, June 2003): bit-exact, and a fast form of it for studies.
//!
//! | to know | read |
//! |---|---|
//! | what the world is | [`world`], [`heading`], [`clock`] |
//! | what a robot does | [`robot`], `decision`, [`simulation`]: the *plain form*, rule by rule |
//! | when a run is over | [`contact`], [`search`](mod@search) |
//! | how a page steps and changes a run | [`run`] |
//! | how studies run it | [`fast`] (the same outcomes, tested), [`start`], [`replicate`](mod@replicate), [`runner`] |
//! | what scenarios say of it | [`scenario`] |
//! | what a trace holds | [`trace`](mod@trace) |

pub mod clock;
pub mod contact;
mod decision;
pub mod fast;
pub mod heading;
pub mod replicate;
pub mod robot;
pub mod run;
pub mod runner;
pub mod scenario;
pub mod search;
pub mod simulation;
pub mod start;
pub mod trace;
pub mod world;

pub use contact::Contact;
pub use fast::FastSearch;
pub use heading::Heading;
pub use replicate::replicate;
pub use robot::{Colour, Robot, Speed, Start};
pub use run::Run;
pub use runner::Configuration;
pub use search::{Outcome, Search, Task, search};
pub use simulation::Simulation;
pub use trace::trace;
