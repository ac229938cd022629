//! Act: every body does what it can of what its brain wants, and stops at what it runs into.
//!
//! First each plans its path as if it were alone. Then the paths are cut where they meet what stands
//! still, and where they meet each other, the earliest meeting first: who stops may no longer be in
//! the way of others, or now be in it. Last, all go. A meeting stops both bodies, but none that leaves
//! what it touched before; nobody slides or bounces.

use super::meetings::Meetings;
use super::mind::Mind;
use super::neighbours::Neighbours;
use super::share_out::ROBOTS_PER_TASK;
use super::state::{Hull, State, Status};
use crate::body::contact::meets_still;
use crate::body::drive::Driven;
use crate::body::kind::Kind;
use crate::body::path::{Course, Path};
use crate::scenario::Scenario;
use crate::world::terrain::Going;
use base::geometry::Disc;
use brain::RobotId;
use rayon::prelude::*;

/// What all robots are about to do, kept between steps so that nothing is allocated.
#[derive(Debug, Clone, Default)]
pub(crate) struct Moves {
    plans: Vec<Plan>,
    meetings: Meetings,
}

/// What one robot is about to do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Plan {
    pub(crate) path: Path,
    driven: Driven,
    /// Factor on the energy of moving.
    effort: f64,
    /// Power of the radio and of the sensors that are on.
    sensing_w: f64,
    /// What stops it, or runs into it.
    pub(crate) stop: Stop,
}

/// Why a robot does not go its way to the end; of two reasons, the greater counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Stop {
    Nothing,
    /// It does go on, but another presses against it.
    Pressed,
    Robot,
    Still,
}

/// What comes of all robots' moves.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Moved {
    /// The farthest that one has gone.
    pub(crate) farthest_m: f64,
    pub(crate) collisions: u64,
}

impl Moves {
    /// Room for the plans of so many robots.
    pub(crate) fn plans(&mut self, robots: usize) -> &mut [Plan] {
        self.plans.resize(robots, Plan::REST);
        &mut self.plans
    }

    /// Moves all robots as far as their plans say.
    pub(crate) fn act(
        &mut self,
        scenario: &Scenario,
        state: &mut State,
        neighbours: &Neighbours,
        is_shared: bool,
    ) -> Moved {
        self.meetings
            .collect(&self.plans, &state.discs, neighbours, scenario.contact_m);
        let met = self.meetings.resolve(&mut self.plans, state, neighbours);
        let moved = go(&self.plans, scenario, state, is_shared);
        Moved {
            // Each stops somebody who moves, but for those that begin at the very same time.
            collisions: (moved.collisions + met).min(state.robots() as u64),
            ..moved
        }
    }
}

/// A body that is about to move, and what its brain wants of it.
pub(crate) struct Body<'a> {
    pub(crate) kind: &'a Kind,
    pub(crate) hull: &'a Hull,
    pub(crate) disc: &'a Disc,
    pub(crate) course: &'a Course,
    pub(crate) mind: &'a Mind,
    /// Whether anything that stands still may be in its way.
    pub(crate) may_touch: bool,
}

/// What a robot does if no other is in its way.
#[inline(always)]
#[expect(
    clippy::inline_always,
    reason = "where nothing can be touched, little of it is left"
)]
pub(crate) fn planned(scenario: &Scenario, tick: u64, body: &Body) -> Plan {
    let Body {
        kind,
        hull,
        disc,
        course,
        mind,
        ..
    } = *body;
    let sensing_w = kind.sensing_w(mind.sensors_off);
    if !hull.can_move(tick) {
        return Plan {
            path: Path::rest(disc.centre),
            sensing_w,
            ..Plan::REST
        };
    }
    let going = scenario.going(disc.centre, kind.layer);
    let driven = kind
        .drive
        .step(hull.speed_m_s, mind.wanted, going.speed, scenario.step_s);
    let turn_rad = driven.turn_rate_rad_s * scenario.step_s;
    let (front, turn_rad) = if kind.drive.turns_at_once {
        (course.turned(turn_rad).front, 0.0)
    } else {
        (course.front, turn_rad)
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
        let stands = scenario.touched(kind.layer);
        let (walls, discs) = (stands.walls_near(path.start), stands.discs_near(path.start));
        meets_still(&path, disc.radius_m, &walls, &discs)
    });
    let meeting = meeting.flatten();
    path.until = meeting.unwrap_or(1.0);
    Plan {
        path,
        driven,
        effort: going.energy,
        sensing_w,
        stop: meeting.map_or(Stop::Nothing, |_| Stop::Still),
    }
}

/// Lets all robots go as far as their plans say.
fn go(plans: &[Plan], scenario: &Scenario, state: &mut State, is_shared: bool) -> Moved {
    let State {
        tick,
        ids,
        discs,
        courses,
        hulls,
        ..
    } = state;
    let some = |(plans, ids, discs, courses, hulls): Bodies| {
        let mut moved = Moved::default();
        let bodies = discs.iter_mut().zip(courses).zip(hulls);
        for ((plan, id), ((disc, course), hull)) in plans.iter().zip(ids).zip(bodies) {
            let kind = &scenario.kinds[usize::from(id.kind)];
            moved.add(hull.go(plan, kind, scenario.step_s, *tick));
            plan.carry_out(scenario, kind, disc, course);
        }
        moved
    };
    if !is_shared {
        return some((plans, ids, discs, courses, hulls));
    }
    let tasks = (
        plans.par_chunks(ROBOTS_PER_TASK),
        ids.par_chunks(ROBOTS_PER_TASK),
        discs.par_chunks_mut(ROBOTS_PER_TASK),
        courses.par_chunks_mut(ROBOTS_PER_TASK),
        hulls.par_chunks_mut(ROBOTS_PER_TASK),
    );
    // A greatest number and a sum of whole ones: the order of the tasks does not matter.
    tasks
        .into_par_iter()
        .map(some)
        .reduce(Moved::default, Moved::and)
}

type Bodies<'a> = (
    &'a [Plan],
    &'a [RobotId],
    &'a mut [Disc],
    &'a mut [Course],
    &'a mut [Hull],
);

impl Moved {
    pub(crate) fn add(&mut self, other: Self) {
        self.farthest_m = self.farthest_m.max(other.farthest_m);
        self.collisions += other.collisions;
    }

    pub(crate) fn and(mut self, other: Self) -> Self {
        self.add(other);
        self
    }
}

impl Plan {
    const REST: Self = Self {
        path: Path::rest(base::geometry::Point { x: 0.0, y: 0.0 }),
        driven: Driven::REST,
        effort: Going::EASY.energy,
        sensing_w: 0.0,
        stop: Stop::Nothing,
    };

    /// Brings a body where it goes.
    #[inline]
    pub(crate) fn carry_out(
        &self,
        scenario: &Scenario,
        kind: &Kind,
        disc: &mut Disc,
        course: &mut Course,
    ) {
        if self.path.length_m != 0.0 {
            disc.centre = scenario.home(self.path.at(1.0));
        }
        let turn_rad = self.driven.turn_rate_rad_s * scenario.step_s;
        *course = if kind.drive.turns_at_once && turn_rad != 0.0 {
            course.turned_to(turn_rad, self.path.front)
        } else {
            course.turned(turn_rad)
        };
    }
}

impl Hull {
    /// Whether its body obeys in this step.
    #[inline]
    fn can_move(&self, tick: u64) -> bool {
        self.status == Status::Active && !self.is_external && tick >= self.held_until
    }

    /// What going its way does to it.
    #[inline]
    pub(crate) fn go(&mut self, plan: &Plan, kind: &Kind, step_s: f64, tick: u64) -> Moved {
        let gone_m = plan.path.length_m.abs() * plan.path.until;
        let is_stopped = plan.stop > Stop::Pressed;
        self.speed_m_s = if is_stopped {
            0.0
        } else {
            plan.driven.speed_m_s
        };
        self.turn_rate_rad_s = plan.driven.turn_rate_rad_s;
        self.distance_m += gone_m;
        let is_collision = is_stopped && !self.is_touching;
        // Only going freely ends a touch: a robot that turns on the spot is still there.
        self.is_touching = plan.stop != Stop::Nothing || (self.is_touching && gone_m == 0.0);
        let stands_pressed = plan.stop == Stop::Pressed && gone_m == 0.0;
        let stays_pressed = self.is_pressed && tick < self.held_until;
        self.is_pressed = is_stopped || stands_pressed || stays_pressed;
        if is_collision {
            self.collide(kind, tick);
        }
        self.drain(plan, kind, gone_m, step_s);
        Moved {
            farthest_m: gone_m,
            collisions: u64::from(is_collision && plan.stop == Stop::Still),
        }
    }

    fn collide(&mut self, kind: &Kind, tick: u64) {
        self.collisions += 1;
        self.held_until = tick + 1 + kind.collision.stop_steps;
        let is_too_often = self.collisions >= kind.collision.max_collisions;
        if is_too_often && self.status == Status::Active && !self.is_external {
            self.status = Status::Broken;
        }
    }

    /// Takes a step's energy from the battery.
    #[inline]
    fn drain(&mut self, plan: &Plan, kind: &Kind, gone_m: f64, step_s: f64) {
        let is_drained = self.status == Status::Active && !self.is_external;
        let Some(battery) = kind.battery.filter(|_| is_drained) else {
            return;
        };
        let is_moving = gone_m > 0.0 || plan.driven.turn_rate_rad_s != 0.0;
        let move_w = if is_moving { battery.move_w } else { 0.0 };
        let moving_j = move_w * step_s + battery.move_j_per_m * gone_m;
        let standing_w = battery.idle_w + plan.sensing_w;
        let used_j = self.energy_j;
        self.energy_j += standing_w * step_s + moving_j * plan.effort;
        if self.energy_j >= battery.capacity_j {
            // Nothing that was used is given back.
            self.energy_j = battery.capacity_j.max(used_j);
            self.status = Status::Empty;
        }
    }
}
