//! Whether a track is of several items that are too close to each other to be tracked apart, such as a mine among scrap.
//!
//! Their contacts are of one track, or of several tracks at one place whose contacts get mixed, and each kind alone explains
//! them badly. The numbers of contacts by the kind that they are reported as show how many items of which kinds there are:
//!
//! ```text
//! log likelihood of n = sum over j of A_j ln(L_j) - L_j      L_j = sum over kinds k of n_k X_kj
//! n_k    number of items of kind k
//! A_j    number of contacts that are reported as kind j
//! X_kj   number of contacts as kind j that one item of kind k gives in the same observations, in the mean
//! ```
//!
//! The numbers count as Poisson distributed, which is wider than their distribution is. An item that looks like another kind
//! counts as of that kind.

use crate::io::body::Detector;
use crate::io::work::lane::{HAS_ANOTHER, MARK_KINDS};
use alloc::vec;
use alloc::vec::Vec;
use base::hashed::Hashed;

/// Maximum number of items that are distinguished.
const MAX_ITEMS: usize = 3;

/// Contacts of a kind that no item explains, in the mean: without them, one false alarm would decide.
const STRAY: f64 = 1e-3;

/// What the contacts of a track show of a group of items.
#[derive(Debug, Clone, PartialEq, Hashed)]
pub(crate) struct Group {
    /// Number of contacts by the reported kind.
    contacts: Vec<f64>,
    /// Expected number of contacts of one item, by its kind and by the reported kind.
    of_one: Vec<f64>,
    /// For each kind, the probability that there are several items and that it is the one which matters.
    of_several: Vec<f64>,
    /// Expected number of items to be cleared that are left when one item is destroyed, whichever.
    further: f64,
}

/// An observation of a place.
pub(super) struct Observed<'o> {
    pub(super) detector: &'o Detector,
    pub(super) distance_m: f64,
    /// Probability that the place was in view.
    pub(super) in_view: f64,
    /// Share of each kind among all items.
    pub(super) shares: &'o [f64],
    /// The kinds of items that are to be cleared, one bit for each.
    pub(super) hazards: u8,
}

impl Group {
    /// Without contacts, for a number of kinds; `None` for more kinds than marks distinguish.
    pub(super) fn new(count: usize) -> Option<Self> {
        (count <= MARK_KINDS).then(|| Self {
            contacts: vec![0.0; count],
            of_one: vec![0.0; count * count],
            of_several: vec![0.0; count],
            further: 0.0,
        })
    }

    /// Takes an observation, with the kinds that its contacts of the group are reported as.
    pub(super) fn observe(&mut self, observed: &Observed, contacts: impl Iterator<Item = u16>) {
        let detector = observed.detector;
        for kind in 0..self.contacts.len() {
            let detected = detector.probability(kind, observed.distance_m) * observed.in_view;
            for reported in 0..self.contacts.len() {
                let place = kind * self.contacts.len() + reported;
                self.of_one[place] += detected * detector.reports(kind, reported);
            }
        }
        for kind in contacts {
            if let Some(count) = self.contacts.get_mut(usize::from(kind)) {
                *count += 1.0;
            }
        }
        self.weigh(observed.shares, observed.hazards);
    }

    /// Computes the probabilities of several items again.
    fn weigh(&mut self, shares: &[f64], hazards: u8) {
        let each = compositions(self.contacts.len());
        let weights = each.map(|numbers| (self.log_weight(shares, &numbers), numbers));
        let weights: Vec<(f64, [usize; MARK_KINDS])> = weights.collect();
        let highest = weights
            .iter()
            .fold(f64::NEG_INFINITY, |highest, (weight, _)| {
                highest.max(*weight)
            });
        self.of_several.fill(0.0);
        let (mut total, mut further) = (0.0, 0.0);
        for (weight, numbers) in weights {
            let weight = libm::exp(weight - highest);
            total += weight;
            let count = numbers.iter().sum::<usize>();
            if count > 1 {
                self.of_several[matters(&numbers, hazards)] += weight;
                let numbers = numbers.iter().enumerate();
                let to_clear = numbers.filter(|(kind, _)| hazards >> kind & 1 == 1);
                let to_clear: usize = to_clear.map(|(_, number)| number).sum();
                further += weight * float(to_clear) * (1.0 - 1.0 / float(count));
            }
        }
        for share in &mut self.of_several {
            *share /= total;
        }
        self.further = further / total;
    }

    /// Log likelihood of numbers of items, and their probability without contacts.
    fn log_weight(&self, shares: &[f64], numbers: &[usize; MARK_KINDS]) -> f64 {
        let (mut arrangements, mut count) = (1.0, 0.0);
        let mut log_prior = 0.0;
        for (kind, number) in numbers.iter().enumerate() {
            for index in 1..=*number {
                count += 1.0;
                arrangements *= count / float(index);
                log_prior += libm::log(shares[kind]);
            }
        }
        log_prior += libm::log(arrangements) + (count - 1.0) * libm::log(HAS_ANOTHER);
        let reported = self.contacts.iter().enumerate();
        let likelihood = reported.map(|(reported, contacts)| {
            let of_kinds = numbers.iter().enumerate().take(self.contacts.len());
            let of_kinds = of_kinds.map(|(kind, number)| {
                float(*number) * self.of_one[kind * self.contacts.len() + reported]
            });
            let expected = STRAY + of_kinds.sum::<f64>();
            contacts * libm::log(expected) - expected
        });
        log_prior + likelihood.sum::<f64>()
    }

    /// Expected number of items to be cleared that are left when one item is destroyed.
    pub(crate) fn further(&self) -> f64 {
        self.further
    }

    /// The log likelihood ratios of an item of each kind, with those of several items: such as contain an item that is to be
    /// cleared count as that. `alone` are those of one item.
    pub(crate) fn with_several(&self, shares: &[f64], alone: &mut [f64]) {
        let several: f64 = self.of_several.iter().sum();
        if several <= 0.0 {
            return;
        }
        let highest = alone.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let of = |kind: usize, ratio: f64| shares[kind] * libm::exp(ratio - highest);
        let any: f64 = (0..)
            .zip(&*alone)
            .map(|(kind, ratio)| of(kind, *ratio))
            .sum();
        for ((ratio, share), of_several) in alone.iter_mut().zip(shares).zip(&self.of_several) {
            if *share > 0.0 {
                let one = (1.0 - several) * libm::exp(*ratio - highest);
                *ratio = highest + libm::log(one + any * of_several / share);
            }
        }
    }
}

/// The numbers of items of each kind, of one to three items.
fn compositions(kinds: usize) -> impl Iterator<Item = [usize; MARK_KINDS]> {
    let base = MAX_ITEMS + 1;
    let all = 1..base.pow(u32::try_from(kinds).unwrap_or_default());
    let numbers = all.map(move |code| {
        let mut rest = code;
        core::array::from_fn(|_| {
            let number = rest % base;
            rest /= base;
            number
        })
    });
    numbers.filter(|numbers: &[usize; MARK_KINDS]| numbers.iter().sum::<usize>() <= MAX_ITEMS)
}

/// The kind that matters among several items: one that is to be cleared, or else the most frequent one.
fn matters(numbers: &[usize; MARK_KINDS], hazards: u8) -> usize {
    let rank = |kind: &usize| {
        (
            numbers[*kind] > 0 && hazards >> kind & 1 == 1,
            numbers[*kind],
        )
    };
    (0..MARK_KINDS).max_by_key(rank).unwrap_or_default()
}

#[expect(clippy::cast_precision_loss, reason = "a few items")]
fn float(number: usize) -> f64 {
    number as f64
}
