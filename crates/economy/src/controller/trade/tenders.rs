//! Goals of other controllers, for which its robots state what they would bid.

use super::terms::PRICE_LIFE_S;
use crate::controller::context::{Context, short};
use crate::controller::contracts::is_plausible;
use crate::controller::ownership::{Ownership, Received};
use alloc::vec::Vec;
use base::hashed::Hashed;
use brain::{
    AgentId, Bid, ContractMessage, GoalId, Price, Reason, Refusal, Task, TradeMessage, TradeOffer,
    Transfer,
};

/// Maximum number of robots that are called for a goal, the nearest ones.
const MAX_ROBOTS: usize = 3;

/// Maximum number of tenders; more offers are declined.
const MAX_TENDERS: usize = 64;

#[derive(Debug, Clone, Default, Hashed)]
pub(super) struct Tenders {
    list: Vec<Tender>,
}

/// A goal of another controller.
#[derive(Debug, Clone, Hashed)]
struct Tender {
    task: Task,
    /// Its deadline on the controller's clock.
    due_at_s: f64,
    owner: AgentId,
    /// What a price has to be below by a factor.
    cost_s: f64,
    awaited: Vec<AgentId>,
    /// The lowest cost of a bid, and its probability.
    best: Option<[f64; 2]>,
    until_s: f64,
    /// The number of the price that has been sent, and when.
    price: Option<(u32, f64)>,
}

impl Tenders {
    /// Another controller offers a goal.
    pub(super) fn open(
        &mut self,
        context: &mut Context,
        owner: AgentId,
        TradeOffer { cost_s, task }: TradeOffer,
    ) {
        let goal = task.id;
        let is_valid = task.is_valid() && cost_s > 0.0 && context.may_grant();
        if !is_valid || context.ledger.get(goal).is_some() {
            return;
        }
        self.list
            .retain(|tender| tender.task.id != goal || tender.owner != owner);
        let is_known = self.list.iter().any(|tender| tender.task.id == goal);
        let priced = self.list.iter().filter(|it| it.price.is_some()).count();
        let has_room = self.list.len() < MAX_TENDERS && !is_loaded(context, priced);
        let robots = if is_known || !has_room {
            Vec::new()
        } else {
            nearest(context, &task)
        };
        if robots.is_empty() {
            context.send(owner, TradeMessage::Decline(goal));
            return;
        }
        for robot in &robots {
            context.send(*robot, ContractMessage::Estimate(task));
        }
        self.list.push(Tender {
            task,
            due_at_s: context.now_s + f64::from(task.due_s),
            owner,
            cost_s: cost_s.into(),
            awaited: robots,
            best: None,
            until_s: context.now_s + 2.0 * context.settings.answer_s,
            price: None,
        });
    }

    /// Takes the bid of a robot.
    pub(super) fn take_bid(
        &mut self,
        context: &Context,
        robot: AgentId,
        (bid, confidence): (Bid, f64),
    ) -> bool {
        let is_valid = is_plausible(&bid, confidence);
        let Some(tender) = self.awaiting(robot, bid.goal).filter(|_| is_valid) else {
            return false;
        };
        if let Some(bidder) = context.robots.get(robot) {
            let cost_s = bidder.cost_s(&tender.task, [bid.time_s.into(), confidence]);
            tender.take_cost(robot, [cost_s, confidence]);
        }
        true
    }

    /// A robot does not bid. One that is full could serve the goal later.
    pub(super) fn take_refusal(
        &mut self,
        context: &Context,
        robot: AgentId,
        refusal: &Refusal,
    ) -> bool {
        let Some(tender) = self.awaiting(robot, refusal.goal) else {
            return false;
        };
        let later = context
            .robots
            .get(robot)
            .filter(|_| refusal.reason == Reason::Full);
        let cost_s = later.map_or(f64::INFINITY, |robot| robot.later_cost_s(&tender.task));
        tender.take_cost(robot, [cost_s, 1.0]);
        true
    }

    fn awaiting(&mut self, robot: AgentId, goal: GoalId) -> Option<&mut Tender> {
        let mut list = self.list.iter_mut();
        list.find(|tender| tender.task.id == goal && tender.awaited.contains(&robot))
    }

    /// Sends the prices, and ends the tenders that had no effect.
    pub(super) fn step(&mut self, context: &mut Context) {
        let now_s = context.now_s;
        for tender in &mut self.list {
            if tender.price.is_none() && (tender.awaited.is_empty() || now_s >= tender.until_s) {
                tender.answer(context);
            }
        }
        self.list.retain(|tender| {
            let is_answered = tender.awaited.is_empty() || now_s >= tender.until_s;
            let priced_s = tender.price.map_or(f64::NEG_INFINITY, |(_, sent_s)| sent_s);
            !is_answered || now_s < priced_s + PRICE_LIFE_S
        });
    }

    /// The owner of a goal accepts the price: this controller is a candidate for it.
    pub(super) fn take_transfer(
        &mut self,
        context: &mut Context,
        ownership: &mut Ownership,
        from: AgentId,
        transfer: Transfer,
    ) {
        let now_s = context.now_s;
        let mut list = self.list.iter();
        let is_priced = |tender: &Tender| {
            let number = tender.price.map(|(number, _)| number);
            tender.owner == from && number == Some(transfer.price)
        };
        let index = list.position(|tender| tender.task.id == transfer.goal && is_priced(tender));
        // A price is for one transfer: a repeated one has no effect.
        let Some(tender) = index.map(|index| self.list.remove(index)) else {
            return;
        };
        let Some((_, sent_s)) = tender.price.filter(|_| !context.is_full()) else {
            return;
        };
        if now_s < sent_s + PRICE_LIFE_S {
            ownership.take_transfer(
                context,
                Received {
                    task: tender.task,
                    due_at_s: tender.due_at_s,
                    transfer,
                    from,
                    priced_s: sent_s,
                },
            );
        }
    }
}

impl Tender {
    /// Takes the cost for a robot, and its probability.
    fn take_cost(&mut self, robot: AgentId, [cost_s, probability]: [f64; 2]) {
        self.awaited.retain(|awaited| *awaited != robot);
        let best_s = self.best.map_or(f64::INFINITY, |[best_s, _]| best_s);
        if cost_s < best_s {
            self.best = Some([cost_s, probability]);
        }
    }

    /// Sends the price of the best bid, if it is low enough.
    fn answer(&mut self, context: &mut Context) {
        let goal = self.task.id;
        let gain = context.settings.trade.map_or(0.0, |trade| trade.gain);
        let best = self
            .best
            .filter(|[cost_s, _]| *cost_s <= gain * self.cost_s);
        let Some([cost_s, probability]) = best else {
            context.send(self.owner, TradeMessage::Decline(goal));
            return;
        };
        let number = context.numbers.draw();
        let price = Price {
            goal,
            number,
            cost_s: short(cost_s),
        };
        self.price = Some((number, context.now_s));
        context.send_with(self.owner, TradeMessage::Price(price), probability);
    }
}

/// The robots that are present, those that are not full first, and then the nearest.
fn nearest(context: &Context, task: &Task) -> Vec<AgentId> {
    let robots = context.robots.present();
    let robots = robots.map(|it| (it.payload == 0, it.distance_m(task), it.id));
    let mut robots: Vec<(bool, f64, AgentId)> = robots.collect();
    robots.sort_by(|one, other| {
        let by_distance = one.1.total_cmp(&other.1);
        one.0
            .cmp(&other.0)
            .then(by_distance)
            .then(one.2.cmp(&other.2))
    });
    robots.truncate(MAX_ROBOTS);
    robots.into_iter().map(|(.., robot)| robot).collect()
}

/// Whether it would have to offer goals itself, with those that it has a price for.
fn is_loaded(context: &Context, priced: usize) -> bool {
    2 * (context.ledger.open(context.now_s) + priced) >= context.settings.max_goals as usize
}
