//! Where the results of measurements go.

use crate::judge::detections::Detections;
use crate::sensors::backlog::Backlog;
use crate::sensors::detection_sink::DetectionSink;
use crate::sensors::pending::{Pending, PendingQueue};
use brain::{Contact, Neighbour, Observation, Percept};

/// Where the results of one measurement go.
pub(super) enum Destination<'a> {
    /// Into the percept: the brain steps now, and the sensor has no latency.
    Percept {
        percept: &'a mut Percept,
        detections: &'a mut Detections,
        /// The number of the robot.
        robot: usize,
    },
    /// Into the backlog, from which the brain gets them in its first step from step `due` on.
    Backlog {
        backlog: &'a mut Backlog,
        taken: u64,
        due: u64,
    },
}

impl DetectionSink for Destination<'_> {
    #[inline]
    fn add_observation(&mut self, observation: Observation) {
        match self {
            Self::Percept { percept, .. } => percept.observations.push(observation),
            Self::Backlog {
                backlog,
                taken,
                due,
            } => {
                push(&mut backlog.observations, *taken, *due, observation);
            }
        }
    }

    #[inline]
    fn add_contact(&mut self, contact: Contact, item: Option<u32>) {
        match self {
            Self::Percept {
                percept,
                detections,
                robot,
            } => {
                percept.contacts.push(contact);
                detections.note(*robot, item);
            }
            Self::Backlog {
                backlog,
                taken,
                due,
            } => {
                push(&mut backlog.contacts, *taken, *due, (contact, item));
            }
        }
    }

    #[inline]
    fn add_neighbour(&mut self, neighbour: Neighbour) {
        match self {
            Self::Percept { percept, .. } => percept.neighbours.push(neighbour),
            Self::Backlog {
                backlog,
                taken,
                due,
            } => {
                push(&mut backlog.neighbours, *taken, *due, neighbour);
            }
        }
    }
}

fn push<T>(queue: &mut PendingQueue<T>, taken: u64, due: u64, what: T) {
    queue.entries.push(Pending { taken, due, what });
}
