//! The arbitration of a kind of robot: one method per kind of arbitration.

use super::Arbitration;
use super::decided::Decided;
use super::goal_selection::GoalSelection;
use super::motor_schemas::{Noise, Sum};
use super::subsumption::{Layer, arbitrate, proposals};
use crate::behaviours::{BehaviourSpec, Memory, Ready};
use crate::goals::proposal::Proposal;
use crate::io::command::Motion;
use crate::situation::Situation;
use crate::spec::BrainSpec;

/// An [`Arbitration`], prepared for the behaviours of a brain.
#[derive(Debug)]
pub(crate) enum Arbiter {
    Subsumption,
    Goals,
    Schemas(Sum),
}

/// The part of a robot's memory that arbitration uses.
pub(crate) struct ArbitrationMemory<'m> {
    pub(crate) layers: &'m mut [Layer<Memory>],
    /// With motor schemas only.
    pub(crate) noise: Option<&'m mut Noise>,
    /// With beliefs only: without them, destinations cannot be pursued.
    pub(crate) selection: Option<&'m mut GoalSelection>,
}

impl Arbiter {
    pub(crate) fn new(spec: &BrainSpec) -> Self {
        match &spec.arbitration {
            Arbitration::Subsumption => Self::Subsumption,
            Arbitration::Goals => Self::Goals,
            Arbitration::Schemas(schemas) => {
                let names = spec.behaviours.iter().map(BehaviourSpec::name);
                Self::Schemas(Sum::new(schemas, names))
            }
        }
    }

    #[inline]
    pub(crate) fn decide(
        &self,
        behaviours: &[Ready],
        memory: ArbitrationMemory,
        situation: &Situation,
    ) -> Decided {
        match self {
            Self::Subsumption => subsumption(behaviours, memory, situation),
            Self::Goals => goals(behaviours, memory, situation),
            Self::Schemas(sum) => schemas(sum, behaviours, memory, situation),
        }
    }
}

#[inline]
fn subsumption(behaviours: &[Ready], memory: ArbitrationMemory, situation: &Situation) -> Decided {
    let active = arbitrate(behaviours, memory.layers, situation);
    let Some(selection) = memory.selection else {
        return reactive(active);
    };
    selection.proposals.clear();
    selection.proposals.extend(active);
    selection.decide(behaviours, memory.layers, situation)
}

fn goals(behaviours: &[Ready], memory: ArbitrationMemory, situation: &Situation) -> Decided {
    let Some(selection) = memory.selection else {
        return reactive(arbitrate(behaviours, memory.layers, situation));
    };
    proposals(
        behaviours,
        memory.layers,
        situation,
        &mut selection.proposals,
    );
    selection.decide(behaviours, memory.layers, situation)
}

fn schemas(
    sum: &Sum,
    behaviours: &[Ready],
    memory: ArbitrationMemory,
    situation: &Situation,
) -> Decided {
    let noise = memory.noise.map(|noise| {
        let motion = sum.motion(behaviours, memory.layers, noise, situation);
        (None, motion)
    });
    noise.unwrap_or_default()
}

fn reactive(active: Option<(usize, Proposal)>) -> Decided {
    match active {
        Some((behaviour, Proposal::Motion(motion))) => (Some(behaviour), motion),
        _ => (None, Motion::default()),
    }
}
