//! Vehicles on a path, one after the other.

use super::PassageSpec;
use crate::scenario::Scenario;
use crate::world::items::Items;
use base::geometry::{Point, Segment};
use base::hashed::Hashed;
use economy::PlannedPassage;

/// Vehicles on a path.
#[derive(Debug, Clone, PartialEq, Hashed)]
pub(crate) struct Convoy {
    /// The corners of the path.
    #[hashed(skip)]
    path: Vec<Point>,
    /// How far along the path each corner is.
    #[hashed(skip)]
    corners_m: Vec<f64>,
    #[hashed(skip)]
    width_m: f64,
    pub(crate) vehicles: Vec<Moving>,
    /// Since when all of them have passed or are destroyed.
    pub(crate) ended_at: Option<u64>,
}

/// A vehicle on the path.
#[derive(Debug, Clone, Copy, PartialEq, Hashed)]
pub(crate) struct Moving {
    /// How far along the path it is; below 0 before the path.
    pub(crate) along_m: f64,
    pub(crate) status: VehicleStatus,
}

/// What has become of a vehicle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VehicleStatus {
    /// It is before the path, or on it.
    Driving,
    /// It has reached the other end of the lane.
    Passed,
    /// A mine has destroyed it.
    Lost,
}

impl Hashed for VehicleStatus {
    fn add_to(&self, hash: &mut base::hash::Hash) {
        hash.add(*self as u64);
    }
}

/// A vehicle that passes a lane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vehicle {
    /// Its number, from 0: the first one is ahead.
    pub index: u32,
    /// Where it is; at the beginning of the path before it has entered the lane.
    pub at: Point,
    /// Whether it has entered the lane.
    pub has_entered: bool,
    /// What has become of it.
    pub status: VehicleStatus,
}

impl Convoy {
    /// Vehicles before a path.
    pub(crate) fn new(passage: &PassageSpec, planned: &PlannedPassage) -> Self {
        let vehicles = (0..passage.vehicles).map(|number| Moving {
            along_m: -f64::from(number) * passage.gap_m,
            status: VehicleStatus::Driving,
        });
        let mut corners_m = vec![0.0];
        for ends in planned.path.windows(2) {
            let before_m = corners_m.last().copied().unwrap_or_default();
            corners_m.push(before_m + ends[0].to(ends[1]).length());
        }
        Self {
            path: planned.path.clone(),
            corners_m,
            width_m: planned.width_m,
            vehicles: vehicles.collect(),
            ended_at: None,
        }
    }

    /// Whether a vehicle is still driving.
    pub(crate) fn is_driving(&self) -> bool {
        let mut vehicles = self.vehicles.iter();
        vehicles.any(|vehicle| vehicle.status == VehicleStatus::Driving)
    }

    /// The vehicles, in their order.
    pub(crate) fn each_vehicle(&self) -> impl Iterator<Item = Vehicle> {
        let vehicles = (0..).zip(&self.vehicles);
        vehicles.map(|(index, vehicle)| Vehicle {
            index,
            at: self.place(vehicle.along_m),
            has_entered: vehicle.along_m >= 0.0,
            status: vehicle.status,
        })
    }

    /// The mines within the width of the path, in the order in which vehicles meet them.
    pub(crate) fn mines(&self, scenario: &Scenario, items: &Items) -> Vec<u32> {
        let near = self.ahead(scenario, items, [0.0, self.length_m()]);
        near.into_iter().map(|(_, item)| item).collect()
    }

    /// Length of the path.
    pub(crate) fn length_m(&self) -> f64 {
        self.corners_m.last().copied().unwrap_or_default()
    }

    /// The pieces of the path between two distances along it, each with the distance at its start.
    fn pieces(&self, [from_m, to_m]: [f64; 2]) -> impl Iterator<Item = (f64, Segment)> {
        let ends = self.corners_m.windows(2);
        let ends = ends.filter(move |ends| ends[0] < to_m && ends[1] > from_m);
        ends.map(move |ends| {
            let (begin_m, end_m) = (ends[0].max(from_m), ends[1].min(to_m));
            let piece = Segment {
                from: self.place(begin_m),
                to: self.place(end_m),
            };
            (begin_m, piece)
        })
    }

    /// The place at a distance along the path.
    fn place(&self, along_m: f64) -> Point {
        let pieces = self.corners_m.windows(2).zip(self.path.windows(2));
        let mut pieces = pieces.skip_while(|(ends, _)| ends[1] < along_m);
        let last = self.path.last().copied().unwrap_or_default();
        pieces.next().map_or(last, |(ends, corners)| {
            let share = ((along_m - ends[0]) / (ends[1] - ends[0])).max(0.0);
            corners[0].plus(corners[0].to(corners[1]).times(share))
        })
    }

    /// The mines in the lane within the width of a part of the path, in the order in which a vehicle meets them.
    pub(crate) fn ahead(
        &self,
        scenario: &Scenario,
        items: &Items,
        part_m: [f64; 2],
    ) -> Vec<(f64, u32)> {
        let (Some(clearance), Some(passage)) = (scenario.clearance(), scenario.passage) else {
            return Vec::new();
        };
        let (lane, half_width_m) = (clearance.lane.area(), self.width_m / 2.0);
        let mut met: Vec<(f64, u32)> = Vec::new();
        for (begin_m, piece) in self.pieces(part_m) {
            let middle = piece.from.plus(piece.way().times(0.5));
            let reach_m = half_width_m + piece.length_m() / 2.0;
            for item in items.within(middle, reach_m) {
                let at = items.place(item);
                let nearest = piece.nearest(at);
                let is_within = nearest.to(at).length() <= half_width_m && lane.contains(at);
                let effect = passage.effect_of(scenario, items.kind(item));
                if is_within && effect.is_some() {
                    met.push((begin_m + piece.from.to(nearest).length(), item));
                }
            }
        }
        met.sort_by(|one, other| one.0.total_cmp(&other.0).then(one.1.cmp(&other.1)));
        let mut known = std::collections::BTreeSet::new();
        met.retain(|(_, item)| known.insert(*item));
        met
    }
}
