//! What can be observed of a lane that controllers are to clear.

use super::state::State;
use crate::scenario::Scenario;
use brain::{Lane, RobotId};
use economy::{BelievedMark, LaneStatement, Risk};

/// What a controller believes of the lane that it is to clear.
#[derive(Debug, Clone, PartialEq)]
pub struct BelievedLane {
    /// The controller.
    pub controller: RobotId,
    /// The lane and its cells.
    pub lane: Lane,
    /// Expected number of mines without a mark in each cell, row by row from the lower left corner.
    pub unmarked: Vec<f64>,
    /// The places that robots have marked.
    pub marks: Vec<BelievedMark>,
    /// The remaining risk.
    pub risk: Risk,
    /// What it has stated about the lane.
    pub statement: Option<LaneStatement>,
}

impl State {
    /// What each controller with a lane believes of it.
    pub fn each_lane(&self) -> impl Iterator<Item = BelievedLane> {
        self.controllers.iter().filter_map(|agent| {
            let picture = agent.controller.lane()?;
            let lane = picture.clearance().lane;
            Some(BelievedLane {
                controller: agent.participant.id,
                lane,
                unmarked: (0..lane.cells())
                    .map(|cell| picture.unmarked(cell))
                    .collect(),
                marks: picture.marks().collect(),
                risk: picture.risk(),
                statement: agent.controller.lane_statement(),
            })
        })
    }

    /// Number of targets in the lane that are not destroyed; 0 without a lane.
    #[must_use]
    pub fn mines_left(&self, scenario: &Scenario) -> u32 {
        let Some(clearance) = scenario.clearance() else {
            return 0;
        };
        let lane = clearance.lane.area();
        let kinds = (0..).zip(self.items.kinds());
        let left = kinds.filter(|(item, kind)| {
            scenario.items[usize::from(*kind)].is_target
                && !self.items.is_gone(*item)
                && lane.contains(self.items.place(*item))
        });
        u32::try_from(left.count()).unwrap_or(u32::MAX)
    }
}
