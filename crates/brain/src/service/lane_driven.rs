//! The ground of a lane that a robot has driven over.
//!
//! An item that destroys robots would have destroyed it there, whether its sensors can detect the item or not.

use crate::io::body::Body;
use crate::io::work::lane::Lane;
use crate::perception::beliefs::field::Field;
use crate::perception::beliefs::pose::Pose;
use alloc::vec;
use alloc::vec::Vec;
use base::geometry::Point;
use base::hashed::Hashed;

/// The parts of a lane over which a robot has driven.
#[derive(Debug, Clone, Hashed)]
pub(super) struct Driven {
    /// One for each part of the field; empty before the first.
    parts: Vec<bool>,
}

impl Driven {
    pub(super) fn new() -> Self {
        Self { parts: Vec::new() }
    }

    /// Takes the position of a robot. Returns whether an item in new parts would have destroyed it, being
    /// within a distance; that must be at least the side of a part.
    pub(super) fn take(&mut self, field: &Field, at: Point, radius_m: f64) -> bool {
        if radius_m < field.cell_m {
            return false;
        }
        if self.parts.is_empty() {
            self.parts = vec![false; field.cells()];
        }
        let reach = Point {
            x: radius_m,
            y: radius_m,
        };
        let [columns, rows] = field.columns_and_rows(reach.to(at), at.plus(reach));
        let mut is_new = false;
        for row in rows {
            for column in columns.clone() {
                let part = row * field.columns + column;
                if !self.parts[part] && field.centre(part).to(at).length() <= radius_m {
                    self.parts[part] = true;
                    is_new = true;
                }
            }
        }
        is_new
    }

    /// Whether it has driven over a part.
    pub(super) fn has(&self, part: usize) -> bool {
        self.parts.get(part) == Some(&true)
    }
}

/// How far from the estimated position of a robot an item of a lane would destroy it, less the error of that position, whichever
/// kind it is of; `None` if none does.
pub(super) fn danger_m(body: &Body, lane: &Lane, pose: &Pose) -> Option<f64> {
    let kinds = body.hazards_m.iter().enumerate();
    let to_clear = kinds.filter(|(kind, _)| lane.is_hazard(*kind));
    let nearest = to_clear.map(|(_, hazard_m)| *hazard_m);
    let nearest_m = nearest.reduce(|one, other| Some(one?.min(other?)))??;
    Some(body.radius_m + nearest_m - pose.deviation_m)
}
