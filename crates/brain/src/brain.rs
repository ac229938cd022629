//! The brain of one robot.

use crate::arbitration::Arbitration;
use crate::arbitration::goal_selection::{BeliefBrain, GoalSelection};
use crate::arbitration::motor_schemas::{Noise, Sum};
use crate::arbitration::subsumption::{Layer, arbitrate, layers, proposals};
use crate::behaviours::{BehaviourSpec, Memory, Ready, flock};
use crate::goals::proposal::Proposal;
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
/// A clone has the same memories and then goes its own way; all clones share what is the same for
/// the kind of robot. So for a team, make one and clone it: each robot then takes some 100 bytes, and
/// what it believes, if it believes anything.
#[derive(Debug, Clone)]
pub struct Brain {
    kind: Arc<Kind>,
    moved: DeadReckoning,
    layers: Box<[Layer<Memory>]>,
    mind: Option<Box<BeliefBrain>>,
    /// If what behaviours want is summed.
    noise: Option<Box<Noise>>,
}

/// What is the same for all robots of a kind.
#[derive(Debug)]
struct Kind {
    spec: Arc<BrainSpec>,
    body: Arc<Body>,
    sight: SpeedGovernor,
    behaviours: Vec<Ready>,
    /// If what behaviours want is summed.
    sum: Option<Sum>,
}

impl Brain {
    /// A mind as `spec` says, in such a `body`, that has just been switched on.
    #[must_use]
    pub fn new(spec: Arc<BrainSpec>, body: Arc<Body>) -> Self {
        let ready = spec.behaviours.iter().map(|each| each.ready(&body));
        let behaviours: Vec<Ready> = ready.collect();
        let sum = sum(&spec);
        Self {
            moved: DeadReckoning::default(),
            layers: layers(&behaviours),
            mind: mind(&spec, &body),
            noise: sum.is_some().then(Box::default),
            kind: Arc::new(Kind {
                sight: SpeedGovernor::new(&body),
                spec,
                body,
                behaviours,
                sum,
            }),
        }
    }

    /// The same mind, briefed as `told` is: both are of the same spec, in the same body but for what
    /// they know of others.
    #[must_use]
    pub fn rebriefed(&self, told: &Self) -> Self {
        Self {
            kind: Arc::clone(&told.kind),
            ..self.clone()
        }
    }

    /// What it was made of.
    #[must_use]
    pub fn spec(&self) -> &BrainSpec {
        &self.kind.spec
    }

    /// What it knows of its body.
    #[must_use]
    pub fn body(&self) -> &Body {
        &self.kind.body
    }

    /// Whether it believes and wants anything.
    #[must_use]
    pub fn has_mind(&self) -> bool {
        self.mind.is_some()
    }

    /// What it believes and wants; `None` if it has no mind.
    #[must_use]
    pub fn thoughts(&self) -> Option<BeliefState> {
        self.mind.as_deref().map(BeliefState::of)
    }

    /// The map in its mind; `None` if it has none.
    #[must_use]
    pub fn map(&self) -> Option<BelievedMap> {
        let map = self.mind.as_deref()?.beliefs.map.as_ref()?;
        Some(BelievedMap::of(map))
    }

    /// What it would decide now, and why; the brain itself does not step.
    #[must_use]
    pub fn decision(&self, percept: &Percept) -> Decision {
        let mut brain = self.clone();
        let mut command = Command::default();
        let leading = brain.lead_into(percept, &mut command);
        Decision {
            command,
            leading: leading.and_then(|place| u32::try_from(place).ok()),
            holds_s: brain.layers.iter().map(Layer::holds_s).collect(),
            thoughts: brain.thoughts(),
        }
    }

    /// Robots have other numbers from now on; what is remembered of one that is gone is forgotten.
    pub fn renumber(&mut self, now: impl Fn(RobotId) -> Option<RobotId>) {
        if let Some(mind) = &mut self.mind {
            mind.beliefs.renumber(&now);
        }
    }

    /// How it goes with the others, if it does nothing else: then its commands are what this says,
    /// whatever else it may know.
    #[must_use]
    pub fn flock(&self) -> Option<&flock::Ready> {
        match self.kind.behaviours.as_slice() {
            [Ready::Flock(ready)] if self.kind.body.rings.is_empty() && self.mind.is_none() => {
                Some(ready)
            }
            _ => None,
        }
    }

    /// What the robot is to do, given what it knows; called once in each of the body's periods.
    ///
    /// Whatever the percept holds, the command holds finite numbers within the body's limits.
    pub fn step(&mut self, percept: &Percept) -> Command {
        let mut command = Command::default();
        self.step_into(percept, &mut command);
        command
    }

    /// As [`Brain::step`], into a command whose memory is used again.
    pub fn step_into(&mut self, percept: &Percept, command: &mut Command) {
        self.lead_into(percept, command);
    }

    /// The same; returns the behaviour that has its way, if it is one.
    #[inline]
    fn lead_into(&mut self, percept: &Percept, command: &mut Command) -> Option<usize> {
        command.requests.clear();
        command.outbox.clear();
        let (leading, motion) = self.motion(percept);
        command.motion = motion;
        self.moved.told(command.motion, &self.kind.body);
        if let Some(mind) = &mut self.mind {
            mind.tell(self.kind.body.period_s, &mut command.outbox);
        }
        leading
    }

    #[inline]
    fn motion(&mut self, percept: &Percept) -> (Option<usize>, Motion) {
        let Kind {
            spec,
            body,
            sight,
            behaviours,
            sum,
        } = &*self.kind;
        let mut turned_rad = self.moved.take_in(percept, body);
        let now_m_s = self.moved.now_m_s(percept, body);
        if let Some(mind) = &mut self.mind {
            let moved = &self.moved;
            turned_rad = moved.turned_beside_compass_rad(turned_rad, percept, body);
            let moved = [moved.gone_m_s(percept, body), turned_rad];
            mind.beliefs.take_in(percept, body, &sight.rings, moved);
        }
        let (beliefs, mut wants) = match self.mind.as_deref_mut() {
            Some(BeliefBrain { beliefs, wants }) => (Some(&*beliefs), Some(wants)),
            None => (None, None),
        };
        let situation = Situation {
            percept,
            body,
            beliefs,
            rings: &sight.rings,
            ahead: sight.ahead(percept, body, now_m_s),
            turned_rad,
            now_m_s,
        };
        let (leading, wanted) = match (sum.as_ref().zip(self.noise.as_deref_mut()), &mut wants) {
            (Some((sum, noise)), _) => {
                let motion = sum.motion(behaviours, &mut self.layers, noise, &situation);
                (None, motion)
            }
            (None, None) => moved(arbitrate(behaviours, &mut self.layers, &situation)),
            (None, Some(wants)) => chosen(spec, behaviours, (&mut self.layers, wants), &situation),
        };
        let mut motion = possible(wanted, body);
        if spec.limit_speed_to_stopping_distance {
            motion = sight.limited(motion, &situation, &self.moved);
        }
        if let (Some(beliefs), Some(wants)) = (beliefs, wants) {
            let traffic = &mut wants.way.traffic;
            traffic.look(&beliefs.others.movers, body, [now_m_s, turned_rad]);
            motion = traffic.limited(motion, body, now_m_s);
        }
        (leading, possible(motion, body))
    }
}

/// What one without a mind does, and the behaviour that wants it: it cannot be somewhere on purpose.
fn moved(wanted: Option<(usize, Proposal)>) -> (Option<usize>, Motion) {
    match wanted {
        Some((behaviour, Proposal::Motion(motion))) => (Some(behaviour), motion),
        _ => (None, Motion::default()),
    }
}

/// What one with a mind does, and the behaviour that wants it.
fn chosen(
    spec: &BrainSpec,
    behaviours: &[Ready],
    (layers, wants): (&mut [Layer<Memory>], &mut GoalSelection),
    situation: &Situation,
) -> (Option<usize>, Motion) {
    let mut all = core::mem::take(&mut wants.proposals);
    wants.way.turned_to = None;
    match spec.arbitration {
        Arbitration::Goals => proposals(behaviours, layers, situation, &mut all),
        Arbitration::Subsumption | Arbitration::Schemas(_) => {
            all.clear();
            all.extend(arbitrate(behaviours, layers, situation));
        }
    }
    // The highest comes first: a motion there is a reflex, and one further down what is left to do.
    let decided = match all.first() {
        None => {
            wants.keep_below(0);
            (None, Motion::default())
        }
        Some((behaviour, Proposal::Motion(motion))) => {
            wants.keep_below(*behaviour);
            (Some(*behaviour), *motion)
        }
        Some((_, Proposal::Destination(_))) => {
            let motion = wants.serve(&all, behaviours, layers, situation);
            (wants.pursued(), motion)
        }
    };
    wants.proposals = all;
    decided
}

/// The sum of what behaviours want, if the scenario asks for one.
fn sum(spec: &BrainSpec) -> Option<Sum> {
    let Arbitration::Schemas(schemas) = &spec.arbitration else {
        return None;
    };
    let names = spec.behaviours.iter().map(BehaviourSpec::name);
    Some(Sum::new(schemas, names))
}

/// A mind, if the scenario asks for one or a behaviour needs it.
fn mind(spec: &BrainSpec, body: &Body) -> Option<Box<BeliefBrain>> {
    let mut behaviours = spec.behaviours.iter();
    let is_needed = spec.beliefs.is_some() || behaviours.any(BehaviourSpec::needs_beliefs);
    let beliefs = spec.beliefs.clone().unwrap_or_default();
    is_needed.then(|| Box::new(BeliefBrain::new(&beliefs, body)))
}

/// Within the body's limits; nonsense is 0.
fn possible(wanted: Motion, body: &Body) -> Motion {
    let within = |value: f64, least: f64, most: f64| {
        let value = value.max(least).min(most);
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
    fn a_brain_of_three_behaviours_takes_some_hundred_bytes() {
        let layer = size_of::<Layer<Memory>>();
        let all = size_of::<Brain>() + 3 * layer;
        assert!(all <= 136, "{all} bytes, {layer} a layer");
    }
}
