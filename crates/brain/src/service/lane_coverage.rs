//! What a robot has searched of a lane, by its own detectors.
//!
//! The coverage map of its beliefs also contains what other robots report. Controllers receive the
//! looks of each robot from that robot, and count them once.

use super::ability::Moment;
use super::lane_driven::{Driven, danger_m};
use super::lane_masks::masks;
use crate::io::work::lane::{CELLS_PER_MESSAGE, Coverage, Lane};
use crate::perception::beliefs::Beliefs;
use crate::perception::beliefs::coverage_map::{CoverageMap, DetectorScan};
use crate::perception::beliefs::field::Field;
use alloc::vec;
use alloc::vec::Vec;
use base::geometry::Point;
use base::hashed::Hashed;
use core::ops::Range;

/// Parts of a cell along each side, and the maximum number of parts of all cells.
const PARTS: f64 = 2.0;
const MAX_PARTS: usize = 262_144;

/// The coverage of a lane.
#[derive(Debug, Clone, Hashed)]
pub(super) struct LaneCoverage {
    lane: Lane,
    /// Finer than the cells of the lane, as parts of a cell are at the edge of every look.
    #[hashed(skip)]
    field: Field,
    #[hashed(skip)]
    parts: Parts,
    own: CoverageMap,
    driven: Driven,
    /// What was sent last of each cell, and the next block of cells.
    sent: Vec<Cell>,
    next_block: usize,
    /// What is known of each cell, computed again for the blocks in view of later observations.
    #[hashed(skip)]
    now: Vec<Cell>,
    #[hashed(skip)]
    is_stale: Vec<bool>,
}

/// For each column and each row of cells, the columns and the rows of parts whose centres are in it.
#[derive(Debug, Clone)]
struct Parts {
    columns: Vec<Range<usize>>,
    rows: Vec<Range<usize>>,
}

/// What messages state of a cell.
#[derive(Debug, Clone, Copy, Default, PartialEq, Hashed)]
struct Cell {
    missed: u8,
    driven: u8,
}

impl LaneCoverage {
    pub(super) fn new(lane: Lane) -> Self {
        let blocks = lane.cells().div_ceil(CELLS_PER_MESSAGE);
        let side_m = f64::from(lane.cell_m) / PARTS;
        let field = Field::new(&lane.area(), side_m, MAX_PARTS);
        Self {
            lane,
            own: CoverageMap::new(field.cells()),
            driven: Driven::new(),
            parts: Parts::new(&lane, &field),
            field,
            sent: vec![Cell::default(); blocks * CELLS_PER_MESSAGE],
            next_block: 0,
            now: vec![Cell::default(); blocks * CELLS_PER_MESSAGE],
            is_stale: vec![false; blocks],
        }
    }

    pub(super) fn lane(&self) -> Lane {
        self.lane
    }

    /// Adds the measurements of a percept.
    pub(super) fn update(&mut self, moment: &Moment, beliefs: &Beliefs) {
        let Some(map) = &beliefs.map else {
            return;
        };
        self.drive(moment, beliefs);
        for observation in &moment.percept.observations {
            let mut detectors = moment.body.detectors.iter();
            let detector = detectors.find(|detector| detector.sensor == observation.sensor);
            let pose = beliefs.pose_then(observation.age_s, moment.body);
            if let (Some(detector), Some(pose)) = (detector, pose) {
                let scan = DetectorScan {
                    detector,
                    at: pose.at,
                    heading_rad: pose.heading_rad,
                    trust: 1.0,
                    observations: 1.0,
                    blur_m: pose.blur_m(),
                };
                let masks = masks(&self.lane, beliefs, detector, &pose);
                let map = (&map.field, &map.occupancy);
                self.own.update_with(&self.field, map, (&scan, &masks));
                self.note_look(pose.at, detector.range_m);
            }
        }
    }

    /// Adds the ground under the robot.
    fn drive(&mut self, moment: &Moment, beliefs: &Beliefs) {
        if let Some(pose) = beliefs.pose()
            && let Some(radius_m) = danger_m(moment.body, &self.lane, &pose)
            && self.driven.take(&self.field, pose.at, radius_m)
        {
            self.note_look(pose.at, radius_m);
        }
    }

    /// Notes that cells within a distance may have changed.
    fn note_look(&mut self, at: Point, within_m: f64) {
        let reach = Point {
            x: within_m,
            y: within_m,
        };
        let [low, high] = [reach.to(at), at.plus(reach)];
        let [columns, _] = self.lane.columns_and_rows();
        let [first, last] = [low, high].map(|corner| self.lane.nearest_cell(corner));
        for row in first / columns..=last / columns {
            let [from, to] = [first, last].map(|cell| row * columns + cell % columns);
            self.is_stale[from / CELLS_PER_MESSAGE..=to / CELLS_PER_MESSAGE].fill(true);
        }
    }

    /// Computes the cells that may have changed.
    fn refresh(&mut self) {
        for block in 0..self.is_stale.len() {
            if core::mem::take(&mut self.is_stale[block]) {
                let cells = self.block(block);
                self.now[block * CELLS_PER_MESSAGE..][..CELLS_PER_MESSAGE].copy_from_slice(&cells);
            }
        }
    }

    /// How often all looks miss a visible item at a position, in nats.
    pub(super) fn nats_at(&self, at: Point) -> f64 {
        let missed = self.own.of(self.field.nearest_cell(at));
        -libm::log(missed.max(f64::MIN_POSITIVE))
    }

    /// The messages to be sent, at most a number: changed blocks of cells, then others again, as
    /// messages are lost. `marks` is the number of marks so far.
    pub(super) fn due(&mut self, marks: u32, max: usize) -> Vec<Coverage> {
        self.refresh();
        let blocks = self.sent.len() / CELLS_PER_MESSAGE;
        let order = (0..blocks).map(|index| (self.next_block + index) % blocks);
        let (mut due, same): (Vec<usize>, Vec<usize>) = order.partition(|block| {
            let cells = block * CELLS_PER_MESSAGE..(block + 1) * CELLS_PER_MESSAGE;
            self.sent[cells.clone()] != self.now[cells]
        });
        due.truncate(max.saturating_sub(1));
        due.extend(same.into_iter().take(max - due.len()));
        if let Some(block) = due.last() {
            self.next_block = (block + 1) % blocks;
        }
        let send = |block: usize| {
            let first = block * CELLS_PER_MESSAGE;
            let cells: [Cell; CELLS_PER_MESSAGE] =
                core::array::from_fn(|index| self.now[first + index]);
            self.sent[first..first + CELLS_PER_MESSAGE].copy_from_slice(&cells);
            Coverage {
                first: u32::try_from(first).unwrap_or(u32::MAX),
                marks,
                missed: cells.map(|cell| cell.missed),
                driven: cells.map(|cell| cell.driven),
            }
        };
        due.into_iter().map(send).collect()
    }

    fn block(&self, block: usize) -> [Cell; CELLS_PER_MESSAGE] {
        core::array::from_fn(|index| {
            let cell = block * CELLS_PER_MESSAGE + index;
            if cell < self.lane.cells() {
                self.cell(cell)
            } else {
                Cell::default()
            }
        })
    }

    /// How often all looks miss a visible item at a random position of a cell of the lane, and how much of the cell has been
    /// driven over.
    fn cell(&self, cell: usize) -> Cell {
        let field = &self.field;
        let [columns, rows] = self.parts.of(cell);
        let (mut missed, mut driven, mut count) = (0.0, 0.0, 0.0);
        for row in rows {
            for part in row * field.columns + columns.start..row * field.columns + columns.end {
                let [part_missed, part_driven] = self.part(part);
                missed += part_missed;
                driven += part_driven;
                count += 1.0;
            }
        }
        if count < 1.0 {
            let nearest = self.part(field.nearest_cell(self.lane.centre(cell)));
            ([missed, driven], count) = (nearest, 1.0);
        }
        Cell::new(missed / count, driven / count)
    }

    /// The probability that all looks miss a visible item in a part, and whether it has been driven over.
    fn part(&self, part: usize) -> [f64; 2] {
        let driven = f64::from(u8::from(self.driven.has(part)));
        [self.own.of(part), driven]
    }
}

impl Parts {
    fn new(lane: &Lane, field: &Field) -> Self {
        let [columns, rows] = lane.columns_and_rows();
        let within = |cell: usize| {
            let area = lane.cell_area(cell);
            let [columns, rows] = field.columns_and_rows(area.min(), area.max());
            let (x, y) = (area.min().x..=area.max().x, area.min().y..=area.max().y);
            [
                span(columns, |column| x.contains(&field.centre(column).x)),
                span(rows, |row| y.contains(&field.centre(row * field.columns).y)),
            ]
        };
        let of_column = |column| {
            let [columns, _] = within(column);
            columns
        };
        let of_row = |row| {
            let [_, rows] = within(row * columns);
            rows
        };
        Self {
            columns: (0..columns).map(of_column).collect(),
            rows: (0..rows).map(of_row).collect(),
        }
    }

    /// Columns and rows of the parts of a cell.
    fn of(&self, cell: usize) -> [Range<usize>; 2] {
        let columns = self.columns.len();
        [
            self.columns[cell % columns].clone(),
            self.rows[cell / columns].clone(),
        ]
    }
}

/// The part of a range that has a property; there are no gaps in it.
fn span(range: Range<usize>, has: impl Fn(usize) -> bool) -> Range<usize> {
    let start = range.clone().find(|index| has(*index)).unwrap_or(range.end);
    let count = (start..range.end).take_while(|index| has(*index)).count();
    start..start + count
}

impl Cell {
    fn new(missed: f64, driven: f64) -> Self {
        Self {
            missed: Coverage::steps(-libm::log(missed.max(f64::MIN_POSITIVE))),
            driven: Coverage::parts(driven),
        }
    }
}
