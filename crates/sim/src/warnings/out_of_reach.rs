//! Warnings about items and goals that may lie where no robot that has to find or serve them can come.

use crate::bodies::Layer;
use crate::scenario::Checked;
use crate::scenario::areas::{lattice, number, within};
use crate::scenario::finders::{Finder, finders, servers};
use crate::scenario::team_reach::Team;
use base::document::Place;
use base::geometry::Point;
use base::placement::Placement;
use base::warning::Warning;
use std::collections::BTreeMap;

/// Parts that fewer of the runs concern have no warning.
const MIN_RUNS: f64 = 0.01;

pub(super) fn warnings(checked: &Checked, at: &Place) -> Vec<Warning> {
    let spec = &checked.spec;
    // Paths through a periodic world are not examined.
    if spec.world.periodic {
        return Vec::new();
    }
    let items = spec.items.iter().filter(|(_, kind)| kind.target);
    let items = items.map(|(name, kind)| Targets {
        placement: &kind.placement,
        count: kind.count,
        finders: sent(finders(spec, name)),
        robots: "robot with a sensor for it",
        at: at.key("items").key(name),
    });
    // Without controllers, other robots may pass them on waypoints of their own.
    let has_controllers = spec.controllers.values().any(|kind| kind.count > 0);
    let goals = spec.goals.iter().filter(|_| has_controllers);
    let goals = goals.map(|(name, kind)| Targets {
        placement: &kind.placement,
        count: kind.count,
        finders: sent(servers(spec, kind)),
        robots: "robot that can serve it",
        at: at.key("goals").key(name),
    });
    let targets = items.chain(goals);
    let targets = targets.filter(|kind| kind.count > 0 && !kind.finders.is_empty());
    targets.flat_map(|kind| kind.warnings(checked)).collect()
}

/// The robots that are sent, of those that could be.
fn sent(mut finders: Vec<Finder>) -> Vec<Finder> {
    finders.retain(|finder| finder.robot.count > 0);
    finders
}

/// Items or goals of a kind.
struct Targets<'s, 'd> {
    placement: &'s Placement,
    count: u32,
    finders: Vec<Finder<'s>>,
    /// The robots that have to come near, in words.
    robots: &'static str,
    at: Place<'d>,
}

impl Targets<'_, '_> {
    fn warnings(&self, checked: &Checked) -> Vec<Warning> {
        let places = self.places(checked);
        let team = Team::new(checked, &self.finders);
        let mut never = Lost::default();
        let mut sometimes = Lost::default();
        for place in &places {
            let part = team.part_of(*place);
            match team.misses(*place) {
                Some(chance) => sometimes.add(*place, part, chance),
                None => never.add(*place, part, 1.0),
            }
        }
        let shares = [&never, &sometimes].map(|lost| lost.sum / number(places.len().max(1)));
        let at = self.at.key("placement");
        let concerned = |share: &f64| self.runs(*share) >= MIN_RUNS;
        let never = never.middle().filter(|_| concerned(&shares[0]));
        let sometimes = sometimes.middle().filter(|_| concerned(&shares[1]));
        let never = never.map(|near| at.warning(self.never(shares[0], near)));
        let sometimes = sometimes.map(|near| at.warning(self.sometimes(shares[1], near)));
        never.into_iter().chain(sometimes).collect()
    }

    /// The given places, or free ones of the area.
    fn places(&self, checked: &Checked) -> Vec<Point> {
        if let Placement::Fixed { at_m, .. } = self.placement {
            return at_m.iter().take(self.count as usize).copied().collect();
        }
        let area = within(self.placement, checked.scenario.world());
        let places = area.into_iter().flat_map(lattice);
        let is_free = |place: &Point| checked.scenario.is_free(*place, 0.0, Layer::Ground);
        places.filter(is_free).collect()
    }

    /// The share of runs that have one or more of the items in a share of the area.
    fn runs(&self, share: f64) -> f64 {
        match self.placement {
            Placement::Fixed { .. } => 1.0,
            Placement::Uniform { .. } => some(share, self.count),
            Placement::Clustered { clusters, .. } => some(share, self.count.min(*clusters)),
        }
    }

    fn never(&self, share: f64, near: Point) -> String {
        format!(
            "no {} can reach {}, near {}, within range{}; {}",
            self.robots,
            self.part(share),
            shown(near),
            self.in_runs(share),
            self.advice("or start a robot there")
        )
    }

    fn sometimes(&self, share: f64, near: Point) -> String {
        format!(
            "in a run, on average, no {} can reach {} within range, as near {}: they start at random in parts of the \
             world with no way between them; {}",
            self.robots,
            self.part(share),
            shown(near),
            self.advice("or start them in one part")
        )
    }

    fn part(&self, share: f64) -> String {
        match self.placement {
            Placement::Fixed { .. } => format!("{} of its places", percent(share)),
            _ => format!("{} of its free area", percent(share)),
        }
    }

    /// How many runs are concerned, in words.
    fn in_runs(&self, share: f64) -> String {
        if let Placement::Fixed { .. } = self.placement {
            return String::new();
        }
        let runs = (100.0 * self.runs(share)).clamp(1.0, 99.0);
        format!(": about {runs:.0}% of runs have one there")
    }

    /// What to do, as the one alternative or another.
    fn advice(&self, start: &str) -> String {
        let radii_m = self.finders.iter().map(|finder| finder.robot.radius_m);
        let width_m = 2.0 * radii_m.fold(f64::INFINITY, f64::min);
        let place = match self.placement {
            Placement::Fixed { .. } => "move them",
            _ => "limit the area with within_m",
        };
        format!("{place}, make a way wider than {width_m} m, {start}")
    }
}

/// Places that are not found.
#[derive(Default)]
struct Lost {
    /// By part of the world, the places and the sum of their chances not to be found.
    parts: BTreeMap<Option<u32>, (Vec<Point>, f64)>,
    sum: f64,
}

impl Lost {
    fn add(&mut self, place: Point, part: Option<u32>, chance: f64) {
        if chance > 0.0 {
            let part = self.parts.entry(part).or_default();
            part.0.push(place);
            part.1 += chance;
            self.sum += chance;
        }
    }

    /// Of the part with the greatest sum, the place nearest to the mean.
    fn middle(&self) -> Option<Point> {
        let parts = self.parts.values();
        let (places, _) = parts.max_by(|one, other| one.1.total_cmp(&other.1))?;
        let sum = places
            .iter()
            .fold(Point::default(), |sum, place| sum.plus(*place));
        let mean = sum.times(1.0 / number(places.len()));
        let from_mean = |place: &Point| mean.to(*place).length();
        let places = places.iter().copied();
        places.min_by(|one, other| from_mean(one).total_cmp(&from_mean(other)))
    }
}

/// The chance that one or more of some things are in a share of an area.
fn some(share: f64, count: u32) -> f64 {
    1.0 - (1.0 - share).powf(f64::from(count))
}

fn shown(Point { x, y }: Point) -> String {
    format!("[{x:.1}, {y:.1}]")
}

/// A share in percent, never rounded to none or all.
fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    if share < 1.0 && !(0.1..=99.9).contains(&percent) {
        return format!("{percent:.3}%");
    }
    format!("{percent:.1}%")
}
