//! The engine from outside: what a run may and may not do, whatever its scenario.

mod change;
mod collisions;
mod common;
mod contact;
mod meetings;
