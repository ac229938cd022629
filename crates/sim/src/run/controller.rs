//! A controller of a run.

use super::participant::{Participant, Place};
use brain::{Act, ActKind};
use economy::{Controller, Settings};
use std::sync::Arc;

/// A controller as a participant in communication.
#[derive(Debug, Clone)]
pub(crate) struct ControllerAgent {
    pub(crate) participant: Participant,
    pub(crate) controller: Controller,
    /// What it has stated about the lane that it is to clear: whether it has declared it clear.
    pub(crate) stated: Option<bool>,
    /// Whether its last decision was made elsewhere.
    pub(crate) is_elsewhere: bool,
}

impl ControllerAgent {
    /// Notes what it states by a command: only the first counts.
    pub(crate) fn note_acts(&mut self, acts: &[Act]) {
        let statement = acts.iter().find_map(|act| match act.kind {
            ActKind::DeclareClear => Some(true),
            ActKind::GiveUp => Some(false),
            _ => None,
        });
        if self.controller.lane().is_some() {
            self.stated = self.stated.or(statement);
        }
    }

    /// Takes over memory, messages and place of a controller; radio and settings stay its own. Its memory names
    /// others by their ids: when these have changed, it restarts, and so does one that was switched off.
    pub(super) fn take_over(
        &mut self,
        before: &Self,
        settings: &Arc<Settings>,
        is_remembered: bool,
    ) {
        self.controller = if is_remembered {
            before.controller.with_settings_of(&self.controller)
        } else {
            Controller::restarted(settings.clone())
        };
        (self.stated, self.is_elsewhere) = (before.stated, before.is_elsewhere);
        let (now, was) = (&mut self.participant, &before.participant);
        now.inbox.clone_from(&was.inbox);
        now.has_failed = was.has_failed;
        if let (Place::Fixed(..), Place::Fixed(..)) = (now.place, was.place) {
            now.place = was.place;
        }
    }
}
