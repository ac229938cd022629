use super::Case;
use crate::random::Place;
use select::Bounds;

/// Runs that fail or not; the last configuration fails half as often as the others.
pub(crate) struct Failures {
    pub(crate) configurations: usize,
    /// How often the others fail.
    pub(crate) others: f64,
}

impl Failures {
    fn chance(&self, configuration: usize) -> f64 {
        if configuration == self.configurations - 1 {
            self.others / 2.0
        } else {
            self.others
        }
    }
}

impl Case for Failures {
    fn means(&self) -> Vec<f64> {
        (0..self.configurations)
            .map(|each| -self.chance(each))
            .collect()
    }

    fn bounds(&self) -> Vec<Bounds> {
        vec![
            Bounds {
                min: -1.0,
                max: 0.0
            };
            self.configurations
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
