//! Getting out of the way of what is too near.

use super::{ahead, half_sight_m};
use crate::body::Body;
use crate::command::Motion;
use crate::rays::Ring;
use crate::senses::Senses;
use crate::subsumption::Behaviour;
use alloc::vec::Vec;
use core::f64::consts::{FRAC_PI_4, PI, TAU};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Two sides that differ by less are equally free, in metres.
const SAME_M: f64 = 0.01;

/// For one who cannot turn.
const LEAST_TURN_RATE_RAD_S: f64 = 1e-3;

/// Gets out of the way of what is too near: it turns on the spot, to the freer side, until it is
/// clear. If it touches something it first backs off, if the body can, and turns by at least an
/// eighth of a turn.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(inline)]
pub struct Avoid {
    /// What is nearer to its hull than this is too near, in metres; at most half as far as its range
    /// sensors see.
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub near_m: f64,
    /// It is clear when everything is farther than `near_m` by this, in metres.
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub clear_by_m: f64,
    /// Angle about the front in which it looks, in degrees.
    #[schemars(range(min = 0.0, max = 360.0))]
    pub sector_deg: f64,
    /// It backs off so far from what it touches, in metres.
    #[schemars(range(min = 0.0, max = 100.0))]
    pub back_off_m: f64,
    /// Time that it goes straight on once it is clear before lower behaviours have their way, in
    /// seconds. Without it a robot with a goal locks in front of a large obstacle: it turns away,
    /// and at once back to its goal.
    #[schemars(range(min = 0.0, max = 3600.0))]
    pub hold_s: f64,
    /// Its speed while it goes straight on, in m/s; left out, the most that the body can.
    #[schemars(range(min = 0.0, max = 100.0))]
    pub speed_m_s: Option<f64>,
}

impl Default for Avoid {
    fn default() -> Self {
        Self {
            near_m: 0.15,
            clear_by_m: 0.05,
            sector_deg: 120.0,
            back_off_m: 0.2,
            hold_s: 1.0,
            speed_m_s: None,
        }
    }
}

/// [`Avoid`] in a body.
#[derive(Debug, Clone)]
pub(crate) struct Ready {
    near_m: f64,
    clear_m: f64,
    hold_s: f64,
    held: Motion,
    back: Motion,
    backing_s: f64,
    turn_rate_rad_s: f64,
    /// Of each ring, the rays on the left and on the right side of the sector.
    sides: Vec<[Vec<usize>; 2]>,
}

/// What it is doing.
#[derive(Debug, Clone)]
pub(crate) enum Memory {
    /// It has been clear for so long.
    Clear { since_s: f32 },
    /// It has so long to back off.
    Backing { left_s: f32 },
    /// It turns since a time, and so long at least.
    Turning {
        is_left: bool,
        since_s: f32,
        least_s: f32,
    },
}

/// It begins to be clear.
const CLEAR: Memory = Memory::Clear { since_s: 0.0 };

impl Ready {
    pub(super) fn new(spec: &Avoid, body: &Body) -> Self {
        let half_rad = (spec.sector_deg / 2.0).to_radians();
        let rings = body.rings.iter().map(|ring| Ring::new(ring, body.period_s));
        let sides = rings
            .map(|ring| [(0.0, half_rad), (-half_rad, 0.0)].map(|(a, b)| ring.rays_within(a, b)));
        let back_m_s = body.max_reverse_speed_m_s;
        let near_m = spec.near_m.min(half_sight_m(body));
        Self {
            near_m,
            clear_m: near_m + spec.clear_by_m.min(near_m),
            hold_s: spec.hold_s,
            held: ahead(spec.speed_m_s, body),
            back: ahead(Some(-back_m_s), body),
            backing_s: if back_m_s > 0.0 {
                spec.back_off_m / back_m_s
            } else {
                0.0
            },
            turn_rate_rad_s: body.max_turn_rate_rad_s.max(LEAST_TURN_RATE_RAD_S),
            sides: sides.collect(),
        }
    }
}

impl Behaviour for Ready {
    type Memory = Memory;

    fn memory(&self) -> Memory {
        CLEAR
    }

    #[inline]
    fn hold_s(&self) -> f64 {
        self.hold_s
    }

    #[inline]
    fn triggered(&self, memory: &mut Memory, senses: &Senses) -> Option<Motion> {
        let period_s = senses.period_s();
        match memory {
            Memory::Clear { since_s } => {
                let clear_s = f64::from(*since_s);
                *since_s += period_s;
                self.look(memory, clear_s, senses)
            }
            Memory::Backing { left_s } if *left_s > 0.0 => {
                *left_s -= period_s;
                Some(self.back)
            }
            Memory::Backing { .. } => Some(self.turn_from_touch(memory, senses)),
            Memory::Turning { since_s, .. } => {
                *since_s += period_s;
                self.go_on_turning(memory, senses)
            }
        }
    }

    fn held(&self) -> Motion {
        self.held
    }

    #[inline]
    fn suppressed(&self, memory: &mut Memory) {
        *memory = CLEAR;
    }
}

impl Ready {
    #[inline]
    #[expect(clippy::cast_possible_truncation, reason = "kept short")]
    fn look(&self, memory: &mut Memory, clear_s: f64, senses: &Senses) -> Option<Motion> {
        if senses.touches(clear_s) {
            if self.backing_s <= 0.0 {
                return Some(self.turn_from_touch(memory, senses));
            }
            let left_s = self.backing_s as f32 - senses.period_s();
            *memory = Memory::Backing { left_s };
            return Some(self.back);
        }
        let [left_m, right_m] = self.nearest_m(senses);
        let is_near = left_m.min(right_m) < self.near_m;
        is_near.then(|| self.turn(memory, [left_m, right_m], 0.0, senses))
    }

    fn turn_from_touch(&self, memory: &mut Memory, senses: &Senses) -> Motion {
        let mut dice = senses.dice();
        // The first number is for the side.
        dice.unit();
        let least_rad = dice.between(FRAC_PI_4, PI);
        self.turn(memory, self.nearest_m(senses), least_rad, senses)
    }

    #[expect(clippy::cast_possible_truncation, reason = "kept short")]
    fn turn(
        &self,
        memory: &mut Memory,
        [left_m, right_m]: [f64; 2],
        least_rad: f64,
        senses: &Senses,
    ) -> Motion {
        let is_same = left_m == right_m || (left_m - right_m).abs() < SAME_M;
        let is_left = if is_same {
            senses.dice().below(2) == 0
        } else {
            left_m > right_m
        };
        *memory = Memory::Turning {
            is_left,
            since_s: 0.0,
            least_s: (least_rad / self.turn_rate_rad_s) as f32,
        };
        self.on_the_spot(is_left)
    }

    fn go_on_turning(&self, memory: &mut Memory, senses: &Senses) -> Option<Motion> {
        let Memory::Turning {
            is_left,
            since_s,
            least_s,
        } = *memory
        else {
            return None;
        };
        let [left_m, right_m] = self.nearest_m(senses);
        // Where nothing is clear, somewhere is the least near.
        let is_round = f64::from(since_s) * self.turn_rate_rad_s > TAU;
        let clear_m = if is_round { self.near_m } else { self.clear_m };
        if since_s >= least_s && left_m.min(right_m) >= clear_m {
            *memory = CLEAR;
            return None;
        }
        Some(self.on_the_spot(is_left))
    }

    fn on_the_spot(&self, is_left: bool) -> Motion {
        let rate = self.turn_rate_rad_s;
        Motion {
            speed_m_s: 0.0,
            turn_rate_rad_s: if is_left { rate } else { -rate },
        }
    }

    /// From the hull to the nearest on the left and on the right; infinite if nothing is seen.
    #[inline]
    fn nearest_m(&self, senses: &Senses) -> [f64; 2] {
        let mut nearest_m = [f64::INFINITY; 2];
        for (place, ring, ranges_m) in senses.scans() {
            let sides = self.sides.get(place).into_iter().flatten();
            for (nearest_m, rays) in nearest_m.iter_mut().zip(sides) {
                for ray in rays {
                    *nearest_m = nearest_m.min(ring.range_m(ranges_m, *ray));
                }
            }
        }
        nearest_m.map(|nearest_m| nearest_m - senses.body.radius_m)
    }
}
