//! The chance that no robot of a team can come near enough to a place.

use super::areas::{lattice, number, within};
use super::checked::Checked;
use super::finders::{Finder, around, reach};
use crate::bodies::{Layer, RobotSpec};
use base::geometry::Point;
use base::placement::Placement;
use base::reachability::Reachability;
use std::cell::OnceCell;
use std::collections::{BTreeMap, BTreeSet};

/// Robots see through gaps that are wider than about their width times this.
const SIGHT_WIDTH: f64 = 0.25;

/// The same in worlds that are too large for it.
const MAX_SIGHT_WIDTH: f64 = 0.5;

/// A sum of shares that is greater is that of all.
const ALL: f64 = 1.0 - 1e-9;

/// The robots that have to find or serve something.
pub(crate) struct Team<'t> {
    kinds: Vec<Kind<'t>>,
}

impl<'t> Team<'t> {
    pub(crate) fn new(checked: &'t Checked, finders: &'t [Finder<'t>]) -> Self {
        let kinds = finders.iter().map(|finder| Kind::new(checked, finder));
        Self {
            kinds: kinds.collect(),
        }
    }

    /// The chance that no robot starts where it can come near enough to a place; `None` if none ever does.
    pub(crate) fn misses(&self, place: Point) -> Option<f64> {
        let mut chance = None;
        for kind in &self.kinds {
            if let Some(missed) = kind.misses(place) {
                chance = Some(missed * chance.unwrap_or(1.0));
            }
            if chance == Some(0.0) {
                break;
            }
        }
        chance
    }

    /// The part of the world in which a place is, for the first kind; `None` in a gap too narrow for it.
    pub(crate) fn part_of(&self, place: Point) -> Option<u32> {
        self.kinds.first()?.reach.parts_near(place, 0.0).next()
    }
}

/// A kind of robots, and where they start and move.
struct Kind<'t> {
    checked: &'t Checked,
    finder: &'t Finder<'t>,
    reach: Reachability,
    /// By part of the world, the share of the starts in it.
    starts: Vec<f64>,
    /// Number of independent starts.
    draws: f64,
    sight: OnceCell<Option<Sight>>,
}

impl<'t> Kind<'t> {
    fn new(checked: &'t Checked, finder: &'t Finder<'t>) -> Self {
        let reach = reach(checked, finder.robot);
        let count = finder.robot.count;
        let draws = match finder.robot.start {
            Placement::Fixed { .. } => 1,
            Placement::Uniform { .. } => count,
            Placement::Clustered { clusters, .. } => count.min(clusters),
        };
        Self {
            checked,
            finder,
            starts: starts(checked, finder.robot, &reach),
            reach,
            draws: f64::from(draws),
            sight: OnceCell::new(),
        }
    }

    /// The chance that none starts where it can come near enough to a place; `None` if none ever does.
    fn misses(&self, place: Point) -> Option<f64> {
        let here = self.chance(set(self.reach.parts_near(place, 0.0)));
        if here == Some(0.0) {
            return here;
        }
        self.chance(self.parts(place))
    }

    /// The chance that none starts in some parts; `None` if none ever does.
    fn chance(&self, parts: BTreeSet<u32>) -> Option<f64> {
        let shares = parts.into_iter().filter_map(|part| self.share(part));
        let share = shares.reduce(|one, other| one + other)?;
        let others = if share > ALL { 0.0 } else { 1.0 - share };
        Some(others.powf(self.draws))
    }

    /// The share of the starts in a part, 0 of a part too small for the lattice; `None` if none can be there.
    fn share(&self, part: u32) -> Option<f64> {
        let share = self.starts[part as usize];
        let is_given = matches!(self.finder.robot.start, Placement::Fixed { .. });
        (share > 0.0 || (!is_given && self.reach.is_reached(part))).then_some(share)
    }

    /// The parts from which a place is within range.
    fn parts(&self, place: Point) -> BTreeSet<u32> {
        let Finder {
            robot,
            range_m,
            through_m,
        } = *self.finder;
        let near = |distance_m| self.reach.parts_near(place, distance_m);
        // Flying robots look down into all parts.
        if through_m >= range_m || robot.layer == Layer::Air {
            return set(near(range_m));
        }
        let Some(sight) = self.sight() else {
            return set(near(range_m));
        };
        let mut parts = set(near(through_m));
        let seen_from = sight.seen_from(place);
        // Most places that are out of sight are so from everywhere: a range is not searched for them.
        if seen_from.iter().any(|from| sight.reached.contains(from)) {
            parts.extend(near(range_m).filter(|part| sight.is_seen(*part, &seen_from)));
        }
        parts
    }

    fn sight(&self) -> Option<&Sight> {
        let new = || Sight::new(self.checked, self.finder.robot, self.places());
        self.sight.get_or_init(new).as_ref()
    }

    /// A place in each part in which one may be.
    fn places(&self) -> BTreeMap<u32, Point> {
        let parts = (0..).take(self.reach.parts());
        let parts = parts.filter(|part| self.share(*part).is_some());
        let places = parts.filter_map(|part| Some((part, self.reach.place_in(part)?)));
        places.collect()
    }
}

/// Few parts of many that are repeated: inserting them is faster than sorting all, as `collect` does.
fn set(parts: impl Iterator<Item = u32>) -> BTreeSet<u32> {
    let mut set = BTreeSet::new();
    set.extend(parts);
    set
}

/// By part of the world, the share of the starts of a kind that are in it; of given starts, 1.
fn starts(checked: &Checked, robot: &RobotSpec, reach: &Reachability) -> Vec<f64> {
    let mut shares = vec![0.0; reach.parts()];
    if let Placement::Fixed { at_m, .. } = &robot.start {
        let sent = at_m.iter().take(robot.count as usize);
        for part in sent.flat_map(|place| reach.parts_near(*place, 0.0)) {
            shares[part as usize] = 1.0;
        }
        return shares;
    }
    let area = within(&robot.start, checked.scenario.world());
    let places = area.into_iter().flat_map(lattice);
    let is_free = |place: &Point| {
        checked
            .scenario
            .is_free(*place, robot.radius_m, robot.layer)
    };
    let parts: Vec<u32> = places
        .filter(is_free)
        .filter_map(|place| reach.parts_near(place, 0.0).next())
        .collect();
    for part in &parts {
        shares[*part as usize] += 1.0 / number(parts.len());
    }
    shares
}

/// The parts of the world into which robots of a kind see, through gaps of more than a part of their width.
struct Sight {
    /// Where a body as wide as such a gap may move.
    gaps: Reachability,
    radius_m: f64,
    /// Its part, by part of the robots.
    parts: BTreeMap<u32, u32>,
    /// All of these.
    reached: BTreeSet<u32>,
}

impl Sight {
    /// For robots with a place in each of their parts. `None` in a world too large for such gaps.
    fn new(checked: &Checked, robot: &RobotSpec, places: BTreeMap<u32, Point>) -> Option<Self> {
        let min_m = Reachability::min_radius_m(checked.scenario.world());
        let radius_m = min_m.max(SIGHT_WIDTH * robot.radius_m);
        if radius_m > MAX_SIGHT_WIDTH * robot.radius_m {
            return None;
        }
        let gaps = around(checked, radius_m, Layer::Ground, &[]);
        let parts = places.into_iter().filter_map(|(part, place)| {
            let from = gaps.parts_near(place, 0.0).next()?;
            Some((part, from))
        });
        let parts: BTreeMap<u32, u32> = parts.collect();
        Some(Self {
            gaps,
            radius_m,
            reached: parts.values().copied().collect(),
            parts,
        })
    }

    /// The parts from which a place may be seen.
    fn seen_from(&self, place: Point) -> BTreeSet<u32> {
        set(self.gaps.parts_near(place, 2.0 * self.radius_m))
    }

    fn is_seen(&self, part: u32, seen_from: &BTreeSet<u32>) -> bool {
        let from = self.parts.get(&part);
        from.is_some_and(|from| seen_from.contains(from))
    }
}
