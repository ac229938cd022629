//! The brain of one robot.

use crate::arbitration::arbiter::{Arbiter, ArbitrationMemory};
use crate::arbitration::goal_selection::BeliefBrain;
use crate::arbitration::motor_schemas::Noise;
use crate::arbitration::subsumption::{Layer, layers};
use crate::behaviours::{BehaviourSpec, Memory, Ready, flock};
use crate::inspect::BeliefState;
use crate::inspect::BelievedMap;
use crate::inspect::Decision;
use crate::io::body::{Body, RobotId};
use crate::io::command::{Command, Motion};
use crate::io::percept::Percept;
use crate::navigation::speed_governor::SpeedGovernor;
use crate::perception::dead_reckoning::DeadReckoning;
use crate::perception::situation::Situation;
use crate::spec::BrainSpec;
use alloc::boxed::Box;
use alloc::sync::Arc;
use alloc::vec::Vec;

/// The brain of one robot.
///
/// A clone starts with the same memory, and is independent from then on; all clones share what is
/// the same for their kind of robot. For a team, create one brain and clone it: each robot then
/// takes about 100 bytes, plus its beliefs if it has any.
#[derive(Debug, Clone)]
pub struct Brain {
    kind: Arc<Kind>,
    odometry: DeadReckoning,
    layers: Box<[Layer<Memory>]>,
    beliefs: Option<Box<BeliefBrain>>,
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
            noise: matches!(arbiter, Arbiter::Schemas(_)).then(Box::default),
            kind: Arc::new(Kind {
                governor: SpeedGovernor::new(&body),
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
        Decision {
            command,
            leading: leading.and_then(|place| u32::try_from(place).ok()),
            holds_s: brain.layers.iter().map(Layer::holds_s).collect(),
            belief_state: brain.belief_state(),
        }
    }

    /// Changes the ids of the other robots; those without a new id are forgotten.
    pub fn renumber(&mut self, new_id: impl Fn(RobotId) -> Option<RobotId>) {
        if let Some(brain) = &mut self.beliefs {
            brain.beliefs.renumber(&new_id);
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

    /// The command for a percept; to be called once per period of the body.
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

    /// Like [`Brain::step_into`]; returns the index of the active behaviour, if there is a single
    /// one.
    #[inline]
    fn decide_into(&mut self, percept: &Percept, command: &mut Command) -> Option<usize> {
        command.requests.clear();
        command.outbox.clear();
        let (leading, motion) = self.motion(percept);
        command.motion = motion;
        self.odometry
            .record_command(command.motion, &self.kind.body);
        if let Some(brain) = &mut self.beliefs {
            brain.publish(self.kind.body.period_s, &mut command.outbox);
        }
        leading
    }

    #[inline]
    fn motion(&mut self, percept: &Percept) -> (Option<usize>, Motion) {
        let Kind {
            spec,
            body,
            governor,
            behaviours,
            arbiter,
        } = &*self.kind;
        let mut turned_rad = self.odometry.update(percept, body);
        let current_speed_m_s = self.odometry.current_speed_m_s(percept, body);
        if let Some(brain) = &mut self.beliefs {
            let odometry = &self.odometry;
            turned_rad = odometry.turned_without_compass_rad(turned_rad, percept, body);
            let moved = [odometry.likely_speed_m_s(percept, body), turned_rad];
            brain.beliefs.update(percept, body, &governor.rings, moved);
        }
        let (beliefs, mut selection) = match self.beliefs.as_deref_mut() {
            Some(BeliefBrain { beliefs, selection }) => (Some(&*beliefs), Some(selection)),
            None => (None, None),
        };
        let situation = Situation {
            percept,
            body,
            beliefs,
            rings: &governor.rings,
            ahead: governor.ahead(percept, body, current_speed_m_s),
            turned_rad,
            current_speed_m_s,
        };
        let memory = ArbitrationMemory {
            layers: &mut self.layers,
            noise: self.noise.as_deref_mut(),
            selection: selection.as_deref_mut(),
        };
        let (leading, wanted) = arbiter.decide(behaviours, memory, &situation);
        let mut motion = clamped(wanted, body);
        if spec.limit_speed_to_stopping_distance {
            motion = governor.limit(motion, &situation, &self.odometry);
        }
        if let (Some(beliefs), Some(selection)) = (beliefs, selection) {
            let traffic = &mut selection.navigator.traffic;
            traffic.update(
                &beliefs.others.movers,
                body,
                [current_speed_m_s, turned_rad],
            );
            motion = traffic.limit(motion, body, current_speed_m_s);
        }
        (leading, clamped(motion, body))
    }
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
    fn a_brain_of_three_behaviours_takes_at_most_136_bytes() {
        let layer = size_of::<Layer<Memory>>();
        let all = size_of::<Brain>() + 3 * layer;
        assert!(all <= 136, "{all} bytes, {layer} a layer");
    }
}
