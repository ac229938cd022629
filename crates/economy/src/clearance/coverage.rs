//! What robots have searched of a lane.

use alloc::vec;
use alloc::vec::Vec;
use base::hashed::Hashed;
use brain::{AgentId, CELLS_PER_MESSAGE, Coverage};
use core::ops::Range;

/// For each sensor model and cell, the evidence that there is no visible item without a mark.
#[derive(Debug, Clone, Default, Hashed)]
pub(super) struct Searched {
    robots: Vec<RobotSearched>,
    /// The sums over the robots of each model, in sixteenths of a nat.
    #[hashed(skip)]
    totals: Vec<Vec<u32>>,
    /// For each cell, the largest share that one robot has driven over, in steps of the messages: robots may drive along
    /// the same path.
    driven: Vec<u8>,
}

#[derive(Debug, Clone, Hashed)]
struct RobotSearched {
    robot: AgentId,
    model: usize,
    steps: Vec<u8>,
}

impl Searched {
    pub(super) fn new(models: usize, cells: usize) -> Self {
        Self {
            robots: Vec::new(),
            totals: vec![vec![0; cells]; models],
            driven: vec![0; cells],
        }
    }

    /// Number of sensor models.
    pub(super) fn models(&self) -> usize {
        self.totals.len()
    }

    /// Takes a message of a robot with a sensor model; the order of messages does not matter. Returns the cells of the message,
    /// or none where all of it was known.
    pub(super) fn take(
        &mut self,
        robot: AgentId,
        model: usize,
        coverage: &Coverage,
    ) -> Range<usize> {
        let Some(totals) = self.totals.get_mut(model) else {
            return 0..0;
        };
        let known = self.robots.iter().position(|known| known.robot == robot);
        let index = known.unwrap_or_else(|| {
            let steps = vec![0; totals.len()];
            self.robots.push(RobotSearched {
                robot,
                model,
                steps,
            });
            self.robots.len() - 1
        });
        let steps = &mut self.robots[index].steps;
        let cells = steps.iter_mut().zip(totals);
        let first = usize::try_from(coverage.first).unwrap_or(usize::MAX);
        let each = self.driven.iter_mut().skip(first);
        let mut is_new = false;
        for (cell, driven) in each.zip(coverage.driven) {
            is_new |= driven > *cell;
            *cell = driven.max(*cell);
        }
        for ((cell, total), missed) in cells.skip(first).zip(coverage.missed) {
            if missed > *cell {
                *total += Coverage::sixteenths(missed) - Coverage::sixteenths(*cell);
                *cell = missed;
                is_new = true;
            }
        }
        first..first.saturating_add(if is_new { CELLS_PER_MESSAGE } else { 0 })
    }

    /// The share of a cell that a robot has driven over without being destroyed.
    pub(super) fn driven(&self, cell: usize) -> f64 {
        self.driven.get(cell).copied().map_or(0.0, Coverage::share)
    }

    /// How often all looks of a model miss a visible item in a cell, in nats, without those of some
    /// robots of the model.
    pub(super) fn nats_without(&self, model: usize, cell: usize, robots: &[AgentId]) -> f64 {
        let total = self.totals.get(model).and_then(|totals| totals.get(cell));
        let total = total.copied().unwrap_or_default();
        if robots.is_empty() {
            return Coverage::nats(total);
        }
        let without = self
            .robots
            .iter()
            .filter(|one| one.model == model && robots.contains(&one.robot));
        let without = without.filter_map(|one| one.steps.get(cell).copied());
        let without: u32 = without.map(Coverage::sixteenths).sum();
        Coverage::nats(total.saturating_sub(without))
    }
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "multiples of 1/16")]
mod tests {
    use super::*;

    fn robot(index: u32) -> AgentId {
        AgentId::robot(0, index)
    }

    fn message(first: u32, steps: u8) -> Coverage {
        Coverage {
            first,
            marks: 0,
            missed: [steps; 16],
            driven: [0; 16],
        }
    }

    #[test]
    fn repeated_and_late_messages_change_nothing() {
        let mut searched = Searched::new(1, 40);
        for steps in [16, 32, 32, 16] {
            searched.take(robot(0), 0, &message(16, steps));
        }
        let nats = |cell| searched.nats_without(0, cell, &[]);
        assert_eq!(
            [nats(15), nats(16), nats(31), nats(32)],
            [0.0, 2.0, 2.0, 0.0]
        );
    }

    #[test]
    fn the_looks_of_several_robots_add_up_except_for_those_left_out() {
        let mut searched = Searched::new(2, 20);
        searched.take(robot(0), 0, &message(0, 16));
        searched.take(robot(1), 0, &message(0, 32));
        searched.take(robot(2), 1, &message(0, 48));
        assert_eq!(searched.nats_without(0, 3, &[]), 3.0);
        assert_eq!(searched.nats_without(0, 3, &[robot(1), robot(2)]), 1.0);
        assert_eq!(searched.nats_without(1, 3, &[]), 3.0);
    }

    #[test]
    fn cells_beyond_the_lane_are_ignored() {
        let mut searched = Searched::new(1, 20);
        searched.take(robot(0), 0, &message(16, 16));
        searched.take(robot(0), 0, &message(u32::MAX, 16));
        searched.take(robot(0), 7, &message(0, 16));
        assert_eq!(searched.nats_without(0, 19, &[]), 1.0);
        assert_eq!(searched.nats_without(0, 20, &[]), 0.0);
    }
}
