//! Items that look like another kind to all sensors of a model.

use alloc::vec::Vec;
use brain::MARK_KINDS;

/// For one sensor model: the share of the items of each kind (row) that look like each kind (column).
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Lookalikes(Vec<[f64; MARK_KINDS]>);

impl Lookalikes {
    /// `None` without rows.
    pub(super) fn new(rows: &[Vec<f64>]) -> Option<Self> {
        let column = |row: &Vec<f64>, kind: usize| row.get(kind).copied().unwrap_or_default();
        let rows = rows.iter();
        let rows: Vec<_> = rows
            .map(|row| core::array::from_fn(|kind| column(row, kind)))
            .collect();
        (!rows.is_empty()).then_some(Self(rows))
    }

    /// The log likelihood ratio of the marks of the model for an item of a kind, relative to that of an item which looks
    /// like that kind, by the sums of their log ratios for what it may look like.
    ///
    /// ```text
    /// ln(sum over kinds a of share of kind k that looks like a x exp(sum of a - sum of k))
    /// ```
    pub(super) fn relative_log_ratio(&self, kind: usize, sums: [f64; MARK_KINDS]) -> f64 {
        let Some(row) = self.0.get(kind) else {
            return 0.0;
        };
        let seen = row.iter().zip(sums).filter(|(share, _)| **share > 0.0);
        let highest = seen.clone().map(|(_, sum)| sum);
        let highest = highest.fold(f64::NEG_INFINITY, f64::max);
        let mixed: f64 = seen
            .map(|(share, sum)| share * libm::exp(sum - highest))
            .sum();
        libm::log(mixed) + highest - sums[kind]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SUMS: [f64; MARK_KINDS] = [3.0, -20.0, 1.0, 0.0];

    fn lookalikes(rows: &[[f64; 3]]) -> Lookalikes {
        let rows: Vec<Vec<f64>> = rows.iter().map(|row| row.to_vec()).collect();
        Lookalikes::new(&rows).unwrap()
    }

    #[test]
    fn marks_are_weighted_by_what_an_item_may_look_like() {
        let lookalikes = lookalikes(&[[1.0, 0.0, 0.0], [0.1, 0.7, 0.2], [0.0, 0.0, 1.0]]);
        let each = [(0.1, 3.0_f64), (0.7, -20.0), (0.2, 1.0)];
        let enumerated: f64 = each.iter().map(|(share, sum)| share * sum.exp()).sum();
        let found = lookalikes.relative_log_ratio(1, SUMS) + SUMS[1];
        assert!((found - enumerated.ln()).abs() < 1e-12);
        assert!(lookalikes.relative_log_ratio(0, SUMS).abs() < 1e-12);
    }

    #[test]
    fn marks_of_a_kind_to_which_none_looks_alike_count_as_they_are() {
        assert_eq!(Lookalikes::new(&[]), None);
        let lookalikes = lookalikes(&[[0.0, 1.0, 0.0]]);
        let far = [-1e9, 700.0, 0.0, 0.0];
        assert!((lookalikes.relative_log_ratio(0, far) - (700.0 + 1e9)).abs() < 1e-3);
        assert!(lookalikes.relative_log_ratio(3, far).abs() < 1e-12);
    }
}
