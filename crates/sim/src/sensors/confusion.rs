//! The kind of item that a sensor reports for an item of another kind.

use base::noise::share;
use std::collections::BTreeMap;

/// A share or a probability of each kind, by kind.
pub(crate) type ConfusionSpec = BTreeMap<String, BTreeMap<String, f64>>;

/// The probabilities of a row sum to 1 up to this error.
pub(crate) const ROW_TOLERANCE: f64 = 1e-9;

/// The probability of each reported kind (column) by true kind (row), for all kinds of items.
pub(super) fn matrix(spec: &ConfusionSpec, kinds: &[String]) -> Vec<Vec<f64>> {
    let row = |kind: &String| {
        let given = spec.get(kind);
        let column = |reported: &String| match given {
            Some(row) => row.get(reported).copied().unwrap_or(0.0),
            None => f64::from(u8::from(reported == kind)),
        };
        kinds.iter().map(column).collect()
    };
    kinds.iter().map(row).collect()
}

/// What a sensor reports, converted for measurements.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Confusion {
    /// By true kind: reported kinds, each with the probability of all up to it; none for a kind that
    /// is reported as it is.
    rows: Vec<Vec<(f64, u16)>>,
}

impl Confusion {
    pub(super) fn new(spec: &ConfusionSpec, kinds: &[String]) -> Self {
        let cumulative = |row: &BTreeMap<String, f64>| {
            let mut sum = 0.0;
            let reported = (0..).zip(kinds).filter_map(|(number, kind)| {
                sum += row.get(kind).filter(|share| **share > 0.0)?;
                Some((sum, number))
            });
            reported.collect()
        };
        let rows = kinds.iter();
        Self {
            rows: rows
                .map(|kind| spec.get(kind).map_or_else(Vec::new, cumulative))
                .collect(),
        }
    }

    /// The kind that is reported for an item of a kind, by a random word.
    #[inline]
    pub(super) fn reported(&self, kind: u16, word: u32) -> u16 {
        let row = &self.rows[usize::from(kind)];
        let Some((_, last)) = row.last() else {
            return kind;
        };
        // The sum of a row may be less than 1 by rounding.
        let drawn = share(word);
        let mut reported = row.iter();
        let found = reported.find(|(sum, _)| drawn < *sum);
        found.map_or(*last, |(_, kind)| *kind)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kinds() -> Vec<String> {
        ["clutter", "mine", "rock"].map(str::to_owned).to_vec()
    }

    fn spec() -> ConfusionSpec {
        let row = [("mine".to_owned(), 0.75), ("rock".to_owned(), 0.25)];
        ConfusionSpec::from([("mine".to_owned(), BTreeMap::from(row))])
    }

    #[test]
    fn a_row_that_is_not_given_reports_the_true_kind() {
        let expected = [[1.0, 0.0, 0.0], [0.0, 0.75, 0.25], [0.0, 0.0, 1.0]];
        assert_eq!(matrix(&spec(), &kinds()), expected.map(Vec::from));
        let confusion = Confusion::new(&spec(), &kinds());
        assert_eq!(
            [0, u32::MAX].map(|word| confusion.reported(0, word)),
            [0, 0]
        );
    }

    #[test]
    fn a_kind_is_reported_for_its_share_of_the_words() {
        let confusion = Confusion::new(&spec(), &kinds());
        // Shares of 0, 0.7, 0.77 and 1.
        let words = [0, 3_000_000_000, 3_300_000_000, u32::MAX];
        let reported = words.map(|word| confusion.reported(1, word));
        assert_eq!(reported, [1, 1, 2, 2]);
    }
}
