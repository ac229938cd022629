//! Readings that have not reached the brain of a robot yet.

use super::Sensor;
use super::pending::PendingQueue;
use brain::{Contact, Neighbour, Observation, Percept};

/// Readings that have not reached the brain yet.
#[derive(Debug, Clone, Default)]
pub(crate) struct Backlog {
    /// By sensor; empty for one without delay.
    kept: Vec<Vec<StoredMeasurement>>,
    pub(crate) observations: PendingQueue<Observation>,
    pub(crate) contacts: PendingQueue<(Contact, Option<u32>)>,
    pub(crate) neighbours: PendingQueue<Neighbour>,
}

/// A measurement that the next one replaces.
#[derive(Debug, Clone, Default)]
pub(crate) struct StoredMeasurement {
    /// `None` before the first measurement.
    taken: Option<u64>,
    values: Vec<f64>,
}

impl Backlog {
    pub(crate) fn new(sensors: &[Sensor]) -> Self {
        Self {
            kept: sensors.iter().map(empty_slots).collect(),
            ..Self::default()
        }
    }

    /// The place of the values of a new measurement of a sensor; it replaces the oldest one, which is
    /// neither in transit nor the newest that has arrived.
    pub(crate) fn keep(&mut self, sensor: usize, taken: u64) -> Option<&mut Vec<f64>> {
        let slots = self.kept[sensor].iter_mut();
        // `None` is less than any other.
        let oldest = slots.min_by_key(|slot| slot.taken)?;
        oldest.taken = Some(taken);
        Some(&mut oldest.values)
    }

    /// The newest measurement of a sensor that has arrived by now, and when it was taken.
    pub(crate) fn newest(&self, sensor: usize, latency: u64, now: u64) -> Option<(u64, &[f64])> {
        let have = self.kept[sensor]
            .iter()
            .filter_map(|measurement| Some((measurement.taken?, &measurement.values[..])));
        let have = have.filter(|(taken, _)| taken + latency <= now);
        have.max_by_key(|(taken, _)| *taken)
    }

    /// Drops all detections.
    pub(crate) fn drop_detections(&mut self) {
        self.observations.entries.clear();
        self.contacts.entries.clear();
        self.neighbours.entries.clear();
    }

    /// Drops old detections, so that a brain that hardly ever steps fills no memory.
    pub(crate) fn forget_detections(&mut self, now: u64) {
        self.observations.forget(now);
        self.contacts.forget(now);
        self.neighbours.forget(now);
    }

    /// Moves everything that has arrived into a percept; calls `found` with the item of each
    /// contact.
    pub(crate) fn deliver(
        &mut self,
        now: u64,
        step_s: f64,
        to: &mut Percept,
        mut found: impl FnMut(Option<u32>),
    ) {
        self.observations.deliver(now, |late| {
            let age_s = age_s(late.taken, now, step_s);
            to.observations.push(Observation { age_s, ..late.what });
        });
        self.contacts.deliver(now, |late| {
            let (contact, item) = late.what;
            let age_s = age_s(late.taken, now, step_s);
            to.contacts.push(Contact { age_s, ..contact });
            found(item);
        });
        self.neighbours.deliver(now, |late| {
            let age_s = age_s(late.taken, now, step_s);
            to.neighbours.push(Neighbour { age_s, ..late.what });
        });
    }
}

#[expect(clippy::cast_precision_loss, reason = "steps are at most 1e8")]
pub(crate) fn age_s(taken: u64, now: u64, step_s: f64) -> f64 {
    (now - taken) as f64 * step_s
}

/// One slot per measurement that can be in transit, and one that has arrived.
fn empty_slots(sensor: &Sensor) -> Vec<StoredMeasurement> {
    if sensor.is_immediate() || sensor.facts.detects {
        return Vec::new();
    }
    let in_transit = sensor.schedule.max_events_in(sensor.latency_steps);
    vec![StoredMeasurement::default(); in_transit + 2]
}
