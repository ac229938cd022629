//! Driving in a zigzag: an example of a behaviour in Rust.
//!
//! It has the three parts of a behaviour: the type that scenarios read, the behaviour prepared for a
//! body (`Ready`), and the state of one robot (`Memory`). `docs/brains.md` explains how to add it.

use super::turn::Turn;
use crate::behaviours::behaviour::Behaviour;
use crate::goals::proposal::Proposal;
use crate::io::body::Body;
use crate::io::command::Motion;
use crate::situation::Situation;
use crate::situation::timer::Stopwatch;
use alloc::boxed::Box;
use core::f64::consts::FRAC_PI_2;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Drives straight for a time, turns 90 degrees to the left, drives straight, turns 90 degrees to the
/// right, and so on: a forward camera covers more of the sides.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(inline)]
pub struct Zigzag {
    /// Duration of a straight leg, in seconds.
    #[schemars(range(min = 0.1, max = 3600.0))]
    pub straight_s: f64,
}

impl Default for Zigzag {
    fn default() -> Self {
        Self { straight_s: 5.0 }
    }
}

/// [`Zigzag`] prepared for a body: shared by all robots of a kind.
#[derive(Debug, Clone)]
pub(crate) struct Ready {
    straight_s: f64,
    ahead: Motion,
}

/// The state of one robot; boxed, so that robots with other behaviours need no memory for it.
pub(crate) type Memory = Box<Leg>;

/// The current leg or turn.
#[derive(Debug, Clone, Default)]
pub(crate) struct Leg {
    straight: Stopwatch,
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

    /// The proposal for this step; `None` would leave the robot to lower behaviours.
    fn triggered(&self, memory: &mut Memory, situation: &Situation) -> Option<Proposal> {
        if let Some(turn) = &mut memory.turn {
            if let Some(motion) = turn.next_motion(situation) {
                return Some(motion.into());
            }
            (memory.turn, memory.straight) = (None, Stopwatch::START);
        }
        if memory.straight.read_s(situation) < self.straight_s {
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
