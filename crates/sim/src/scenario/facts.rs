//! What is the same in all runs of a scenario.

use super::ready::Scenario;
use crate::clock::seconds;
use crate::world::item_number::ItemNumber;
use crate::world::items::ItemKind;
use economy::Settings;

/// The number of items of a kind, as text.
fn number_of(kind: &ItemKind) -> String {
    match kind.number {
        ItemNumber::Fixed => kind.count.to_string(),
        ItemNumber::Poisson => format!("{} on average, Poisson", kind.count),
    }
}

impl Scenario {
    /// Number of robots of each kind, in the order in which ids count them.
    #[must_use]
    pub fn team(&self) -> Vec<(String, u32)> {
        self.kinds
            .iter()
            .map(|kind| (kind.name.clone(), kind.count))
            .collect()
    }

    /// Names and counts of the kinds of controllers, in the order in which ids count them.
    #[must_use]
    pub fn controller_team(&self) -> Vec<(String, u32)> {
        let kinds = self.controllers.iter();
        kinds.map(|kind| (kind.name.clone(), kind.count)).collect()
    }

    /// What is the same in all runs, as text.
    pub(crate) fn facts(&self) -> Vec<(String, String)> {
        let size = self.world.size();
        let world = format!(
            "{} m by {} m, {} obstacles",
            size.x,
            size.y,
            self.solids().len()
        );
        let clock = format!("step {} s, time limit {} s", self.step_s, self.time_limit_s);
        let items = self.items.iter().map(|kind| {
            let clutter = if kind.is_target { "" } else { " (not target)" };
            (
                format!("items {}", kind.name),
                format!("{}{clutter}", number_of(kind)),
            )
        });
        let goals = self.goals.iter();
        let goals = goals.map(|kind| (format!("goals {}", kind.name), kind.count.to_string()));
        let controllers = self.controllers.iter();
        let controllers =
            controllers.map(|kind| (format!("controllers {}", kind.name), kind.count.to_string()));
        let items = items.chain(goals).chain(controllers);
        let end = self.end.iter().filter(|end| !end.is_default());
        let end = end.map(|end| ("complete when".to_owned(), end.comparison.to_string()));
        let facts = [("world".to_owned(), world), ("clock".to_owned(), clock)];
        facts.into_iter().chain(items).chain(end).collect()
    }

    /// How long a round of awards waits for bids, and what the loss of controllers of each kind
    /// costs.
    pub(crate) fn recoveries(&self) -> Vec<(String, String)> {
        let goals = self.number_of_goals();
        let kinds = self.controllers.iter().filter(|kind| kind.count > 0);
        let recoveries = kinds.map(|kind| {
            let delay_s = seconds(kind.radio.delay_steps, self.step_s);
            let within_s = kind.settings.recovery_s(goals, self.step_s, delay_s);
            let round_s = kind.settings.answer_s;
            let lost = of_losses(&kind.settings);
            let text = format!(
                "after an award, the next waits at most {round_s:.2} s for the bids that it has changed; {lost}; \
                 open goals have an owner or are reported, and are offered again, within {within_s:.1} s after a loss \
                 if no message is lost"
            );
            (format!("controllers.{}", kind.name), text)
        });
        recoveries.collect()
    }
}

/// What the loss of controllers costs, in words.
fn of_losses(settings: &Settings) -> String {
    match (settings.votes_needed(), settings.count) {
        (0, 2..) if settings.clearance.is_some() => {
            "what a lost controller had planned, the others plan".to_owned()
        }
        (0, _) => "the goals of a lost controller are lost with it".to_owned(),
        (_, 2) => "the loss of either controller leaves all goals without an owner".to_owned(),
        (_, count) => format!(
            "the loss of any {} of {count} controllers loses no goal",
            (count - 1) / 2
        ),
    }
}
