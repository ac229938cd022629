//! Own observations of items, and their likelihoods.

use super::kinds::KindModel;
use super::track::{MAX_LOG_ODDS, MIN_DEVIATION_M, Track};
use super::track_set::TrackSet;
use super::tracks::{Items, density};
use crate::io::body::{Detector, RobotId};
use crate::io::message::Provenance;
use crate::io::percept::Contact;
use crate::perception::beliefs::coverage_map::MAX_DETECTION;
use crate::perception::beliefs::map::Map;
use crate::perception::beliefs::pose::Pose;
use crate::perception::beliefs::view::View;
use crate::perception::sector::direction;
use base::geometry::Point;
use core::f64::consts::PI;

/// Limit of the log likelihood ratio of one observation against an item, in nats.
const MAX_OBSERVATION_LOG_RATIO: f64 = 8.0;

/// Lower limit of the factor by which unsuccessful observations reduce the density of items:
/// detector models have errors.
const MIN_UNSEEN: f64 = 0.01;

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
        let mut detected = TrackSet::default();
        for contact in contacts {
            if let Some(track) = self.associate(observation, contact, &detected, map) {
                detected.insert(track);
            }
        }
        let view = View::new(observation.detector, observation.pose.heading_rad);
        let mut changed = detected;
        for (number, track) in self.tracks.iter_mut().enumerate() {
            if !detected.contains(number) {
                let in_view = track.probability_in_view(&view, observation, map);
                if in_view > 0.0 {
                    let ratio = match &self.kinds {
                        Some(kinds) => track.add_miss(kinds, observation, in_view),
                        None => OwnRatio::Added(track.miss_log_ratio(observation, in_view)),
                    };
                    track.add(
                        (observation.observer, track.prior),
                        &mut self.last_track_id,
                        ratio,
                    );
                    if let Some(kinds) = &self.kinds {
                        track.update_kind(kinds, observation.observer);
                    }
                    changed.insert(number);
                }
            }
        }
        self.mark_changed(&changed);
    }

    /// Associates a contact with a track that is not in `taken`, or with a new one; returns its
    /// index.
    fn associate(
        &mut self,
        observation: &OwnObservation,
        contact: &Contact,
        taken: &TrackSet,
        map: Option<&Map>,
    ) -> Option<usize> {
        if !(0.0..=1e6).contains(&contact.range_m) || contact.bearing_rad.abs() > 10.0 {
            return None;
        }
        let relative = direction(contact.bearing_rad).times(contact.range_m);
        let at = observation.pose.in_world(relative);
        let variance_m2 = observation.variance_m2(contact.range_m);
        let nearest = self.nearest(contact.kind, at, variance_m2, taken);
        let kinds = self.kinds.clone();
        let kinds = kinds.as_deref();
        let index = nearest.unwrap_or_else(|| {
            let unseen = observation.unseen(at, variance_m2, map);
            self.add_track(observation.new_track(contact.kind, (at, variance_m2), unseen, kinds))
        });
        let track = &mut self.tracks[index];
        let place = (at, variance_m2);
        let ratio = if let Some(kinds) = kinds {
            track.add_contact(kinds, observation, contact, place)
        } else {
            let kinds = [contact.kind, contact.kind].map(usize::from);
            let log_ratio = track.contact_log_ratio(observation, kinds, place, contact.range_m);
            OwnRatio::Added(log_ratio.min(MAX_LOG_ODDS - track.prior))
        };
        let per_m2 = prior_per_m2(observation.per_m2, contact.kind, kinds);
        let prior = track.prior_with_another(at, variance_m2, per_m2);
        track.add(
            (observation.observer, prior),
            &mut self.last_track_id,
            ratio,
        );
        track.note_contact(observation.observer);
        track.correct_position(at, variance_m2);
        if let Some(kinds) = kinds {
            track.update_kind(kinds, observation.observer);
        }
        Some(index)
    }
}

impl OwnObservation<'_> {
    /// A new track of a contact; `unseen` is the probability that earlier observations missed an item there.
    fn new_track(
        &self,
        kind: u16,
        (at, variance_m2): (Point, f64),
        unseen: f64,
        kinds: Option<&KindModel>,
    ) -> Track {
        let per_m2 = prior_per_m2(self.per_m2, kind, kinds);
        let Some(kinds) = kinds else {
            return Track::new(kind, at, variance_m2, per_m2 * unseen);
        };
        let mut track = Track::new(kind, at, variance_m2, per_m2);
        track.evidence = kinds.no_evidence();
        // Items to which the sensor is blind are as probable as before.
        let range_m = self.pose.at.to(at).length();
        for kind in kinds.each_kind() {
            let place = kinds.place(self.detector, kind);
            track.evidence[place] = libm::log(unseen) * self.relative_misses(kind, range_m);
        }
        track
    }

    /// Log likelihood of a miss of a kind, relative to that of the coverage map: of the kind that is detected least.
    fn relative_misses(&self, kind: usize, range_m: f64) -> f64 {
        let [least, own] = [
            self.detector.min_probability(range_m),
            self.detector.probability(kind, range_m),
        ];
        let [least, own] = [least, own].map(|p| libm::log1p(-p.clamp(1e-6, MAX_DETECTION)));
        own / least
    }

    /// Probability that no observation so far would have detected an item at a position.
    ///
    /// A cell at the edge of the field of view does not count as observed, though a contact may be
    /// in it, and a contact with an error of more than half a cell may be in any of the surrounding
    /// cells. In these cases, the best observed cell of the neighbourhood determines the density.
    fn unseen(&self, at: Point, variance_m2: f64, map: Option<&Map>) -> f64 {
        let unseen = map.map_or(1.0, |map| {
            let cell = map.field.nearest_cell(at);
            let view = View::new(self.detector, self.pose.heading_rad);
            let offset = self.pose.at.to(map.field.centre(cell));
            let half_width_m = map.field.cell_m / 2.0;
            let is_clear =
                view.holds_cell(&map.field, offset) && variance_m2 < half_width_m * half_width_m;
            let reach = i32::from(!is_clear);
            let cells = map.field.around(cell, reach);
            cells.map(|cell| map.coverage.of(cell)).fold(1.0, f64::min)
        });
        unseen.max(MIN_UNSEEN)
    }

    /// Variance of the position of a contact at a distance, along each axis.
    fn variance_m2(&self, range_m: f64) -> f64 {
        let lateral_m = range_m * self.pose.deviation_rad;
        let noise_m = self.detector.noise_m.max(MIN_DEVIATION_M);
        noise_m * noise_m + lateral_m * lateral_m + self.pose.deviation_m * self.pose.deviation_m
    }
}

/// Log likelihood ratio of own observations for an item.
#[derive(Clone, Copy)]
enum OwnRatio {
    /// Of one observation.
    Added(f64),
    /// Of all of them.
    Total(f64),
}

/// Prior density of what a contact of a kind may be.
fn prior_per_m2(per_m2: &[f64], kind: u16, kinds: Option<&KindModel>) -> f64 {
    if kinds.is_some() {
        per_m2.iter().sum()
    } else {
        density(per_m2, kind)
    }
}

/// Log likelihood ratio of a miss with a probability of detection, if the item was in view with a probability;
/// `edge` is the log likelihood of all misses at the edge of the field of view.
///
/// Those have a common cause, the error of the estimated position, and are not independent. The
/// likelihood of k of them is `in_view (1 - p)^k + 1 - in_view`.
fn miss_log_ratio(detection: f64, in_view: f64, edge: &mut f64) -> f64 {
    let missed = libm::log1p(-detection.min(0.999));
    if in_view >= 1.0 {
        return missed;
    }
    let likelihood = |edge: f64| in_view * libm::exp(edge) + 1.0 - in_view;
    let before = likelihood(*edge);
    *edge = (*edge + missed).max(-MAX_LOG_ODDS);
    libm::log(likelihood(*edge) / before)
}

impl Track {
    /// Adds a contact at a position with a variance to the evidence of each kind.
    fn add_contact(
        &mut self,
        kinds: &KindModel,
        observation: &OwnObservation,
        contact: &Contact,
        place: (Point, f64),
    ) -> OwnRatio {
        for kind in kinds.each_kind() {
            let reported = [kind, contact.kind.into()];
            let ratio = self.contact_log_ratio(observation, reported, place, contact.range_m);
            self.evidence[kinds.place(observation.detector, kind)] += ratio;
        }
        self.bound_evidence(kinds, observation.detector);
        OwnRatio::Total(self.own_log_ratio(kinds))
    }

    /// Adds a miss to the evidence of each kind, if the item was in view with a probability.
    fn add_miss(
        &mut self,
        kinds: &KindModel,
        observation: &OwnObservation,
        in_view: f64,
    ) -> OwnRatio {
        let distance_m = observation.pose.at.to(self.at).length();
        for kind in kinds.each_kind() {
            let place = kinds.place(observation.detector, kind);
            let detection = observation.detector.probability(kind, distance_m);
            let ratio = miss_log_ratio(detection, in_view, &mut self.evidence[place + 1]);
            self.evidence[place] += ratio;
        }
        self.bound_evidence(kinds, observation.detector);
        OwnRatio::Total(self.own_log_ratio(kinds))
    }

    /// Bounds the evidence of a sensor model. Above, all kinds are lowered by the same amount: what distinguishes
    /// them stays.
    fn bound_evidence(&mut self, kinds: &KindModel, detector: &Detector) {
        let places = kinds.each_kind().map(|kind| kinds.place(detector, kind));
        let sums = places.clone().map(|place| self.evidence[place]);
        let highest = sums.fold(f64::NEG_INFINITY, f64::max);
        let excess = (highest - (MAX_LOG_ODDS - self.prior)).max(0.0);
        for place in places {
            let sum = self.evidence[place] - excess;
            self.evidence[place] = sum.max(-2.0 * MAX_LOG_ODDS);
        }
    }

    /// Log likelihood ratio of a contact: of an item of a kind that is reported as another or the same.
    fn contact_log_ratio(
        &self,
        observation: &OwnObservation,
        [kind, reported]: [usize; 2],
        (at, variance_m2): (Point, f64),
        range_m: f64,
    ) -> f64 {
        let detector = observation.detector;
        let detection = detector.probability(kind, range_m) * detector.reports(kind, reported);
        let detection = detection.max(1e-6);
        let all_m2 = variance_m2
            + if self.count == 0 {
                0.0
            } else {
                self.variance_m2
            };
        let distance = self.at.to(at).length_squared() / (2.0 * all_m2);
        let false_per_m2 = detector.false_alarms_per_m2.get(reported);
        let false_per_m2 = false_per_m2.copied().unwrap_or_default().max(1e-12);
        let log_ratio = libm::log(detection / (2.0 * PI * all_m2 * false_per_m2)) - distance;
        log_ratio.max(-MAX_OBSERVATION_LOG_RATIO)
    }

    /// Adds an own observation; `prior` is that of the first one.
    fn add(&mut self, (observer, prior): (RobotId, f64), last_track_id: &mut u32, ratio: OwnRatio) {
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
        let log_ratio = match ratio {
            OwnRatio::Added(log_ratio) => source.log_ratio + log_ratio,
            OwnRatio::Total(log_ratio) => log_ratio,
        };
        source.log_ratio = log_ratio.max(-MAX_LOG_ODDS).min(MAX_LOG_ODDS - self.prior);
        source.provenance.observations = source.provenance.observations.saturating_add(1);
    }

    /// Notes that an own detector has detected it.
    fn note_contact(&mut self, observer: RobotId) {
        let mut sources = self.sources[..self.count].iter_mut();
        if let Some(own) = sources.find(|source| source.provenance.observer == observer) {
            own.is_contact = true;
        }
    }

    /// Log likelihood ratio of a miss, if the item was in view with a probability.
    fn miss_log_ratio(&mut self, observation: &OwnObservation, in_view: f64) -> f64 {
        let distance_m = observation.pose.at.to(self.at).length();
        let detection = observation
            .detector
            .probability(self.kind.into(), distance_m);
        miss_log_ratio(detection, in_view, &mut self.edge)
    }

    /// Probability that the item was in view: five points with the same mean and variance represent
    /// the normal distribution of its position.
    fn probability_in_view(
        &self,
        view: &View,
        observation: &OwnObservation,
        map: Option<&Map>,
    ) -> f64 {
        let offset = observation.pose.at.to(self.at);
        let length_m = offset.length().max(1e-9);
        let error_m = 2.0 * libm::sqrt(self.variance_m2 + observation.variance_m2(length_m));
        if length_m > observation.detector.range_m + error_m {
            return 0.0;
        }
        let out = offset.times(error_m / length_m);
        let aside = Point {
            x: -out.y,
            y: out.x,
        };
        let weight = |at: Point, weight: f64| if view.holds(at) { weight } else { 0.0 };
        let around = [
            offset.plus(out),
            out.to(offset),
            offset.plus(aside),
            aside.to(offset),
        ];
        let total = weight(offset, 0.5) + around.map(|at| weight(at, 0.125)).iter().sum::<f64>();
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
