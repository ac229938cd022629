//! Keys of the passage of a lane that cannot change once controllers have stated it.

use super::state::State;
use crate::passage::PassageSpec;
use crate::scenario::Scenario;
use base::error::InputError;

impl State {
    /// The errors of a change of what has been stated: the path, and the vehicles that drive on it.
    pub(super) fn of_passage(&self, from: &Scenario, to: &Scenario) -> Vec<InputError> {
        let (Some(was), Some(now)) = (from.passage, to.passage) else {
            return Vec::new();
        };
        if self.tally.conclusion.is_none() {
            return Vec::new();
        }
        let keys = stated(&was).into_iter().zip(stated(&now));
        let changed = keys.filter(|((_, was), (_, now))| was.to_bits() != now.to_bits());
        let errors = changed.map(|((key, was), (_, now))| {
            let allowed = format!("{was}: controllers have stated the passage");
            InputError::new(format!("passage.{key}"), Some(now.to_string()), allowed)
        });
        errors.collect()
    }
}

fn stated(of: &PassageSpec) -> [(&'static str, f64); 3] {
    [
        ("width_m", of.width_m),
        ("vehicles", of.vehicles.into()),
        ("gap_m", of.gap_m),
    ]
}
