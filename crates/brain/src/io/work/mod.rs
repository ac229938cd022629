//! What goals consist of, and the messages that a kind of work needs beside those of its contracts.

pub(crate) mod lane;

use super::goal_id::GoalId;
use base::geometry::Point;
use base::hashed::Hashed;
use lane::MAX_COORDINATE_M;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A goal as it is described in messages.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(deny_unknown_fields)]
pub struct Task {
    /// Its id.
    pub id: GoalId,
    /// Its position in the world, in metres.
    pub at_m: [f32; 2],
    /// A robot is there within this distance; of a search or an interrogation, the radius of the area.
    pub radius_m: f32,
    /// Value of serving it, relative to other goals.
    pub value: f32,
    /// Time that a robot spends there.
    pub service_s: f32,
    /// Time from sending until its deadline; without one, `f32::MAX`.
    pub due_s: f32,
    /// What is to be done there.
    pub work: Work,
    /// Number of the capability that a robot needs for it, as in
    /// [`Body::capabilities`](crate::Body::capabilities); 0 if it needs none.
    pub capability: u8,
}

impl Task {
    /// Its position in the world.
    #[must_use]
    pub fn at(&self) -> Point {
        Point::from(self.at_m.map(f64::from))
    }

    /// Whether all of its numbers are finite and plausible.
    #[must_use]
    pub fn is_valid(&self) -> bool {
        let is_plausible = |number: f32| (0.0..=f32::MAX).contains(&number);
        let numbers = [self.value, self.service_s, self.due_s];
        let is_near = |along_m: f32| along_m.abs() <= MAX_COORDINATE_M;
        let is_wide = self.radius_m > 0.0 && self.radius_m <= MAX_COORDINATE_M;
        is_wide && self.at_m.into_iter().all(is_near) && numbers.into_iter().all(is_plausible)
    }
}

/// How robots do a kind of work.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Manner {
    /// Its name in scenarios.
    pub(crate) name: &'static str,
    /// Whether the robot has to know its position so well that it is within the radius.
    pub(crate) is_precise: bool,
    /// Whether the radius is that of an area of which all has to be seen.
    pub(crate) covers_area: bool,
    /// Whether the robot looks at, or acts on, an item that has been marked; the radius is the uncertainty of its place.
    pub(crate) is_at_item: bool,
    /// What it does to the item, if it does anything.
    pub(crate) effect: Option<Effect>,
}

/// What a robot does to an item that has been marked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Effect {
    /// It neutralises the item, and cannot do the work without a charge.
    Neutralise,
    /// It fences the item off, if it can, and cannot neutralise it.
    Isolate,
}

macro_rules! works {
    ($($(#[$meta:meta])* $name:ident in $module:ident;)*) => {
        $(mod $module;)*

        /// What a goal consists of.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Hashed)]
        #[serde(rename_all = "snake_case")]
        pub enum Work {
            $($(#[$meta])* $name,)*
        }

        impl Work {
            pub(crate) fn manner(self) -> Manner {
                match self {
                    $(Self::$name => $module::MANNER,)*
                }
            }
        }
    };
}

works! {
    /// To be there for the time of service.
    Visit in visit;
    /// To search the area around it.
    Search in search;
    /// To look closer at a mark, and to confirm or reject it.
    Interrogate in interrogate;
    /// To neutralise a confirmed mark.
    Neutralise in neutralise;
}

impl Work {
    /// Its name in scenarios.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.manner().name
    }
}
