//! The engine from outside: what a run may and may not do, whatever its scenario.

mod battery;
mod change;
mod collisions;
mod common;
mod contact;
mod determinism;
mod golden;
mod judge;
mod layers;
mod meetings;
mod outside;
mod radio;
mod random;
mod robust;
mod sensors;
