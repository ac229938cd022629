//! Moving straight ahead.

use super::common::ahead;
use crate::behaviours::behaviour::Behaviour;
use crate::goals::proposal::Proposal;
use crate::io::body::Body;
use crate::io::command::Motion;
use crate::situation::Situation;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Moves straight ahead, always; every behaviour above it takes precedence.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(inline)]
pub struct Cruise {
    /// Speed, in m/s. Without it, the maximum speed of the body.
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
