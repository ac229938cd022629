//! A controller concludes what it states of a lane beside the risk.

use super::Controller;
use super::conclusion::LaneConclusion;
use crate::clearance::LanePicture;
use crate::passage::PlannedPassage;

impl Controller {
    /// What it has stated of the lane beside the risk; if it has stated nothing, what it would state now. `None` without
    /// a lane.
    #[must_use]
    pub fn lane_conclusion(&self) -> Option<LaneConclusion> {
        let work = self.clearing.work.as_ref()?;
        let stated = work.conclusion.clone();
        Some(stated.unwrap_or_else(|| self.concluded(&work.picture)))
    }

    /// The passage that it has stated.
    #[must_use]
    pub fn stated_passage(&self) -> Option<&PlannedPassage> {
        let work = self.clearing.work.as_ref()?;
        work.conclusion.as_ref()?.passage.as_ref()
    }

    pub(super) fn concluded(&self, picture: &LanePicture) -> LaneConclusion {
        let passage = self.settings.passage.as_deref();
        LaneConclusion {
            cleared: picture.cleared(),
            passage: passage.and_then(|passage| PlannedPassage::new(passage, picture)),
        }
    }
}
