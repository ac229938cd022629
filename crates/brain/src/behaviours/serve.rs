//! Serving the goals of controllers.

use super::behaviour::Behaviour;
use super::lawnmower::{ahead_m, all_round_m, swath_m};
use crate::goals::Verdict;
use crate::goals::proposal::{Destination, Proposal};
use crate::io::act::ActKind;
use crate::io::agent_id::AgentId;
use crate::io::body::Body;
use crate::io::command::{Command, Motion};
use crate::navigation::hazards::kept_m;
use crate::perception::beliefs::Beliefs;
use crate::perception::beliefs::pose::Pose;
use crate::service::ability::{Ability, Moment};
use crate::service::assignee::Assignee;
use crate::service::jobs::Job;
use crate::service::lanes::Lanes;
use crate::situation::Situation;
use alloc::borrow::Cow;
use alloc::boxed::Box;
use base::geometry::{Point, Rectangle};
use base::trig::wrapped;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Time in which a robot turns towards a mark, in seconds.
const TURN_S: f64 = 0.5;

/// Bids for the goals of controllers, and serves those that it is awarded on the shortest path
/// through them. It needs a position, a heading and a radio. Without an awarded goal, it does nothing.
/// A stationary robot serves the goals at which it stands.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(inline)]
pub struct Serve {
    /// Speed, in m/s. Without it, the maximum speed of the body.
    #[schemars(range(min = 0.0, max = 100.0))]
    pub speed_m_s: Option<f64>,
    /// Factor of the values of goals, relative to other behaviours.
    #[schemars(range(min = 0.0, max = 1e6))]
    pub value: f64,
    /// Maximum number of goals that the robot is awarded at once. Its paths through up to 8 are the
    /// shortest.
    #[schemars(range(min = 1, max = 64))]
    pub max_goals: u32,
}

impl Default for Serve {
    fn default() -> Self {
        Self {
            speed_m_s: None,
            value: 1.0,
            max_goals: 4,
        }
    }
}

/// [`Serve`] in a body.
#[derive(Debug, Clone)]
pub(crate) struct Ready {
    ability: Ability,
    value: f64,
}

impl Ready {
    pub(super) fn new(spec: &Serve, body: &Body) -> Self {
        let speed_m_s = spec.speed_m_s.unwrap_or(body.max_speed_m_s);
        Self {
            ability: Ability {
                speed_m_s: speed_m_s.min(body.max_speed_m_s),
                max_goals: spec.max_goals as usize,
                lanes: Lanes {
                    apart_m: swath_m(body).0,
                    within: body.field.map(|field| inset(field, body.radius_m)),
                    is_balanced: false,
                },
                all_round_m: all_round_m(body),
                ahead_m: ahead_m(body),
                position_noise_m: body.position_noise_m,
                keep_m: kept_m(body),
                charge: body.tool(ActKind::Neutralise).copied(),
                fence: body.tool(ActKind::Isolate).copied(),
                capabilities: body.capabilities.as_slice().into(),
            },
            value: spec.value,
        }
    }

    /// What the robot can do, in the lane that a controller has named, if one has.
    fn ability(&self, assignee: &Assignee) -> Cow<'_, Ability> {
        let Some(lane) = assignee.lane_area() else {
            return Cow::Borrowed(&self.ability);
        };
        Cow::Owned(Ability {
            lanes: self.ability.lanes.in_lane(lane),
            ..self.ability.clone()
        })
    }

    /// The motion at a goal: robots face the marks at which they look or act.
    fn standing(&self, job: &Job, pose: &Pose, situation: &Situation) -> Motion {
        let looks = job.task.work.manner().is_at_item;
        if !looks || self.ability.is_stationary() {
            return Motion::default();
        }
        let item = job.fence_at().or_else(|| job.charge_at());
        let mark = item.unwrap_or(job.task.at());
        let towards = pose.at.to(mark);
        let off_rad = wrapped(libm::atan2(towards.y, towards.x) - pose.heading_rad);
        let max_rad_s = situation.body.max_turn_rate_rad_s;
        Motion {
            speed_m_s: 0.0,
            turn_rate_rad_s: situation
                .turn_rate_rad_s(off_rad, TURN_S)
                .clamp(-max_rad_s, max_rad_s),
        }
    }
}

/// Where the centre of a robot can be in a field.
fn inset(field: Rectangle, radius_m: f64) -> Rectangle {
    let size = field.size();
    let [x, y] = [size.x, size.y].map(|size_m| radius_m.min(size_m / 2.0));
    Rectangle::spanned(
        field.min().plus(Point { x, y }),
        field.max().plus(Point { x: -x, y: -y }),
    )
}

impl Behaviour for Ready {
    type Memory = Box<Assignee>;

    const NEEDS_BELIEFS: bool = true;
    const SERVES_CONTROLLERS: bool = true;

    fn memory(&self) -> Box<Assignee> {
        Box::default()
    }

    fn communicate(&self, assignee: &mut Box<Assignee>, situation: &Situation) {
        let Some(beliefs) = situation.beliefs else {
            return;
        };
        let pose = beliefs.pose();
        let moment = Moment {
            percept: situation.percept,
            body: situation.body,
            beliefs: Some(beliefs),
            map: beliefs.map.as_ref(),
            at: pose.map(|pose| pose.at),
            deviation_m: pose.map_or(f64::INFINITY, |pose| pose.deviation_m),
            elapsed_s: situation.elapsed_s,
            battery_s: beliefs.battery_s(),
            charge: beliefs.battery_charge(),
        };
        let ability = self.ability(assignee);
        assignee.step(&ability, &moment);
        assignee.report_lane(&ability, &moment, beliefs);
    }

    fn publish(&self, assignee: &mut Box<Assignee>, command: &mut Command) {
        assignee.publish(command);
    }

    fn assignee<'m>(&self, assignee: &'m Box<Assignee>) -> Option<&'m Assignee> {
        Some(assignee)
    }

    fn renumber(&self, assignee: &mut Box<Assignee>, new_id: &dyn Fn(AgentId) -> Option<AgentId>) {
        assignee.renumber(&new_id);
    }

    fn triggered(&self, assignee: &mut Box<Assignee>, situation: &Situation) -> Option<Proposal> {
        let pose = situation.beliefs.and_then(Beliefs::pose)?;
        let ability = self.ability(assignee);
        let (job, is_there) = assignee.current(&ability, &pose)?;
        if is_there {
            return Some(self.standing(&job, &pose, situation).into());
        }
        let (at, near_m) = job.target(&ability);
        Some(Proposal::Destination(Destination {
            id: job.task.id,
            at,
            tolerance_m: ability.approach_m(&job.task, job.within_m(near_m, pose.deviation_m)),
            max_deviation_m: job.max_deviation_m(),
            is_at_hazard: ability.is_at_hazard(&job.task),
            max_speed_m_s: ability.speed_at_m_s(&job.task, [pose.at.to(at).length(), near_m]),
            value: self.value * f64::from(job.task.value),
        }))
    }

    fn judged(&self, assignee: &mut Box<Assignee>, verdict: Verdict) {
        let ability = self.ability(assignee);
        assignee.judged(&ability, verdict);
    }

    fn held(&self) -> Motion {
        Motion::default()
    }
}
