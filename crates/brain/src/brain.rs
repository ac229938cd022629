//! The brain of one robot.

use crate::arbitration::arbiter::{Arbiter, ArbitrationMemory};
use crate::arbitration::decided::Decided;
use crate::arbitration::goal_selection::BeliefBrain;
use crate::arbitration::motor_schemas::Noise;
use crate::arbitration::subsumption::{Layer, heading_rad, layers};
use crate::behaviours::behaviour::Behaviour;
use crate::behaviours::{BehaviourSpec, Memory, Ready, flock};
use crate::goals::orders::AssignedGoal;
use crate::inspect::BeliefState;
use crate::inspect::BelievedMap;
use crate::inspect::Decision;
use crate::io::agent_id::AgentId;
use crate::io::body::Body;
use crate::io::command::{Command, Motion};
use crate::io::goal_id::GoalId;
use crate::io::percept::Percept;
use crate::messaging::peers::Peers;
use crate::navigation::speed_governor::SpeedGovernor;
use crate::perception::beliefs::{Beliefs, Localisation};
use crate::perception::dead_reckoning::{DeadReckoning, Odometry};
use crate::service::assignee::Assignee;
use crate::service::served::ServedGoal;
use crate::situation::Situation;
use crate::spec::BrainSpec;
use alloc::boxed::Box;
use alloc::sync::Arc;
use alloc::vec::Vec;
use base::hash::Hash;
use base::hashed::Hashed;
use core::cell::Cell;

/// The brain of one robot.
///
/// A clone starts with the same memory, and is independent from then on; all clones share what is
/// the same for their kind of robot. For a team, create one brain and clone it: each robot then
/// takes about 170 bytes, plus its beliefs if it has any.
#[derive(Debug, Clone)]
pub struct Brain {
    kind: Arc<Kind>,
    odometry: DeadReckoning,
    layers: Box<[Layer<Memory>]>,
    beliefs: Option<Box<BeliefBrain>>,
    /// Its estimate of the pose, if it has no beliefs and needs one: see [`Kind::needs_estimate`].
    localisation: Option<Box<Localisation>>,
    /// With motor schemas only.
    noise: Option<Box<Noise>>,
}

/// The part of a brain that all robots of a kind share.
#[derive(Debug)]
struct Kind {
    spec: Arc<BrainSpec>,
    body: Arc<Body>,
    governor: SpeedGovernor,
    behaviours: Vec<Ready>,
    /// Index of the highest behaviour that takes a person's orders.
    order_taker: Option<usize>,
    /// The same for the behaviour that serves the goals of controllers.
    server: Option<usize>,
    drives_to_places: bool,
    /// Whether one reading of the position is not enough to know that the robot is at a place.
    needs_filter: bool,
    arbiter: Arbiter,
}

impl Brain {
    /// The brain that a specification describes, in a body; it has just been switched on.
    #[must_use]
    pub fn new(spec: Arc<BrainSpec>, body: Arc<Body>) -> Self {
        let ready = spec.behaviours.iter().map(|each| each.ready(&body));
        let behaviours: Vec<Ready> = ready.collect();
        let arbiter = Arbiter::new(&spec);
        Self {
            odometry: DeadReckoning::default(),
            layers: layers(&behaviours),
            beliefs: belief_brain(&spec, &body),
            localisation: None,
            noise: matches!(arbiter, Arbiter::Schemas(_)).then(Box::default),
            kind: Arc::new(Kind {
                governor: SpeedGovernor::new(&body),
                order_taker: highest(&spec, BehaviourSpec::takes_orders),
                server: highest(&spec, BehaviourSpec::serves_controllers),
                drives_to_places: spec.behaviours.iter().any(BehaviourSpec::needs_pose),
                needs_filter: spec.needs_filter(body.position_error_m()),
                spec,
                body,
                behaviours,
                arbiter,
            }),
        }
    }

    /// This brain with the specification and body of another brain, which may differ only in the
    /// parts that describe other robots.
    #[must_use]
    pub fn rebriefed(&self, other: &Self) -> Self {
        Self {
            kind: Arc::clone(&other.kind),
            ..self.clone()
        }
    }

    /// The specification.
    #[must_use]
    pub fn spec(&self) -> &BrainSpec {
        &self.kind.spec
    }

    /// The body.
    #[must_use]
    pub fn body(&self) -> &Body {
        &self.kind.body
    }

    /// Whether it has beliefs and goals.
    #[must_use]
    pub fn has_beliefs(&self) -> bool {
        self.beliefs.is_some()
    }

    /// Its beliefs and goals; `None` if it has none.
    #[must_use]
    pub fn belief_state(&self) -> Option<BeliefState> {
        self.beliefs.as_deref().map(BeliefState::of)
    }

    /// Adds its beliefs and goals to a hash; nothing if it has none.
    pub fn hash_beliefs(&self, hash: &mut Hash) {
        if let Some(brain) = &self.beliefs {
            brain.add_to(hash);
            self.assigned_goals().add_to(hash);
        }
        if let Some(assignee) = self.assignee() {
            assignee.add_to(hash);
        }
    }

    fn assignee(&self) -> Option<&Assignee> {
        self.kind.assignee(&self.layers)
    }

    /// The goals of controllers that it serves, in the order in which it serves them; none if it has
    /// no behaviour `serve`.
    #[must_use]
    pub fn served_goals(&self) -> Vec<ServedGoal> {
        self.assignee().map(Assignee::served).unwrap_or_default()
    }

    /// The goals of controllers that it has served, as far as it reports them: until the owner has acknowledged that.
    pub fn finished_goals(&self) -> impl Iterator<Item = GoalId> {
        let assignees = self.assignee().into_iter();
        assignees.flat_map(|assignee| assignee.finished.reported())
    }

    /// The goals of controllers that it serves no longer although it has not served them, until the operator has
    /// acknowledged its report of that.
    pub fn returned_goals(&self) -> impl Iterator<Item = GoalId> {
        let assignees = self.assignee().into_iter();
        assignees.flat_map(|assignee| assignee.returned.goals())
    }

    /// The goals that a person has assigned, in the order of assignment; none if no behaviour of the
    /// brain takes orders.
    #[must_use]
    pub fn assigned_goals(&self) -> Vec<AssignedGoal> {
        let goals = self.kind.order_taker.and_then(|place| {
            let (behaviour, layer) = (self.kind.behaviours.get(place)?, self.layers.get(place)?);
            Some(behaviour.assigned_goals(layer.memory_now()))
        });
        goals.unwrap_or_default()
    }

    /// Its map; `None` if it has none.
    #[must_use]
    pub fn map(&self) -> Option<BelievedMap> {
        let map = self.beliefs.as_deref()?.beliefs.map.as_ref()?;
        Some(BelievedMap::of(map))
    }

    /// The decision that it would make now, and its reasons; the brain itself does not step.
    #[must_use]
    pub fn decision(&self, percept: &Percept) -> Decision {
        let mut brain = self.clone();
        let mut command = Command::default();
        let leading = brain.decide_into(percept, &mut command);
        let period_s = brain.kind.body.period_s;
        let holds_s = brain.layers.iter().map(|layer| layer.holds_s(period_s));
        Decision {
            command,
            leading: leading.and_then(|place| u32::try_from(place).ok()),
            holds_s: holds_s.collect(),
            belief_state: brain.belief_state(),
        }
    }

    /// Changes the ids of the other robots; those without a new id are forgotten.
    pub fn renumber(&mut self, new_id: impl Fn(AgentId) -> Option<AgentId>) {
        if let Some(brain) = &mut self.beliefs {
            brain.renumber(&new_id);
        }
        if let Some((behaviour, layer)) = self.kind.server(&mut self.layers) {
            behaviour.renumber(layer.memory(), &new_id);
        }
    }

    /// Its flocking behaviour, if it has no other and no beliefs or range sensors: its commands
    /// then depend on nothing else.
    #[must_use]
    pub fn flock(&self) -> Option<&flock::Ready> {
        match self.kind.behaviours.as_slice() {
            [Ready::Flock(ready)] if self.kind.body.rings.is_empty() && self.beliefs.is_none() => {
                Some(ready)
            }
            _ => None,
        }
    }

    /// The command for a percept.
    ///
    /// Percepts may come at any times: everything in the brain that takes time follows
    /// [`Percept::time_s`]. Between two percepts, the last command counts as executed. Stopping
    /// distances and turn rates are those of [`Body::period_s`], so percepts should not come more
    /// rarely than that for long.
    ///
    /// A percept with a time that is not later than that of the last one, or not finite, changes
    /// nothing. The command then repeats the last motion and heading, without requests and messages:
    /// those were in the last command.
    ///
    /// Whatever the percept contains, the command contains finite numbers within the body's limits.
    pub fn step(&mut self, percept: &Percept) -> Command {
        let mut command = Command::default();
        self.step_into(percept, &mut command);
        command
    }

    /// Like [`Brain::step`], but reuses the allocations of a command.
    pub fn step_into(&mut self, percept: &Percept, command: &mut Command) {
        self.decide_into(percept, command);
    }

    /// Whether [`Brain::step`] decides by a percept: see there.
    #[must_use]
    pub fn is_later(&self, percept: &Percept) -> bool {
        self.odometry.is_later(percept.time_s)
    }

    /// The command that [`Brain::step`] returns for a percept that is not later than the last one.
    #[must_use]
    pub fn last_command(&self) -> Command {
        let mut command = Command::default();
        self.repeat_into(&mut command);
        command
    }

    /// Leaves out a percept for which the decision is made elsewhere: the time since the previous
    /// percept does not count.
    pub fn skip(&mut self, percept: &Percept) {
        self.odometry
            .elapsed_s(percept.time_s, self.kind.body.period_s);
    }

    /// Like [`Brain::step_into`]; returns the index of the active behaviour, if there is a single
    /// one.
    #[inline]
    fn decide_into(&mut self, percept: &Percept, command: &mut Command) -> Option<usize> {
        command.requests.clear();
        command.outbox.clear();
        command.acts.clear();
        let period_s = self.kind.body.period_s;
        let Some(elapsed_s) = self.odometry.elapsed_s(percept.time_s, period_s) else {
            self.repeat_into(command);
            return None;
        };
        let (leading, motion) = self.motion(percept, elapsed_s);
        self.odometry.record_command(motion);
        self.odometry.decided_by = leading.and_then(|place| u16::try_from(place).ok());
        self.repeat_into(command);
        if let Some(brain) = &mut self.beliefs {
            let service = self.kind.assignee(&self.layers);
            brain.publish(elapsed_s, service, &mut command.outbox);
        }
        if let Some((behaviour, layer)) = self.kind.server(&mut self.layers) {
            behaviour.publish(layer.memory(), command);
        }
        leading
    }

    /// Writes the motion in force, and the heading that it turns to.
    #[inline]
    fn repeat_into(&self, command: &mut Command) {
        command.motion = self.odometry.command();
        let is_turning = command.motion.turn_rate_rad_s != 0.0;
        let active = self.odometry.decided_by.filter(|_| is_turning);
        command.heading_rad = active
            .and_then(|active| heading_rad(&self.kind.behaviours, &self.layers, active.into()));
    }

    /// The motion that the percept leads to, and the index of the active behaviour.
    #[inline]
    fn motion(&mut self, percept: &Percept, elapsed_s: f64) -> Decided {
        let kind = &*self.kind;
        let mut moved = self.odometry.reckon(percept, &kind.body, elapsed_s);
        if let Some(brain) = self.beliefs.as_deref_mut() {
            kind.believe(brain, &self.odometry, percept, &mut moved);
        } else if self.localisation.is_some() || kind.needs_estimate(&moved) {
            let localisation = self.localisation.get_or_insert_default();
            kind.localise(localisation, &self.odometry, percept, &mut moved);
        }
        let (known, mut selection) = BeliefBrain::parts(self.beliefs.as_deref_mut());
        let last_goal = Cell::new(selection.as_ref().map_or(0, |each| each.last_goal));
        let mut situation = kind.situation(percept, known, &moved, &last_goal);
        if known.is_none() {
            situation.localisation = self.localisation.as_deref();
        }
        kind.serve_orders(&mut self.layers, &situation);
        if let Some((behaviour, layer)) = kind.server(&mut self.layers) {
            behaviour.communicate(layer.memory(), &situation);
        }
        let memory = ArbitrationMemory {
            layers: &mut self.layers,
            noise: self.noise.as_deref_mut(),
            selection: selection.as_deref_mut(),
        };
        let (leading, wanted) = kind.arbiter.decide(&kind.behaviours, memory, &situation);
        let mut motion = clamped(wanted, &kind.body);
        if kind.spec.limit_speed_to_stopping_distance {
            motion = kind.governor.limit(motion, &situation, &self.odometry);
        }
        if let Some(selection) = selection {
            selection.last_goal = last_goal.get();
            motion = selection.keep_clear(motion, &situation);
        }
        (leading, clamped(motion, &kind.body))
    }
}

impl Kind {
    /// Whether a brain without beliefs begins to estimate its pose: if a behaviour drives to places, and
    /// one reading of the position is not enough for that, or the robot does not measure its own motion.
    fn needs_estimate(&self, moved: &Odometry) -> bool {
        self.drives_to_places && (moved.is_commanded || self.needs_filter)
    }

    /// Updates the pose of a brain without beliefs.
    fn localise(
        &self,
        localisation: &mut Localisation,
        odometry: &DeadReckoning,
        percept: &Percept,
        moved: &mut Odometry,
    ) {
        let likely = odometry.likely(percept, &self.body, moved);
        moved.turned_rad = localisation.step(percept, &self.body, &likely).turned_rad;
    }

    /// Updates the beliefs with a percept and its messages. A noisy compass corrects the believed
    /// heading, so its readings are taken out of the turn.
    fn believe(
        &self,
        brain: &mut BeliefBrain,
        odometry: &DeadReckoning,
        percept: &Percept,
        moved: &mut Odometry,
    ) {
        let body = &*self.body;
        let likely = odometry.likely(percept, body, moved);
        brain.doubt_map();
        let BeliefBrain {
            beliefs, messaging, ..
        } = brain;
        let executed = beliefs.update(percept, body, &self.governor.rings, &likely);
        moved.turned_rad = executed.turned_rad;
        messaging.receive(percept, body, moved.elapsed_s, beliefs);
    }

    #[inline]
    fn situation<'s>(
        &'s self,
        percept: &'s Percept,
        known: Option<(&'s Beliefs, &'s Peers)>,
        moved: &Odometry,
        last_goal: &'s Cell<u32>,
    ) -> Situation<'s> {
        let (body, governor) = (&*self.body, &self.governor);
        let (beliefs, peers) = known.unzip();
        Situation {
            percept,
            body,
            beliefs,
            localisation: beliefs.map(|beliefs| &beliefs.localisation),
            peers,
            rings: &governor.rings,
            last_goal,
            ahead: governor.ahead(percept, body, moved.speed_m_s),
            elapsed_s: moved.elapsed_s,
            turned_rad: moved.turned_rad,
            current_speed_m_s: moved.speed_m_s,
        }
    }

    /// The behaviour that serves the goals of controllers.
    #[inline]
    fn server<'k, 'l>(
        &'k self,
        layers: &'l mut [Layer<Memory>],
    ) -> Option<(&'k Ready, &'l mut Layer<Memory>)> {
        let place = self.server?;
        self.behaviours.get(place).zip(layers.get_mut(place))
    }

    /// The memory of that behaviour.
    #[inline]
    fn assignee<'l>(&self, layers: &'l [Layer<Memory>]) -> Option<&'l Assignee> {
        let place = self.server?;
        let (behaviour, layer) = (self.behaviours.get(place)?, layers.get(place)?);
        behaviour.assignee(layer.memory_now())
    }

    /// Passes a person's orders to the behaviour that takes them.
    #[inline]
    fn serve_orders(&self, layers: &mut [Layer<Memory>], situation: &Situation) {
        let behaviours = &self.behaviours;
        let taker = self
            .order_taker
            .and_then(|place| behaviours.get(place).zip(layers.get_mut(place)));
        if let Some((behaviour, layer)) = taker {
            behaviour.serve_orders(layer.memory(), situation);
        }
    }
}

/// Index of the highest behaviour with a property.
fn highest(spec: &BrainSpec, has: impl FnMut(&BehaviourSpec) -> bool) -> Option<usize> {
    spec.behaviours.iter().rposition(has)
}

/// The beliefs and goals, if the specification has beliefs or a behaviour needs them.
fn belief_brain(spec: &BrainSpec, body: &Body) -> Option<Box<BeliefBrain>> {
    let mut behaviours = spec.behaviours.iter();
    let is_needed = spec.beliefs.is_some() || behaviours.any(BehaviourSpec::needs_beliefs);
    let beliefs = spec.beliefs.clone().unwrap_or_default();
    is_needed.then(|| Box::new(BeliefBrain::new(&beliefs, body)))
}

/// A motion within the body's limits; numbers that are not finite become 0.
fn clamped(wanted: Motion, body: &Body) -> Motion {
    let within = |value: f64, min: f64, max: f64| {
        let value = value.max(min).min(max);
        // Adding 0 makes -0 a plain 0.
        if value.is_finite() { value + 0.0 } else { 0.0 }
    };
    let turn = body.max_turn_rate_rad_s;
    let back = -body.max_reverse_speed_m_s;
    Motion {
        speed_m_s: within(wanted.speed_m_s, back, body.max_speed_m_s),
        turn_rate_rad_s: within(wanted.turn_rate_rad_s, -turn, turn),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_brain_of_three_behaviours_takes_at_most_168_bytes() {
        let layer = size_of::<Layer<Memory>>();
        let all = size_of::<Brain>() + 3 * layer;
        assert!(all <= 168, "{all} bytes, {layer} a layer");
    }
}
