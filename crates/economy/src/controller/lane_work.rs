//! What a controller knows of a mined lane, and the goals that it has planned.

use super::conclusion::LaneConclusion;
use super::owned::Owned;
use super::tried::Tried;
use crate::clearance::plan::{Proposal, Subject};
use crate::clearance::{Clearance, Decision, LanePicture, LaneStatement};
use alloc::boxed::Box;
use alloc::sync::Arc;
use alloc::vec::Vec;
use base::hash::Hash;
use base::hashed::Hashed;
use brain::{AgentId, Dispatch, GoalId, Task};

/// Messages of a robot that has served a goal arrive within this time, in seconds: what it has searched
/// is not searched again before.
const REST_S: f64 = 10.0;

/// A goal that robots have lost this many times counts as impossible. It is still offered.
const MAX_FAILURES: u8 = 6;

/// Lowest value of a goal: values are relative, and not 0.
const MIN_VALUE: f64 = 1e-3;

/// The lane of a controller, if it has one.
#[derive(Debug, Clone, Default)]
pub(super) struct Clearing {
    pub(super) work: Option<Box<LaneWork>>,
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
    /// How often a robot has lost it without serving it.
    pub(super) failures: u8,
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
        (self.value, self.failures).add_to(hash);
    }
}

impl Clearing {
    pub(super) fn new(clearance: Option<&Arc<Clearance>>) -> Self {
        let work = clearance.map(|clearance| {
            Box::new(LaneWork {
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

    /// Notes that a robot has lost a goal without serving it.
    pub(super) fn note_failure(&mut self, goal: GoalId) {
        let work = self.work.iter_mut();
        let mut planned = work.flat_map(|work| &mut work.planned);
        if let Some(planned) = planned.find(|planned| planned.goal == goal) {
            planned.failures = planned.failures.saturating_add(1);
        }
    }

    /// Takes a message of a robot about the lane.
    pub(super) fn receive(&mut self, from: AgentId, dispatch: &Dispatch) {
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

impl LaneWork {
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
    /// Whether robots have lost it so often that another award hardly serves it.
    pub(super) fn has_failed_often(&self) -> bool {
        self.failures >= MAX_FAILURES
    }

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
