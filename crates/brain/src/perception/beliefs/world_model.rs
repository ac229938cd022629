//! The world model of a robot: all its beliefs, and their update with each percept.

use super::battery::Battery;
use super::coverage_map::DetectorScan;
use super::displacement::Displacement;
use super::items::kinds::KindModel;
use super::items::{Items, OwnObservation};
use super::localisation::Localisation;
use super::map::Map;
use super::others::Others;
use super::pose::Pose;
use super::scans::new_scans;
use super::spec::BeliefsSpec;
use crate::io::act::{ActKind, Acted};
use crate::io::agent_id::AgentId;
use crate::io::body::{Body, Detector};
use crate::io::message::About;
use crate::io::percept::{Contact, Observation, Percept};
use crate::io::work::lane::LaneMessage;
use crate::io::work::lane::MarkVerdict;
use crate::perception::dead_reckoning::Odometry;
use crate::perception::rays::Ring;
use alloc::sync::Arc;
use base::geometry::Point;
use base::hashed::Hashed;

/// Rounding tolerance between the ages of an observation and of its contacts.
const AGE_TOLERANCE_S: f64 = 1e-6;

/// Tracks within this distance of what another robot has destroyed are forgotten: the reach of a charge, and the errors of
/// both poses.
const STATED_WITHIN_M: f64 = 1.0;

/// The beliefs of one robot.
#[derive(Debug, Clone, Hashed)]
pub(crate) struct Beliefs {
    /// Prior density of items of each kind; all robots of a kind share it.
    pub(crate) per_m2: Arc<[f64]>,
    pub(crate) id: AgentId,
    pub(crate) localisation: Localisation,
    pub(crate) others: Others,
    pub(crate) items: Items,
    battery: Battery,
    /// `None` if the mission area is unknown.
    pub(crate) map: Option<Map>,
    /// Number of item observations so far, and time since the brain was started.
    pub(crate) observations: u32,
    uptime_s: f64,
}

impl Beliefs {
    /// The initial beliefs.
    pub(crate) fn new(spec: &BeliefsSpec, body: &Body) -> Self {
        let area = spec.area_m.or(body.field);
        let area_m2 = area.map_or(1.0, |area| area.area_m2().max(1.0));
        let kinds = body.item_kinds.iter();
        let expected = kinds.map(|kind| spec.prior_count.get(kind).copied().unwrap_or(1.0));
        let per_m2: Arc<[f64]> = expected.map(|expected| expected / area_m2).collect();
        Self {
            id: AgentId::default(),
            localisation: Localisation::default(),
            others: Others::default(),
            items: Items::new(spec.max_tracks, KindModel::new(body, &per_m2)),
            battery: Battery::default(),
            per_m2,
            map: area.map(|area| Map::new(spec, &area)),
            observations: 0,
            uptime_s: 0.0,
        }
    }

    /// The estimated pose, if known.
    pub(crate) fn pose(&self) -> Option<Pose> {
        self.localisation.pose()
    }

    /// The pose at the time of a measurement of the last step.
    pub(crate) fn pose_then(&self, age_s: f64, body: &Body) -> Option<Pose> {
        self.localisation.pose_then(age_s, body)
    }

    /// Estimated remaining time of the battery, in seconds; infinite if unknown.
    pub(crate) fn battery_s(&self) -> f64 {
        self.battery.remaining_s()
    }

    /// Estimated charge of the battery, 0 to 1, if known.
    pub(crate) fn battery_charge(&self) -> Option<f64> {
        self.battery.charge()
    }

    /// Mean time between two item observations.
    pub(crate) fn observation_period_s(&self) -> f64 {
        self.uptime_s / f64::from(self.observations.max(1))
    }

    /// Renumbers the robots; information about removed robots is dropped.
    pub(crate) fn renumber(&mut self, new_id: &impl Fn(AgentId) -> Option<AgentId>) {
        let keep = |id: &mut AgentId| new_id(*id).map(|new| *id = new).is_some();
        self.others.renumber(keep);
        self.items.renumber(keep);
    }

    /// The position of another robot in the world, if it is tracked.
    pub(crate) fn position_of(&self, id: AgentId) -> Option<Point> {
        let pose = self.pose()?;
        let mut movers = self.others.movers.iter();
        let tracked = movers.find(|mover| mover.id == Some(id))?;
        Some(pose.in_world(tracked.at))
    }

    /// Updates the beliefs after a step. Returns the displacement of the body.
    pub(crate) fn update(
        &mut self,
        percept: &Percept,
        body: &Body,
        rings: &[Ring],
        odometry: &Odometry,
    ) -> Displacement {
        let elapsed_s = odometry.elapsed_s;
        self.id = percept.id;
        self.uptime_s += elapsed_s;
        let moved = self.localisation.step(percept, body, odometry);
        let pose = self.localisation.pose();
        self.others.update(percept, body, &moved, pose.as_ref());
        for (ring, ranges_m) in new_scans(percept, rings, elapsed_s) {
            self.others.scan(ring, ranges_m);
        }
        self.battery.update(percept, elapsed_s);
        self.note_lane(percept, body);
        if let Some(pose) = pose {
            self.update_map(percept, &pose, rings, elapsed_s);
            self.observe(percept, body);
        }
        moved
    }

    /// Takes the observations of items.
    fn observe(&mut self, percept: &Percept, body: &Body) {
        for observation in &percept.observations {
            if let Some(then) = self.localisation.pose_before(observation.age_s, body) {
                self.update_items(observation, percept, body, then);
            }
        }
    }

    /// Takes messages and results about a lane. What this robot, or another by its statement, has destroyed is
    /// forgotten: later contacts there are of other items.
    fn note_lane(&mut self, percept: &Percept, body: &Body) {
        for received in &percept.inbox {
            match received.message.about {
                About::Lane(LaneMessage::Lane(lane)) => self.items.hazards = Some(lane.hazards),
                About::Lane(LaneMessage::Statement(statement))
                    if statement.verdict == MarkVerdict::Neutralised =>
                {
                    let at = Point::from(statement.at_m.map(f64::from));
                    self.items.forget(at, STATED_WITHIN_M);
                }
                _ => {}
            }
        }
        let is_charge = |acted: &&Acted| acted.kind == ActKind::Neutralise && acted.is_success;
        for acted in percept.acted.iter().filter(is_charge) {
            let reach_m = body
                .tool(ActKind::Neutralise)
                .map_or(0.0, |tool| tool.reach_m);
            self.items.forget(acted.at, reach_m);
        }
    }

    fn update_map(&mut self, percept: &Percept, pose: &Pose, rings: &[Ring], elapsed_s: f64) {
        let Some(map) = &mut self.map else {
            return;
        };
        if map.is_update_due(pose, elapsed_s) {
            for scan in new_scans(percept, rings, elapsed_s) {
                map.update(pose, &self.others, scan);
            }
        }
    }

    /// Updates items and coverage with an observation of an own detector, and its contacts.
    fn update_items(
        &mut self,
        observation: &Observation,
        percept: &Percept,
        body: &Body,
        pose: Pose,
    ) {
        let mut detectors = body.detectors.iter();
        let Some(detector) = detectors.find(|detector| detector.sensor == observation.sensor)
        else {
            return;
        };
        self.observations = self.observations.saturating_add(1);
        let own = OwnObservation {
            observer: self.id,
            detector,
            pose,
            per_m2: &self.per_m2,
        };
        let belongs = |contact: &&Contact| {
            contact.sensor == observation.sensor
                && (contact.age_s - observation.age_s).abs() < AGE_TOLERANCE_S
        };
        let contacts = percept.contacts.iter().filter(belongs);
        self.items.observe(&own, contacts, self.map.as_ref());
        self.update_coverage(detector, (pose.at, pose.heading_rad), [1.0, 1.0]);
    }

    /// Updates the coverage map with a number of observations from a pose, weighted by trust.
    pub(crate) fn update_coverage(
        &mut self,
        detector: &Detector,
        (at, heading_rad): (Point, f64),
        [trust, observations]: [f64; 2],
    ) {
        if let Some(Map {
            field,
            occupancy,
            coverage,
            ..
        }) = &mut self.map
        {
            let blur_m = self.localisation.pose().map_or(0.0, |pose| pose.blur_m());
            let scan = DetectorScan {
                detector,
                at,
                heading_rad,
                trust,
                observations,
                blur_m,
            };
            coverage.update(field, (field, occupancy), &scan);
        }
    }
}
