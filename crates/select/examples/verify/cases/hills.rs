use super::Case;
use crate::random::Place;
use select::Bounds;

/// Bell-shaped merits between 0 and 1, each of its own mean and width; ten configurations, the
/// best last.
pub(crate) struct Hills {
    means: Vec<f64>,
    /// Distance between the lowest and the highest merit of each.
    widths: Vec<f64>,
}

const DELTA: f64 = 0.05;

impl Hills {
    /// The best leads all others by delta: the least favourable means.
    pub(crate) fn slippage() -> Self {
        Self::new([0.0; 9], |_| 0.8)
    }

    /// Each leads the next by delta.
    pub(crate) fn spaced() -> Self {
        Self::new(
            [-8., -7., -6., -5., -4., -3., -2., -1., 0.].map(|step| step * DELTA),
            |_| 0.2,
        )
    }

    /// Each leads the next by a third of delta: three are right, and the others nearly.
    pub(crate) fn crowded() -> Self {
        let leads = [-6., -5., -4., -3., -2., -1., 0., 1., 2.].map(|step| step * DELTA / 3.0);
        Self::new(leads, |_| 0.6)
    }

    /// All have the same mean.
    pub(crate) fn equal() -> Self {
        Self::new([DELTA; 9], |_| 0.8)
    }

    /// The best leads all others by delta and has the highest variance; the variances of the others differ.
    pub(crate) fn unequal() -> Self {
        Self::new([0.0; 9], |place| 0.09 * f64::from(place + 1))
    }

    /// From the others' means above 1/2 and the widths by place.
    fn new(others: [f64; 9], width: impl Fn(u32) -> f64) -> Self {
        let means = others.into_iter().chain([DELTA]).map(|lead| 0.5 + lead);
        Self {
            means: means.collect(),
            widths: (0..10).map(width).collect(),
        }
    }
}

impl Case for Hills {
    fn means(&self) -> Vec<f64> {
        self.means.clone()
    }

    fn bounds(&self) -> Vec<Bounds> {
        vec![Bounds { min: 0.0, max: 1.0 }; self.means.len()]
    }

    fn delta(&self) -> f64 {
        DELTA
    }

    fn sample(&self, place: Place, configuration: usize) -> f64 {
        let deviation = place.own(configuration).bates() - 0.5;
        self.means[configuration] + self.widths[configuration] * deviation
    }
}
