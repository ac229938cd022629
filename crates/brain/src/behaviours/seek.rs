//! Searching where beliefs say most is to be found.

use super::part::Part;
use super::survey::{Survey, aim};
use crate::beliefs::{Beliefs, Map};
use crate::body::Body;
use crate::command::Motion;
use crate::goals::Verdict;
use crate::senses::Senses;
use crate::subsumption::Behaviour;
use crate::wish::{Aim, Wish};
use alloc::boxed::Box;
use base::geometry::Point;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What is left about a place is summed over so many cells to each side.
const ABOUT: i32 = 1;

/// Time that is lost at a place besides the way there, in seconds.
const STOP_S: f64 = 1.0;

/// A radian of turning costs so much time, in seconds.
const TURN_S_RAD: f64 = 0.5;

/// Where less than this share of an item in each cell is left, nothing is.
const LEAST: f64 = 0.02;

/// A place with less than this share of what it had is done.
const DONE: f64 = 0.5;

/// Searches by going where the probability of an item that nobody has seen is highest per second of the
/// way: what it passes on the way counts, what others go for hardly does. When next to nothing is left,
/// it has nothing to do.
///
/// Greedy in the sense of Stone, *Theory of optimal search*, 1975: the rate of detection is maximised.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(inline)]
pub struct Seek {
    /// Its speed, in m/s; left out, the most that the body can.
    #[schemars(range(min = 0.0, max = 100.0))]
    pub speed_m_s: Option<f64>,
    /// What searching is worth, beside what other behaviours want.
    #[schemars(range(min = 0.0, max = 1e6))]
    pub value: f64,
}

impl Default for Seek {
    fn default() -> Self {
        Self {
            speed_m_s: None,
            value: 1.0,
        }
    }
}

/// [`Seek`] in a body.
#[derive(Debug, Clone)]
pub(crate) struct Ready {
    aim: Aim,
}

/// What a robot remembers for it.
#[derive(Debug, Clone, Default)]
pub(crate) struct Search {
    survey: Survey,
    part: Part,
    /// What was left where it goes.
    was: f64,
}

impl Ready {
    pub(super) fn new(spec: &Seek, body: &Body) -> Self {
        Self {
            aim: aim(spec.speed_m_s, spec.value, body),
        }
    }

    /// The place with most to be found a second of the way.
    fn best(
        &self,
        search: &mut Search,
        senses: &Senses,
        beliefs: &Beliefs,
        map: &Map,
    ) -> Option<Point> {
        let pose = beliefs.pose()?;
        let Search { survey, part, .. } = search;
        part.renew(beliefs, map);
        let (field, full) = (&map.field, f64::from((2 * ABOUT + 1) * (2 * ABOUT + 1)));
        let time_s = |way_m: f64| STOP_S + way_m / self.aim.speed_m_s.max(1e-6);
        let worth = |cell, way_m| {
            if map.unseen.of(cell) < LEAST {
                return 0.0;
            }
            let way = pose.own(field.centre(cell));
            let turn_s = TURN_S_RAD * libm::atan2(way.y, way.x).abs();
            about(map, cell) * part.share(field, cell) / (time_s(way_m) + turn_s)
        };
        survey.best((map, senses.body), pose.at, worth, |way_m| {
            full / time_s(way_m)
        })
    }
}

/// What is left in the cells about one.
fn about(map: &Map, cell: usize) -> f64 {
    let cells = map.field.around(cell, ABOUT);
    cells.map(|cell| map.unseen.of(cell)).sum()
}

impl Behaviour for Ready {
    type Memory = Option<Box<Search>>;

    const NEEDS_BELIEFS: bool = true;
    const NEEDS_DETECTOR: bool = true;

    fn memory(&self) -> Self::Memory {
        None
    }

    fn triggered(&self, memory: &mut Self::Memory, senses: &Senses) -> Option<Wish> {
        let beliefs = senses.beliefs?;
        let map = beliefs.map.as_ref()?;
        let search = memory.get_or_insert_default();
        let left = |to: &Point| map.unseen.of(map.field.nearest_cell(*to));
        let going = search.survey.still_going(senses.body.period_s);
        let to = if let Some(to) = going.filter(|to| left(to) > DONE * search.was) {
            to
        } else {
            let to = self.best(search, senses, beliefs, map)?;
            search.was = left(&to);
            search.survey.going = Some((to, 0.0));
            to
        };
        Some(Wish::Aim(Aim { to, ..self.aim }))
    }

    fn judged(&self, memory: &mut Self::Memory, _verdict: Verdict) {
        if let Some(search) = memory {
            search.survey.give_up();
        }
    }

    fn held(&self) -> Motion {
        Motion::default()
    }
}
