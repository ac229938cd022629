//! What a robot believes, made of percepts: the *identifier* of a mind (after Rodin and Amin, who
//! layer one into an identifier, a [goal selector](crate::goals) and an [adapter](crate::navigation::navigator)).
//!
//! Bounded: with its goals and ways a mind takes at most 40 kB, twenty bytes a cell of at most
//! [`BeliefsSpec::cells`], and forty a ray. A test counts them.

pub(crate) mod coverage_map;
mod doubt;
mod drain;
pub(crate) mod field;
pub(crate) mod items;
mod messaging;
pub(crate) mod mover;
mod moving;
pub(crate) mod occupancy;
pub(crate) mod others;
pub(crate) mod peers;
pub(crate) mod pose;
pub(crate) mod trust;

pub use trust::TrustSpec;

use crate::io::body::{Body, Detector, RobotId};
use crate::io::percept::{Observation, Percept};
use crate::perception::believed::BelievedItem;
use crate::perception::rays::{Ring, free_ranges_m};
use crate::perception::sector::direction;
use alloc::collections::BTreeMap;
use alloc::string::String;
use alloc::sync::Arc;
use alloc::vec::Vec;
use base::geometry::{Point, Rectangle, Segment};
use base::trig::wrapped;
use coverage_map::{CoverageMap, Glance};
use drain::Drain;
use field::Field;
use items::{Items, OwnLook};
use messaging::Told;
use occupancy::{Occupancy, Ray};
use others::Others;
use peers::Peers;
use pose::{Localisation, Pose, turned};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use trust::Trust;

/// Contacts of a look have its age, but for rounding.
const SAME_S: f64 = 1e-6;

/// Scans are drawn into the map when the robot has moved by this share of a cell, has turned so far, or
/// after so long.
const DRAWN_CELLS: f64 = 0.25;
const DRAWN_RAD: f64 = 0.1;
const DRAWN_S: f64 = 0.5;

/// What a mind believes, and how finely.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct BeliefsSpec {
    /// Where it searches and what it maps, two opposite corners in metres; left out, the whole world.
    pub area_m: Option<Rectangle>,
    /// Its maps have cells at least so wide, in metres.
    #[schemars(range(min = 0.05, max = 1000.0))]
    pub cell_m: f64,
    /// Its maps have at most so many cells; each takes a robot some twenty bytes.
    #[schemars(range(min = 16, max = 65_000))]
    pub cells: u32,
    /// How many items of each kind it expects before it has looked; left out, one of each kind.
    pub prior_count: BTreeMap<String, f64>,
    /// How far it trusts what others tell.
    pub trust: TrustSpec,
}

impl Default for BeliefsSpec {
    fn default() -> Self {
        Self {
            area_m: None,
            cell_m: 0.25,
            cells: 4096,
            prior_count: BTreeMap::new(),
            trust: TrustSpec::default(),
        }
    }
}

/// What is the same for all robots of a kind.
#[derive(Debug)]
struct Prior {
    trust: TrustSpec,
    /// Items of each kind in a square metre.
    per_m2: Vec<f64>,
}

/// All that one robot believes.
#[derive(Debug, Clone)]
pub(crate) struct Beliefs {
    prior: Arc<Prior>,
    id: RobotId,
    here: Localisation,
    pub(crate) others: Others,
    pub(crate) peers: Peers,
    pub(crate) items: Items,
    trust: Trust,
    drain: Drain,
    /// If it knows where its mission is.
    pub(crate) map: Option<Map>,
    speed_m_s: f64,
    /// How often it has looked for items, and for how long it has been on.
    observations: u32,
    on_s: f64,
    told: Told,
}

/// The mission's field, what fills it, and where nobody has looked.
#[derive(Debug, Clone)]
pub(crate) struct Map {
    pub(crate) field: Field,
    pub(crate) filled: Occupancy,
    pub(crate) unseen: CoverageMap,
    /// From where scans were drawn last, and how long ago.
    drawn: Option<(Pose, f64)>,
}

impl Map {
    pub(crate) fn new(spec: &BeliefsSpec, area: &Rectangle) -> Self {
        let field = Field::new(area, spec.cell_m, spec.cells as usize);
        Self {
            filled: Occupancy::new(&field),
            unseen: CoverageMap::new(field.cells()),
            drawn: None,
            field,
        }
    }
}

impl Map {
    /// Whether scans tell something new: from where the last were taken, they err as those did.
    fn is_worth_drawing(&mut self, pose: &Pose, period_s: f64) -> bool {
        if let Some((last, age_s)) = &mut self.drawn {
            *age_s += period_s;
            let moved_m2 = last.at.to(pose.at).length_squared();
            let turned_rad = wrapped(pose.heading_rad - last.heading_rad).abs();
            let apart_m = DRAWN_CELLS * self.field.cell_m;
            if *age_s < DRAWN_S && moved_m2 < apart_m * apart_m && turned_rad < DRAWN_RAD {
                return false;
            }
        }
        self.drawn = Some((*pose, 0.0));
        true
    }
}

impl Beliefs {
    /// Those of a robot that has just been switched on.
    pub(crate) fn new(spec: &BeliefsSpec, body: &Body) -> Self {
        let area = spec.area_m.or(body.field);
        let area_m2 = area.map_or(1.0, |area| area.area_m2().max(1.0));
        let kinds = body.item_kinds.iter();
        let expected = kinds.map(|kind| spec.prior_count.get(kind).copied().unwrap_or(1.0));
        let prior = Prior {
            trust: spec.trust.clone(),
            per_m2: expected.map(|expected| expected / area_m2).collect(),
        };
        Self {
            prior: Arc::new(prior),
            id: RobotId::default(),
            here: Localisation::default(),
            others: Others::default(),
            peers: Peers::default(),
            items: Items::default(),
            trust: Trust::default(),
            drain: Drain::default(),
            map: area.map(|area| Map::new(spec, &area)),
            speed_m_s: 0.0,
            observations: 0,
            on_s: 0.0,
            told: Told::default(),
        }
    }

    /// Where it is, if it knows.
    pub(crate) fn pose(&self) -> Option<Pose> {
        self.here.pose()
    }

    /// So long the battery lasts, in seconds; infinite if nobody knows.
    pub(crate) fn battery_s(&self) -> f64 {
        self.drain.lasts_s()
    }

    /// Share of the battery that is left, if it is known; one misreading says nothing.
    pub(crate) fn battery_left(&self) -> Option<f64> {
        self.drain.left()
    }

    /// Time from one look for items to the next.
    pub(crate) fn look_s(&self) -> f64 {
        self.on_s / f64::from(self.observations.max(1))
    }

    /// Robots have other numbers from now on; what is known of one that is gone is forgotten.
    pub(crate) fn renumber(&mut self, now: &impl Fn(RobotId) -> Option<RobotId>) {
        let keep = |id: &mut RobotId| now(*id).map(|now| *id = now).is_some();
        self.others
            .movers
            .retain_mut(|mover| mover.id.as_mut().is_none_or(keep));
        self.peers.mates.retain_mut(|peer| keep(&mut peer.id));
        self.trust.renumber(keep);
        self.items.renumber(keep);
    }

    /// Items, by how surely they are there.
    pub(crate) fn believed_items(&self) -> impl Iterator<Item = BelievedItem> {
        let ears = messaging::ears(self.id, &self.trust, &self.prior);
        self.items.tracks.iter().map(move |track| BelievedItem {
            kind: track.kind,
            at: track.at,
            deviation_m: libm::sqrt(track.variance_m2),
            confidence: track.confidence(&ears),
        })
    }

    /// Where another robot is in the world, if it is seen, or has told of late.
    pub(crate) fn whereabouts(&self, id: RobotId) -> Option<Point> {
        let pose = self.pose()?;
        let mut seen = self.others.movers.iter();
        let seen = seen.find(|mover| mover.id == Some(id));
        let told = || {
            let mut mates = self.peers.mates.iter();
            mates.find(|peer| peer.id == id)?.at()
        };
        seen.map(|mover| pose.world_of(mover.at)).or_else(told)
    }

    /// Takes in a step: `now_m_s` is its likely speed, and `turned_rad` what it turned since the last.
    pub(crate) fn take_in(
        &mut self,
        percept: &Percept,
        body: &Body,
        rings: &[Ring],
        [now_m_s, turned_rad]: [f64; 2],
    ) {
        self.id = percept.id;
        self.on_s += body.period_s;
        let way_m = way_m([self.speed_m_s, now_m_s], body);
        self.speed_m_s = now_m_s;
        self.here.take_in(percept, body, way_m, turned_rad);
        let way = direction(turned_rad / 2.0).times(way_m);
        self.others.take_in(percept, body, way, turned_rad);
        for (ring, ranges_m) in new_scans(percept, rings, body.period_s) {
            self.others.scan(ring, ranges_m);
        }
        self.peers.pass(body.period_s);
        self.drain.take_in(percept, body.period_s);
        let Some(pose) = self.here.pose() else {
            return;
        };
        self.fill_map(percept, &pose, rings, body.period_s);
        let rate_rad_s = turned_rad / body.period_s.max(f64::MIN_POSITIVE);
        for look in &percept.observations {
            let then = earlier(&pose, [now_m_s, rate_rad_s], look.age_s);
            self.take_look(look, percept, body, then);
        }
        for heard in &percept.inbox {
            self.hear(heard, body, &pose);
        }
        self.items
            .learn(self.id, &mut self.trust, &self.prior.trust);
    }

    fn fill_map(&mut self, percept: &Percept, pose: &Pose, rings: &[Ring], period_s: f64) {
        let Some(map) = &mut self.map else {
            return;
        };
        if !map.is_worth_drawing(pose, period_s) {
            return;
        }
        let front = direction(pose.heading_rad);
        let there = |end: Point| pose.at.plus(turned(end, front));
        for (ring, ranges_m) in new_scans(percept, rings, period_s) {
            map.filled.begin_scan();
            let free_m = free_ranges_m(ranges_m);
            for (ray, free_m) in ring.rays(ranges_m).zip(free_m) {
                let end = ray.end();
                let is_hit = ray.range_m < ring.range_m() && !self.others.is_on_one(end);
                let free = there(ray.direction.times(free_m.min(ray.range_m)));
                let way = Segment {
                    from: pose.at,
                    to: free,
                };
                map.filled.take_in(
                    &map.field,
                    &Ray {
                        way,
                        hit: is_hit.then(|| there(end)),
                    },
                );
            }
        }
    }

    /// Takes in a look for items, and its contacts.
    fn take_look(&mut self, look: &Observation, percept: &Percept, body: &Body, pose: Pose) {
        let mut detectors = body.detectors.iter();
        let Some(detector) = detectors.find(|detector| detector.sensor == look.sensor) else {
            return;
        };
        self.observations = self.observations.saturating_add(1);
        let own = OwnLook {
            observer: self.id,
            detector,
            pose,
            per_m2: &self.prior.per_m2,
        };
        let is_of_it = |contact: &&crate::io::percept::Contact| {
            contact.sensor == look.sensor && (contact.age_s - look.age_s).abs() < SAME_S
        };
        let contacts = percept.contacts.iter().filter(is_of_it);
        self.items.look(&own, contacts, self.map.as_ref());
        self.look_at_cells(detector, (pose.at, pose.heading_rad), [1.0, 1.0]);
    }

    /// Notes what a look that is so much trusted, and counts as so many, has seen of the field.
    fn look_at_cells(
        &mut self,
        detector: &Detector,
        (at, heading_rad): (Point, f64),
        [trust, observations]: [f64; 2],
    ) {
        if let Some(Map {
            field,
            filled,
            unseen,
            ..
        }) = &mut self.map
        {
            let blur_m = self.here.pose().map_or(0.0, |pose| pose.blur_m());
            let glance = Glance {
                detector,
                at,
                heading_rad,
                trust,
                observations,
                blur_m,
            };
            unseen.take_in(field, filled, &glance);
        }
    }
}

/// The way of a step at the end of which it is so fast: at once to the new speed, as far as that goes, and
/// then on with it.
fn way_m([before_m_s, now_m_s]: [f64; 2], body: &Body) -> f64 {
    let change_m_s = now_m_s - before_m_s;
    let change_s = change_m_s.abs() / body.max_acceleration_m_s2.max(f64::MIN_POSITIVE);
    now_m_s * body.period_s - change_m_s * change_s.min(body.period_s) / 2.0
}

/// Where it was some time ago, at a speed and a rate of turn.
fn earlier(pose: &Pose, [speed_m_s, rate_rad_s]: [f64; 2], age_s: f64) -> Pose {
    // What is no age is none.
    let age_s = if (0.0..=60.0).contains(&age_s) {
        age_s
    } else {
        0.0
    };
    let heading_rad = wrapped(pose.heading_rad - rate_rad_s * age_s);
    let way = direction(heading_rad + rate_rad_s * age_s / 2.0).times(-speed_m_s * age_s);
    Pose {
        at: pose.at.plus(way),
        heading_rad,
        ..*pose
    }
}

/// Scans that have not been taken in before.
fn new_scans<'p>(
    percept: &'p Percept,
    rings: &'p [Ring],
    period_s: f64,
) -> impl Iterator<Item = (&'p Ring, &'p [f64])> {
    let scans = rings.iter().zip(&percept.scans);
    scans.filter_map(move |(ring, scan)| {
        let (age_s, ranges_m) = ring.fresh(Some(scan))?;
        (age_s < ring.latency_s() + period_s).then_some((ring, ranges_m))
    })
}

/// Things that stand, as rays see them now: their bearings and how far they are from the centre.
pub(crate) fn standing(
    beliefs: &Beliefs,
    rings: &[Ring],
    percept: &Percept,
    into: &mut Vec<crate::perception::rays::Ray>,
) {
    into.clear();
    for (ring, scan) in rings.iter().zip(&percept.scans) {
        let Some((_, ranges_m)) = ring.fresh(Some(scan)) else {
            continue;
        };
        let still = |ray: &crate::perception::rays::Ray| {
            ray.range_m < ring.range_m() && !beliefs.others.is_on_one(ray.end())
        };
        into.extend(ring.rays(ranges_m).filter(still));
    }
}
