//! Turning towards a waypoint.

use super::turn::Turn;
use crate::behaviours::behaviour::Behaviour;
use crate::goals::fitness::Step;
use crate::goals::orders::{AssignedGoal, Orders, order_of};
use crate::goals::proposal::{Destination, Proposal, max_deviation_m};
use crate::io::body::Body;
use crate::io::command::Motion;
use crate::io::goal_id::GoalId;
use crate::io::percept::Reading;
use crate::perception::beliefs::Localisation;
use crate::situation::Situation;
use crate::situation::timer::{Countdown, Stopwatch};
use alloc::boxed::Box;
use alloc::vec::Vec;
use base::geometry::Point;
use base::trig::wrapped;
use core::f64::consts::PI;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// It turns only if the heading is off by at least this many standard deviations.
const MIN_DEVIATIONS: f64 = 2.0;

/// Maximum age of a position, in seconds.
const OLDEST_S: f64 = 5.0;

/// Larger coordinates in metres and angles in radians are invalid.
const FARTHEST_M: f64 = 1e7;
const MAX_RAD: f64 = 1e4;

/// Turns on the spot towards a waypoint when the heading is off, one waypoint after the other; then
/// it visits the goals that a person assigns to it, in the order of assignment. Between *cruise*, which moves there, and *avoid* it is the middle
/// layer of Bender (Williams 2003). It needs a position and a heading, but no beliefs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(inline)]
pub struct Correct {
    /// The waypoints, in metres.
    #[schemars(length(max = 10_000))]
    pub waypoints_m: Vec<Point>,
    /// A waypoint within this distance is reached, in metres, if the standard deviation of the position
    /// is at most half of it. Where that of the position sensor is not, and where the robot does not
    /// measure its own motion, the position is estimated from all readings.
    #[schemars(range(min = 0.01, max = 1000.0))]
    pub within_m: f64,
    /// It turns when the heading is off by more than this, in degrees.
    #[schemars(range(min = 0.1, max = 180.0))]
    pub course_error_deg: f64,
    /// Time to wait after a higher behaviour was active, in seconds. Without it a robot can be
    /// trapped in front of a large obstacle: it turns away, and at once back. With it, it gets
    /// around what it can pass in this time.
    #[schemars(range(min = 0.0, max = 3600.0))]
    pub wait_s: f64,
    /// Whether the robot is stationary while no waypoint and no assigned goal is left. Otherwise lower
    /// behaviours are active then.
    pub stop_when_done: bool,
}

impl Default for Correct {
    fn default() -> Self {
        Self {
            waypoints_m: Vec::new(),
            within_m: 0.5,
            course_error_deg: 6.3,
            wait_s: 5.0,
            stop_when_done: false,
        }
    }
}

/// [`Correct`] in a body.
#[derive(Debug, Clone)]
pub(crate) struct Ready {
    spec: Correct,
    tolerance_rad: f64,
    /// A destination without goal and place.
    destination: Destination,
}

/// Progress; `None` before the first step.
pub(crate) type Memory = Option<Box<Progress>>;

/// Progress of a robot on its waypoints.
#[derive(Debug, Clone, Default)]
pub(crate) struct Progress {
    /// Number of waypoints visited.
    visited: usize,
    wait: Countdown,
    /// Time since its last turn; older compass readings are not its heading.
    straight: Stopwatch,
    turn: Option<TurnTo>,
    /// From the first order of a person on: the waypoints, and the goals that the person assigned.
    orders: Option<Box<Orders>>,
}

/// A turn to a heading.
#[derive(Debug, Clone)]
struct TurnTo {
    turn: Turn,
    /// From -pi (excluded) to pi.
    heading_rad: f64,
}

impl Ready {
    pub(super) fn new(spec: &Correct, body: &Body) -> Self {
        Self {
            spec: spec.clone(),
            tolerance_rad: spec.course_error_deg.to_radians(),
            destination: Destination {
                id: GoalId::default(),
                at: Point::default(),
                tolerance_m: spec.within_m,
                max_deviation_m: max_deviation_m(spec.within_m),
                is_at_hazard: false,
                max_speed_m_s: body.max_speed_m_s,
                value: 1.0,
            },
        }
    }

    /// The next waypoint or assigned goal.
    fn next(&self, progress: &mut Progress, known: &Known) -> Option<Point> {
        if let Some(orders) = &progress.orders {
            return orders.next().map(|goal| goal.at);
        }
        while let Some(place) = self.spec.waypoints_m.get(progress.visited) {
            let there = self.destination.moved_to(*place);
            if !there.is_reached(known.at, known.deviation_m) {
                return Some(*place);
            }
            progress.visited += 1;
        }
        None
    }

    /// Whether no waypoint and no assigned goal is left.
    fn is_done(&self, progress: &Progress) -> bool {
        match &progress.orders {
            Some(orders) => orders.next().is_none(),
            None => progress.visited >= self.spec.waypoints_m.len(),
        }
    }

    /// The motion while nothing is left.
    fn rest(&self) -> Option<Motion> {
        self.spec.stop_when_done.then(Motion::default)
    }

    fn judge(&self, orders: &mut Orders, situation: &Situation) {
        let Some(known) = position(situation) else {
            return;
        };
        let step = Step {
            at: known.at,
            deviation_m: known.deviation_m,
            elapsed_s: situation.elapsed_s,
            period_s: situation.body.period_s,
            unreachable: None,
            battery_s: f64::INFINITY,
            pursued: None,
            noise_m: known.noise_m,
        };
        orders.judge(&self.destination, &step);
    }

    fn look(&self, progress: &mut Progress, situation: &Situation) -> Option<Motion> {
        let straight_s = progress.straight.read_s(situation);
        progress.wait.advance(situation);
        if self.is_done(progress) {
            return self.rest();
        }
        if progress.wait.is_running(situation) {
            return None;
        }
        let known = position(situation)?;
        let Some(to) = self.next(progress, &known) else {
            return self.rest();
        };
        let there = self.destination.moved_to(to);
        if there.is_uncertain(known.at, known.deviation_m) {
            // It waits for more readings.
            return Some(Motion::default());
        }
        let way = known.at.to(to);
        let heading = heading(situation, straight_s)?;
        let course_rad = libm::atan2(way.y, way.x);
        let off_rad = wrapped(course_rad - heading.rad);
        let deviation_rad = libm::hypot(heading.deviation_rad, known.deviation_m / way.length());
        (off_rad.abs() > self.tolerance_rad.max(MIN_DEVIATIONS * deviation_rad)).then(|| {
            let (turn, motion) = Turn::by(off_rad, situation.body);
            progress.turn = Some(TurnTo {
                turn,
                // The arc tangent of -0 is -pi.
                heading_rad: if course_rad > -PI { course_rad } else { PI },
            });
            motion
        })
    }
}

/// What is known of the position.
struct Known {
    at: Point,
    /// Standard deviation along each axis; 0 for one reading, which is exact enough.
    deviation_m: f64,
    /// Standard deviation of its differences from one step to the next at rest.
    noise_m: f64,
}

/// The estimated position if the robot has an estimate, otherwise the last reading.
fn position(situation: &Situation) -> Option<Known> {
    if let Some(own) = situation.localisation {
        let pose = own.pose().filter(|pose| pose.age_s <= OLDEST_S)?;
        return Some(Known {
            at: pose.at,
            deviation_m: pose.deviation_m,
            noise_m: 0.0,
        });
    }
    let is_sensible = |Reading { value, age_s }: &Reading<Point>| {
        let is_near = value.x.abs() <= FARTHEST_M && value.y.abs() <= FARTHEST_M;
        is_near && (0.0..=OLDEST_S).contains(age_s)
    };
    let reading = situation.percept.position.filter(is_sensible)?;
    Some(Known {
        at: reading.value,
        deviation_m: 0.0,
        noise_m: situation.body.position_noise_m,
    })
}

/// What is known of the heading.
struct KnownHeading {
    rad: f64,
    /// Standard deviation; 0 for one reading.
    deviation_rad: f64,
}

/// The estimated heading if the robot has an estimate, otherwise the last reading, if the robot has driven
/// straight since then.
fn heading(situation: &Situation, straight_s: f64) -> Option<KnownHeading> {
    if let Some(own) = situation.localisation {
        return own.pose().map(|pose| KnownHeading {
            rad: pose.heading_rad,
            deviation_rad: pose.deviation_rad,
        });
    }
    let is_sensible = |Reading { value, age_s }: &Reading<f64>| {
        (0.0..=straight_s).contains(age_s) && value.abs() <= MAX_RAD
    };
    let reading = situation.percept.heading_rad.filter(is_sensible)?;
    Some(KnownHeading {
        rad: reading.value,
        deviation_rad: 0.0,
    })
}

impl Behaviour for Ready {
    type Memory = Memory;

    const NEEDS_POSE: bool = true;
    const TAKES_ORDERS: bool = true;

    fn memory(&self) -> Memory {
        None
    }

    fn serve_orders(&self, memory: &mut Memory, situation: &Situation) {
        let mut new = situation
            .percept
            .inbox
            .iter()
            .filter_map(order_of)
            .peekable();
        let has_orders = memory.as_ref().is_some_and(|known| known.orders.is_some());
        // A robot that may never know that it is at a waypoint gives it up as it does an order.
        let may_fail = situation.localisation.is_some() && !self.spec.waypoints_m.is_empty();
        if new.peek().is_none() && !has_orders && !may_fail {
            return;
        }
        let progress = memory.get_or_insert_default();
        let visited = progress.visited;
        let orders = progress
            .orders
            .get_or_insert_with(|| Box::new(Orders::of_waypoints(&self.spec.waypoints_m, visited)));
        for (goal, action) in new {
            orders.obey(goal, action);
        }
        self.judge(orders, situation);
    }

    fn assigned_goals(&self, memory: &Memory) -> Vec<AssignedGoal> {
        let orders = memory.as_ref().and_then(|known| known.orders.as_deref());
        orders.map(Orders::assigned).unwrap_or_default()
    }

    fn triggered(&self, memory: &mut Memory, situation: &Situation) -> Option<Proposal> {
        let progress = &mut **memory.get_or_insert_default();
        let is_done = self.is_done(progress);
        if let Some(TurnTo { turn, heading_rad }) = &mut progress.turn {
            if let Some(pose) = situation.localisation.and_then(Localisation::pose) {
                turn.aim(wrapped(*heading_rad - pose.heading_rad), situation);
            }
            // It may have been withdrawn.
            let motion = turn.next_motion(situation).filter(|_| !is_done);
            if motion.is_some() {
                return motion.map(Proposal::Motion);
            }
            (progress.turn, progress.straight) = (None, Stopwatch::START);
        }
        let motion = self.look(progress, situation);
        motion.map(Proposal::Motion)
    }

    fn held(&self) -> Motion {
        Motion::default()
    }

    fn heading_rad(&self, memory: &Memory) -> Option<f64> {
        let turn = memory.as_deref()?.turn.as_ref()?;
        Some(turn.heading_rad)
    }

    fn suppressed(&self, memory: &mut Memory) {
        let progress = memory.get_or_insert_default();
        progress.wait = Countdown::new(self.spec.wait_s);
        (progress.turn, progress.straight) = (None, Stopwatch::START);
    }
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "exact by construction")]
mod tests {
    use super::*;
    use crate::behaviours::{BehaviourSpec, Cruise};
    use crate::io::percept::Percept;
    use crate::world_of_walls::{now, rover};
    use crate::{Brain, BrainSpec};
    use std::sync::Arc;

    /// Cruise, and above it correct.
    fn brain(correct: Correct) -> Brain {
        let behaviours = vec![
            BehaviourSpec::Cruise(Cruise::default()),
            BehaviourSpec::Correct(correct),
        ];
        let spec = BrainSpec {
            behaviours,
            limit_speed_to_stopping_distance: false,
            ..BrainSpec::default()
        };
        Brain::new(Arc::new(spec), Arc::new(rover()))
    }

    fn to(x: f64, y: f64) -> Correct {
        Correct {
            waypoints_m: vec![Point { x, y }],
            ..Correct::default()
        }
    }

    /// A percept at the origin with this heading.
    fn percept(heading_deg: f64) -> Percept {
        Percept {
            position: Some(now(Point::default())),
            heading_rad: Some(now(heading_deg.to_radians())),
            ..Percept::default()
        }
    }

    fn turn_rate(correct: Correct, percept: &Percept) -> f64 {
        brain(correct).step(percept).motion.turn_rate_rad_s
    }

    #[test]
    fn it_turns_the_shorter_way_once_the_error_passes_the_threshold() {
        for (heading_deg, sign) in [(-6.2, 0.0), (6.2, 0.0), (-6.4, 1.0), (6.4, -1.0)] {
            let rate = turn_rate(to(9.0, 0.0), &percept(heading_deg));
            assert_eq!(rate * sign > 0.0, sign != 0.0, "{heading_deg}");
            assert_eq!(rate != 0.0, sign != 0.0, "{heading_deg}");
        }
        // Across the wrap of angles, where Bender's program had an error.
        let back = to(-9.0, 0.0);
        assert_eq!(turn_rate(back.clone(), &percept(-177.0)), 0.0);
        assert!(turn_rate(back.clone(), &percept(-170.0)) < 0.0);
        assert!(turn_rate(back, &percept(170.0)) > 0.0);
    }

    #[test]
    fn it_reaches_its_heading_in_all_quadrants() {
        for course_deg in [30.0_f64, 120.0, 225.0, 300.0] {
            let (y, x) = base::trig::sin_cos(course_deg.to_radians());
            let mut brain = brain(to(9.0 * x, 9.0 * y));
            let mut heading_rad: f64 = 0.0;
            for _ in 0..40 {
                let motion = brain.step(&percept(heading_rad.to_degrees())).motion;
                heading_rad = wrapped(heading_rad + 0.1 * motion.turn_rate_rad_s);
            }
            let off_rad = wrapped(heading_rad - course_deg.to_radians());
            assert!(off_rad.abs() < 0.03, "{course_deg} {off_rad}");
        }
    }

    #[test]
    fn without_a_position_or_heading_it_is_not_triggered() {
        let mut lost = percept(90.0);
        lost.position = None;
        let mut dizzy = percept(90.0);
        dizzy.heading_rad = None;
        let mut nowhere = percept(90.0);
        nowhere.position = Some(now(Point {
            x: f64::NAN,
            y: 0.0,
        }));
        for percept in [lost, dizzy, nowhere, Percept::default()] {
            let motion = brain(to(9.0, 0.0)).step(&percept).motion;
            assert_eq!((motion.speed_m_s, motion.turn_rate_rad_s), (1.0, 0.0));
        }
    }

    #[test]
    fn at_a_waypoint_it_continues_to_the_next() {
        let mut two = to(0.3, 0.0);
        two.waypoints_m.push(Point { x: 0.0, y: 9.0 });
        assert!(turn_rate(two, &percept(0.0)) > 0.0);
    }

    #[test]
    fn one_reading_of_a_slow_compass_causes_one_turn() {
        let mut brain = brain(to(0.0, 9.0));
        let mut percept = percept(0.0);
        let (mut turned_rad, mut motion) = (0.0, Motion::default());
        for step in 0..30_u32 {
            percept.heading_rad = Some(Reading {
                value: 0.0,
                age_s: 0.1 * f64::from(step),
            });
            percept.motion = Some(now(motion));
            motion = brain.step(&percept).motion;
            turned_rad += 0.1 * motion.turn_rate_rad_s;
        }
        assert!((turned_rad - 1.57).abs() < 0.2, "{turned_rad}");
    }
}
