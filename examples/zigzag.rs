//! Going in a zigzag: a behaviour of your own, in Rust.
//!
//! It has all that a behaviour has: the type that scenarios read, what that comes to in a body (`Ready`),
//! and what a robot remembers for it (`Memory`). `docs/brains.md` says where it goes.

use super::turn::Turn;
use crate::behaviours::behaviour::Behaviour;
use crate::goals::proposal::Proposal;
use crate::io::body::Body;
use crate::io::command::Motion;
use crate::perception::situation::Situation;
use alloc::boxed::Box;
use core::f64::consts::FRAC_PI_2;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Goes straight on for a time, turns a quarter to the left, goes straight on, turns a quarter to the
/// right, and so on: a camera that looks ahead sees more to the sides.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(inline)]
pub struct Zigzag {
    /// Time that it goes straight on, in seconds.
    #[schemars(range(min = 0.1, max = 3600.0))]
    pub straight_s: f64,
}

impl Default for Zigzag {
    fn default() -> Self {
        Self { straight_s: 5.0 }
    }
}

/// [`Zigzag`] in a body: what is the same for all robots of a kind.
#[derive(Debug, Clone)]
pub(crate) struct Ready {
    straight_s: f64,
    ahead: Motion,
}

/// What one robot remembers; in a box, so that robots with other behaviours take no more room for it.
pub(crate) type Memory = Box<Leg>;

/// What it is doing.
#[derive(Debug, Clone, Default)]
pub(crate) struct Leg {
    straight_s: f32,
    turn: Option<Turn>,
    turned_left: bool,
}

impl Ready {
    pub(super) fn new(spec: &Zigzag, body: &Body) -> Self {
        Self {
            straight_s: spec.straight_s,
            ahead: Motion {
                speed_m_s: body.max_speed_m_s,
                turn_rate_rad_s: 0.0,
            },
        }
    }
}

impl Behaviour for Ready {
    type Memory = Memory;

    fn memory(&self) -> Memory {
        Box::default()
    }

    /// What it wishes now; `None` would leave the robot to the behaviours below.
    fn triggered(&self, memory: &mut Memory, situation: &Situation) -> Option<Proposal> {
        if let Some(turn) = &mut memory.turn {
            if let Some(motion) = turn.go_on(situation) {
                return Some(motion.into());
            }
            (memory.turn, memory.straight_s) = (None, 0.0);
        }
        if f64::from(memory.straight_s) < self.straight_s {
            memory.straight_s += situation.period_s();
            return Some(self.ahead.into());
        }
        memory.turned_left = !memory.turned_left;
        let angle_rad = if memory.turned_left {
            FRAC_PI_2
        } else {
            -FRAC_PI_2
        };
        let (turn, motion) = Turn::by(angle_rad, situation.body);
        memory.turn = Some(turn);
        Some(motion.into())
    }

    fn held(&self) -> Motion {
        self.ahead
    }
}
