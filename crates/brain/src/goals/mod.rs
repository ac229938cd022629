//! What a robot wants, which of it first, and whether it gets there: the *goal selector* of a mind.
//!
//! Each behaviour that wants to be somewhere has a goal. In every cycle each goal gets a
//! [precedence](precedence) and a [verdict](fitness); goals that do not conflict are served together,
//! others in order of precedence. What a verdict means:
//!
//! * *complete*: the behaviour goes on to its next place;
//! * *impossible*: the behaviour is told, and goes on to another place; if it still wants the same, that has
//!   to wait for [ten seconds](fitness), in which other goals have their turn;
//! * *approaching*: nothing is to be done;
//! * *receding*: the behaviour is told; searches choose another place. What fills the way is looked over in
//!   [each second](crate::navigation::navigator) anyhow.

pub(crate) mod fitness;
pub(crate) mod precedence;
pub(crate) mod proposal;

use crate::goals::proposal::Destination;
use alloc::vec::Vec;
use base::geometry::Point;
pub use fitness::Verdict;
use fitness::{Fitness, Step};
use precedence::{precedence, time_s};

/// Another goal is on the way if all detours together are no longer than this share of the way.
const DETOUR: f64 = 0.15;

/// A goal that moves by less is the same, in metres.
const SAME_M: f64 = 1.0;

/// What one behaviour wants, and what has become of it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Goal {
    /// Place of the behaviour in the brain's list.
    pub(crate) behaviour: usize,
    pub(crate) aim: Destination,
    pub(crate) precedence: f64,
    pub(crate) verdict: Verdict,
    pub(crate) fitness: Fitness,
    /// Whether its behaviour has been told before that it is impossible.
    is_told: bool,
}

/// All that a robot wants, by precedence: at most one goal a behaviour.
#[derive(Debug, Clone, Default)]
pub(crate) struct Goals {
    pub(crate) goals: Vec<Goal>,
    lead: Option<Lead>,
}

/// The first goal, and what may still be gone out of the way to it.
#[derive(Debug, Clone, Copy)]
struct Lead {
    behaviour: usize,
    to: Point,
    /// Where the robot was when that was reckoned.
    at: Point,
    spare_m: f64,
}

impl Lead {
    fn new(goal: &Goal, at: Point) -> Self {
        Self {
            behaviour: goal.behaviour,
            to: goal.aim.to,
            at,
            spare_m: DETOUR * at.to(goal.aim.to).length(),
        }
    }

    fn is_of(&self, goal: &Goal) -> bool {
        self.behaviour == goal.behaviour && self.to.to(goal.aim.to).length() < SAME_M
    }

    /// After it went on to a place: what did not bring it nearer was a detour.
    fn moved(self, goal: &Goal, at: Point) -> Self {
        let [before_m, after_m] = [self.at, at].map(|at| at.to(goal.aim.to).length());
        let detour_m = self.at.to(at).length() - (before_m - after_m);
        Self {
            to: goal.aim.to,
            at,
            spare_m: self.spare_m - detour_m.max(0.0),
            ..self
        }
    }
}

impl Goals {
    /// Renews the goals from what behaviours aim at, given what is known of this step.
    pub(crate) fn renew(&mut self, aims: impl Iterator<Item = (usize, Destination)>, step: &Step) {
        let before = core::mem::take(&mut self.goals);
        self.goals.extend(aims.map(|(behaviour, aim)| {
            let mut known = before.iter();
            let same = known.find(|goal| goal.behaviour == behaviour && goal.aim.to == aim.to);
            let is_told = same.is_some_and(|goal| goal.fitness.rests());
            // What was given up and is wanted again begins anew, unless it rests.
            let same = same.filter(|goal| goal.verdict != Verdict::Impossible || is_told);
            let mut fitness = same.map_or_else(Fitness::default, |goal| goal.fitness);
            let way_m = step.at.to(aim.to).length();
            let verdict = fitness.judge(&aim, step);
            // Who wants nothing else may as well go on trying, where there is a way.
            let is_worth_a_rest = before.len() > 1 || step.closed == Some(aim.to);
            if verdict == Verdict::Impossible && is_worth_a_rest && !fitness.rests() {
                fitness.rest();
            }
            Goal {
                behaviour,
                aim,
                precedence: precedence(&aim, time_s(way_m, &aim), step.battery_s),
                verdict,
                is_told: is_told && fitness.rests(),
                fitness,
            }
        }));
        // Equal ones stay in the order of their behaviours.
        self.goals
            .sort_by(|one, other| other.precedence.total_cmp(&one.precedence));
        let lead = self.possible().next().map(|first| match self.lead {
            Some(lead) if lead.is_of(first) => lead.moved(first, step.at),
            _ => Lead::new(first, step.at),
        });
        self.lead = lead;
    }

    fn possible(&self) -> impl Iterator<Item = &Goal> {
        let goals = self.goals.iter();
        goals.filter(|goal| goal.verdict != Verdict::Impossible)
    }

    /// The goal to go for: the first, or one that lies on the way to it.
    pub(crate) fn next(&self, at: Point) -> Option<&Goal> {
        let mut possible = self.possible();
        let first = possible.next()?;
        let spare_m = self.lead.map_or(0.0, |lead| lead.spare_m);
        let way_m = at.to(first.aim.to).length();
        let detour_m = |goal: &&Goal| {
            let (there, then) = (at.to(goal.aim.to), goal.aim.to.to(first.aim.to));
            there.length() + then.length() - way_m
        };
        let on_the_way = possible.filter(|goal| detour_m(goal) <= spare_m);
        let nearest = on_the_way.min_by(|one, other| {
            let far = |goal: &Goal| at.to(goal.aim.to).length_squared();
            far(one).total_cmp(&far(other))
        });
        Some(nearest.unwrap_or(first))
    }

    /// Those that are not being reached, and whose behaviours have not been told yet.
    pub(crate) fn in_trouble(&self) -> impl Iterator<Item = &Goal> {
        let is_in_trouble = |goal: &&Goal| match goal.verdict {
            Verdict::Impossible => !goal.is_told,
            Verdict::Receding => true,
            Verdict::Complete | Verdict::Approaching => false,
        };
        self.goals.iter().filter(is_in_trouble)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn aim(x: f64, y: f64, value: f64) -> Destination {
        Destination {
            to: Point { x, y },
            within_m: 0.5,
            speed_m_s: 1.0,
            value,
        }
    }

    fn step(at: Point) -> Step {
        Step {
            at,
            period_s: 0.1,
            closed: None,
            battery_s: f64::INFINITY,
            going: None,
        }
    }

    fn goals(aims: &[Destination], at: Point) -> Goals {
        let mut goals = Goals::default();
        goals.renew(aims.iter().copied().enumerate(), &step(at));
        goals
    }

    const HERE: Point = Point { x: 0.0, y: 0.0 };

    #[test]
    fn precedence_changes_as_the_robot_moves() {
        let aims = [aim(10.0, 0.0, 1.0), aim(-10.0, 0.0, 1.0)];
        for (x, first) in [(2.0, 0), (-2.0, 1)] {
            let at = Point { x, y: 0.0 };
            assert_eq!(goals(&aims, at).next(at).unwrap().behaviour, first);
        }
    }

    #[test]
    fn a_goal_on_the_way_is_served_together_with_the_one_beyond() {
        let aims = [aim(10.0, 0.0, 5.0), aim(5.0, 0.5, 0.1)];
        assert_eq!(goals(&aims, HERE).next(HERE).unwrap().behaviour, 1);
    }

    #[test]
    fn detours_on_one_way_are_counted_together() {
        let first = aim(40.0, 0.0, 5.0);
        let mut goals = Goals::default();
        let mut at = HERE;
        let mut detours_m = 0.0;
        // Always another that lies a little aside.
        let served = (0..200).filter(|_| {
            let beside = at.plus(Point { x: 1.0, y: 1.5 });
            let beside = aim(beside.x, beside.y, 0.1);
            goals.renew([first, beside].into_iter().enumerate(), &step(at));
            let next = goals.next(at).unwrap();
            let way = at.to(next.aim.to);
            let stride = way.times(0.5 / way.length().max(0.5));
            let nearer_m = at.to(first.to).length() - at.plus(stride).to(first.to).length();
            detours_m += stride.length() - nearer_m;
            at = at.plus(stride);
            next.behaviour == 1
        });
        assert!(served.count() > 5);
        assert!(detours_m <= DETOUR * 40.0 + 0.5, "{detours_m}");
    }

    #[test]
    fn goals_that_conflict_are_served_in_order() {
        let aims = [aim(10.0, 0.0, 5.0), aim(0.0, 5.0, 0.1)];
        let goals = goals(&aims, HERE);
        assert_eq!(goals.next(HERE).unwrap().behaviour, 0);
        let order: Vec<usize> = goals.goals.iter().map(|goal| goal.behaviour).collect();
        assert_eq!(order, [0, 1]);
    }

    /// Two that conflict, and the way to the first is closed.
    fn closed() -> ([Destination; 2], Goals) {
        let aims = [aim(10.0, 0.0, 5.0), aim(0.0, 5.0, 0.1)];
        let closed = Step {
            closed: Some(aims[0].to),
            ..step(HERE)
        };
        let mut goals = Goals::default();
        goals.renew(aims.iter().copied().enumerate(), &closed);
        (aims, goals)
    }

    #[test]
    fn what_is_impossible_is_not_gone_for() {
        let (_, goals) = closed();
        assert_eq!(goals.next(HERE).unwrap().behaviour, 1);
        assert_eq!(goals.in_trouble().next().unwrap().behaviour, 0);
    }

    #[test]
    fn what_is_impossible_leaves_ten_seconds_to_others_and_is_told_once() {
        let (aims, mut goals) = closed();
        assert_eq!(goals.in_trouble().count(), 1);
        let mut renewed = || {
            goals.renew(aims.iter().copied().enumerate(), &step(HERE));
            let told = goals.in_trouble().count();
            (goals.next(HERE).unwrap().behaviour, told)
        };
        let others = core::iter::from_fn(|| Some(renewed())).take_while(|next| *next == (1, 0));
        assert!((95..=101).contains(&others.count()));
    }
}
