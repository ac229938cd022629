//! What is told to others, and what others tell.

use super::items::{Reception, Report};
use super::pose::Pose;
use super::trust::ENOUGH;
use super::{Beliefs, Body, Prior, Trust};
use crate::goals::proposal::Destination;
use crate::io::body::RobotId;
use crate::io::message::{About, CommitmentStatus, Message, Provenance};
use crate::io::percept::{Reading, ReceivedMessage};
use alloc::vec::Vec;
use base::geometry::Point;
use base::trig::wrapped;

/// Others are told where it is once in so long, in seconds. Each robot has its own moment within that: a
/// radio hears only so much at once.
const AGAIN_S: f64 = 1.0;

/// Every so many times it also tells again where it goes, which it tells at once when that changes, and
/// which items it believes in: others keep that for ten seconds or for good.
const SELDOM: u8 = 3;

/// Who has turned by this tells at once where it is: others take it to have looked the way that it told
/// last, and a narrow view that turns leaves that way within this.
const TURNED_RAD: f64 = 0.3;

/// So many messages about items are told in a step.
const ITEMS_A_STEP: usize = 2;

/// A team mate's way since its last message is looked at from at most so many places.
const MOST_PLACES: f64 = 16.0;

/// Nobody looks oftener with one detector, in observations a second: cameras see, and robots tell of it, more slowly.
const MOST_LOOKS_S: f64 = 50.0;

/// Kinds of robots begin so far apart, as a share of [`AGAIN_S`]: multiples of the golden ratio fall evenly.
const KINDS_APART: f64 = 0.618_033_988_749_894_9;

/// What is farther away than this is nonsense, in metres.
const FARTHEST_M: f64 = 1e7;

/// What was told, and how long ago.
#[derive(Debug, Clone, Default)]
pub(crate) struct Told {
    goal: Option<Destination>,
    heading_rad: f64,
    observations: u32,
    /// `None` before the first time.
    age_s: Option<f64>,
    times: u8,
}

impl Beliefs {
    /// Takes in a message.
    pub(super) fn hear(&mut self, heard: &ReceivedMessage, body: &Body, pose: &Pose) {
        let confidence = heard.message.confidence;
        if !(0.0..=1.0).contains(&confidence) || !is_age(heard.age_s) {
            return;
        }
        let counts = self.trust.of(heard.from, &self.prior.trust) * confidence;
        match heard.message.about {
            About::Item {
                kind,
                at,
                provenance,
            } if is_place(at) => {
                let report = Report {
                    kind,
                    at,
                    provenance: own_look(heard, provenance, at),
                    confidence,
                    from: heard.from,
                };
                let variance_m2 = report_variance_m2(body, pose);
                let ears = ears(self.id, &self.trust, &self.prior);
                self.items
                    .hear(&ears, &report, variance_m2, &self.prior.per_m2);
            }
            About::Sender {
                at,
                heading_rad,
                observations,
            } if is_place(at) && heading_rad.abs() < 1e4 => {
                if counts >= ENOUGH {
                    self.peers.stands(heard.from, at, heard.age_s);
                }
                let glance = (at, heading_rad);
                self.hear_looks((heard, counts), body, glance, observations);
            }
            About::Goal { at, status } if is_place(at) && counts >= ENOUGH => {
                self.peers.goes(heard.from, at, status, heard.age_s);
            }
            _ => {}
        }
    }

    /// A team mate has looked around on its way: that extends the own picture, towards it only. However long
    /// ago that was, it has looked; but no oftener than can be.
    fn hear_looks(
        &mut self,
        (heard, counts): (&ReceivedMessage, f64),
        body: &Body,
        (at, heading_rad): (Point, f64),
        observations: u32,
    ) {
        let told = Reading {
            value: (at, observations),
            age_s: heard.age_s,
        };
        let (from, since, in_s) = self.peers.looked(heard.from, told);
        let other = body.others.get(usize::from(heard.from.kind));
        let detectors = other.map_or(&body.detectors, |other| &other.detectors);
        let observations = believable(since, in_s, detectors.len());
        let Some(detector) = detectors.first().filter(|_| observations >= 1.0) else {
            return;
        };
        let way = from.to(at);
        let apart_m = (detector.range_m / 2.0).max(1e-3);
        let places = libm::ceil(way.length() / apart_m).clamp(1.0, MOST_PLACES.min(observations));
        let each = observations / places;
        let mut place = 1.0;
        while place <= places {
            let there = from.plus(way.times(place / places));
            self.look_at_cells(detector, (there, heading_rad), [counts, each]);
            place += 1.0;
        }
    }

    /// Tells others what they need to know; `goal` is where it is going.
    pub(crate) fn tell(
        &mut self,
        goal: Option<Destination>,
        period_s: f64,
        outbox: &mut Vec<Message>,
    ) {
        let Some(pose) = self.here.pose() else {
            return;
        };
        let is_time = self.told.is_time(self.id, period_s);
        let is_time_for_all = is_time && self.told.times == 0;
        self.told.tell_goal(goal, pose.at, is_time_for_all, outbox);
        let turned_rad = wrapped(pose.heading_rad - self.told.heading_rad).abs();
        let looks_elsewhere =
            turned_rad >= TURNED_RAD && self.observations != self.told.observations;
        if is_time || looks_elsewhere {
            (self.told.heading_rad, self.told.observations) = (pose.heading_rad, self.observations);
            outbox.push(sure(About::Sender {
                at: pose.at,
                heading_rad: pose.heading_rad,
                observations: self.observations,
            }));
        }
        if is_time_for_all {
            self.items.tell_again();
        }
        let ears = ears(self.id, &self.trust, &self.prior);
        self.items.tell(&ears, outbox, ITEMS_A_STEP);
    }
}

impl Told {
    /// Whether it is time to tell again, after one more period: the sum may be half of one off, and what is
    /// left over counts for the next time, so that it is once in [`AGAIN_S`] whatever the period.
    fn is_time(&mut self, own: RobotId, period_s: f64) -> bool {
        let begun_s = || AGAIN_S * phase(own, period_s);
        let age_s = self.age_s.unwrap_or_else(begun_s) + period_s;
        let is_time = age_s >= AGAIN_S - period_s / 2.0;
        let left_s = (age_s - AGAIN_S).min(period_s / 2.0);
        self.age_s = Some(if is_time { left_s } else { age_s });
        if is_time {
            self.times = (self.times + 1) % SELDOM;
        }
        is_time
    }

    /// Tells where it is going, and what has become of where it went before.
    fn tell_goal(
        &mut self,
        goal: Option<Destination>,
        at: Point,
        is_time: bool,
        outbox: &mut Vec<Message>,
    ) {
        let before = self.goal;
        let is_new = goal.map(|aim| aim.at) != before.map(|aim| aim.at);
        if !is_new && !is_time {
            return;
        }
        let say = |aim: Destination, status| sure(About::Goal { at: aim.at, status });
        if let Some(ended) = before.filter(|_| is_new) {
            if at.to(ended.at).length() <= ended.tolerance_m {
                outbox.push(say(ended, CommitmentStatus::Done));
            } else if goal.is_none() {
                // Who goes elsewhere has left too.
                outbox.push(say(ended, CommitmentStatus::Released));
            }
        }
        outbox.extend(goal.map(|aim| say(aim, CommitmentStatus::Active)));
        self.goal = goal;
    }
}

/// How much of [`AGAIN_S`] is over for a robot when it begins, 0 to 1: there are as many moments as periods,
/// and of one kind as many robots in each, but for one.
fn phase(own: RobotId, period_s: f64) -> f64 {
    let moments = libm::round(AGAIN_S / period_s).clamp(1.0, 1e9);
    let place = f64::from(own.index) / moments + KINDS_APART * f64::from(own.kind);
    place - libm::floor(place)
}

/// So many of the observations that a team mate says that it took in a time, in seconds, with so many detectors can
/// have been taken.
fn believable(observations: u32, in_s: f64, detectors: usize) -> f64 {
    let detectors = u32::try_from(detectors).unwrap_or(u32::MAX);
    // Ages are sums of periods.
    let most = libm::floor(in_s * MOST_LOOKS_S * f64::from(detectors) + 1e-3);
    f64::from(observations).min(most)
}

pub(super) fn ears<'t>(own: RobotId, trust: &'t Trust, prior: &'t Prior) -> Reception<'t> {
    let spec = &prior.trust;
    Reception { own, trust, spec }
}

fn sure(about: About) -> Message {
    Message {
        about,
        confidence: 1.0,
    }
}

/// Whose observations a report is of: if it tells of none, of one of its sender at that place.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "only to be told apart"
)]
fn own_look(heard: &ReceivedMessage, provenance: Provenance, at: Point) -> Provenance {
    if provenance.observations > 0 {
        return provenance;
    }
    let [x, y] = [at.x, at.y].map(|along_m| libm::round(along_m) as i32 as u32);
    Provenance {
        observer: heard.from,
        track_id: x.wrapping_mul(0x9e37_79b9) ^ y,
        observations: 1,
    }
}

/// Of a place that another robot reports: both may be wrong about where they are.
fn report_variance_m2(body: &Body, pose: &Pose) -> f64 {
    let detectors = body.detectors.iter();
    let noise_m = detectors
        .map(|detector| detector.noise_m)
        .fold(0.05, f64::max);
    2.0 * pose.deviation_m * pose.deviation_m + noise_m * noise_m
}

fn is_age(age_s: f64) -> bool {
    age_s >= 0.0 && age_s.is_finite()
}

fn is_place(at: Point) -> bool {
    at.x.abs() <= FARTHEST_M && at.y.abs() <= FARTHEST_M
}

#[cfg(test)]
mod tests;
