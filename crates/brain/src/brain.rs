//! The mind of one robot.

use crate::behaviours::{Memory, Ready, swarm};
use crate::body::Body;
use crate::command::{Command, Motion};
use crate::percept::Percept;
use crate::reckoning::Reckoning;
use crate::senses::Senses;
use crate::sight::Sight;
use crate::spec::BrainSpec;
use crate::subsumption::{Layer, arbitrate, layers};
use alloc::boxed::Box;
use alloc::sync::Arc;
use alloc::vec::Vec;

/// The mind of one robot.
///
/// A clone has the same memories and then goes its own way; all clones share what is the same for
/// the kind of robot. So for a team, make one and clone it: each robot then takes some 100 bytes.
#[derive(Debug, Clone)]
pub struct Brain {
    kind: Arc<Kind>,
    moved: Reckoning,
    layers: Box<[Layer<Memory>]>,
}

/// What is the same for all robots of a kind.
#[derive(Debug)]
struct Kind {
    spec: Arc<BrainSpec>,
    body: Arc<Body>,
    sight: Sight,
    behaviours: Vec<Ready>,
}

impl Brain {
    /// A mind as `spec` says, in such a `body`, that has just been switched on.
    #[must_use]
    pub fn new(spec: Arc<BrainSpec>, body: Arc<Body>) -> Self {
        let ready = spec.behaviours.iter().map(|each| each.ready(&body));
        let behaviours: Vec<Ready> = ready.collect();
        Self {
            moved: Reckoning::default(),
            layers: layers(&behaviours),
            kind: Arc::new(Kind {
                sight: Sight::new(&body),
                spec,
                body,
                behaviours,
            }),
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

    /// How it goes with the others, if it does nothing else: then its commands are what this says,
    /// whatever else it may know.
    #[must_use]
    pub fn swarm(&self) -> Option<&swarm::Ready> {
        match self.kind.behaviours.as_slice() {
            [Ready::Swarm(ready)] if self.kind.body.rings.is_empty() => Some(ready),
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
        command.requests.clear();
        command.outbox.clear();
        command.motion = self.motion(percept);
        self.moved.told(command.motion, &self.kind.body);
    }

    fn motion(&mut self, percept: &Percept) -> Motion {
        let Kind { body, sight, .. } = &*self.kind;
        let turned_rad = self.moved.take_in(percept, body);
        let now_m_s = self.moved.now_m_s(percept, body);
        let senses = Senses {
            percept,
            body,
            rings: &sight.rings,
            ahead: sight.ahead(percept, body, now_m_s),
            turned_rad,
            now_m_s,
        };
        let wanted = arbitrate(&self.kind.behaviours, &mut self.layers, &senses);
        let mut motion = possible(wanted, body);
        if self.kind.spec.speed_limited_by_sight {
            motion = sight.limited(motion, &senses, &self.moved);
        }
        possible(motion, body)
    }
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
        assert!(all <= 112, "{all} bytes, {layer} a layer");
    }
}
