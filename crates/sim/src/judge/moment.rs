//! What a run is judged by.

use super::tally::Tally;
use crate::bodies::body_state::BodyState;
use crate::bodies::path::Orientation;
use crate::goals::placed::Goals;
use crate::passage::convoy::Convoy;
use crate::scenario::Scenario;
use crate::world::items::Items;
use base::geometry::Disc;

/// A run between two steps, as the judge sees it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Moment<'a> {
    pub(crate) scenario: &'a Scenario,
    /// Number of steps taken.
    pub(crate) tick: u64,
    pub(crate) items: &'a Items,
    pub(crate) tally: &'a Tally,
    /// Vehicles that pass a lane.
    pub(crate) convoy: Option<&'a Convoy>,
    pub(crate) goals: &'a Goals,
    /// Goals that controllers have refused.
    pub(crate) goals_refused: u32,
    /// Service leases that ended because the robot was silent.
    pub(crate) leases_lapsed: u32,
    pub(crate) discs: &'a [Disc],
    pub(crate) orientations: &'a [Orientation],
    pub(crate) body_states: &'a [BodyState],
}
