//! What every robot senses and decides from: the same moment for all.

use super::act::Body;
use super::flocks::Flocks;
use super::mind::Mind;
use super::neighbours::Neighbours;
use super::outside::Outside;
use super::state::{Hull, Status};
use crate::body::Layer;
use crate::body::kind::Kind;
use crate::body::path::Course;
use crate::scenario::Scenario;
use crate::sensing::eye::Eye;
use crate::world::items::Items;
use base::geometry::Disc;
use base::noise::Noise;
use brain::RobotId;

/// The world at the beginning of a step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct View<'a> {
    pub(crate) scenario: &'a Scenario,
    pub(crate) tick: u64,
    pub(crate) ids: &'a [RobotId],
    pub(crate) discs: &'a [Disc],
    pub(crate) courses: &'a [Course],
    pub(crate) hulls: &'a [Hull],
    pub(crate) noises: &'a [Noise],
    pub(crate) items: &'a Items,
    pub(crate) neighbours: &'a Neighbours,
    pub(crate) outside: Option<&'a Outside>,
    pub(crate) flocks: Option<&'a Flocks>,
    pub(crate) has_bodies_outside: bool,
}

impl<'a> View<'a> {
    #[inline]
    pub(crate) fn kind(&self, robot: usize) -> &'a Kind {
        &self.scenario.kinds[usize::from(self.ids[robot].kind)]
    }

    /// The eye of a robot for one look of one sensor.
    #[inline]
    pub(crate) fn eye(&self, robot: usize, sensor: usize, look: u64) -> Eye<'a> {
        Eye {
            at: self.discs[robot].centre,
            front: self.courses[robot].front,
            noise: self.noises[robot],
            #[expect(clippy::cast_possible_truncation, reason = "a robot has at most 32")]
            sensor: sensor as u32,
            look,
            stands: self
                .scenario
                .hiding([self.kind(robot).layer, Layer::Ground]),
            is_clear: false,
        }
    }

    /// Its body, as it is about to move.
    #[inline]
    pub(crate) fn body(&self, robot: usize, mind: &'a Mind) -> Body<'a> {
        Body {
            kind: self.kind(robot),
            hull: &self.hulls[robot],
            disc: &self.discs[robot],
            course: &self.courses[robot],
            mind,
            may_touch: self.neighbours.may_touch(robot),
        }
    }

    /// Whether its body is simulated, and can go on.
    pub(crate) fn is_simulated(&self, robot: usize) -> bool {
        let hull = &self.hulls[robot];
        hull.status == Status::Active && !hull.is_external
    }

    /// Whether its brain steps now, and its body is simulated.
    pub(crate) fn is_due(&self, robot: usize) -> bool {
        self.is_simulated(robot) && self.kind(robot).rhythm.beat(self.tick).is_some()
    }

    /// Whether it can hear at all.
    pub(crate) fn is_listening(&self, robot: usize) -> bool {
        let hull = &self.hulls[robot];
        hull.status == Status::Active && self.kind(robot).radio.is_some()
    }

    #[expect(clippy::cast_precision_loss, reason = "steps are at most 1e8")]
    pub(crate) fn time_s(&self) -> f64 {
        self.tick as f64 * self.scenario.step_s
    }
}
