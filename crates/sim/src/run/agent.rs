//! The deciding part of a robot: its brain, its motion setpoint, and pending observations.

use crate::bodies::kind::Kind;
use crate::radio::channel::Transmission;
use crate::sensors::backlog::Backlog;
use crate::sensors::pending::Pending;
use brain::{Brain, Motion, Percept, RobotId, SensorRequest};
use std::collections::BTreeMap;

/// The deciding part of one robot.
#[derive(Debug, Clone)]
pub(crate) struct Agent {
    pub(crate) brain: Brain,
    /// The motion setpoint until the brain steps again.
    pub(crate) setpoint: Motion,
    /// A bit for each sensor that is switched off.
    pub(crate) sensors_off: u32,
    /// Readings and messages that have not reached the brain. Most kinds of robots never have any.
    pub(crate) backlog: Option<Box<Backlog>>,
}

impl Agent {
    pub(crate) fn new(kind: &Kind) -> Self {
        Self {
            brain: kind.brain.clone(),
            setpoint: Motion::default(),
            sensors_off: 0,
            backlog: kind
                .needs_backlog()
                .then(|| Box::new(Backlog::new(&kind.sensors))),
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

    /// Takes a message that arrives now, unless the radio has received its maximum in this step.
    pub(crate) fn receive(&mut self, sent: &Transmission, now: u64, max_messages: usize) {
        let Some(backlog) = &mut self.backlog else {
            return;
        };
        let inbox = &mut backlog.inbox;
        inbox.forget(now);
        if inbox
            .entries
            .iter()
            .rev()
            .take_while(|late| late.due == now)
            .count()
            < max_messages
        {
            inbox.entries.push(Pending {
                taken: sent.at,
                due: now,
                what: sent.message,
            });
        }
    }

    /// Adds received messages to an external percept.
    pub(crate) fn deliver_messages(&mut self, now: u64, step_s: f64, to: &mut Percept) {
        if let Some(backlog) = &mut self.backlog {
            backlog.deliver_messages(now, step_s, to);
        }
    }

    /// Renumbers items; detections of items that were removed are dropped.
    pub(crate) fn renumber_items(&mut self, numbers: &BTreeMap<usize, usize>) {
        if let Some(backlog) = &mut self.backlog {
            backlog.contacts.entries.retain_mut(|late| {
                let Some(item) = &mut late.what.1 else {
                    return true;
                };
                let number = numbers.get(&(*item as usize));
                let number = number.and_then(|number| u32::try_from(*number).ok());
                number.inspect(|number| *item = *number).is_some()
            });
        }
    }

    /// Renumbers robots; detections and messages of robots that were removed are dropped.
    pub(crate) fn renumber_robots(&mut self, numbers: &BTreeMap<RobotId, RobotId>) {
        self.brain.renumber(|id| numbers.get(&id).copied());
        let renumber = |id: &mut RobotId| numbers.get(id).map(|now| *id = *now).is_some();
        if let Some(backlog) = &mut self.backlog {
            let neighbours = &mut backlog.neighbours.entries;
            neighbours.retain_mut(|late| renumber(&mut late.what.id));
            let inbox = &mut backlog.inbox.entries;
            inbox.retain_mut(|late| renumber(&mut late.what.from));
        }
    }
}

/// Whether a sensor is on, by the bits of those that are off.
pub(crate) fn is_on(sensors_off: u32, sensor: usize) -> bool {
    sensors_off & (1 << sensor) == 0
}
