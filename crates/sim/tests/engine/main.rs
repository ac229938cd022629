//! The engine from outside: what a run may and may not do, whatever its scenario.

mod change;
mod common;
mod contact;
mod meetings;
