//! Reports of items: received, fused by trust, and sent.
//!
//! The sender of a report is accountable for it: see [`Trust`].

use super::trust::{MIN_TRUST, Trust};
use crate::io::body::RobotId;
use crate::io::message::{About, Message, Provenance};
use crate::perception::beliefs::items::track::{
    MAX_LOG_ODDS, Source, Track, log_odds, probability,
};
use crate::perception::beliefs::items::tracks::{Items, bits, density};
use alloc::vec::Vec;
use base::geometry::Point;
use core::f64::consts::LN_10;
use core::mem;

/// Own observations confirm or refute a report from 90% on, as log odds.
const DECISIVE: f64 = 2.0 * LN_10 * 0.477;

/// A report is sent again when its confidence has changed by this much.
const RESEND_CHANGE: f64 = 0.05;

/// A report of an item by another robot.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Report {
    pub(crate) kind: u16,
    pub(crate) at: Point,
    pub(crate) provenance: Provenance,
    pub(crate) confidence: f64,
    /// The sender.
    pub(crate) from: RobotId,
}

/// The receiving robot, and its trust in others.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reception<'t> {
    pub(crate) own: RobotId,
    pub(crate) trust: &'t Trust,
}

impl Reception<'_> {
    /// Trust in another robot, 0 to 1.
    pub(crate) fn trust_in(&self, other: RobotId) -> f64 {
        self.trust.of(other)
    }

    /// Whether a robot is trusted enough for its reports to be relayed, or to replace those of
    /// others.
    fn trusts(&self, other: RobotId) -> bool {
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
        let has_source = |track: &Track| track.slot_of(report.provenance).is_some();
        let per_m2 = density(per_m2, report.kind);
        let known = self.tracks.iter().position(has_source);
        let near = || self.nearest(report.kind, report.at, variance_m2, 0);
        let index = known.or_else(near).unwrap_or_else(|| {
            self.add_track(Track::new(report.kind, report.at, variance_m2, per_m2))
        });
        let track = &mut self.tracks[index];
        let prior = track.prior_with_another(report.at, variance_m2, per_m2);
        let is_new = track.slot_of(report.provenance).is_none();
        if track.replace(reception, report, prior) {
            if !track.is_observed_by(reception.own) {
                track.correct_by_report(report.at, variance_m2, is_new);
            }
            self.mark_changed(1 << index);
        }
    }

    /// Updates the trust in the senders of reports that own observations confirm or refute.
    pub(crate) fn learn(&mut self, own: RobotId, trust: &mut Trust) {
        for number in bits(mem::take(&mut self.unjudged)) {
            let Some(track) = self.tracks.get_mut(number) else {
                break;
            };
            let Some(verdict) = track.own_verdict(own) else {
                continue;
            };
            for source in &mut track.sources[..track.count] {
                let is_report = source.provenance.observer != own && source.log_odds() > 0.0;
                if is_report && !source.is_judged {
                    source.is_judged = true;
                    trust.learn(source.from, verdict);
                }
            }
        }
    }

    /// Appends reports to the outbox, at most `max`: own observations, and relayed ones of trusted
    /// robots.
    pub(crate) fn report(&mut self, reception: &Reception, outbox: &mut Vec<Message>, max: usize) {
        let mut left = max;
        for number in bits(self.unsent) {
            let Some(track) = self.tracks.get_mut(number).filter(|_| left > 0) else {
                break;
            };
            let (kind, at) = (track.kind, track.at);
            for source in &mut track.sources[..track.count] {
                let confidence = probability(source.log_odds());
                if left == 0 || source.is_sent(confidence) || !source.is_trusted(reception) {
                    continue;
                }
                source.mark_sent(confidence);
                left -= 1;
                let provenance = source.provenance;
                outbox.push(Message {
                    about: About::Item {
                        kind,
                        at,
                        provenance,
                    },
                    confidence,
                });
            }
            if left > 0 {
                self.unsent &= !(1 << number);
            }
        }
    }
}

impl Track {
    /// Probability that the item exists, 0 to 1. All reports of one sender are combined before they
    /// are weighted by trust, so that none is believed more than it is trusted, however often it
    /// reports and whichever observers it names.
    pub(crate) fn confidence(&self, reception: &Reception) -> f64 {
        let sources = &self.sources[..self.count];
        let is_first = |number: usize, from: RobotId| {
            let mut earlier = sources[..number].iter();
            earlier.all(|other| other.from != from)
        };
        let numbered = sources.iter().enumerate();
        let firsts = numbered.filter(|(number, source)| is_first(*number, source.from));
        let all = firsts.map(|(_, first)| {
            let log_ratio = self.log_ratio_from(reception, first.from);
            if first.from == reception.own {
                log_ratio
            } else {
                discounted(first.prior, log_ratio, reception.trust_in(first.from))
            }
        });
        probability(self.prior + all.sum::<f64>())
    }

    /// Log likelihood ratio of all reports of one sender, assuming that they are true.
    fn log_ratio_from(&self, reception: &Reception, from: RobotId) -> f64 {
        let numbers = (0..self.count).filter(|number| self.sources[*number].from == from);
        let counted = numbers.filter(|number| self.is_counted(*number));
        let log_ratios = counted.map(|number| {
            let Source {
                provenance,
                log_ratio,
                prior,
                ..
            } = self.sources[number];
            if provenance.observer == from {
                log_ratio
            } else {
                discounted(prior, log_ratio, reception.trust_in(provenance.observer))
            }
        });
        log_ratios.sum()
    }

    /// Whether a source is counted: observations count once, as reported by the observer itself, or
    /// else by the first other sender.
    fn is_counted(&self, number: usize) -> bool {
        let Source {
            provenance, from, ..
        } = self.sources[number];
        let others = self.sources[..self.count].iter().enumerate();
        let mut same = others.filter(|(_, other)| {
            other.provenance.observer == provenance.observer && other.from != from
        });
        provenance.observer == from
            || same.all(|(index, other)| index > number && other.from != provenance.observer)
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
        let log_ratio = log_odds(report.confidence.clamp(1e-6, 1.0 - 1e-6)) - prior;
        let Some(slot) = known.or_else(|| self.free_slot(reception.own, log_ratio)) else {
            return false;
        };
        let source = &mut self.sources[slot];
        (source.provenance, source.from, source.prior) = (provenance, report.from, prior);
        source.log_ratio = log_ratio.max(-MAX_LOG_ODDS).min(MAX_LOG_ODDS - prior);
        true
    }

    /// Whether own observations confirm the item; `None` if they are not decisive.
    fn own_verdict(&self, own: RobotId) -> Option<bool> {
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

    /// Corrects the position with a report; a repeated report is not a new measurement.
    fn correct_by_report(&mut self, at: Point, variance_m2: f64, is_new: bool) {
        if self.count == 1 {
            (self.at, self.variance_m2) = (at, variance_m2);
        } else if is_new {
            self.correct_position(at, variance_m2);
        }
    }
}

impl Source {
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

    /// Whether it is relayed.
    fn is_trusted(&self, reception: &Reception) -> bool {
        reception.trusts(self.from) && reception.trusts(self.provenance.observer)
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
