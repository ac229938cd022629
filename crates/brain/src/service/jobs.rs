//! The goals that a robot serves, in the order in which it serves them.

use super::ability::Ability;
use super::charge_state::{Aim, Charges, Fence};
use crate::goals::proposal::max_deviation_m;
use crate::goals::tour::Tour;
use crate::io::agent_id::AgentId;
use crate::io::goal_id::GoalId;
use crate::io::verdict::Verdict;
use crate::io::work::{Effect, Task};
use alloc::vec::Vec;
use base::geometry::Point;
use base::hashed::Hashed;

/// A robot that seems to be there waits for this time until it knows its position better than it needs to.
const PATIENCE_S: f64 = 10.0;

/// It drives nearer to the goal than it needs to by this number of standard deviations, but at most to this fraction.
const MARGIN_DEVIATIONS: f64 = 3.0;
const MIN_WITHIN: f64 = 0.25;

/// Times in messages have the precision of 32-bit floats.
const ROUNDING_S: f64 = 1e-6;

/// A goal that a robot serves.
#[derive(Debug, Clone, Copy, Hashed)]
pub(crate) struct Job {
    pub(crate) task: Task,
    pub(crate) owner: AgentId,
    /// Its deadline on the robot's clock.
    pub(crate) due_at_s: f64,
    /// Time of service so far.
    pub(crate) served_s: f64,
    /// Number of the next corner of a search, and how many have been visited.
    pub(crate) corners: u32,
    pub(crate) visited: u32,
    pub(crate) verdict: Verdict,
    /// Whether the robot has seemed to be there, but did not know its position well enough.
    pub(crate) is_uncertain: bool,
    /// For how long it has stood there until it knows its position well enough.
    pub(crate) waited_s: f64,
    /// Until when others are served first, because it was impossible.
    pub(crate) rests_until_s: f64,
    /// What it is to neutralise, once it has detected it.
    #[hashed(skip)]
    pub(crate) aim: Option<Aim>,
    pub(crate) charges: Charges,
}

impl Job {
    pub(crate) fn new(task: Task, owner: AgentId, due_at_s: f64) -> Self {
        Self {
            task,
            owner,
            due_at_s,
            served_s: 0.0,
            corners: 0,
            visited: 0,
            verdict: Verdict::Approaching,
            is_uncertain: false,
            waited_s: 0.0,
            rests_until_s: f64::NEG_INFINITY,
            aim: None,
            charges: Charges::default(),
        }
    }

    /// Where the robot has to be, and how near.
    pub(crate) fn target(&self, ability: &Ability) -> (Point, f64) {
        if let Some(at) = self.fence_at() {
            return (at, ability.act_from_m(ability.fence.as_ref()));
        }
        if let Some(at) = self.charge_at() {
            return (at, ability.act_from_m(ability.charge.as_ref()));
        }
        let sweeps = ability.sweeps(&self.task);
        let corner = || ability.lanes.corner(&self.task, self.corners);
        if let Some(corner) = sweeps.then(corner).flatten() {
            return (corner, (ability.lanes.apart_m / 4.0).clamp(0.2, 2.0));
        }
        let radius_m = if self.task.work.manner().is_at_item {
            ability.look_from_m(&self.task)
        } else {
            self.task.radius_m.into()
        };
        (self.task.at(), radius_m)
    }

    /// Whether it ends with a charge.
    pub(super) fn neutralises(&self) -> bool {
        self.task.work.manner().effect == Some(Effect::Neutralise)
    }

    /// Whether the service has begun: looks or a charge, which end if the robot drives on.
    pub(crate) fn has_begun(&self) -> bool {
        self.served_s > 0.0 || self.charges.is_firing
    }

    /// How near to its goal the robot drives, and has to believe itself to be: a position with a standard deviation is
    /// rarely outside of the goal then.
    pub(crate) fn within_m(&self, near_m: f64, deviation_m: f64) -> f64 {
        if self.task.work.manner().is_precise {
            (near_m - MARGIN_DEVIATIONS * deviation_m).max(MIN_WITHIN * near_m)
        } else {
            near_m
        }
    }

    /// Whether the robot knows its position well enough to be there: within half of what it needs, which makes errors
    /// rare, or after it has waited for that.
    pub(crate) fn is_certain(&self, deviation_m: f64) -> bool {
        let max_m = self.max_deviation_m();
        deviation_m <= max_m / 2.0 || deviation_m <= max_m && self.waited_s >= PATIENCE_S
    }

    /// The largest standard deviation of its position with which the robot knows that it is there.
    /// Any is enough for a search, and for looks and acts, whose distances allow for the error.
    pub(crate) fn max_deviation_m(&self) -> f64 {
        if self.task.work.manner().is_precise {
            max_deviation_m(self.task.radius_m.into())
        } else {
            f64::INFINITY
        }
    }

    /// Where it is to fence something off, if it is.
    pub(crate) fn fence_at(&self) -> Option<Point> {
        let aim = self.aim.filter(|_| self.charges.fence == Fence::Wanted);
        aim.map(|aim| aim.at)
    }

    /// Where it is to act with a charge, if it is: at what it has detected, or at the mark itself if it
    /// has detected nothing and no charge has gone off there.
    pub(crate) fn charge_at(&self) -> Option<Point> {
        if !self.neutralises() {
            return None;
        }
        let has_looked = self.charges.has_looked && self.charges.fired == 0;
        let aim = self.aim.map(|aim| aim.at);
        aim.or_else(|| has_looked.then(|| self.task.at()))
    }

    /// Whether it remains only to be there for the time of service.
    pub(crate) fn is_swept(&self, ability: &Ability) -> bool {
        !ability.sweeps(&self.task)
            || self.fence_at().is_some()
            || self.charge_at().is_some()
            || ability.is_stationary()
            || ability.lanes.corner(&self.task, self.corners).is_none()
    }

    /// Skips a corner of a search that cannot be reached: an obstacle may be there. Returns whether
    /// the search continues; one without any corner in reach does not.
    pub(crate) fn skip_corner(&mut self, ability: &Ability) -> bool {
        if self.is_swept(ability) {
            return false;
        }
        self.corners += 1;
        if self.is_swept(ability) && self.visited == 0 {
            self.corners = 0;
            return false;
        }
        true
    }

    /// Remaining time of service; none when it is within the rounding of a sum of steps.
    pub(crate) fn left_s(&self) -> f64 {
        let left_s = f64::from(self.task.service_s) - self.served_s;
        if left_s < ROUNDING_S { 0.0 } else { left_s }
    }
}

/// All goals that a robot serves.
#[derive(Debug, Clone, Default, Hashed)]
pub(crate) struct Jobs {
    pub(crate) list: Vec<Job>,
    /// Number of changes.
    pub(crate) version: u32,
}

impl Jobs {
    pub(crate) fn get(&self, goal: GoalId) -> Option<&Job> {
        self.list.iter().find(|job| job.task.id == goal)
    }

    pub(crate) fn get_mut(&mut self, goal: GoalId) -> Option<&mut Job> {
        self.list.iter_mut().find(|job| job.task.id == goal)
    }

    /// Adds a goal; all are then served in the order of the shortest path from a position.
    pub(crate) fn add(&mut self, job: Job, at: Point) {
        self.list.push(job);
        self.sort(at);
    }

    pub(crate) fn remove(&mut self, goal: GoalId) -> Option<Job> {
        let index = self.list.iter().position(|job| job.task.id == goal)?;
        self.version = self.version.wrapping_add(1);
        Some(self.list.remove(index))
    }

    /// The goal to serve now: one whose service has begun, or the first that does not rest.
    pub(crate) fn current(&self, now_s: f64) -> Option<&Job> {
        let begun = self.list.iter().find(|job| job.served_s > 0.0);
        let mut awake = self.list.iter().filter(|job| now_s >= job.rests_until_s);
        begun.or_else(|| awake.next())
    }

    /// The shortest path from a position through all goals.
    pub(crate) fn tour(&self, at: Point) -> Tour {
        let places = self.list.iter().map(|job| job.task.at());
        let places: Vec<Point> = places.collect();
        Tour::new(at, &places)
    }

    fn sort(&mut self, at: Point) {
        let order = self.tour(at).order;
        self.list = order.into_iter().map(|index| self.list[index]).collect();
        self.version = self.version.wrapping_add(1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::work::Work;
    use crate::service::lanes::Lanes;

    fn search() -> (Job, Ability) {
        let task = Task {
            id: GoalId::default(),
            at_m: [20.0, 20.0],
            radius_m: 6.0,
            value: 1.0,
            service_s: 0.0,
            due_s: f32::MAX,
            work: Work::Search,
            capability: 0,
        };
        let lanes = Lanes {
            apart_m: 4.0,
            within: None,
            is_balanced: false,
        };
        let ability = Ability {
            speed_m_s: 1.0,
            max_goals: 1,
            lanes,
            ..Ability::default()
        };
        (Job::new(task, AgentId::default(), f64::INFINITY), ability)
    }

    #[test]
    fn a_search_skips_corners_out_of_reach_and_fails_if_there_is_no_other() {
        let (mut job, ability) = search();
        let first = job.target(&ability).0;
        assert!(job.skip_corner(&ability));
        assert_ne!(job.target(&ability).0, first);
        let skipped = (0..5).take_while(|_| job.skip_corner(&ability)).count();
        assert_eq!(skipped, 4);
        assert_eq!(job.target(&ability).0, first, "it begins again");
        job.visited = 1;
        assert!((0..6).all(|_| job.skip_corner(&ability)));
        assert!(job.is_swept(&ability) && !job.skip_corner(&ability));
    }
}
