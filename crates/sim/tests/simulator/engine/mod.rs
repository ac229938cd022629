//! The engine through its public interface: properties of runs for scenarios of every kind.

mod battery;
mod change;
mod change_pending;
mod collision_warnings;
mod collisions;
mod contact;
mod correct;
mod dead_end;
mod determinism;
mod external;
mod external_decisions;
mod flocks;
mod footprints;
mod golden;
mod inspect;
mod judge;
mod layers;
mod links;
mod meetings;
mod periodic;
mod radio;
mod random;
mod robust;
mod sensors;
mod streams;
mod waiting;
