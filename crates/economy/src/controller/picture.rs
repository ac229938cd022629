//! The picture that a controller has of the robots: what they report, and where they are seen.

use super::trust::Trust;
use alloc::vec::Vec;
use base::geometry::Point;
use brain::{Report, RobotId, Task};

/// A robot is forgotten when nothing has been received of it for this time, in seconds, except for
/// the trust in it.
const LIFE_S: f64 = 20.0;

/// Maximum number of robots; the one that has been silent the longest is forgotten first.
const MAX_ROBOTS: usize = 4096;

/// All robots that a controller knows.
#[derive(Debug, Clone, Default)]
pub(super) struct Picture {
    robots: Vec<Robot>,
}

base::hashed!(Picture { robots });

/// A robot, as a controller knows it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Robot {
    pub(super) id: RobotId,
    pub(super) at: Option<Point>,
    pub(super) speed_m_s: f64,
    /// Number of goals that it serves, and that it can serve in addition.
    pub(super) goals: u16,
    pub(super) payload: u16,
    received_s: f64,
    pub(super) is_present: bool,
    pub(super) trust: Trust,
}

base::hashed!(Robot {
    id,
    at,
    speed_m_s,
    goals,
    payload,
    received_s,
    is_present,
    trust
});

impl Robot {
    /// Distance to a goal; infinite if its position is unknown.
    pub(super) fn distance_m(&self, task: &Task) -> f64 {
        self.at
            .map_or(f64::INFINITY, |at| at.to(task.at()).length())
    }
}

impl Picture {
    /// The robots from which messages are received.
    pub(super) fn present(&self) -> impl Iterator<Item = &Robot> {
        self.robots.iter().filter(|robot| robot.is_present)
    }

    pub(super) fn get(&self, id: RobotId) -> Option<&Robot> {
        self.robots.iter().find(|robot| robot.id == id)
    }

    /// Notes a message of a robot; returns whether it was not present before.
    pub(super) fn note(&mut self, id: RobotId, now_s: f64) -> bool {
        let robot = self.robot(id, now_s);
        robot.received_s = now_s;
        !core::mem::replace(&mut robot.is_present, true)
    }

    pub(super) fn report(&mut self, id: RobotId, report: &Report, now_s: f64) {
        let robot = self.robot(id, now_s);
        let at = Point::from(report.at_m.map(f64::from));
        robot.at = Some(at).filter(|at| at.x.is_finite() && at.y.is_finite());
        robot.speed_m_s = f64::from(report.speed_m_s).clamp(1e-3, 1e3);
        (robot.goals, robot.payload) = (report.goals, report.payload);
    }

    /// Notes where a robot is seen, by this controller or another.
    pub(super) fn see(&mut self, id: RobotId, at: Point, now_s: f64) {
        if at.x.is_finite() && at.y.is_finite() {
            self.robot(id, now_s).at = Some(at);
        }
    }

    /// A robot has refused a goal because it serves the maximum number.
    pub(super) fn is_full(&mut self, id: RobotId, now_s: f64) {
        self.robot(id, now_s).payload = 0;
    }

    /// An award to a robot has been served, or not.
    pub(super) fn learn(&mut self, id: RobotId, is_served: bool, now_s: f64) {
        self.robot(id, now_s).trust.learn(is_served);
    }

    pub(super) fn expire(&mut self, now_s: f64) {
        for robot in &mut self.robots {
            robot.is_present &= now_s < robot.received_s + LIFE_S;
        }
    }

    fn robot(&mut self, id: RobotId, now_s: f64) -> &mut Robot {
        let known = self.robots.iter().position(|robot| robot.id == id);
        let index = known.unwrap_or_else(|| {
            if self.robots.len() == MAX_ROBOTS {
                let ages = self.robots.iter().enumerate();
                let oldest =
                    ages.min_by(|one, other| one.1.received_s.total_cmp(&other.1.received_s));
                self.robots.remove(oldest.map_or(0, |(index, _)| index));
            }
            self.robots.push(Robot {
                id,
                at: None,
                speed_m_s: 1.0,
                goals: 0,
                payload: 1,
                received_s: now_s,
                is_present: false,
                trust: Trust::default(),
            });
            self.robots.len() - 1
        });
        &mut self.robots[index]
    }
}
