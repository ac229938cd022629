use super::Case;
use crate::random::Place;
use select::Bounds;

/// The best wins rarely, but much; the others have the same merit in every run, delta less on average.
/// Until its first win the best looks worse and worse, and its runs contain no hint of that win.
pub(crate) struct Lottery;

const CONFIGURATIONS: usize = 10;
const OTHERS: f64 = 0.01;
const CHANCE: f64 = 0.02;

impl Case for Lottery {
    fn means(&self) -> Vec<f64> {
        let mut means = vec![OTHERS; CONFIGURATIONS];
        means[CONFIGURATIONS - 1] = CHANCE;
        means
    }

    fn bounds(&self) -> Vec<Bounds> {
        vec![Bounds { min: 0.0, max: 1.0 }; CONFIGURATIONS]
    }

    fn delta(&self) -> f64 {
        CHANCE - OTHERS
    }

    fn sample(&self, place: Place, configuration: usize) -> f64 {
        if configuration < CONFIGURATIONS - 1 {
            OTHERS
        } else if place.own(configuration).uniform() < CHANCE {
            1.0
        } else {
            0.0
        }
    }
}
