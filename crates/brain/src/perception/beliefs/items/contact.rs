//! The contacts of one observation: what each may be.

use super::kinds::KindModel;
use super::own_observation::OwnObservation;
use super::track::Track;
use crate::io::percept::Contact;
use crate::perception::beliefs::map::Map;
use crate::perception::beliefs::view::View;
use crate::perception::sector::direction;
use base::geometry::Point;
use core::f64::consts::PI;

/// A contact farther from a track than this, in standard deviations, is not of its item.
const GATE: f64 = 5.0;

/// Lower limit of the factor by which unsuccessful observations reduce the density of items:
/// detector models have errors.
const MIN_UNSEEN: f64 = 0.01;

/// At least this part of the false alarms is outside of the estimated field of view: poses have errors.
const MIN_FALSE_SHARE: f64 = 1e-3;

/// Minimum standard deviation of the position of the field of view.
const MIN_VIEW_DEVIATION_M: f64 = 0.01;

/// A contact with its position in the world, and the densities of what it may be, per square metre.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SeenContact {
    pub(super) kind: u16,
    pub(super) range_m: f64,
    pub(super) at: Point,
    /// Variance of `at`, along each axis.
    pub(super) variance_m2: f64,
    /// The part of it by the pose, which contacts at about the same time have in common.
    pub(super) pose_variance_m2: f64,
    /// Probability that no observation so far would have detected an item there.
    pub(super) unseen: f64,
    /// Density of false alarms of its kind.
    pub(super) false_per_m2: f64,
    /// Density of contacts of items that have no track yet.
    pub(super) untracked_per_m2: f64,
    /// Density of contacts of the items of all tracks that this robot has observed.
    pub(super) tracked_per_m2: f64,
    /// The same of the item that it is most probably of, if each exists and is detected.
    pub(super) nearest_per_m2: f64,
    /// Whether it is rather of the item of a track, if that exists, than a false alarm or of another item.
    pub(super) is_of_track: bool,
}

/// An own observation, its field of view, and what is known about the world.
pub(super) struct Look<'l> {
    pub(super) observation: &'l OwnObservation<'l>,
    pub(super) view: View,
    pub(super) map: Option<&'l Map>,
    pub(super) kinds: Option<&'l KindModel>,
    /// The kinds of items that are to be cleared, one bit for each; none outside of a lane.
    pub(super) hazards: Option<u8>,
}

impl<'l> Look<'l> {
    pub(super) fn new(
        observation: &'l OwnObservation<'l>,
        map: Option<&'l Map>,
        (kinds, hazards): (Option<&'l KindModel>, Option<u8>),
    ) -> Self {
        Self {
            observation,
            view: View::new(observation.detector, observation.pose.heading_rad),
            map,
            kinds,
            hazards,
        }
    }

    /// A contact, unless its numbers are invalid.
    pub(super) fn contact(&self, contact: &Contact) -> Option<SeenContact> {
        if !(0.0..=1e6).contains(&contact.range_m) || contact.bearing_rad.abs() > 10.0 {
            return None;
        }
        let observation = self.observation;
        let relative = direction(contact.bearing_rad).times(contact.range_m);
        let at = observation.pose.in_world(relative);
        let pose_variance_m2 = observation.pose_variance_m2(contact.range_m);
        let variance_m2 = observation.variance_m2(pose_variance_m2);
        let unseen = self.unseen(at, variance_m2);
        Some(SeenContact {
            kind: contact.kind,
            range_m: contact.range_m,
            at,
            variance_m2,
            pose_variance_m2,
            unseen,
            false_per_m2: self.false_per_m2(contact.kind, at, pose_variance_m2),
            untracked_per_m2: unseen * observation.untracked_per_m2(contact),
            tracked_per_m2: 0.0,
            nearest_per_m2: 0.0,
            is_of_track: false,
        })
    }

    /// Probability that no observation so far would have detected an item at a position.
    ///
    /// A cell at the edge of the field of view does not count as observed, though a contact may be
    /// in it, and a contact with an error of more than half a cell may be in any of the surrounding
    /// cells. In these cases, the best observed cell of the neighbourhood determines the density.
    fn unseen(&self, at: Point, variance_m2: f64) -> f64 {
        let unseen = self.map.map_or(1.0, |map| {
            let cell = map.field.nearest_cell(at);
            let offset = self.observation.pose.at.to(map.field.centre(cell));
            let half_width_m = map.field.cell_m / 2.0;
            let is_clear = self.view.holds(offset) && variance_m2 < half_width_m * half_width_m;
            let reach = i32::from(!is_clear);
            let cells = map.field.around(cell, reach);
            cells.map(|cell| map.coverage.of(cell)).fold(1.0, f64::min)
        });
        unseen.max(MIN_UNSEEN)
    }

    /// Density of false alarms at a contact. They are in the field of view, also if errors place an item outside.
    fn false_per_m2(&self, kind: u16, at: Point, pose_variance_m2: f64) -> f64 {
        let detector = self.observation.detector;
        let per_m2 = detector.false_alarms_per_m2.get(usize::from(kind));
        let deviation_m = libm::sqrt(pose_variance_m2);
        let in_view = self.in_view(at, deviation_m.max(MIN_VIEW_DEVIATION_M));
        (per_m2.copied().unwrap_or_default() * in_view.max(MIN_FALSE_SHARE)).max(1e-12)
    }

    /// Probability that a place in the world with a standard deviation, along each axis, is in view.
    pub(super) fn in_view(&self, at: Point, deviation_m: f64) -> f64 {
        let offset = self.observation.pose.at.to(at);
        self.view.probability(offset, deviation_m)
    }

    /// Density at a contact of the contacts of a track's item, if it is detected; 0 far from it.
    pub(super) fn density(&self, track: &Track, contact: &SeenContact) -> f64 {
        let all_m2 = contact.variance_m2 + track.variance_m2;
        let square_m2 = track.at.to(contact.at).length_squared();
        if square_m2 > GATE * GATE * all_m2 {
            return 0.0;
        }
        // Where the item is, given that the contact is of it.
        let gain = track.variance_m2 / all_m2;
        let at = track.at.plus(track.at.to(contact.at).times(gain));
        let in_view = self.in_view(at, libm::sqrt(track.variance_m2 * (1.0 - gain)));
        in_view * libm::exp(-square_m2 / (2.0 * all_m2)) / (2.0 * PI * all_m2)
    }
}
