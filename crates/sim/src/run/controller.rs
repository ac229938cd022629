//! A controller of a run.

use super::participant::{Participant, Place};
use economy::{Controller, Settings};
use std::sync::Arc;

/// A controller as a participant in communication.
#[derive(Debug, Clone)]
pub(crate) struct ControllerAgent {
    pub(crate) participant: Participant,
    pub(crate) controller: Controller,
}

impl ControllerAgent {
    /// Takes over memory, messages and place of a controller; radio and settings stay its own. Its memory names
    /// others by their ids: when these have changed, it restarts.
    pub(super) fn take_over(
        &mut self,
        before: &Self,
        settings: &Arc<Settings>,
        has_same_ids: bool,
    ) {
        self.controller = if has_same_ids {
            before.controller.with_settings_of(&self.controller)
        } else {
            Controller::restarted(settings.clone())
        };
        let (now, was) = (&mut self.participant, &before.participant);
        now.inbox.clone_from(&was.inbox);
        now.has_failed = was.has_failed;
        if let (Place::Fixed(..), Place::Fixed(..)) = (now.place, was.place) {
            now.place = was.place;
        }
    }
}
