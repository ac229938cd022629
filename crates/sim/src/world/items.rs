//! Items: targets, and clutter that is taken for them.

use super::buckets::Buckets;
use super::item_number::ItemNumber;
use base::geometry::{Point, Torus};
use base::placement::Placement;
use base::random::{Entity, kind_key};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// A contact from an external body belongs to an item at up to this distance from its measured
/// position, in metres.
pub(crate) const RECOGNISED_WITHIN_M: f64 = 1.0;

/// A statement about a place is about the nearest item, if it is at most this far from it, in metres. Position
/// sensors of small robots have errors of about 2 m.
pub(crate) const MARK_TOLERANCE_M: f64 = 2.0;

/// A kind of item.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ItemSpec {
    /// Number of items of this kind; their mean number with `number = "poisson"`.
    #[schemars(range(max = 1_000_000))]
    pub count: u32,
    /// Number of items in a run: `count`, or drawn in each run from a Poisson distribution with the mean `count`, at
    /// most 500. Drawn numbers are cut at `count` + 8 sqrt(`count`) + 8, which bounds the columns. A run that draws
    /// no target is complete when it begins.
    #[serde(default)]
    pub number: ItemNumber,
    /// Whether these items are to be found; false for clutter. A run is complete when all targets
    /// are found, unless `[end]` has another condition.
    #[serde(default = "yes")]
    pub target: bool,
    /// Number of looks (measurements with a contact of the item, of all robots together) after which an item of
    /// this kind counts as detected. One look can be a chance, for example where the position of a real robot is uncertain.
    #[serde(default = "one_look")]
    #[schemars(range(min = 1, max = 1000))]
    pub confirm_looks: u32,
    /// What completes an item of this kind, if it is a target. Without `[end]`, a run is complete when all targets are.
    #[serde(default)]
    pub completed_by: CompletedBy,
    /// The danger for robots on the ground. Without it, items are harmless.
    pub hazard: Option<HazardSpec>,
    /// Where the items are.
    #[serde(default)]
    pub placement: Placement,
}

fn one_look() -> u32 {
    1
}

/// What completes an item. Whatever destroys it completes it, too.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CompletedBy {
    /// A robot has detected it.
    #[default]
    Detected,
    /// A robot has confirmed a mark on it.
    Confirmed,
    /// A robot has destroyed it.
    Neutralised,
}

/// The danger of an item for robots on the ground.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct HazardSpec {
    /// An item is a danger to a robot whose footprint is at most this far from it at the end of a step, in metres.
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub radius_m: f64,
    /// Probability that it destroys a robot within this distance, drawn once for each robot and item.
    #[serde(default = "certain")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub destroy_probability: f64,
    /// Whether the item is destroyed with the robot.
    #[serde(default = "yes")]
    pub detonates: bool,
}

fn certain() -> f64 {
    1.0
}

fn yes() -> bool {
    true
}

impl ItemSpec {
    /// The largest number of items of this kind in a run.
    pub(crate) fn max_number(&self) -> u32 {
        self.number.max(self.count)
    }

    /// Whether all runs have the same number of them.
    pub(crate) fn is_fixed(&self) -> bool {
        self.number == ItemNumber::Fixed
    }
}

/// A kind of item, converted for runs.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ItemKind {
    pub(crate) name: String,
    /// Its name in random streams: [`kind_key`].
    pub(crate) key: u32,
    /// The mean number of items in a run.
    pub(crate) count: u32,
    pub(crate) number: ItemNumber,
    /// The largest number of items of this kind in a run of any configuration of the study.
    pub(crate) max_count: u32,
    pub(crate) is_target: bool,
    /// Whether it is a target in any configuration of the study.
    pub(crate) may_be_target: bool,
    /// Looks after which one counts as detected.
    pub(crate) confirm_looks: u32,
    pub(crate) completed_by: CompletedBy,
    pub(crate) hazard: Option<HazardSpec>,
    pub(crate) placement: Placement,
}

impl ItemKind {
    pub(crate) fn new((name, spec): (&String, &ItemSpec)) -> Self {
        Self {
            name: name.clone(),
            key: kind_key(name),
            count: spec.count,
            number: spec.number,
            max_count: spec.max_number(),
            is_target: spec.target,
            may_be_target: spec.target,
            confirm_looks: spec.confirm_looks,
            completed_by: spec.completed_by,
            hazard: spec.hazard,
            placement: spec.placement.clone(),
        }
    }

    /// The largest number of items of this kind in a run.
    pub(crate) fn max_number(&self) -> u32 {
        self.number.max(self.count)
    }

    /// The distance from the footprint of a robot on the ground at which it may destroy the robot.
    pub(crate) fn hazard_m(&self) -> Option<f64> {
        let hazard = self
            .hazard
            .filter(|hazard| hazard.destroy_probability > 0.0);
        hazard.map(|hazard| hazard.radius_m)
    }

    /// Whether nothing happens to these items but that robots find them.
    pub(crate) fn is_only_found(&self) -> bool {
        self.completed_by == CompletedBy::Detected && self.hazard.is_none()
    }
}

/// One item.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Item {
    pub(crate) number: usize,
    pub(crate) place: Point,
    pub(crate) is_gone: bool,
}

/// The items of a run.
#[derive(Debug, Clone)]
pub(crate) struct Items {
    places: Vec<Point>,
    kinds: Vec<u16>,
    /// The key of each item in random streams.
    things: Vec<Entity>,
    /// Numbers of items that were destroyed.
    gone: BTreeSet<u32>,
    buckets: Buckets,
    /// The seed and the number of the run.
    run: [u64; 2],
}

impl Items {
    /// Items, each with its place and the number of its kind.
    pub(crate) fn new(
        each: &[(Entity, u16, Point)],
        (size_m, torus): (Point, Option<Torus>),
        reach_m: f64,
        run: [u64; 2],
    ) -> Self {
        let farthest_m = reach_m.max(RECOGNISED_WITHIN_M);
        let mut buckets = Buckets::new(size_m, reach_m).on(torus, farthest_m);
        buckets.fill(each.iter().map(|(.., place)| *place));
        Self {
            things: each.iter().map(|(thing, ..)| *thing).collect(),
            places: each.iter().map(|(.., place)| *place).collect(),
            kinds: each.iter().map(|(_, kind, _)| *kind).collect(),
            gone: BTreeSet::new(),
            buckets,
            run,
        }
    }

    /// The seed and the number of the run, for draws that are the same for all robots.
    pub(crate) fn run(&self) -> [u64; 2] {
        self.run
    }

    /// All items within a distance of a place that still exist, with their numbers, and possibly some more; in a
    /// periodic world as their images there.
    #[inline]
    pub(crate) fn near(&self, place: Point, radius_m: f64) -> impl Iterator<Item = &(Point, u32)> {
        self.buckets.near(place, radius_m)
    }

    /// The items within a distance of a place, by increasing distance.
    pub(crate) fn within(&self, place: Point, radius_m: f64) -> Vec<u32> {
        let near = self.near(place, radius_m);
        let near = near.map(|(at, number)| (place.to(*at).length(), *number));
        let mut near: Vec<(f64, u32)> = near.filter(|(away_m, _)| *away_m <= radius_m).collect();
        near.sort_by(|one, other| one.0.total_cmp(&other.0).then(one.1.cmp(&other.1)));
        near.into_iter().map(|(_, number)| number).collect()
    }

    /// The item nearest to a place, if it is within a distance.
    pub(crate) fn nearest(&self, place: Point, radius_m: f64) -> Option<u32> {
        self.within(place, radius_m).first().copied()
    }

    /// The place of an item.
    pub(crate) fn place(&self, number: u32) -> Point {
        self.places[number as usize]
    }

    /// Whether an item was destroyed.
    pub(crate) fn is_gone(&self, number: u32) -> bool {
        self.gone.contains(&number)
    }

    /// Removes an item that is destroyed from the world; it keeps its number.
    pub(crate) fn remove(&mut self, number: u32) {
        self.gone.insert(number);
        self.fill();
    }

    fn fill(&mut self) {
        let places = (0..).zip(self.places.iter().copied());
        let left = places.filter(|(number, _)| !self.gone.contains(number));
        let left: Vec<(Point, u32)> = left.map(|(number, at)| (at, number)).collect();
        self.buckets.fill_numbered(&left);
    }

    /// Items by the names of their kinds and their index within the kind.
    pub(crate) fn named<'a>(
        &self,
        kinds: &'a [ItemKind],
    ) -> impl Iterator<Item = ((&'a str, u32), Item)> {
        (0..self.places.len()).map(|number| {
            let name = kinds[usize::from(self.kinds[number])].name.as_str();
            #[expect(clippy::cast_possible_truncation, reason = "counts are at most 1e6")]
            let item = Item {
                number,
                place: self.places[number],
                is_gone: self.is_gone(number as u32),
            };
            ((name, self.things[number].index), item)
        })
    }

    /// Replaces the place of items, by their numbers, and whether they were destroyed.
    #[expect(clippy::cast_possible_truncation, reason = "counts are at most 1e6")]
    pub(crate) fn keep(&mut self, kept: &[(usize, Item)]) {
        for (number, item) in kept {
            self.places[*number] = item.place;
            if item.is_gone {
                self.gone.insert(*number as u32);
            }
        }
        self.fill();
    }

    /// Number of items.
    pub(crate) fn len(&self) -> usize {
        self.places.len()
    }

    /// The kind of each item.
    pub(crate) fn kinds(&self) -> impl Iterator<Item = u16> {
        self.kinds.iter().copied()
    }

    /// The place of each item.
    pub(crate) fn places(&self) -> impl Iterator<Item = Point> {
        self.places.iter().copied()
    }

    /// The random-stream key of an item: independent of the items of other kinds.
    #[inline]
    pub(crate) fn thing(&self, number: u32) -> Entity {
        self.things[number as usize]
    }

    #[inline]
    pub(crate) fn kind(&self, number: u32) -> u16 {
        self.kinds[number as usize]
    }
}
