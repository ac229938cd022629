//! Searching at the frontier of what has been observed.

use super::goal_behaviour::GoalBehaviour;
use super::survey::{Survey, destination, share};
use crate::goals::Verdict;
use crate::goals::proposal::{Destination, Proposal};
use crate::io::body::Body;
use crate::perception::beliefs::Map;
use crate::situation::Situation;
use alloc::boxed::Box;
use base::geometry::Point;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Probability of missing an item above which a cell counts as unobserved.
const UNSEEN: f64 = 0.5;

/// Searches at the nearest place that no robot has observed: along the frontier between what was
/// observed and what was not (Yamauchi, *A frontier-based approach for autonomous exploration*,
/// 1997). When everything has been observed, it has nothing to do.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(inline)]
pub struct Frontier {
    /// Speed, in m/s. Without it, the maximum speed of the body.
    #[schemars(range(min = 0.0, max = 100.0))]
    pub speed_m_s: Option<f64>,
    /// Value of searching, relative to other behaviours.
    #[schemars(range(min = 0.0, max = 1e6))]
    pub value: f64,
}

impl Default for Frontier {
    fn default() -> Self {
        Self {
            speed_m_s: None,
            value: 1.0,
        }
    }
}

/// [`Frontier`] in a body.
#[derive(Debug, Clone)]
pub(crate) struct Ready {
    destination: Destination,
}

impl Ready {
    pub(super) fn new(spec: &Frontier, body: &Body) -> Self {
        Self {
            destination: destination(spec.speed_m_s, spec.value, body),
        }
    }
}

/// The nearest unobserved place; places of other robots count as ten times as far away.
fn nearest(survey: &mut Survey, situation: &Situation, map: &Map) -> Option<Point> {
    let (at, near_m) = (situation.beliefs?.pose()?.at, 4.0 * map.field.cell_m);
    let peers = situation.peers?;
    let nearness = |way_m: f64| 1.0 / way_m.max(map.field.cell_m);
    let value = |cell, way_m, _| {
        if map.coverage.of(cell) > UNSEEN {
            nearness(way_m) * share(peers, at, map.field.centre(cell), near_m)
        } else {
            0.0
        }
    };
    survey.best((map, situation.body), at, value, nearness)
}

fn is_unseen(map: &Map, place: Point) -> bool {
    map.coverage.of(map.field.nearest_cell(place)) > UNSEEN
}

impl GoalBehaviour for Ready {
    type Progress = Survey;

    const SEARCHES: bool = true;

    fn destination(&self) -> &Destination {
        &self.destination
    }

    fn goal(&self, survey: &mut Option<Box<Survey>>, situation: &Situation) -> Option<Proposal> {
        let map = situation.beliefs?.map.as_ref()?;
        let survey = survey.get_or_insert_default();
        let current = survey.current(situation.elapsed_s);
        let current = current.filter(|to| is_unseen(map, to.at));
        let to = if let Some(to) = current {
            to
        } else {
            let at = nearest(survey, situation, map)?;
            survey.select(at, situation)
        };
        Some(self.drive_to(to))
    }

    fn judged(&self, survey: &mut Survey, _verdict: Verdict) {
        survey.abandon();
    }
}
