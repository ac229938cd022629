//! The picture that a controller has of the robots: what they report, and where they are seen.
//!
//! A position has a weight: the trust in its source times the confidence of the message, halved every
//! [`HALF_LIFE_S`]. Own sensors and other controllers have a trust of 1, a robot the one that its
//! awards have earned. Of two positions of a robot, the one with the higher weight counts: what others
//! see outweighs the report of a robot that is not trusted, until it is old.

mod trust;

use alloc::vec::Vec;
use base::geometry::Point;
use base::hashed::Hashed;
use brain::{AgentId, Report, Task};
use trust::Trust;

/// A robot is forgotten when nothing has been received of it for this time, in seconds, except for
/// the trust in it.
const LIFE_S: f64 = 20.0;

/// Time in which the weight of a position halves, in seconds: robots report every three seconds.
const HALF_LIFE_S: f64 = 3.0;

/// Maximum number of robots; the one that has been silent the longest is forgotten first.
const MAX_ROBOTS: usize = 4096;

/// All robots that a controller knows.
#[derive(Debug, Clone, Default, Hashed)]
pub(super) struct Robots {
    robots: Vec<Robot>,
}

/// A robot, as a controller knows it.
#[derive(Debug, Clone, Copy, Hashed)]
pub(super) struct Robot {
    pub(super) id: AgentId,
    pub(super) at: Option<Point>,
    /// The weight of the position when it was received, and that time.
    weight: f64,
    at_s: f64,
    pub(super) speed_m_s: f64,
    /// Number of goals that it serves, and that it can serve in addition.
    pub(super) goals: u16,
    pub(super) payload: u16,
    received_s: f64,
    pub(super) is_present: bool,
    pub(super) trust: Trust,
}

impl Robot {
    /// Distance to a goal; infinite if its position is unknown.
    pub(super) fn distance_m(&self, task: &Task) -> f64 {
        self.at
            .map_or(f64::INFINITY, |at| at.to(task.at()).length())
    }

    /// The cost of a bid: the expected time divided by confidence, trust and value.
    pub(super) fn cost_s(&self, task: &Task, [time_s, confidence]: [f64; 2]) -> f64 {
        let value = f64::from(task.value).max(1e-6);
        time_s / (confidence * self.trust.value() * value)
    }

    /// The cost of a goal that it could serve after those that it serves now, as if each of them took as long; infinite if its
    /// position is unknown.
    pub(super) fn later_cost_s(&self, task: &Task) -> f64 {
        let time_s = self.distance_m(task) / self.speed_m_s + f64::from(task.service_s);
        self.cost_s(task, [time_s * f64::from(self.goals + 1), 1.0])
    }

    /// Takes a position, unless the known one has a higher weight.
    fn place(&mut self, at: Point, weight: f64, now_s: f64) {
        let known = self.weight * libm::exp2((self.at_s - now_s) / HALF_LIFE_S);
        let is_valid = at.x.is_finite() && at.y.is_finite() && (0.0..=1.0).contains(&weight);
        if is_valid && (self.at.is_none() || weight >= known) {
            (self.at, self.weight, self.at_s) = (Some(at), weight, now_s);
        }
    }
}

impl Robots {
    /// The robots from which messages are received.
    pub(super) fn present(&self) -> impl Iterator<Item = &Robot> {
        self.robots.iter().filter(|robot| robot.is_present)
    }

    pub(super) fn get(&self, id: AgentId) -> Option<&Robot> {
        self.robots.iter().find(|robot| robot.id == id)
    }

    /// Notes a message of a robot; returns whether it was not present before.
    pub(super) fn note(&mut self, id: AgentId, now_s: f64) -> bool {
        let robot = self.robot(id, now_s);
        robot.received_s = now_s;
        !core::mem::replace(&mut robot.is_present, true)
    }

    /// Takes the report of a robot, with the confidence of the message.
    pub(super) fn report(&mut self, id: AgentId, report: &Report, confidence: f64, now_s: f64) {
        let robot = self.robot(id, now_s);
        let at = Point::from(report.at_m.map(f64::from));
        robot.place(at, robot.trust.value() * confidence, now_s);
        robot.speed_m_s = f64::from(report.speed_m_s).clamp(1e-3, 1e3);
        (robot.goals, robot.payload) = (report.goals, report.payload);
    }

    /// Notes where a robot is seen, by this controller or another, and with what confidence.
    pub(super) fn see(&mut self, id: AgentId, at: Point, confidence: f64, now_s: f64) {
        self.robot(id, now_s).place(at, confidence, now_s);
    }

    /// A robot has refused a goal because it serves the maximum number.
    pub(super) fn is_full(&mut self, id: AgentId, now_s: f64) {
        self.robot(id, now_s).payload = 0;
    }

    /// A robot has been taken out of service: its next report is that of a robot that returns.
    pub(super) fn is_gone(&mut self, id: AgentId, now_s: f64) {
        self.robot(id, now_s).is_present = false;
    }

    /// An award to a robot has been served, or not.
    pub(super) fn learn(&mut self, id: AgentId, is_served: bool, now_s: f64) {
        self.robot(id, now_s).trust.learn(is_served);
    }

    pub(super) fn expire(&mut self, now_s: f64) {
        for robot in &mut self.robots {
            robot.is_present &= now_s < robot.received_s + LIFE_S;
        }
    }

    fn robot(&mut self, id: AgentId, now_s: f64) -> &mut Robot {
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
                weight: 0.0,
                at_s: now_s,
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

#[cfg(test)]
mod tests {
    use super::*;

    const ROBOT: AgentId = AgentId::robot(0, 0);

    fn reported(x: f32) -> Report {
        Report {
            at_m: [x, 0.0],
            speed_m_s: 1.0,
            battery: 1.0,
            goals: 0,
            payload: 1,
        }
    }

    /// Where a robot is in the picture that is seen at 0 m, and then reports 50 m.
    fn x_m(failures: u32, confidence: f64, after_s: f64) -> f64 {
        let mut picture = Robots::default();
        (0..failures).for_each(|_| picture.learn(ROBOT, false, 0.0));
        picture.see(ROBOT, Point::default(), 1.0, 0.0);
        picture.report(ROBOT, &reported(50.0), confidence, after_s);
        picture.get(ROBOT).unwrap().at.unwrap().x
    }

    #[test]
    fn what_is_seen_outweighs_the_report_of_a_distrusted_robot_until_it_is_old() {
        let is_reported = |failures, confidence, after_s| x_m(failures, confidence, after_s) > 25.0;
        assert!(is_reported(0, 1.0, 1.0) && !is_reported(8, 1.0, 1.0));
        assert!(!is_reported(0, 0.5, 1.0));
        assert!(is_reported(8, 1.0, 10.0) && is_reported(0, 0.5, 10.0));
        assert!(!is_reported(0, f64::NAN, 10.0) && !is_reported(0, 2.0, 10.0));
    }
}
