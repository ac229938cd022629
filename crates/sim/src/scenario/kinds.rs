//! The kinds of robots, controllers, goals and items of a scenario.

use super::ready::Scenario;
use crate::bodies::Layer;
use crate::bodies::kind::Kind;
use crate::controllers::kind::ControllerKind;
use brain::{AgentId, Brain};
use economy::Settings;
use std::sync::Arc;

impl Scenario {
    /// Names of the kinds of robots, in the order in which ids count them.
    pub fn robot_kinds(&self) -> impl Iterator<Item = &str> {
        self.kinds.iter().map(|kind| kind.name.as_str())
    }

    /// Names of the kinds of controllers, in the order in which ids count them after the kinds of robots.
    pub fn controller_kinds(&self) -> impl Iterator<Item = &str> {
        self.controllers.iter().map(|kind| kind.name.as_str())
    }

    /// Names of the kinds of goals.
    pub fn goal_kinds(&self) -> impl Iterator<Item = &str> {
        self.goals.iter().map(|kind| kind.name.as_str())
    }

    /// Names of the kinds of items, in the order in which contacts count them.
    pub fn item_kinds(&self) -> impl Iterator<Item = &str> {
        self.items.iter().map(|kind| kind.name.as_str())
    }

    /// Names of the kinds of items, each with the largest number of them in any configuration of the study.
    pub(crate) fn max_item_counts(&self) -> Vec<(&str, u32)> {
        let kinds = self.items.iter();
        let counts = kinds.map(|kind| (kind.name.as_str(), kind.max_count));
        counts.collect()
    }

    /// The kinds of items that are targets in any configuration of the study.
    pub(crate) fn mines(&self) -> Vec<&str> {
        let kinds = self.items.iter().filter(|kind| kind.may_be_target);
        kinds.map(|kind| kind.name.as_str()).collect()
    }

    /// The brain with which robots of a kind start.
    #[must_use]
    pub fn brain(&self, kind: u8) -> Option<&Brain> {
        self.kinds.get(usize::from(kind)).map(|kind| &kind.brain)
    }

    /// The radio range of a kind of robots, if they have a radio.
    #[must_use]
    pub fn radio_m(&self, kind: u8) -> Option<f64> {
        let kind = self.kinds.get(usize::from(kind))?;
        kind.radio.map(|radio| radio.range_m)
    }

    /// The layer of a kind of robots; none if there is no such kind.
    #[must_use]
    pub fn layer(&self, kind: u8) -> Option<Layer> {
        Some(self.kinds.get(usize::from(kind))?.layer)
    }

    /// The kind of a robot of a run. Ids from anywhere else, such as the senders of messages, may
    /// have no kind of robots.
    #[inline]
    pub(crate) fn kind_of(&self, robot: AgentId) -> &Kind {
        &self.kinds[usize::from(robot.kind)]
    }

    /// The number in ids of the kind of controllers of this number.
    #[expect(clippy::cast_possible_truncation, reason = "255 kinds at most")]
    pub(crate) fn controller_number(&self, kind: usize) -> u8 {
        (self.kinds.len() + kind) as u8
    }

    /// The settings of a kind of controllers, by its index among these kinds.
    #[must_use]
    pub fn controller_settings(&self, kind: usize) -> Option<&Arc<Settings>> {
        self.controllers.get(kind).map(|kind| &kind.settings)
    }

    /// The kind of a controller of a run.
    pub(crate) fn controller_kind_of(&self, controller: AgentId) -> &ControllerKind {
        &self.controllers[usize::from(controller.kind) - self.kinds.len()]
    }
}
