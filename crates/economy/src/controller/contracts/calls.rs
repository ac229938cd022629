//! Calls for bids: for goals on offer, of all robots or of one.

use crate::allocation::Allocation;
use crate::controller::context::Context;
use brain::{AgentId, ContractMessage, GoalId, Receiver};

/// Maximum number of calls per step, and time after which a call is repeated, in seconds.
pub(crate) const CALLS_PER_STEP: usize = 2;
pub(crate) const REPEAT_S: f64 = 10.0;

/// One robot is called alone for a goal at most once in this time, in seconds.
const PROBE_S: f64 = 1.0;

/// Calls for bids for the goals on offer, those first that have waited longest.
pub(super) fn call(context: &mut Context) {
    if context.settings.allocation == Allocation::None || !context.may_grant() {
        return;
    }
    for _ in 0..CALLS_PER_STEP {
        let now_s = context.now_s;
        let due = context.ledger.goals.iter_mut();
        let due = due.filter(|owned| owned.is_on_offer(now_s) && now_s >= owned.next_call_s);
        let next = due.min_by(|one, other| one.next_call_s.total_cmp(&other.next_call_s));
        let Some(owned) = next else {
            return;
        };
        owned.called_s.get_or_insert(now_s);
        owned.next_call_s = now_s + REPEAT_S;
        let (number, task) = (owned.call, owned.task_at(now_s));
        context.send(Receiver::All, ContractMessage::Call { number, task });
    }
}

/// Requests an answer of one robot, at most once in a while.
pub(super) fn call_to(context: &mut Context, goal: GoalId, robot: AgentId) {
    let now_s = context.now_s;
    let Some(owned) = context
        .ledger
        .get_mut(goal)
        .filter(|owned| now_s >= owned.next_probe_s)
    else {
        return;
    };
    owned.next_probe_s = now_s + PROBE_S;
    owned.called_s.get_or_insert(now_s);
    let (number, task) = (owned.call, owned.task_at(now_s));
    context.send(robot, ContractMessage::Call { number, task });
}
