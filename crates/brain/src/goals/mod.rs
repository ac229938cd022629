//! The goals of a robot: which of them it pursues, and whether it reaches them.
//!
//! Each behaviour that proposes a destination has a goal. In every step each goal gets a
//! [precedence](precedence) and a [verdict](fitness). The robot pursues the goal of the highest
//! precedence, and on its path goals that need only a small detour. The verdicts mean:
//!
//! * *complete*: the behaviour continues to its next destination;
//! * *impossible*: the behaviour is notified, and chooses another destination; the goal itself
//!   [rests](given_up), after each failure for longer, while other goals are pursued;
//! * *approaching*: nothing changes;
//! * *receding*: the behaviour is notified; searches choose another destination. The path is
//!   checked for obstacles [every second](crate::navigation::navigator) in any case.

pub(crate) mod fitness;
mod given_up;
pub(crate) mod orders;
pub(crate) mod precedence;
pub(crate) mod proposal;
pub(crate) mod tour;

use crate::goals::proposal::Destination;
use crate::io::goal_id::GoalId;
use crate::io::reason::Reason;
use alloc::vec::Vec;
use base::geometry::Point;
use base::hashed::Hashed;
pub use fitness::Verdict;
use fitness::{Fitness, Step};
use given_up::GivenUp;
use precedence::{precedence, time_s};

/// All detours on the way to a goal together are at most this fraction of the straight line to it.
const MAX_DETOUR: f64 = 0.15;

/// The goal of a behaviour, and its state.
#[derive(Debug, Clone, Copy, Hashed)]
pub(crate) struct Goal {
    /// Index of the behaviour in the brain's list.
    pub(crate) behaviour: usize,
    pub(crate) destination: Destination,
    pub(crate) precedence: f64,
    pub(crate) verdict: Verdict,
    pub(crate) fitness: Fitness,
    /// Why it is impossible, if it is.
    pub(crate) reason: Option<Reason>,
    /// Remaining time for which it is not tried again.
    pub(crate) rest_s: f64,
    /// Whether the behaviour was notified before that the goal is impossible.
    is_reported: bool,
}

/// All goals of a robot, by precedence: at most one per behaviour.
#[derive(Debug, Clone, Default, Hashed)]
pub(crate) struct Goals {
    pub(crate) list: Vec<Goal>,
    given_up: GivenUp,
    detours: Option<DetourBudget>,
}

/// The first goal, and the remaining length of detours on the way to it.
#[derive(Debug, Clone, Copy, Hashed)]
struct DetourBudget {
    goal: GoalId,
    /// Position of the robot when the budget was last updated.
    at: Point,
    left_m: f64,
}

impl DetourBudget {
    fn new(goal: &Goal, at: Point) -> Self {
        Self {
            goal: goal.destination.id,
            at,
            left_m: MAX_DETOUR * at.to(goal.destination.at).length(),
        }
    }

    fn applies_to(&self, goal: &Goal) -> bool {
        self.goal == goal.destination.id
    }

    /// After the robot moved to a position: what did not bring it nearer was a detour.
    fn moved(self, goal: &Goal, at: Point) -> Self {
        let goal_at = goal.destination.at;
        let [before_m, after_m] = [self.at, at].map(|at| at.to(goal_at).length());
        let detour_m = self.at.to(at).length() - (before_m - after_m);
        Self {
            at,
            left_m: self.left_m - detour_m.max(0.0),
            ..self
        }
    }
}

impl Goals {
    /// Replaces the goals by those of this step's destinations, each with its behaviour's index;
    /// the progress of goals that remain is kept. That of a goal that has moved starts over: it was
    /// made on the path to another place.
    pub(crate) fn update(
        &mut self,
        destinations: impl Iterator<Item = (usize, Destination)>,
        step: &Step,
    ) {
        let before = core::mem::take(&mut self.list);
        self.rest(step.elapsed_s);
        for (behaviour, destination) in destinations {
            let mut known = before.iter();
            let same = known.find(|goal| {
                goal.behaviour == behaviour && goal.destination.goal() == destination.goal()
            });
            let goal = self.judged(behaviour, destination, same, step);
            self.list.push(goal);
        }
        // The sort is stable: equal goals stay in the order of their behaviours.
        self.list
            .sort_by(|one, other| other.precedence.total_cmp(&one.precedence));
        let detours = self.possible().next().map(|first| match self.detours {
            Some(detours) if detours.applies_to(first) => detours.moved(first, step.at),
            _ => DetourBudget::new(first, step.at),
        });
        self.detours = detours;
    }

    /// Takes a step into account in which a reflex moved the robot, which does not stop the clock of
    /// the goal that it interrupts. Returns whether that has become impossible.
    pub(crate) fn interrupt(&mut self, id: GoalId, elapsed_s: f64, period_s: f64) -> bool {
        let mut goals = self.list.iter_mut();
        let Some(goal) = goals.find(|goal| goal.destination.id == id) else {
            return false;
        };
        goal.fitness.count(elapsed_s, period_s);
        let is_given_up = goal.fitness.is_stuck() && goal.verdict != Verdict::Impossible;
        if is_given_up {
            goal.verdict = Verdict::Impossible;
            let reason = goal.fitness.reason_of_time();
            goal.reason = Some(reason);
            self.given_up.add(goal.destination.goal(), reason);
        }
        is_given_up
    }

    /// Begins to pursue a goal. Returns whether the map is to be marked stale first, as the goal is tried
    /// again.
    pub(crate) fn begin(&mut self, destination: &Destination) -> bool {
        self.given_up.begin_retry(destination.goal())
    }

    /// Whether a goal has been given up before.
    pub(crate) fn is_retried(&self, destination: &Destination) -> bool {
        self.given_up.contains(destination.goal())
    }

    /// Lets goals rest that were given up.
    pub(crate) fn rest(&mut self, elapsed_s: f64) {
        self.given_up.advance(elapsed_s);
    }

    /// The goal of a destination, which may be the same as in the last step.
    fn judged(
        &mut self,
        behaviour: usize,
        destination: Destination,
        same: Option<&Goal>,
        step: &Step,
    ) -> Goal {
        let place = destination.goal();
        let was_impossible = same.is_some_and(|goal| goal.verdict == Verdict::Impossible);
        let is_resting = self.given_up.rest_s(place) > 0.0;
        let same = same.filter(|_| !was_impossible);
        let mut fitness = same.map_or_else(Fitness::default, |goal| goal.fitness);
        let verdict = match fitness.update(&destination, step) {
            Verdict::Complete => {
                self.given_up.remove(place);
                Verdict::Complete
            }
            _ if is_resting => Verdict::Impossible,
            Verdict::Impossible => {
                self.given_up.add(place, fitness.reason(&destination, step));
                Verdict::Impossible
            }
            verdict => verdict,
        };
        let time_s = time_s(step.at.to(destination.at).length(), &destination);
        let reason = self.given_up.reason(place);
        Goal {
            behaviour,
            destination,
            precedence: precedence(&destination, time_s, step.battery_s),
            verdict,
            fitness,
            reason: reason.filter(|_| verdict == Verdict::Impossible),
            rest_s: self.given_up.rest_s(place),
            is_reported: was_impossible && is_resting,
        }
    }

    fn possible(&self) -> impl Iterator<Item = &Goal> {
        let goals = self.list.iter();
        goals.filter(|goal| goal.verdict != Verdict::Impossible)
    }

    /// The goal to pursue: the first, or the nearest that is worth a detour on the way to it.
    pub(crate) fn select(&self, at: Point) -> Option<&Goal> {
        let mut possible = self.possible();
        let first = possible.next()?;
        let budget_m = self.detours.map_or(0.0, |detours| detours.left_m);
        let first_at = first.destination.at;
        let direct_m = at.to(first_at).length();
        let detour_m = |goal: &&Goal| {
            let via = goal.destination.at;
            at.to(via).length() + via.to(first_at).length() - direct_m
        };
        let on_the_way = possible.filter(|goal| detour_m(goal) <= budget_m);
        let nearest = on_the_way.min_by(|one, other| {
            let distance = |goal: &Goal| at.to(goal.destination.at).length_squared();
            distance(one).total_cmp(&distance(other))
        });
        Some(nearest.unwrap_or(first))
    }

    /// The goals that are not being reached, and of which their behaviours have to be notified.
    pub(crate) fn unreported(&self) -> impl Iterator<Item = &Goal> {
        let is_unreported = |goal: &&Goal| match goal.verdict {
            Verdict::Impossible => !goal.is_reported,
            Verdict::Receding => true,
            Verdict::Complete | Verdict::Approaching => false,
        };
        self.list.iter().filter(is_unreported)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::agent_id::AgentId;
    use fitness::Pursuit;

    fn id(number: u32) -> GoalId {
        let issuer = AgentId::default();
        GoalId {
            issuer: issuer.into(),
            number,
        }
    }

    /// Each place has a goal of its own.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a number"
    )]
    fn destination(x: f64, y: f64, value: f64) -> Destination {
        Destination {
            id: id((100.0 * x) as i32 as u32 ^ ((100.0 * y) as i32 as u32) << 16),
            at: Point { x, y },
            tolerance_m: 0.5,
            max_deviation_m: 0.25,
            is_at_hazard: false,
            max_speed_m_s: 1.0,
            value,
        }
    }

    fn step(at: Point) -> Step {
        Step {
            at,
            deviation_m: 0.0,
            elapsed_s: 0.1,
            period_s: 0.1,
            unreachable: None,
            battery_s: f64::INFINITY,
            pursued: None,
            noise_m: 0.0,
        }
    }

    fn goals(destinations: &[Destination], at: Point) -> Goals {
        let mut goals = Goals::default();
        goals.update(destinations.iter().copied().enumerate(), &step(at));
        goals
    }

    const HERE: Point = Point { x: 0.0, y: 0.0 };

    #[test]
    fn precedence_changes_as_the_robot_moves() {
        let destinations = [destination(10.0, 0.0, 1.0), destination(-10.0, 0.0, 1.0)];
        for (x, first) in [(2.0, 0), (-2.0, 1)] {
            let at = Point { x, y: 0.0 };
            assert_eq!(
                goals(&destinations, at).select(at).unwrap().behaviour,
                first
            );
        }
    }

    #[test]
    fn a_goal_on_the_way_is_pursued_before_the_one_beyond() {
        let destinations = [destination(10.0, 0.0, 5.0), destination(5.0, 0.5, 0.1)];
        assert_eq!(
            goals(&destinations, HERE).select(HERE).unwrap().behaviour,
            1
        );
    }

    #[test]
    fn detours_on_the_way_to_a_goal_share_one_budget() {
        let first = destination(40.0, 0.0, 5.0);
        let mut goals = Goals::default();
        let mut at = HERE;
        let mut detours_m = 0.0;
        // There is always another goal slightly aside of the path.
        let served = (0..200).filter(|_| {
            let beside = at.plus(Point { x: 1.0, y: 1.5 });
            let beside = destination(beside.x, beside.y, 0.1);
            goals.update([first, beside].into_iter().enumerate(), &step(at));
            let next = goals.select(at).unwrap();
            let path = at.to(next.destination.at);
            let stride = path.times(0.5 / path.length().max(0.5));
            let nearer_m = at.to(first.at).length() - at.plus(stride).to(first.at).length();
            detours_m += stride.length() - nearer_m;
            at = at.plus(stride);
            next.behaviour == 1
        });
        assert!(served.count() > 5);
        assert!(detours_m <= MAX_DETOUR * 40.0 + 0.5, "{detours_m}");
    }

    #[test]
    fn conflicting_goals_are_pursued_in_order() {
        let destinations = [destination(10.0, 0.0, 5.0), destination(0.0, 5.0, 0.1)];
        let goals = goals(&destinations, HERE);
        assert_eq!(goals.select(HERE).unwrap().behaviour, 0);
        let order: Vec<usize> = goals.list.iter().map(|goal| goal.behaviour).collect();
        assert_eq!(order, [0, 1]);
    }

    /// Two conflicting goals, of which the first has no path.
    fn first_is_unreachable() -> ([Destination; 2], Goals) {
        let destinations = [destination(10.0, 0.0, 5.0), destination(0.0, 5.0, 0.1)];
        let unreachable = Step {
            unreachable: Some(destinations[0].goal()),
            ..step(HERE)
        };
        let mut goals = Goals::default();
        goals.update(destinations.iter().copied().enumerate(), &unreachable);
        (destinations, goals)
    }

    #[test]
    fn an_impossible_goal_is_not_pursued() {
        let (_, goals) = first_is_unreachable();
        assert_eq!(goals.select(HERE).unwrap().behaviour, 1);
        assert_eq!(goals.unreported().next().unwrap().behaviour, 0);
    }

    #[test]
    fn an_impossible_goal_is_reported_once_and_first_rests_for_ten_seconds() {
        let (destinations, mut goals) = first_is_unreachable();
        assert_eq!(goals.unreported().count(), 1);
        let mut next = || {
            goals.update(destinations.iter().copied().enumerate(), &step(HERE));
            let reported = goals.unreported().count();
            (goals.select(HERE).unwrap().behaviour, reported)
        };
        let others = core::iter::from_fn(|| Some(next())).take_while(|next| *next == (1, 0));
        assert!((95..=101).contains(&others.count()));
    }

    #[test]
    fn a_reflex_that_moves_the_robot_does_not_stop_the_clock_of_the_goal() {
        let place = destination(10.0, 0.0, 1.0);
        let mut goals = goals(&[place], HERE);
        let mut interrupt = || goals.interrupt(place.id, 0.1, 0.1);
        let steps = (0..1000).take_while(|_| !interrupt()).count();
        assert!((295..=305).contains(&steps), "{steps}");
        assert_eq!(goals.unreported().count(), 1);
        assert!(goals.select(HERE).is_none());
        goals.update([(0, place)].into_iter(), &step(HERE));
        assert_eq!(goals.list[0].verdict, Verdict::Impossible);
        assert_eq!(goals.unreported().count(), 0);
    }

    #[test]
    fn two_goals_at_one_place_are_two_goals() {
        let [one, other] = [1, 2].map(|number| Destination {
            id: id(number),
            ..destination(10.0, 0.0, 1.0)
        });
        let stuck = Step {
            pursued: Some(Pursuit {
                goal: one.goal(),
                remaining_m: 10.0,
                added_m: 0.0,
            }),
            ..step(HERE)
        };
        let mut goals = Goals::default();
        for _ in 0..50 {
            goals.update([one, other].into_iter().enumerate(), &stuck);
        }
        // Only the one that is pursued makes no progress.
        let verdicts = goals.list.iter().map(|goal| goal.verdict);
        let verdicts: Vec<Verdict> = verdicts.collect();
        assert_eq!(verdicts, [Verdict::Receding, Verdict::Approaching]);
    }

    #[test]
    fn a_goal_that_moves_remains_the_same_goal() {
        let mut goals = Goals::default();
        let budget_m = |goals: &Goals| goals.detours.unwrap().left_m;
        goals.update([(0, destination(10.0, 0.0, 1.0))].into_iter(), &step(HERE));
        let moved = |x| Destination {
            id: destination(10.0, 0.0, 1.0).id,
            ..destination(x, 3.0, 1.0)
        };
        let aside = Point { x: 0.0, y: -0.4 };
        goals.update([(0, moved(20.0))].into_iter(), &step(aside));
        assert!(budget_m(&goals) < MAX_DETOUR * 10.0);
        // The progress was made on the path to another place.
        assert!((goals.list[0].fitness.min_m() - aside.to(moved(20.0).at).length()).abs() < 1e-9);
        goals.update([(0, destination(20.0, 3.0, 1.0))].into_iter(), &step(aside));
        assert!(budget_m(&goals) > MAX_DETOUR * 20.0);
    }
}
