//! What each robot is about to do, as if no other robot were in its way.

use super::view::View;
use crate::bodies::body_state::{BodyState, Status};
use crate::bodies::contact::meets_still;
use crate::bodies::kind::Kind;
use crate::bodies::path::{Orientation, Path};
use crate::run::agent::Agent;
use crate::scenario::Scenario;
use crate::world::terrain::TerrainFactors;
use base::geometry::Disc;
use brain::Motion;

/// What one robot is about to do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Plan {
    pub(crate) path: Path,
    /// Speed and turn rate at the end of the step.
    pub(crate) motion: Motion,
    /// Factor on the energy of motion.
    pub(crate) effort: f64,
    /// Power of the radio and of the sensors that are on.
    pub(crate) sensing_w: f64,
    /// What stops it, or runs into it.
    pub(crate) stop: Stop,
}

/// Why a robot does not complete its path; of two reasons, the greater one counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Stop {
    Nothing,
    /// It continues, but another robot presses against it.
    Pressed,
    Robot,
    Still,
}

/// A body that is about to move, and the motion setpoint of its brain.
pub(crate) struct Body<'a> {
    pub(crate) kind: &'a Kind,
    pub(crate) state: &'a BodyState,
    pub(crate) disc: &'a Disc,
    pub(crate) course: &'a Orientation,
    pub(crate) agent: &'a Agent,
    /// Whether static geometry may be in its way.
    pub(crate) may_touch: bool,
}

/// The plan of a robot if no other robot is in its way.
#[inline(always)]
#[expect(
    clippy::inline_always,
    reason = "where nothing can be touched, little of it is left"
)]
pub(crate) fn planned(scenario: &Scenario, tick: u64, body: &Body) -> Plan {
    let Body {
        kind,
        state,
        disc,
        course,
        agent,
        ..
    } = *body;
    let sensing_w = kind.sensing_w(agent.sensors_off);
    if !state.can_move(tick) {
        return Plan {
            path: Path::rest(disc.centre),
            sensing_w,
            ..Plan::REST
        };
    }
    let terrain_factors = scenario.terrain_factors(disc.centre, kind.layer);
    let (drive, terrain, step_s) = (&kind.drive, terrain_factors.speed, scenario.step_s);
    let driven = match &drive.errors {
        None => drive.step(state.speed_m_s, agent.setpoint, terrain, step_s),
        Some(errors) => {
            let setpoints = agent.setpoints_in_force();
            drive.step_with_errors(errors, state.motion(), setpoints, (terrain, step_s))
        }
    };
    let (front, turn_rad) = if drive.turns_at_once {
        (course.turned(driven.turn_rad).front, 0.0)
    } else {
        (course.front, driven.turn_rad)
    };
    let mut path = Path {
        start: disc.centre,
        front,
        length_m: driven.length_m,
        turn_rad,
        until: 1.0,
    };
    let may_touch = path.length_m != 0.0 && body.may_touch;
    let meeting = may_touch.then(|| {
        let geometry = scenario.touched(kind.layer);
        let (walls, discs) = (
            geometry.walls_near(path.start),
            geometry.discs_near(path.start),
        );
        meets_still(&path, disc.radius_m, &walls, &discs)
    });
    let meeting = meeting.flatten();
    path.until = meeting.unwrap_or(1.0);
    Plan {
        path,
        motion: driven.motion(),
        effort: terrain_factors.energy,
        sensing_w,
        stop: meeting.map_or(Stop::Nothing, |_| Stop::Still),
    }
}

impl Plan {
    pub(crate) const REST: Self = Self {
        path: Path::rest(base::geometry::Point { x: 0.0, y: 0.0 }),
        motion: Motion {
            speed_m_s: 0.0,
            turn_rate_rad_s: 0.0,
        },
        effort: TerrainFactors::NO_EFFECT.energy,
        sensing_w: 0.0,
        stop: Stop::Nothing,
    };

    /// Moves a body along its path.
    #[inline]
    pub(crate) fn carry_out(
        &self,
        scenario: &Scenario,
        kind: &Kind,
        disc: &mut Disc,
        course: &mut Orientation,
    ) {
        if self.path.length_m != 0.0 {
            disc.centre = scenario.home(self.path.at(1.0));
        }
        let turn_rad = self.motion.turn_rate_rad_s * scenario.step_s;
        *course = if kind.drive.turns_at_once && turn_rad != 0.0 {
            course.turned_to(turn_rad, self.path.front)
        } else {
            course.turned(self.path.turn_rad)
        };
    }
}

impl BodyState {
    /// Whether its body moves in this step.
    #[inline]
    fn can_move(&self, tick: u64) -> bool {
        self.status == Status::Active && !self.is_external() && tick >= self.held_until
    }
}

impl<'a> View<'a> {
    /// Its body, as it is about to move.
    #[inline]
    pub(crate) fn body(&self, robot: usize, agent: &'a Agent) -> Body<'a> {
        Body {
            kind: self.kind(robot),
            state: &self.body_states[robot],
            disc: &self.discs[robot],
            course: &self.orientations[robot],
            agent,
            may_touch: self.neighbours.may_touch(robot),
        }
    }
}
