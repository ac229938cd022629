//! What a robot bids: the increment of the shortest path through its goals.

use super::ability::{Ability, Moment};
use super::failures::Failures;
use super::jobs::Jobs;
use super::offers::Offer;
use super::reach::Reach;
use crate::goals::precedence::reachable_probability;
use crate::goals::tour::Tour;
use crate::io::dispatch::{Bid, Reason};

/// The basis of all bids of a step.
pub(crate) struct Bidder<'b> {
    ability: &'b Ability,
    failures: &'b Failures,
    moment: &'b Moment<'b>,
    now_s: f64,
    tour: Tour,
    reach: Reach<'b>,
    /// Time for all goals that it serves.
    busy_s: f64,
    is_full: bool,
}

/// A bid without its number.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Estimate {
    pub(crate) offer: Offer,
    time_s: f64,
    energy: f64,
    pub(crate) confidence: f64,
}

impl<'b> Bidder<'b> {
    /// `None` for a robot that does not know its position.
    pub(crate) fn new(
        ability: &'b Ability,
        (jobs, failures): (&Jobs, &'b Failures),
        moment: &'b Moment<'b>,
        now_s: f64,
    ) -> Option<Self> {
        let at = moment.at?;
        let tour = jobs.tour(at);
        let work_s = jobs.list.iter().map(|job| ability.work_s(&job.task));
        Some(Self {
            busy_s: work_s.sum::<f64>() + tour.length_m / ability.speed_m_s,
            is_full: jobs.list.len() >= ability.max_goals,
            ability,
            failures,
            moment,
            now_s,
            tour,
            reach: Reach::new(moment, at),
        })
    }

    /// The bid for an offer, or why there is none.
    pub(crate) fn estimate(&self, offer: &Offer) -> Result<Estimate, Reason> {
        let (task, ability) = (&offer.task, self.ability);
        if let Some(reason) = ability.lacks(task) {
            return Err(reason);
        }
        if self.failures.is_resting(task.id, self.now_s) || !self.reach.contains(task.at()) {
            return Err(Reason::Unreachable);
        }
        if self.is_full {
            return Err(Reason::Full);
        }
        let work_s = ability.work_s(task);
        let time_s = self.tour.increment_m(task.at()) / ability.speed_m_s + work_s;
        let all_s = self.busy_s + time_s;
        if self.moment.battery_s < all_s {
            return Err(Reason::Battery);
        }
        if self.now_s + self.arrival_s(offer) + work_s > offer.due_at_s {
            return Err(Reason::Deadline);
        }
        let reachable = reachable_probability(all_s, self.moment.battery_s);
        Ok(Estimate {
            offer: *offer,
            time_s,
            energy: self.energy(time_s),
            confidence: reachable * self.failures.confidence(task.id),
        })
    }

    /// Time until the robot would be there, at the latest.
    fn arrival_s(&self, offer: &Offer) -> f64 {
        let at = offer.task.at();
        let others_s = self.busy_s - self.tour.length_m / self.ability.speed_m_s;
        self.tour.arrival_m(at) / self.ability.speed_m_s + others_s
    }

    /// The part of the battery's capacity for a time; 0 if unknown.
    fn energy(&self, time_s: f64) -> f64 {
        let charge = self.moment.charge.unwrap_or(0.0);
        (charge * time_s / self.moment.battery_s).min(1.0)
    }
}

impl Estimate {
    /// Time divided by confidence and value: the less, the better.
    pub(crate) fn cost_s(&self) -> f64 {
        let value = f64::from(self.offer.task.value).max(1e-6);
        self.time_s / (self.confidence * value)
    }

    #[expect(clippy::cast_possible_truncation, reason = "messages are short")]
    pub(crate) fn bid(&self, number: u32) -> Bid {
        Bid {
            goal: self.offer.task.id,
            number,
            time_s: self.time_s as f32,
            energy: self.energy as f32,
            call: self.offer.call,
        }
    }
}
