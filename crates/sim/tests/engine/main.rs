//! The engine from outside: what a run may and may not do, whatever its scenario.

mod common;
mod contact;
