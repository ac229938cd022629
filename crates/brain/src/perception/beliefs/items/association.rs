//! Which contacts are of which tracks: by probabilities, none is assigned to a single track.
//!
//! The probability that an item exists, and that it gave each contact, follow from all contacts of an observation
//! (integrated probabilistic data association, Musicki, Evans and Stankovic, *IEEE Transactions on Automatic Control*
//! 39, 1994). The contacts of other tracked items count as further false alarms (its linear multi-target form, Musicki
//! and La Scala, *IEEE Transactions on Aerospace and Electronic Systems* 44, 2008, section V):
//!
//! ```text
//! likelihood ratio of an item = 1 - p + sum over contacts of p N(d; S) / c
//! c   = false alarms per m2 + sum over other tracks of N(d'; S') q / (1 - q)
//! q   = probability of that item x p' for the contact that is most probably of it, 0 for the others
//! p   probability of detection    N(d; S)  normal density of the distance d with the variance of track and contact
//! ```
//!
//! So a contact between two items confirms neither, and the stray contacts of a sure item are no item of their own.

use super::contact::{Look, SeenContact};
use super::group::{Group, Observed};
use super::own_observation::OwnRatio;
use super::track::{MAX_LOG_ODDS, MIN_DEVIATION_M, Track, probability};
use crate::io::agent_id::AgentId;
use crate::io::body::Detector;
use alloc::boxed::Box;
use alloc::vec::Vec;
use base::geometry::Point;

/// The highest probability that the item of another track gave a contact.
const MAX_OTHER: f64 = 0.999;

/// An item that is in view with a lower probability counts as out of view, and one that is out of view with a lower one
/// as in view.
const MIN_IN_VIEW: f64 = 1e-3;

/// An item at a larger distance from the field of view, in standard deviations, counts as out of view.
const MAX_OUT_OF_VIEW: f64 = 3.5;

/// A contact is of a group at a track if its density is more than this part of that at the nearest track.
const AS_NEAR: f64 = 0.1;

/// What a track expects at one contact.
#[derive(Debug, Clone, Copy, Default)]
struct Match {
    /// Density of the contact if the item is detected.
    per_m2: f64,
    /// Probability that the item, if it exists, is detected and reported as the kind of the contact.
    detection: f64,
    /// Whether it is the contact that is most probably of the item.
    is_best: bool,
    /// What the track adds to the false alarms of other tracks.
    claim_per_m2: f64,
    /// `per_m2`, relative to the density of what else the contact may be.
    ratio: f64,
}

/// The contacts of one observation, with scratch memory for the matches of one track with them.
#[derive(Debug, Clone, Default)]
pub(crate) struct Contacts {
    pub(super) seen: Vec<SeenContact>,
    matches: Vec<Match>,
}

impl Contacts {
    /// Takes the contacts of an observation.
    pub(super) fn take(&mut self, seen: impl Iterator<Item = SeenContact>) {
        self.seen.clear();
        self.seen.extend(seen);
    }

    /// Adds the contacts that a track explains.
    pub(super) fn explain(&mut self, track: &Track, look: &Look) {
        if self.match_with(track, look).is_none() {
            return;
        }
        for (seen, each) in self.seen.iter_mut().zip(&self.matches) {
            seen.tracked_per_m2 += each.claim_per_m2;
            let untracked_per_m2 = seen.false_per_m2 + seen.untracked_per_m2;
            seen.nearest_per_m2 = seen.nearest_per_m2.max(each.per_m2);
            seen.is_of_track |= each.is_best && each.per_m2 * each.detection > untracked_per_m2;
        }
    }

    /// Matches a track with each contact. Returns the probability that its item, if it exists, is detected; `None` if no
    /// contact is near it.
    fn match_with(&mut self, track: &Track, look: &Look) -> Option<f64> {
        self.matches.clear();
        let densities = self.seen.iter().map(|seen| look.density(track, seen));
        self.matches.extend(densities.map(|per_m2| Match {
            per_m2,
            ..Match::default()
        }));
        if self.matches.iter().all(|each| each.per_m2 <= 0.0) {
            return None;
        }
        for (each, seen) in self.matches.iter_mut().zip(&self.seen) {
            if each.per_m2 > 0.0 {
                each.detection = track.detection(look, Some(seen.kind));
            }
        }
        let any = track.detection(look, None);
        self.claim(track.own_probability(look.observation.observer), any);
        Some(any)
    }

    /// Determines what a track claims of the contact that is most probably of its item, if that exists and is detected
    /// with some probabilities. An item gives one contact: it explains no others.
    fn claim(&mut self, exists: f64, detected: f64) {
        let pairs = self.matches.iter_mut().zip(&self.seen);
        let relative = pairs.map(|(each, seen)| (each.relative_to(seen.false_per_m2), each));
        let Some((ratio, best)) = relative.max_by(|one, other| one.0.total_cmp(&other.0)) else {
            return;
        };
        if ratio > 0.0 {
            let gave = (exists * detected).min(MAX_OTHER);
            best.claim_per_m2 = best.per_m2 * best.detection / detected * gave / (1.0 - gave);
            best.is_best = true;
        }
    }

    /// Weighs the contacts near a track by what else they may be. Returns the probability that its item, if it exists, is
    /// detected; `None` if there are none.
    fn weigh(&mut self, track: &Track, look: &Look) -> Option<f64> {
        let detected = self.match_with(track, look)?;
        for (each, seen) in self.matches.iter_mut().zip(&self.seen) {
            let others_per_m2 = (seen.tracked_per_m2 - each.claim_per_m2).max(0.0);
            each.ratio = each.per_m2 / (seen.false_per_m2 + others_per_m2);
        }
        Some(detected)
    }

    /// Each contact with its likelihood ratio for the weighed track, against what else it may be.
    fn hits(&self) -> impl Iterator<Item = (f64, &SeenContact)> {
        let pairs = self.matches.iter().zip(&self.seen);
        pairs.map(|(each, seen)| (each.ratio * each.detection, seen))
    }

    /// The reported kinds of the contacts that are of the weighed track, or of items which cannot be tracked apart from it.
    pub(super) fn of_group(&self) -> impl Iterator<Item = u16> {
        let pairs = self.matches.iter().zip(&self.seen);
        let near = pairs.filter(|(each, seen)| {
            let new_per_m2 = seen.false_per_m2 + seen.untracked_per_m2;
            each.per_m2 > new_per_m2 && each.per_m2 > AS_NEAR * seen.nearest_per_m2
        });
        near.map(|(_, seen)| seen.kind)
    }

    /// Sum of the likelihood ratios of the contacts for an item of a kind.
    fn hits_of(&self, kind: usize, detector: &Detector, detection: f64) -> f64 {
        let pairs = self.matches.iter().zip(&self.seen);
        let each = pairs.map(|(each, seen)| each.ratio * detector.reports(kind, seen.kind.into()));
        detection * each.sum::<f64>()
    }
}

impl Match {
    fn relative_to(&self, per_m2: f64) -> f64 {
        self.per_m2 * self.detection / per_m2
    }
}

/// The hits of an observation: near a track, with the probability that one of them is of its item.
struct Hits<'c> {
    contacts: &'c Contacts,
    is_of_item: f64,
}

impl Track {
    /// Updates it with an observation; returns whether its item was in view, or a contact near it.
    pub(super) fn observe(
        &mut self,
        look: &Look,
        contacts: &mut Contacts,
        last_track_id: &mut u32,
    ) -> bool {
        let own = look.observation.observer;
        let in_view = self.probability_in_view(look);
        let Some(detected) = contacts.weigh(self, look) else {
            if in_view > 0.0 {
                let ratio = self.add_likelihoods(look, in_view, None);
                self.add((own, self.prior), last_track_id, ratio);
                self.update_own_kind(look);
                self.update_group(look, None, in_view);
            }
            return in_view > 0.0;
        };
        let contacts = &*contacts;
        let hits: f64 = contacts.hits().map(|(hit, _)| hit).sum();
        let all = hits + 1.0 - detected * in_view;
        let is_of_item = hits / all;
        let prior = self.prior_with_contact(look, contacts, is_of_item);
        let hits = Hits {
            contacts,
            is_of_item,
        };
        let ratio = self.add_likelihoods(look, in_view, Some(&hits));
        self.add((own, prior), last_track_id, ratio);
        if is_of_item > 0.5 {
            self.note_contact(own);
        }
        self.update_group(look, Some(contacts), in_view);
        self.move_to(contacts, all);
        self.update_own_kind(look);
        true
    }

    /// Takes the contacts of an observation for those of a group of items.
    fn update_group(&mut self, look: &Look, contacts: Option<&Contacts>, in_view: f64) {
        let (Some(kinds), Some(hazards)) = (look.kinds, look.hazards) else {
            return;
        };
        // The contact by which the track became an own one does not count: without it, there would be none.
        let is_own = self.own_contact(look.observation.observer).is_some();
        let distance_m = look.observation.pose.at.to(self.at).length();
        let Some(group) = &mut self.group else {
            let new = is_own.then(|| Group::new(kinds.shares().len()));
            self.group = new.flatten().map(Box::new);
            return;
        };
        let observed = Observed {
            detector: look.observation.detector,
            distance_m,
            in_view,
            shares: kinds.shares(),
            hazards,
        };
        let contacts = contacts.into_iter().flat_map(Contacts::of_group);
        group.observe(&observed, contacts);
    }

    /// Log odds before the own observations, the first of which this may be.
    fn prior_with_contact(&self, look: &Look, contacts: &Contacts, is_of_item: f64) -> f64 {
        let best = contacts
            .hits()
            .max_by(|one, other| one.0.total_cmp(&other.0));
        match best {
            Some((_, seen)) if is_of_item > 0.5 => {
                let per_m2 = look.observation.prior_per_m2(seen.kind, look.kinds);
                self.prior_with_another(seen.at, seen.variance_m2, per_m2)
            }
            _ => self.prior,
        }
    }

    /// Adds the likelihood ratios of an observation to the evidence of each kind.
    fn add_likelihoods(&mut self, look: &Look, in_view: f64, hits: Option<&Hits>) -> OwnRatio {
        let detector = look.observation.detector;
        let distance_m = look.observation.pose.at.to(self.at).length();
        let log_ratio = |kind: usize, edge: &mut f64| {
            let detection = detector.probability(kind, distance_m);
            let before = *edge;
            let missed = miss_log_ratio(detection, in_view, edge);
            let Some(hits) = hits else {
                return missed;
            };
            if hits.is_of_item > 0.5 {
                *edge = before;
            }
            let hit = hits.contacts.hits_of(kind, detector, detection);
            libm::log(libm::exp(missed) + hit)
        };
        let Some(kinds) = look.kinds else {
            return OwnRatio::Added(log_ratio(self.kind.into(), &mut self.edge));
        };
        for kind in kinds.each_kind() {
            let place = kinds.place(detector, kind);
            let ratio = log_ratio(kind, &mut self.evidence[place + 1]);
            self.evidence[place] += ratio;
        }
        self.bound_evidence(kinds, detector);
        OwnRatio::Total(self.own_log_ratio(kinds))
    }

    /// Corrects the position by each contact, as far as it is of this item. `all` is the sum of the likelihoods, that of a
    /// miss included. However many contacts there are, the error of the pose remains.
    fn move_to(&mut self, contacts: &Contacts, all: f64) {
        let (mut moved, mut square_m2, mut gain_sum) = (Point::default(), 0.0, 0.0);
        let mut min_m2 = self.variance_m2;
        for (hit, seen) in contacts.hits() {
            let share = hit / all;
            let gain = self.variance_m2 / (self.variance_m2 + seen.variance_m2);
            let way = self.at.to(seen.at).times(gain);
            moved = moved.plus(way.times(share));
            square_m2 += share * way.length_squared();
            gain_sum += share * gain;
            min_m2 = min_m2.min(seen.pose_variance_m2);
        }
        // Not knowing which of the contacts is right adds to the variance.
        let spread_m2 = (square_m2 - moved.length_squared()).max(0.0) / 2.0;
        let variance_m2 = self.variance_m2 * (1.0 - gain_sum) + spread_m2;
        self.variance_m2 = variance_m2.max(min_m2.max(MIN_DEVIATION_M * MIN_DEVIATION_M));
        self.at = self.at.plus(moved);
    }

    /// Probability that its item, if it exists, is detected, and reported as a kind or as any.
    fn detection(&self, look: &Look, reported: Option<u16>) -> f64 {
        let detector = look.observation.detector;
        let distance_m = look.observation.pose.at.to(self.at).length();
        let Some(kinds) = look.kinds else {
            let is_kind = reported.is_none_or(|reported| reported == self.kind);
            let detection = detector.probability(self.kind.into(), distance_m);
            return if is_kind { detection } else { 0.0 };
        };
        let visible = |kind: usize| {
            let reports = reported.map_or(1.0, |reported| detector.reports(kind, reported.into()));
            let detection = detector.probability(kind, distance_m);
            reports * detection * self.visible_share(kinds, detector, kind)
        };
        kinds.each_kind().map(visible).sum()
    }

    /// Probability of its item by own observations alone; 0 without any.
    pub(crate) fn own_probability(&self, own: AgentId) -> f64 {
        let mut sources = self.sources[..self.count].iter();
        let source = sources.find(|source| source.provenance.observer == own);
        source.map_or(0.0, |source| probability(source.log_odds()))
    }

    /// Probability that its item was in view.
    fn probability_in_view(&self, look: &Look) -> f64 {
        let observation = look.observation;
        let offset = observation.pose.at.to(self.at);
        let variance_m2 = self.variance_m2 + observation.pose_variance_m2(offset.length());
        let deviation_m = libm::sqrt(variance_m2);
        if look.view.is_beyond(offset, MAX_OUT_OF_VIEW * deviation_m) {
            return 0.0;
        }
        let in_view = look.in_view(self.at, deviation_m);
        let is_hidden = || {
            let map = look
                .map
                .filter(|_| observation.detector.needs_line_of_sight);
            map.is_some_and(|map| {
                let from = observation.pose.at;
                !map.occupancy.is_visible(&map.field, from, self.at, 0.0)
            })
        };
        if in_view < MIN_IN_VIEW || is_hidden() {
            0.0
        } else {
            in_view
        }
    }
}

/// Log likelihood ratio of a miss with a probability of detection, if the item was in view with a probability;
/// `edge` is the log likelihood of all misses at the edge of the field of view.
///
/// Those have a common cause, the error of the estimated position, and are not independent. The
/// likelihood of k of them is `in_view (1 - p)^k + 1 - in_view`.
fn miss_log_ratio(detection: f64, in_view: f64, edge: &mut f64) -> f64 {
    let missed = libm::log1p(-detection.min(0.999));
    if in_view > 1.0 - MIN_IN_VIEW {
        return missed;
    }
    let likelihood = |edge: f64| in_view * libm::exp(edge) + 1.0 - in_view;
    let before = likelihood(*edge);
    *edge = (*edge + missed).max(-MAX_LOG_ODDS);
    libm::log(likelihood(*edge) / before)
}
