//! One step of all robots, as one vectorised function.

#![expect(
    clippy::inline_always,
    reason = "it is compiled for the vectors of its callers"
)]

use super::constants::{RADIUS_M, RANGE_M, SPEED_M_S, STEP_S, TURN_RAD_S};
use super::rays::{NearDisc, NearWall, Rays, cast};
use super::room::Room;
use super::team::Team;
use base::geometry::Point;
use base::noise::{Noise, normal_pairs};
use base::trig::{sin_cos, wrapped};
use pulp::{Arch, Simd, WithSimd};

/// Power of a robot, and energy per metre.
const IDLE_W: f64 = 10.0;
const MOVE_J_PER_M: f64 = 10.0;

/// Distance ahead within which it turns away.
const NEAR_M: f64 = 0.6;

impl Team {
    pub(crate) fn step(&mut self) {
        self.refresh();
        let mut room = std::mem::take(&mut self.room);
        room.next.resize(self.x.len(), Point::default());
        Arch::new().dispatch(Step {
            team: self,
            room: &mut room,
        });
        for (robot, at) in room.next.iter().enumerate() {
            self.x[robot] = at.x;
            self.y[robot] = at.y;
        }
        self.room = room;
        self.tick += 1;
        // The distance that it drives, and at most the same by being pushed.
        self.lists.gone_m += 2.0 * SPEED_M_S * STEP_S;
    }
}

struct Step<'a> {
    team: &'a mut Team,
    room: &'a mut Room,
}

impl WithSimd for Step<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let mut ranges = [[0.0; 8]; 2];
        for robot in 0..self.team.x.len() {
            let pushed = gather(self.team, self.room, robot);
            let room = &mut *self.room;
            let discs = &room.discs[..room.disc_count];
            let walls = &room.walls[..room.wall_count];
            cast(
                simd,
                &room.directions,
                discs,
                walls,
                &mut room.hits,
                &mut ranges,
            );
            if self.team.has_noise {
                blur(
                    self.room.noise,
                    self.team.tick,
                    self.team.key[robot],
                    &mut ranges,
                );
            }
            let turn = decide(self.team, robot, &ranges);
            self.room.next[robot] = drive(self.team, robot, turn, pushed);
        }
    }
}

/// Fills the neighbours, in the frame of the robot; returns the displacement by contacts.
#[expect(clippy::too_many_lines, reason = "one pass over what is near")]
#[inline(always)]
fn gather(team: &mut Team, room: &mut Room, robot: usize) -> Point {
    let Team {
        x,
        y,
        front,
        lists,
        pillars,
        walls,
        ..
    } = team;
    let (at, front) = (
        Point {
            x: x[robot],
            y: y[robot],
        },
        front[robot],
    );
    let own = |way: Point| [front.dot(way), front.cross(way)];
    let start = robot
        .checked_sub(1)
        .map_or(0, |before| lists.ends[before][2]) as usize;
    let [robots, discs, sides] = lists.ends[robot].map(|end| end as usize);
    let most = sides - start;
    if room.discs.len() < most {
        room.discs.resize(most, NearDisc::default());
        room.walls.resize(most, NearWall::default());
        room.hits.resize(most, 0);
    }
    let mut pushed = Point::default();
    let mut found = 0;
    let mut disc = |centre: Point, radius_m: f64| {
        let way = at.to(centre);
        let square = way.length_squared();
        let [x, y] = own(way);
        room.discs[found] = NearDisc {
            x,
            y,
            power: square - radius_m * radius_m,
        };
        let reach = RANGE_M + radius_m;
        found += usize::from(square < reach * reach);
        let gap = RADIUS_M + radius_m;
        if square < gap * gap {
            let distance = square.sqrt();
            let by = (distance - gap) / 2.0 / distance.max(1e-9);
            pushed = pushed.plus(way.times(by));
            team.collisions += 1;
        }
    };
    for other in &lists.things[start..robots] {
        disc(
            Point {
                x: x[*other as usize],
                y: y[*other as usize],
            },
            RADIUS_M,
        );
    }
    for number in &lists.things[robots..discs] {
        disc(
            pillars[*number as usize].centre,
            pillars[*number as usize].radius_m,
        );
    }
    room.disc_count = found;
    let mut found = 0;
    for number in &lists.things[discs..sides] {
        let [from, to] = walls[*number as usize].map(|end| at.to(end));
        let area = from.cross(to);
        let length = from.to(to).length_squared();
        room.walls[found] = NearWall {
            from: own(from),
            to: own(to),
            area,
        };
        found += usize::from((area > 0.0) & (area * area < RANGE_M * RANGE_M * length));
        if (area > 0.0) & (area * area < RADIUS_M * RADIUS_M * length) {
            let along = from.to(to);
            if (from.dot(along) < 0.0) & (to.dot(along) > 0.0) {
                let by = (RADIUS_M - area / length.sqrt()) / length.sqrt();
                pushed = pushed.plus(Point {
                    x: -along.y * by,
                    y: along.x * by,
                });
                team.collisions += 1;
            }
        }
    }
    room.wall_count = found;
    pushed
}

#[inline(always)]
fn blur(noise: Noise, tick: u64, key: u32, ranges: &mut Rays) {
    let words = noise.batch_words(key, tick, 0);
    let deviations = normal_pairs([&words[0], &words[1]]);
    for (range, deviation) in ranges
        .as_flattened_mut()
        .iter_mut()
        .zip(deviations.as_flattened())
    {
        let measured = (*range + 0.02 * deviation).max(0.0);
        *range = if *range < RANGE_M { measured } else { *range };
    }
}

/// Turn rate.
#[inline(always)]
fn decide(team: &mut Team, robot: usize, ranges: &Rays) -> f64 {
    let left = ranges[0][1].min(ranges[0][2]).min(ranges[0][0]);
    let right = ranges[1][7].min(ranges[1][6]).min(ranges[0][0]);
    let turning = &mut team.turning[robot];
    if *turning == 0 && left.min(right) < NEAR_M {
        let word = u64::from(team.key[robot]).wrapping_add(team.tick << 32);
        let chance = (word ^ (word >> 29)).wrapping_mul(0xBF58_476D_1CE4_E5B9) >> 60;
        let steps = 4 + chance as i32;
        *turning = if left > right { steps } else { -steps };
    }
    let turn = TURN_RAD_S * f64::from(turning.signum());
    *turning -= turning.signum();
    turn
}

/// New position.
#[inline(always)]
fn drive(team: &mut Team, robot: usize, turn: f64, pushed: Point) -> Point {
    let speed = if turn == 0.0 { SPEED_M_S } else { 0.0 };
    let heading_rad = wrapped(team.heading_rad[robot] + turn * STEP_S);
    team.heading_rad[robot] = heading_rad;
    let (y, x) = sin_cos(heading_rad);
    team.front[robot] = Point { x, y };
    team.energy_j[robot] += IDLE_W * STEP_S + MOVE_J_PER_M * speed * STEP_S;
    let way = Point { x, y }.times(speed * STEP_S);
    let place = Point {
        x: team.x[robot],
        y: team.y[robot],
    }
    .plus(way)
    .plus(pushed);
    let most = team.side_m - RADIUS_M;
    Point {
        x: place.x.max(RADIUS_M).min(most),
        y: place.y.max(RADIUS_M).min(most),
    }
}
