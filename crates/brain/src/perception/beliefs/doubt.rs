//! Readings that are too far from what is believed to be taken at once.

/// So many deviations of the difference are too far. Of honest readings that is one in 1.7 million in one
/// dimension, 2 (1 - Phi(5)), and one in 270,000 in two, exp(-5^2 / 2): validation gates as in Bar-Shalom and
/// Fortmann, *Tracking and data association*, 1988.
const FAR: f64 = 5.0;

/// So many in a row that agree are believed.
const INSISTING: u8 = 3;

/// The last reading that was too far, and how many in a row have agreed by now, itself among them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Doubted<T>(Option<(T, u8)>);

// Derived, it would ask the same of T.
impl<T> Default for Doubted<T> {
    fn default() -> Self {
        Self(None)
    }
}

/// How far a reading is from what is believed, and what of that is no surprise.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Off {
    pub(crate) by: f64,
    /// Of what is believed and of the sensor, along each axis.
    pub(crate) variances: [f64; 2],
    /// What it may be off besides, as it is not of now.
    pub(crate) room: f64,
}

impl Off {
    /// Whether it is too far; an exact sensor's reading never is.
    fn is_far(&self) -> bool {
        let [own, sensor] = self.variances;
        let beyond = self.by - self.room;
        sensor > 0.0 && beyond > 0.0 && beyond * beyond > FAR * FAR * (own + sensor)
    }
}

/// What to do with a reading.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Verdict {
    /// It corrects what is believed.
    Near,
    /// It is left out.
    Far,
    /// What was believed is wrong: begin anew with it.
    Instead,
}

impl<T> Doubted<T> {
    /// Judges a reading; `apart` is how far another is from it.
    ///
    /// Two agree if they are not half as far from each other as the later is from what is believed: then
    /// a body whose wheels slip, so that no two readings agree by their noise, is not lost for ever.
    #[inline]
    pub(crate) fn judge(&mut self, read: T, off: &Off, apart: impl Fn(&T) -> f64) -> Verdict {
        if !off.is_far() {
            self.0 = None;
            return Verdict::Near;
        }
        let before = self.0.take();
        let agreed = before.filter(|(last, _)| apart(last) < off.by / 2.0);
        let times = agreed.map_or(1, |(_, times)| times + 1);
        if times >= INSISTING {
            return Verdict::Instead;
        }
        self.0 = Some((read, times));
        Verdict::Far
    }

    /// What was read is now elsewhere, as the body has moved.
    #[inline]
    pub(crate) fn carry_on(&mut self, way: impl Fn(T) -> T) {
        if let Some((last, times)) = self.0.take() {
            self.0 = Some((way(last), times));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What becomes of readings in one dimension by one who believes in 0, with a deviation of 1 in all.
    fn judged(read: &[f64]) -> Vec<Verdict> {
        let mut doubted = Doubted::default();
        let each = read.iter().map(|read: &f64| {
            let off = Off {
                by: read.abs(),
                variances: [0.36, 0.64],
                room: 0.0,
            };
            doubted.judge(*read, &off, |last: &f64| (last - read).abs())
        });
        each.collect()
    }

    #[test]
    fn five_deviations_are_too_far() {
        assert_eq!(judged(&[4.99, -5.01]), [Verdict::Near, Verdict::Far]);
    }

    #[test]
    fn three_in_a_row_that_agree_are_believed_and_others_are_not() {
        use Verdict::{Far, Instead, Near};
        assert_eq!(judged(&[9.0, 9.1, 8.9]), [Far, Far, Instead]);
        assert_eq!(judged(&[9.0, 9.1, 0.0, 8.9]), [Far, Far, Near, Far]);
        assert_eq!(judged(&[9.0, -9.0, 9.0, -9.0]), [Far; 4]);
        assert_eq!(judged(&[9.0, 900.0, 9.0, 9.1]), [Far; 4]);
    }

    #[test]
    fn readings_that_run_away_are_believed_though_no_two_are_the_same() {
        let judged = judged(&[10.0, 19.0, 28.0]);
        assert_eq!(judged, [Verdict::Far, Verdict::Far, Verdict::Instead]);
    }

    #[test]
    fn what_is_late_has_room() {
        let off = Off {
            by: 7.0,
            variances: [0.0, 1.0],
            room: 2.5,
        };
        assert!(!off.is_far() && Off { room: 1.5, ..off }.is_far());
    }

    #[test]
    fn an_exact_sensor_is_never_doubted() {
        let off = Off {
            by: 1e6,
            variances: [1.0, 0.0],
            room: 0.0,
        };
        assert!(!off.is_far());
    }
}
