//! A mined lane that the controller is to clear: its goals follow from what the controller believes of it.
//!
//! Several controllers share a lane: each plans the goals of its own tiles, in turn among the
//! controllers in range, so that the others take over when one is lost.
//!
//! * [`work`]: what it knows of the lane, and what it does in a step; [`planning`]: the goals;
//! * [`tried`]: searches in vain; [`conclusion`]: what it states beside the risk.

mod conclusion;
mod planning;
mod tried;
mod work;

pub use conclusion::LaneConclusion;

use crate::clearance::{Clearance, LanePicture, LaneStatement};
use crate::controller::context::Context;
use crate::controller::contracts::Contracts;
use crate::passage::{Passage, PlannedPassage};
use alloc::boxed::Box;
use alloc::sync::Arc;
use base::hash::Hash;
use base::hashed::Hashed;
use brain::{Act, AgentId, LaneMessage};
use work::LaneWork;

/// The lane of a controller, if it has one.
#[derive(Debug, Clone, Default)]
pub(crate) struct LaneMission {
    work: Option<Box<LaneWork>>,
}

/// Controllers without a lane have the hash that they had before there were lanes.
impl Hashed for LaneMission {
    fn add_to(&self, hash: &mut Hash) {
        if let Some(work) = &self.work {
            work.add_to(hash);
        }
    }
}

impl LaneMission {
    pub(crate) fn new(clearance: Option<&Arc<Clearance>>) -> Self {
        let work = clearance.map(|clearance| Box::new(LaneWork::new(clearance)));
        Self { work }
    }

    /// Plans the goals of the lane until it has stated that the lane is clear, or has given it up; returns the act
    /// by which it states so.
    pub(crate) fn step(&mut self, context: &mut Context, contracts: &mut Contracts) -> Option<Act> {
        self.work.as_mut()?.step(context, contracts)
    }

    /// Takes a message of a robot about the lane.
    pub(crate) fn receive(&mut self, from: AgentId, message: &LaneMessage) {
        let Some(work) = &mut self.work else {
            return;
        };
        match message {
            LaneMessage::Coverage(coverage) => work.picture.take_coverage(from, coverage),
            LaneMessage::Mark(mark) => work.picture.take_mark(from, mark),
            LaneMessage::Statement(statement) => work.picture.take_statement(statement),
            LaneMessage::Lane(_) | LaneMessage::Gain(_) => {}
        }
    }

    pub(crate) fn picture(&self) -> Option<&LanePicture> {
        self.work.as_ref().map(|work| &work.picture)
    }

    pub(crate) fn statement(&self) -> Option<LaneStatement> {
        self.work.as_ref()?.decision.statement
    }

    /// What it has stated beside the risk; if it has stated nothing, what it would state now.
    pub(crate) fn conclusion(&self, passage: Option<&Passage>) -> Option<LaneConclusion> {
        let work = self.work.as_ref()?;
        let stated = work.conclusion.clone();
        Some(stated.unwrap_or_else(|| LaneConclusion::new(&work.picture, passage)))
    }

    /// The passage that it has stated.
    pub(crate) fn stated_passage(&self) -> Option<&PlannedPassage> {
        self.work.as_ref()?.conclusion.as_ref()?.passage.as_ref()
    }

    /// Whether a mark that may be a mine had no verdict when it last planned.
    pub(crate) fn has_open_marks(&self) -> bool {
        self.work.as_ref().is_some_and(|work| work.has_open_marks)
    }
}
