//! Vehicles on a path, one after the other.

use super::PassageSpec;
use crate::judge::events::{EventKind, EventLog};
use crate::run::state::State;
use crate::scenario::Scenario;
use crate::sensors::sensor_frame::NoisePurpose;
use base::geometry::{Point, Segment};
use base::hashed::Hashed;
use base::noise::{Noise, share};
use base::random::{Entity, kind_key};
use economy::PlannedPassage;

/// The name of vehicles in random streams: no kind of robots can have it.
const STREAM: &str = "[passage]";

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
    along_m: f64,
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

    /// The items of a kind that destroys vehicles within the width of the path, and how far along it they are.
    pub(crate) fn mines(&self, scenario: &Scenario, state: &State) -> Vec<u32> {
        let near = self.ahead(scenario, state, [0.0, self.length_m()]);
        near.into_iter().map(|(_, item)| item).collect()
    }

    fn length_m(&self) -> f64 {
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
    fn ahead(&self, scenario: &Scenario, state: &State, part_m: [f64; 2]) -> Vec<(f64, u32)> {
        let (Some(clearance), Some(passage)) = (scenario.clearance(), scenario.passage) else {
            return Vec::new();
        };
        let (lane, half_m) = (clearance.lane.area(), self.width_m / 2.0);
        let mut met: Vec<(f64, u32)> = Vec::new();
        for (begin_m, piece) in self.pieces(part_m) {
            let middle = piece.from.plus(piece.way().times(0.5));
            let reach_m = half_m + piece.length_m() / 2.0;
            for item in state.items.within(middle, reach_m) {
                let at = state.items.place(item);
                let nearest = piece.nearest(at);
                let is_within = nearest.to(at).length() <= half_m && lane.contains(at);
                let effect = passage.effect_of(scenario, state.items.kind(item));
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

/// Moves the vehicles by a step, in their order; returns whether one of them has passed or was destroyed.
pub(crate) fn drive(scenario: &Scenario, state: &mut State, events: &EventLog) -> bool {
    let (Some(passage), Some(mut convoy)) = (scenario.passage, state.convoy.take()) else {
        return false;
    };
    let step_m = passage.speed_m_s * scenario.step_s;
    let mut is_counted = false;
    for number in 0..convoy.vehicles.len() {
        let vehicle = convoy.vehicles[number];
        if vehicle.status == VehicleStatus::Driving {
            let next = moved(scenario, state, (&convoy, number), step_m, events);
            is_counted |= next.status != VehicleStatus::Driving;
            convoy.vehicles[number] = next;
        }
    }
    if !convoy.is_driving() {
        convoy.ended_at.get_or_insert(state.tick);
    }
    state.convoy = Some(convoy);
    is_counted
}

/// A vehicle after a step: mines on its way may destroy it.
fn moved(
    scenario: &Scenario,
    state: &mut State,
    (convoy, number): (&Convoy, usize),
    step_m: f64,
    events: &EventLog,
) -> Moving {
    let mut vehicle = convoy.vehicles[number];
    let from_m = vehicle.along_m;
    vehicle.along_m = (from_m + step_m).min(convoy.length_m());
    let index = u32::try_from(number).unwrap_or(u32::MAX);
    // A vehicle enters with its front, which is as round as the path is wide.
    for (along_m, item) in convoy.ahead(scenario, state, [from_m, vehicle.along_m]) {
        let effect = scenario
            .passage
            .and_then(|passage| passage.effect_of(scenario, state.items.kind(item)));
        let Some(effect) =
            effect.filter(|effect| draw(state, scenario, index, item) < effect.destroy_probability)
        else {
            continue;
        };
        (vehicle.along_m, vehicle.status) = (along_m, VehicleStatus::Lost);
        let named = (state.items.kind(item), state.items.thing(item).index);
        let kind = EventKind::VehicleLost {
            vehicle: index,
            item: named,
        };
        events.note(state.tick, kind);
        if effect.detonates {
            state.items.remove(item);
        }
        return vehicle;
    }
    if vehicle.along_m >= convoy.length_m() {
        vehicle.status = VehicleStatus::Passed;
        events.note(state.tick, EventKind::VehiclePassed { vehicle: index });
    }
    vehicle
}

/// Whether a mine destroys a vehicle: the same draw in each step, one for each vehicle and item.
fn draw(state: &State, scenario: &Scenario, index: u32, item: u32) -> f64 {
    let kind = kind_key(STREAM);
    let noise = Noise::of(state.seed, state.run, Entity { kind, index });
    let key = scenario.items[usize::from(state.items.kind(item))].key;
    let thing = state.items.thing(item).index;
    let words = noise.words(NoisePurpose::Hazard as u32, key.into(), thing);
    share(words[0])
}
