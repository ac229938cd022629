//! When robots send what they send in each period: a radio receives only a limited number of messages at once.

use crate::io::agent_id::AgentId;

/// Offset between the phases of two kinds of robots, as a fraction of the period: multiples of the golden
/// ratio are spread evenly.
const KIND_PHASE: f64 = 0.618_033_988_749_894_9;

/// The phase of a robot within a period, 0 to 1: the robots of a kind are distributed evenly over its steps.
pub(crate) fn phase(own: AgentId, [period_s, step_s]: [f64; 2]) -> f64 {
    let count = libm::round(period_s / step_s).clamp(1.0, 1e9);
    let turns = f64::from(own.index) / count + KIND_PHASE * f64::from(own.kind);
    turns - libm::floor(turns)
}
