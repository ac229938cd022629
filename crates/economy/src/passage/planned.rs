//! A path through a lane, with the risk of each vehicle on it.

use super::danger::danger;
use super::search::Search;
use super::settings::Passage;
use super::swath::Swath;
use crate::clearance::{BelievedMark, LanePicture};
use alloc::vec::Vec;
use base::geometry::Point;
use base::hashed::Hashed;
use brain::MarkVerdict;

/// A path through a lane, and what a controller believes of the vehicles that drive on it.
#[derive(Debug, Clone, PartialEq, Hashed)]
pub struct PlannedPassage {
    /// The corners of its middle line, from one short side of the lane to the other.
    pub path: Vec<Point>,
    /// Width of the path, in metres.
    pub width_m: f64,
    /// Its length, in metres.
    pub length_m: f64,
    /// Expected number of mines within its width.
    pub mines: f64,
    /// The probability that each vehicle is destroyed, in their order.
    pub risks: Vec<f64>,
}

impl PlannedPassage {
    /// The passage with the lowest expected number of mines within its width, by a belief of the lane; `None` if obstacles
    /// and isolated marks leave no room for one.
    #[must_use]
    pub fn new(passage: &Passage, picture: &LanePicture) -> Option<Self> {
        let grid = &passage.grid;
        let isolated = picture
            .marks()
            .filter(|mark| mark.verdict == Some(MarkVerdict::Isolated));
        let isolated: Vec<BelievedMark> = isolated.collect();
        let away_m = passage.keep_out_m + passage.width_m / 2.0;
        let is_free = |cell: usize| {
            let at = grid.centre(cell);
            let keeps_out = |mark: &BelievedMark| mark.at.to(at).length() >= away_m;
            let is_open = grid.is_inside(cell) && !passage.blocked[cell];
            is_open && isolated.iter().all(keeps_out)
        };
        let search = Search {
            grid,
            danger: &danger(picture, passage),
            is_free: &is_free,
            width_m: passage.width_m,
        };
        let path = corners(passage, &search.path()?);
        let contents = Swath::new(&path, passage.width_m).contents(picture, passage);
        Some(Self {
            width_m: passage.width_m,
            length_m: path
                .windows(2)
                .map(|ends| ends[0].to(ends[1]).length())
                .sum(),
            mines: contents.expected(),
            risks: contents.risks(&passage.effects, passage.vehicles),
            path,
        })
    }

    /// The risk of the first vehicle.
    #[must_use]
    pub fn first_risk(&self) -> f64 {
        self.risks.first().copied().unwrap_or_default()
    }

    /// The risk of the last vehicle.
    #[must_use]
    pub fn last_risk(&self) -> f64 {
        self.risks.last().copied().unwrap_or_default()
    }
}

impl Passage {
    /// Whether obstacles leave room for a path.
    #[must_use]
    pub fn has_room(&self) -> bool {
        let danger = alloc::vec![0.0; self.grid.cells()];
        let is_free = |cell: usize| self.grid.is_inside(cell) && !self.blocked[cell];
        let search = Search {
            grid: &self.grid,
            danger: &danger,
            is_free: &is_free,
            width_m: self.width_m,
        };
        search.path().is_some()
    }
}

/// The corners of a path through cells, from end to end of the lane.
fn corners(passage: &Passage, cells: &[usize]) -> Vec<Point> {
    let grid = &passage.grid;
    let step = |from: usize, to: usize| {
        [
            (to / grid.rows).wrapping_sub(from / grid.rows),
            (to % grid.rows).wrapping_sub(from % grid.rows),
        ]
    };
    let along = [1, 0];
    let mut path = Vec::new();
    path.extend(cells.first().map(|cell| grid.end(*cell, false)));
    for (place, cell) in cells.iter().enumerate() {
        let before = place
            .checked_sub(1)
            .map_or(along, |before| step(cells[before], *cell));
        let after = cells
            .get(place + 1)
            .map_or(along, |next| step(*cell, *next));
        if before != after {
            path.push(grid.centre(*cell));
        }
    }
    path.extend(cells.last().map(|cell| grid.end(*cell, true)));
    path
}
