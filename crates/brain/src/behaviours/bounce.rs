//! Searching by random bounces.

use super::{ahead, half_sight_m};
use crate::body::Body;
use crate::command::Motion;
use crate::rays::Ring;
use crate::senses::Senses;
use crate::subsumption::Behaviour;
use base::trig::wrapped;
use core::f64::consts::{FRAC_PI_4, TAU};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A turn that is done but for this is done.
const DONE_RAD: f32 = 0.02;

/// For one who cannot turn.
const MOST_PATIENCE_S: f64 = 60.0;

/// Who sees nothing turns by at least this.
const LEAST_BLIND_RAD: f64 = FRAC_PI_4;

/// Searches by random bounces: it goes straight on until something stands in its way or touches it,
/// turns on the spot to a course drawn at random among those that look free, and goes on. A robot
/// without range sensors turns by any angle but a small one.
///
/// Needs no compass: it turns for as long as the angle takes, and better if it has one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(inline)]
pub struct Bounce {
    /// It turns when something stands nearer ahead than this, from its hull, in metres; at most half
    /// as far as its range sensors see.
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub turn_at_m: f64,
    /// Time that it goes straight on after a turn before lower behaviours have their way, in
    /// seconds.
    #[schemars(range(min = 0.0, max = 3600.0))]
    pub hold_s: f64,
    /// Its speed while it goes straight on, in m/s; left out, the most that the body can.
    #[schemars(range(min = 0.0, max = 100.0))]
    pub speed_m_s: Option<f64>,
}

impl Default for Bounce {
    fn default() -> Self {
        Self {
            turn_at_m: 0.5,
            hold_s: 0.0,
            speed_m_s: None,
        }
    }
}

/// [`Bounce`] in a body.
#[derive(Debug, Clone)]
pub(crate) struct Ready {
    turn_at_m: f64,
    hold_s: f64,
    held: Motion,
}

/// What it is doing.
#[derive(Debug, Clone)]
pub(crate) enum Memory {
    /// It has gone on for so long.
    Going { since_s: f32 },
    /// It has so far to turn, anticlockwise, and loses patience after a time.
    Turning { left_rad: f32, patience_s: f32 },
}

/// It begins to go.
const GOING: Memory = Memory::Going { since_s: 0.0 };

impl Ready {
    pub(super) fn new(spec: &Bounce, body: &Body) -> Self {
        Self {
            turn_at_m: spec.turn_at_m.min(half_sight_m(body)),
            hold_s: spec.hold_s,
            held: ahead(spec.speed_m_s, body),
        }
    }
}

impl Behaviour for Ready {
    type Memory = Memory;

    fn memory(&self) -> Memory {
        GOING
    }

    fn hold_s(&self) -> f64 {
        self.hold_s
    }

    #[inline]
    fn triggered(&self, memory: &mut Memory, senses: &Senses) -> Option<Motion> {
        match memory {
            Memory::Going { since_s } => {
                let straight_s = f64::from(*since_s);
                *since_s += senses.period_s();
                let is_stopped =
                    senses.stands_ahead(self.turn_at_m, straight_s) || senses.touches(straight_s);
                is_stopped.then(|| self.turn(memory, senses))
            }
            Memory::Turning { .. } => go_on_turning(memory, senses),
        }
    }

    fn held(&self) -> Motion {
        self.held
    }

    #[inline]
    fn suppressed(&self, memory: &mut Memory) {
        *memory = GOING;
    }
}

impl Ready {
    #[expect(clippy::cast_possible_truncation, reason = "kept short")]
    fn turn(&self, memory: &mut Memory, senses: &Senses) -> Motion {
        let left_rad = self.new_course_rad(senses);
        // Twice the time that it takes, and a second, in case that it is stuck.
        let patience_s = 1.0 + 2.0 * left_rad.abs() / senses.body.max_turn_rate_rad_s;
        *memory = Memory::Turning {
            left_rad: left_rad as f32,
            patience_s: patience_s.min(MOST_PATIENCE_S) as f32,
        };
        on_the_spot(left_rad, senses)
    }

    /// The angle to a new course, from -pi to pi: that of a ray that is free for longer than it
    /// turns at, or else of the longest, and up to half way to the next ray.
    fn new_course_rad(&self, senses: &Senses) -> f64 {
        let mut dice = senses.dice();
        let free_m = senses.body.radius_m + self.turn_at_m;
        let is_free = |(_, _, range_m): &(&Ring, usize, f64)| *range_m > free_m;
        let count = rays(senses).filter(is_free).count();
        let chosen = rays(senses).filter(is_free).nth(dice.below(count));
        let longest = || rays(senses).max_by(|a, b| a.2.total_cmp(&b.2));
        let angle_rad = match chosen.or_else(longest) {
            Some((ring, ray, _)) => ring.about_rad(ray, dice.between(-0.5, 0.5)),
            None => dice.between(LEAST_BLIND_RAD, TAU - LEAST_BLIND_RAD),
        };
        wrapped(angle_rad)
    }
}

#[expect(clippy::cast_possible_truncation, reason = "kept short")]
fn go_on_turning(memory: &mut Memory, senses: &Senses) -> Option<Motion> {
    let Memory::Turning {
        left_rad,
        patience_s,
    } = memory
    else {
        return None;
    };
    *left_rad -= senses.turned_rad as f32;
    *patience_s -= senses.period_s();
    if left_rad.abs() <= DONE_RAD || *patience_s <= 0.0 {
        *memory = GOING;
        return None;
    }
    Some(on_the_spot(f64::from(*left_rad), senses))
}

/// As fast as it can without going too far before the next step.
fn on_the_spot(left_rad: f64, senses: &Senses) -> Motion {
    Motion {
        speed_m_s: 0.0,
        turn_rate_rad_s: left_rad / senses.body.period_s,
    }
}

/// Each ray of each fresh scan: its ring, its place there, and its range.
fn rays<'s>(senses: &'s Senses) -> impl Iterator<Item = (&'s Ring, usize, f64)> {
    senses.scans().flat_map(|(_, ring, ranges_m)| {
        let rays = 0..ranges_m.len();
        rays.map(move |ray| (ring, ray, ring.range_m(ranges_m, ray)))
    })
}
