//! Going ahead.

use super::common::ahead;
use crate::behaviours::behaviour::Behaviour;
use crate::goals::proposal::Proposal;
use crate::io::body::Body;
use crate::io::command::Motion;
use crate::perception::situation::Situation;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Goes ahead, always; whatever stands above it has its way first.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(inline)]
pub struct Cruise {
    /// Its speed, in m/s; left out, the most that the body can.
    #[schemars(range(min = 0.0, max = 100.0))]
    pub speed_m_s: Option<f64>,
}

/// [`Cruise`] in a body.
#[derive(Debug, Clone)]
pub(crate) struct Ready {
    motion: Motion,
}

impl Ready {
    pub(super) fn new(spec: &Cruise, body: &Body) -> Self {
        Self {
            motion: ahead(spec.speed_m_s, body),
        }
    }
}

impl Behaviour for Ready {
    type Memory = ();

    fn memory(&self) {}

    #[inline]
    fn triggered(&self, (): &mut (), _senses: &Situation) -> Option<Proposal> {
        Some(self.motion.into())
    }

    fn held(&self) -> Motion {
        self.motion
    }
}
