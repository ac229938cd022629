//! Probability of detection per measurement, by distance.

use base::document::Place;
use base::error::InputError;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A brain gets a bell curve as this number of straight pieces.
const CURVE_PARTS: u32 = 16;

/// Probability of detection per measurement.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Detection {
    /// The same at any distance in range.
    Constant(#[schemars(range(min = 0.0, max = 1.0))] f64),
    /// Pairs of distance (metres) and probability, by increasing distance; linear in between.
    Table(Vec<[f64; 2]>),
    /// A bell curve: `peak` at distance 0, half of that at `half_range_m`.
    Curve {
        /// Probability at distance 0.
        #[schemars(range(min = 0.0, max = 1.0))]
        peak: f64,
        /// Distance at which the probability is half the peak, in metres.
        #[schemars(range(min = 0.001, max = 10_000.0))]
        half_range_m: f64,
    },
}

impl Detection {
    /// Probability of detection at a distance.
    pub(super) fn probability(&self, distance_m: f64) -> f64 {
        match self {
            Self::Constant(probability) => *probability,
            Self::Table(pairs) => between(pairs, distance_m),
            Self::Curve { peak, half_range_m } => {
                let halves = distance_m / half_range_m;
                peak * libm::exp2(-halves * halves)
            }
        }
    }
}

impl Detection {
    /// Pairs of distance and probability, linear in between, up to `range_m`.
    pub(super) fn pairs(&self, range_m: f64) -> Vec<[f64; 2]> {
        match self {
            Self::Constant(probability) => vec![[0.0, *probability]],
            Self::Table(pairs) => pairs.clone(),
            Self::Curve { .. } => (0..=CURVE_PARTS)
                .map(|part| range_m * f64::from(part) / f64::from(CURVE_PARTS))
                .map(|at| [at, self.probability(at)])
                .collect(),
        }
    }
}

impl Detection {
    /// The error of a table that is not one, at its place in a document.
    pub(super) fn error(&self, at: &Place) -> Option<InputError> {
        let Self::Table(rows) = self else {
            return None;
        };
        let ascends = rows.windows(2).all(|pair| pair[0][0] < pair[1][0]);
        let is_fine = |[distance, probability]: &[f64; 2]| {
            *distance >= 0.0 && (0.0..=1.0).contains(probability)
        };
        let allowed = "at least one pair of a distance of at least 0 and a probability from 0 to 1, each \
                       distance above the one before";
        let is_right = !rows.is_empty() && ascends && rows.iter().all(is_fine);
        (!is_right).then(|| at.error(allowed))
    }
}

/// The value at `x`, linear between pairs; beyond the ends, that of the end.
fn between(pairs: &[[f64; 2]], x: f64) -> f64 {
    let next = pairs.partition_point(|[at, _]| *at <= x);
    match (next.checked_sub(1).map(|last| pairs[last]), pairs.get(next)) {
        (Some([x0, y0]), Some([x1, y1])) => y0 + (y1 - y0) * (x - x0) / (x1 - x0),
        (Some([_, y]), None) | (None, Some(&[_, y])) => y,
        (None, None) => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_detection_table_is_linear_between_its_pairs_and_flat_beyond() {
        let table = Detection::Table(vec![[1.0, 0.9], [2.0, 0.5], [4.0, 0.1]]);
        for (distance_m, expected) in [
            (0.0, 0.9),
            (1.0, 0.9),
            (1.5, 0.7),
            (2.0, 0.5),
            (3.0, 0.3),
            (4.0, 0.1),
            (99.0, 0.1),
        ] {
            let probability = table.probability(distance_m);
            assert!(
                (probability - expected).abs() < 1e-12,
                "{distance_m}: {probability}"
            );
        }
        let one = Detection::Table(vec![[1.0, 0.4]]);
        assert_eq!([0.0, 1.0, 2.0].map(|at| one.probability(at)), [0.4; 3]);
    }

    #[test]
    fn a_detection_curve_is_a_bell_curve_with_half_its_peak_at_the_half_range() {
        let curve = Detection::Curve {
            peak: 0.8,
            half_range_m: 1.5,
        };
        for (distance_m, expected) in [(0.0, 0.8), (1.5, 0.4), (3.0, 0.05), (4.5, 0.8 / 512.0)] {
            assert!(
                (curve.probability(distance_m) - expected).abs() < 1e-12,
                "{distance_m}"
            );
        }
    }

    #[test]
    fn a_constant_detection_does_not_depend_on_the_distance() {
        let constant = Detection::Constant(0.3);
        assert_eq!([0.0, 7.0].map(|at| constant.probability(at)), [0.3; 2]);
    }
}
