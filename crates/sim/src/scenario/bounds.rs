//! Bounds of what runs of a scenario can yield, and what is the same in all runs.

use super::ready::Scenario;
use crate::bodies::Layer;
use crate::bodies::kind::Kind;
use crate::world::terrain::{Terrain, TerrainFactors};

/// Rounding in a sum of many steps, and a step that begins before the time limit, must not exceed
/// the bound.
const HAIR: f64 = 1.001;

/// Upper bounds of the bounded quantities of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Bounds {
    pub(crate) robots: f64,
    pub(crate) price: f64,
    pub(crate) targets: f64,
    pub(crate) collisions: f64,
    pub(crate) energy_j: f64,
    pub(crate) distance_m: f64,
}

impl Scenario {
    pub(crate) fn bounds(&self) -> Bounds {
        let hardest = self
            .terrain
            .as_ref()
            .map_or(TerrainFactors::NO_EFFECT, Terrain::most);
        let of_team = |of_one: &dyn Fn(&Kind) -> f64| {
            self.kinds
                .iter()
                .map(|kind| f64::from(kind.count) * of_one(kind))
                .sum::<f64>()
        };
        #[expect(clippy::cast_precision_loss, reason = "steps are at most 1e8")]
        let steps = self.steps as f64;
        Bounds {
            robots: of_team(&|_| 1.0),
            price: of_team(&|kind| kind.price),
            targets: f64::from(self.targets()),
            collisions: of_team(&|_| steps),
            energy_j: of_team(&|kind| self.max_energy_j(kind, hardest)),
            distance_m: of_team(&|kind| self.max_distance_m(kind, hardest)),
        }
    }

    fn longest_s(&self) -> f64 {
        HAIR * (self.time_limit_s + self.step_s)
    }

    fn max_distance_m(&self, kind: &Kind, hardest: TerrainFactors) -> f64 {
        let speed = if kind.layer == Layer::Ground {
            hardest.speed
        } else {
            1.0
        };
        let fastest = kind
            .drive
            .max_speed_m_s
            .max(kind.drive.max_reverse_speed_m_s);
        fastest * speed * self.longest_s()
    }

    fn max_energy_j(&self, kind: &Kind, hardest: TerrainFactors) -> f64 {
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
            + battery.move_j_per_m * self.max_distance_m(kind, hardest);
        let spent_j = standing_w * self.longest_s() + effort * moving_j;
        spent_j.min(battery.capacity_j)
    }

    /// Number of robots of each kind, in the order in which ids count them.
    #[must_use]
    pub fn team(&self) -> Vec<(String, u32)> {
        self.kinds
            .iter()
            .map(|kind| (kind.name.clone(), kind.count))
            .collect()
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
                format!("{}{clutter}", kind.count),
            )
        });
        let facts = [("world".to_owned(), world), ("clock".to_owned(), clock)];
        facts.into_iter().chain(items).collect()
    }
}
