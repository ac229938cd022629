//! The flock of JuliaDynamics/ABMFrameworksComparison, by its declaration: 400 birds on each torus of
//! 150 by 150, who see 15 far, for 100 steps from a random start.

use krabmaga::engine::agent::Agent;
use krabmaga::engine::fields::field::Field as _;
use krabmaga::engine::fields::field_2d::{
    Field2D, Location2D, toroidal_distance, toroidal_transform,
};
use krabmaga::engine::location::Real2D;
use krabmaga::engine::schedule::Schedule;
use krabmaga::engine::state::State;
use std::any::Any;
use std::f32::consts::TAU;
use std::fmt;
use std::hash::{Hash, Hasher};

/// Steps of a run.
pub const STEPS: usize = 100;

const REACH: f32 = 15.0;
const SEPARATION: f32 = 1.0;
const COHERE: f32 = 0.03;
const SEPARATE: f32 = 0.015;
const MATCH: f32 = 0.05;

#[derive(Clone, Copy)]
pub struct Bird {
    id: u32,
    at: Real2D,
    /// Of length 1, and gone in one step.
    course: [f32; 2],
}

pub struct Sky {
    birds: Field2D<Bird>,
    count: u32,
    side: f32,
}

impl Sky {
    pub fn new(count: u32) -> Self {
        let side = 150.0 * (count as f32 / 400.0).sqrt();
        Self {
            birds: Field2D::new(side, side, REACH, true),
            count,
            side,
        }
    }
}

impl State for Sky {
    fn init(&mut self, schedule: &mut Schedule) {
        let mut chance = Chance(1);
        for id in 0..self.count {
            let at = Real2D {
                x: self.side * chance.unit(),
                y: self.side * chance.unit(),
            };
            let (y, x) = (TAU * chance.unit()).sin_cos();
            let bird = Bird {
                id,
                at,
                course: [x, y],
            };
            self.birds.set_object_location(bird, at);
            schedule.schedule_repeating(Box::new(bird), 0.0, 0);
        }
    }

    fn update(&mut self, _: u64) {
        self.birds.lazy_update();
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

impl Agent for Bird {
    fn step(&mut self, state: &mut dyn State) {
        let sky = state.as_any().downcast_ref::<Sky>();
        let sky = sky.expect("there is one kind of state");
        let near = sky.birds.get_neighbors_within_distance(self.at, REACH);
        self.turn(&near, sky.side);
        let [x, y] = self.course;
        self.at = Real2D {
            x: toroidal_transform(self.at.x + x, sky.side),
            y: toroidal_transform(self.at.y + y, sky.side),
        };
        sky.birds.set_object_location(*self, self.at);
    }
}

impl Bird {
    fn turn(&mut self, near: &[Bird], side: f32) {
        let [mut cohere, mut separate, mut matched] = [[0.0; 2]; 3];
        let mut count = 0.0_f32;
        for other in near.iter().filter(|other| other.id != self.id) {
            let way = [
                toroidal_distance(other.at.x, self.at.x, side),
                toroidal_distance(other.at.y, self.at.y, side),
            ];
            let is_near = way[0] * way[0] + way[1] * way[1] < SEPARATION * SEPARATION;
            for axis in 0..2 {
                cohere[axis] += way[axis];
                separate[axis] -= if is_near { way[axis] } else { 0.0 };
                matched[axis] += other.course[axis];
            }
            count += 1.0;
        }
        let count = count.max(1.0);
        let [x, y] = [0, 1].map(|axis| {
            let wish = COHERE * cohere[axis] + SEPARATE * separate[axis] + MATCH * matched[axis];
            self.course[axis] + wish / count
        });
        let length = (x * x + y * y).sqrt();
        self.course = [x / length, y / length];
    }
}

/// Knuth's linear congruential generator.
struct Chance(u64);

impl Chance {
    fn unit(&mut self) -> f32 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 / 16_777_216.0
    }
}

impl Location2D<Real2D> for Bird {
    fn get_location(self) -> Real2D {
        self.at
    }

    fn set_location(&mut self, at: Real2D) {
        self.at = at;
    }
}

impl PartialEq for Bird {
    fn eq(&self, other: &Self) -> bool {
        self.id == other.id
    }
}

impl Eq for Bird {}

impl Hash for Bird {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.id.hash(state);
    }
}

impl fmt::Display for Bird {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "bird {}", self.id)
    }
}
