//! The lane as a controller believes it to be.

mod kinds;

use super::coverage::Searched;
use super::lookalikes::Lookalikes;
use super::marks::Marks;
use super::place::{GONE, Place};
use super::remaining::{Beside, Known, Remaining, missed_share};
use super::risk::Risk;
use super::settings::Clearance;
use alloc::sync::Arc;
use alloc::vec;
use alloc::vec::Vec;
use base::geometry::Point;
use base::hashed::Hashed;
use brain::{AgentId, Coverage, HAS_ANOTHER, Lane, MARK_KINDS, Mark, MarkVerdict, Statement};
use core::f64::consts::TAU;
use core::ops::Range;

/// Probabilities of a mine are at most this: no mark is certain.
const MAX_PROBABILITY: f64 = 1.0 - 1e-9;

/// A mark that is farther from the lane than this, in deviations of its position, is not in it.
const BORDER_DEVIATIONS: f64 = 3.0;

/// Two marks of one item are at most this far apart, in metres, even if they are two places.
const NEAR_M: f64 = 1.5;

/// What a controller believes of a lane.
#[derive(Debug, Clone, Hashed)]
pub struct LanePicture {
    #[hashed(skip)]
    clearance: Arc<Clearance>,
    /// For each sensor model, the blind share of each kind, and what looks like another kind; for each kind of robots, its
    /// model.
    #[hashed(skip)]
    blind: Vec<[f64; MARK_KINDS]>,
    #[hashed(skip)]
    lookalikes: Vec<Option<Lookalikes>>,
    #[hashed(skip)]
    model_of_kind: Vec<usize>,
    searched: Searched,
    marks: Marks,
    /// Where items have been destroyed.
    beside: Vec<Beside>,
    /// What follows for each cell.
    #[hashed(skip)]
    remaining: Remaining,
}

/// A place that robots have marked, as a controller believes it to be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BelievedMark {
    /// Its number, which never changes.
    pub number: u32,
    /// Its position in the world.
    pub at: Point,
    /// Standard deviation of the position along each axis, in metres.
    pub deviation_m: f64,
    /// Probability of each kind of items; the rest is that of nothing.
    pub probabilities: [f64; MARK_KINDS],
    /// Probability that it holds a mine that has not been neutralised.
    pub mine: f64,
    /// The last statement about it.
    pub verdict: Option<MarkVerdict>,
    /// Number of charges that have gone off there and destroyed nothing.
    pub failed_charges: u32,
}

impl BelievedMark {
    /// Expected number of mines per square metre at a position.
    fn per_m2(&self, at: Point) -> f64 {
        let variance_m2 = self.deviation_m * self.deviation_m;
        let distance = self.at.to(at).length_squared() / (2.0 * variance_m2);
        self.mine * libm::exp(-distance) / (TAU * variance_m2)
    }

    /// Whether what has been marked may lie in a lane. A mine at the border may seem to be beyond it.
    pub(crate) fn may_be_in(&self, lane: &Lane) -> bool {
        lane.area().distance_m(self.at) <= BORDER_DEVIATIONS * self.deviation_m
    }
}

impl LanePicture {
    /// The picture before any message.
    #[must_use]
    pub fn new(clearance: Arc<Clearance>) -> Self {
        let models = clearance.models();
        let shares = models
            .iter()
            .map(|robot| core::array::from_fn(|kind| robot.blind_share_of(kind)));
        let lookalikes = models.iter();
        let lookalikes = lookalikes.map(|robot| Lookalikes::new(&robot.lookalike_share));
        let cells = clearance.lane.cells();
        let mut picture = Self {
            blind: shares.collect(),
            lookalikes: lookalikes.collect(),
            searched: Searched::new(models.len(), cells),
            marks: Marks::default(),
            beside: Vec::new(),
            remaining: Remaining::new(&clearance),
            model_of_kind: clearance.model_of_kind(),
            clearance,
        };
        picture.refresh(0..cells);
        picture
    }

    /// Computes the expected numbers of mines of some cells again.
    fn refresh(&mut self, cells: Range<usize>) {
        let known = Known {
            blind: &self.blind,
            searched: &self.searched,
            beside: &self.beside,
        };
        self.remaining.refresh(cells, &self.clearance, &known);
    }

    /// What is known of the lane and the robots.
    #[must_use]
    pub fn clearance(&self) -> &Clearance {
        &self.clearance
    }

    /// Takes what a robot has searched, unless some of its marks have not been received: the robot
    /// repeats both.
    pub fn take_coverage(&mut self, robot: AgentId, coverage: &Coverage) {
        let Some(model) = self.model_of(robot) else {
            return;
        };
        if self.marks.note_reported(robot, coverage.marks) {
            let changed = self.searched.take(robot, model, coverage);
            self.refresh(changed);
        }
    }

    /// Takes a mark of a robot; one that names another issuer has no effect.
    pub fn take_mark(&mut self, robot: AgentId, mark: &Mark) {
        let is_own = mark.id.issuer == robot.into() && self.model_of(robot).is_some();
        if is_own && mark.is_valid() {
            self.marks.take(*mark);
        }
    }

    /// Takes a statement of a robot about a mark.
    pub fn take_statement(&mut self, statement: &Statement) {
        if statement.at_m.into_iter().all(f32::is_finite) {
            let items: f64 = self.clearance.expected.iter().sum();
            let items_per_m2 = items / self.clearance.lane.area().area_m2();
            if let Some(place) = self.marks.state(statement, items_per_m2) {
                let cell = self.clearance.lane.nearest_cell(place.at);
                let shown = place.further();
                let shown =
                    shown.and_then(|(further, robot)| Some((further, self.model_of(robot)?)));
                let mines_per_m2 = self.clearance.mines() / self.remaining.free_m2;
                self.beside
                    .push(Beside::new(cell, mines_per_m2, shown, &self.searched));
                self.refresh(cell..cell + 1);
            }
        }
    }

    /// Number of marks that robots report and that have not been received.
    #[must_use]
    pub fn missing_marks(&self) -> u32 {
        self.marks.missing()
    }

    /// The places that robots have marked, in the order of their numbers.
    pub fn marks(&self) -> impl Iterator<Item = BelievedMark> {
        self.marks.places.iter().map(|place| self.believed(place))
    }

    /// The numbers of these places, and the last statement about each.
    pub fn mark_verdicts(&self) -> impl Iterator<Item = (u32, Option<MarkVerdict>)> {
        let places = self.marks.places.iter();
        places.map(|place| (place.number, place.verdict))
    }

    /// Expected number of mines in a cell without a mark.
    #[must_use]
    pub fn unmarked(&self, cell: usize) -> f64 {
        self.remaining.now[cell]
    }

    /// For each of a number of tiles, the expected number of mines without a mark that one more search in a way finds.
    pub(crate) fn gains(&self, way: u8, tiles: usize) -> Vec<f64> {
        let mut gains = vec![0.0; tiles];
        let remaining = &self.remaining;
        let after = remaining.after.get(usize::from(way));
        let each = remaining.now.iter().zip(after.into_iter().flatten());
        for ((now, after), tile) in each.zip(&remaining.tiles) {
            if let Some(gain) = gains.get_mut(*tile as usize) {
                *gain += now - after;
            }
        }
        gains
    }

    /// The part of the believed density of mines at a position that is that of marks.
    ///
    /// If the density is right, the mines that are left, weighted by it, are as many as are expected at marks.
    #[must_use]
    pub fn share_of_marks(&self, at: Point) -> f64 {
        let lane = self.clearance.lane;
        let cell = lane.nearest_cell(at);
        let unmarked = self.unmarked(cell) / lane.cell_area(cell).area_m2();
        let marked: f64 = self.marks().map(|mark| mark.per_m2(at)).sum();
        if marked > 0.0 {
            marked / (marked + unmarked)
        } else {
            0.0
        }
    }

    /// The probability that at least one mine is left in the lane.
    #[must_use]
    pub fn risk(&self) -> Risk {
        let lane = self.clearance.lane;
        self.risk_with(self.marks().filter(|mark| mark.may_be_in(&lane)))
    }

    /// The same, with the marks that may be in the lane.
    pub(crate) fn risk_with(&self, marks: impl Iterator<Item = BelievedMark>) -> Risk {
        let unmarked = self.remaining.now.iter().sum();
        Risk::new(unmarked, marks.map(|mark| mark.mine))
    }

    fn model_of(&self, robot: AgentId) -> Option<usize> {
        self.model_of_kind.get(usize::from(robot.kind)).copied()
    }

    fn believed(&self, place: &Place) -> BelievedMark {
        let probabilities = self.probabilities(place);
        let is_open = !place.is_neutralised();
        let hazards = self.clearance.hazards().filter(|_| is_open);
        let mine: f64 = hazards.map(|(kind, _)| probabilities[kind]).sum();
        let mine = (mine * place.is_left()).min(MAX_PROBABILITY);
        let missed = self.missed_by_charges(place);
        BelievedMark {
            number: place.number,
            at: place.at,
            deviation_m: libm::sqrt(place.variance_m2),
            probabilities,
            mine: mine * missed / (mine * missed + 1.0 - mine),
            verdict: place.verdict,
            failed_charges: place.failed_charges(),
        }
    }

    /// Probability that all charges that have failed at a place missed an item there.
    fn missed_by_charges(&self, place: &Place) -> f64 {
        let deviation_m = libm::sqrt(place.variance_m2);
        let charge = self.clearance.neutralise;
        let missed = charge.map_or(1.0, |charge| charge.missed(deviation_m));
        libm::pow(missed, place.failed_charges().into())
    }

    /// Probability of each kind of items at a place, against nothing but false alarms.
    fn probabilities(&self, place: &Place) -> [f64; MARK_KINDS] {
        let origins = self.origins(place).into_iter();
        let each = origins.map(|origin| {
            let odds: [f64; MARK_KINDS] =
                core::array::from_fn(|kind| self.log_odds(place, kind, &origin));
            (odds, self.contradiction(place, &origin))
        });
        let each: Vec<([f64; MARK_KINDS], f64)> = each.collect();
        let highest = each
            .iter()
            .fold(0.0, |highest: f64, (odds, contradiction)| {
                highest.max(odds.iter().copied().fold(0.0, f64::max) + contradiction)
            });
        let mut sums = [0.0; MARK_KINDS];
        let mut total = libm::exp(-highest);
        for (odds, contradiction) in &each {
            // It has been there, but is gone: what contradicts an item that is still there does not count.
            let is_contradicted = *contradiction > 0.0;
            for (sum, odds) in sums.iter_mut().zip(odds) {
                let still = libm::exp(odds - highest);
                let gone = GONE * libm::exp(odds + contradiction - highest);
                *sum += still;
                total += still + if is_contradicted { gone } else { 0.0 };
            }
        }
        sums.map(|sum| sum / total)
    }

    /// From what the marks of a place may come: for each, whether those of each sensor model are of the item. All of
    /// them are, or those of one model are false alarms, or of another item, beside one that the model has not detected.
    fn origins(&self, place: &Place) -> Vec<Vec<bool>> {
        let all = self.marked_models(place);
        let marked = (0..all.len()).filter(|model| all[*model]);
        let without = marked.clone().map(|model| {
            let mut others = all.clone();
            others[model] = false;
            others
        });
        let without = without.filter(|_| marked.clone().count() > 1);
        core::iter::once(all.clone()).chain(without).collect()
    }

    /// How often looks of robots without a mark miss an item that a robot of the same model has detected, in nats.
    fn contradiction(&self, place: &Place, detected: &[bool]) -> f64 {
        let robots = self.robots_in_agreement(place);
        let cell = self.clearance.lane.nearest_cell(place.at);
        let models = detected.iter().enumerate();
        let models = models.filter(|(_, has_detected)| **has_detected);
        let nats = models.map(|(model, _)| self.searched.nats_without(model, cell, &robots));
        nats.sum()
    }

    /// Log odds of a kind of items at a place, against nothing but false alarms, if some sensor models have detected
    /// it.
    ///
    /// An item that a sensor model has detected is one that it can detect; its robots agree on what it looks like. If the
    /// model has not, either all of its looks have missed the item, or the model is blind to it.
    fn log_odds(&self, place: &Place, kind: usize, detected: &[bool]) -> f64 {
        let area_m2 = self.remaining.free_m2;
        let expected = self.clearance.expected.get(kind).copied();
        let Some(expected) = expected.filter(|expected| *expected > 0.0) else {
            return f64::NEG_INFINITY;
        };
        let is_of_item = |mark: &Mark| {
            let model = self.model_of(mark.robot());
            model.is_some_and(|model| detected[model])
        };
        let cell = self.clearance.lane.nearest_cell(place.at);
        let robots = place.robots();
        let models = (0..self.blind.len()).zip(detected);
        let models = models.map(|(model, has_detected)| {
            let blind = self.blind[model][kind];
            if *has_detected {
                let nats = self.searched.nats_without(model, cell, &robots);
                libm::log(1.0 - blind) - nats + self.lookalike_log_ratio(place, kind, model)
            } else {
                let nats = self.searched.nats_without(model, cell, &[]);
                libm::log(missed_share(blind, libm::exp(-nats)))
            }
        });
        let of_marks_m2 = self.log_ratio_m2(place, kind, is_of_item);
        libm::log(expected / area_m2) + of_marks_m2 + models.sum::<f64>()
    }

    /// The log likelihood ratio of the marks of a place, as [`Place::log_ratio_m2`]: those that are not of the item are false
    /// alarms, or of another item beside it.
    fn log_ratio_m2(&self, place: &Place, kind: usize, is_of_item: impl Fn(&Mark) -> bool) -> f64 {
        let alone = place.log_ratio_m2(|mark| is_of_item(mark).then_some(kind));
        if place.marks.iter().all(&is_of_item) {
            return alone;
        }
        let expected = &self.clearance.expected;
        let items: f64 = expected.iter().sum();
        let beside = expected.iter().enumerate().map(|(other, expected)| {
            let kind_of = |mark: &Mark| Some(if is_of_item(mark) { kind } else { other });
            libm::log(HAS_ANOTHER * expected / items) + place.log_ratio_m2(kind_of)
        });
        let all: Vec<f64> = core::iter::once(alone).chain(beside).collect();
        log_sum(&all)
    }

    /// What the marks of a model add to the log odds of a kind, as an item of it may look like another kind.
    fn lookalike_log_ratio(&self, place: &Place, kind: usize, model: usize) -> f64 {
        let lookalikes = self.lookalikes[model].as_ref();
        lookalikes.map_or(0.0, |lookalikes| {
            let is_of_model = |mark: &Mark| self.model_of(mark.robot()) == Some(model);
            lookalikes.relative_log_ratio(kind, place.log_ratios(kind, is_of_model))
        })
    }

    /// Whether a robot of each model has marked a place.
    fn marked_models(&self, place: &Place) -> Vec<bool> {
        let mut marked = vec![false; self.blind.len()];
        for robot in place.robots() {
            if let Some(model) = self.model_of(robot) {
                marked[model] = true;
            }
        }
        marked
    }

    /// The robots whose looks do not contradict an item at a place: those that have marked it, or something
    /// that may be the same item.
    fn robots_in_agreement(&self, place: &Place) -> Vec<AgentId> {
        let within_m = NEAR_M.max(place.reach_m());
        let mut robots = self.marks.robots_near(place.at, within_m);
        robots.extend(place.robots());
        robots
    }
}

/// The logarithm of the sum of numbers, from their logarithms.
fn log_sum(logs: &[f64]) -> f64 {
    let highest = logs.iter().copied().fold(f64::MIN, f64::max);
    let sum: f64 = logs.iter().map(|log| libm::exp(log - highest)).sum();
    highest + libm::log(sum)
}
