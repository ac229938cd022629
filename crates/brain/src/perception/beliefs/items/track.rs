//! One track: the sources of an item, its position and its log odds.

use super::group::Group;
use crate::io::agent_id::AgentId;
use crate::io::message::Provenance;
use alloc::boxed::Box;
use alloc::vec::Vec;
use base::geometry::Point;
use base::hash::Hash;
use base::hashed::Hashed;
use core::f64::consts::PI;

/// Maximum number of sources per track.
pub(crate) const SOURCES: usize = 6;

/// Minimum standard deviation of a position.
pub(crate) const MIN_DEVIATION_M: f64 = 0.05;

/// Limit of the log odds that an item exists, in nats.
pub(crate) const MAX_LOG_ODDS: f64 = 15.0;

/// The highest probability of an item before any observation.
pub(crate) const MAX_PRIOR: f64 = 0.1;

/// A track of an item, or of false alarms.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Track {
    /// Index of its kind in the body's `item_kinds`.
    pub(crate) kind: u16,
    /// Position in the world.
    pub(crate) at: Point,
    /// Variance of the position, along each axis.
    pub(crate) variance_m2: f64,
    /// Log odds before any observation.
    pub(crate) prior: f64,
    pub(crate) sources: [Source; SOURCES],
    pub(crate) count: usize,
    /// Log likelihood of all misses at the edge of the field of view.
    pub(crate) edge: f64,
    /// Own measurements by sensor model and kind; empty if kinds are certain.
    pub(crate) evidence: Vec<f64>,
    /// Whether it is of several items; `None` outside of lanes that are to be cleared.
    pub(crate) group: Option<Box<Group>>,
}

impl Hashed for Track {
    fn add_to(&self, hash: &mut Hash) {
        let Self {
            kind,
            at,
            variance_m2,
            prior,
            sources,
            count,
            edge,
            evidence,
            group,
        } = self;
        (*kind, *at).add_to(hash);
        [*variance_m2, *prior, *edge].add_to(hash);
        sources[..*count].add_to(hash);
        if let Some(group) = group {
            group.add_to(hash);
        }
        if !evidence.is_empty() {
            evidence.add_to(hash);
            for source in &sources[..*count] {
                (source.kind, f64::from(source.kind_share)).add_to(hash);
            }
        }
    }
}

/// The observations of one robot.
#[derive(Debug, Clone, Copy, Default, PartialEq, Hashed)]
pub(crate) struct Source {
    pub(crate) provenance: Provenance,
    /// The sender of the report; the robot itself for own observations.
    pub(crate) from: AgentId,
    /// Log odds before its observations, given the other sources of the track.
    pub(crate) prior: f64,
    /// Log likelihood ratio of all its observations.
    pub(crate) log_ratio: f64,
    /// Confidence of the last report that was sent; 0 if none. Single precision, because there are
    /// hundreds.
    pub(crate) sent_confidence: f32,
    /// Whether own observations have confirmed or refuted it; each source is judged once.
    pub(crate) is_judged: bool,
    /// Whether it is this robot, and a detector of it has detected the item.
    #[hashed(skip)]
    pub(crate) is_contact: bool,
    /// The kind that a report named, and its probability given that there is an item, if kinds are uncertain.
    #[hashed(skip)]
    pub(crate) kind: u16,
    #[hashed(skip)]
    pub(crate) kind_share: f32,
}

impl Track {
    /// A track without sources.
    pub(crate) fn new(kind: u16, at: Point, variance_m2: f64, per_m2: f64) -> Self {
        Self {
            kind,
            at,
            variance_m2,
            prior: prior_log_odds(variance_m2, per_m2),
            sources: [Source::default(); SOURCES],
            count: 0,
            edge: 0.0,
            evidence: Vec::new(),
            group: None,
        }
    }

    /// Log odds with full trust in all sources.
    pub(crate) fn log_odds(&self) -> f64 {
        let sources = self.sources[..self.count].iter();
        self.prior + sources.map(|source| source.log_ratio).sum::<f64>()
    }

    /// Log odds before the observations of one more robot, given that it locates the item at a
    /// position.
    ///
    /// ```text
    /// odds = odds of the first x odds of the second x N(d; S) / density of items
    /// ```
    ///
    /// Two robots that each observed an item may have observed two different ones; a distance of d
    /// with a total variance of S is evidence for a single one.
    pub(crate) fn prior_with_another(&self, at: Point, variance_m2: f64, per_m2: f64) -> f64 {
        if self.count == 0 {
            return self.prior;
        }
        let all_m2 = self.variance_m2 + variance_m2;
        let distance = self.at.to(at).length_squared() / (2.0 * all_m2);
        prior_log_odds(all_m2, per_m2) + distance
    }

    /// The slot of the own observations, replacing the weakest source if all slots are in use.
    pub(super) fn own_slot(&mut self) -> usize {
        if self.count < SOURCES {
            self.count += 1;
            return self.count - 1;
        }
        let strengths = self.sources.iter().map(|source| source.log_ratio.abs());
        let weakest = strengths
            .enumerate()
            .min_by(|one, other| one.1.total_cmp(&other.1));
        weakest.map_or(0, |(slot, _)| slot)
    }

    pub(crate) fn slot_of(&self, provenance: Provenance) -> Option<usize> {
        let sources = self.sources[..self.count].iter();
        let is_same = |source: &Source| {
            source.provenance.observer == provenance.observer
                && source.provenance.track_id == provenance.track_id
        };
        sources.into_iter().position(is_same)
    }

    pub(crate) fn is_observed_by(&self, own: AgentId) -> bool {
        let mut sources = self.sources[..self.count].iter();
        sources.any(|source| source.provenance.observer == own)
    }

    /// The observations of a robot, if its detectors have detected the item.
    pub(crate) fn own_contact(&self, own: AgentId) -> Option<&Source> {
        let mut sources = self.sources[..self.count].iter();
        sources.find(|source| source.provenance.observer == own && source.is_contact)
    }

    /// Corrects the position.
    pub(crate) fn correct_position(&mut self, at: Point, variance_m2: f64) {
        let gain = self.variance_m2 / (self.variance_m2 + variance_m2);
        self.at = self.at.plus(self.at.to(at).times(gain));
        let min_m2 = MIN_DEVIATION_M * MIN_DEVIATION_M;
        self.variance_m2 = (self.variance_m2 * (1.0 - gain)).max(min_m2);
    }
}

impl Source {
    /// Log odds by its observations alone.
    pub(crate) fn log_odds(&self) -> f64 {
        self.prior + self.log_ratio
    }
}

/// Prior log odds of an item at a position with a variance, given the density of items.
fn prior_log_odds(variance_m2: f64, per_m2: f64) -> f64 {
    log_odds((2.0 * PI * variance_m2 * per_m2).clamp(1e-9, MAX_PRIOR))
}

pub(crate) fn log_odds(probability: f64) -> f64 {
    libm::log(probability / (1.0 - probability))
}

pub(crate) fn probability(log_odds: f64) -> f64 {
    1.0 / (1.0 + libm::exp(-log_odds))
}
