//! What robots detected in one step.

/// What the judge counts of the percepts of some robots.
#[derive(Debug, Clone, Default)]
pub(crate) struct Detections {
    /// Items that robots detected, in the order of the robots.
    pub(crate) sightings: Vec<Sighting>,
    /// False alarms in the percepts of robots.
    pub(crate) false_alarms: u64,
}

/// An item in the percept of a robot, by their numbers.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sighting {
    pub(crate) robot: u32,
    pub(crate) item: u32,
}

impl Detections {
    pub(crate) fn clear(&mut self) {
        self.sightings.clear();
        self.false_alarms = 0;
    }

    /// Notes the item of a contact in the percept of a robot, or none for a false alarm.
    #[expect(
        clippy::cast_possible_truncation,
        reason = "robots have 32-bit numbers"
    )]
    pub(crate) fn note(&mut self, robot: usize, item: Option<u32>) {
        let robot = robot as u32;
        match item {
            Some(item) => self.sightings.push(Sighting { robot, item }),
            None => self.false_alarms += 1,
        }
    }

    /// Adds those of other robots.
    pub(crate) fn add(&mut self, other: &Self) {
        self.sightings.extend(&other.sightings);
        self.false_alarms += other.false_alarms;
    }

    /// Those of some robots and of others, in the order of all of them.
    pub(crate) fn merged<'a>(parts: impl Iterator<Item = &'a Self>) -> Self {
        let mut all = Self::default();
        parts.for_each(|part| all.add(part));
        all.sightings.sort_by_key(|sighting| sighting.robot);
        all
    }
}
