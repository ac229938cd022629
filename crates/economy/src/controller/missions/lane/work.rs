//! What a controller knows of a mined lane, the goals that it has planned, and what it does in a step.

use super::conclusion::LaneConclusion;
use super::tried::Tried;
use crate::clearance::plan::{Proposal, Subject};
use crate::clearance::{Clearance, Decision, LanePicture};
use crate::controller::context::Context;
use crate::controller::contracts::Contracts;
use crate::controller::ledger::owned::Owned;
use alloc::sync::Arc;
use alloc::vec::Vec;
use base::hash::Hash;
use base::hashed::Hashed;
use brain::{Act, AgentId, GoalId, LaneMessage, Receiver, Task};

/// Time between two plans, and between two messages about the lane, in seconds.
const PLAN_PERIOD_S: f64 = 1.0;
const LANE_PERIOD_S: f64 = 5.0;

/// Messages of a robot that has served a goal arrive within this time, in seconds: what it has searched
/// is not searched again before.
const REST_S: f64 = 10.0;

/// Lowest value of a goal: values are relative, and not 0.
const MIN_VALUE: f64 = 1e-3;

/// The work on a lane.
#[derive(Debug, Clone, Hashed)]
pub(super) struct LaneWork {
    pub(super) picture: LanePicture,
    pub(super) decision: Decision,
    /// What it stated beside the risk; it follows from the picture of that time.
    #[hashed(skip)]
    pub(super) conclusion: Option<LaneConclusion>,
    pub(super) planned: Vec<Planned>,
    /// How often places have been interrogated.
    pub(super) interrogated: Vec<(u32, u32)>,
    pub(super) tried: Tried,
    pub(super) next_plan_s: f64,
    pub(super) next_lane_s: f64,
    /// The expected number of mines that its goals may find or destroy, since the first plan.
    pub(super) gain: Option<f64>,
    /// Whether a mark that may be a mine had no verdict at the last plan.
    #[hashed(skip)]
    pub(super) has_open_marks: bool,
}

/// A goal that the controller has planned.
#[derive(Debug, Clone, Copy)]
pub(super) struct Planned {
    pub(super) goal: GoalId,
    pub(super) subject: Subject,
    /// What it was to find or destroy when it was planned.
    pub(super) value: f64,
    /// When it had been served; until then none.
    pub(super) done_s: Option<f64>,
}

impl Hashed for Planned {
    fn add_to(&self, hash: &mut Hash) {
        let subject = match self.subject {
            Subject::Tile { tile, search } => (tile, search),
            Subject::Suspect { place } => (place, u8::MAX - 1),
            Subject::Mine { place } => (place, u8::MAX),
        };
        ((self.goal, self.done_s), subject).add_to(hash);
        self.value.add_to(hash);
    }
}

impl LaneWork {
    pub(super) fn new(clearance: &Arc<Clearance>) -> Self {
        Self {
            picture: LanePicture::new(clearance.clone()),
            decision: Decision::default(),
            conclusion: None,
            planned: Vec::new(),
            interrogated: Vec::new(),
            tried: Tried::default(),
            gain: None,
            next_plan_s: f64::NEG_INFINITY,
            next_lane_s: f64::NEG_INFINITY,
            has_open_marks: false,
        }
    }

    /// Reports, and plans when it is time; returns the act by which it states that the lane is clear, or gives it up.
    pub(super) fn step(&mut self, context: &mut Context, contracts: &mut Contracts) -> Option<Act> {
        let now_s = context.now_s;
        if now_s >= self.next_lane_s {
            self.next_lane_s = now_s + LANE_PERIOD_S;
            self.report(context);
        }
        if now_s < self.next_plan_s || self.decision.statement.is_some() {
            return None;
        }
        self.next_plan_s = now_s + PLAN_PERIOD_S;
        let plan = self.plan(context);
        self.has_open_marks = plan.has_open_marks;
        self.gain = Some(plan.gain);
        self.decision.decide(&self.picture, &plan, now_s);
        if context.settings.is_called_off {
            self.decision.give_up(&plan, now_s);
        }
        let Some(statement) = self.decision.statement else {
            self.issue(context, contracts, plan);
            return None;
        };
        self.gain = Some(0.0);
        let passage = context.settings.passage.as_deref();
        self.conclusion = Some(LaneConclusion::new(&self.picture, passage));
        self.cancel(context, contracts, |_| false);
        Some(statement.act())
    }

    /// Reports the lane to robots, and to peers what its goals may still find or destroy: a lane is hopeless only if none
    /// of them lowers the risk.
    fn report(&self, context: &mut Context) {
        let lane = self.picture.clearance().lane;
        context.send(Receiver::All, LaneMessage::Lane(lane));
        let Some(gain) = self.gain else {
            return;
        };
        #[expect(clippy::cast_possible_truncation, reason = "messages are short")]
        let gain = gain as f32;
        let peers: Vec<AgentId> = context.peers.members_of(context.own).collect();
        for peer in peers {
            context.send(peer, LaneMessage::Gain(gain));
        }
    }

    /// Notes the goals that have been served; after a rest, their subjects can be proposed again.
    pub(super) fn note_done(&mut self, goals: &[Owned], now_s: f64) {
        for planned in &mut self.planned {
            let owned = goals.iter().find(|owned| owned.task.id == planned.goal);
            if planned.done_s.is_some() || owned.is_some_and(|owned| !owned.is_done) {
                continue;
            }
            planned.done_s = Some(now_s);
            match planned.subject {
                Subject::Tile { .. } => self.tried.served(planned.subject, planned.value),
                Subject::Mine { .. } => {}
                Subject::Suspect { place } => {
                    let mut known = self.interrogated.iter_mut();
                    match known.find(|(known, _)| *known == place) {
                        Some((_, times)) => *times += 1,
                        None => self.interrogated.push((place, 1)),
                    }
                }
            }
        }
        let is_resting = |done_s: f64| now_s < done_s + REST_S;
        self.planned
            .retain(|planned| planned.done_s.is_none_or(is_resting));
    }

    pub(super) fn is_planned(&self, subject: Subject) -> bool {
        self.planned
            .iter()
            .any(|planned| planned.subject == subject)
    }
}

impl Planned {
    /// Whether it is a search in a way that has not been served.
    pub(super) fn is_open_search(&self, way: u8) -> bool {
        let is_search = matches!(self.subject, Subject::Tile { search, .. } if search == way);
        self.done_s.is_none() && is_search
    }
}

impl Proposal {
    #[expect(clippy::cast_possible_truncation, reason = "messages are short")]
    pub(super) fn task(&self, id: GoalId) -> Task {
        Task {
            id,
            at_m: [self.at.x as f32, self.at.y as f32],
            radius_m: self.radius_m as f32,
            value: self.value.max(MIN_VALUE) as f32,
            service_s: self.skill.service_s,
            due_s: f32::MAX,
            work: self.work,
            capability: self.skill.capability,
        }
    }
}
