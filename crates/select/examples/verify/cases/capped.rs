use super::Case;
use crate::random::Place;
use select::Bounds;

/// Exponential times that are cut off at a limit, so that many runs have exactly the same merit:
/// ten configurations, of which the last is faster by delta on average.
pub(crate) struct Capped {
    /// Means of the times before the cut.
    scales: Vec<f64>,
}

const LIMIT_S: f64 = 120.0;
/// The minimum time of a run.
const MIN_S: f64 = 10.0;
const BEST_SCALE_S: f64 = 60.0;
const DELTA_S: f64 = 6.0;

impl Capped {
    pub(crate) fn new() -> Self {
        let mut scales = vec![scale_of_mean(mean_s(BEST_SCALE_S) + DELTA_S); 9];
        scales.push(BEST_SCALE_S);
        Self { scales }
    }
}

/// Mean time after the cut.
fn mean_s(scale: f64) -> f64 {
    MIN_S - scale * libm::expm1(-(LIMIT_S - MIN_S) / scale)
}

/// The scale that gives a mean time, by bisection.
fn scale_of_mean(mean: f64) -> f64 {
    let (mut low, mut high) = (1.0, 1000.0);
    for _ in 0..80 {
        let scale = f64::midpoint(low, high);
        if mean_s(scale) < mean {
            low = scale;
        } else {
            high = scale;
        }
    }
    low
}

impl Case for Capped {
    fn means(&self) -> Vec<f64> {
        self.scales.iter().map(|scale| -mean_s(*scale)).collect()
    }

    fn bounds(&self) -> Vec<Bounds> {
        vec![
            Bounds {
                min: -LIMIT_S,
                max: -MIN_S
            };
            self.scales.len()
        ]
    }

    fn delta(&self) -> f64 {
        DELTA_S
    }

    fn sample(&self, place: Place, configuration: usize) -> f64 {
        let time = MIN_S + self.scales[configuration] * place.own(configuration).exponential();
        -time.min(LIMIT_S)
    }
}
