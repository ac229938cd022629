//! The goals of a mined lane: they follow from what the controller believes of it.
//!
//! Several controllers share a lane: each plans the goals of its own tiles, in turn among the
//! controllers in range, so that the others take over when one is lost.

use super::Controller;
use super::owned::Owned;
use crate::clearance::plan::{Circumstances, Plan, Subject, Wanted};
use crate::clearance::{Clearance, Decision, LanePicture, LaneStatement};
use alloc::boxed::Box;
use alloc::sync::Arc;
use alloc::vec::Vec;
use base::hash::Hash;
use base::hashed::Hashed;
use brain::{Dispatch, GoalId, Percept, RobotId, Task};

/// Time between two plans, and between two messages about the lane, in seconds.
const PLAN_PERIOD_S: f64 = 1.0;
const LANE_PERIOD_S: f64 = 5.0;

/// Messages of a robot that has served a goal arrive within this time, in seconds: what it has searched
/// is not searched again before.
const REST_S: f64 = 10.0;

/// Number of searches on offer at once for each robot in range.
const SEARCHES_PER_ROBOT: usize = 3;

/// Lowest value of a goal: values are relative, and not 0.
const MIN_VALUE: f64 = 1e-3;

/// The lane of a controller, if it has one.
#[derive(Debug, Clone, Default)]
pub(super) struct Clearing {
    work: Option<Box<LaneWork>>,
}

/// Controllers without a lane have the hash that they had before there were lanes.
impl Hashed for Clearing {
    fn add_to(&self, hash: &mut Hash) {
        if let Some(work) = &self.work {
            work.add_to(hash);
        }
    }
}

/// The work on a lane.
#[derive(Debug, Clone)]
struct LaneWork {
    picture: LanePicture,
    decision: Decision,
    planned: Vec<Planned>,
    /// How often places have been interrogated.
    interrogated: Vec<(u32, u32)>,
    next_plan_s: f64,
    next_lane_s: f64,
}

base::hashed!(LaneWork {
    picture,
    decision,
    planned,
    interrogated,
    next_plan_s,
    next_lane_s
});

/// A goal that the controller has planned.
#[derive(Debug, Clone, Copy)]
struct Planned {
    goal: GoalId,
    subject: Subject,
    /// When it had been served; until then none.
    done_s: Option<f64>,
}

impl Hashed for Planned {
    fn add_to(&self, hash: &mut Hash) {
        let subject = match self.subject {
            Subject::Tile { tile, search } => (tile, search),
            Subject::Suspect { place } => (place, u8::MAX - 1),
            Subject::Mine { place } => (place, u8::MAX),
        };
        ((self.goal, self.done_s), subject).add_to(hash);
    }
}

impl Clearing {
    pub(super) fn new(clearance: Option<&Arc<Clearance>>) -> Self {
        let work = clearance.map(|clearance| {
            Box::new(LaneWork {
                picture: LanePicture::new(clearance.clone()),
                decision: Decision::default(),
                planned: Vec::new(),
                interrogated: Vec::new(),
                next_plan_s: f64::NEG_INFINITY,
                next_lane_s: f64::NEG_INFINITY,
            })
        });
        Self { work }
    }

    pub(super) fn picture(&self) -> Option<&LanePicture> {
        self.work.as_ref().map(|work| &work.picture)
    }

    pub(super) fn statement(&self) -> Option<LaneStatement> {
        self.work.as_ref()?.decision.statement
    }

    /// Takes a message of a robot about the lane.
    pub(super) fn receive(&mut self, from: RobotId, dispatch: &Dispatch) {
        let Some(work) = &mut self.work else {
            return;
        };
        match dispatch {
            Dispatch::Coverage(coverage) => work.picture.take_coverage(from, coverage),
            Dispatch::Mark(mark) => work.picture.take_mark(from, mark),
            Dispatch::Statement(statement) => work.picture.take_statement(statement),
            _ => {}
        }
    }
}

impl Controller {
    /// Plans the goals of the lane until it has stated that the lane is clear, or has given it up.
    pub(super) fn clear(&mut self, percept: &Percept) {
        let now_s = self.now_s;
        // Taken out, as planning owns goals.
        let Some(mut work) = self.clearing.work.take() else {
            return;
        };
        if now_s >= work.next_lane_s {
            work.next_lane_s = now_s + LANE_PERIOD_S;
            let lane = work.picture.clearance().lane;
            self.send(RobotId::EVERYONE, Dispatch::Lane(lane));
        }
        if now_s >= work.next_plan_s && work.decision.statement.is_none() {
            work.next_plan_s = now_s + PLAN_PERIOD_S;
            let plan = self.plan(&mut work);
            work.decision.decide(&work.picture, &plan, now_s);
            if work.decision.statement.is_some() {
                self.cancel(&mut work, |_| false);
            } else {
                self.issue(&mut work, plan, percept);
            }
        }
        self.clearing.work = Some(work);
    }

    fn plan(&self, work: &mut LaneWork) -> Plan {
        work.note_done(&self.goals, self.now_s);
        let mut kinds: Vec<u8> = self.picture.present().map(|robot| robot.id.kind).collect();
        kinds.sort_unstable();
        kinds.dedup();
        let interrogated = &work.interrogated;
        Plan::new(
            &work.picture,
            &Circumstances {
                kinds: &kinds,
                interrogations: &|place| {
                    let times = interrogated.iter().find(|(known, _)| *known == place);
                    times.map_or(0, |(_, times)| *times)
                },
            },
        )
    }

    /// Owns the goals that are wanted, and cancels those that no longer are.
    fn issue(&mut self, work: &mut LaneWork, plan: Plan, percept: &Percept) {
        let is_wanted =
            |subject: Subject| plan.wanted.iter().any(|wanted| wanted.subject == subject);
        self.cancel(work, is_wanted);
        let (turn, turns) = self.turn();
        let mut wanted = plan.wanted;
        wanted.retain(|wanted| wanted.tile % turns == turn && !work.is_planned(wanted.subject));
        wanted.sort_by(|one, other| other.value.total_cmp(&one.value));
        let open = work
            .planned
            .iter()
            .filter(|planned| planned.is_open_search());
        let robots = self.picture.present().count().max(1);
        let mut free = (SEARCHES_PER_ROBOT * robots).saturating_sub(open.count());
        for wanted in wanted {
            if matches!(wanted.subject, Subject::Tile { .. }) {
                if free == 0 {
                    continue;
                }
                free -= 1;
            }
            let issuer = self.own;
            let number = self.numbers.next(percept);
            let goal = GoalId { issuer, number };
            self.own(wanted.task(goal));
            work.planned.push(Planned {
                goal,
                subject: wanted.subject,
                done_s: None,
            });
        }
    }

    /// Cancels the goals without an assignee whose subject is not wanted.
    fn cancel(&mut self, work: &mut LaneWork, is_wanted: impl Fn(Subject) -> bool) {
        let is_served = |goal: GoalId| self.services.grant_of(goal).is_some();
        let idle = work.planned.iter().filter(|planned| {
            planned.done_s.is_none() && !is_wanted(planned.subject) && !is_served(planned.goal)
        });
        let idle: Vec<GoalId> = idle.map(|planned| planned.goal).collect();
        for goal in &idle {
            if let Some(owned) = self.goal_mut(*goal) {
                owned.is_done = true;
                owned.assigned = None;
                self.bids.remove_for(*goal);
                self.close_offer(*goal);
            }
        }
        work.planned.retain(|planned| !idle.contains(&planned.goal));
    }

    /// Its turn among the controllers in range, and the number of turns.
    fn turn(&self) -> (u32, u32) {
        let others = self.colleagues.list.iter().map(|colleague| colleague.id);
        let (before, after): (Vec<RobotId>, Vec<RobotId>) = others.partition(|id| *id < self.own);
        let count = |ids: &[RobotId]| u32::try_from(ids.len()).unwrap_or(u32::MAX);
        let turn = count(&before);
        (turn, turn.saturating_add(count(&after)).saturating_add(1))
    }
}

impl LaneWork {
    /// Notes the goals that have been served; after a rest, their subjects can be wanted again.
    fn note_done(&mut self, goals: &[Owned], now_s: f64) {
        for planned in &mut self.planned {
            let owned = goals.iter().find(|owned| owned.task.id == planned.goal);
            if planned.done_s.is_some() || owned.is_some_and(|owned| !owned.is_done) {
                continue;
            }
            planned.done_s = Some(now_s);
            if let Subject::Suspect { place } = planned.subject {
                match self
                    .interrogated
                    .iter_mut()
                    .find(|(known, _)| *known == place)
                {
                    Some((_, times)) => *times += 1,
                    None => self.interrogated.push((place, 1)),
                }
            }
        }
        let is_resting = |done_s: f64| now_s < done_s + REST_S;
        self.planned
            .retain(|planned| planned.done_s.is_none_or(is_resting));
    }

    fn is_planned(&self, subject: Subject) -> bool {
        self.planned
            .iter()
            .any(|planned| planned.subject == subject)
    }
}

impl Planned {
    fn is_open_search(&self) -> bool {
        self.done_s.is_none() && matches!(self.subject, Subject::Tile { .. })
    }
}

impl Wanted {
    #[expect(clippy::cast_possible_truncation, reason = "messages are short")]
    fn task(&self, id: GoalId) -> Task {
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
