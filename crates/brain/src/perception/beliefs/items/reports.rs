//! What others tell of items, what they are told, and how far it is believed.
//!
//! Who tells of observations, his own or another's, answers for them: see [`Trust`](super::super::trust::Trust).

use super::{Items, MOST_AT_ALL, Source, Track, bits, log_odds, of, probability};
use crate::io::body::RobotId;
use crate::io::message::{About, Message, Provenance};
use crate::perception::beliefs::trust::{ENOUGH, Trust, TrustSpec};
use alloc::vec::Vec;
use base::geometry::Point;
use core::f64::consts::LN_10;
use core::mem;

/// Own observations that say 90% confirm or refute a report.
const SURE: f64 = 2.0 * LN_10 * 0.477;

/// Others are told again when what they were told is off by this.
const TOLD_AGAIN: f64 = 0.05;

/// What another robot tells of an item.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Report {
    pub(crate) kind: u16,
    pub(crate) at: Point,
    pub(crate) provenance: Provenance,
    pub(crate) confidence: f64,
    /// Who tells it.
    pub(crate) from: RobotId,
}

/// Who is told something, and how far he trusts others.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reception<'t> {
    pub(crate) own: RobotId,
    pub(crate) trust: &'t Trust,
    pub(crate) spec: &'t TrustSpec,
}

impl Reception<'_> {
    /// In another robot, 0 to 1.
    pub(crate) fn trust_in(&self, other: RobotId) -> f64 {
        self.trust.of(other, self.spec)
    }

    /// Whether one is trusted enough for what he says to be passed on, or to take the place of what others say.
    fn trusts(&self, other: RobotId) -> bool {
        other == self.own || self.trust_in(other) >= ENOUGH
    }
}

impl Items {
    /// Takes in a report, unless it is of own observations; its place errs by a variance.
    pub(crate) fn hear(
        &mut self,
        ears: &Reception,
        report: &Report,
        variance_m2: f64,
        per_m2: &[f64],
    ) {
        if report.provenance.observer == ears.own {
            return;
        }
        let of_source = |track: &Track| track.place_of(report.provenance).is_some();
        let known = self.tracks.iter().position(of_source);
        let near = || self.nearest(report.kind, report.at, variance_m2, 0);
        let place = match known.or_else(near) {
            Some(place) => place,
            None => self.begin(report.kind, report.at, variance_m2, of(per_m2, report.kind)),
        };
        let track = &mut self.tracks[place];
        let before = track.before_another(report.at, variance_m2, of(per_m2, report.kind));
        let is_new = track.place_of(report.provenance).is_none();
        if track.replace(ears, report, before) {
            if !track.has_looked(ears.own) {
                track.place_by_report(report.at, variance_m2, is_new);
            }
            self.note(1 << place);
        }
    }

    /// Learns from own observations whose reports were right.
    pub(crate) fn learn(&mut self, own: RobotId, trust: &mut Trust, spec: &TrustSpec) {
        for number in bits(mem::take(&mut self.unjudged)) {
            let Some(track) = self.tracks.get_mut(number) else {
                break;
            };
            let Some(verdict) = track.own_verdict(own) else {
                continue;
            };
            for source in &mut track.sources[..track.count] {
                let is_report = source.provenance.observer != own && source.says() > 0.0;
                if is_report && !source.is_judged {
                    source.is_judged = true;
                    trust.learn(source.from, verdict, spec);
                }
            }
        }
    }

    /// What others are to be told, at most so many messages: own observations, and those that others who are trusted
    /// told of.
    pub(crate) fn tell(&mut self, ears: &Reception, outbox: &mut Vec<Message>, most: usize) {
        let mut left = most;
        for number in bits(self.news) {
            let Some(track) = self.tracks.get_mut(number).filter(|_| left > 0) else {
                break;
            };
            let (kind, at) = (track.kind, track.at);
            for source in &mut track.sources[..track.count] {
                let confidence = probability(source.says());
                if left == 0 || source.is_known(confidence) || !source.is_trusted(ears) {
                    continue;
                }
                source.note_told(confidence);
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
                self.news &= !(1 << number);
            }
        }
    }
}

impl Track {
    /// How surely it is there, 0 to 1. All that one robot tells counts together, so that nobody is believed
    /// more than he is trusted, however often he says it, and whomever he names.
    pub(crate) fn confidence(&self, ears: &Reception) -> f64 {
        let sources = &self.sources[..self.count];
        let is_first = |number: usize, from: RobotId| {
            let mut before = sources[..number].iter();
            before.all(|other| other.from != from)
        };
        let numbered = sources.iter().enumerate();
        let firsts = numbered.filter(|(number, source)| is_first(*number, source.from));
        let all = firsts.map(|(_, first)| {
            let told = self.told_by(ears, first.from);
            if first.from == ears.own {
                told
            } else {
                discounted(first.before, told, ears.trust_in(first.from))
            }
        });
        probability(self.before + all.sum::<f64>())
    }

    /// Log likelihood ratio of all that one robot tells, if that is true.
    fn told_by(&self, ears: &Reception, from: RobotId) -> f64 {
        let numbers = (0..self.count).filter(|number| self.sources[*number].from == from);
        let counting = numbers.filter(|number| self.is_first_hand(*number));
        let odds = counting.map(|number| {
            let Source {
                provenance,
                odds,
                before,
                ..
            } = self.sources[number];
            if provenance.observer == from {
                odds
            } else {
                discounted(before, odds, ears.trust_in(provenance.observer))
            }
        });
        odds.sum()
    }

    /// Whether a looker told it itself, or no other told of his observations here before: they count once.
    fn is_first_hand(&self, number: usize) -> bool {
        let Source {
            provenance, from, ..
        } = self.sources[number];
        let others = self.sources[..self.count].iter().enumerate();
        let mut same = others.filter(|(_, other)| {
            other.provenance.observer == provenance.observer && other.from != from
        });
        provenance.observer == from
            || same.all(|(place, other)| place > number && other.from != provenance.observer)
    }

    /// Takes in what observations of a source say, if it says more than before; `before` holds if it is new.
    fn replace(&mut self, ears: &Reception, report: &Report, before: f64) -> bool {
        let provenance = report.provenance;
        let known = self.place_of(provenance);
        if known.is_some_and(|place| !self.sources[place].gives_way(ears, report)) {
            return false;
        }
        let before = known.map_or(before, |place| self.sources[place].before);
        let odds = log_odds(report.confidence.clamp(1e-6, 1.0 - 1e-6)) - before;
        let Some(place) = known.or_else(|| self.room(ears.own, odds)) else {
            return false;
        };
        let source = &mut self.sources[place];
        (source.provenance, source.from, source.before) = (provenance, report.from, before);
        source.odds = odds.max(-MOST_AT_ALL).min(MOST_AT_ALL - before);
        true
    }

    /// Whether own observations say that it is there, if they say something for sure.
    fn own_verdict(&self, own: RobotId) -> Option<bool> {
        let mut sources = self.sources[..self.count].iter();
        let source = sources.find(|source| source.provenance.observer == own)?;
        if source.says() > SURE {
            Some(true)
        } else if source.odds < -SURE {
            Some(false)
        } else {
            None
        }
    }

    /// Takes in where others say that it is: who says it again has not measured all of it anew.
    fn place_by_report(&mut self, at: Point, variance_m2: f64, is_new: bool) {
        if self.count == 1 {
            (self.at, self.variance_m2) = (at, variance_m2);
        } else if is_new {
            self.correct(at, variance_m2);
        }
    }
}

impl Source {
    /// Whether a report of the same observations holds in its place: the one of more observations does, but what the looker
    /// says himself goes before what others say of him, and those must be trusted to contradict anybody.
    fn gives_way(&self, ears: &Reception, report: &Report) -> bool {
        let observer = self.provenance.observer;
        if report.from == observer && self.from != observer {
            return true;
        }
        let may = report.from == self.from || ears.trusts(report.from);
        may && report.provenance.observations > self.provenance.observations
    }

    /// Whether others know that it is so likely, as far as they need to.
    fn is_known(&self, confidence: f64) -> bool {
        (confidence - f64::from(self.told)).abs() < TOLD_AGAIN
    }

    #[expect(clippy::cast_possible_truncation, reason = "kept short")]
    fn note_told(&mut self, confidence: f64) {
        self.told = confidence as f32;
    }

    /// Whether it is passed on.
    fn is_trusted(&self, ears: &Reception) -> bool {
        ears.trusts(self.from) && ears.trusts(self.provenance.observer)
    }
}

/// Log likelihood ratio of what is true with a probability, and else tells nothing.
fn discounted(before: f64, odds: f64, trust: f64) -> f64 {
    let told = probability(before + odds);
    log_odds(trust * told + (1.0 - trust) * probability(before)) - before
}
