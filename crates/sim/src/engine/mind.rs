//! A robot's brain, and what waits for it.

use super::air::Sent;
use super::waiting::{Late, Waiting};
use crate::body::kind::Kind;
use crate::sensing::{Measure, Sensor};
use brain::{self, Brain, Contact, Heard, Motion, Neighbour, Percept, RobotId, SensorRequest};
use std::collections::BTreeMap;

/// What decides for one robot.
#[derive(Debug, Clone)]
pub(crate) struct Mind {
    pub(crate) brain: Brain,
    /// What it wants until it steps again.
    pub(crate) wanted: Motion,
    /// A bit for each sensor that is switched off.
    pub(crate) sensors_off: u32,
    /// What has been measured or heard and has not reached the brain. Most kinds of robots never
    /// have any.
    pub(crate) backlog: Option<Box<Backlog>>,
}

impl Mind {
    pub(crate) fn new(kind: &Kind) -> Self {
        Self {
            brain: kind.brain.clone(),
            wanted: Motion::default(),
            sensors_off: 0,
            backlog: kind.needs_backlog().then(|| Box::new(Backlog::new(kind))),
        }
    }

    pub(crate) fn switch(&mut self, request: SensorRequest) {
        let bit = 1_u32.checked_shl(request.sensor.into()).unwrap_or(0);
        if request.on {
            self.sensors_off &= !bit;
        } else {
            self.sensors_off |= bit;
        }
    }

    /// Takes a message that arrives now, unless the radio has heard enough in this step.
    pub(crate) fn hear(&mut self, sent: &Sent, now: u64, most: usize) {
        let Some(backlog) = &mut self.backlog else {
            return;
        };
        let inbox = &mut backlog.inbox;
        inbox.forget(now);
        if inbox
            .lates
            .iter()
            .rev()
            .take_while(|late| late.due == now)
            .count()
            < most
        {
            inbox.lates.push(Late {
                taken: sent.at,
                due: now,
                what: sent.heard,
            });
        }
    }

    /// Adds what others told to a percept from outside.
    pub(crate) fn tell_messages(&mut self, now: u64, step_s: f64, to: &mut Percept) {
        if let Some(backlog) = &mut self.backlog {
            backlog.tell_messages(now, step_s, to);
        }
    }

    /// Makes room for what is recognised in a step in which the brain does not step.
    pub(crate) fn forget(&mut self, now: u64) {
        if let Some(backlog) = &mut self.backlog {
            backlog.looks.forget(now);
            backlog.contacts.forget(now);
            backlog.neighbours.forget(now);
        }
    }

    pub(crate) fn wait_look(&mut self, late: Late<brain::Look>) {
        if let Some(backlog) = &mut self.backlog {
            backlog.looks.lates.push(late);
        }
    }

    pub(crate) fn wait_contact(&mut self, late: Late<(Contact, Option<u32>)>) {
        if let Some(backlog) = &mut self.backlog {
            backlog.contacts.lates.push(late);
        }
    }

    pub(crate) fn wait_neighbour(&mut self, late: Late<Neighbour>) {
        if let Some(backlog) = &mut self.backlog {
            backlog.neighbours.lates.push(late);
        }
    }

    /// Items have other numbers from now on; what was seen of one that is gone is forgotten.
    pub(crate) fn renumber_items(&mut self, numbers: &BTreeMap<usize, usize>) {
        if let Some(backlog) = &mut self.backlog {
            backlog.contacts.lates.retain_mut(|late| {
                let Some(item) = &mut late.what.1 else {
                    return true;
                };
                let number = numbers.get(&(*item as usize));
                let number = number.and_then(|number| u32::try_from(*number).ok());
                number.inspect(|number| *item = *number).is_some()
            });
        }
    }

    /// Robots have other numbers from now on; what was seen and heard of one that is gone is
    /// forgotten.
    pub(crate) fn renumber_robots(&mut self, numbers: &BTreeMap<RobotId, RobotId>) {
        self.brain.renumber(|id| numbers.get(&id).copied());
        let renumber = |id: &mut RobotId| numbers.get(id).map(|now| *id = *now).is_some();
        if let Some(backlog) = &mut self.backlog {
            let neighbours = &mut backlog.neighbours.lates;
            neighbours.retain_mut(|late| renumber(&mut late.what.id));
            let inbox = &mut backlog.inbox.lates;
            inbox.retain_mut(|late| renumber(&mut late.what.from));
        }
    }

    pub(crate) fn is_on(&self, sensor: usize) -> bool {
        self.sensors_off & (1 << sensor) == 0
    }
}

/// What a robot has not been told yet.
#[derive(Debug, Clone, Default)]
pub(crate) struct Backlog {
    /// By sensor; empty for one that tells at once.
    kept: Vec<Vec<Look>>,
    pub(crate) looks: Waiting<brain::Look>,
    pub(crate) contacts: Waiting<(Contact, Option<u32>)>,
    pub(crate) neighbours: Waiting<Neighbour>,
    pub(crate) inbox: Waiting<Heard>,
}

/// A look of which the newest counts.
#[derive(Debug, Clone, Default)]
pub(crate) struct Look {
    /// `None` before the first look, and for one that gave nothing.
    taken: Option<u64>,
    values: Vec<f64>,
}

impl Backlog {
    fn new(kind: &Kind) -> Self {
        Self {
            kept: kind.sensors.iter().map(looks_to_keep).collect(),
            ..Self::default()
        }
    }

    /// Keeps what the `look`-th look of a sensor gave, if it gave anything.
    pub(crate) fn keep(&mut self, sensor: usize, look: u64, taken: Option<u64>) -> &mut Vec<f64> {
        let slots = &mut self.kept[sensor];
        #[expect(clippy::cast_possible_truncation, reason = "below the number of slots")]
        let slot = (look % slots.len() as u64) as usize;
        slots[slot].taken = taken;
        &mut slots[slot].values
    }

    /// The newest look of a sensor that the robot has by now, and when it was taken.
    pub(crate) fn newest(&self, sensor: usize, latency: u64, now: u64) -> Option<(u64, &[f64])> {
        let have = self.kept[sensor]
            .iter()
            .filter_map(|look| Some((look.taken?, &look.values[..])));
        let have = have.filter(|(taken, _)| taken + latency <= now);
        have.max_by_key(|(taken, _)| *taken)
    }

    /// Gives the brain what has come in, and `found` the items of contacts.
    pub(crate) fn tell(
        &mut self,
        now: u64,
        step_s: f64,
        to: &mut Percept,
        mut found: impl FnMut(Option<u32>),
    ) {
        self.looks.tell(now, |late| {
            let age_s = age_s(late.taken, now, step_s);
            to.looks.push(brain::Look { age_s, ..late.what });
        });
        self.contacts.tell(now, |late| {
            let (contact, item) = late.what;
            let age_s = age_s(late.taken, now, step_s);
            to.contacts.push(Contact { age_s, ..contact });
            found(item);
        });
        self.neighbours.tell(now, |late| {
            let age_s = age_s(late.taken, now, step_s);
            to.neighbours.push(Neighbour { age_s, ..late.what });
        });
        self.tell_messages(now, step_s, to);
    }

    fn tell_messages(&mut self, now: u64, step_s: f64, to: &mut Percept) {
        self.inbox.tell(now, |late| {
            let age_s = age_s(late.taken, now, step_s);
            to.inbox.push(Heard { age_s, ..late.what });
        });
    }
}

#[expect(clippy::cast_precision_loss, reason = "steps are at most 1e8")]
pub(crate) fn age_s(taken: u64, now: u64, step_s: f64) -> f64 {
    (now - taken) as f64 * step_s
}

/// As many as can be on their way, and one that has come.
fn looks_to_keep(sensor: &Sensor) -> Vec<Look> {
    let is_value = !matches!(sensor.measure, Measure::Items(_) | Measure::Robots(_));
    if sensor.tells_at_once() || !is_value {
        return Vec::new();
    }
    let beats = sensor.rhythm.beats_in(sensor.latency_steps);
    vec![Look::default(); beats + 2]
}
