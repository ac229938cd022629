//! Tests of the beliefs of a lane against simulated lanes, without an engine.

#![expect(
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    clippy::cast_precision_loss,
    clippy::cast_sign_loss,
    reason = "small numbers"
)]
#![expect(clippy::float_cmp, reason = "the same numbers in the same order")]

mod calibration;
mod closed_forms;
mod marks;
mod passage;
mod plan;
mod simulated;
