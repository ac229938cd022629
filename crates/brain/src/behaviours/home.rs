//! Going home before the battery is empty.

use crate::beliefs::Beliefs;
use crate::body::Body;
use crate::command::Motion;
use crate::senses::Senses;
use crate::subsumption::Behaviour;
use crate::wish::{Aim, Wish};
use alloc::boxed::Box;
use base::geometry::Point;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Goes back to base when the battery is low, and stays there: low is what is written here, or less than
/// the way home may take, whichever comes first.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(inline)]
pub struct Home {
    /// The base, in metres; left out, where the robot was first switched on.
    pub at_m: Option<Point>,
    /// Share of the battery at which it goes home in any case.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub below: f64,
    /// It goes home when the battery lasts for no more than so many times the straight way.
    #[schemars(range(min = 1.0, max = 100.0))]
    pub margin: f64,
    /// It is at a place that is no farther, in metres.
    #[schemars(range(min = 0.01, max = 1000.0))]
    pub within_m: f64,
    /// What being home is worth then, beside what other behaviours want.
    #[schemars(range(min = 0.0, max = 1e6))]
    pub value: f64,
}

impl Default for Home {
    fn default() -> Self {
        Self {
            at_m: None,
            below: 0.1,
            margin: 2.0,
            within_m: 1.0,
            value: 1000.0,
        }
    }
}

/// [`Home`] in a body.
#[derive(Debug, Clone)]
pub(crate) struct Ready {
    spec: Home,
    aim: Aim,
}

/// Where home is, once it knows, and whether it is on its way there.
pub(crate) type Memory = Option<Box<(Point, bool)>>;

impl Ready {
    pub(super) fn new(spec: &Home, body: &Body) -> Self {
        Self {
            spec: spec.clone(),
            aim: Aim {
                to: Point::default(),
                within_m: spec.within_m,
                speed_m_s: body.max_speed_m_s,
                value: spec.value,
            },
        }
    }

    fn is_low(&self, way_m: f64, senses: &Senses) -> bool {
        let battery = senses.percept.battery;
        let left = battery.map_or(1.0, |battery| battery.value);
        let way_s = way_m / self.aim.speed_m_s.max(1e-6);
        let lasts_s = senses.beliefs.map_or(f64::INFINITY, Beliefs::battery_s);
        left <= self.spec.below || lasts_s < self.spec.margin * way_s
    }
}

impl Behaviour for Ready {
    type Memory = Memory;

    const NEEDS_BELIEFS: bool = true;

    fn memory(&self) -> Memory {
        None
    }

    fn triggered(&self, memory: &mut Memory, senses: &Senses) -> Option<Wish> {
        let at = senses.beliefs?.pose()?.at;
        let begin = || Box::new((self.spec.at_m.unwrap_or(at), false));
        let (to, is_going) = &mut **memory.get_or_insert_with(begin);
        let way_m = at.to(*to).length();
        *is_going |= self.is_low(way_m, senses);
        is_going.then(|| {
            if way_m <= self.spec.within_m {
                Motion::default().into()
            } else {
                Wish::Aim(Aim {
                    to: *to,
                    ..self.aim
                })
            }
        })
    }

    fn held(&self) -> Motion {
        Motion::default()
    }
}
