use super::Case;
use crate::random::Place;
use select::Bounds;

/// Runs that fail or not: ten configurations, of which the last fails half as often as the others.
pub(crate) struct Failures {
    /// How often the others fail.
    pub(crate) others: f64,
}

impl Failures {
    const CONFIGURATIONS: usize = 10;

    fn chance(&self, configuration: usize) -> f64 {
        if configuration == Self::CONFIGURATIONS - 1 {
            self.others / 2.0
        } else {
            self.others
        }
    }
}

impl Case for Failures {
    fn means(&self) -> Vec<f64> {
        (0..Self::CONFIGURATIONS)
            .map(|each| -self.chance(each))
            .collect()
    }

    fn bounds(&self) -> Vec<Bounds> {
        vec![
            Bounds {
                least: -1.0,
                greatest: 0.0
            };
            Self::CONFIGURATIONS
        ]
    }

    fn delta(&self) -> f64 {
        self.others / 2.0
    }

    fn sample(&self, place: Place, configuration: usize) -> f64 {
        if place.own(configuration).uniform() < self.chance(configuration) {
            -1.0
        } else {
            0.0
        }
    }
}
