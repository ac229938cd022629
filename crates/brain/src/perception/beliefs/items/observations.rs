//! Own observations of items: existing tracks, and new ones.

use super::contact::{Look, SeenContact};
use super::kinds::KindModel;
use super::own_observation::{OwnObservation, OwnRatio};
use super::track::{MAX_LOG_ODDS, Source, Track};
use super::track_set::TrackSet;
use super::tracks::Items;
use crate::io::agent_id::AgentId;
use crate::io::body::Detector;
use crate::io::message::Provenance;
use crate::io::percept::Contact;
use crate::perception::beliefs::map::Map;
use core::f64::consts::PI;

/// Minimum probability that an item is in view which has just been detected.
const MIN_DETECTED_IN_VIEW: f64 = 1e-3;

impl Items {
    /// Updates the tracks with an observation: its contacts, and the items in view that it missed.
    pub(crate) fn observe<'c>(
        &mut self,
        observation: &OwnObservation,
        contacts: impl Iterator<Item = &'c Contact>,
        map: Option<&Map>,
    ) {
        let kinds = self.kinds.clone();
        let look = Look::new(observation, map, (kinds.as_deref(), self.hazards));
        let mut seen = core::mem::take(&mut self.contacts);
        seen.take(contacts.filter_map(|contact| look.contact(contact)));
        for track in &self.tracks {
            seen.explain(track, &look);
        }
        let mut changed = TrackSet::default();
        for (number, track) in self.tracks.iter_mut().enumerate() {
            if track.observe(&look, &mut seen, &mut self.last_track_id) {
                changed.insert(number);
            }
        }
        for contact in seen.seen.iter().filter(|contact| !contact.is_of_track) {
            let track = look.new_track(contact, &mut self.last_track_id);
            changed.insert(self.add_track(track));
        }
        self.contacts = seen;
        self.end_duplicates(observation.observer, &changed);
        self.mark_changed(&changed);
    }
}

impl Look<'_> {
    /// A new track of a contact.
    fn new_track(&self, contact: &SeenContact, last_track_id: &mut u32) -> Track {
        let SeenContact {
            kind,
            at,
            variance_m2,
            unseen,
            ..
        } = *contact;
        let observation = self.observation;
        let per_m2 = observation.prior_per_m2(kind, self.kinds);
        let in_view = self
            .in_view(at, libm::sqrt(variance_m2))
            .max(MIN_DETECTED_IN_VIEW);
        let background_per_m2 = contact.false_per_m2 + contact.tracked_per_m2;
        let likelihood = in_view / (2.0 * PI * variance_m2 * background_per_m2);
        let log_ratio = |true_kind: usize| {
            let detection = observation.detector.probability(true_kind, contact.range_m);
            let reports = observation.detector.reports(true_kind, kind.into());
            libm::log((detection * reports).max(1e-6) * likelihood)
        };
        // Items to which the sensor is blind are as probable as before: they have no misses.
        let in_prior = if self.kinds.is_some() { 1.0 } else { unseen };
        let mut track = Track::new(kind, at, variance_m2, per_m2 * in_prior);
        let ratio = match self.kinds {
            None => OwnRatio::Added(log_ratio(kind.into())),
            Some(kinds) => {
                track.evidence = kinds.no_evidence();
                for true_kind in kinds.each_kind() {
                    let misses = observation.relative_misses(true_kind, contact.range_m);
                    let place = kinds.place(observation.detector, true_kind);
                    track.evidence[place] = libm::log(unseen) * misses + log_ratio(true_kind);
                }
                track.bound_evidence(kinds, observation.detector);
                OwnRatio::Total(track.own_log_ratio(kinds))
            }
        };
        track.add((observation.observer, track.prior), last_track_id, ratio);
        track.note_contact(observation.observer);
        track.update_own_kind(self);
        track
    }
}

impl Track {
    /// Bounds the evidence of a sensor model. Above, all kinds are lowered by the same amount: what distinguishes
    /// them stays.
    pub(super) fn bound_evidence(&mut self, kinds: &KindModel, detector: &Detector) {
        let places = kinds.each_kind().map(|kind| kinds.place(detector, kind));
        let sums = places.clone().map(|place| self.evidence[place]);
        let highest = sums.fold(f64::NEG_INFINITY, f64::max);
        let excess = (highest - (MAX_LOG_ODDS - self.prior)).max(0.0);
        for place in places {
            let sum = self.evidence[place] - excess;
            self.evidence[place] = sum.max(-2.0 * MAX_LOG_ODDS);
        }
    }

    /// Adds an own observation; `prior` is that of the first one.
    pub(super) fn add(
        &mut self,
        (observer, prior): (AgentId, f64),
        last_track_id: &mut u32,
        ratio: OwnRatio,
    ) {
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
            let slot = self.own_slot();
            self.sources[slot] = Source {
                provenance,
                from: observer,
                prior,
                ..Source::default()
            };
            slot
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
    pub(super) fn note_contact(&mut self, observer: AgentId) {
        let mut sources = self.sources[..self.count].iter_mut();
        if let Some(own) = sources.find(|source| source.provenance.observer == observer) {
            own.is_contact = true;
        }
    }

    /// Updates the most probable kind, if kinds are uncertain.
    pub(super) fn update_own_kind(&mut self, look: &Look) {
        if let Some(kinds) = look.kinds {
            self.update_kind(kinds, look.observation.observer);
        }
    }
}
