//! Simulated lanes: items, looks of robots and the messages that follow from them.

use crate::clearance::{Clearance, LanePicture, RobotModel};
use base::geometry::Point;
use brain::{AgentId, CELLS_PER_MESSAGE, Coverage, GoalId, Lane, Mark};
use core::f64::consts::TAU;
use std::sync::Arc;

/// Random numbers, by `SplitMix64`.
pub(super) struct Random(pub(super) u64);

impl Random {
    pub(super) fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut word = self.0;
        word = (word ^ word >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        word = (word ^ word >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((word ^ word >> 31) >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub(super) fn is(&mut self, probability: f64) -> bool {
        self.unit() < probability
    }

    pub(super) fn poisson(&mut self, mean: f64) -> u32 {
        let (limit, mut product, mut count) = ((-mean).exp(), self.unit(), 0);
        while product > limit {
            product *= self.unit();
            count += 1;
        }
        count
    }

    fn normal(&mut self) -> f64 {
        (-2.0 * (1.0 - self.unit()).ln()).sqrt() * (TAU * self.unit()).cos()
    }

    fn near(&mut self, at: Point, deviation_m: f64) -> Point {
        let [x, y] = [self.normal(), self.normal()];
        at.plus(Point { x, y }.times(deviation_m))
    }
}

/// A sensor model, as it is.
pub(super) struct Sensor {
    /// Probability of a contact per look at a visible item.
    pub(super) detection: f64,
    /// Probability that a contact with an item is reported as its own kind, of two.
    pub(super) is_right: f64,
    /// False alarms of each kind per look and square metre.
    pub(super) false_alarms_per_m2: f64,
    pub(super) noise_m: f64,
}

pub(super) struct Item {
    pub(super) at: Point,
    pub(super) kind: usize,
    /// The kind that it looks like to each model; `None` if the model cannot detect it.
    seen: Vec<Option<usize>>,
    pub(super) is_marked: bool,
}

/// A lane of 20 m x 10 m with mines (kind 0) and clutter (kind 1), and robots of two sensor models,
/// the kinds 0 and 1.
pub(super) fn clearance(expected: [f64; 2], blind: [f64; 2]) -> Clearance {
    let robot = |model: u32, blind_share: f64| RobotModel {
        model,
        blind_share: vec![blind_share; 2],
        ..RobotModel::default()
    };
    Clearance {
        lane: Lane {
            min_m: [5.0, -5.0],
            max_m: [25.0, 5.0],
            cell_m: 2.0,
            hazards: 1,
        },
        free_shares: Vec::new(),
        expected: expected.to_vec(),
        destroy_probability: Vec::new(),
        robots: vec![robot(0, blind[0]), robot(1, blind[1])],
        declare_below: 0.05,
        interrogate_above: 0.05,
        tile_m: 10.0,
        searches: Vec::new(),
        interrogate: None,
        neutralise: None,
    }
}

/// The same, with a share of the mines that look like clutter to each model.
pub(super) fn with_lookalikes(mut clearance: Clearance, shares: [f64; 2]) -> Clearance {
    for (robot, share) in clearance.robots.iter_mut().zip(shares) {
        robot.lookalike_share = vec![vec![1.0 - share, share], vec![0.0, 1.0]];
    }
    clearance
}

/// The items of a lane that is as the clearance assumes.
pub(super) fn items(clearance: &Clearance, random: &mut Random) -> Vec<Item> {
    let area = clearance.lane.area();
    let mut items = Vec::new();
    for (kind, expected) in clearance.expected.iter().enumerate() {
        for _ in 0..random.poisson(*expected) {
            let (right, up) = (random.unit(), random.unit());
            let at = Point {
                x: area.min().x + right * area.size().x,
                y: area.min().y + up * area.size().y,
            };
            let robots = clearance.robots.iter();
            let seen = robots.map(|robot| {
                let is_visible = !random.is(robot.blind_share[kind]);
                is_visible.then(|| {
                    let share = robot.lookalike_share.get(kind);
                    let other = 1 - kind;
                    let is_alike = share.is_some_and(|row| random.is(row[other]));
                    if is_alike { other } else { kind }
                })
            });
            items.push(Item {
                at,
                kind,
                seen: seen.collect(),
                is_marked: false,
            });
        }
    }
    items
}

/// Each message is sent this many times.
const REPEATS: usize = 3;

/// A robot that looks at cells, and the probability that one of its messages is lost.
pub(super) struct Searcher<'s> {
    pub(super) id: AgentId,
    pub(super) sensor: &'s Sensor,
    pub(super) loss: f64,
    /// Number of looks at each cell.
    pub(super) looks: Vec<u32>,
}

impl Searcher<'_> {
    /// Looks at the lane; the messages that are not lost arrive.
    pub(super) fn search(
        &self,
        items: &mut [Item],
        picture: &mut LanePicture,
        random: &mut Random,
    ) {
        let lane = picture.clearance().lane;
        let mut marks: Vec<Mark> = Vec::new();
        for item in items.iter_mut() {
            let cell = lane.cell_at(item.at).unwrap();
            let Some(seen) = item.seen[usize::from(self.id.kind)] else {
                continue;
            };
            let contacts = self.contacts(item.at, seen, self.looks[cell], random);
            if !contacts.is_empty() {
                item.is_marked = true;
                marks.push(self.mark(marks.len(), &contacts, self.looks[cell]));
            }
        }
        for (cell, looks) in self.looks.iter().enumerate() {
            let area = lane.cell_area(cell);
            for kind in 0..2 {
                let expected = self.sensor.false_alarms_per_m2 * area.area_m2() * f64::from(*looks);
                for _ in 0..random.poisson(expected) {
                    let (x, y) = (random.unit(), random.unit());
                    let at = area.min().plus(Point {
                        x: x * area.size().x,
                        y: y * area.size().y,
                    });
                    marks.push(self.mark(marks.len(), &[(at, kind)], *looks));
                }
            }
        }
        self.publish(&marks, picture, random);
    }

    fn publish(&self, marks: &[Mark], picture: &mut LanePicture, random: &mut Random) {
        for _ in 0..REPEATS {
            for mark in marks {
                if !random.is(self.loss) {
                    picture.take_mark(self.id, mark);
                }
            }
            for first in (0..self.looks.len()).step_by(CELLS_PER_MESSAGE) {
                if !random.is(self.loss) {
                    picture.take_coverage(self.id, &self.coverage(first, marks.len()));
                }
            }
        }
    }

    fn coverage(&self, first: usize, marks: usize) -> Coverage {
        let nats = -(1.0 - self.sensor.detection).ln();
        let looks = |cell| self.looks.get(cell).copied().unwrap_or_default();
        Coverage {
            first: first as u32,
            marks: marks as u32,
            missed: core::array::from_fn(|cell| {
                Coverage::steps(nats * f64::from(looks(first + cell)))
            }),
            driven: [0; 16],
        }
    }

    /// The contacts of looks at an item that looks like a kind.
    fn contacts(
        &self,
        at: Point,
        seen: usize,
        looks: u32,
        random: &mut Random,
    ) -> Vec<(Point, usize)> {
        let mut contacts = Vec::new();
        for _ in 0..looks {
            if random.is(self.sensor.detection) {
                let is_right = random.is(self.sensor.is_right);
                let kind = if is_right { seen } else { 1 - seen };
                contacts.push((random.near(at, self.sensor.noise_m), kind));
            }
        }
        contacts
    }

    /// The mark of contacts that are known to be of one item or false alarm.
    fn mark(&self, number: usize, contacts: &[(Point, usize)], looks: u32) -> Mark {
        let Sensor {
            detection,
            is_right,
            false_alarms_per_m2,
            noise_m,
        } = *self.sensor;
        let variance_m2 = noise_m * noise_m;
        let count = contacts.len() as f64;
        let sum = contacts
            .iter()
            .fold(Point::default(), |sum, (at, _)| sum.plus(*at));
        let mean = sum.times(1.0 / count);
        let misses = f64::from(looks) - count;
        let log_ratio = |kind: usize| {
            let each = contacts.iter().map(|(at, reported)| {
                let share = if *reported == kind {
                    is_right
                } else {
                    1.0 - is_right
                };
                let density = detection * share / (TAU * variance_m2);
                let away_m2 = at.to(mean).length_squared();
                (density / false_alarms_per_m2).ln() - away_m2 / (2.0 * variance_m2)
            });
            (each.sum::<f64>() + misses * (1.0 - detection).ln()) as f32
        };
        Mark {
            id: GoalId {
                issuer: self.id.into(),
                number: number as u32,
            },
            at_m: [mean.x as f32, mean.y as f32],
            deviation_mm: Mark::millimetres(noise_m / count.sqrt()),
            log_ratios: [log_ratio(0), log_ratio(1), 0.0, 0.0],
            missed_since: 0,
            further: 0,
        }
    }
}

pub(super) fn picture(clearance: &Clearance) -> LanePicture {
    LanePicture::new(Arc::new(clearance.clone()))
}
