//! What behaviours are given of a step.

use crate::io::body::Body;
use crate::io::percept::Percept;
use crate::io::random_words::RandomWords;
use crate::perception::beliefs::Beliefs;
use crate::perception::rays::Ring;

/// Touch is believed again so long after a turn: the body needs time to leave what it touched.
const LEAVING_S: f64 = 0.5;

/// What was seen in some direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ClearAhead {
    /// From the hull, and a little room, to what is not known to be free, now; negative if nothing is certain.
    pub(crate) free_m: f64,
    /// Time since the oldest scan of it was measured.
    pub(crate) age_s: f64,
}

/// A step's percept, with what the brain has made of it for all behaviours together.
#[derive(Debug)]
pub(crate) struct Situation<'s> {
    pub(crate) percept: &'s Percept,
    pub(crate) body: &'s Body,
    /// What a mind makes of all percepts so far; `None` without a mind.
    pub(crate) beliefs: Option<&'s Beliefs>,
    pub(crate) rings: &'s [Ring],
    /// What is seen straight ahead; `None` if nothing looks there or nothing came in.
    pub(crate) ahead: Option<ClearAhead>,
    /// Angle by which the body turned since the last step.
    pub(crate) turned_rad: f64,
    /// At most so fast it now goes; negative if backwards.
    pub(crate) now_m_s: f64,
}

impl Situation<'_> {
    /// Time between two steps, as short as memories keep it.
    #[inline]
    #[expect(clippy::cast_possible_truncation, reason = "kept short")]
    pub(crate) fn period_s(&self) -> f32 {
        self.body.period_s as f32
    }

    /// Whether it still touches something; a collision may hold it, and it gets nowhere meanwhile.
    #[inline]
    pub(crate) fn is_held(&self) -> bool {
        self.touches(f64::INFINITY)
    }

    /// Uniform numbers; every call begins with the first.
    pub(crate) fn random_words(&self) -> RandomWords {
        RandomWords::new(self.percept.random_words)
    }

    /// So far it still goes if it brakes now.
    #[inline]
    pub(crate) fn stopping_m(&self) -> f64 {
        self.now_m_s * self.now_m_s / (2.0 * self.body.max_acceleration_m_s2)
    }

    /// Whether something stands nearer ahead than `near_m`, to one who has gone straight for
    /// `straight_s`: what was seen before that says nothing.
    #[inline]
    pub(crate) fn stands_ahead(&self, near_m: f64, straight_s: f64) -> bool {
        self.ahead
            .is_some_and(|seen| seen.free_m < near_m && seen.age_s <= straight_s)
    }

    /// Whether the body touches something, to one who has gone on for `since_s`.
    #[inline]
    pub(crate) fn touches(&self, since_s: f64) -> bool {
        self.percept
            .touch
            .is_some_and(|touch| touch.value && touch.age_s <= since_s - LEAVING_S)
    }

    /// Fresh scans: the ranges, and what a behaviour knows of the ring.
    #[inline]
    pub(crate) fn scans_with<'a, T>(
        &'a self,
        known: &'a [T],
    ) -> impl Iterator<Item = (&'a [f64], &'a T)> {
        let rings = self.rings.iter().zip(&self.percept.scans).zip(known);
        rings.filter_map(|((ring, scan), known)| {
            let (_, ranges_m) = ring.fresh(Some(scan))?;
            Some((ranges_m, known))
        })
    }

    /// Fresh scans: the ring, and its ranges.
    pub(crate) fn scans(&self) -> impl Iterator<Item = (&Ring, &[f64])> {
        let rings = self.rings.iter().zip(&self.percept.scans);
        rings.filter_map(|(ring, scan)| Some((ring, ring.fresh(Some(scan))?.1)))
    }
}
