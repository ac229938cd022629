use super::Case;
use crate::random::Place;
use select::Bounds;

/// Normal merits of variance 1, for the procedures that assume them; the best is last.
pub(crate) struct Normal {
    means: Vec<f64>,
    delta: f64,
    /// Correlation of any two configurations in a run.
    correlation: f64,
}

impl Normal {
    /// The best leads all others by delta, the standard error of the mean of `first_runs` runs.
    pub(crate) fn slippage(configurations: u32, first_runs: u32, correlation: f64) -> Self {
        Self::new(configurations, first_runs, correlation, |place| {
            if place == 0 { 0.0 } else { -1.0 }
        })
    }

    /// Each leads the next by delta.
    pub(crate) fn spaced(configurations: u32, first_runs: u32, correlation: f64) -> Self {
        Self::new(configurations, first_runs, correlation, |place| {
            -f64::from(place)
        })
    }

    /// `deltas`: the mean by rank, in deltas.
    fn new(configurations: u32, first_runs: u32, correlation: f64, deltas: fn(u32) -> f64) -> Self {
        let delta = 1.0 / f64::from(first_runs).sqrt();
        Self {
            means: (0..configurations)
                .rev()
                .map(|rank| delta * deltas(rank))
                .collect(),
            delta,
            correlation,
        }
    }
}

impl Case for Normal {
    fn means(&self) -> Vec<f64> {
        self.means.clone()
    }

    fn bounds(&self) -> Vec<Bounds> {
        vec![
            Bounds {
                min: f64::NEG_INFINITY,
                max: f64::INFINITY
            };
            self.means.len()
        ]
    }

    fn delta(&self) -> f64 {
        self.delta
    }

    fn sample(&self, place: Place, configuration: usize) -> f64 {
        let own = (1.0 - self.correlation).sqrt() * place.own(configuration).normal();
        let shared = if self.correlation > 0.0 {
            self.correlation.sqrt() * place.shared().normal()
        } else {
            0.0
        };
        self.means[configuration] + own + shared
    }
}
