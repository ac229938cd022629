//! Warnings about robots that find no room where they start: such runs are quarantined.

use crate::bodies::RobotSpec;
use crate::run::placing::start_places;
use crate::scenario::{Checked, Scenario};
use base::document::Place;
use base::geometry::{Point, Rectangle};
use base::placement::Placement;
use base::warning::Warning;

/// Number of runs whose robots are placed, from run 0 of seed 0 on.
const TRIALS: u64 = 5;

/// Maximum number of robots that are placed in all trials together.
const MAX_PLACED: u64 = 100_000;

/// Robots nearer to each other than this, in metres, overlap; less is rounding.
const TOLERANCE_M: f64 = 1e-9;

pub(super) fn warnings(checked: &Checked, at: &Place) -> Vec<Warning> {
    let kinds = checked.spec.robots.iter();
    let kinds: Vec<Kind> = kinds
        .map(|(name, spec)| Kind::new(name, spec, checked))
        .collect();
    let trials = Trials::run(&checked.scenario, &kinds);
    let found = kinds
        .iter()
        .zip(&trials.placed)
        .filter_map(|(kind, placed)| {
            let at = at.key("robots").key(kind.name).key("count");
            Some(at.warning(kind.effect(placed, trials.runs)?))
        });
    found.collect()
}

/// A kind of robots, and the room for them.
struct Kind<'s> {
    name: &'s str,
    count: u32,
    /// The area where they start, in words; `None` for given places.
    area: Option<String>,
    /// No more of them fit, however they are placed.
    max_count: u32,
    /// Whether there are robots of other kinds in their layer.
    has_others: bool,
}

impl<'s> Kind<'s> {
    fn new(name: &'s str, spec: &RobotSpec, checked: &Checked) -> Self {
        let scenario = &checked.scenario;
        let world = scenario.world();
        let (area, centres) = match &spec.start {
            Placement::Fixed { .. } => (None, None),
            Placement::Uniform { within_m } | Placement::Clustered { within_m, .. } => {
                let words = within_m.map_or_else(|| "the world".to_owned(), words);
                (Some(words), Some(within_m.unwrap_or(world)))
            }
        };
        let centres = centres.map(|within| {
            if scenario.is_periodic() {
                within.size()
            } else {
                inner_size(within, world, spec.radius_m)
            }
        });
        let mut others = checked
            .spec
            .robots
            .iter()
            .filter(|(other, _)| *other != name);
        Self {
            name,
            count: spec.count,
            has_others: others.any(|(_, other)| other.layer == spec.layer && other.count > 0),
            area,
            max_count: centres.map_or(u32::MAX, |size_m| densest(size_m, spec.radius_m)),
        }
    }

    fn is_impossible(&self) -> bool {
        self.count > self.max_count
    }

    /// The warning for the numbers of these robots that found a place in those of the trial runs that had no
    /// room for all.
    fn effect(&self, placed: &[u32], runs: u64) -> Option<String> {
        let area = self.area.as_ref()?;
        let max_count = self.max_count;
        let beside = if self.has_others {
            " beside the others"
        } else {
            ""
        };
        let reason = match placed.iter().min() {
            Some(least) if placed.len() as u64 == runs => {
                format!("no room: {area} holds about {least} of them{beside}")
            }
            Some(least) => format!(
                "no room in {} of {runs} trial runs: {area} holds about {least} of them{beside}",
                placed.len()
            ),
            None if self.is_impossible() => {
                format!("no room: {area} holds at most {max_count} of them")
            }
            None => return None,
        };
        Some(format!("{reason}; runs without room are quarantined"))
    }
}

fn words(area: Rectangle) -> String {
    let (Point { x: left, y: low }, Point { x: right, y: high }) = (area.min(), area.max());
    format!("their start area, from [{left}, {low}] to [{right}, {high}],")
}

/// The size of the rectangle of the centres of discs that are centred in an area and inside the walls of
/// the world.
fn inner_size(area: Rectangle, world: Rectangle, radius_m: f64) -> Point {
    let (low, high, wall) = (area.min(), area.max(), world.max());
    let along =
        |low: f64, high: f64, wall: f64| (high.min(wall - radius_m) - low.max(radius_m)).max(0.0);
    Point {
        x: along(low.x, high.x, wall.x),
        y: along(low.y, high.y, wall.y),
    }
}

/// The maximum number of points of a rectangle that are two radii apart: 2 A / (d² √3) + P / (2 d) + 1 for an
/// area A, a perimeter P and a distance d.
///
/// Source: N. Oler, *An inequality in the geometry of numbers*, 1961.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "positive; a larger number becomes the largest"
)]
fn densest(size_m: Point, radius_m: f64) -> u32 {
    let apart_m = 2.0 * radius_m - TOLERANCE_M;
    if apart_m <= 0.0 {
        return u32::MAX;
    }
    let (width, height) = (size_m.x / apart_m, size_m.y / apart_m);
    (2.0 * width * height / 3_f64.sqrt() + width + height + 1.0) as u32
}

/// Trial placements of all robots.
struct Trials {
    /// Number of runs.
    runs: u64,
    /// By kind: the number of robots that found a place, in each run in which the next one found none.
    placed: Vec<Vec<u32>>,
}

impl Trials {
    fn run(scenario: &Scenario, kinds: &[Kind]) -> Self {
        let fitting = kinds.iter().map(|kind| kind.count.min(kind.max_count));
        let per_run: u64 = fitting.map(u64::from).sum();
        // One run is enough to estimate how many fit.
        let is_impossible = kinds.iter().any(Kind::is_impossible);
        let wanted = if is_impossible { 1 } else { TRIALS };
        let runs = wanted.min(MAX_PLACED / per_run.max(1));
        let mut placed = vec![Vec::new(); kinds.len()];
        for run in 0..runs {
            if let Err(error) = start_places(scenario, 0, run) {
                placed[usize::from(error.kind)].push(error.index);
            }
        }
        Self { runs, placed }
    }
}
