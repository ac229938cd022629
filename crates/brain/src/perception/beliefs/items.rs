//! Item tracks: estimated positions and the probability that each item exists.
//!
//! Each track has sources: for each robot that observed the item, the combined log likelihood ratio of its
//! observations and their number. Reports contain the same values and may therefore arrive any number of
//! times, by any route: of each source, only the report with the most observations counts.
//!
//! ```text
//! log odds = prior log odds + sum over sources of their log likelihood ratios
//! a contact adds    ln(p N(d; S) / f)    p: probability of detection at that distance, N: normal density
//! a miss adds       ln(1 - p)            of the position error d, f: false alarms per m2
//! a report counts   as t x its confidence + (1 - t) x the prior confidence,
//!                   t: trust in the sender, times trust in the observer if that is another robot
//! ```
//!
//! The prior follows from the density of items, and from the observations that did not detect anything at
//! that position.

use super::coverage_map::View;
use super::map::Map;
use super::pose::Pose;
use crate::io::body::{Detector, RobotId};
use crate::io::message::Provenance;
use crate::io::percept::Contact;
use crate::perception::sector::direction;
use alloc::vec::Vec;
use base::geometry::Point;
use core::f64::consts::PI;

mod reports;

pub(crate) use reports::{Reception, Report};

/// Maximum number of tracks; the least likely one is replaced first.
const MAX_TRACKS: usize = 64;

/// Maximum number of sources per track.
const SOURCES: usize = 6;

/// Association gate, in standard deviations.
const GATE: f64 = 3.0;

/// Minimum standard deviation of a position.
const MIN_DEVIATION_M: f64 = 0.05;

/// Limits of the log likelihood ratio of one observation against an item, and of the total log odds, in nats.
const MAX_OBSERVATION_LOG_RATIO: f64 = 8.0;
const MAX_LOG_ODDS: f64 = 15.0;

/// Lower limit of the factor by which unsuccessful observations reduce the density of items: detector models
/// have errors.
const MIN_UNSEEN: f64 = 0.01;

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
    prior: f64,
    sources: [Source; SOURCES],
    count: usize,
    /// Log likelihood of all misses at the edge of the field of view.
    edge: f64,
}

/// The observations of one robot.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Source {
    provenance: Provenance,
    /// The sender of the report; the robot itself for own observations.
    from: RobotId,
    /// Log odds before its observations, given the other sources of the track.
    prior: f64,
    /// Log likelihood ratio of all its observations.
    log_ratio: f64,
    /// Confidence of the last report that was sent; 0 if none. Single precision, because there are hundreds.
    sent_confidence: f32,
    /// Whether own observations have confirmed or refuted it; each source is judged once.
    is_judged: bool,
}

/// All item tracks of a robot.
#[derive(Debug, Clone, Default)]
pub(crate) struct Items {
    pub(crate) tracks: Vec<Track>,
    last_track_id: u32,
    /// Index of the track that was repeated last.
    repeated: usize,
    /// One bit per track: those with reports to be sent, and those with reports to be judged.
    unsent: u64,
    unjudged: u64,
}

/// One observation of an own detector.
#[derive(Debug, Clone, Copy)]
pub(crate) struct OwnObservation<'l> {
    pub(crate) observer: RobotId,
    pub(crate) detector: &'l Detector,
    /// The pose of the robot at that time.
    pub(crate) pose: Pose,
    /// Prior density of items of each kind.
    pub(crate) per_m2: &'l [f64],
}

impl Items {
    /// Updates the tracks with an observation: its contacts, and the items in view that it missed.
    pub(crate) fn observe<'c>(
        &mut self,
        observation: &OwnObservation,
        contacts: impl Iterator<Item = &'c Contact>,
        map: Option<&Map>,
    ) {
        // One bit per detected item.
        let mut detected = 0_u64;
        for contact in contacts {
            detected |= self.associate(observation, contact, detected, map);
        }
        let view = View::new(observation.detector, observation.pose.heading_rad);
        let mut changed = detected;
        for (number, track) in self.tracks.iter_mut().enumerate() {
            if detected & (1 << number) == 0 {
                let in_view = track.probability_in_view(&view, observation, map);
                if in_view > 0.0 {
                    let log_ratio = track.miss_log_ratio(observation, in_view);
                    track.add(
                        (observation.observer, track.prior),
                        &mut self.last_track_id,
                        log_ratio,
                    );
                    changed |= 1 << number;
                }
            }
        }
        self.mark_changed(changed);
    }

    /// Marks tracks for sending and judging.
    fn mark_changed(&mut self, tracks: u64) {
        self.unsent |= tracks;
        self.unjudged |= tracks;
    }

    /// Associates a contact with a track that is not in `taken`, or with a new one; returns its bit.
    fn associate(
        &mut self,
        observation: &OwnObservation,
        contact: &Contact,
        taken: u64,
        map: Option<&Map>,
    ) -> u64 {
        if !(0.0..=1e6).contains(&contact.range_m) || contact.bearing_rad.abs() > 10.0 {
            return 0;
        }
        let relative = direction(contact.bearing_rad).times(contact.range_m);
        let at = observation.pose.in_world(relative);
        let variance_m2 = observation.variance_m2(contact.range_m);
        let index = match self.nearest(contact.kind, at, variance_m2, taken) {
            Some(index) => index,
            None => self.add_track(
                contact.kind,
                at,
                variance_m2,
                observation.remaining_per_m2(contact.kind, at, variance_m2, map),
            ),
        };
        let track = &mut self.tracks[index];
        let log_ratio = track.contact_log_ratio(observation, at, variance_m2, contact.range_m);
        let prior =
            track.prior_with_another(at, variance_m2, density(observation.per_m2, contact.kind));
        track.add(
            (observation.observer, prior),
            &mut self.last_track_id,
            log_ratio,
        );
        track.correct_position(at, variance_m2);
        1 << index
    }

    /// The nearest track of a kind within the gate that is not in `taken`.
    fn nearest(&self, kind: u16, at: Point, variance_m2: f64, taken: u64) -> Option<usize> {
        let tracks = self.tracks.iter().enumerate();
        let same =
            tracks.filter(|(number, track)| track.kind == kind && taken & (1 << number) == 0);
        let near = same.filter_map(|(number, track)| {
            let square = track.at.to(at).length_squared();
            let all_m2 = variance_m2 + track.variance_m2;
            (square <= GATE * GATE * all_m2).then_some((square, number))
        });
        let nearest = near.min_by(|one, other| one.0.total_cmp(&other.0));
        nearest.map(|(_, number)| number)
    }

    /// Adds a track; returns its index.
    fn add_track(&mut self, kind: u16, at: Point, variance_m2: f64, per_m2: f64) -> usize {
        let track = Track {
            kind,
            at,
            variance_m2,
            prior: prior_log_odds(variance_m2, per_m2),
            sources: [Source::default(); SOURCES],
            count: 0,
            edge: 0.0,
        };
        if self.tracks.len() < MAX_TRACKS {
            self.tracks.push(track);
            return self.tracks.len() - 1;
        }
        let numbered = self.tracks.iter().enumerate();
        let log_odds = numbered.map(|(number, track)| (track.log_odds(), number));
        let lowest = log_odds.min_by(|one, other| one.0.total_cmp(&other.0));
        let index = lowest.map_or(0, |(_, number)| number);
        self.tracks[index] = track;
        index
    }

    /// Renumbers the robots, and drops the sources for which `keep` returns false.
    pub(crate) fn renumber(&mut self, keep: impl Fn(&mut RobotId) -> bool) {
        for track in &mut self.tracks {
            let mut kept = 0;
            for slot in 0..track.count {
                let mut source = track.sources[slot];
                if keep(&mut source.provenance.observer) && keep(&mut source.from) {
                    track.sources[kept] = source;
                    kept += 1;
                }
            }
            track.count = kept;
        }
        self.tracks.retain(|track| track.count > 0);
        self.mark_changed(u64::MAX);
    }

    /// Marks the next track for repetition, in turn: messages are lost, and robots may have come into range.
    pub(crate) fn repeat_next(&mut self) {
        self.repeated = (self.repeated + 1)
            .checked_rem(self.tracks.len())
            .unwrap_or(0);
        if let Some(track) = self.tracks.get_mut(self.repeated) {
            for source in &mut track.sources {
                source.sent_confidence = f32::NEG_INFINITY;
            }
            self.unsent |= 1 << self.repeated;
        }
    }
}

/// The indices of the set bits, in increasing order.
fn bits(set: u64) -> impl Iterator<Item = usize> {
    (0..MAX_TRACKS).filter(move |bit| set >> bit & 1 == 1)
}

/// The density of items of a kind.
fn density(per_m2: &[f64], kind: u16) -> f64 {
    per_m2.get(usize::from(kind)).copied().unwrap_or_default()
}

impl OwnObservation<'_> {
    /// Density of undetected items of a kind at a position.
    ///
    /// A cell at the edge of the field of view does not count as observed, though a contact may be in it, and
    /// a contact with an error of more than half a cell may be in any of the surrounding cells. In these
    /// cases, the best observed cell of the neighbourhood determines the density.
    fn remaining_per_m2(&self, kind: u16, at: Point, variance_m2: f64, map: Option<&Map>) -> f64 {
        let unseen = map.map_or(1.0, |map| {
            let cell = map.field.nearest_cell(at);
            let view = View::new(self.detector, self.pose.heading_rad);
            let way = self.pose.at.to(map.field.centre(cell));
            let half_width_m = map.field.cell_m / 2.0;
            let is_clear =
                view.holds_cell(&map.field, way) && variance_m2 < half_width_m * half_width_m;
            let reach = i32::from(!is_clear);
            let cells = map.field.around(cell, reach);
            cells.map(|cell| map.coverage.of(cell)).fold(1.0, f64::min)
        });
        density(self.per_m2, kind) * unseen.max(MIN_UNSEEN)
    }

    /// Variance of the position of a contact at a distance, along each axis.
    fn variance_m2(&self, range_m: f64) -> f64 {
        let lateral_m = range_m * self.pose.deviation_rad;
        let noise_m = self.detector.noise_m.max(MIN_DEVIATION_M);
        noise_m * noise_m + lateral_m * lateral_m + self.pose.deviation_m * self.pose.deviation_m
    }
}

impl Track {
    /// Log odds with full trust in all sources.
    fn log_odds(&self) -> f64 {
        let sources = self.sources[..self.count].iter();
        self.prior + sources.map(|source| source.log_ratio).sum::<f64>()
    }

    /// Log likelihood ratio of a contact.
    fn contact_log_ratio(
        &self,
        observation: &OwnObservation,
        at: Point,
        variance_m2: f64,
        range_m: f64,
    ) -> f64 {
        let kind = usize::from(self.kind);
        let detection = observation.detector.probability(kind, range_m).max(1e-6);
        let all_m2 = variance_m2
            + if self.count == 0 {
                0.0
            } else {
                self.variance_m2
            };
        let distance = self.at.to(at).length_squared() / (2.0 * all_m2);
        let false_per_m2 = observation.detector.false_alarms_per_m2.get(kind);
        let false_per_m2 = false_per_m2.copied().unwrap_or_default().max(1e-12);
        let log_ratio = libm::log(detection / (2.0 * PI * all_m2 * false_per_m2)) - distance;
        log_ratio
            .max(-MAX_OBSERVATION_LOG_RATIO)
            .min(MAX_LOG_ODDS - self.prior)
    }

    /// Log odds before the observations of one more robot, given that it locates the item at a position.
    ///
    /// ```text
    /// odds = odds of the first x odds of the second x N(d; S) / density of items
    /// ```
    ///
    /// Two robots that each observed an item may have observed two different ones; a distance of d with a total
    /// variance of S is evidence for a single one.
    fn prior_with_another(&self, at: Point, variance_m2: f64, per_m2: f64) -> f64 {
        if self.count == 0 {
            return self.prior;
        }
        let all_m2 = self.variance_m2 + variance_m2;
        let distance = self.at.to(at).length_squared() / (2.0 * all_m2);
        prior_log_odds(all_m2, per_m2) + distance
    }

    /// Adds an own observation; `prior` is that of the first one.
    fn add(&mut self, (observer, prior): (RobotId, f64), last_track_id: &mut u32, log_ratio: f64) {
        let own = self.sources[..self.count]
            .iter()
            .position(|source| source.provenance.observer == observer);
        let slot = own.unwrap_or_else(|| {
            *last_track_id = last_track_id.wrapping_add(1);
            let provenance = Provenance {
                observer,
                track_id: *last_track_id,
                observations: 0,
            };
            self.free_slot(observer, f64::INFINITY).map_or(0, |slot| {
                (self.sources[slot].provenance, self.sources[slot].from) = (provenance, observer);
                self.sources[slot].prior = prior;
                slot
            })
        });
        let source = &mut self.sources[slot];
        source.log_ratio = (source.log_ratio + log_ratio)
            .max(-MAX_LOG_ODDS)
            .min(MAX_LOG_ODDS - self.prior);
        source.provenance.observations = source.provenance.observations.saturating_add(1);
    }

    /// A slot for a new source, replacing the weakest one if all are in use; `None` if all others are stronger.
    /// Own observations are never replaced.
    fn free_slot(&mut self, own: RobotId, log_ratio: f64) -> Option<usize> {
        let slot = if self.count < SOURCES {
            self.count += 1;
            self.count - 1
        } else {
            let others = self.sources.iter().enumerate();
            let others = others.filter(|(_, source)| source.provenance.observer != own);
            let strengths = others.map(|(number, source)| (source.log_ratio.abs(), number));
            let weakest = strengths.min_by(|one, other| one.0.total_cmp(&other.0));
            weakest
                .filter(|(strength, _)| *strength < log_ratio.abs())?
                .1
        };
        self.sources[slot] = Source::default();
        Some(slot)
    }

    fn slot_of(&self, provenance: Provenance) -> Option<usize> {
        let sources = self.sources[..self.count].iter();
        let is_same = |source: &Source| {
            source.provenance.observer == provenance.observer
                && source.provenance.track_id == provenance.track_id
        };
        sources.into_iter().position(is_same)
    }

    fn is_observed_by(&self, own: RobotId) -> bool {
        let mut sources = self.sources[..self.count].iter();
        sources.any(|source| source.provenance.observer == own)
    }

    /// Corrects the position.
    fn correct_position(&mut self, at: Point, variance_m2: f64) {
        if self.count == 1 && self.sources[0].provenance.observations <= 1 {
            (self.at, self.variance_m2) = (at, variance_m2);
            return;
        }
        let gain = self.variance_m2 / (self.variance_m2 + variance_m2);
        self.at = self.at.plus(self.at.to(at).times(gain));
        let min_m2 = MIN_DEVIATION_M * MIN_DEVIATION_M;
        self.variance_m2 = (self.variance_m2 * (1.0 - gain)).max(min_m2);
    }

    /// Log likelihood ratio of a miss, if the item was in view with a probability.
    ///
    /// Misses at the edge of the field of view have a common cause, the error of the estimated position, and
    /// are not independent: k of them have the likelihood `in_view (1 - p)^k + 1 - in_view`.
    fn miss_log_ratio(&mut self, observation: &OwnObservation, in_view: f64) -> f64 {
        let distance_m = observation.pose.at.to(self.at).length();
        let detection = observation
            .detector
            .probability(self.kind.into(), distance_m);
        let missed = libm::log1p(-detection.min(0.999));
        if in_view >= 1.0 {
            return missed;
        }
        let likelihood = |edge: f64| in_view * libm::exp(edge) + 1.0 - in_view;
        let before = likelihood(self.edge);
        self.edge = (self.edge + missed).max(-MAX_LOG_ODDS);
        libm::log(likelihood(self.edge) / before)
    }

    /// Probability that the item was in view: five points with the same mean and variance represent the normal
    /// distribution of its position.
    fn probability_in_view(
        &self,
        view: &View,
        observation: &OwnObservation,
        map: Option<&Map>,
    ) -> f64 {
        let way = observation.pose.at.to(self.at);
        let length_m = way.length().max(1e-9);
        let error_m = 2.0 * libm::sqrt(self.variance_m2 + observation.variance_m2(length_m));
        if length_m > observation.detector.range_m + error_m {
            return 0.0;
        }
        let out = way.times(error_m / length_m);
        let aside = Point {
            x: -out.y,
            y: out.x,
        };
        let weight = |at: Point, weight: f64| if view.holds(at) { weight } else { 0.0 };
        let around = [way.plus(out), out.to(way), way.plus(aside), aside.to(way)];
        let total = weight(way, 0.5) + around.map(|at| weight(at, 0.125)).iter().sum::<f64>();
        let is_hidden = || {
            observation.detector.needs_line_of_sight
                && map.is_some_and(|map| {
                    !map.occupancy
                        .is_visible(&map.field, observation.pose.at, self.at, 0.0)
                })
        };
        if total > 0.0 && is_hidden() {
            0.0
        } else {
            total
        }
    }
}

impl Source {
    /// Log odds by its observations alone.
    fn log_odds(&self) -> f64 {
        self.prior + self.log_ratio
    }
}

/// Prior log odds of an item at a position with a variance, given the density of items.
fn prior_log_odds(variance_m2: f64, per_m2: f64) -> f64 {
    log_odds((2.0 * PI * variance_m2 * per_m2).clamp(1e-9, 0.1))
}

fn log_odds(probability: f64) -> f64 {
    libm::log(probability / (1.0 - probability))
}

fn probability(log_odds: f64) -> f64 {
    1.0 / (1.0 + libm::exp(-log_odds))
}

#[cfg(test)]
mod tests;
