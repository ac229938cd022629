//! Calls for bids, and awards: a round awards what the rule of allocation chooses from all valid
//! bids.

use super::Controller;
use super::owned::Assigned;
use super::picture::Robot;
use crate::allocation::{Allocation, Market, Offer, Pair};
use alloc::vec::Vec;
use brain::{AgentId, Award, Claim, Dispatch, GoalId, Receiver, Task};

/// Maximum number of calls per step, and time after which a call is repeated, in seconds.
pub(crate) const CALLS_PER_STEP: usize = 2;
pub(crate) const REPEAT_S: f64 = 10.0;

/// An award without an answer is repeated after this time, in seconds, this many times.
const RETRY_S: f64 = 0.5;
const RETRIES: f64 = 10.0;

/// A robot should have served a goal after this multiple of the time that it bid, and more, in
/// seconds: it may serve others before.
const OVERDUE_FACTOR: f64 = 4.0;
const OVERDUE_S: f64 = 120.0;

impl Controller {
    /// Calls for bids for the goals on offer, those first that have waited longest.
    pub(super) fn call(&mut self) {
        if self.settings.allocation == Allocation::None || !self.may_grant() {
            return;
        }
        for _ in 0..CALLS_PER_STEP {
            let now_s = self.now_s;
            let due = self.goals.iter_mut();
            let due = due.filter(|owned| owned.is_on_offer(now_s) && now_s >= owned.next_call_s);
            let next = due.min_by(|one, other| one.next_call_s.total_cmp(&other.next_call_s));
            let Some(owned) = next else {
                return;
            };
            owned.called_s.get_or_insert(now_s);
            owned.next_call_s = now_s + REPEAT_S;
            let (number, task) = (owned.call, owned.task_at(now_s));
            self.send(Receiver::All, Dispatch::Call { number, task });
        }
    }

    /// Holds a round when it is due, and repeats awards without an answer.
    pub(super) fn award(&mut self) {
        self.repeat_awards();
        if !self.round.is_over(self.now_s + self.step_s / 2.0) || !self.may_grant() {
            return;
        }
        let goals = self.goals_of_round();
        let robots: Vec<Robot> = self.picture.present().copied().collect();
        let market = self.market(&goals, &robots);
        for Pair { goal, robot } in self.settings.allocation.choose(&market) {
            self.award_to(goals[goal].id, robots[robot].id);
        }
    }

    /// The goals without an assignee that can be awarded in a round: none before the auction of the oldest has lasted long
    /// enough, and that of each goal that was called meanwhile, so that goals called together are awarded by all of their
    /// bids. The optimal assignment considers all goals on offer, because it estimates what robots would bid.
    fn goals_of_round(&self) -> Vec<Task> {
        let wait_s = self.settings.auction_wait_s();
        let free = self.goals.iter().filter(|owned| {
            owned.assigned.is_none()
                && owned.is_on_offer(self.now_s)
                && self.services.grant_of(owned.task.id).is_none()
                && self.owns_at(owned.task.id, self.now_s)
        });
        let called_s = free.clone().filter_map(|owned| owned.called_s);
        let oldest_s = called_s.clone().fold(f64::INFINITY, f64::min);
        let is_of_auction = |called_s: &f64| *called_s <= oldest_s + wait_s;
        let newest_s = called_s
            .filter(is_of_auction)
            .fold(f64::NEG_INFINITY, f64::max);
        let is_ripe = |called_s: f64| self.now_s + self.step_s / 2.0 >= called_s + wait_s;
        if !oldest_s.is_finite() || !is_ripe(newest_s) {
            return Vec::new();
        }
        let is_all = self.settings.allocation == Allocation::Optimal;
        let goals = free.filter(|owned| is_all || owned.called_s.is_some_and(is_ripe));
        goals.map(|owned| owned.task).collect()
    }

    fn market(&self, goals: &[Task], robots: &[Robot]) -> Market {
        let grants = self.services.grants();
        let is_idle = robots
            .iter()
            .map(|robot| robot.goals == 0 && !grants.iter().any(|grant| grant.holder == robot.id));
        let mut market = Market {
            goals: goals.len(),
            is_idle: is_idle.collect(),
            offers: self.bid_offers(goals, robots).collect(),
        };
        if self.settings.allocation == Allocation::Optimal {
            self.add_estimates(&mut market, goals, robots);
        }
        market
    }

    /// The bids of robots that are present, for goals on offer.
    fn bid_offers(&self, goals: &[Task], robots: &[Robot]) -> impl Iterator<Item = Offer> {
        self.bids.iter().filter_map(|standing| {
            let goal = goals.iter().position(|task| task.id == standing.bid.goal)?;
            let robot = robots.iter().position(|robot| robot.id == standing.robot)?;
            if self.is_reserved(standing.robot, standing.bid.goal) {
                return None;
            }
            let (bidder, task) = (&robots[robot], &goals[goal]);
            let cost_s = |time_s: f32| cost_s(bidder, task, [time_s.into(), standing.confidence]);
            Some(Offer {
                pair: Pair { goal, robot },
                cost_s: cost_s(standing.bid.time_s),
                total_s: cost_s(standing.bid.total_s),
                distance_m: bidder.distance_m(task),
                is_bid: true,
            })
        })
    }

    /// Adds the costs of idle robots by distance and speed, where they have neither bid nor declined.
    fn add_estimates(&self, market: &mut Market, goals: &[Task], robots: &[Robot]) {
        let mut has_bid = alloc::vec![false; goals.len() * robots.len()];
        for Offer { pair, .. } in &market.offers {
            has_bid[pair.goal * robots.len() + pair.robot] = true;
        }
        let owned = self.goals.iter().filter_map(|owned| {
            let goal = goals.iter().position(|task| task.id == owned.task.id)?;
            Some((goal, owned))
        });
        for (goal, owned) in owned {
            for (robot, bidder) in robots.iter().enumerate() {
                let is_new = market.is_idle[robot] && !has_bid[goal * robots.len() + robot];
                let distance_m = bidder.distance_m(&owned.task);
                let time_s = distance_m / bidder.speed_m_s + f64::from(owned.task.service_s);
                if is_new && time_s.is_finite() && !owned.is_declined_by(bidder.id, self.now_s) {
                    let cost_s = cost_s(bidder, &owned.task, [time_s, 1.0]);
                    market.offers.push(Offer {
                        pair: Pair { goal, robot },
                        cost_s,
                        total_s: cost_s,
                        distance_m,
                        is_bid: false,
                    });
                }
            }
        }
    }

    /// Awards a goal to a robot that has bid for it; one that has not is called alone.
    fn award_to(&mut self, goal: GoalId, robot: AgentId) {
        let bid = self.bids.get(robot, goal).map(|standing| standing.bid);
        let Some(bid) = bid else {
            self.call_to(goal, robot);
            self.round
                .await_loser(robot, self.now_s + self.settings.answer_s);
            return;
        };
        let (now_s, wait_s) = (self.now_s, self.service_wait_s());
        let claim = Claim {
            goal,
            number: bid.number,
        };
        if !self.services.grant(robot, claim, wait_s, now_s) {
            return;
        }
        self.awards += 1;
        let overdue_s = now_s + OVERDUE_S + OVERDUE_FACTOR * f64::from(bid.time_s);
        let assigned = Assigned {
            robot,
            number: bid.number,
            is_committed: false,
            awarded_s: now_s,
            lease_s: self.settings.service_lease_s,
            next_s: now_s,
            overdue_s,
            is_contested: false,
            stuck_s: f64::INFINITY,
            is_withdrawn: false,
            there_s: f64::INFINITY,
        };
        if let Some(owned) = self.goal_mut(goal) {
            owned.assign(assigned);
        }
        let until_s = now_s + self.settings.answer_s;
        self.round.await_winner(robot, until_s);
        for bidder in self.bids.bidders(goal) {
            self.round.await_loser(bidder, until_s);
        }
        self.bids.remove_for(goal);
        self.bids.remove_of(robot);
        self.report_assignees(goal);
        self.repeat_awards();
        self.close_offer(goal, bid.number);
    }

    /// Requests an answer of one robot, at most once in a while.
    pub(super) fn call_to(&mut self, goal: GoalId, robot: AgentId) {
        let now_s = self.now_s;
        let Some(owned) = self
            .goal_mut(goal)
            .filter(|owned| now_s >= owned.next_probe_s)
        else {
            return;
        };
        owned.next_probe_s = now_s + 2.0 * RETRY_S;
        owned.called_s.get_or_insert(now_s);
        let (number, task) = (owned.call, owned.task_at(now_s));
        self.send(robot, Dispatch::Call { number, task });
    }

    /// Sends the awards that have not been answered.
    fn repeat_awards(&mut self) {
        let now_s = self.now_s;
        for index in 0..self.goals.len() {
            let owned = &mut self.goals[index];
            let goal = owned.task.id;
            let Some(assigned) = owned.assigned.as_mut() else {
                continue;
            };
            let is_repeated = now_s < assigned.awarded_s + RETRIES * RETRY_S;
            if assigned.is_committed || now_s < assigned.next_s || !is_repeated {
                continue;
            }
            assigned.next_s = now_s + RETRY_S;
            #[expect(clippy::cast_possible_truncation, reason = "messages are short")]
            let award = Award {
                goal,
                number: assigned.number,
                lease_s: assigned.lease_s as f32,
            };
            let robot = assigned.robot;
            self.send(robot, Dispatch::Award(award));
        }
    }
}

/// Expected time divided by confidence, trust and value.
fn cost_s(robot: &Robot, task: &Task, [time_s, confidence]: [f64; 2]) -> f64 {
    let value = f64::from(task.value).max(1e-6);
    time_s / (confidence * robot.trust.value() * value)
}
