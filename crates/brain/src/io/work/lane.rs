//! Messages about a mined lane: its cells, what robots have searched and marked, and what they state.

use crate::io::agent_id::AgentId;
use crate::io::goal_id::GoalId;
use base::geometry::{Point, Rectangle};
use base::hashed::Hashed;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Larger coordinates in metres are invalid.
pub(crate) const MAX_COORDINATE_M: f32 = 1e7;

/// Maximum number of cells of a lane.
const MAX_CELLS: f64 = 65_536.0;

/// Number of cells that one message covers.
pub const CELLS_PER_MESSAGE: usize = 16;

/// Number of kinds of items that marks distinguish.
pub const MARK_KINDS: usize = 4;

/// Probability that an item in a lane has another one beside it, as they may lie in groups whatever their number: an assumption.
pub const HAS_ANOTHER: f64 = 0.03;

/// Steps of coverage up to this one are a sixteenth of a nat, the others a half.
const FINE_STEPS: u8 = 128;
const PER_NAT: f64 = 16.0;
const PER_COARSE_STEP: u32 = 8;

/// Largest plausible log likelihood ratio of a mark, in nats.
const MAX_LOG_RATIO: f32 = 1e4;

/// A message about a mined lane.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum LaneMessage {
    /// From a controller to robots: a lane of which it needs coverage and marks.
    Lane(Lane),
    /// From a robot to controllers: what it has searched of the lane.
    Coverage(Coverage),
    /// From a robot to controllers: a place where it has detected something.
    Mark(Mark),
    /// From a robot to controllers: what it states about a mark.
    Statement(Statement),
    /// From a controller to others: the expected number of mines of a lane that its goals may still find or destroy.
    Gain(f32),
}

impl LaneMessage {
    pub(in crate::io) fn urgency(&self) -> u8 {
        match self {
            Self::Gain(_) => 3,
            _ => 1,
        }
    }
}

/// A lane to be cleared, as a grid of square cells, row by row from the lower left corner.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(deny_unknown_fields)]
pub struct Lane {
    /// Its lower left corner in the world, in metres.
    pub min_m: [f32; 2],
    /// Its upper right corner.
    pub max_m: [f32; 2],
    /// Side of a cell. The last cells of rows and columns may reach beyond the lane.
    pub cell_m: f32,
    /// The kinds of items that are to be cleared: one bit for each, from the lowest.
    pub hazards: u8,
}

impl Lane {
    /// Whether it has an area, and at most 65,536 cells.
    #[must_use]
    pub fn is_valid(&self) -> bool {
        let mut corners = self.min_m.into_iter().chain(self.max_m);
        let is_wide = self.min_m[0] < self.max_m[0] && self.min_m[1] < self.max_m[1];
        let is_square = self.cell_m.is_finite() && self.cell_m > 0.0;
        let is_grid = corners.all(f32::is_finite) && is_wide && is_square;
        is_grid && self.extent().into_iter().product::<f64>() <= MAX_CELLS
    }

    /// Whether items of a kind are to be cleared.
    #[must_use]
    pub fn is_hazard(&self, kind: usize) -> bool {
        kind < MARK_KINDS && self.hazards >> kind & 1 == 1
    }

    /// Its area in the world.
    #[must_use]
    pub fn area(&self) -> Rectangle {
        let corner = |at_m: [f32; 2]| Point::from(at_m.map(f64::from));
        Rectangle::spanned(corner(self.min_m), corner(self.max_m))
    }

    fn extent(&self) -> [f64; 2] {
        let size = self.area().size();
        [size.x, size.y].map(|side_m| libm::ceil(side_m / f64::from(self.cell_m)).max(1.0))
    }

    /// Number of columns and rows.
    #[must_use]
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "at most 65,536 cells"
    )]
    pub fn columns_and_rows(&self) -> [usize; 2] {
        self.extent().map(|count| count.min(MAX_CELLS) as usize)
    }

    /// Number of cells.
    #[must_use]
    pub fn cells(&self) -> usize {
        let [columns, rows] = self.columns_and_rows();
        columns * rows
    }

    /// The part of a cell that is in the lane.
    #[must_use]
    #[expect(clippy::cast_precision_loss, reason = "at most 65,536 cells")]
    pub fn cell_area(&self, cell: usize) -> Rectangle {
        let [columns, _] = self.columns_and_rows();
        let (area, side_m) = (self.area(), f64::from(self.cell_m));
        let (right, up) = ((cell % columns) as f64, (cell / columns) as f64);
        let corner = |right: f64, up: f64| Point {
            x: (area.min().x + right * side_m).min(area.max().x),
            y: (area.min().y + up * side_m).min(area.max().y),
        };
        Rectangle::spanned(corner(right, up), corner(right + 1.0, up + 1.0))
    }

    /// The centre of the part of a cell that is in the lane.
    #[must_use]
    pub fn centre(&self, cell: usize) -> Point {
        let area = self.cell_area(cell);
        area.min().plus(area.size().times(0.5))
    }

    /// The cell nearest to a position.
    #[must_use]
    pub fn nearest_cell(&self, at: Point) -> usize {
        let area = self.area();
        let within = Point {
            x: at.x.max(area.min().x).min(area.max().x),
            y: at.y.max(area.min().y).min(area.max().y),
        };
        self.cell_at(within).unwrap_or_default()
    }

    /// The cell that contains a position; `None` outside the lane.
    #[must_use]
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "within the lane"
    )]
    pub fn cell_at(&self, at: Point) -> Option<usize> {
        let area = self.area();
        if !area.contains(at) {
            return None;
        }
        let [columns, rows] = self.columns_and_rows();
        let offset = area.min().to(at);
        let [column, row] =
            [offset.x, offset.y].map(|along_m| (along_m / f64::from(self.cell_m)) as usize);
        Some(row.min(rows - 1) * columns + column.min(columns - 1))
    }
}

/// What all looks of a robot so far have missed, for 16 cells of a lane. It is cumulative: a later
/// message replaces an earlier one, and a repeated one changes nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(deny_unknown_fields)]
pub struct Coverage {
    /// The first of the cells.
    pub first: u32,
    /// Number of marks of the robot so far. Looks without a mark are evidence of a clear place only
    /// for a receiver that has all marks.
    pub marks: u32,
    /// For each cell, the probability that all looks miss an item there that the sensors can detect,
    /// as its negative logarithm in steps: 1/16 nat each up to 128 steps, and 1/2 nat above; 255 stands for 255 or more.
    pub missed: [u8; CELLS_PER_MESSAGE],
    /// For each cell, the share of it that the robot has driven over, so that an item there would have destroyed it, in
    /// steps of 1/255.
    pub driven: [u8; CELLS_PER_MESSAGE],
}

impl Coverage {
    /// The nearest step for a negative logarithm in nats.
    #[must_use]
    pub fn steps(nats: f64) -> u8 {
        // A number that is none counts as no look.
        let fine = if nats > 0.0 { nats * PER_NAT } else { 0.0 };
        let coarse = (fine - f64::from(FINE_STEPS)) / f64::from(PER_COARSE_STEP);
        let steps = fine.min(f64::from(FINE_STEPS) + coarse.max(0.0));
        byte(steps)
    }

    /// A share as coverage states it.
    #[must_use]
    pub fn parts(share: f64) -> u8 {
        byte(share * 255.0)
    }

    /// The share for a number of parts.
    #[must_use]
    pub fn share(parts: u8) -> f64 {
        f64::from(parts) / 255.0
    }

    /// The negative logarithm for a number of steps, in sixteenths of a nat: sums of them are exact.
    #[must_use]
    pub fn sixteenths(steps: u8) -> u32 {
        let fine = steps.min(FINE_STEPS);
        u32::from(fine) + PER_COARSE_STEP * u32::from(steps - fine)
    }

    /// Nats for a number of sixteenths.
    #[must_use]
    pub fn nats(sixteenths: u32) -> f64 {
        f64::from(sixteenths) / PER_NAT
    }
}

/// The nearest whole number from 0 to 255.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped"
)]
fn byte(number: f64) -> u8 {
    libm::round(number).clamp(0.0, f64::from(u8::MAX)) as u8
}

/// A place where a robot has detected something. It is cumulative: a later message replaces an earlier
/// one with the same id.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(deny_unknown_fields)]
pub struct Mark {
    /// Its id: the robot, and the number that the robot gave it.
    pub id: GoalId,
    /// Its position in the world, in metres.
    pub at_m: [f32; 2],
    /// Standard deviation of the position along each axis, the error of the robot's pose included, in millimetres.
    pub deviation_mm: u16,
    /// How often all looks of the robot since it has stopped tracking the item miss a visible item there, in the steps of
    /// coverage: since something there has been destroyed. 0 while it tracks the item.
    pub missed_since: u8,
    /// Expected number of items to be cleared that are left there when one item has been destroyed, in steps of 1/100.
    pub further: u8,
    /// For each of the first four kinds of items, the log likelihood ratio of all looks of the robot
    /// at the place, contacts and misses: an item of that kind that its sensors can detect, against
    /// nothing there but false alarms.
    pub log_ratios: [f32; MARK_KINDS],
}

impl Mark {
    /// The robot that has detected it. Receivers ignore a mark whose issuer is not its sender.
    #[must_use]
    pub fn robot(&self) -> AgentId {
        self.id.issuer.agent().unwrap_or_default()
    }

    /// Its position in the world.
    #[must_use]
    pub fn at(&self) -> Point {
        Point::from(self.at_m.map(f64::from))
    }

    /// Standard deviation of its position along each axis, in metres.
    #[must_use]
    pub fn deviation_m(&self) -> f64 {
        f64::from(self.deviation_mm) / 1e3
    }

    /// A standard deviation in metres as a mark states it.
    #[must_use]
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped"
    )]
    pub fn millimetres(deviation_m: f64) -> u16 {
        libm::round(deviation_m * 1e3).clamp(1.0, f64::from(u16::MAX)) as u16
    }

    /// How often all looks since it has stopped tracking the item miss a visible item there, in nats.
    #[must_use]
    pub fn missed_since_nats(&self) -> f64 {
        Coverage::nats(Coverage::sixteenths(self.missed_since))
    }

    /// An expected number of further items as a mark states it.
    #[must_use]
    pub fn hundredths(further: f64) -> u8 {
        byte(further * 100.0)
    }

    /// Expected number of items to be cleared that are left when one item there has been destroyed now.
    #[must_use]
    pub fn further(&self) -> f64 {
        f64::from(self.further) / 100.0 * libm::exp(-self.missed_since_nats())
    }

    /// Whether all of its numbers are finite and plausible.
    #[must_use]
    pub fn is_valid(&self) -> bool {
        let is_near = |along_m: f32| along_m.abs() <= MAX_COORDINATE_M;
        let mut ratios = self.log_ratios.into_iter();
        self.deviation_mm > 0
            && self.at_m.into_iter().all(is_near)
            && ratios.all(|ratio| ratio.abs() <= MAX_LOG_RATIO)
    }
}

/// What a robot states about a mark.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(deny_unknown_fields)]
pub struct Statement {
    /// The mark, or the goal that the robot served there.
    pub mark: GoalId,
    /// Its position in the world, in metres: receivers may not know the goal.
    pub at_m: [f32; 2],
    /// The statement.
    pub verdict: MarkVerdict,
}

/// A verdict on a mark.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(rename_all = "snake_case")]
pub enum MarkVerdict {
    /// There is an item that is to be cleared.
    Confirmed,
    /// There is none.
    Rejected,
    /// It is fenced off, so that traffic keeps clear of it.
    Isolated,
    /// Something there has been destroyed.
    Neutralised,
    /// A charge there has destroyed nothing.
    Missed,
}

#[cfg(test)]
mod tests {
    use super::*;

    const LANE: Lane = Lane {
        min_m: [-1.0, 2.0],
        max_m: [9.0, 7.0],
        cell_m: 2.0,
        hazards: 0b10,
    };

    #[test]
    fn the_cells_of_a_lane_fill_its_area() {
        assert_eq!(LANE.columns_and_rows(), [5, 3]);
        let areas_m2 = (0..LANE.cells()).map(|cell| LANE.cell_area(cell).area_m2());
        assert!((areas_m2.sum::<f64>() - 50.0).abs() < 1e-9);
        for cell in 0..LANE.cells() {
            assert_eq!(LANE.cell_at(LANE.centre(cell)), Some(cell));
        }
        assert_eq!(LANE.cell_at(Point { x: 9.0, y: 7.0 }), Some(14));
        assert_eq!(LANE.cell_at(Point { x: 9.1, y: 7.0 }), None);
        assert_eq!(LANE.nearest_cell(Point { x: 9.1, y: 1.0 }), 4);
    }

    #[test]
    fn a_lane_names_the_kinds_that_are_to_be_cleared() {
        assert_eq!(
            [0, 1, 2, 9].map(|kind| LANE.is_hazard(kind)),
            [false, true, false, false]
        );
    }

    #[test]
    fn lanes_with_absurd_numbers_are_invalid() {
        assert!(LANE.is_valid());
        for absurd in [
            Lane {
                cell_m: 0.0,
                ..LANE
            },
            Lane {
                cell_m: 1e-3,
                ..LANE
            },
            Lane {
                cell_m: f32::NAN,
                ..LANE
            },
            Lane {
                max_m: [-1.0, 7.0],
                ..LANE
            },
            Lane {
                max_m: [f32::INFINITY, 7.0],
                ..LANE
            },
        ] {
            assert!(!absurd.is_valid(), "{absurd:?}");
        }
    }

    #[test]
    fn coverage_is_rounded_to_the_nearest_step_and_saturates() {
        for (nats, error) in [
            (0.0, 0.0),
            (0.4, 1.0 / 32.0),
            (7.99, 1.0 / 32.0),
            (8.3, 0.25),
            (70.9, 0.25),
        ] {
            let rounded = Coverage::nats(Coverage::sixteenths(Coverage::steps(nats)));
            assert!((rounded - nats).abs() <= error, "{nats}: {rounded}");
        }
        assert_eq!(Coverage::steps(1e9), 255);
        assert_eq!(Coverage::steps(-1.0), 0);
    }

    #[test]
    fn marks_with_absurd_numbers_are_invalid() {
        let mark = Mark {
            id: GoalId::default(),
            at_m: [1.0, 2.0],
            deviation_mm: 300,
            log_ratios: [4.0, -2.0, 0.0, 0.0],
            missed_since: 0,
            further: 0,
        };
        assert!(mark.is_valid());
        for absurd in [
            Mark {
                deviation_mm: 0,
                ..mark
            },
            Mark {
                at_m: [f32::NAN, 0.0],
                ..mark
            },
            Mark {
                log_ratios: [f32::INFINITY; MARK_KINDS],
                ..mark
            },
        ] {
            assert!(!absurd.is_valid(), "{absurd:?}");
        }
    }
}
