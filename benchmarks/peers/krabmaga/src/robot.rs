//! Robots as agents of krABMaga, and the world as its state.

use crate::field::Field;
use crate::rays::{self, Disc, RANGE_M, Wall};
use krabmaga::engine::agent::Agent;
use krabmaga::engine::fields::field::Field as _;
use krabmaga::engine::fields::field_2d::{Field2D, Location2D};
use krabmaga::engine::location::Real2D;
use krabmaga::engine::schedule::Schedule;
use krabmaga::engine::state::State;
use std::any::Any;
use std::f32::consts::TAU;
use std::fmt;
use std::hash::{Hash, Hasher};

const RADIUS_M: f32 = 0.2;
const STEP_S: f32 = 0.1;
const SPEED_M_S: f32 = 0.5;
const TURN_RAD_S: f32 = 1.5;
/// It turns away from what is nearer ahead.
const NEAR_M: f32 = 0.6;

#[derive(Clone, Copy)]
pub struct Robot {
    id: u32,
    at: Real2D,
    heading_rad: f32,
    /// Steps left of a turn; negative to the right.
    turning: i32,
}

/// All robots, and what stands still.
pub struct World {
    robots: Field2D<Robot>,
    starts: Vec<[f32; 3]>,
    pillars: Vec<[f32; 3]>,
    walls: Vec<Wall>,
    side_m: f32,
    step: u64,
    has_rays: bool,
}

impl World {
    pub fn new(field: Field, has_rays: bool) -> Self {
        let side_m = field.side_m;
        Self {
            robots: Field2D::new(side_m, side_m, RANGE_M + RADIUS_M, false),
            walls: field.walls(),
            starts: field.robots,
            pillars: field.pillars,
            side_m,
            step: 0,
            has_rays,
        }
    }
}

impl State for World {
    fn init(&mut self, schedule: &mut Schedule) {
        for (id, [x, y, heading_rad]) in (0..).zip(self.starts.iter().copied()) {
            let at = Real2D { x, y };
            let robot = Robot {
                id,
                at,
                heading_rad,
                turning: 0,
            };
            self.robots.set_object_location(robot, at);
            schedule.schedule_repeating(Box::new(robot), 0.0, 0);
        }
    }

    fn update(&mut self, step: u64) {
        self.step = step;
        self.robots.lazy_update();
    }

    fn reset(&mut self) {}

    fn as_any(&self) -> &dyn Any {
        self
    }

    fn as_any_mut(&mut self) -> &mut dyn Any {
        self
    }

    fn as_state(&self) -> &dyn State {
        self
    }

    fn as_state_mut(&mut self) -> &mut dyn State {
        self
    }
}

impl Agent for Robot {
    fn step(&mut self, state: &mut dyn State) {
        let world = state.as_any().downcast_ref::<World>();
        let world = world.expect("there is one kind of world");
        let reach_m = RANGE_M + RADIUS_M;
        let neighbours = world.robots.get_neighbors_within_distance(self.at, reach_m);
        let others = neighbours.iter().filter(|other| other.id != self.id);
        let discs = others.map(|other| self.seen(other.at.x, other.at.y, RADIUS_M));
        let mut discs: Vec<Disc> = discs.collect();
        let pushed = pushed(&discs);
        let [left, right] = if world.has_rays {
            self.rays_ahead(world, &mut discs)
        } else {
            self.nearest_ahead(&discs)
        };
        self.decide(left, right, world.step);
        self.drive(pushed, world.side_m);
        world.robots.set_object_location(*self, self.at);
    }
}

impl Robot {
    fn seen(&self, x: f32, y: f32, radius_m: f32) -> Disc {
        [x - self.at.x, y - self.at.y, radius_m]
    }

    /// What the rays ahead say, to the left and to the right.
    fn rays_ahead(&self, world: &World, discs: &mut Vec<Disc>) -> [f32; 2] {
        let pillars = world
            .pillars
            .iter()
            .map(|[x, y, radius_m]| self.seen(*x, *y, *radius_m));
        discs.extend(pillars.filter(|[x, y, radius_m]| {
            let reach_m = RANGE_M + radius_m;
            x * x + y * y < reach_m * reach_m
        }));
        let Real2D { x, y } = self.at;
        let walls = world
            .walls
            .iter()
            .map(|[a, b, c, d]| [a - x, b - y, c - x, d - y]);
        let walls: Vec<Wall> = walls.filter(rays::is_near).collect();
        let ranges = rays::ranges(self.heading_rad, discs, &walls);
        let nearest = |rays: [usize; 3]| {
            rays.map(|ray| ranges[ray])
                .into_iter()
                .fold(RANGE_M, f32::min)
        };
        [nearest([0, 1, 2]), nearest([0, 15, 14])]
    }

    /// The same without rays: how near the nearest neighbours ahead are.
    fn nearest_ahead(&self, discs: &[Disc]) -> [f32; 2] {
        let mut nearest = [RANGE_M; 2];
        let (front_y, front_x) = self.heading_rad.sin_cos();
        for [x, y, radius_m] in discs {
            let (ahead, left) = (front_x * x + front_y * y, front_x * y - front_y * x);
            if ahead > left.abs() {
                let side = &mut nearest[usize::from(left < 0.0)];
                *side = side.min((x * x + y * y).sqrt() - radius_m);
            }
        }
        nearest
    }

    fn decide(&mut self, left: f32, right: f32, step: u64) {
        if self.turning == 0 && left.min(right) < NEAR_M {
            let word = u64::from(self.id).wrapping_add(step << 32);
            let chance = (word ^ (word >> 29)).wrapping_mul(0xBF58_476D_1CE4_E5B9) >> 60;
            let steps = 4 + chance as i32;
            self.turning = if left > right { steps } else { -steps };
        }
    }

    fn drive(&mut self, [push_x, push_y]: [f32; 2], side_m: f32) {
        let turn = self.turning.signum();
        self.turning -= turn;
        self.heading_rad = (self.heading_rad + turn as f32 * TURN_RAD_S * STEP_S).rem_euclid(TAU);
        let way_m = if turn == 0 { SPEED_M_S * STEP_S } else { 0.0 };
        let (front_y, front_x) = self.heading_rad.sin_cos();
        let inside = |place: f32| place.clamp(RADIUS_M, side_m - RADIUS_M);
        self.at = Real2D {
            x: inside(self.at.x + front_x * way_m + push_x),
            y: inside(self.at.y + front_y * way_m + push_y),
        };
    }
}

/// By how much robots that touch push it.
fn pushed(discs: &[Disc]) -> [f32; 2] {
    let mut pushed = [0.0; 2];
    for [x, y, radius_m] in discs {
        let gap_m = RADIUS_M + radius_m;
        let square = x * x + y * y;
        if square < gap_m * gap_m {
            let distance_m = square.sqrt();
            let by = (distance_m - gap_m) / 2.0 / distance_m.max(1e-9);
            pushed = [pushed[0] + x * by, pushed[1] + y * by];
        }
    }
    pushed
}

impl Location2D<Real2D> for Robot {
    fn get_location(self) -> Real2D {
        self.at
    }

    fn set_location(&mut self, at: Real2D) {
        self.at = at;
    }
}

impl PartialEq for Robot {
    fn eq(&self, other: &Self) -> bool {
        self.id == other.id
    }
}

impl Eq for Robot {}

impl Hash for Robot {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.id.hash(state);
    }
}

impl fmt::Display for Robot {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "robot {}", self.id)
    }
}
