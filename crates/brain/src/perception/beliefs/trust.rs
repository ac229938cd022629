//! How far others are trusted.

use crate::io::body::RobotId;
use alloc::vec::Vec;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// So many others are remembered; who was heard of first is forgotten first.
const MOST: usize = 64;

/// A report that is confirmed or refuted counts as much as one in so many that came before.
const BEFORE: f32 = 4.0;

/// Nobody acts on what he is told, or passes it on, if he trusts it less: it is more likely wrong than right.
pub(crate) const ENOUGH: f64 = 0.5;

/// How far a mind trusts what others tell.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct TrustSpec {
    /// In one of whom nothing is known yet, 0 to 1.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub initial: f64,
    /// Whether it changes when own looks confirm or refute reports.
    pub adaptive: bool,
}

impl Default for TrustSpec {
    fn default() -> Self {
        Self {
            initial: 0.9,
            adaptive: true,
        }
    }
}

/// Trust in each of the others: the mean of a beta distribution,
///
/// ```text
/// trust = (4 initial + confirmed) / (4 + confirmed + refuted)
/// ```
///
/// (Jøsang and Ismail, *The beta reputation system*, 2002).
///
/// Experience is with whoever told, his own looks or those of others: who passes something on answers for it,
/// and nobody's trust falls for what another says of him. Looks that are passed on count as
///
/// ```text
/// trust in the one who tells of them x trust in the one who took them
/// ```
///
/// So what is wrong by mistake counts against both its looker, where he tells it, and who passes it on, and
/// what is right counts for them alike: for each of them trust is the share of what he told that was right.
/// What counts no more than [`ENOUGH`] is acted on by nobody, as far as places to go to are concerned.
#[derive(Debug, Clone, Default)]
pub(crate) struct Trust {
    records: Vec<Record>,
}

#[derive(Debug, Clone)]
struct Record {
    of: RobotId,
    confirmed: f32,
    refuted: f32,
}

impl Trust {
    /// In a robot, 0 to 1.
    #[expect(clippy::cast_possible_truncation, reason = "kept short")]
    pub(crate) fn of(&self, robot: RobotId, spec: &TrustSpec) -> f64 {
        let initial = spec.initial as f32;
        let record = self.records.iter().find(|record| record.of == robot);
        record.map_or(spec.initial, |record| {
            let all = BEFORE + record.confirmed + record.refuted;
            f64::from((BEFORE * initial + record.confirmed) / all)
        })
    }

    /// Keeps what is known of those that `keep` has a number for.
    pub(crate) fn renumber(&mut self, keep: impl Fn(&mut RobotId) -> bool) {
        self.records.retain_mut(|record| keep(&mut record.of));
    }

    /// Notes that a robot's report was confirmed, or refuted.
    pub(crate) fn learn(&mut self, robot: RobotId, is_confirmed: bool, spec: &TrustSpec) {
        if !spec.adaptive {
            return;
        }
        let known = self.records.iter().position(|record| record.of == robot);
        let place = known.unwrap_or_else(|| {
            if self.records.len() == MOST {
                self.records.remove(0);
            }
            self.records.push(Record {
                of: robot,
                confirmed: 0.0,
                refuted: 0.0,
            });
            self.records.len() - 1
        });
        let record = &mut self.records[place];
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

    const LIAR: RobotId = RobotId { kind: 0, index: 3 };

    #[test]
    fn trust_falls_with_refuted_reports_and_rises_with_confirmed_ones() {
        let (mut trust, spec) = (Trust::default(), TrustSpec::default());
        assert!((trust.of(LIAR, &spec) - 0.9).abs() < 1e-6);
        (0..4).for_each(|_| trust.learn(LIAR, false, &spec));
        assert!((trust.of(LIAR, &spec) - 0.45).abs() < 1e-6);
        (0..8).for_each(|_| trust.learn(LIAR, true, &spec));
        assert!(trust.of(LIAR, &spec) > 0.7);
        assert!((trust.of(RobotId::default(), &spec) - 0.9).abs() < 1e-6);
    }

    #[test]
    fn who_does_not_learn_trusts_as_he_was_told() {
        let spec = TrustSpec {
            initial: 0.3,
            adaptive: false,
        };
        let mut trust = Trust::default();
        (0..9).for_each(|_| trust.learn(LIAR, true, &spec));
        assert!((trust.of(LIAR, &spec) - 0.3).abs() < 1e-6);
    }

    #[test]
    fn a_crowd_takes_bounded_memory() {
        let (mut trust, spec) = (Trust::default(), TrustSpec::default());
        for index in 0..1000 {
            trust.learn(RobotId { kind: 0, index }, false, &spec);
        }
        assert_eq!(trust.records.len(), MOST);
    }
}
