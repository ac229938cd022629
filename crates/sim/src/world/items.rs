//! Items: targets, and clutter that is taken for them.

use super::buckets::Buckets;
use super::item_number::ItemNumber;
use base::geometry::{Point, Torus};
use base::placement::Placement;
use base::random::{Entity, kind_key};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A contact from an external body belongs to an item at up to this distance from its measured
/// position, in metres.
pub(crate) const RECOGNISED_WITHIN_M: f64 = 1.0;

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
    /// Where the items are.
    #[serde(default)]
    pub placement: Placement,
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
            placement: spec.placement.clone(),
        }
    }

    /// The largest number of items of this kind in a run.
    pub(crate) fn max_number(&self) -> u32 {
        self.number.max(self.count)
    }
}

/// One item.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Item {
    pub(crate) number: usize,
    pub(crate) place: Point,
}

/// The items of a run.
#[derive(Debug, Clone)]
pub(crate) struct Items {
    places: Vec<Point>,
    kinds: Vec<u16>,
    /// The key of each item in random streams.
    things: Vec<Entity>,
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
            buckets,
            run,
        }
    }

    /// The seed and the number of the run, for draws that are the same for all robots.
    pub(crate) fn run(&self) -> [u64; 2] {
        self.run
    }

    /// All items within a distance of a place, with their numbers, and possibly some more; in a
    /// periodic world as their images there.
    #[inline]
    pub(crate) fn near(&self, place: Point, radius_m: f64) -> impl Iterator<Item = &(Point, u32)> {
        self.buckets.near(place, radius_m)
    }

    /// Items by the names of their kinds and their index within the kind.
    pub(crate) fn named<'a>(
        &self,
        kinds: &'a [ItemKind],
    ) -> impl Iterator<Item = ((&'a str, u32), Item)> {
        (0..self.places.len()).map(|number| {
            let name = kinds[usize::from(self.kinds[number])].name.as_str();
            let item = Item {
                number,
                place: self.places[number],
            };
            ((name, self.things[number].index), item)
        })
    }

    /// Replaces the place of items, by their numbers.
    pub(crate) fn keep(&mut self, kept: &[(usize, Item)]) {
        for (number, item) in kept {
            self.places[*number] = item.place;
        }
        self.buckets.fill(self.places.iter().copied());
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
