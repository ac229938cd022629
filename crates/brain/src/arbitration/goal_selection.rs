//! A belief-based brain: identifier, goal selector, adapter (Rodin and Amin, *Intelligent
//! navigation for an autonomous mobile robot*, 1988).
//!
//! * the *identifier* turns percepts into [beliefs](crate::perception::beliefs);
//! * the *goal selector* chooses among the [goals](crate::goals) of the behaviours;
//! * the *adapter* finds a [path](crate::navigation::navigator) there, and avoids other robots.

use crate::arbitration::decided::Decided;
use crate::arbitration::subsumption::Layer;
use crate::behaviours::behaviour::Behaviour;
use crate::behaviours::{Memory, Ready};
use crate::goals::fitness::{Pursuit, Step};
use crate::goals::proposal::{Destination, Proposal};
use crate::goals::{Goal, Goals, Verdict};
use crate::io::agent_id::AgentId;
use crate::io::body::Body;
use crate::io::command::Motion;
use crate::io::message::Message;
use crate::messaging::Messaging;
use crate::messaging::commitment::Commitment;
use crate::messaging::peers::Peers;
use crate::navigation::navigator::Navigator;
use crate::perception::beliefs::{Beliefs, BeliefsSpec};
use crate::perception::dead_reckoning::Odometry;
use crate::service::assignee::Assignee;
use crate::situation::Situation;
use alloc::vec::Vec;
use base::hashed::Hashed;

/// The part of a brain that only robots with beliefs have.
#[derive(Debug, Clone, Hashed)]
pub(crate) struct BeliefBrain {
    pub(crate) beliefs: Beliefs,
    pub(crate) messaging: Messaging,
    pub(crate) selection: GoalSelection,
}

/// The goals of a robot, and the path to the one that it pursues.
#[derive(Debug, Clone, Default, Hashed)]
pub(crate) struct GoalSelection {
    pub(crate) goals: Goals,
    pub(crate) navigator: Navigator,
    pursued: Option<Destination>,
    /// Whether the map is to be marked stale before the next step, in which a goal is tried again.
    doubts_map: bool,
    /// Number of the last goal that the robot chose itself.
    pub(crate) last_goal: u32,
    /// Kept between steps to reuse its allocation.
    #[hashed(skip)]
    pub(crate) proposals: Vec<(usize, Proposal)>,
}

impl BeliefBrain {
    pub(crate) fn new(spec: &BeliefsSpec, body: &Body) -> Self {
        Self {
            beliefs: Beliefs::new(spec, body),
            messaging: Messaging::new(spec, body),
            selection: GoalSelection::default(),
        }
    }

    /// Splits off what behaviours read from what arbitration changes.
    #[inline]
    pub(crate) fn parts(
        brain: Option<&mut Self>,
    ) -> (Option<(&Beliefs, &Peers)>, Option<&mut GoalSelection>) {
        let parts = brain.map(|brain| {
            let known = (&brain.beliefs, &brain.messaging.peers);
            (known, &mut brain.selection)
        });
        parts.unzip()
    }

    /// Marks the map as stale before a goal is tried again.
    pub(crate) fn doubt_map(&mut self) {
        if core::mem::take(&mut self.selection.doubts_map)
            && let Some(map) = &mut self.beliefs.map
        {
            map.occupancy.mark_stale();
        }
    }

    /// Adds the messages of this step to the outbox. The goals of controllers are done when they have
    /// been served, and all others when the robot is there.
    pub(crate) fn publish(
        &mut self,
        elapsed_s: f64,
        service: Option<&Assignee>,
        outbox: &mut Vec<Message>,
    ) {
        let commitment = Commitment {
            goal: self.selection.pursued,
            service,
        };
        self.messaging
            .broadcast(&mut self.beliefs, &commitment, elapsed_s, outbox);
    }

    /// Changes the ids of the other robots; those without a new id are forgotten.
    pub(crate) fn renumber(&mut self, new_id: &impl Fn(AgentId) -> Option<AgentId>) {
        self.beliefs.renumber(new_id);
        self.messaging.renumber(new_id);
    }
}

impl GoalSelection {
    /// Decides by the proposals of this step.
    pub(crate) fn decide(
        &mut self,
        behaviours: &[Ready],
        layers: &mut [Layer<Memory>],
        situation: &Situation,
    ) -> Decided {
        let all = core::mem::take(&mut self.proposals);
        self.navigator.target = None;
        // The highest comes first. A motion there is a reflex; one further down applies only if no
        // destination is proposed.
        let decided = match all.first() {
            None => {
                self.keep_below(0);
                (None, Motion::default())
            }
            Some((behaviour, Proposal::Motion(motion))) => {
                self.keep_below(*behaviour);
                self.interrupt(motion, behaviours, layers, situation);
                (Some(*behaviour), *motion)
            }
            Some((_, Proposal::Destination(_))) => {
                let motion = self.serve(&all, behaviours, layers, situation);
                (self.pursued_behaviour(), motion)
            }
        };
        self.proposals = all;
        decided
    }

    /// Takes a step into account in which a reflex determined the motion. One that holds the robot
    /// in place, such as that of a robot that is charged, stops the clock of the goal.
    fn interrupt(
        &mut self,
        motion: &Motion,
        behaviours: &[Ready],
        layers: &mut [Layer<Memory>],
        situation: &Situation,
    ) {
        self.goals.rest(situation.elapsed_s);
        let (elapsed_s, period_s) = (situation.elapsed_s, situation.body.period_s);
        let moved = self.pursued.filter(|_| *motion != Motion::default());
        if moved.is_some_and(|pursued| self.goals.interrupt(pursued.id, elapsed_s, period_s)) {
            self.notify(behaviours, layers);
        }
    }

    /// Notifies the behaviours of which the goals are not being reached.
    fn notify(&mut self, behaviours: &[Ready], layers: &mut [Layer<Memory>]) {
        let pursued_id = self.pursued.map(|pursued| pursued.id);
        for goal in self.goals.unreported() {
            if let (Some(behaviour), Some(layer)) = (
                behaviours.get(goal.behaviour),
                layers.get_mut(goal.behaviour),
            ) {
                behaviour.judged(layer.memory(), goal.verdict);
            }
            if goal.verdict == Verdict::Impossible && pursued_id == Some(goal.destination.id) {
                self.navigator.discard_plan();
                self.pursued = None;
            }
        }
    }

    pub(crate) fn is_pursued(&self, goal: &Goal) -> bool {
        self.pursued
            .is_some_and(|pursued| pursued.id == goal.destination.id)
    }

    /// Index of the behaviour whose goal the robot pursues.
    pub(crate) fn pursued_behaviour(&self) -> Option<usize> {
        let mut goals = self.goals.list.iter();
        Some(goals.find(|goal| self.is_pursued(goal))?.behaviour)
    }

    /// Keeps only the goals of behaviours below one: those are suppressed, while the ones above
    /// propose nothing.
    pub(crate) fn keep_below(&mut self, behaviour: usize) {
        let goals = &mut self.goals.list;
        goals.retain(|goal| goal.behaviour < behaviour);
        let is_kept =
            |pursued: &Destination| goals.iter().any(|goal| goal.destination.id == pursued.id);
        self.pursued = self.pursued.filter(is_kept);
    }

    /// The motion, changed so that the robot keeps clear of other robots.
    pub(crate) fn keep_clear(&mut self, motion: Motion, situation: &Situation) -> Motion {
        let Some(beliefs) = situation.beliefs else {
            return motion;
        };
        let traffic = &mut self.navigator.traffic;
        let odometry = Odometry {
            elapsed_s: situation.elapsed_s,
            speed_m_s: situation.current_speed_m_s,
            turned_rad: situation.turned_rad,
            is_commanded: situation.drive().is_some(),
        };
        traffic.update(&beliefs.others.movers, situation.body, &odometry);
        traffic.limit(motion, situation.body, situation.current_speed_m_s)
    }

    /// The motion towards the goal that is pursued, given the proposals of behaviours by their
    /// indices; a proposed motion can only be the last of them, and is ignored.
    pub(crate) fn serve(
        &mut self,
        proposals: &[(usize, Proposal)],
        behaviours: &[Ready],
        layers: &mut [Layer<Memory>],
        situation: &Situation,
    ) -> Motion {
        let known = situation
            .beliefs
            .and_then(|beliefs| Some((beliefs, beliefs.pose()?)));
        let Some((beliefs, pose)) = known else {
            self.pursued = None;
            return Motion::default();
        };
        let pursued = self.pursued.map(|destination| destination.goal());
        let destinations = proposals
            .iter()
            .filter_map(|(behaviour, proposal)| match proposal {
                Proposal::Destination(destination) => Some((*behaviour, *destination)),
                Proposal::Motion(_) => None,
            });
        let added_m = self.navigator.take_added_m();
        let step = Step {
            at: pose.at,
            deviation_m: pose.deviation_m,
            elapsed_s: situation.elapsed_s,
            period_s: situation.body.period_s,
            unreachable: self.navigator.unreachable_goal(),
            battery_s: beliefs.battery_s(),
            pursued: pursued.map(|goal| Pursuit {
                goal,
                remaining_m: self.navigator.remaining_m(pose.at, goal),
                added_m,
            }),
            noise_m: 0.0,
        };
        self.goals.update(destinations, &step);
        self.notify(behaviours, layers);
        self.pursued = None;
        let Some(goal) = self.goals.select(pose.at) else {
            return Motion::default();
        };
        let destination = goal.destination;
        self.doubts_map = self.goals.begin(&destination);
        if self.doubts_map {
            self.navigator.discard_plan();
            return Motion::default();
        }
        self.pursued = Some(destination);
        let is_retry = self.goals.is_retried(&destination);
        self.navigator
            .drive_to((&destination, is_retry), situation, beliefs)
    }
}
