//! Reports of items: received, combined by trust, and sent.
//!
//! The sender of a report is accountable for it: see [`Trust`]. The belief in an item is limited by
//! the trust in the robots behind its reports:
//!
//! 1. A robot sends its own observations, and relays only reports that it received from their
//!    observer. So each report names all robots that could have forged it: its sender and its
//!    observer.
//! 2. Of the reports that support the item, those count that have the largest sum of log ratios of all
//!    sets without a robot, sender or observer, in two reports; the same holds for those that deny it.
//! 3. With the trust `t` of each counted report of support, which is the trust in its sender times that
//!    in its observer (once if they are one robot), support raises the belief before own observations to
//!    at most
//!
//! ```text
//! 1 - (1 - prior) x product of (1 - t)
//! ```
//!
//!    Denials then lower it, each by at most the factor `(1 - t) (1 - prior)` in the odds.
//!
//! Bound: *whatever c robots send, they make the belief in an item that no honest robot detected at
//! most `1 - (1 - prior) (1 - t1) ... (1 - tc)`, where `ti` is the trust in each of them, at any
//! number of honest robots that relay, or look and see nothing.* A report joins the reports of an item
//! by its place and kind, or because its sender sent the same one before, and never because another
//! sender named the same observations. Proof: a radio names the true sender. A report of an honest
//! sender is of its own observations or was received from the observer that it names (1), so a
//! report that supports the item has one of the c robots as sender or as observer. Counted reports of
//! support share no robot (2), so at most c of them count, each with another one of the c robots, and
//! its `t` is at most the trust in that robot. The product in (3) is then at least that of the bound,
//! and denials only lower the belief: a further one never raises it.
//!
//! At a trust of .5 and a prior of .01 that is .505 for one robot, .75 for two and .88 for three.
//! The bound is on belief by reports: own observations apply after it.

use super::trust::{MIN_TRUST, Trust};
use crate::io::agent_id::{AgentId, Receiver};
use crate::io::message::{About, Message, Provenance};
use crate::perception::beliefs::items::kinds::KindModel;
use crate::perception::beliefs::items::track::{
    MAX_LOG_ODDS, MAX_PRIOR, SOURCES, Source, Track, log_odds, probability,
};
use crate::perception::beliefs::items::track_set::TrackSet;
use crate::perception::beliefs::items::{Items, density};
use alloc::vec::Vec;
use base::geometry::Point;
use core::f64::consts::LN_10;
use core::mem;

/// Own observations confirm or refute a report from 90% on, as log odds.
const DECISIVE: f64 = 2.0 * LN_10 * 0.477;

/// A report is sent again when its confidence has changed by this much.
const RESEND_CHANGE: f64 = 0.05;

/// A report is believed half as much after this age, in seconds.
const HALF_LIFE_S: f64 = 600.0;

/// Probability that a message of an age still carries information: 2^(-age / 10 min).
pub(super) fn freshness(age_s: f64) -> f64 {
    libm::exp2(-age_s / HALF_LIFE_S)
}

/// A report of an item by another robot.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Report {
    pub(crate) kind: u16,
    pub(crate) at: Point,
    pub(crate) provenance: Provenance,
    pub(crate) confidence: f64,
    /// Probability of the kind, given that there is an item, if the sender has stated it.
    pub(crate) kind_share: Option<f32>,
    /// Probability that it still carries information about the item: see [`freshness`].
    pub(crate) freshness: f64,
    /// The sender.
    pub(crate) from: AgentId,
}

impl Report {
    /// The same for an item of any kind, and the probability of the named kind given that there is an item.
    fn of_any_kind(&self, kinds: Option<&KindModel>) -> (f64, Self) {
        let Some(kinds) = kinds.filter(|_| self.confidence > MAX_PRIOR) else {
            return (1.0, *self);
        };
        let any = match self.kind_share {
            Some(share) => (self.confidence / f64::from(share)).min(1.0),
            None => kinds.any_by_report(self.kind, self.confidence),
        };
        let report = Self {
            confidence: any,
            ..*self
        };
        (self.confidence / any, report)
    }

    /// Log likelihood ratio of the observations behind it, given the receiver's prior, as far as it is fresh.
    ///
    /// Priors differ: that of a robot with a poor position is higher. What it reports after a miss
    /// can be above the receiver's prior, so a probability that may be a prior is never support.
    fn log_ratio(&self, prior: f64) -> f64 {
        let log_ratio = log_odds(self.confidence.clamp(1e-6, 1.0 - 1e-6)) - prior;
        let log_ratio = if self.confidence <= MAX_PRIOR {
            log_ratio.min(0.0)
        } else {
            log_ratio
        };
        discounted(prior, log_ratio, self.freshness)
    }
}

/// The receiving robot, and its trust in others.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reception<'t> {
    pub(crate) own: AgentId,
    pub(crate) trust: &'t Trust,
}

impl Reception<'_> {
    /// Trust in another robot, 0 to 1.
    pub(crate) fn trust_in(&self, other: AgentId) -> f64 {
        self.trust.of(other)
    }

    /// Whether a robot is trusted enough for its reports to be relayed, or to replace those of
    /// others.
    fn trusts(&self, other: AgentId) -> bool {
        other == self.own || self.trust_in(other) >= MIN_TRUST
    }
}

impl Items {
    /// Updates the items with a report, unless it is of the robot's own observations.
    pub(crate) fn receive(
        &mut self,
        reception: &Reception,
        report: &Report,
        variance_m2: f64,
        per_m2: &[f64],
    ) {
        if report.provenance.observer == reception.own {
            return;
        }
        let kinds = self.kinds.clone();
        let per_m2 = match &kinds {
            Some(_) => per_m2.iter().sum(),
            None => density(per_m2, report.kind),
        };
        let (kind_share, report) = &report.of_any_kind(kinds.as_deref());
        let known = self.tracks.iter().position(|track| track.continues(report));
        let near = || self.track_of_report(report.kind, (report.at, variance_m2), per_m2);
        let new = || Track {
            evidence: kinds
                .as_ref()
                .map_or_else(Vec::new, |kinds| kinds.no_evidence()),
            ..Track::new(report.kind, report.at, variance_m2, per_m2)
        };
        let Some(index) = known
            .or_else(near)
            .or_else(|| self.add_reported_track(new(), reception.own))
        else {
            return;
        };
        let track = &mut self.tracks[index];
        let prior = track.prior_with_another(report.at, variance_m2, per_m2);
        let is_new = !track.has_report_from(report.from);
        if track.replace(reception, report, prior) {
            if !track.is_observed_by(reception.own) {
                track.correct_by_report(report, variance_m2, is_new);
            }
            if let Some(kinds) = &kinds {
                track.set_reported_kind(report, *kind_share);
                track.update_kind(kinds, reception.own);
            }
            self.mark_changed(&TrackSet::of(index));
        }
    }

    /// Updates the trust in the senders of reports that own observations confirm or refute.
    pub(crate) fn learn(&mut self, own: AgentId, trust: &mut Trust) {
        for number in mem::take(&mut self.unjudged).iter() {
            let Some(track) = self.tracks.get_mut(number) else {
                break;
            };
            let Some(verdict) = track.own_verdict(own) else {
                continue;
            };
            for place in 0..track.count {
                let source = track.sources[place];
                let is_own = source.provenance.observer == own;
                if !is_own && !source.is_judged && source.is_judged_by(verdict) {
                    let is_right = source.log_odds() > 0.0 && verdict;
                    let is_credited = track.is_credited(own, source.from);
                    track.sources[place].is_judged = true;
                    if !is_credited {
                        trust.learn(source.from, is_right);
                    }
                }
            }
        }
    }

    /// The tracks with the probabilities of their items, without those that are probably of the item of a more probable one.
    pub(crate) fn believed(&self, reception: &Reception) -> Vec<(&Track, f64)> {
        let kinds = self.kinds.as_deref();
        let each = self.tracks.iter();
        let all: Vec<(&Track, f64)> = each
            .map(|track| (track, track.confidence(reception, kinds)))
            .collect();
        let is_alone = |(track, confidence): &(&Track, f64)| {
            let mut others = all.iter().filter(|(_, other)| other > confidence);
            !others.any(|(other, _)| {
                (kinds.is_some() || other.kind == track.kind) && track.is_beside(other, *confidence)
            })
        };
        all.iter().filter(|each| is_alone(each)).copied().collect()
    }

    /// Appends reports to the outbox, at most `max`: own observations, and relayed ones of trusted
    /// robots.
    pub(crate) fn report(&mut self, reception: &Reception, outbox: &mut Vec<Message>, max: usize) {
        let mut left = max;
        for number in self.unsent.iter() {
            let Some(track) = self.tracks.get_mut(number).filter(|_| left > 0) else {
                break;
            };
            let at = track.at;
            let own = self.kinds.as_ref().map(|kinds| track.own_kind(kinds));
            let certain = track.kind;
            for source in &mut track.sources[..track.count] {
                let (kind, share) = match own {
                    None => (certain, None),
                    Some((kind, share)) if source.provenance.observer == reception.own => {
                        (kind, Some(share))
                    }
                    Some(_) => (source.kind, Some(source.kind_share.into())),
                };
                let confidence = probability(source.log_odds()) * share.unwrap_or(1.0);
                if left == 0 || source.is_sent(confidence) || !source.is_sendable(reception) {
                    continue;
                }
                source.mark_sent(confidence);
                left -= 1;
                let provenance = source.provenance;
                outbox.push(Message {
                    to: Receiver::All,
                    about: About::Item {
                        kind,
                        at,
                        provenance,
                        #[expect(clippy::cast_possible_truncation, reason = "messages are short")]
                        kind_share: share.map(|share| share as f32),
                    },
                    confidence,
                });
            }
            if left > 0 {
                self.unsent.remove(number);
            }
        }
    }
}

impl Track {
    /// Probability that an item of its kind exists, 0 to 1.
    pub(crate) fn confidence(&self, reception: &Reception, kinds: Option<&KindModel>) -> f64 {
        let sources = self.sources[..self.count].iter();
        let own = sources.filter(|source| source.provenance.observer == reception.own);
        let own: f64 = own.map(|source| source.log_ratio).sum();
        let Some(kinds) = kinds else {
            return probability(self.reported(reception, 0.0) + own);
        };
        let weighted = Weighted::new(self, reception);
        let trust = |source: &Source| {
            let mut counted = weighted.counted();
            let report =
                counted.find(|report| self.sources[report.slot].provenance == source.provenance)?;
            Some(report.trust)
        };
        let (_, share, agreement) = self.kind_and_agreement(kinds, reception.own, &trust);
        let [all, reports] = agreement.map(|factor| libm::log(factor.max(f64::MIN_POSITIVE)));
        share * probability(self.reported(reception, reports) + own + all - reports)
    }

    /// Records the kind that a report names, with its probability given that there is an item.
    #[expect(clippy::cast_possible_truncation, reason = "stored as f32")]
    fn set_reported_kind(&mut self, report: &Report, share: f64) {
        if let Some(slot) = self.slot_of(report.provenance) {
            let source = &mut self.sources[slot];
            (source.kind, source.kind_share) = (report.kind, share as f32);
        }
    }

    /// Log odds by the reports of others, within the bound of the [module](self); `agreement` is the log ratio by
    /// the kinds that they name.
    fn reported(&self, reception: &Reception, agreement: f64) -> f64 {
        let (mut support, mut denial, mut distrust) = (0.0, 0.0, 1.0);
        for report in Weighted::new(self, reception).counted() {
            if report.is_support() {
                support += report.log_ratio;
                distrust *= 1.0 - report.trust;
            } else {
                denial += report.log_ratio;
            }
        }
        let prior = probability(self.prior);
        let max = log_odds(1.0 - (1.0 - prior) * distrust) - self.prior;
        self.prior + (support + agreement).max(0.0).min(max) + denial
    }

    /// Whether a report updates one that its sender sent before. A report of the same observations by
    /// another sender is of this item only if it is near: otherwise a liar that names the observations
    /// of others before they do could gather their reports at a place of its own.
    fn continues(&self, report: &Report) -> bool {
        let slot = self.slot_of(report.provenance);
        slot.is_some_and(|slot| self.sources[slot].from == report.from)
    }

    /// Whether own observations have confirmed a report of this item by a sender. Trust then does not
    /// grow by further ones: otherwise a liar could earn it by one item with many numbers.
    fn is_credited(&self, own: AgentId, sender: AgentId) -> bool {
        let mut sources = self.sources[..self.count].iter();
        self.own_verdict(own) == Some(true)
            && sources.any(|source| source.from == sender && source.is_judged)
    }

    /// Adds or replaces the source of a report; `prior` is that of a new source. Returns whether it
    /// changed.
    fn replace(&mut self, reception: &Reception, report: &Report, prior: f64) -> bool {
        let provenance = report.provenance;
        let known = self.slot_of(provenance);
        if known.is_some_and(|slot| !self.sources[slot].is_replaced_by(reception, report)) {
            return false;
        }
        let prior = known.map_or(prior, |slot| self.sources[slot].prior);
        let is_credited = self.is_credited(reception.own, report.from);
        let log_ratio = report.log_ratio(prior);
        let new = Source {
            provenance,
            from: report.from,
            prior,
            log_ratio: log_ratio.max(-MAX_LOG_ODDS).min(MAX_LOG_ODDS - prior),
            ..Source::default()
        };
        let Some(slot) = known.or_else(|| self.slot_for(reception, &new)) else {
            return false;
        };
        let before = known.map_or(Source::default(), |slot| self.sources[slot]);
        self.sources[slot] = Source {
            sent_confidence: before.sent_confidence,
            is_judged: before.is_judged || is_credited,
            ..new
        };
        true
    }

    /// The slot of a new report: if all slots are in use, that of one that does not count, or of a weaker one. One that
    /// would not count itself has none: otherwise a liar could occupy all slots. Where kinds are uncertain, support that
    /// is forgotten may have contradicted the kind of the others: a denial does not take its place.
    fn slot_for(&mut self, reception: &Reception, new: &Source) -> Option<usize> {
        if self.count < self.sources.len() {
            self.count += 1;
            return Some(self.count - 1);
        }
        let weighted = Weighted::new(self, reception);
        let new = WeightedReport::new(SOURCES, new, reception);
        let mut counted = weighted.counted();
        if counted.any(|other| other.is_support() == new.is_support() && other.shares(new.robots)) {
            return None;
        }
        let has_kinds = !self.evidence.is_empty();
        let is_weaker = |other: &WeightedReport| {
            let may_leave = !has_kinds || new.is_support() || !other.is_support();
            may_leave && other.log_ratio.abs() < new.log_ratio.abs()
        };
        let not_counted = weighted.weakest(|other| !other.is_counted);
        not_counted.or_else(|| weighted.weakest(is_weaker))
    }

    /// Whether own observations confirm the item; `None` if they are not decisive.
    fn own_verdict(&self, own: AgentId) -> Option<bool> {
        let mut sources = self.sources[..self.count].iter();
        let source = sources.find(|source| source.provenance.observer == own)?;
        if source.log_odds() > DECISIVE {
            Some(true)
        } else if source.log_ratio < -DECISIVE {
            Some(false)
        } else {
            None
        }
    }

    fn has_report_from(&self, sender: AgentId) -> bool {
        let mut sources = self.sources[..self.count].iter();
        sources.any(|source| source.from == sender)
    }

    /// Corrects the position with a report if it supports the item, as far as it is fresh, and if it is the first of its
    /// sender: with any number of them, a liar could move the item to any place.
    fn correct_by_report(&mut self, report: &Report, variance_m2: f64, is_new: bool) {
        if self.count == 1 {
            (self.at, self.variance_m2) = (report.at, variance_m2);
        } else if is_new && report.confidence > MAX_PRIOR {
            self.correct_position(report.at, variance_m2 / report.freshness);
        }
    }
}

impl Source {
    /// Whether own observations with a `verdict` confirm or refute this report: one that there is an item by either
    /// verdict, a decisive denial if there is one. A denial earns no trust: most places have no item.
    fn is_judged_by(&self, verdict: bool) -> bool {
        self.log_odds() > 0.0 || (verdict && self.log_ratio < -DECISIVE)
    }

    /// Whether a report of the same observations replaces this one. The report with more
    /// observations wins; reports of the observer itself precede relayed ones, and a different
    /// sender must be trusted.
    fn is_replaced_by(&self, reception: &Reception, report: &Report) -> bool {
        let observer = self.provenance.observer;
        if report.from == observer && self.from != observer {
            return true;
        }
        let may_replace = report.from == self.from || reception.trusts(report.from);
        may_replace && report.provenance.observations > self.provenance.observations
    }

    /// Whether a report with about this confidence has been sent.
    fn is_sent(&self, confidence: f64) -> bool {
        (confidence - f64::from(self.sent_confidence)).abs() < RESEND_CHANGE
    }

    #[expect(clippy::cast_possible_truncation, reason = "stored as f32")]
    fn mark_sent(&mut self, confidence: f64) {
        self.sent_confidence = confidence as f32;
    }

    /// Whether it is sent: own observations are, and those that a trusted observer has reported
    /// itself. The receivers then know all robots that have passed a report on.
    fn is_sendable(&self, reception: &Reception) -> bool {
        self.from == self.provenance.observer && reception.trusts(self.from)
    }
}

/// A report of another robot in a track, weighted by trust.
#[derive(Debug, Clone, Copy, Default)]
struct WeightedReport {
    slot: usize,
    /// The sender and the observer.
    robots: [AgentId; 2],
    /// Trust in the sender x trust in the observer, once if they are one robot.
    trust: f64,
    /// Log likelihood ratio, discounted by trust.
    log_ratio: f64,
    is_counted: bool,
}

impl WeightedReport {
    fn new(slot: usize, source: &Source, reception: &Reception) -> Self {
        let (from, observer) = (source.from, source.provenance.observer);
        let in_observer = if observer == from {
            1.0
        } else {
            reception.trust_in(observer)
        };
        let trust = reception.trust_in(from) * in_observer;
        Self {
            slot,
            robots: [from, observer],
            trust,
            log_ratio: discounted(source.prior, source.log_ratio, trust),
            is_counted: false,
        }
    }

    fn is_support(&self) -> bool {
        self.log_ratio > 0.0
    }

    /// Whether it comes from one of two robots, or from observations of one of them.
    fn shares(&self, robots: [AgentId; 2]) -> bool {
        robots.iter().any(|robot| self.robots.contains(robot))
    }
}

/// The reports of other robots in a track.
struct Weighted {
    reports: [WeightedReport; SOURCES],
    count: usize,
}

impl Weighted {
    fn new(track: &Track, reception: &Reception) -> Self {
        let mut weighted = Self {
            reports: [WeightedReport::default(); SOURCES],
            count: 0,
        };
        for (slot, source) in track.sources[..track.count].iter().enumerate() {
            if source.provenance.observer != reception.own {
                weighted.reports[weighted.count] = WeightedReport::new(slot, source, reception);
                weighted.count += 1;
            }
        }
        for is_support in [true, false] {
            weighted.count_side(is_support);
        }
        weighted
    }

    /// Counts, of the reports that support the item or of those that deny it, those with the largest sum of log ratios of
    /// all sets without a robot in two reports. So a further report never weakens its side.
    fn count_side(&mut self, is_support: bool) {
        let of_side = |report: &WeightedReport| report.is_support() == is_support;
        let has_conflict = |set: u32| {
            let mut reports = self.members(set);
            reports.any(|(place, one)| {
                let mut others = self.members(set & !(1 << place));
                !of_side(one) || others.any(|(_, other)| other.shares(one.robots))
            })
        };
        let sum = |set: u32| -> f64 {
            let reports = self.members(set);
            reports.map(|(_, report)| report.log_ratio.abs()).sum()
        };
        let all = self.side(is_support);
        let best = if has_conflict(all) {
            let sets = (0..=all).filter(|set| set & !all == 0 && !has_conflict(*set));
            sets.max_by(|one, other| sum(*one).total_cmp(&sum(*other)))
        } else {
            Some(all)
        };
        for place in 0..self.count {
            self.reports[place].is_counted |= best.unwrap_or_default() >> place & 1 == 1;
        }
    }

    /// The set of all reports of a side, one bit for each.
    fn side(&self, is_support: bool) -> u32 {
        let numbered = self.reports[..self.count].iter().enumerate();
        let side = numbered.filter(|(_, report)| report.is_support() == is_support);
        side.fold(0, |set, (place, _)| set | 1 << place)
    }

    fn members(&self, set: u32) -> impl Iterator<Item = (usize, &WeightedReport)> {
        let numbered = self.reports[..self.count].iter().enumerate();
        numbered.filter(move |(place, _)| set >> place & 1 == 1)
    }

    fn counted(&self) -> impl Iterator<Item = &WeightedReport> {
        let reports = self.reports[..self.count].iter();
        reports.filter(|report| report.is_counted)
    }

    /// The slot of the weakest report for which a condition holds.
    fn weakest(&self, condition: impl Fn(&WeightedReport) -> bool) -> Option<usize> {
        let reports = self.reports[..self.count].iter();
        let reports = reports.filter(|report| condition(report));
        let weakest =
            reports.min_by(|one, other| one.log_ratio.abs().total_cmp(&other.log_ratio.abs()));
        Some(weakest?.slot)
    }
}

/// Log likelihood ratio of a report that is true with the probability `trust`, and uninformative
/// otherwise.
fn discounted(prior: f64, log_ratio: f64, trust: f64) -> f64 {
    let reported = probability(prior + log_ratio);
    log_odds(trust * reported + (1.0 - trust) * probability(prior)) - prior
}

#[cfg(test)]
mod tests;
