//! Searching where beliefs say most is to be found.

use super::lanes::swath_m;
use super::survey::{Survey, aim, share};
use crate::beliefs::pose::Pose;
use crate::beliefs::{Beliefs, Map};
use crate::body::Body;
use crate::command::Motion;
use crate::goals::Verdict;
use crate::senses::Senses;
use crate::subsumption::Behaviour;
use crate::wish::{Aim, Wish};
use alloc::boxed::Box;
use alloc::vec::Vec;
use base::geometry::Point;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What lies between looked-at cells weighs more by up to this factor: left alone it costs a way of its
/// own later.
const LEFTOVER: f64 = 1.0;

/// Time that is lost at a place besides the way there, in seconds.
const STOP_S: f64 = 1.0;

/// Where less than so many cells are left about a place, nothing is.
const LEAST: f64 = 0.5;

/// A place with less than this share of what it had is done.
const DONE: f64 = 0.3;

/// Searches by going where the probability of an item that nobody has seen is highest per second of the
/// way: what it passes on the way counts, what others go for hardly does. When next to nothing is left,
/// it has nothing to do.
///
/// Greedy in the sense of Stone, *Theory of optimal search*, 1975: the rate of detection is maximised.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(inline)]
pub struct Seek {
    /// Its speed, in m/s; left out, the most that the body can.
    #[schemars(range(min = 0.0, max = 100.0))]
    pub speed_m_s: Option<f64>,
    /// What searching is worth, beside what other behaviours want.
    #[schemars(range(min = 0.0, max = 1e6))]
    pub value: f64,
}

impl Default for Seek {
    fn default() -> Self {
        Self {
            speed_m_s: None,
            value: 1.0,
        }
    }
}

/// [`Seek`] in a body.
#[derive(Debug, Clone)]
pub(crate) struct Ready {
    aim: Aim,
    /// Half of what is seen on both sides.
    half_m: f64,
}

/// What a robot remembers for it.
#[derive(Debug, Clone, Default)]
pub(crate) struct Search {
    survey: Survey,
    sums: Sums,
}

/// Sums over all cells below and to the left of each: the sum over any rectangle is four of them.
#[derive(Debug, Clone, Default)]
struct Sums {
    columns: usize,
    rows: usize,
    below: Vec<f32>,
}

impl Sums {
    /// Of a value a cell.
    #[expect(clippy::cast_possible_truncation, reason = "kept short")]
    fn fill(&mut self, map: &Map, value: impl Fn(usize) -> f64) {
        let (columns, rows) = (map.field.columns, map.field.rows);
        (self.columns, self.rows) = (columns, rows);
        self.below.clear();
        self.below.resize((columns + 1) * (rows + 1), 0.0);
        for row in 0..rows {
            let mut line = 0.0;
            for column in 0..columns {
                line += value(row * columns + column) as f32;
                let below = self.below[row * (columns + 1) + column + 1];
                self.below[(row + 1) * (columns + 1) + column + 1] = below + line;
            }
        }
    }

    /// Over the cells about one, as far as `reach`, and how many there are.
    fn about(&self, [column, row]: [i32; 2], reach: i32) -> (f64, f64) {
        let within = |number: i32, most: usize| usize::try_from(number).unwrap_or(0).min(most);
        let (left, right) = (
            within(column - reach, self.columns),
            within(column + reach + 1, self.columns),
        );
        let (low, high) = (
            within(row - reach, self.rows),
            within(row + reach + 1, self.rows),
        );
        let at =
            |column: usize, row: usize| f64::from(self.below[row * (self.columns + 1) + column]);
        let sum = at(right, high) - at(left, high) - at(right, low) + at(left, low);
        #[expect(clippy::cast_precision_loss, reason = "some thousands at most")]
        let count = ((right - left) * (high - low)) as f64;
        (sum, count)
    }
}

impl Ready {
    pub(super) fn new(spec: &Seek, body: &Body) -> Self {
        Self {
            aim: aim(spec.speed_m_s, spec.value, body),
            half_m: swath_m(body).0 / 2.0,
        }
    }

    /// The place with most to be found a second of the way.
    fn best(&self, search: &mut Search, beliefs: &Beliefs, map: &Map) -> Option<Point> {
        let pose = beliefs.pose()?;
        let reach = self.reach(map);
        search.sums.fill(map, |cell| map.unseen.of(cell));
        let stride = usize::try_from(reach).unwrap_or(1);
        let rows = (stride / 2..map.field.rows).step_by(stride);
        let columns = (stride / 2..map.field.columns).step_by(stride);
        let cells = rows
            .flat_map(|row| columns.clone().map(move |column| (row, column)))
            .map(|(row, column)| row * map.field.columns + column);
        let mut best = (0.0, None);
        for cell in cells {
            let place = map.field.centre(cell);
            let rate = self.rate(search, map, &pose, cell);
            if rate > best.0 {
                let rate = rate * share(beliefs, pose.at, place, 2.0 * self.half_m);
                if rate > best.0 {
                    best = (rate, Some(place));
                }
            }
        }
        best.1
    }

    /// What is to be found a second on the way to a cell; 0 if there is no way.
    fn rate(&self, search: &Search, map: &Map, pose: &Pose, cell: usize) -> f64 {
        let reach = self.reach(map);
        let place = map.field.centre(cell);
        let Some(way_m) = search.survey.wave.cell_distance_m(&map.field, cell) else {
            return 0.0;
        };
        let here = left(&search.sums, map, place, reach);
        if here < LEAST || search.survey.is_given_up(place, self.half_m / 2.0) {
            return 0.0;
        }
        let is_straight = way_m < 1.1 * pose.at.to(place).length() + map.field.cell_m;
        let passed = if is_straight {
            passed(&search.sums, map, [pose.at, place], reach)
        } else {
            0.0
        };
        let way = pose.own(place);
        let turn_rad = libm::atan2(way.y, way.x).abs();
        let time_s = way_m / self.aim.speed_m_s.max(1e-6) + turn_rad + STOP_S;
        (here + passed) / time_s
    }

    /// So many cells on each side it sees.
    #[expect(clippy::cast_possible_truncation, reason = "some hundreds at most")]
    fn reach(&self, map: &Map) -> i32 {
        libm::floor(self.half_m / map.field.cell_m).max(1.0) as i32
    }
}

/// What is to be found about a place, more if it is a leftover.
fn left(sums: &Sums, map: &Map, place: Point, reach: i32) -> f64 {
    let cell = map.field.column_and_row(place);
    let (here, _) = sums.about(cell, reach);
    let (around, count) = sums.about(cell, 3 * reach);
    let full = f64::from(6 * reach + 1) * f64::from(6 * reach + 1);
    let alone = 1.0 - around / full.max(count);
    here * (1.0 + LEFTOVER * alone)
}

/// What is to be found on the way between two places, but for the places themselves.
fn passed(sums: &Sums, map: &Map, [from, to]: [Point; 2], reach: i32) -> f64 {
    let way = from.to(to);
    let length_m = way.length();
    let stride_m = f64::from(2 * reach + 1) * map.field.cell_m;
    let mut along_m = length_m - stride_m;
    let mut sum = 0.0;
    while along_m > stride_m {
        let place = from.plus(way.times(along_m / length_m));
        sum += left(sums, map, place, reach);
        along_m -= stride_m;
    }
    sum
}

impl Behaviour for Ready {
    type Memory = Option<Box<Search>>;

    const NEEDS_BELIEFS: bool = true;
    const NEEDS_DETECTOR: bool = true;

    fn memory(&self) -> Self::Memory {
        None
    }

    fn triggered(&self, memory: &mut Self::Memory, senses: &Senses) -> Option<Wish> {
        let beliefs = senses.beliefs?;
        let (at, map) = (beliefs.pose()?.at, beliefs.map.as_ref()?);
        let search = memory.get_or_insert_default();
        let going = search.survey.still_going(senses.body.period_s);
        let is_left = |to: &Point| {
            let cell = map.field.nearest_cell(*to);
            map.unseen.of(cell) > DONE
        };
        let to = if let Some(to) = going.filter(is_left) {
            to
        } else {
            search.survey.look(map, at, senses.body);
            let to = self.best(search, beliefs, map)?;
            search.survey.going = Some((to, 0.0));
            to
        };
        Some(Wish::Aim(Aim { to, ..self.aim }))
    }

    fn judged(&self, memory: &mut Self::Memory, _verdict: Verdict) {
        if let Some(search) = memory {
            search.survey.give_up();
        }
    }

    fn held(&self) -> Motion {
        Motion::default()
    }
}
