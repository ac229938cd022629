//! Trust in other robots.

use crate::io::agent_id::AgentId;
use crate::perception::beliefs::TrustSpec;
use alloc::vec::Vec;
use base::hashed::Hashed;

/// Maximum number of robots with a record; the oldest record is dropped first.
const MAX_RECORDS: usize = 64;

/// Weight of the initial trust, in reports.
const PRIOR_WEIGHT: f32 = 4.0;

/// Information with less trust is neither acted on nor relayed: it is more likely wrong than right.
pub(crate) const MIN_TRUST: f64 = 0.5;

/// Trust in each other robot: the mean of a beta distribution,
///
/// ```text
/// trust = (4 initial + confirmed) / (4 + confirmed + refuted)
/// ```
///
/// (Jøsang and Ismail, *The beta reputation system*, 2002).
///
/// The sender of a report is accountable for it, whether the observations are its own or relayed;
/// the trust in a robot never changes because of what another robot reports about it. Relayed
/// observations have the weight
///
/// ```text
/// trust in the sender x trust in the observer
/// ```
///
/// A wrong report therefore counts against the observer where it sent the report itself, and
/// against each robot that relayed it; a correct one counts for them in the same way. For each
/// robot, trust is the share of its reports that were correct. Positions and destinations with less
/// weight than [`MIN_TRUST`] are ignored.
#[derive(Debug, Clone, Hashed)]
pub(crate) struct Trust {
    spec: TrustSpec,
    records: Vec<Record>,
}

#[derive(Debug, Clone, Hashed)]
struct Record {
    id: AgentId,
    confirmed: f32,
    refuted: f32,
}

impl Trust {
    pub(crate) fn new(spec: &TrustSpec) -> Self {
        Self {
            spec: spec.clone(),
            records: Vec::new(),
        }
    }

    /// Returns the trust in a robot, 0 to 1.
    #[expect(clippy::cast_possible_truncation, reason = "stored as f32")]
    pub(crate) fn of(&self, robot: AgentId) -> f64 {
        let initial = self.spec.initial as f32;
        let record = self.records.iter().find(|record| record.id == robot);
        record.map_or(self.spec.initial, |record| {
            let weight = PRIOR_WEIGHT + record.confirmed + record.refuted;
            f64::from((PRIOR_WEIGHT * initial + record.confirmed) / weight)
        })
    }

    /// Renumbers the robots, and drops the records of those for which `keep` returns false.
    pub(crate) fn renumber(&mut self, keep: impl Fn(&mut AgentId) -> bool) {
        self.records.retain_mut(|record| keep(&mut record.id));
    }

    /// Records that a report of a robot was confirmed or refuted.
    pub(crate) fn learn(&mut self, robot: AgentId, is_confirmed: bool) {
        if !self.spec.adaptive {
            return;
        }
        let known = self.records.iter().position(|record| record.id == robot);
        let index = known.unwrap_or_else(|| {
            if self.records.len() == MAX_RECORDS {
                self.records.remove(0);
            }
            self.records.push(Record {
                id: robot,
                confirmed: 0.0,
                refuted: 0.0,
            });
            self.records.len() - 1
        });
        let record = &mut self.records[index];
        if is_confirmed {
            record.confirmed += 1.0;
        } else {
            record.refuted += 1.0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SENDER: AgentId = AgentId::robot(0, 3);

    #[test]
    fn trust_falls_with_refuted_reports_and_rises_with_confirmed_ones() {
        let mut trust = Trust::new(&TrustSpec::default());
        assert!((trust.of(SENDER) - 0.9).abs() < 1e-6);
        (0..4).for_each(|_| trust.learn(SENDER, false));
        assert!((trust.of(SENDER) - 0.45).abs() < 1e-6);
        (0..8).for_each(|_| trust.learn(SENDER, true));
        assert!(trust.of(SENDER) > 0.7);
        assert!((trust.of(AgentId::default()) - 0.9).abs() < 1e-6);
    }

    #[test]
    fn trust_that_is_not_adaptive_stays_at_its_initial_value() {
        let spec = TrustSpec {
            initial: 0.3,
            adaptive: false,
        };
        let mut trust = Trust::new(&spec);
        (0..9).for_each(|_| trust.learn(SENDER, true));
        assert!((trust.of(SENDER) - 0.3).abs() < 1e-6);
    }

    #[test]
    fn memory_is_bounded_for_any_number_of_robots() {
        let mut trust = Trust::new(&TrustSpec::default());
        for index in 0..1000 {
            trust.learn(AgentId::robot(0, index), false);
        }
        assert_eq!(trust.records.len(), MAX_RECORDS);
    }
}
