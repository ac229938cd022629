//! Where detections go.

use brain::{Contact, Neighbour, Observation, Percept};

/// Takes what a measurement detects: entries that all count.
pub(crate) trait DetectionSink {
    /// Adds that an item detector has measured.
    fn add_observation(&mut self, observation: Observation);

    /// Adds a contact with an item, or with none for a false alarm.
    fn add_contact(&mut self, contact: Contact, item: Option<u32>);

    /// Adds a detected robot or controller.
    fn add_neighbour(&mut self, neighbour: Neighbour);
}

impl DetectionSink for Percept {
    #[inline]
    fn add_observation(&mut self, observation: Observation) {
        self.observations.push(observation);
    }

    #[inline]
    fn add_contact(&mut self, contact: Contact, _item: Option<u32>) {
        self.contacts.push(contact);
    }

    #[inline]
    fn add_neighbour(&mut self, neighbour: Neighbour) {
        self.neighbours.push(neighbour);
    }
}
