//! A controller of a run.

use super::participant::{Participant, Place};
use super::state::{NoRoom, State, draws};
use crate::bodies::Layer;
use crate::controllers::kind::{ControllerBase, ControllerKind};
use crate::scenario::Scenario;
use base::noise::Noise;
use base::placement::{EntityClass, PlacementError};
use brain::RobotId;
use economy::Controller;

/// A controller as a participant in communication.
#[derive(Debug, Clone)]
pub(crate) struct ControllerAgent {
    pub(crate) participant: Participant,
    pub(crate) controller: Controller,
}

impl State {
    /// The controllers of a run that begins.
    pub(super) fn place_controllers(&mut self, scenario: &Scenario) -> Result<(), NoRoom> {
        for (number, kind) in scenario.controllers.iter().enumerate() {
            let number = scenario.controller_number(number);
            for index in 0..kind.count {
                let id = RobotId {
                    kind: number,
                    index,
                };
                let place = self.place_of(scenario, kind, id)?;
                let draws = (kind.entity(index), self.noise_of(kind, index));
                self.controllers.push(ControllerAgent {
                    participant: Participant::new(id, place, kind.radio, draws),
                    controller: Controller::new(kind.settings.clone()),
                });
            }
        }
        Ok(())
    }

    fn noise_of(&self, kind: &ControllerKind, index: u32) -> Noise {
        Noise::of(self.seed, self.run, kind.entity(index))
    }

    fn place_of(
        &self,
        scenario: &Scenario,
        kind: &ControllerKind,
        id: RobotId,
    ) -> Result<Place, NoRoom> {
        let no_room = |why| NoRoom::Controller { id, why };
        match &kind.base {
            ControllerBase::Placed(placement) => {
                let draws = draws(scenario, self.seed, self.run, EntityClass::Robots);
                let is_free = |place| scenario.is_free(place, 0.0, Layer::Ground);
                let place = placement.place(&draws, kind.entity(id.index), is_free);
                let place = place.map_err(no_room)?;
                Ok(Place::Fixed(scenario.home(place), Layer::Ground))
            }
            ControllerBase::Aboard(carriers) => {
                let carrier = RobotId {
                    kind: *carriers,
                    index: id.index,
                };
                let robot = self.ids.binary_search(&carrier).ok();
                let robot = robot.and_then(|robot| u32::try_from(robot).ok());
                // A scenario has a carrier for each.
                let robot = robot.ok_or(no_room(PlacementError::Taken))?;
                Ok(Place::Aboard(robot))
            }
        }
    }
}

impl ControllerAgent {
    /// Takes over memory, messages and place of a controller; radio and settings stay its own.
    pub(super) fn take_over(&mut self, before: &Self) {
        self.controller = before.controller.with_settings_of(&self.controller);
        let (now, was) = (&mut self.participant, &before.participant);
        now.inbox.clone_from(&was.inbox);
        now.has_failed = was.has_failed;
        if let (Place::Fixed(..), Place::Fixed(..)) = (now.place, was.place) {
            now.place = was.place;
        }
    }
}
