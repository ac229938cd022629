//! For tests: a disc that executes commands exactly, among walls that its rays measure exactly.

use crate::brain::Brain;
use crate::io::agent_id::AgentId;
use crate::io::body::{Body, RangeRing};
use crate::io::command::{Command, Motion};
use crate::io::percept::{Neighbour, Observation, Percept, Reading, Scan};
use base::geometry::{Point, Segment};
use base::random::{Entity, Purpose, Stream, stream, unit};
use base::trig::{sin_cos, wrapped};
use std::collections::VecDeque;
use std::f64::consts::{PI, TAU};

/// Substeps of a step of motion.
const PARTS: u32 = 20;

/// Rays in all directions, the first ahead, with a scan at each step of 0.1 s without latency.
pub(crate) fn ring(rays: usize, range_m: f64) -> RangeRing {
    #[expect(clippy::cast_precision_loss, reason = "few")]
    let bearing = |ray| wrapped(TAU * ray as f64 / rays as f64);
    let bearings_rad = (0..rays).map(bearing).collect();
    RangeRing {
        bearings_rad,
        range_m,
        period_s: 0.1,
        latency_s: 0.0,
    }
}

/// The distance, in lengths of `direction`, at which the ray from `origin` meets the free side of a
/// wall; the solid side, and a ray along the wall, meet nothing. An end on the ray counts for both
/// sides, so that a ray between two walls with a common end meets one of them.
fn hit(wall: &Segment, origin: Point, direction: Point) -> Option<f64> {
    let (from, to) = (origin.to(wall.from), origin.to(wall.to));
    let (right, left) = (direction.cross(from), direction.cross(to));
    let comes_from_free = right <= 0.0 && left >= 0.0 && left > right;
    let ahead = (direction.dot(from) * left - direction.dot(to) * right)
        / ((left - right) * direction.length_squared());
    (comes_from_free && ahead >= 0.0).then_some(ahead)
}

/// A small robot with 16 sonar sensors.
pub(crate) fn rover() -> Body {
    Body {
        radius_m: 0.25,
        max_speed_m_s: 1.0,
        max_acceleration_m_s2: 1.0,
        max_turn_rate_rad_s: PI / 2.0,
        period_s: 0.1,
        rings: vec![ring(16, 3.0)],
        ..Body::default()
    }
}

/// The walls of a room from 0 to its width and height.
pub(crate) fn room(width: f64, height: f64) -> Vec<Segment> {
    outline(&[[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]])
}

/// Walls between consecutive corners, free on the left.
pub(crate) fn outline(corners: &[[f64; 2]]) -> Vec<Segment> {
    let next = corners.iter().cycle().skip(1);
    let sides = corners.iter().zip(next);
    sides
        .map(|(from, to)| Segment {
            from: (*from).into(),
            to: (*to).into(),
        })
        .collect()
}

/// The walls of a square box that is turned by an angle.
pub(crate) fn square(centre: Point, angle_rad: f64, side_m: f64) -> Vec<Segment> {
    let half_diagonal_m = side_m / 2.0_f64.sqrt();
    // Clockwise: it is free outside.
    let corners = [0.0, 1.0, 2.0, 3.0].map(|corner| {
        let (y, x) = sin_cos(angle_rad - corner * PI / 2.0);
        [
            centre.x + half_diagonal_m * x,
            centre.y + half_diagonal_m * y,
        ]
    });
    outline(&corners)
}

/// The sensors of a robot.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Wiring {
    /// Steps between scans, minus one.
    pub(crate) scans_apart: usize,
    /// Latency of a scan, in steps.
    pub(crate) latency: usize,
    /// Probability that a scan is lost.
    pub(crate) lost_share: f64,
    pub(crate) touch: bool,
    pub(crate) compass: bool,
    /// Pose readings, and a measurement without contacts of its first detector in each step.
    pub(crate) position: bool,
    /// Fraction of the battery used per second; 0 without a gauge.
    pub(crate) drain: f64,
}

/// A robot and its world.
pub(crate) struct Walk {
    pub(crate) body: Body,
    pub(crate) walls: Vec<Segment>,
    pub(crate) wiring: Wiring,
    pub(crate) at: Point,
    pub(crate) heading_rad: f64,
    pub(crate) speed_m_s: f64,
    /// Index of the robot, and number of robots.
    pub(crate) id: (AgentId, u32),
    /// Other robots, which it always detects.
    pub(crate) others: Vec<(AgentId, Point)>,
    /// The minimum distance from its footprint to a wall up to now.
    pub(crate) min_gap_m: f64,
    pub(crate) is_touching: bool,
    steps: usize,
    /// Measured scans with their steps.
    scans: VecDeque<(usize, Vec<f64>)>,
    random: Stream,
    random_dropouts: Stream,
}

impl Walk {
    pub(crate) fn new(body: Body, walls: Vec<Segment>, at: [f64; 2], heading_rad: f64) -> Self {
        let robot = Entity { kind: 0, index: 0 };
        Self {
            body,
            walls,
            wiring: Wiring::default(),
            at: at.into(),
            heading_rad,
            speed_m_s: 0.0,
            id: (AgentId::default(), 1),
            others: Vec::new(),
            min_gap_m: f64::INFINITY,
            is_touching: false,
            steps: 0,
            scans: VecDeque::new(),
            random: stream(1, 0, robot, Purpose::Start),
            random_dropouts: stream(2, 0, robot, Purpose::Start),
        }
    }

    /// Runs a brain for a number of steps.
    pub(crate) fn run(&mut self, brain: &mut Brain, steps: usize) {
        let mut command = Command::default();
        for _ in 0..steps {
            let percept = self.percept();
            brain.step_into(&percept, &mut command);
            self.step(command.motion);
        }
    }

    #[expect(clippy::cast_precision_loss, reason = "few")]
    pub(crate) fn percept(&mut self) -> Percept {
        let is_due = self.steps.is_multiple_of(self.wiring.scans_apart + 1);
        if is_due && unit(&mut self.random_dropouts) >= self.wiring.lost_share {
            let ring = self.body.rings.first();
            let ranges = ring.map(|ring| self.ranges_m(ring));
            self.scans.extend(ranges.map(|ranges| (self.steps, ranges)));
        }
        let came_in = |(step, _): &&(usize, Vec<f64>)| step + self.wiring.latency <= self.steps;
        let latest = self.scans.iter().rev().find(came_in);
        let scan = latest.map(|(step, ranges)| Scan {
            age_s: Some((self.steps - step) as f64 * self.body.period_s),
            ranges_m: ranges.clone(),
        });
        let time_s = self.steps as f64 * self.body.period_s;
        let look = Observation {
            sensor: 0,
            age_s: 0.0,
        };
        let has_gauge = self.wiring.drain > 0.0;
        let left = (1.0 - self.wiring.drain * time_s).max(0.0);
        Percept {
            time_s: Some(time_s),
            id: self.id.0,
            team_size: self.id.1,
            position: self.wiring.position.then_some(now(self.at)),
            battery: has_gauge.then_some(now(left)),
            observations: self.wiring.position.then_some(look).into_iter().collect(),
            neighbours: self.others.iter().map(|other| self.seen(other)).collect(),
            random_words: std::array::from_fn(|_| self.random.next_u32()),
            touch: self.wiring.touch.then_some(now(self.is_touching)),
            heading_rad: self.wiring.compass.then_some(now(self.heading_rad)),
            scans: vec![scan.unwrap_or_default(); self.body.rings.len()],
            ..Percept::default()
        }
    }

    fn seen(&self, (id, at): &(AgentId, Point)) -> Neighbour {
        let way = self.at.to(*at);
        Neighbour {
            range_m: way.length(),
            bearing_rad: wrapped(way.y.atan2(way.x) - self.heading_rad),
            course_rad: None,
            age_s: 0.0,
            uncertainty_m: 0.0,
            id: *id,
        }
    }

    fn ranges_m(&self, ring: &RangeRing) -> Vec<f64> {
        let range = |bearing: &f64| {
            let (y, x) = sin_cos(self.heading_rad + bearing);
            let hits = self
                .walls
                .iter()
                .filter_map(|wall| hit(wall, self.at, Point { x, y }));
            let range_m = hits.fold(f64::INFINITY, f64::min);
            if range_m > ring.range_m {
                f64::INFINITY
            } else {
                range_m
            }
        };
        ring.bearings_rad.iter().map(range).collect()
    }

    /// Executes a motion for one period; the robot stops at walls.
    pub(crate) fn step(&mut self, motion: Motion) {
        let part_s = self.body.period_s / f64::from(PARTS);
        let most = self.body.max_acceleration_m_s2 * part_s;
        self.is_touching = false;
        for _ in 0..PARTS {
            let before_m_s = self.speed_m_s;
            self.speed_m_s += (motion.speed_m_s - before_m_s).clamp(-most, most);
            self.heading_rad = wrapped(self.heading_rad + motion.turn_rate_rad_s * part_s);
            let (y, x) = sin_cos(self.heading_rad);
            let change_m_s = self.speed_m_s - before_m_s;
            let change_s = change_m_s.abs() / self.body.max_acceleration_m_s2;
            let way_m = self.speed_m_s * part_s - change_m_s * change_s / 2.0;
            let there = self.at.plus(Point { x, y }.times(way_m));
            let gap_m = self.gap_m(there);
            self.min_gap_m = self.min_gap_m.min(gap_m);
            if gap_m > 0.0 || gap_m > self.gap_m(self.at) {
                self.at = there;
            } else {
                self.is_touching = true;
                self.speed_m_s = 0.0;
            }
        }
        self.steps += 1;
        while self.scans.len() > self.wiring.latency + 2 {
            self.scans.pop_front();
        }
    }

    pub(crate) fn gap_m(&self, at: Point) -> f64 {
        let distances = self.walls.iter().map(|wall| wall.distance_m(at));
        distances.fold(f64::INFINITY, f64::min) - self.body.radius_m
    }
}

/// A reading of age 0.
pub(crate) fn now<T>(value: T) -> Reading<T> {
    Reading { value, age_s: 0.0 }
}
