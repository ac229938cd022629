//! What every robot senses and decides from: the same moment for all.

use super::neighbours::Neighbours;
use crate::bodies::Layer;
use crate::bodies::body_state::{BodyState, Status};
use crate::bodies::kind::Kind;
use crate::bodies::path::Orientation;
use crate::bodies::region::Region;
use crate::run::agent::Agent;
use crate::run::controller::ControllerAgent;
use crate::run::state::State;
use crate::scenario::Scenario;
use crate::sensors::sensor_frame::SensorFrame;
use crate::world::items::Items;
use base::geometry::Disc;
use base::noise::Noise;
use brain::AgentId;

/// The world at the beginning of a step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct View<'a> {
    pub(crate) scenario: &'a Scenario,
    pub(crate) tick: u64,
    pub(crate) ids: &'a [AgentId],
    pub(crate) discs: &'a [Disc],
    pub(crate) orientations: &'a [Orientation],
    pub(crate) body_states: &'a [BodyState],
    pub(crate) noises: &'a [Noise],
    pub(crate) items: &'a Items,
    pub(crate) controllers: &'a [ControllerAgent],
    pub(crate) neighbours: &'a Neighbours,
    pub(crate) has_external_bodies: bool,
    /// Where external bodies may be.
    pub(crate) regions: &'a [Region],
}

impl<'a> View<'a> {
    #[inline]
    pub(crate) fn kind(&self, robot: usize) -> &'a Kind {
        self.scenario.kind_of(self.ids[robot])
    }

    /// Where one sensor of a robot measures from, and the random numbers of one measurement.
    #[inline]
    pub(crate) fn sensor_frame(
        &self,
        robot: usize,
        sensor: usize,
        measurement: u64,
    ) -> SensorFrame<'a> {
        SensorFrame {
            at: self.discs[robot].centre,
            front: self.orientations[robot].front,
            noise: self.noises[robot],
            #[expect(clippy::cast_possible_truncation, reason = "a robot has at most 32")]
            sensor: sensor as u32,
            measurement,
            geometry: self
                .scenario
                .hiding([self.kind(robot).layer, Layer::Ground]),
            is_clear: false,
        }
    }

    /// A bit for each sensor of a robot that the simulation does not measure.
    #[inline]
    pub(crate) fn unmeasured(&self, robot: usize) -> u32 {
        if !self.has_external_bodies {
            return 0;
        }
        let external = self.body_states[robot].external();
        external.map_or(0, |external| !external.virtual_sensors)
    }

    /// Whether its body is simulated, and can still move.
    pub(crate) fn is_simulated(&self, robot: usize) -> bool {
        let body_state = &self.body_states[robot];
        body_state.status == Status::Active && !body_state.is_external()
    }

    /// Whether its brain steps now, and its body is simulated.
    pub(crate) fn is_due(&self, robot: usize) -> bool {
        self.is_simulated(robot) && self.kind(robot).schedule.due(self.tick).is_some()
    }

    /// The time on the clock of a robot.
    #[inline]
    #[expect(clippy::cast_precision_loss, reason = "steps are at most 1e8")]
    pub(crate) fn time_s(&self, robot: usize) -> f64 {
        let time_s = self.tick as f64 * self.scenario.step_s;
        self.scenario.clocks.time_s(self.noises[robot], time_s)
    }
}

impl State {
    /// The view from which robots sense and decide, and their agents.
    pub(crate) fn view<'a>(
        &'a mut self,
        scenario: &'a Scenario,
        neighbours: &'a Neighbours,
    ) -> (View<'a>, &'a mut [Agent]) {
        let view = View {
            scenario,
            tick: self.tick,
            ids: &self.ids,
            discs: &self.discs,
            orientations: &self.orientations,
            body_states: &self.body_states,
            noises: &self.noises,
            items: &self.items,
            controllers: &self.controllers,
            neighbours,
            regions: &self.regions,
            has_external_bodies: self.body_states.iter().any(BodyState::is_external),
        };
        (view, &mut self.agents)
    }
}
