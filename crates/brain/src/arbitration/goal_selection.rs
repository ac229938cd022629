//! A mind: identifier, goal selector, adapter (Rodin and Amin, *Intelligent navigation for an autonomous
//! mobile robot*, 1988).
//!
//! * the *identifier* makes [beliefs](crate::perception::beliefs) of percepts;
//! * the *goal selector* chooses among the [goals](crate::goals) that behaviours have;
//! * the *adapter* finds a [way](crate::navigation::navigator) there, and keeps out of others'.

use crate::arbitration::subsumption::Layer;
use crate::behaviours::behaviour::Behaviour;
use crate::behaviours::{Memory, Ready};
use crate::goals::fitness::Step;
use crate::goals::proposal::{Destination, Proposal};
use crate::goals::{Goal, Goals, Verdict};
use crate::io::body::Body;
use crate::io::command::Motion;
use crate::io::message::Message;
use crate::navigation::navigator::Navigator;
use crate::perception::beliefs::{Beliefs, BeliefsSpec};
use crate::perception::situation::Situation;
use alloc::vec::Vec;

/// What only robots have that believe something: most kinds do not.
#[derive(Debug, Clone)]
pub(crate) struct BeliefBrain {
    pub(crate) beliefs: Beliefs,
    pub(crate) wants: GoalSelection,
}

/// What a robot wants, and how it gets there.
#[derive(Debug, Clone, Default)]
pub(crate) struct GoalSelection {
    pub(crate) goals: Goals,
    pub(crate) way: Navigator,
    going: Option<Destination>,
    /// Kept so that nothing is allocated.
    pub(crate) proposals: Vec<(usize, Proposal)>,
}

impl BeliefBrain {
    pub(crate) fn new(spec: &BeliefsSpec, body: &Body) -> Self {
        Self {
            beliefs: Beliefs::new(spec, body),
            wants: GoalSelection::default(),
        }
    }

    /// Tells others what they need to know.
    pub(crate) fn tell(&mut self, period_s: f64, outbox: &mut Vec<Message>) {
        self.beliefs.tell(self.wants.going, period_s, outbox);
    }
}

impl GoalSelection {
    /// Whether a goal is the one that the robot goes for.
    pub(crate) fn is_pursued(&self, goal: &Goal) -> bool {
        self.going.is_some_and(|aim| aim.to == goal.aim.to)
    }

    /// The behaviour whose goal the robot goes for.
    pub(crate) fn pursued(&self) -> Option<usize> {
        let mut goals = self.goals.goals.iter();
        Some(goals.find(|goal| self.is_pursued(goal))?.behaviour)
    }

    /// Keeps the goals of behaviours below one, which were not asked; those above want nothing.
    pub(crate) fn keep_below(&mut self, behaviour: usize) {
        let goals = &mut self.goals.goals;
        goals.retain(|goal| goal.behaviour < behaviour);
        let is_kept = |aim: &Destination| goals.iter().any(|goal| goal.aim.to == aim.to);
        self.going = self.going.filter(is_kept);
    }

    /// The motion that serves proposals best: those of behaviours by their places, none of them beside a
    /// motion unless it is the lowest.
    pub(crate) fn serve(
        &mut self,
        proposals: &[(usize, Proposal)],
        behaviours: &[Ready],
        layers: &mut [Layer<Memory>],
        situation: &Situation,
    ) -> Motion {
        let going = self.going.take().map(|aim| aim.to);
        let Some(beliefs) = situation.beliefs else {
            return Motion::default();
        };
        let Some(pose) = beliefs.pose() else {
            return Motion::default();
        };
        let aims = proposals
            .iter()
            .filter_map(|(behaviour, proposal)| match proposal {
                Proposal::Destination(aim) => Some((*behaviour, *aim)),
                Proposal::Motion(_) => None,
            });
        let step = Step {
            at: pose.at,
            period_s: situation.body.period_s,
            closed: self.way.closed(),
            battery_s: beliefs.battery_s(),
            going: going.map(|to| (to, self.way.left_m(pose.at, to))),
        };
        self.goals.renew(aims, &step);
        for goal in self.goals.in_trouble() {
            if let (Some(behaviour), Some(layer)) = (
                behaviours.get(goal.behaviour),
                layers.get_mut(goal.behaviour),
            ) {
                behaviour.judged(layer.memory(), goal.verdict);
            }
            if goal.verdict == Verdict::Impossible && going == Some(goal.aim.to) {
                self.way.find_anew();
            }
        }
        let Some(goal) = self.goals.next(pose.at) else {
            return Motion::default();
        };
        self.going = Some(goal.aim);
        self.way.towards(&goal.aim, situation, beliefs)
    }
}
