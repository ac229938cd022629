//! Calls for bids, and awards: a round awards what the rule of allocation chooses from all valid
//! bids.

use super::Contracts;
use super::calls::call_to;
use super::displacement::is_reserved;
use crate::allocation::{Allocation, Market, Offer, Pair};
use crate::controller::context::{Context, short};
use crate::controller::ledger::owned::Assigned;
use crate::controller::robots::Robot;
use alloc::vec::Vec;
use brain::{AgentId, Award, Claim, ContractMessage, GoalId, Task};

/// An award without an answer is repeated after this time, in seconds, this many times.
const RETRY_S: f64 = 0.5;
const RETRIES: f64 = 10.0;

/// A robot should have served a goal after this multiple of the time that it bid, and more, in
/// seconds: it may serve others before.
const OVERDUE_FACTOR: f64 = 4.0;
const OVERDUE_S: f64 = 120.0;

impl Contracts {
    /// Holds a round when it is due, and repeats awards without an answer.
    pub(super) fn award(&mut self, context: &mut Context) {
        repeat_awards(context);
        if !self.round.is_over(context.now_s + context.step_s / 2.0) || !context.may_grant() {
            return;
        }
        let goals = self.goals_of_round(context);
        let robots: Vec<Robot> = context.robots.present().copied().collect();
        let market = self.market(context, &goals, &robots);
        for Pair { goal, robot } in context.settings.allocation.choose(&market) {
            self.award_to(context, goals[goal].id, robots[robot].id);
        }
    }

    /// The goals without an assignee that can be awarded in a round: none before the auction of the oldest has lasted long
    /// enough, and that of each goal that was called meanwhile, so that goals called together are awarded by all of their
    /// bids. The optimal assignment considers all goals on offer, because it estimates what robots would bid.
    fn goals_of_round(&self, context: &Context) -> Vec<Task> {
        let wait_s = context.settings.auction_wait_s();
        let free = context.ledger.goals.iter().filter(|owned| {
            owned.assigned.is_none()
                && owned.is_on_offer(context.now_s)
                && self.is_free(owned.task.id)
        });
        let called_s = free.clone().filter_map(|owned| owned.called_s);
        let oldest_s = called_s.clone().fold(f64::INFINITY, f64::min);
        let is_of_auction = |called_s: &f64| *called_s <= oldest_s + wait_s;
        let newest_s = called_s
            .filter(is_of_auction)
            .fold(f64::NEG_INFINITY, f64::max);
        let is_ripe = |called_s: f64| context.now_s + context.step_s / 2.0 >= called_s + wait_s;
        if !oldest_s.is_finite() || !is_ripe(newest_s) {
            return Vec::new();
        }
        let is_all = context.settings.allocation == Allocation::Optimal;
        let goals = free.filter(|owned| is_all || owned.called_s.is_some_and(is_ripe));
        goals.map(|owned| owned.task).collect()
    }

    fn market(&self, context: &Context, goals: &[Task], robots: &[Robot]) -> Market {
        let grants = self.services.grants();
        let is_idle = robots
            .iter()
            .map(|robot| robot.goals == 0 && !grants.iter().any(|grant| grant.holder == robot.id));
        let mut market = Market {
            goals: goals.len(),
            is_idle: is_idle.collect(),
            offers: self.bid_offers(context, goals, robots).collect(),
        };
        if context.settings.allocation == Allocation::Optimal {
            add_estimates(context, &mut market, goals, robots);
        }
        market
    }

    /// The bids of robots that are present, for goals on offer.
    fn bid_offers(
        &self,
        context: &Context,
        goals: &[Task],
        robots: &[Robot],
    ) -> impl Iterator<Item = Offer> {
        self.bids.iter().filter_map(|standing| {
            let goal = goals.iter().position(|task| task.id == standing.bid.goal)?;
            let robot = robots.iter().position(|robot| robot.id == standing.robot)?;
            if is_reserved(context, standing.robot, standing.bid.goal) {
                return None;
            }
            let (bidder, task) = (&robots[robot], &goals[goal]);
            let cost_s = |time_s: f32| bidder.cost_s(task, [time_s.into(), standing.confidence]);
            Some(Offer {
                pair: Pair { goal, robot },
                cost_s: cost_s(standing.bid.time_s),
                total_s: cost_s(standing.bid.total_s),
                distance_m: bidder.distance_m(task),
                is_bid: true,
            })
        })
    }

    /// The lowest cost of the valid bids for a goal; without any, that of a robot that could serve it later; infinity without
    /// one.
    pub(crate) fn lowest_cost_s(&self, context: &Context, goal: GoalId) -> f64 {
        let Some(owned) = context.ledger.get(goal) else {
            return f64::INFINITY;
        };
        let valid = self.bids.iter().filter(|it| it.bid.goal == goal);
        let costs_s = valid.filter_map(|it| {
            let bidder = context.robots.get(it.robot)?;
            Some(bidder.cost_s(&owned.task, [it.bid.time_s.into(), it.confidence]))
        });
        let lowest_s = costs_s.fold(f64::INFINITY, f64::min);
        if lowest_s.is_finite() {
            return lowest_s;
        }
        let robots = context.robots.present();
        let able = robots.filter(|robot| !owned.is_declined_by(robot.id, context.now_s));
        let later_s = able.map(|robot| robot.later_cost_s(&owned.task));
        later_s
            .filter(|_| owned.unserved(context.now_s).is_none())
            .fold(f64::INFINITY, f64::min)
    }

    /// Awards a goal to a robot that has bid for it; one that has not is called alone.
    fn award_to(&mut self, context: &mut Context, goal: GoalId, robot: AgentId) {
        let bid = self.bids.get(robot, goal).map(|standing| standing.bid);
        let Some(bid) = bid else {
            call_to(context, goal, robot);
            self.round
                .await_loser(robot, context.now_s + context.settings.answer_s);
            return;
        };
        let (now_s, wait_s) = (context.now_s, context.service_wait_s());
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
            lease_s: context.settings.service_lease_s,
            next_s: now_s,
            overdue_s,
            is_contested: false,
            stuck_s: f64::INFINITY,
            is_withdrawn: false,
            there_s: f64::INFINITY,
        };
        if let Some(owned) = context.ledger.get_mut(goal) {
            owned.assign(assigned);
        }
        let until_s = now_s + context.settings.answer_s;
        self.round.await_winner(robot, until_s);
        for bidder in self.bids.bidders(goal) {
            self.round.await_loser(bidder, until_s);
        }
        self.bids.remove_for(goal);
        self.bids.remove_of(robot);
        context.report_assignees(goal);
        repeat_awards(context);
        context.close_offer(goal, Some(bid.number));
    }
}

/// Adds the costs of idle robots by distance and speed, where they have neither bid nor declined.
fn add_estimates(context: &Context, market: &mut Market, goals: &[Task], robots: &[Robot]) {
    let mut has_bid = alloc::vec![false; goals.len() * robots.len()];
    for Offer { pair, .. } in &market.offers {
        has_bid[pair.goal * robots.len() + pair.robot] = true;
    }
    let owned = context.ledger.goals.iter().filter_map(|owned| {
        let goal = goals.iter().position(|task| task.id == owned.task.id)?;
        Some((goal, owned))
    });
    for (goal, owned) in owned {
        for (robot, bidder) in robots.iter().enumerate() {
            let is_new = market.is_idle[robot] && !has_bid[goal * robots.len() + robot];
            let distance_m = bidder.distance_m(&owned.task);
            let time_s = distance_m / bidder.speed_m_s + f64::from(owned.task.service_s);
            if is_new && time_s.is_finite() && !owned.is_declined_by(bidder.id, context.now_s) {
                let cost_s = bidder.cost_s(&owned.task, [time_s, 1.0]);
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

/// Sends the awards that have not been answered.
fn repeat_awards(context: &mut Context) {
    let now_s = context.now_s;
    for index in 0..context.ledger.goals.len() {
        let owned = &mut context.ledger.goals[index];
        let goal = owned.task.id;
        let Some(assigned) = owned.assigned.as_mut() else {
            continue;
        };
        let is_repeated = now_s < assigned.awarded_s + RETRIES * RETRY_S;
        if assigned.is_committed || now_s < assigned.next_s || !is_repeated {
            continue;
        }
        assigned.next_s = now_s + RETRY_S;
        let award = Award {
            goal,
            number: assigned.number,
            lease_s: short(assigned.lease_s),
        };
        let robot = assigned.robot;
        context.send(robot, ContractMessage::Award(award));
    }
}
