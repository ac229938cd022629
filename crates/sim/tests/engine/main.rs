//! The engine from outside: what a run may and may not do, whatever its scenario.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    clippy::cast_sign_loss,
    clippy::float_cmp,
    clippy::format_push_string,
    clippy::needless_for_each,
    clippy::panic,
    clippy::similar_names,
    clippy::unnecessary_wraps,
    clippy::unwrap_used,
    reason = "tests count, compare what is exact by construction, write scenarios, and may panic"
)]

mod battery;
mod change;
mod collisions;
mod common;
mod contact;
mod correct;
mod danger;
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
mod schemas;
mod sensors;
mod streams;
mod waiting;
