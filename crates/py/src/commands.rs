//! Commands for the robots of a kind, from arrays.

use crate::arrays::{GOAL, STATUSES};
use base::geometry::Point;
use brain::{About, GoalId, Message, Motion, Provenance, RobotId, SensorRequest};
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use sim::step::PendingDecision;

/// Arrays as `agent_economy.runs.batch` has checked them; `row` is the index of the robot of an entry.
#[derive(FromPyObject)]
pub(crate) struct Commands<'py> {
    speed_m_s: PyReadonlyArray1<'py, f64>,
    turn_rate_rad_s: PyReadonlyArray1<'py, f64>,
    requests: Requests<'py>,
    outbox: Outbox<'py>,
}

#[derive(FromPyObject)]
struct Requests<'py> {
    row: PyReadonlyArray1<'py, i64>,
    sensor: PyReadonlyArray1<'py, u16>,
    on: PyReadonlyArray1<'py, bool>,
}

#[derive(FromPyObject)]
struct Outbox<'py> {
    row: PyReadonlyArray1<'py, i64>,
    confidence: PyReadonlyArray1<'py, f64>,
    item_kind: PyReadonlyArray1<'py, i64>,
    at: PyReadonlyArray2<'py, f64>,
    heading_rad: PyReadonlyArray1<'py, f64>,
    observations: PyReadonlyArray1<'py, u32>,
    issuer_kind: PyReadonlyArray1<'py, u8>,
    issuer_index: PyReadonlyArray1<'py, u32>,
    goal_number: PyReadonlyArray1<'py, u32>,
    status: PyReadonlyArray1<'py, u8>,
}

impl Commands<'_> {
    /// Sets the commands of the robots.
    pub(crate) fn apply(&self, decisions: &mut [PendingDecision]) {
        let speeds = self.speed_m_s.as_array();
        let turns = self.turn_rate_rad_s.as_array();
        for (decision, (speed, turn)) in decisions.iter_mut().zip(speeds.iter().zip(turns)) {
            decision.command.motion = Motion {
                speed_m_s: *speed,
                turn_rate_rad_s: *turn,
            };
        }
        self.requests.apply(decisions);
        self.outbox.apply(decisions);
    }
}

impl Requests<'_> {
    fn apply(&self, decisions: &mut [PendingDecision]) {
        let switches = self.sensor.as_array().into_iter().zip(self.on.as_array());
        for (row, (sensor, on)) in self.row.as_array().iter().zip(switches) {
            let request = SensorRequest {
                sensor: *sensor,
                on: *on,
            };
            if let Some(decision) = at_row(decisions, *row) {
                decision.command.requests.push(request);
            }
        }
    }
}

impl Outbox<'_> {
    fn goal_ids(&self) -> impl Iterator<Item = GoalId> {
        let kinds = self.issuer_kind.as_array().into_iter();
        let issuers = kinds.zip(self.issuer_index.as_array());
        let ids = issuers.zip(self.goal_number.as_array());
        ids.map(|((kind, index), number)| GoalId {
            issuer: RobotId {
                kind: *kind,
                index: *index,
            },
            number: *number,
        })
    }

    fn apply(&self, decisions: &mut [PendingDecision]) {
        let places = self.at.as_array();
        let places = places
            .rows()
            .into_iter()
            .map(|at| Point { x: at[0], y: at[1] });
        let kinds = self.item_kind.as_array();
        let abouts = places.zip(kinds.iter().zip(self.heading_rad.as_array()));
        let more = self
            .observations
            .as_array()
            .into_iter()
            .zip(self.status.as_array())
            .zip(self.goal_ids());
        let abouts = abouts.zip(more).map(|((at, (kind, heading_rad)), more)| {
            let ((observations, status), id) = ((*more.0.0, *more.0.1), more.1);
            match u16::try_from(*kind) {
                // A receiver then counts it as observed by the sender.
                Ok(kind) => About::Item {
                    kind,
                    at,
                    provenance: Provenance::default(),
                },
                Err(_) if *kind == GOAL => About::Goal {
                    id,
                    at,
                    status: STATUSES[usize::from(status) % STATUSES.len()],
                },
                Err(_) => About::Sender {
                    at,
                    heading_rad: *heading_rad,
                    observations,
                },
            }
        });
        let confidences = self.confidence.as_array();
        let messages = abouts.zip(confidences).map(|(about, confidence)| Message {
            to: RobotId::EVERYONE,
            about,
            confidence: *confidence,
        });
        for (row, message) in self.row.as_array().iter().zip(messages) {
            if let Some(decision) = at_row(decisions, *row) {
                decision.command.outbox.push(message);
            }
        }
    }
}

fn at_row(decisions: &mut [PendingDecision], row: i64) -> Option<&mut PendingDecision> {
    decisions.get_mut(usize::try_from(row).ok()?)
}
