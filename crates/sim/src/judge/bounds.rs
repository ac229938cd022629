//! Bounds of what runs of a scenario can yield.

use super::goal_tally::GoalTally;
use crate::bodies::Layer;
use crate::bodies::kind::Kind;
use crate::scenario::Scenario;
use crate::world::terrain::{Terrain, TerrainFactors};

/// Rounding in a sum of many steps, and a step that begins before the time limit, must not exceed
/// the bound.
const HAIR: f64 = 1.001;

impl Scenario {
    /// Number of robots.
    pub(super) fn team_size(&self) -> f64 {
        self.of_team(|_| 1.0)
    }

    /// The price of the team and its controllers.
    pub(super) fn price(&self) -> f64 {
        let controllers = self.controllers.iter();
        let controllers = controllers.map(|kind| f64::from(kind.count) * kind.price);
        self.of_team(|kind| kind.price) + controllers.sum::<f64>()
    }

    /// Number of goals of all kinds.
    pub(crate) fn number_of_goals(&self) -> u32 {
        self.goals.iter().map(|kind| kind.count).sum()
    }

    /// The tally of goals of a run that begins, if there are kinds of goals.
    pub(super) fn goals(&self) -> Option<GoalTally> {
        let goals = self.number_of_goals() as usize;
        (!self.goals.is_empty()).then(|| GoalTally::new(goals, self.robots()))
    }

    #[expect(clippy::cast_precision_loss, reason = "steps are at most 1e8")]
    pub(super) fn max_collisions(&self) -> f64 {
        self.of_team(|_| self.steps as f64)
    }

    pub(super) fn max_energy_j(&self) -> f64 {
        let hardest = self.hardest();
        self.of_team(|kind| self.energy_of_j(kind, hardest))
    }

    pub(super) fn max_distance_m(&self) -> f64 {
        let hardest = self.hardest();
        self.of_team(|kind| self.distance_of_m(kind, hardest))
    }

    /// The energy of all robots of the kind of a number.
    pub(super) fn max_energy_of_j(&self, number: usize) -> f64 {
        let hardest = self.hardest();
        self.sum_over_kind(number, |kind| self.energy_of_j(kind, hardest))
    }

    /// The distance of all robots of the kind of a number.
    pub(super) fn max_distance_of_m(&self, number: usize) -> f64 {
        let hardest = self.hardest();
        self.sum_over_kind(number, |kind| self.distance_of_m(kind, hardest))
    }

    fn sum_over_kind(&self, number: usize, of_one: impl Fn(&Kind) -> f64) -> f64 {
        let kind = self.kinds.get(number);
        kind.map_or(0.0, |kind| f64::from(kind.count) * of_one(kind))
    }

    fn of_team(&self, of_one: impl Fn(&Kind) -> f64) -> f64 {
        let kinds = self.kinds.iter();
        kinds.map(|kind| f64::from(kind.count) * of_one(kind)).sum()
    }

    fn hardest(&self) -> TerrainFactors {
        let terrain = self.terrain.as_ref();
        terrain.map_or(TerrainFactors::NO_EFFECT, Terrain::most)
    }

    pub(super) fn longest_s(&self) -> f64 {
        HAIR * (self.time_limit_s + self.step_s)
    }

    fn distance_of_m(&self, kind: &Kind, hardest: TerrainFactors) -> f64 {
        let speed = if kind.layer == Layer::Ground {
            hardest.speed
        } else {
            1.0
        };
        kind.drive.fastest_m_s() * speed * self.longest_s()
    }

    fn energy_of_j(&self, kind: &Kind, hardest: TerrainFactors) -> f64 {
        let Some(battery) = &kind.battery else {
            return 0.0;
        };
        let effort = if kind.layer == Layer::Ground {
            hardest.energy
        } else {
            1.0
        };
        let standing_w = battery.idle_w + kind.sensing_w(0);
        let moving_j = battery.move_w * self.longest_s()
            + battery.move_j_per_m * self.distance_of_m(kind, hardest);
        let spent_j = standing_w * self.longest_s() + effort * moving_j;
        spent_j.min(battery.capacity_j)
    }
}
