//! The goals of a mined lane: they follow from what the controller believes of it.
//!
//! Several controllers share a lane: each plans the goals of its own tiles, in turn among the
//! controllers in range, so that the others take over when one is lost.

use super::lane_work::{LaneWork, Planned};
use super::owned::Owned;
use super::{Controller, NO_BID};
use crate::clearance::plan::{Circumstances, Plan, Subject};
use alloc::vec::Vec;
use brain::{Act, AgentId, Dispatch, GoalId, Percept, Receiver};

/// Time between two plans, and between two messages about the lane, in seconds.
const PLAN_PERIOD_S: f64 = 1.0;
const LANE_PERIOD_S: f64 = 5.0;

/// Number of searches on offer at once for each robot in range.
const SEARCHES_PER_ROBOT: usize = 3;

impl Controller {
    /// Plans the goals of the lane until it has stated that the lane is clear, or has given it up; returns the act
    /// by which it states so.
    pub(super) fn clear(&mut self, percept: &Percept) -> Option<Act> {
        let now_s = self.now_s;
        let mut act = None;
        // Taken out, as planning owns goals.
        let mut work = self.clearing.work.take()?;
        if now_s >= work.next_lane_s {
            work.next_lane_s = now_s + LANE_PERIOD_S;
            let lane = work.picture.clearance().lane;
            self.send(Receiver::All, Dispatch::Lane(lane));
            if let Some(gain) = work.gain {
                self.report_gain(gain);
            }
        }
        if now_s >= work.next_plan_s && work.decision.statement.is_none() {
            work.next_plan_s = now_s + PLAN_PERIOD_S;
            let plan = self.plan(&mut work);
            work.has_open_marks = plan.has_open_marks;
            work.gain = Some(plan.gain);
            work.decision.decide(&work.picture, &plan, now_s);
            if self.settings.is_called_off {
                work.decision.give_up(&plan, now_s);
            }
            if let Some(statement) = work.decision.statement {
                act = Some(statement.act());
                work.gain = Some(0.0);
                work.conclusion = Some(self.concluded(&work.picture));
                self.cancel(&mut work, |_| false);
            } else {
                self.issue(&mut work, plan, percept);
            }
        }
        self.clearing.work = Some(work);
        act
    }

    fn plan(&self, work: &mut LaneWork) -> Plan {
        work.note_done(&self.goals, self.now_s);
        let mut kinds: Vec<u8> = self.picture.present().map(|robot| robot.id.kind).collect();
        kinds.sort_unstable();
        kinds.dedup();
        let interrogated = &work.interrogated;
        let impossible = self.impossible(work);
        let (turn, turns) = self.turn();
        Plan::new(
            &work.picture,
            &Circumstances {
                kinds: &kinds,
                interrogations: &|place| {
                    let times = interrogated.iter().find(|(known, _)| *known == place);
                    times.map_or(0, |(_, times)| *times)
                },
                is_impossible: &|subject| impossible.contains(&subject),
                is_vain: &|proposal| work.tried.is_vain(proposal),
                is_own: &|tile| tile % turns == turn,
                others_gain: self.colleagues.lane_gain(self.own),
            },
        )
    }

    /// Reports to the other controllers what its goals may still find or destroy: a lane is hopeless only if none of
    /// them lowers the risk.
    fn report_gain(&mut self, gain: f64) {
        #[expect(clippy::cast_possible_truncation, reason = "messages are short")]
        let gain = gain as f32;
        let others: Vec<AgentId> = self.colleagues.on_lane_of(self.own).collect();
        for other in others {
            self.send(other, Dispatch::LaneGain(gain));
        }
    }

    /// What no robot in range could do when it was offered last, such as to neutralise when no charge is left, and what
    /// has failed again and again.
    fn impossible(&self, work: &LaneWork) -> Vec<Subject> {
        let is_unserved = |goal: GoalId| {
            let mut goals = self.goals.iter();
            let owned = goals.find(|owned| owned.task.id == goal);
            owned.is_some_and(Owned::is_hopeless)
        };
        let planned = work.planned.iter();
        let impossible =
            planned.filter(|planned| planned.has_failed_often() || is_unserved(planned.goal));
        impossible.map(|planned| planned.subject).collect()
    }

    /// Owns the proposed goals, and cancels those that no longer are.
    fn issue(&mut self, work: &mut LaneWork, plan: Plan, percept: &Percept) {
        let is_proposed = |subject: Subject| {
            plan.proposals
                .iter()
                .any(|proposal| proposal.subject == subject)
        };
        self.cancel(work, is_proposed);
        let (turn, turns) = self.turn();
        let mut proposals = plan.proposals;
        proposals
            .retain(|proposal| proposal.tile % turns == turn && !work.is_planned(proposal.subject));
        proposals.retain(|proposal| !work.tried.judge(proposal));
        proposals.sort_by(|one, other| other.value.total_cmp(&one.value));
        let mut free = self.free_searches(work);
        for proposal in proposals {
            if let Subject::Tile { search, .. } = proposal.subject {
                let Some(free) = free.get_mut(usize::from(search)).filter(|free| **free > 0) else {
                    continue;
                };
                *free -= 1;
            }
            let issuer = self.own.into();
            let number = self.numbers.next(percept);
            let goal = GoalId { issuer, number };
            if self.own(proposal.task(goal)).is_err() {
                // There is room for it later.
                break;
            }
            work.planned.push(Planned {
                goal,
                subject: proposal.subject,
                value: proposal.value,
                failures: 0,
                done_s: None,
            });
        }
    }

    /// For each way to search, how many more tiles can be on offer, by the robots in range that search so.
    fn free_searches(&self, work: &LaneWork) -> Vec<usize> {
        let clearance = work.picture.clearance();
        let ways = (0..).zip(&clearance.searches);
        let free = ways.map(|(way, skill)| {
            let able = self.picture.present().filter(|robot| {
                let model = clearance.robots.get(usize::from(robot.id.kind));
                model.is_some_and(|model| model.has(*skill))
            });
            let open = work
                .planned
                .iter()
                .filter(|planned| planned.is_open_search(way));
            (SEARCHES_PER_ROBOT * able.count()).saturating_sub(open.count())
        });
        free.collect()
    }

    /// Cancels the goals without an assignee whose subject is not proposed.
    fn cancel(&mut self, work: &mut LaneWork, is_proposed: impl Fn(Subject) -> bool) {
        let is_served = |goal: GoalId| self.services.grant_of(goal).is_some();
        let idle = work.planned.iter().filter(|planned| {
            planned.done_s.is_none() && !is_proposed(planned.subject) && !is_served(planned.goal)
        });
        let idle: Vec<GoalId> = idle.map(|planned| planned.goal).collect();
        for goal in &idle {
            if let Some(owned) = self.goal_mut(*goal) {
                owned.is_done = true;
                owned.assigned = None;
                self.bids.remove_for(*goal);
                self.close_offer(*goal, NO_BID);
            }
        }
        work.planned.retain(|planned| !idle.contains(&planned.goal));
    }

    /// Its turn among the controllers in range that share the lane, and the number of turns.
    fn turn(&self) -> (u32, u32) {
        let others = self.colleagues.on_lane_of(self.own);
        let (before, after): (Vec<AgentId>, Vec<AgentId>) = others.partition(|id| *id < self.own);
        let count = |ids: &[AgentId]| u32::try_from(ids.len()).unwrap_or(u32::MAX);
        let turn = count(&before);
        (turn, turn.saturating_add(count(&after)).saturating_add(1))
    }
}
