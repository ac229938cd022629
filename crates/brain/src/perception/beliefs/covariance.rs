//! The covariance matrix of an estimate, and the steps of an extended Kalman filter on it.
//!
//! A prediction is a sequence of [additions](Covariance::add_multiple) of a multiple of one quantity to
//! another. That is exact for the product of the matrices, most entries of which are zero.

use base::hashed::Hashed;

/// The covariances of `N` quantities.
#[derive(Debug, Clone, Copy, Hashed)]
pub(super) struct Covariance<const N: usize> {
    rows: [[f64; N]; N],
}

impl<const N: usize> Covariance<N> {
    /// Of quantities that are all exact.
    pub(super) const EXACT: Self = Self {
        rows: [[0.0; N]; N],
    };

    /// The covariances of these quantities and of further ones that are exact.
    pub(super) fn extended<const M: usize>(&self) -> Covariance<M> {
        let mut extended = Covariance::<M>::EXACT;
        for (to, from) in extended.rows.iter_mut().zip(self.rows) {
            for (entry, before) in to.iter_mut().zip(from) {
                *entry = before;
            }
        }
        extended
    }

    #[inline]
    pub(super) fn get(&self, row: usize, column: usize) -> f64 {
        self.rows[row][column]
    }

    /// Adds a quantity, times a factor, to another one.
    #[inline]
    pub(super) fn add_multiple(&mut self, of: usize, factor: f64, to: usize) {
        let from = self.rows[of];
        for (entry, add) in self.rows[to].iter_mut().zip(from) {
            *entry += factor * add;
        }
        for row in &mut self.rows {
            row[to] += factor * row[of];
        }
    }

    /// Adds an independent error to a quantity.
    #[inline]
    pub(super) fn add_variance(&mut self, of: usize, variance: f64) {
        self.rows[of][of] += variance;
    }

    /// Replaces what is known of a quantity: its error is independent of all others.
    pub(super) fn set_independent(&mut self, of: usize, variance: f64) {
        for row in &mut self.rows {
            row[of] = 0.0;
        }
        self.rows[of] = [0.0; N];
        self.rows[of][of] = variance;
    }

    /// Takes a measurement of a quantity into account, and returns the gain of each quantity: by how
    /// much it changes per difference between the measurement and its estimate.
    #[inline]
    pub(super) fn measure(&mut self, of: usize, sensor_variance: f64) -> [f64; N] {
        let row = self.rows[of];
        let total = row[of] + sensor_variance;
        let mut gains = [0.0; N];
        if total > 0.0 {
            gains = row.map(|entry| entry / total);
        }
        if sensor_variance <= 0.0 {
            gains[of] = 1.0;
        }
        for (entries, gain) in self.rows.iter_mut().zip(gains) {
            for (entry, before) in entries.iter_mut().zip(row) {
                *entry -= gain * before;
            }
        }
        if sensor_variance > 0.0 {
            self.round();
        } else {
            self.set_independent(of, 0.0);
        }
        gains
    }

    /// Rounding may leave a variance slightly below zero.
    #[inline]
    fn round(&mut self) {
        for index in 0..N {
            self.rows[index][index] = self.rows[index][index].max(0.0);
        }
    }

    /// Whether all variances are finite.
    #[inline]
    pub(super) fn is_finite(&self) -> bool {
        let variances = (0..N).map(|index| self.rows[index][index]);
        variances.sum::<f64>().is_finite()
    }
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "exact by construction")]
mod tests {
    use super::*;

    #[test]
    fn a_prediction_and_a_measurement_are_those_of_the_matrix_form() {
        let mut covariance = Covariance::<3>::EXACT;
        covariance.add_variance(0, 4.0);
        covariance.add_variance(1, 1.0);
        // x' = x + 2 v.
        covariance.add_multiple(1, 2.0, 0);
        assert_eq!([covariance.get(0, 0), covariance.get(0, 1)], [8.0, 2.0]);
        // S = 8 + 2, K = [0.8, 0.2].
        let gains = covariance.measure(0, 2.0);
        assert_eq!(gains, [0.8, 0.2, 0.0]);
        assert!((covariance.get(0, 0) - 1.6).abs() < 1e-12);
        assert!((covariance.get(1, 1) - 0.6).abs() < 1e-12);
        assert!((covariance.get(1, 0) - 0.4).abs() < 1e-12);
    }

    #[test]
    fn an_exact_measurement_leaves_no_error() {
        let mut covariance = Covariance::<2>::EXACT;
        covariance.add_variance(1, 1.0);
        covariance.add_multiple(1, 2.0, 0);
        assert_eq!(covariance.measure(0, 0.0), [1.0, 0.5]);
        assert_eq!([covariance.get(0, 0), covariance.get(0, 1)], [0.0, 0.0]);
        assert_eq!(covariance.get(1, 1), 0.0);
        // Nothing is left to learn from the next one.
        assert_eq!(covariance.measure(0, 0.0), [1.0, 0.0]);
    }
}
