//! External bodies for display: where they may be, and what their sensors report.

use super::Simulation;
use crate::bodies::external::ExternalBody;
use crate::bodies::path::Orientation;
use base::geometry::Point;
use base::trig::sin_cos;
use brain::{AgentId, Body, Percept};

/// An external body at the end of a step.
#[derive(Debug, Clone, PartialEq)]
pub struct ExternalView {
    /// The robot.
    pub id: AgentId,
    /// Its believed position.
    pub at: Point,
    /// Radius of its footprint.
    pub radius_m: f64,
    /// How far its centre may be from there; of a silent robot, as far as it can have come.
    pub uncertainty_m: f64,
    /// Age of its newest position if it is silent.
    pub silent_s: Option<f64>,
    /// Where the centre of a silent robot may be, if its fence limits it; otherwise empty.
    pub outline: Vec<Point>,
    /// What its real sensors reported last.
    pub real: Detected,
    /// What its virtual sensors measured then, if its brain stepped.
    pub measured: Detected,
}

/// Places in the world where sensors detected something.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Detected {
    /// Ends of rays with a return.
    pub echoes: Vec<Point>,
    /// Items, or what was taken for one.
    pub contacts: Vec<Point>,
    /// Other robots.
    pub neighbours: Vec<Point>,
}

impl Simulation {
    /// All external bodies, in the order of their robots.
    #[must_use]
    pub fn external_views(&self) -> Vec<ExternalView> {
        let regions = self.state.regions.iter();
        let view = regions.map(|region| {
            let robot = region.robot;
            let id = self.state.ids[robot];
            let kind = self.scenario.kind_of(id);
            let external = self.state.body_states[robot].external();
            let perceived = self.scratch.perceived(robot);
            let at = self.state.discs[robot].centre;
            let pose = (at, &self.state.orientations[robot]);
            let detected = |percept: Option<&Percept>| {
                percept.map_or_else(Detected::default, |percept| {
                    Detected::new(percept, kind.brain.body(), pose)
                })
            };
            ExternalView {
                id,
                at,
                radius_m: kind.radius_m,
                uncertainty_m: region.uncertainty_m,
                silent_s: external.and_then(ExternalBody::silent_s),
                outline: region.corners().to_vec(),
                real: detected(perceived.map(|perceived| &perceived.real)),
                measured: detected(perceived.map(|perceived| &perceived.measured)),
            }
        });
        view.collect()
    }
}

impl Detected {
    fn new(percept: &Percept, body: &Body, (at, facing): (Point, &Orientation)) -> Self {
        let place = |range_m: f64, bearing_rad: f64| {
            let (y, x) = sin_cos(facing.heading_rad + bearing_rad);
            at.plus(Point { x, y }.times(range_m))
        };
        let rays = percept.scans.iter().zip(&body.rings);
        let rays = rays.flat_map(|(scan, ring)| scan.ranges_m.iter().zip(&ring.bearings_rad));
        let echoes = rays.filter(|(range_m, _)| range_m.is_finite());
        let contacts = percept.contacts.iter();
        let neighbours = percept.neighbours.iter();
        Self {
            echoes: echoes
                .map(|(range_m, bearing_rad)| place(*range_m, *bearing_rad))
                .collect(),
            contacts: contacts
                .map(|each| place(each.range_m, each.bearing_rad))
                .collect(),
            neighbours: neighbours
                .map(|each| place(each.range_m, each.bearing_rad))
                .collect(),
        }
    }
}
