//! Searching where the expected rate of detection is highest.

use super::goal_behaviour::GoalBehaviour;
use super::outlook::Outlook;
use super::part::Part;
use super::survey::{Survey, destination};
use crate::goals::Verdict;
use crate::goals::proposal::{Destination, Proposal};
use crate::io::body::Body;
use crate::io::goal_id::GoalPlace;
use crate::messaging::peers::Peers;
use crate::perception::beliefs::pose::Pose;
use crate::perception::beliefs::{Beliefs, Map};
use crate::situation::Situation;
use alloc::boxed::Box;
use base::geometry::Point;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Overhead per place besides driving and measuring, in seconds.
const OVERHEAD_S: f64 = 0.5;

/// Time for turning by a radian, in seconds.
const TURN_S_RAD: f64 = 0.5;

/// It stays at a place until the expected undetected fraction is e^-2, or 14%.
const MEASURED_NATS: f64 = 2.0;

/// A place is complete when its expected detections are below this fraction of the initial value.
const DONE: f64 = 0.5;

/// Candidate places per detector range; a denser grid gives nearly the same values.
const PLACES: f64 = 3.0;

/// Searches where a measurement expected most per second: the number of items that would be
/// detected there, given how likely each cell holds an undetected one, divided by the time for the
/// path, for turning and for measuring. What is in the parts of other robots hardly counts. It
/// never ends: a robot that has seen everything searches again.
///
/// Greedy in the sense of Stone, *Theory of optimal search*, 1975: the rate of detection is
/// maximised. Valuing places by what is visible from them is after Gonzalez-Banos and Latombe,
/// *Navigation strategies for exploring indoor environments*, 2002: what is visible from nowhere,
/// such as the inside of obstacles, attracts no robot.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(inline)]
pub struct BayesianSearch {
    /// Speed, in m/s. Without it, the maximum speed of the body.
    #[schemars(range(min = 0.0, max = 100.0))]
    pub speed_m_s: Option<f64>,
    /// Value of searching, relative to other behaviours.
    #[schemars(range(min = 0.0, max = 1e6))]
    pub value: f64,
}

impl Default for BayesianSearch {
    fn default() -> Self {
        Self {
            speed_m_s: None,
            value: 1.0,
        }
    }
}

/// [`BayesianSearch`] in a body.
#[derive(Debug, Clone)]
pub(crate) struct Ready {
    destination: Destination,
    outlook: Outlook,
}

/// The state of one robot's search.
#[derive(Debug, Clone, Default)]
pub(crate) struct Search {
    survey: Survey,
    part: Part,
    /// The expected detections at the destination when it was selected.
    was: f64,
}

impl Ready {
    pub(super) fn new(spec: &BayesianSearch, body: &Body) -> Self {
        Self {
            destination: destination(spec.speed_m_s, spec.value, body),
            outlook: Outlook::new(&body.detectors),
        }
    }

    /// The place with the most expected detections per second.
    fn best(&self, search: &mut Search, situation: &Situation, known: &Known) -> Option<Point> {
        let Known {
            beliefs,
            peers,
            map,
            pose,
        } = known;
        let (Search { survey, part, .. }, outlook) = (search, &self.outlook);
        part.renew(pose.at, peers, map);
        let overhead_s =
            OVERHEAD_S + outlook.measurements(MEASURED_NATS) * beliefs.observation_period_s();
        let time_s = |way_m: f64| overhead_s + way_m / self.destination.max_speed_m_s.max(1e-6);
        let apart = apart(situation.body, map);
        let value = |cell: usize, way_m: f64, least: f64| {
            let [column, row] = map.field.column_and_row_of(cell);
            let share = part.share(&map.field, cell);
            let place = map.field.centre(cell);
            let fits = map.field.edge_m(place) >= situation.body.radius_m;
            let is_place = fits && (column + row) % apart == 0;
            if !is_place || share * outlook.max <= least * time_s(way_m) {
                return 0.0;
            }
            let rate = share / (time_s(way_m) + turn_s(pose, place));
            let way = pose.at.to(place);
            // Occlusion is computed only if it can affect the result.
            if rate * outlook.at_best(map, place, way) <= least {
                return 0.0;
            }
            rate * outlook.expected(map, place, way, pose.blur_m())
        };
        survey.best((map, situation.body), pose.at, value, |way_m| {
            outlook.max / time_s(way_m)
        })
    }
}

/// Time to turn towards a place.
fn turn_s(pose: &Pose, place: Point) -> f64 {
    let way = pose.in_own_frame(place);
    TURN_S_RAD * libm::atan2(way.y, way.x).abs()
}

/// Spacing of candidate places, in cells.
#[expect(clippy::cast_possible_truncation, reason = "a cast saturates")]
fn apart(body: &Body, map: &Map) -> i32 {
    let ranges = body.detectors.iter().map(|detector| detector.range_m);
    let range_m = ranges.fold(0.0, f64::max);
    ((range_m / (PLACES * map.field.cell_m)) as i32).max(1)
}

/// The inputs of a selection.
struct Known<'k> {
    beliefs: &'k Beliefs,
    peers: &'k Peers,
    map: &'k Map,
    pose: Pose,
}

impl<'k> Known<'k> {
    fn new(situation: &Situation<'k>) -> Option<Self> {
        let beliefs = situation.beliefs?;
        Some(Self {
            beliefs,
            peers: situation.peers?,
            map: beliefs.map.as_ref()?,
            pose: beliefs.pose()?,
        })
    }

    /// The expected detections of a measurement at the end of the straight path to a place.
    fn expected(&self, outlook: &Outlook, to: Point) -> f64 {
        let Self { map, pose, .. } = self;
        outlook.expected(map, to, pose.at.to(to), pose.blur_m())
    }
}

impl GoalBehaviour for Ready {
    type Progress = Search;

    const SEARCHES: bool = true;

    fn destination(&self) -> &Destination {
        &self.destination
    }

    fn goal(&self, search: &mut Option<Box<Search>>, situation: &Situation) -> Option<Proposal> {
        let known = Known::new(situation)?;
        let search = search.get_or_insert_default();
        let destination = search.survey.current(situation.elapsed_s);
        let is_there =
            |to: GoalPlace| known.pose.at.to(to.at).length() <= self.destination.tolerance_m;
        if destination.is_some_and(is_there) {
            // The expected detections that were not made on the path cannot be made from there.
            search.survey.abandon();
        }
        let min_expected = DONE * search.was;
        let is_on = |to: &GoalPlace| known.expected(&self.outlook, to.at) > min_expected;
        let to = if let Some(to) = destination.filter(|to| !is_there(*to) && is_on(to)) {
            to
        } else {
            let at = self.best(search, situation, &known)?;
            search.was = known.expected(&self.outlook, at);
            search.survey.select(at, situation)
        };
        Some(self.drive_to(to))
    }

    fn judged(&self, search: &mut Search, _verdict: Verdict) {
        search.survey.abandon();
    }
}
