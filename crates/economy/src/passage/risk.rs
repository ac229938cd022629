//! What the mines within the width of a path do to vehicles that drive over them one after the other.
//!
//! A mine destroys each vehicle over it with a probability d, independently; if it detonates, it is gone with that
//! vehicle. A vehicle that is destroyed stops, so that fewer vehicles arrive at what lies beyond. All that counts at a
//! mine is therefore how many vehicles arrive there before: let `h(n)` be the probability that the vehicle that arrives
//! as the `n`-th passes all that lies beyond. Back from the end of the path, where it is 1:
//!
//! ```text
//! over a mine that detonates   T h(n) = (1 - d)^n h(n) + (1 - (1 - d)^(n - 1)) h(n - 1)
//! over one that does not       T h(n) = (1 - d) x the mean of h(n - j), j destroyed of the n - 1 before: binomial
//! over a mine with a chance q  h <- (1 - q) h + q T h
//! over a Poisson number        h <- exp(mean x (T - 1)) h
//! ```
//!
//! Of the first vehicle, it follows that it is destroyed with 1 - exp(-mean d) x product over marks of (1 - q d). If
//! each mine is certain to destroy a vehicle, the n-th is destroyed if there are at least n mines.

use super::settings::MineEffect;
use alloc::vec;
use alloc::vec::Vec;
use brain::MARK_KINDS;

/// The path is divided into this many parts, in which mines without a mark are alike. It matters only where kinds of mines
/// have different effects; otherwise their order does not.
const PARTS: u32 = 64;

/// Largest mean of one series, and largest mean of all: with more mines, no vehicle passes.
const SERIES_MEAN: f64 = 16.0;
const MAX_MEAN: f64 = 4096.0;

/// Terms of a series are left out when they add less than this.
const NEGLIGIBLE: f64 = 1e-17;

/// The mines that are expected within the width of a path.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Contents {
    /// Expected number of those without a mark, of each kind.
    pub(super) unmarked: [f64; MARK_KINDS],
    /// For each mark, how far along the path it is, as a share, and the probability of a mine of each kind.
    pub(super) marks: Vec<(f64, [f64; MARK_KINDS])>,
}

impl Contents {
    /// Expected number of mines.
    pub(super) fn expected(&self) -> f64 {
        let marked = self.marks.iter().flat_map(|(_, mines)| mines);
        self.unmarked.iter().chain(marked).sum()
    }

    /// The probability that each of a number of vehicles is destroyed, in their order.
    pub(super) fn risks(&self, effects: &[MineEffect; MARK_KINDS], vehicles: u32) -> Vec<f64> {
        let mut passes = vec![1.0; vehicles as usize];
        for part in (0..PARTS).rev() {
            let kinds = self.unmarked.iter().zip(effects);
            for (expected, effect) in kinds.filter(|(expected, _)| **expected > 0.0) {
                effect.pass_poisson(expected / f64::from(PARTS), &mut passes);
            }
            let here = |along: f64| part_of(along) == part;
            for (_, mines) in self.marks.iter().filter(|(along, _)| here(*along)) {
                pass_mark(mines, effects, &mut passes);
            }
        }
        passes.into_iter().map(|passes| 1.0 - passes).collect()
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped"
)]
fn part_of(along: f64) -> u32 {
    (along.clamp(0.0, 1.0) * f64::from(PARTS)).min(f64::from(PARTS - 1)) as u32
}

/// Passes a mark at which there may be one mine.
fn pass_mark(mines: &[f64; MARK_KINDS], effects: &[MineEffect; MARK_KINDS], passes: &mut [f64]) {
    let none = 1.0 - mines.iter().sum::<f64>();
    let mut next: Vec<f64> = passes.iter().map(|passes| none * passes).collect();
    for (mine, effect) in mines.iter().zip(effects).filter(|(mine, _)| **mine > 0.0) {
        let over = effect.over(passes);
        let each = next.iter_mut().zip(over);
        each.for_each(|(next, over)| *next += mine * over);
    }
    passes.copy_from_slice(&next);
}

impl MineEffect {
    /// Passes a Poisson number of mines.
    ///
    /// The series is that of the mines over which something happens to one of the vehicles: then few vehicles over
    /// many mines that are nearly harmless take few terms.
    fn pass_poisson(&self, expected: f64, passes: &mut [f64]) {
        let vehicles = i32::try_from(passes.len()).unwrap_or(i32::MAX);
        let active = 1.0 - powi(1.0 - self.destroy_probability, vehicles);
        let mut left = (expected * active).min(MAX_MEAN);
        while left > 0.0 {
            let mean = left.min(SERIES_MEAN);
            left -= mean;
            let mut term = passes.to_vec();
            let mut weight = libm::exp(-mean);
            for passes in passes.iter_mut() {
                *passes *= weight;
            }
            let mut number = 1.0;
            while weight > NEGLIGIBLE || number <= mean {
                let over = self.over(&term);
                let each = term.iter_mut().zip(over);
                each.for_each(|(here, over)| *here += (over - *here) / active);
                weight *= mean / number;
                let sums = passes.iter_mut().zip(&term);
                sums.for_each(|(sum, term)| *sum += weight * term);
                number += 1.0;
            }
        }
    }

    /// Passes one mine.
    fn over(&self, passes: &[f64]) -> Vec<f64> {
        let safe = 1.0 - self.destroy_probability;
        if self.detonates {
            let mut unspent = 1.0;
            let mut before = 0.0;
            let each = passes.iter().map(|here| {
                let next = unspent * safe * here + (1.0 - unspent) * before;
                (unspent, before) = (unspent * safe, *here);
                next
            });
            return each.collect();
        }
        // The number of vehicles before that are destroyed: the binomial distribution grows by one vehicle at a time.
        let mut lost = vec![1.0];
        let each = (0..passes.len()).map(|vehicle| {
            let before = lost.iter().enumerate();
            let mean: f64 = before
                .map(|(lost, share)| share * passes[vehicle - lost])
                .sum();
            lost.push(0.0);
            for number in (0..lost.len()).rev() {
                let fewer = number.checked_sub(1).map_or(0.0, |fewer| lost[fewer]);
                lost[number] = lost[number] * safe + fewer * self.destroy_probability;
            }
            safe * mean
        });
        each.collect()
    }
}

/// A power by multiplication, which is the same on every machine.
fn powi(base: f64, exponent: i32) -> f64 {
    (0..exponent).fold(1.0, |power, _| power * base)
}
