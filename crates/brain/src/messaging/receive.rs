//! How received messages change the beliefs.

use super::reports::{Report, freshness};
use super::state::Messaging;
use super::trust::MIN_TRUST;
use crate::io::agent_id::AgentId;
use crate::io::body::{Body, Detector};
use crate::io::goal_id::GoalPlace;
use crate::io::message::{About, Provenance};
use crate::io::percept::{Percept, Reading, ReceivedMessage};
use crate::perception::beliefs::Beliefs;
use crate::perception::beliefs::pose::Pose;
use base::geometry::Point;

/// Maximum number of positions at which a team mate's observations since its last message are
/// assumed.
const MAX_POSITIONS: f64 = 16.0;

/// Maximum plausible rate of observations per detector, in Hz: cameras and radios are slower.
pub(super) const MAX_OBSERVATION_RATE_HZ: f64 = 50.0;

/// Received positions farther from the origin than this are discarded.
const MAX_COORDINATE_M: f64 = 1e7;

impl Messaging {
    /// Updates the beliefs with the messages of a percept, `elapsed_s` after the previous one; a
    /// robot that does not know its pose ignores them.
    pub(crate) fn receive(
        &mut self,
        percept: &Percept,
        body: &Body,
        elapsed_s: f64,
        beliefs: &mut Beliefs,
    ) {
        self.peers.advance(elapsed_s);
        if beliefs.pose().is_none() {
            return;
        }
        for received in &percept.inbox {
            self.receive_message(received, body, beliefs);
        }
        beliefs.items.learn(beliefs.id, &mut self.trust);
    }

    fn receive_message(&mut self, received: &ReceivedMessage, body: &Body, beliefs: &mut Beliefs) {
        let confidence = received.message.confidence;
        if !(0.0..=1.0).contains(&confidence) || !is_valid_age(received.age_s) {
            return;
        }
        let weight = self.trust.of(received.from) * confidence;
        match received.message.about {
            About::Item {
                kind,
                at,
                provenance,
                kind_share,
            } if is_valid_position(at) && usize::from(kind) < body.item_kinds.len() => {
                let report = Report {
                    kind,
                    at,
                    provenance: provenance_of(received, provenance, at),
                    confidence,
                    freshness: freshness(received.age_s),
                    kind_share: kind_share.filter(|share| *share > 0.0 && *share <= 1.0),
                    from: received.from,
                };
                self.receive_report(&report, body, beliefs);
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
                let reported = Reading {
                    value: (at, observations),
                    age_s: received.age_s,
                };
                let path = self.observed_path(received.from, reported, body);
                let weight = weight * freshness(received.age_s);
                path.extend_coverage(beliefs, heading_rad, weight);
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

    fn receive_report(&mut self, report: &Report, body: &Body, beliefs: &mut Beliefs) {
        let Some(pose) = beliefs.pose() else {
            return;
        };
        let variance_m2 = report_variance_m2(body, &pose);
        let reception = self.reception(beliefs.id);
        beliefs
            .items
            .receive(&reception, report, variance_m2, &beliefs.per_m2);
    }

    /// The observations that a team mate made on its path since its last message. Their age does
    /// not matter, but no more of them count than are plausible.
    fn observed_path<'b>(
        &mut self,
        mate: AgentId,
        reported: Reading<(Point, u32)>,
        body: &'b Body,
    ) -> ObservedPath<'b> {
        let (from, since, in_s) = self.peers.update_observations(mate, reported);
        let other = body.others.get(usize::from(mate.kind));
        let detectors = other.map_or(&body.detectors, |other| &other.detectors);
        ObservedPath {
            from,
            to: reported.value.0,
            observations: plausible(since, in_s, detectors.len()),
            detector: detectors.first(),
        }
    }
}

/// The observations of a team mate on a straight path.
struct ObservedPath<'b> {
    from: Point,
    to: Point,
    observations: f64,
    detector: Option<&'b Detector>,
}

impl ObservedPath<'_> {
    /// Adds the observations to the coverage map, evenly spaced along the path.
    fn extend_coverage(&self, beliefs: &mut Beliefs, heading_rad: f64, weight: f64) {
        let Some(detector) = self.detector.filter(|_| self.observations >= 1.0) else {
            return;
        };
        let path = self.from.to(self.to);
        let spacing_m = (detector.range_m / 2.0).max(1e-3);
        let positions =
            libm::ceil(path.length() / spacing_m).clamp(1.0, MAX_POSITIONS.min(self.observations));
        let observations_each = self.observations / positions;
        let mut position = 1.0;
        while position <= positions {
            let at = self.from.plus(path.times(position / positions));
            beliefs.update_coverage(detector, (at, heading_rad), [weight, observations_each]);
            position += 1.0;
        }
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
