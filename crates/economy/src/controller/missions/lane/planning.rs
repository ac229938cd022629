//! The goals of a lane: which of them are on offer.

use super::work::{LaneWork, Planned};
use crate::clearance::plan::{Circumstances, Plan, Subject};
use crate::controller::context::Context;
use crate::controller::contracts::Contracts;
use crate::controller::ledger::owned::Owned;
use alloc::vec::Vec;
use brain::GoalId;

/// Number of searches on offer at once for each robot in range.
const SEARCHES_PER_ROBOT: usize = 3;

/// A goal that robots have lost this many times counts as impossible. It is still offered.
const MAX_FAILURES: u16 = 6;

impl LaneWork {
    /// The goals that are worth their time now.
    pub(super) fn plan(&mut self, context: &Context) -> Plan {
        self.note_done(&context.ledger.goals, context.now_s);
        let mut kinds: Vec<u8> = context
            .robots
            .present()
            .map(|robot| robot.id.kind)
            .collect();
        kinds.sort_unstable();
        kinds.dedup();
        let interrogated = &self.interrogated;
        let impossible = self.impossible(context);
        let (turn, turns) = context.peers.turn(context.own);
        Plan::new(
            &self.picture,
            &Circumstances {
                kinds: &kinds,
                interrogations: &|place| {
                    let times = interrogated.iter().find(|(known, _)| *known == place);
                    times.map_or(0, |(_, times)| *times)
                },
                is_impossible: &|subject| impossible.contains(&subject),
                is_vain: &|proposal| self.tried.is_vain(proposal),
                is_own: &|tile| tile % turns == turn,
                others_gain: context.peers.lane_gain(context.own),
            },
        )
    }

    /// What no robot in range could do when it was offered last, such as to neutralise when no charge is left, and what
    /// has failed again and again.
    fn impossible(&self, context: &Context) -> Vec<Subject> {
        let is_impossible = |owned: &Owned| owned.is_hopeless() || owned.failures >= MAX_FAILURES;
        let planned = self.planned.iter().filter(|planned| {
            let owned = context.ledger.get(planned.goal);
            owned.is_some_and(is_impossible)
        });
        planned.map(|planned| planned.subject).collect()
    }

    /// Owns the proposed goals, and cancels those that no longer are.
    pub(super) fn issue(&mut self, context: &mut Context, contracts: &mut Contracts, plan: Plan) {
        let is_proposed = |subject: Subject| {
            plan.proposals
                .iter()
                .any(|proposal| proposal.subject == subject)
        };
        self.cancel(context, contracts, is_proposed);
        let (turn, turns) = context.peers.turn(context.own);
        let mut proposals = plan.proposals;
        proposals
            .retain(|proposal| proposal.tile % turns == turn && !self.is_planned(proposal.subject));
        proposals.retain(|proposal| !self.tried.judge(proposal));
        proposals.sort_by(|one, other| other.value.total_cmp(&one.value));
        let mut free = self.free_searches(context);
        for proposal in proposals {
            if let Subject::Tile { search, .. } = proposal.subject {
                let Some(free) = free.get_mut(usize::from(search)).filter(|free| **free > 0) else {
                    continue;
                };
                *free -= 1;
            }
            let issuer = context.own.into();
            let number = context.numbers.draw();
            let goal = GoalId { issuer, number };
            if context.own(proposal.task(goal)).is_err() {
                // There is room for it later.
                break;
            }
            self.planned.push(Planned {
                goal,
                subject: proposal.subject,
                value: proposal.value,
                done_s: None,
            });
        }
    }

    /// For each way to search, how many more tiles can be on offer, by the robots in range that search so.
    fn free_searches(&self, context: &Context) -> Vec<usize> {
        let clearance = self.picture.clearance();
        let ways = (0..).zip(&clearance.searches);
        let free = ways.map(|(way, skill)| {
            let able = context.robots.present().filter(|robot| {
                let model = clearance.robots.get(usize::from(robot.id.kind));
                model.is_some_and(|model| model.has(*skill))
            });
            let open = self
                .planned
                .iter()
                .filter(|planned| planned.is_open_search(way));
            (SEARCHES_PER_ROBOT * able.count()).saturating_sub(open.count())
        });
        free.collect()
    }

    /// Cancels the goals without an assignee whose subject is not proposed.
    pub(super) fn cancel(
        &mut self,
        context: &mut Context,
        contracts: &mut Contracts,
        is_proposed: impl Fn(Subject) -> bool,
    ) {
        let idle = self.planned.iter().filter(|planned| {
            planned.done_s.is_none()
                && !is_proposed(planned.subject)
                && contracts.is_free(planned.goal)
        });
        let idle: Vec<GoalId> = idle.map(|planned| planned.goal).collect();
        for goal in &idle {
            if let Some(owned) = context.ledger.get_mut(*goal) {
                owned.finish(context.now_s);
                contracts.forget_bids(*goal);
                context.close_offer(*goal, None);
            }
        }
        self.planned.retain(|planned| !idle.contains(&planned.goal));
    }
}
