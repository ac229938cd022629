//! Items that look like another kind to all sensors of a model.

use super::confusion::ConfusionSpec;
use super::sensor_frame::NoisePurpose;
use base::noise::{Noise, share};
use base::random::Entity;

/// The share of the items of each true kind (row) that look like each kind (column), for all kinds of
/// items; empty if all look like what they are.
pub(super) fn appearances(spec: &ConfusionSpec, kinds: &[String]) -> Vec<Vec<f64>> {
    let row = |kind: &String| {
        let given = spec.get(kind);
        let like = |other: &String| given.and_then(|row| row.get(other)).copied().unwrap_or(0.0);
        let others: f64 = kinds.iter().map(like).sum();
        let column = |other: &String| {
            if other == kind {
                (1.0 - others).max(0.0)
            } else {
                like(other)
            }
        };
        kinds.iter().map(column).collect()
    };
    let is_any = spec
        .values()
        .flat_map(|row| row.values())
        .any(|share| *share > 0.0);
    let rows = kinds.iter().filter(|_| is_any);
    rows.map(row).collect()
}

/// The items that look like another kind to all sensors of one model.
///
/// One draw per item, model and run decides, whichever robot looks and however often, as for
/// [blindness](super::blindness).
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Lookalikes {
    model: u32,
    /// By true kind: other kinds, each with the share of all up to it.
    rows: Vec<Vec<(f64, u16)>>,
}

impl Lookalikes {
    /// `None` if all items look like what they are.
    pub(super) fn new(model: u32, spec: &ConfusionSpec, kinds: &[String]) -> Option<Self> {
        let cumulative = |(kind, row): (usize, &Vec<f64>)| {
            let mut sum = 0.0;
            let others = (0..).zip(row).filter_map(|(number, share)| {
                let is_other = usize::from(number) != kind && *share > 0.0;
                sum += if is_other { *share } else { 0.0 };
                is_other.then_some((sum, number))
            });
            others.collect()
        };
        let shares = appearances(spec, kinds);
        let rows = shares.iter().enumerate().map(cumulative).collect();
        (!shares.is_empty()).then_some(Self { model, rows })
    }

    /// What items look like in one run.
    pub(super) fn in_run(&self, [seed, run]: [u64; 2]) -> Appearance<'_> {
        let model = Entity {
            kind: self.model,
            index: 0,
        };
        Appearance {
            rows: &self.rows,
            noise: Noise::of(seed, run, model),
        }
    }
}

/// What the items of one run look like to all sensors of one model.
pub(super) struct Appearance<'l> {
    rows: &'l [Vec<(f64, u16)>],
    noise: Noise,
}

impl Appearance<'_> {
    /// The kind that an item of a kind looks like.
    pub(super) fn of(&self, kind: u16, thing: Entity) -> u16 {
        let row = &self.rows[usize::from(kind)];
        if row.is_empty() {
            return kind;
        }
        // The first word of this purpose decides about blindness.
        let words = self.noise.words(
            NoisePurpose::Blindness as u32,
            u64::from(thing.kind) << 32,
            thing.index,
        );
        let drawn = share(words[1]);
        let mut others = row.iter();
        let found = others.find(|(sum, _)| drawn < *sum);
        found.map_or(kind, |(_, other)| *other)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    fn kinds() -> Vec<String> {
        ["clutter", "mine", "rock"].map(str::to_owned).to_vec()
    }

    fn spec(clutter: f64, rock: f64) -> ConfusionSpec {
        let row = [("clutter".to_owned(), clutter), ("rock".to_owned(), rock)];
        ConfusionSpec::from([("mine".to_owned(), BTreeMap::from(row))])
    }

    #[test]
    fn what_looks_like_no_other_kind_looks_like_what_it_is() {
        let expected = [[1.0, 0.0, 0.0], [0.25, 0.25, 0.5], [0.0, 0.0, 1.0]];
        assert_eq!(
            appearances(&spec(0.25, 0.5), &kinds()),
            expected.map(Vec::from)
        );
        assert!(appearances(&spec(0.0, 0.0), &kinds()).is_empty());
        assert_eq!(Lookalikes::new(1, &spec(0.0, 0.0), &kinds()), None);
    }

    /// With a correct draw, a share is off by 5.5 standard errors for one seed in 26 million.
    #[test]
    fn an_item_looks_like_another_kind_with_the_share_of_that_kind() {
        let lookalikes = Lookalikes::new(7, &spec(0.1, 0.2), &kinds()).unwrap();
        let appearance = lookalikes.in_run([1, 0]);
        let mut counts = [0.0_f64; 3];
        for index in 0..10_000 {
            let thing = Entity { kind: 3, index };
            counts[usize::from(appearance.of(1, thing))] += 1.0;
            assert_eq!(appearance.of(2, thing), 2);
        }
        for (count, share) in counts.into_iter().zip([0.1, 0.7, 0.2]) {
            let error = (share * (1.0 - share) / 10_000.0_f64).sqrt();
            assert!((count / 10_000.0 - share).abs() < 5.5 * error, "{counts:?}");
        }
    }
}
