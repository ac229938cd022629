//! What can be observed of a lane that controllers are to clear.

use super::state::State;
use crate::judge::clearance_tally::Remains;
use crate::passage::Vehicle;
use crate::scenario::Scenario;
use base::geometry::{Point, Rectangle};
use brain::{AgentId, Lane};
use core::f64::consts::FRAC_1_SQRT_2;
use economy::{BelievedMark, ClearedShare, LanePicture, LaneStatement, PlannedPassage, Risk};

/// What a controller believes of the lane that it is to clear.
#[derive(Debug, Clone, PartialEq)]
pub struct BelievedLane {
    /// The controller.
    pub controller: AgentId,
    /// The lane and its cells.
    pub lane: Lane,
    /// Expected number of mines without a mark in each cell, row by row from the lower left corner.
    pub unmarked: Vec<f64>,
    /// The places that robots have marked.
    pub marks: Vec<BelievedMark>,
    /// The remaining risk.
    pub risk: Risk,
    /// The ground of the lane that is not inside of obstacles, in square metres.
    pub free_m2: f64,
    /// The lane is declared clear when the probability that at least one mine is left is below this.
    pub declare_below: f64,
    /// What it has stated about the lane.
    pub statement: Option<LaneStatement>,
    /// The share of the mines of each kind that are cleared.
    pub cleared: Vec<ClearedShare>,
    /// The path on which vehicles are to pass, once it has stated one.
    pub passage: Option<PlannedPassage>,
}

impl BelievedLane {
    /// Expected number of mines in each cell, row by row from the lower left corner: those without a mark, and those at
    /// marks, distributed as their positions are.
    #[must_use]
    pub fn expected(&self) -> Vec<f64> {
        let mut expected = self.unmarked.clone();
        let [columns, rows] = self.lane.columns_and_rows();
        let right: Vec<Rectangle> = (0..columns).map(|cell| self.lane.cell_area(cell)).collect();
        let up: Vec<Rectangle> = (0..rows)
            .map(|row| self.lane.cell_area(row * columns))
            .collect();
        for mark in &self.marks {
            let share = |from_m, to_m, at_m| share_between([from_m, to_m], at_m, mark.deviation_m);
            let right = right
                .iter()
                .map(|cell| share(cell.min().x, cell.max().x, mark.at.x));
            let right: Vec<f64> = right.collect();
            let up = up
                .iter()
                .map(|cell| share(cell.min().y, cell.max().y, mark.at.y));
            for (row, up) in up.enumerate().filter(|(_, up)| *up > 0.0) {
                for (cell, right) in right.iter().enumerate() {
                    expected[row * columns + cell] += mark.mine * up * right;
                }
            }
        }
        expected
    }

    /// Expected number of mines per square metre below which a place is cleared: with that density everywhere, the
    /// controller would just declare the lane clear.
    #[must_use]
    pub fn cleared_below_per_m2(&self) -> f64 {
        -libm::log1p(-self.declare_below) / self.free_m2
    }
}

/// Probability that a normally distributed coordinate is between two others.
fn share_between([from_m, to_m]: [f64; 2], at_m: f64, deviation_m: f64) -> f64 {
    let below = |along_m: f64| libm::erf((along_m - at_m) / deviation_m * FRAC_1_SQRT_2) / 2.0;
    below(to_m) - below(from_m)
}

impl State {
    /// What each controller with a lane believes of it.
    pub fn each_lane(&self) -> impl Iterator<Item = BelievedLane> {
        self.controllers.iter().filter_map(|agent| {
            let picture = agent.controller.lane()?;
            let lane = picture.clearance().lane;
            Some(BelievedLane {
                controller: agent.participant.id,
                lane,
                unmarked: (0..lane.cells())
                    .map(|cell| picture.unmarked(cell))
                    .collect(),
                marks: picture.marks().collect(),
                risk: picture.risk(),
                free_m2: picture.clearance().free_area_m2(),
                declare_below: picture.clearance().declare_below,
                statement: agent.controller.lane_statement(),
                cleared: picture.cleared(),
                passage: agent.controller.stated_passage().cloned(),
            })
        })
    }

    /// The vehicles that pass a lane, in their order; none before it is declared clear.
    pub fn each_vehicle(&self) -> impl Iterator<Item = Vehicle> {
        self.convoy.iter().flat_map(|convoy| convoy.each_vehicle())
    }

    /// Number of items of a kind in the lane at the start, and of those that are not destroyed.
    pub(crate) fn mines_of(&self, scenario: &Scenario, kind: usize) -> [u32; 2] {
        let lane = scenario.clearance().map(|clearance| clearance.lane.area());
        let kinds = (0..).zip(self.items.kinds());
        let own = kinds.filter(|(item, of)| {
            let is_inside = lane.is_some_and(|lane| lane.contains(self.items.place(*item)));
            usize::from(*of) == kind && is_inside
        });
        own.fold([0, 0], |[all, left], (item, _)| {
            [all + 1, left + u32::from(!self.items.is_gone(item))]
        })
    }

    /// Number of targets in the lane that are not destroyed; 0 without a lane.
    #[must_use]
    pub fn mines_left(&self, scenario: &Scenario) -> u32 {
        u32::try_from(self.each_mine_left(scenario).count()).unwrap_or(u32::MAX)
    }

    /// The positions of the targets in the lane that are not destroyed.
    fn each_mine_left(&self, scenario: &Scenario) -> impl Iterator<Item = Point> {
        let lane = scenario.clearance().map(|clearance| clearance.lane.area());
        let kinds = (0..).zip(self.items.kinds());
        kinds.filter_map(move |(item, kind)| {
            let is_left = scenario.items[usize::from(kind)].is_target && !self.items.is_gone(item);
            let at = self.items.place(item);
            (is_left && lane.is_some_and(|lane| lane.contains(at))).then_some(at)
        })
    }

    /// The mines that are left, and what a controller believes of them.
    pub(crate) fn remains(&self, scenario: &Scenario, controller: usize) -> Remains {
        let agent = self.controllers.get(controller);
        let picture = agent.and_then(|agent| agent.controller.lane());
        let risk = picture.map(LanePicture::risk);
        let at_marks = |at: Point| picture.map_or(0.0, |picture| picture.share_of_marks(at));
        Remains {
            mines: self.mines_left(scenario),
            at_marks: self.each_mine_left(scenario).map(at_marks).sum(),
            believed_unmarked: risk.map_or(0.0, |risk| risk.unmarked),
            believed_marked: risk.map_or(0.0, |risk| risk.marked),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lane(at: Point) -> BelievedLane {
        let lane = Lane {
            min_m: [-1.0, 2.0],
            max_m: [9.0, 7.0],
            cell_m: 2.0,
            hazards: 1,
        };
        BelievedLane {
            controller: AgentId::controller(0, 0),
            lane,
            unmarked: vec![1e-3; lane.cells()],
            marks: vec![BelievedMark {
                number: 0,
                at,
                deviation_m: 0.5,
                probabilities: [0.8, 0.0, 0.0, 0.0],
                mine: 0.8,
                verdict: None,
                failed_charges: 0,
            }],
            risk: Risk {
                unmarked: 0.015,
                marked: 0.8,
                probability: 0.8,
            },
            free_m2: lane.area().area_m2(),
            declare_below: 0.05,
            statement: None,
            cleared: Vec::new(),
            passage: None,
        }
    }

    #[test]
    fn the_expected_mines_of_a_mark_are_distributed_as_its_position_is() {
        let total = |lane: &BelievedLane| lane.expected().iter().sum::<f64>();
        let inside = lane(Point { x: 4.0, y: 5.0 });
        assert!((total(&inside) - 0.815).abs() < 1e-4);
        let expected = inside.expected();
        let cell = inside.lane.nearest_cell(Point { x: 4.0, y: 5.0 });
        let highest = expected.iter().copied().fold(0.0, f64::max);
        assert_eq!(expected[cell], highest);
        // Two deviations to each side of the cell.
        assert!((highest - 0.001 - 0.8 * 0.9545 * 0.9545).abs() < 1e-4);
        let on_the_border = lane(Point { x: 4.0, y: 2.0 });
        assert!((total(&on_the_border) - 0.415).abs() < 1e-4);
    }

    #[test]
    fn a_lane_with_the_density_of_cleared_places_is_just_declared_clear() {
        let lane = lane(Point::default());
        let expected = lane.cleared_below_per_m2() * lane.lane.area().area_m2();
        assert!((1.0 - libm::exp(-expected) - 0.05).abs() < 1e-12);
    }
}
