//! Uncertain kinds, and sensors that are blind to a share of the items, or to which they look like another kind.
//!
//! For each own sensor model and each kind, a track has the log likelihood ratio E of all measurements of that
//! model: of an item that looks like that kind to the model, which can detect it, against false alarms alone. An item to
//! which the model is blind leaves the measurements as they are without it, so that its ratio is 1:
//!
//! ```text
//! likelihood of kind k = product over models of (b + (1 - b) sum over kinds a of s x exp(E of a))
//! own log ratio        = ln(sum over kinds of share k x likelihood k)
//! a contact reported as kind j adds to E of a  ln(p C N(d; S) / f)    p: probability of detection of kind a,
//! a miss adds                                  ln(1 - p)              C: probability that kind a is reported as j,
//!                                                                     f: false alarms of kind j per m2,
//!                                                                     b: blind share of kind k,
//!                                                                     s: share of kind k that looks like kind a
//! ```
//!
//! However often a sensor misses an item, the likelihood therefore stays above the blind share; and however often it
//! reports an item as clutter, the probability of a mine stays above that of a mine that looks like clutter.
//!
//! A report names one kind, and states the probability of an item of that kind and that of the kind given an item. What is
//! left is divided among the other kinds by the confusion of the known detectors: as if that kind had been reported once.

use super::track::{SOURCES, Source, Track};
use crate::io::agent_id::AgentId;
use crate::io::body::{Body, Detector};
use alloc::vec;
use alloc::vec::Vec;

/// Numbers per model and kind in the evidence of a track: the log likelihood ratio, and that of misses at the
/// edge of the field of view.
const NUMBERS: usize = 2;

/// The highest part of what a report leaves open that counts for other kinds.
const MAX_OTHER: f64 = 0.5;

/// The highest probability of the named kind of a report: a report contradicts many own measurements only so far.
const MAX_NAMED: f64 = 0.99;

/// What a robot knows of the kinds of items and of its sensor models.
#[derive(Debug, Clone)]
pub(crate) struct KindModel {
    /// Share of each kind among the items.
    shares: Vec<f64>,
    /// Own sensor models.
    models: Vec<u32>,
    /// Blind share by model, and by kind within it.
    blind: Vec<f64>,
    /// By model, and by kind within it: the kinds that its items look like, each with their share.
    appearances: Vec<Vec<(usize, f64)>>,
    /// Probability of each true kind by the reported kind, row by row.
    reported: Vec<f64>,
}

impl KindModel {
    /// For items of each kind with a density; `None` if all own detectors report all items, as they are.
    pub(crate) fn new(body: &Body, per_m2: &[f64]) -> Option<Self> {
        let mut own = body.detectors.iter();
        if !own.any(Detector::is_uncertain) {
            return None;
        }
        let total: f64 = per_m2.iter().sum();
        let even = 1.0 / f64::from(u32::try_from(per_m2.len().max(1)).unwrap_or(u32::MAX));
        let share = |density: &f64| if total > 0.0 { density / total } else { even };
        let shares: Vec<f64> = per_m2.iter().map(share).collect();
        let mut models: Vec<u32> = body
            .detectors
            .iter()
            .map(|detector| detector.model)
            .collect();
        models.sort_unstable();
        models.dedup();
        Some(Self {
            blind: blind_shares(&models, &body.detectors, shares.len()),
            appearances: appearances(&models, &body.detectors, shares.len()),
            reported: reported(body, &shares),
            shares,
            models,
        })
    }

    fn kinds(&self) -> usize {
        self.shares.len()
    }

    /// The evidence of a track without measurements.
    pub(crate) fn no_evidence(&self) -> Vec<f64> {
        vec![0.0; NUMBERS * self.models.len() * self.kinds()]
    }

    /// The numbers of one kind in the evidence of a track, for the model of a detector.
    pub(super) fn place(&self, detector: &Detector, kind: usize) -> usize {
        let mut models = self.models.iter();
        let model = models.position(|model| *model == detector.model);
        NUMBERS * (model.unwrap_or(0) * self.kinds() + kind)
    }

    /// Share of each kind among the items.
    pub(crate) fn shares(&self) -> &[f64] {
        &self.shares
    }

    pub(super) fn each_kind(&self) -> core::ops::Range<usize> {
        0..self.kinds()
    }

    /// Probability of any item, for a report with this confidence in an item of a kind that does not state its share.
    pub(crate) fn any_by_report(&self, kind: u16, confidence: f64) -> f64 {
        let named = self.true_kind(kind, usize::from(kind)).max(1e-6);
        let other = confidence * (1.0 - named) / named;
        confidence + other.min(MAX_OTHER * (1.0 - confidence))
    }

    /// Probability of a true kind by a reported one.
    fn true_kind(&self, reported: u16, kind: usize) -> f64 {
        let place = usize::from(reported) * self.kinds() + kind;
        self.reported.get(place).copied().unwrap_or_default()
    }

    /// Probability of a kind, given that there is an item, by a report with a trust.
    fn by_report(&self, source: &Source, kind: usize, trust: f64) -> f64 {
        let named = f64::from(source.kind_share).min(MAX_NAMED);
        let by_report = if usize::from(source.kind) == kind {
            named
        } else {
            let others = 1.0 - self.true_kind(source.kind, source.kind.into());
            let of_others = if others > 1e-9 {
                self.true_kind(source.kind, kind) / others
            } else {
                let named = self.shares.get(usize::from(source.kind));
                self.shares[kind] / (1.0 - named.copied().unwrap_or_default()).max(1e-9)
            };
            (1.0 - named) * of_others
        };
        trust * by_report + (1.0 - trust) * self.shares[kind]
    }
}

/// The blind shares of models, by kind; of detectors of one model, the largest.
fn blind_shares(models: &[u32], detectors: &[Detector], kinds: usize) -> Vec<f64> {
    let of = |model: u32, kind: usize| {
        let own = detectors.iter().filter(|detector| detector.model == model);
        let shares = own.filter_map(|detector| detector.blind_share.get(kind).copied());
        shares.fold(0.0, f64::max)
    };
    let models = models.iter();
    models
        .flat_map(|model| (0..kinds).map(move |kind| of(*model, kind)))
        .collect()
}

/// For models, by kind: the kinds that its items look like; of detectors of one model, those of the first that states any.
fn appearances(models: &[u32], detectors: &[Detector], kinds: usize) -> Vec<Vec<(usize, f64)>> {
    let of = |model: u32, kind: usize| {
        let mut own = detectors.iter().filter(|detector| detector.model == model);
        let stated = own.find(|detector| !detector.lookalike_share.is_empty());
        let each = (0..kinds).map(|seen| {
            (
                seen,
                stated.map_or_else(|| same(kind, seen), |one| one.appears(kind, seen)),
            )
        });
        each.filter(|(_, share)| *share > 0.0).collect()
    };
    let models = models.iter();
    models
        .flat_map(|model| (0..kinds).map(move |kind| of(*model, kind)))
        .collect()
}

/// 1 if two kinds are the same, and otherwise 0.
fn same(kind: usize, other: usize) -> f64 {
    f64::from(u8::from(kind == other))
}

/// Probability of each true kind by the reported kind, for one contact of the known detectors.
fn reported(body: &Body, shares: &[f64]) -> Vec<f64> {
    let others = body.others.iter().flat_map(|other| &other.detectors);
    let detectors: Vec<&Detector> = body.detectors.iter().chain(others).collect();
    let kinds = shares.len();
    let weight = |reported: usize, kind: usize| {
        let each = detectors.iter();
        let contacts = each.map(|detector| detector.contacts((kind, 1.0), reported, 0.0));
        shares[kind] * contacts.sum::<f64>()
    };
    let row = |reported: usize| {
        let total: f64 = (0..kinds).map(|kind| weight(reported, kind)).sum();
        (0..kinds).map(move |kind| (weight(reported, kind), total))
    };
    let rows = (0..kinds).flat_map(row);
    rows.map(|(weight, total)| if total > 0.0 { weight / total } else { 0.0 })
        .collect()
}

impl Detector {
    /// Whether it is blind to items, or does not report all of them as they are.
    fn is_uncertain(&self) -> bool {
        let is_certain = self.confusion.is_empty()
            && self.blind_share.is_empty()
            && self.lookalike_share.is_empty();
        !is_certain
    }

    /// Probability that a detected item that looks like a kind is reported as another.
    pub(crate) fn reports(&self, kind: usize, reported: usize) -> f64 {
        of_kinds(&self.confusion, kind, reported)
    }

    /// Share of the items of a kind that look like another to its model.
    fn appears(&self, kind: usize, seen: usize) -> f64 {
        of_kinds(&self.lookalike_share, kind, seen)
    }

    /// Contacts at a distance, reported as a kind, of a number of items of a true kind to none of which it is blind.
    pub(crate) fn contacts(
        &self,
        (kind, items): (usize, f64),
        reported: usize,
        range_m: f64,
    ) -> f64 {
        let as_kind = |(seen, items): (usize, f64)| {
            items * self.probability(seen, range_m) * self.reports(seen, reported)
        };
        if self.lookalike_share.is_empty() {
            return as_kind((kind, items));
        }
        let kinds = 0..self.lookalike_share.len();
        let seen = kinds.map(|seen| (seen, items * self.appears(kind, seen)));
        seen.map(as_kind).sum()
    }
}

/// A number of two kinds, by row and column; without rows, each kind is what it is.
fn of_kinds(rows: &[Vec<f64>], kind: usize, other: usize) -> f64 {
    if rows.is_empty() {
        return same(kind, other);
    }
    let row = rows.get(kind);
    let number = row.and_then(|row| row.get(other));
    number.copied().unwrap_or_default()
}

impl Track {
    /// Likelihood ratio of all own measurements for an item of a kind.
    fn own_likelihood(&self, kinds: &KindModel, kind: usize) -> f64 {
        let models = 0..kinds.models.len();
        let of_model = |model: usize| {
            let blind = kinds.blind[model * kinds.kinds() + kind];
            blind + (1.0 - blind) * self.visible_likelihood(kinds, model, kind)
        };
        models.map(of_model).product()
    }

    /// Likelihood ratio of the measurements of a model for an item of a kind that it can detect, whatever the item looks
    /// like.
    fn visible_likelihood(&self, kinds: &KindModel, model: usize, kind: usize) -> f64 {
        let first = model * kinds.kinds();
        let seen = kinds.appearances[first + kind].iter();
        seen.map(|(seen, share)| share * libm::exp(self.evidence[NUMBERS * (first + seen)]))
            .sum()
    }

    /// Probability that a detector can see an item and that it looks like a kind to it, given that there is an item, by
    /// own measurements.
    pub(super) fn visible_share(&self, kinds: &KindModel, detector: &Detector, seen: usize) -> f64 {
        let total: f64 = kinds
            .each_kind()
            .map(|kind| kinds.shares[kind] * self.own_likelihood(kinds, kind))
            .sum();
        let place = kinds.place(detector, seen);
        let model = place / NUMBERS / kinds.kinds();
        let share_of = |kind: usize| {
            let blind = kinds.blind[model * kinds.kinds() + kind];
            let mut like = kinds.appearances[model * kinds.kinds() + kind].iter();
            let (_, share) = like.find(|(like, _)| *like == seen)?;
            let visible = (1.0 - blind) * (share * libm::exp(self.evidence[place]));
            let all = (1.0 - blind) * self.visible_likelihood(kinds, model, kind);
            let of_all = kinds.shares[kind] * self.own_likelihood(kinds, kind);
            Some(of_all / total.max(f64::MIN_POSITIVE) * visible / (blind + all))
        };
        kinds.each_kind().filter_map(share_of).sum()
    }

    /// For each kind, the log likelihood ratio of all own measurements for an item that looks like it and that the own
    /// sensor models can detect.
    pub(crate) fn visible_log_ratios(&self, kinds: &KindModel) -> Vec<f64> {
        let each = kinds.each_kind();
        let of = |kind: usize| {
            let models = 0..kinds.models.len();
            let ratios =
                models.map(|model| self.evidence[NUMBERS * (model * kinds.kinds() + kind)]);
            ratios.sum()
        };
        each.map(of).collect()
    }

    /// Log likelihood ratio of all own measurements for an item of any kind.
    pub(super) fn own_log_ratio(&self, kinds: &KindModel) -> f64 {
        let each = kinds.each_kind();
        let sum = each.map(|kind| kinds.shares[kind] * self.own_likelihood(kinds, kind));
        libm::log(sum.sum::<f64>().max(f64::MIN_POSITIVE))
    }

    /// The most probable kind by own measurements, and its probability, given that there is an item.
    pub(crate) fn own_kind(&self, kinds: &KindModel) -> (u16, f64) {
        likeliest(kinds, |kind| self.own_likelihood(kinds, kind))
    }

    /// Updates the most probable kind, by own measurements and all reports.
    pub(crate) fn update_kind(&mut self, kinds: &KindModel, own: AgentId) {
        let all = |_: &Source| Some(1.0);
        self.kind = self.kind_and_agreement(kinds, own, &all).0;
    }

    /// Writes the probability of each kind, given that there is an item, by own measurements and all reports.
    pub(crate) fn write_kind_shares(&self, kinds: &KindModel, own: AgentId, into: &mut Vec<f64>) {
        let by_reports = self.report_likelihood(kinds, own, &|_| Some(1.0));
        let weight =
            |kind| kinds.shares[kind] * self.own_likelihood(kinds, kind) * by_reports(kind);
        into.clear();
        into.extend(kinds.each_kind().map(weight));
        let total: f64 = into.iter().sum();
        for share in into {
            *share /= total.max(f64::MIN_POSITIVE);
        }
    }

    /// Likelihood ratio of the reports of other robots for an item of a kind, against one of any kind.
    fn report_likelihood(
        &self,
        kinds: &KindModel,
        own: AgentId,
        trust: &impl Fn(&Source) -> Option<f64>,
    ) -> impl Fn(usize) -> f64 {
        let mut trusts = [None; SOURCES];
        let sources = &self.sources[..self.count];
        for (place, source) in sources.iter().enumerate() {
            // Looks that have only missed are no evidence of a kind.
            if source.provenance.observer != own && source.log_ratio > 0.0 {
                trusts[place] = trust(source);
            }
        }
        move |kind: usize| {
            let share = kinds.shares[kind].max(1e-9);
            let each = sources.iter().zip(&trusts);
            let counted = each.filter_map(|(source, trust)| Some((source, (*trust)?)));
            counted.fold(1.0, |product, (source, trust)| {
                product * kinds.by_report(source, kind, trust) / share
            })
        }
    }

    /// The most probable kind, its probability given that there is an item, and the factors on the odds of an item
    /// by the agreement of the kinds: of all sources, and of reports alone. Sources count with a trust, or not at
    /// all.
    ///
    /// With the probabilities `q` of each kind by the sources, the factor is the sum over kinds of the share of the
    /// kind x the product of `q / share`: 1 for a single source, and less for sources that contradict each other.
    pub(crate) fn kind_and_agreement(
        &self,
        kinds: &KindModel,
        own: AgentId,
        trust: &impl Fn(&Source) -> Option<f64>,
    ) -> (u16, f64, [f64; 2]) {
        let by_reports = self.report_likelihood(kinds, own, trust);
        let own_total = libm::exp(self.own_log_ratio(kinds));
        let sum = |of: &dyn Fn(usize) -> f64| -> f64 {
            kinds
                .each_kind()
                .map(|kind| kinds.shares[kind] * of(kind))
                .sum()
        };
        let both = |kind: usize| self.own_likelihood(kinds, kind) / own_total * by_reports(kind);
        let (kind, share) = likeliest(kinds, both);
        (kind, share, [sum(&both), sum(&by_reports)])
    }
}

/// The most probable kind and its probability, for a likelihood of each kind.
fn likeliest(kinds: &KindModel, likelihood: impl Fn(usize) -> f64) -> (u16, f64) {
    let (mut best, mut total) = ((0, -1.0), 0.0);
    for kind in kinds.each_kind() {
        let weight = kinds.shares[kind] * likelihood(kind);
        total += weight;
        if weight > best.1 {
            best = (kind, weight);
        }
    }
    let share = if total > 0.0 { best.1 / total } else { 0.0 };
    (u16::try_from(best.0).unwrap_or(u16::MAX), share)
}
