//! Messages: which ones a robot broadcasts, and how received ones change its beliefs.

use super::broadcast::certain;
use super::items::{Reception, Report};
use super::pose::Pose;
use super::trust::MIN_TRUST;
use super::world_model::Beliefs;
use crate::goals::proposal::Destination;
use crate::io::body::Body;
use crate::io::goal_id::GoalPlace;
use crate::io::message::{About, Message, Provenance};
use crate::io::percept::{Reading, ReceivedMessage};
use alloc::vec::Vec;
use base::geometry::Point;
use base::trig::wrapped;

/// A robot that has turned by this angle broadcasts its pose at once: receivers assume that it
/// observed in the last heading that it sent, and a narrow field of view leaves that heading within
/// this angle.
const MAX_TURN_RAD: f64 = 0.3;

/// Maximum number of messages about items per step.
const MAX_ITEM_MESSAGES: usize = 2;

/// Maximum number of positions at which a team mate's observations since its last message are
/// assumed.
const MAX_POSITIONS: f64 = 16.0;

/// Maximum plausible rate of observations per detector, in Hz: cameras and radios are slower.
const MAX_OBSERVATION_RATE_HZ: f64 = 50.0;

/// Received positions farther from the origin than this are discarded.
const MAX_COORDINATE_M: f64 = 1e7;

impl Beliefs {
    /// Updates the beliefs with a received message.
    pub(super) fn receive(&mut self, received: &ReceivedMessage, body: &Body, pose: &Pose) {
        let confidence = received.message.confidence;
        if !(0.0..=1.0).contains(&confidence) || !is_valid_age(received.age_s) {
            return;
        }
        let weight = self.trust.of(received.from, &self.prior.trust) * confidence;
        match received.message.about {
            About::Item {
                kind,
                at,
                provenance,
            } if is_valid_position(at) => {
                let report = Report {
                    kind,
                    at,
                    provenance: provenance_of(received, provenance, at),
                    confidence,
                    from: received.from,
                };
                let variance_m2 = report_variance_m2(body, pose);
                let reception = Reception {
                    own: self.id,
                    trust: &self.trust,
                    spec: &self.prior.trust,
                };
                self.items
                    .receive(&reception, &report, variance_m2, &self.prior.per_m2);
            }
            About::Sender {
                at,
                heading_rad,
                observations,
            } if is_valid_position(at) && heading_rad.abs() < 1e4 => {
                if weight >= MIN_TRUST {
                    self.peers
                        .update_position(received.from, at, received.age_s);
                }
                self.receive_observations(
                    (received, weight),
                    body,
                    (at, heading_rad),
                    observations,
                );
            }
            About::Goal { id, at, status } if is_valid_position(at) && weight >= MIN_TRUST => {
                self.peers.update_destination(
                    received.from,
                    GoalPlace { id, at },
                    status,
                    received.age_s,
                );
            }
            _ => {}
        }
    }

    /// Adds the observations that a team mate made on its path since its last message to the
    /// coverage map.
    ///
    /// Their age does not matter, but no more of them count than are plausible.
    fn receive_observations(
        &mut self,
        (received, weight): (&ReceivedMessage, f64),
        body: &Body,
        (at, heading_rad): (Point, f64),
        observations: u32,
    ) {
        let reported = Reading {
            value: (at, observations),
            age_s: received.age_s,
        };
        let (from, since, in_s) = self.peers.update_observations(received.from, reported);
        let other = body.others.get(usize::from(received.from.kind));
        let detectors = other.map_or(&body.detectors, |other| &other.detectors);
        let observations = plausible(since, in_s, detectors.len());
        let Some(detector) = detectors.first().filter(|_| observations >= 1.0) else {
            return;
        };
        let path = from.to(at);
        let spacing_m = (detector.range_m / 2.0).max(1e-3);
        let positions =
            libm::ceil(path.length() / spacing_m).clamp(1.0, MAX_POSITIONS.min(observations));
        let observations_each = observations / positions;
        let mut position = 1.0;
        while position <= positions {
            let at = from.plus(path.times(position / positions));
            self.update_coverage(detector, (at, heading_rad), [weight, observations_each]);
            position += 1.0;
        }
    }

    /// Appends the messages that are due in this step to the outbox; `goal` is the current
    /// destination.
    pub(crate) fn broadcast(
        &mut self,
        goal: Option<Destination>,
        elapsed_s: f64,
        outbox: &mut Vec<Message>,
    ) {
        let Some(pose) = self.localisation.pose() else {
            return;
        };
        let is_due = self.broadcast.is_due(self.id, elapsed_s);
        let is_repeat_due = is_due && self.broadcast.count == 0;
        self.broadcast
            .broadcast_goal(goal, pose.at, is_repeat_due, outbox);
        let turned_rad = wrapped(pose.heading_rad - self.broadcast.heading_rad).abs();
        let has_turned =
            turned_rad >= MAX_TURN_RAD && self.observations != self.broadcast.observations;
        if is_due || has_turned {
            (self.broadcast.heading_rad, self.broadcast.observations) =
                (pose.heading_rad, self.observations);
            outbox.push(certain(About::Sender {
                at: pose.at,
                heading_rad: pose.heading_rad,
                observations: self.observations,
            }));
        }
        if is_repeat_due {
            self.items.repeat_next();
        }
        let reception = Reception {
            own: self.id,
            trust: &self.trust,
            spec: &self.prior.trust,
        };
        self.items.report(&reception, outbox, MAX_ITEM_MESSAGES);
    }
}

/// The number of reported observations that are plausible within a time and for a number of
/// detectors.
fn plausible(observations: u32, in_s: f64, detectors: usize) -> f64 {
    let detectors = u32::try_from(detectors).unwrap_or(u32::MAX);
    // Ages are sums of periods, with rounding errors.
    let max = libm::floor(in_s * MAX_OBSERVATION_RATE_HZ * f64::from(detectors) + 1e-3);
    f64::from(observations).min(max)
}

/// The provenance of a reported item; if the report has none, one observation of its sender there.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "only a distinguishing number"
)]
fn provenance_of(received: &ReceivedMessage, provenance: Provenance, at: Point) -> Provenance {
    if provenance.observations > 0 {
        return provenance;
    }
    let [x, y] = [at.x, at.y].map(|along_m| libm::round(along_m) as i32 as u32);
    Provenance {
        observer: received.from,
        track_id: x.wrapping_mul(0x9e37_79b9) ^ y,
        observations: 1,
    }
}

/// Variance of a position that another robot reports: both robots may be wrong about their own
/// pose.
fn report_variance_m2(body: &Body, pose: &Pose) -> f64 {
    let detectors = body.detectors.iter();
    let noise_m = detectors
        .map(|detector| detector.noise_m)
        .fold(0.05, f64::max);
    2.0 * pose.deviation_m * pose.deviation_m + noise_m * noise_m
}

fn is_valid_age(age_s: f64) -> bool {
    age_s >= 0.0 && age_s.is_finite()
}

fn is_valid_position(at: Point) -> bool {
    at.x.abs() <= MAX_COORDINATE_M && at.y.abs() <= MAX_COORDINATE_M
}

#[cfg(test)]
mod tests;
