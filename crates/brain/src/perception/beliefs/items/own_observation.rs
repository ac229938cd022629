//! An observation of an own detector, and what it expects to see.

use super::kinds::KindModel;
use super::track::MIN_DEVIATION_M;
use crate::io::agent_id::AgentId;
use crate::io::body::Detector;
use crate::io::percept::Contact;
use crate::perception::beliefs::coverage_map::MAX_DETECTION;
use crate::perception::beliefs::pose::Pose;

/// One observation of an own detector.
#[derive(Debug, Clone, Copy)]
pub(crate) struct OwnObservation<'l> {
    pub(crate) observer: AgentId,
    pub(crate) detector: &'l Detector,
    /// The pose of the robot at that time.
    pub(crate) pose: Pose,
    /// Prior density of items of each kind.
    pub(crate) per_m2: &'l [f64],
}

/// Log likelihood ratio of own observations for an item.
#[derive(Clone, Copy)]
pub(super) enum OwnRatio {
    /// Of one observation.
    Added(f64),
    /// Of all of them.
    Total(f64),
}

impl OwnObservation<'_> {
    /// Density at a contact of the contacts of items, if none has been observed.
    pub(super) fn untracked_per_m2(&self, contact: &Contact) -> f64 {
        let contacts = |(kind, per_m2): (usize, &f64)| {
            let reported = contact.kind.into();
            let items = (kind, *per_m2);
            self.detector.contacts(items, reported, contact.range_m)
        };
        self.per_m2.iter().enumerate().map(contacts).sum()
    }

    /// Prior density of what a contact of a kind may be.
    pub(super) fn prior_per_m2(&self, kind: u16, kinds: Option<&KindModel>) -> f64 {
        if kinds.is_some() {
            self.per_m2.iter().sum()
        } else {
            density(self.per_m2, kind)
        }
    }

    /// Log likelihood of a miss of a kind, relative to that of the coverage map: of the kind that is detected least.
    pub(super) fn relative_misses(&self, kind: usize, range_m: f64) -> f64 {
        let [least, own] = [
            self.detector.min_probability(range_m),
            self.detector.probability(kind, range_m),
        ];
        let [least, own] = [least, own].map(|p| libm::log1p(-p.clamp(1e-6, MAX_DETECTION)));
        own / least
    }

    /// Variance of the position of a contact, along each axis; the pose adds its part.
    pub(super) fn variance_m2(&self, pose_variance_m2: f64) -> f64 {
        let noise_m = self.detector.noise_m.max(MIN_DEVIATION_M);
        noise_m * noise_m + pose_variance_m2
    }

    /// Variance that the pose adds to the position of a contact at a distance, along each axis.
    pub(super) fn pose_variance_m2(&self, range_m: f64) -> f64 {
        let lateral_m = range_m * self.pose.deviation_rad;
        lateral_m * lateral_m + self.pose.deviation_m * self.pose.deviation_m
    }
}

/// The density of items of a kind.
pub(crate) fn density(per_m2: &[f64], kind: u16) -> f64 {
    per_m2.get(usize::from(kind)).copied().unwrap_or_default()
}
