//! Goals that no robot can serve: reported once with the reason, and tried again later.

use super::calls::call_to;
use crate::allocation::Allocation;
use crate::controller::context::Context;
use crate::controller::robots::Robot;
use alloc::vec::Vec;
use brain::{GoalId, Reason};

/// A goal for which no robot has bid for this time, in seconds, is offered to each robot alone.
const PATIENCE_S: f64 = 10.0;

/// Calls each robot alone for goals without a bid; if all have refused, the goal rests.
pub(super) fn probe(context: &mut Context) {
    if context.settings.allocation == Allocation::None || !context.may_grant() {
        return;
    }
    end_expired(context);
    let now_s = context.now_s;
    let waiting = context.ledger.goals.iter().filter(|owned| {
        let is_free = owned.assigned.is_none() && owned.is_on_offer(now_s);
        let since_s = owned
            .called_s
            .map(|called_s| called_s.max(owned.without_bid_s));
        is_free && since_s.is_some_and(|since_s| now_s >= since_s + PATIENCE_S)
    });
    let waiting: Vec<GoalId> = waiting.map(|owned| owned.task.id).collect();
    for goal in waiting {
        probe_one(context, goal);
    }
}

/// Reports the goals whose deadline has passed without an award, and offers them no more.
fn end_expired(context: &mut Context) {
    let now_s = context.now_s;
    let expired = context.ledger.goals.iter().filter(|owned| {
        let is_ended = owned.rest.until_s == f64::INFINITY;
        !owned.is_done && owned.assigned.is_none() && now_s >= owned.due_at_s && !is_ended
    });
    let expired: Vec<GoalId> = expired.map(|owned| owned.task.id).collect();
    for goal in expired {
        give_up(context, goal, Reason::Deadline);
        if let Some(owned) = context.ledger.get_mut(goal) {
            owned.end();
        }
        context.close_offer(goal, None);
    }
}

fn probe_one(context: &mut Context, goal: GoalId) {
    let now_s = context.now_s;
    let Some(owned) = context.ledger.get(goal) else {
        return;
    };
    let task = owned.task;
    let robots = context.robots.present().copied();
    let robots = robots.filter(|robot| !owned.is_declined_by(robot.id, now_s));
    let willing: Vec<Robot> = robots.collect();
    let has_robots = context.robots.present().next().is_some();
    let free = willing.iter().filter(|robot| robot.payload > 0);
    let nearest = free.min_by(|one, other| {
        let by_distance = one.distance_m(&task).total_cmp(&other.distance_m(&task));
        by_distance.then(one.id.cmp(&other.id))
    });
    match nearest {
        Some(robot) => call_to(context, goal, robot.id),
        // The others serve the maximum number of goals, but not forever.
        None if !willing.is_empty() => {}
        None if has_robots => {
            let reason = owned.reason;
            give_up(context, goal, reason);
        }
        None => give_up(context, goal, Reason::NoRobot),
    }
}

/// The goal rests; the first time, that is reported to the operator.
pub(super) fn give_up(context: &mut Context, goal: GoalId, reason: Reason) {
    let now_s = context.now_s;
    let Some(owned) = context.ledger.get_mut(goal) else {
        return;
    };
    let is_first = owned.rest.total_s <= 0.0;
    owned.reason = reason;
    owned.give_up(now_s);
    if is_first {
        let number = owned.call.into();
        context.report(goal, number, reason);
    }
}
