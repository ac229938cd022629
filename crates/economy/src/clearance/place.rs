//! A place that robots have marked: their marks, fused.

use alloc::vec::Vec;
use base::geometry::Point;
use base::hashed::Hashed;
use brain::{AgentId, GoalId, MARK_KINDS, Mark, MarkVerdict};
use core::cmp::Reverse;
use core::f64::consts::TAU;

/// Marks belong to one place within this many joint standard deviations. With 3, one pair of marks of
/// the same item in ninety would be two places, of which one is never neutralised; with 4, one in 3,000.
const GATE: f64 = 4.0;

/// Error of the position of a statement, in metres: that of a robot's pose, and its distance.
const STATEMENT_M: f64 = 1.0;

/// Share of the items of which a robot has two marks.
const TWO_MARKS: f64 = 0.1;

/// Probability that an item that has been marked is gone without a statement: a vehicle has set it off.
pub(super) const GONE: f64 = 0.01;

/// Maximum number of marks of a place.
const MAX_MARKS: usize = 64;

/// A place with at least one mark.
#[derive(Debug, Clone, Hashed)]
pub(super) struct Place {
    /// Its number, which never changes.
    pub(super) number: u32,
    pub(super) marks: Vec<Mark>,
    /// The last statement about it; one that it has been neutralised is final.
    pub(super) verdict: Option<MarkVerdict>,
    /// The goals for which charges have gone off there and destroyed nothing.
    pub(super) missed: Vec<GoalId>,
    /// Mean of the positions, weighted by their precision, and its variance along each axis.
    pub(super) at: Point,
    pub(super) variance_m2: f64,
    /// Probability that its item, if there is one, is none of those that have been destroyed beside it.
    pub(super) is_other: f64,
}

impl Place {
    pub(super) fn new(number: u32, mark: Mark) -> Self {
        let mut place = Self {
            number,
            marks: Vec::new(),
            verdict: None,
            missed: Vec::new(),
            at: mark.at(),
            variance_m2: variance_m2(&mark),
            is_other: 1.0,
        };
        place.put(mark);
        place
    }

    /// Adds a mark, or replaces the one with the same id.
    pub(super) fn put(&mut self, mark: Mark) {
        self.marks.retain(|known| known.id != mark.id);
        self.marks.push(mark);
        self.fuse();
    }

    /// The place without a mark; `None` if that is its only one.
    pub(super) fn without(&self, mark: &Mark) -> Option<Self> {
        let mut place = self.clone();
        place.marks.retain(|known| known.id != mark.id);
        if place.marks.is_empty() {
            return None;
        }
        place.fuse();
        Some(place)
    }

    /// Takes a statement about a mark, or for a goal; one that it has been neutralised is final.
    pub(super) fn state(&mut self, verdict: MarkVerdict, of: GoalId) {
        if self.is_neutralised() {
            return;
        }
        self.verdict = Some(verdict);
        if verdict == MarkVerdict::Missed && !self.missed.contains(&of) {
            self.missed.push(of);
        }
    }

    /// The highest expected number of mines that are left there when one item has been destroyed, and the robot whose mark
    /// states it.
    pub(super) fn further(&self) -> Option<(f64, AgentId)> {
        let each = self.surest(|_| None);
        let each = each.map(|mark| (mark.further(), mark.robot()));
        each.max_by(|one, other| one.0.total_cmp(&other.0))
    }

    /// Whether what was there has been destroyed.
    pub(super) fn is_neutralised(&self) -> bool {
        self.verdict == Some(MarkVerdict::Neutralised)
    }

    /// Number of charges that have gone off there and destroyed nothing.
    pub(super) fn failed_charges(&self) -> u32 {
        u32::try_from(self.missed.len()).unwrap_or(u32::MAX)
    }

    /// Takes that the item of another place has been destroyed: that of this place may be the same one. The denser items
    /// are, the rather it is another one; a robot that has marked both seldom has two marks of one item.
    ///
    /// ```text
    /// odds of another item = density of items / (N(distance; variance of both places) x share of items with two marks)
    /// ```
    pub(super) fn note_destroyed(&mut self, other: &Self, items_per_m2: f64) {
        let is_of_both = |mark: &Mark| other.is_of(mark.robot());
        let joint_m2 = self.variance_m2 + other.variance_m2;
        let square = self.at.to(other.at).length_squared() / joint_m2;
        if square <= GATE * GATE {
            let has_two = self.marks.iter().any(is_of_both);
            let share = if has_two { TWO_MARKS } else { 1.0 };
            let same_per_m2 = share * libm::exp(-square / 2.0) / (TAU * joint_m2);
            self.is_other *= items_per_m2 / (items_per_m2 + same_per_m2);
        }
    }

    /// Probability that its item, if there was one, has not been destroyed, by what has been destroyed beside it and by
    /// the looks since then.
    pub(super) fn is_left(&self) -> f64 {
        let nats: f64 = self.surest(|_| None).map(Mark::missed_since_nats).sum();
        let least = if nats > 0.0 { GONE } else { 0.0 };
        let gone = (1.0 - self.is_other).max(least);
        let left = (1.0 - gone) * libm::exp(-nats);
        left / (left + gone)
    }

    /// Statements within this distance can be about it.
    pub(super) fn reach_m(&self) -> f64 {
        GATE * libm::sqrt(self.variance_m2) + STATEMENT_M
    }

    pub(super) fn holds(&self, mark: &Mark) -> bool {
        self.marks.iter().any(|known| known.id == mark.id)
    }

    /// The robots that have marked it.
    pub(super) fn robots(&self) -> Vec<AgentId> {
        self.marks.iter().map(Mark::robot).collect()
    }

    /// Distance of a mark in joint standard deviations, squared; `None` if it belongs to another place.
    pub(super) fn distance_to(&self, mark: &Mark) -> Option<f64> {
        let joint_m2 = self.variance_m2 + variance_m2(mark);
        let square = self.at.to(mark.at()).length_squared() / joint_m2;
        (self.marks.len() < MAX_MARKS && square <= GATE * GATE).then_some(square)
    }

    /// Whether a robot has a mark there.
    pub(super) fn is_of(&self, robot: AgentId) -> bool {
        self.marks.iter().any(|mark| mark.robot() == robot)
    }

    /// For each robot, the mark that is most probably of an item of the kind that it is of, or of any: of those that it still
    /// tracks, if there are any.
    fn surest(
        &self,
        kind_of: impl Fn(&Mark) -> Option<usize> + Clone,
    ) -> impl Iterator<Item = &Mark> + Clone {
        let is_surer = move |one: &Mark, other: &Mark| {
            let any = |mark: &Mark| mark.log_ratios.into_iter().fold(f32::MIN, f32::max);
            let strength =
                |mark: &Mark| kind_of(mark).map_or_else(|| any(mark), |kind| mark.log_ratios[kind]);
            let rank = |mark: &Mark| (Reverse(mark.missed_since), strength(mark), mark.id.number);
            rank(one) > rank(other)
        };
        self.marks.iter().filter(move |mark| {
            let mut rivals = self.marks.iter();
            !rivals.any(|one| one.robot() == mark.robot() && is_surer(one, mark))
        })
    }

    /// For each kind, the sum of the log likelihood ratios of those marks that `is_of_item` chooses: of the marks that are
    /// most probably of an item of a kind, as in [`log_ratio_m2`](Self::log_ratio_m2).
    pub(super) fn log_ratios(
        &self,
        kind: usize,
        is_of_item: impl Fn(&Mark) -> bool,
    ) -> [f64; MARK_KINDS] {
        let mut sums = [0.0; MARK_KINDS];
        for mark in self.surest(|_| Some(kind)).filter(|mark| is_of_item(mark)) {
            for (sum, ratio) in sums.iter_mut().zip(mark.log_ratios) {
                *sum += f64::from(ratio);
            }
        }
        sums
    }

    /// Log likelihood ratio of those marks that have a kind, for an item that looks like it and that all of their sensors can
    /// detect, integrated over the position, in square metres. Items of several kinds are at the same position.
    ///
    /// ```text
    /// integral of product exp(L_r - |x - x_r|^2 / 2 s_r^2) dx
    ///   = exp(sum L_r) x 2 pi s^2 x exp(-sum |x_0 - x_r|^2 / 2 s_r^2),  1 / s^2 = sum 1 / s_r^2
    /// ```
    pub(super) fn log_ratio_m2(&self, kind_of: impl Fn(&Mark) -> Option<usize>) -> f64 {
        let marks = self.surest(&kind_of);
        let marks = marks.filter_map(|mark| Some((mark, kind_of(mark)?)));
        let (at, joint_m2) = fused(marks.clone().map(|(mark, _)| mark));
        let each = marks.map(|(mark, kind)| {
            let away_m2 = at.to(mark.at()).length_squared();
            f64::from(mark.log_ratios[kind]) - away_m2 / (2.0 * variance_m2(mark))
        });
        libm::log(TAU * joint_m2) + each.sum::<f64>()
    }

    fn fuse(&mut self) {
        (self.at, self.variance_m2) = fused(self.surest(|_| None));
    }
}

/// Mean of the positions, weighted by their precision, and its variance along each axis.
fn fused<'m>(marks: impl Iterator<Item = &'m Mark>) -> (Point, f64) {
    let (mut precision, mut sum) = (0.0, Point::default());
    for mark in marks {
        let weight = 1.0 / variance_m2(mark);
        precision += weight;
        sum = sum.plus(mark.at().times(weight));
    }
    (sum.times(1.0 / precision), 1.0 / precision)
}

fn variance_m2(mark: &Mark) -> f64 {
    mark.deviation_m() * mark.deviation_m()
}
