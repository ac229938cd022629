//! Visiting places.

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

/// Visits places one after the other, around what is known to be in the way; then it has nothing more
/// to do. It needs to know where it is and where it points.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(inline)]
pub struct Navigate {
    /// The places, in metres.
    #[schemars(length(max = 10_000))]
    pub places_m: Vec<Point>,
    /// Who visits which.
    pub share: Share,
    /// It is at a place that is no farther, in metres.
    #[schemars(range(min = 0.01, max = 1000.0))]
    pub within_m: f64,
    /// Its speed, in m/s; left out, the most that the body can.
    #[schemars(range(min = 0.0, max = 100.0))]
    pub speed_m_s: Option<f64>,
    /// What being at the next place is worth, beside what other behaviours want.
    #[schemars(range(min = 0.0, max = 1e6))]
    pub value: f64,
}

/// Who visits which places.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Share {
    /// Every robot all of them.
    #[default]
    All,
    /// Each robot one: the first of its kind the first, and so on, from the beginning again if there are
    /// fewer places than robots.
    Each,
}

impl Default for Navigate {
    fn default() -> Self {
        Self {
            places_m: Vec::new(),
            share: Share::default(),
            within_m: 0.5,
            speed_m_s: None,
            value: 1.0,
        }
    }
}

/// [`Navigate`] in a body.
#[derive(Debug, Clone)]
pub(crate) struct Ready {
    spec: Navigate,
    speed_m_s: f64,
}

/// Numbers of the places that are left, the next one last; `None` before it begins.
pub(crate) type Memory = Option<Box<Vec<u32>>>;

impl Ready {
    pub(super) fn new(spec: &Navigate, body: &Body) -> Self {
        Self {
            spec: spec.clone(),
            speed_m_s: spec.speed_m_s.unwrap_or(body.max_speed_m_s),
        }
    }

    /// All places of a robot, the next one last.
    #[expect(clippy::cast_possible_truncation, reason = "ten thousand at most")]
    fn places(&self, senses: &Senses) -> Vec<u32> {
        let count = self.spec.places_m.len() as u32;
        match self.spec.share {
            Share::All => (0..count).rev().collect(),
            Share::Each => {
                let own = senses.percept.id.index.checked_rem(count);
                own.into_iter().collect()
            }
        }
    }

    fn next(&self, left: &[u32]) -> Option<Point> {
        let place = *left.last()? as usize;
        self.spec.places_m.get(place).copied()
    }
}

impl Behaviour for Ready {
    type Memory = Memory;

    const NEEDS_BELIEFS: bool = true;

    fn memory(&self) -> Memory {
        None
    }

    fn triggered(&self, memory: &mut Memory, senses: &Senses) -> Option<Wish> {
        let pose = senses.beliefs?.pose()?;
        let left = memory.get_or_insert_with(|| Box::new(self.places(senses)));
        let mut to = self.next(left)?;
        if pose.at.to(to).length() <= self.spec.within_m {
            left.pop();
            to = self.next(left)?;
        }
        Some(Wish::Aim(Aim {
            to,
            within_m: self.spec.within_m,
            speed_m_s: self.speed_m_s,
            value: self.spec.value,
        }))
    }

    /// What it cannot get to now, it tries again when it has visited all others.
    fn judged(&self, memory: &mut Memory, verdict: Verdict) {
        if let Some(left) = memory.as_mut().filter(|_| verdict == Verdict::Impossible) {
            left.rotate_right(1);
        }
    }

    fn held(&self) -> Motion {
        Motion::default()
    }
}
