//! A valuable goal that waits because all robots are full displaces one of at most half its value.
//!
//! The controller calls the robot with the least valuable such goal alone. If it answers that it is
//! full, and so could serve the goal otherwise, its less valuable goal is withdrawn and on offer again,
//! and it is awarded no other before the valuable one. Each displacement at least doubles the value
//! of what the robot serves, so goals do not move back and forth.

use super::Contracts;
use super::calls::call_to;
use crate::controller::context::Context;
use crate::controller::ledger::owned::{Assigned, Owned, Reservation};
use crate::controller::robots::Robot;
use brain::{AgentId, Fitness, GoalId};

/// For this time, in seconds, the robot is reserved for the valuable goal, which displaces no other
/// for as long again and more.
const RESERVED_S: f64 = 10.0;
const REST_S: f64 = 60.0;

/// Robots report in this period, in seconds: until the next report, one may begin its service.
const REPORT_PERIOD_S: f64 = 3.0;

impl Contracts {
    /// Calls robots that may give up a goal for one that waits.
    pub(super) fn call_full_robots(&mut self, context: &mut Context) {
        if !context.may_grant() {
            return;
        }
        let assigned = context.ledger.goals.iter();
        let assigned = assigned.filter(|owned| owned.assigned.is_some() && !owned.is_done);
        let least = assigned
            .map(|owned| owned.task.value)
            .fold(f32::INFINITY, f32::min);
        for index in 0..context.ledger.goals.len() {
            if context.ledger.goals[index].task.value / 2.0 < least {
                continue;
            }
            let goal = context.ledger.goals[index].task.id;
            if let Some(robot) = self.waits_for(context, index) {
                call_to(context, goal, robot);
            }
        }
    }

    /// A robot answers that it could serve a goal if it were not full.
    pub(super) fn displace(&mut self, context: &mut Context, robot: AgentId, goal: GoalId) {
        let mut goals = context.ledger.goals.iter();
        let index = goals.position(|owned| owned.task.id == goal);
        let Some(index) = index.filter(|index| self.waits_for(context, *index) == Some(robot))
        else {
            return;
        };
        let Some(displaced) = displaceable(context, index, robot).map(|owned| owned.task.id) else {
            return;
        };
        let until_s = context.now_s + RESERVED_S;
        context.ledger.goals[index].reserved = Some(Reservation { robot, until_s });
        self.withdraw(context, displaced);
    }

    /// The robot that serves the least valuable goal which a waiting one can displace. It waits if all
    /// robots that have not declined it are full.
    fn waits_for(&self, context: &Context, index: usize) -> Option<AgentId> {
        let (owned, now_s) = (&context.ledger.goals[index], context.now_s);
        let is_ripe = |called_s: f64| now_s >= called_s + context.settings.auction_wait_s();
        let has_rested = |reserved: Reservation| now_s >= reserved.until_s + REST_S;
        let waits = owned.assigned.is_none()
            && owned.is_on_offer(now_s)
            && owned.called_s.is_some_and(is_ripe)
            && owned.reserved.is_none_or(has_rested)
            && !self
                .bids
                .iter()
                .any(|standing| standing.bid.goal == owned.task.id);
        let is_willing = |robot: &&Robot| !owned.is_declined_by(robot.id, now_s);
        let mut willing = context.robots.present().filter(is_willing);
        if !waits || willing.any(|robot| robot.payload > 0) {
            return None;
        }
        let willing = context.robots.present().filter(is_willing);
        let displaceable = willing.filter_map(|robot| displaceable(context, index, robot.id));
        let least = displaceable.min_by(|one, other| one.task.value.total_cmp(&other.task.value));
        Some(least?.assigned?.robot)
    }
}

/// The least valuable goal of a robot that a waiting one can displace.
fn displaceable(context: &Context, index: usize, robot: AgentId) -> Option<&Owned> {
    let value = context.ledger.goals[index].task.value;
    let can_stop = |assigned: Assigned| {
        let is_kept = assigned.is_committed && !assigned.is_withdrawn;
        let is_away = context.now_s + REPORT_PERIOD_S < assigned.there_s;
        assigned.robot == robot && is_kept && is_away
    };
    let goals = context.ledger.goals.iter().filter(|owned| {
        let is_less = owned.task.value <= value / 2.0 && owned.task.value < value;
        is_less && !owned.is_done && owned.assigned.is_some_and(can_stop)
    });
    goals.min_by(|one, other| one.task.value.total_cmp(&other.task.value))
}

/// Whether a robot is reserved for another goal than this one.
pub(super) fn is_reserved(context: &Context, robot: AgentId, goal: GoalId) -> bool {
    let mut waiting = context.ledger.goals.iter().filter(|owned| {
        let is_due =
            |reserved: Reservation| reserved.robot == robot && context.now_s < reserved.until_s;
        owned.is_on_offer(context.now_s) && owned.reserved.is_some_and(is_due)
    });
    waiting.any(|owned| owned.task.id != goal)
}

/// Notes when a robot begins the service of a goal.
pub(super) fn note_progress(context: &mut Context, robot: AgentId, fitness: &Fitness) {
    let now_s = context.now_s;
    let speed_m_s = context
        .robots
        .get(robot)
        .map_or(1.0, |robot| robot.speed_m_s);
    let Some(owned) = context.ledger.get_mut(fitness.goal) else {
        return;
    };
    let work_s = f64::from(owned.task.service_s) + f64::from(owned.task.radius_m) / speed_m_s;
    let assigned = owned.assigned.as_mut();
    if let Some(assigned) = assigned.filter(|assigned| assigned.robot == robot) {
        assigned.there_s = now_s + f64::from(fitness.remaining_s) - work_s;
    }
}

/// Calls a robot that has released a goal for the goal that displaced it.
pub(super) fn call_reserved(context: &mut Context, robot: AgentId) {
    let now_s = context.now_s;
    let mut goals = context.ledger.goals.iter_mut();
    let waiting = goals.find(|owned| {
        let reserved = owned.reserved.filter(|reserved| reserved.robot == robot);
        owned.is_on_offer(now_s) && reserved.is_some_and(|reserved| now_s < reserved.until_s)
    });
    if let Some(owned) = waiting {
        owned.next_probe_s = now_s;
        let goal = owned.task.id;
        call_to(context, goal, robot);
    }
}
