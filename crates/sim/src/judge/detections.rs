//! What robots detected in one step.

/// What the judge counts of the percepts of some robots.
#[derive(Debug, Clone, Default)]
pub(crate) struct Detections {
    /// Items that robots detected, in the order of the robots.
    pub(crate) sightings: Vec<u32>,
    /// False alarms in the percepts of robots.
    pub(crate) false_alarms: u64,
}

impl Detections {
    pub(crate) fn clear(&mut self) {
        self.sightings.clear();
        self.false_alarms = 0;
    }

    /// Notes the item of a contact in a percept, or none for a false alarm.
    pub(crate) fn note(&mut self, item: Option<u32>) {
        match item {
            Some(item) => self.sightings.push(item),
            None => self.false_alarms += 1,
        }
    }

    /// Adds those of other robots.
    pub(crate) fn add(&mut self, other: &Self) {
        self.sightings.extend(&other.sightings);
        self.false_alarms += other.false_alarms;
    }
}
