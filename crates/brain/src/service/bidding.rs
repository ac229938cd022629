//! What a robot bids: the increment of the shortest path through its goals.
//!
//! The path between goals is a straight line. If the map has obstacles between the robot and the goal
//! of a bid, the increment is multiplied by the detour from the robot's position: exact for a robot
//! without other goals, and an estimate for one that comes from another goal.

use super::ability::{Ability, Moment};
use super::failures::Failures;
use super::jobs::Jobs;
use super::offers::Offer;
use super::reach::Reach;
use crate::goals::precedence::reachable_probability;
use crate::goals::tour::Tour;
use crate::io::contract::Bid;
use crate::io::reason::Reason;
use crate::io::work::Task;
use base::geometry::Point;

/// The basis of all bids of a step.
pub(crate) struct Bidder<'b> {
    ability: &'b Ability,
    failures: &'b Failures,
    moment: &'b Moment<'b>,
    now_s: f64,
    at: Point,
    tour: Tour,
    reach: Reach<'b>,
    /// Time for all goals that it serves.
    busy_s: f64,
    is_full: bool,
}

/// A bid without its number.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Estimate {
    pub(crate) offer: Offer,
    time_s: f64,
    total_s: f64,
    energy: f64,
    pub(crate) confidence: f64,
}

impl<'b> Bidder<'b> {
    /// `None` for a robot that does not know its position.
    pub(crate) fn new(
        ability: &'b Ability,
        (jobs, failures): (&Jobs, &'b Failures),
        moment: &'b Moment<'b>,
        now_s: f64,
    ) -> Option<Self> {
        let at = moment.at?;
        let tour = jobs.tour(at);
        let work_s = jobs.list.iter().map(|job| ability.work_s(&job.task));
        Some(Self {
            busy_s: work_s.sum::<f64>() + ability.travel_s(tour.length_m),
            is_full: jobs.list.len() >= ability.max_goals,
            ability,
            failures,
            moment,
            now_s,
            at,
            tour,
            reach: Reach::new(moment, at),
        })
    }

    /// The bid for an offer, or why there is none.
    pub(crate) fn estimate(&self, offer: &Offer) -> Result<Estimate, Reason> {
        let (task, ability) = (&offer.task, self.ability);
        if let Some(reason) = ability.lacks(task, self.moment.percept.charges) {
            return Err(reason);
        }
        if let Some(reason) = self.failures.reason_of_rest(task.id, self.now_s) {
            return Err(reason);
        }
        let detour = self.detour(task).ok_or(Reason::Unreachable)?;
        let work_s = ability.work_s(task);
        let time_s = ability.travel_s(detour * self.tour.increment_m(task.at())) + work_s;
        let all_s = self.busy_s + time_s;
        if self.moment.battery_s < all_s {
            return Err(Reason::Battery);
        }
        if self.now_s + self.arrival_s(offer, detour) + work_s > offer.due_at_s {
            return Err(Reason::Deadline);
        }
        // Last: a robot that is full could serve the goal instead of another.
        if self.is_full {
            return Err(Reason::Full);
        }
        let reachable = reachable_probability(all_s, self.moment.battery_s);
        Ok(Estimate {
            offer: *offer,
            time_s,
            total_s: all_s,
            energy: self.energy(time_s),
            confidence: reachable * self.failures.confidence(task.id),
        })
    }

    /// Time until the robot would be there, at the latest.
    fn arrival_s(&self, offer: &Offer, detour: f64) -> f64 {
        let at = offer.task.at();
        let others_s = self.busy_s - self.ability.travel_s(self.tour.length_m);
        self.ability.travel_s(detour * self.tour.arrival_m(at)) + others_s
    }

    /// The detour to a goal; `None` if the robot cannot reach it.
    fn detour(&self, task: &Task) -> Option<f64> {
        if self.ability.is_stationary() {
            self.ability.covers(task, self.at).then_some(1.0)
        } else {
            self.reach.detour(task.at())
        }
    }

    /// The part of the battery's capacity for a time; 0 if unknown.
    fn energy(&self, time_s: f64) -> f64 {
        let charge = self.moment.charge.unwrap_or(0.0);
        (charge * time_s / self.moment.battery_s).min(1.0)
    }
}

impl Estimate {
    /// Time divided by confidence and value: the less, the better.
    pub(crate) fn cost_s(&self) -> f64 {
        let value = f64::from(self.offer.task.value).max(1e-6);
        self.time_s / (self.confidence * value)
    }

    #[expect(clippy::cast_possible_truncation, reason = "messages are short")]
    pub(crate) fn bid(&self, number: u32) -> Bid {
        Bid {
            goal: self.offer.task.id,
            number,
            time_s: self.time_s as f32,
            total_s: self.total_s as f32,
            energy: self.energy as f32,
            call: self.offer.call,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::agent_id::AgentId;
    use crate::io::body::Body;
    use crate::io::goal_id::{GoalId, Issuer};
    use crate::io::percept::Percept;
    use crate::io::work::Work;
    use crate::perception::beliefs::Map;
    use crate::perception::beliefs::coverage_map::tests::map;
    use crate::perception::beliefs::occupancy::Ray;
    use base::geometry::Segment;

    const TASK: Task = Task {
        id: GoalId {
            issuer: Issuer::Agent(AgentId::OPERATOR),
            number: 0,
        },
        at_m: [12.0, 2.0],
        radius_m: 0.5,
        value: 1.0,
        service_s: 0.0,
        due_s: f32::MAX,
        work: Work::Visit,
        capability: 0,
    };

    /// A map with a wall along x = 10 m, seen from the left.
    fn with_wall(mut map: Map) -> Map {
        for y in (0..=320).map(|step| 0.05 * f64::from(step)) {
            let (from, to) = (Point { x: 9.0, y }, Point { x: 10.0, y });
            let free = Segment { from, to };
            let hit = Some(to);
            (0..5).for_each(|_| map.occupancy.add_ray(&map.field, &Ray { free, hit }));
        }
        map
    }

    fn bid(at: Point, map: Option<&Map>, speed_m_s: f64, task: Task) -> Result<f32, Reason> {
        let ability = Ability {
            speed_m_s,
            max_goals: 4,
            all_round_m: 3.0,
            ..Ability::default()
        };
        let (percept, body) = (Percept::default(), Body::default());
        let moment = Moment {
            percept: &percept,
            body: &body,
            beliefs: None,
            map,
            at: Some(at),
            deviation_m: 0.0,
            elapsed_s: 0.1,
            battery_s: f64::INFINITY,
            charge: None,
        };
        let known = (&Jobs::default(), &Failures::default());
        let bidder = Bidder::new(&ability, known, &moment, 0.0).unwrap();
        let offer = Offer::new(task, AgentId::default(), 0, 0.0);
        bidder
            .estimate(&offer)
            .map(|estimate| estimate.bid(1).time_s)
    }

    #[test]
    fn a_robot_behind_a_known_wall_bids_the_time_of_the_detour() {
        let (behind, beyond) = (Point { x: 8.0, y: 2.0 }, Point { x: 12.0, y: 12.0 });
        let time_s = |at: Point, map: &Map| bid(at, Some(map), 1.0, TASK).unwrap();
        let (open, wall) = (map(), with_wall(map()));
        assert!((time_s(behind, &open) - 4.0).abs() < 1e-6);
        assert!(time_s(behind, &open) < time_s(beyond, &open));
        assert!(time_s(behind, &wall) > 28.0 && time_s(behind, &wall) < 34.0);
        assert!(time_s(beyond, &wall) < time_s(behind, &wall));
        assert!((time_s(beyond, &wall) - 10.0).abs() < 0.2);
    }

    #[test]
    fn a_stationary_robot_bids_only_for_goals_at_which_it_stands_and_areas_that_it_sees_whole() {
        let at = |x: f64| bid(Point { x, y: 2.0 }, None, 0.0, TASK);
        assert_eq!(at(11.6), Ok(0.0));
        assert_eq!(at(11.4), Err(Reason::Unreachable));
        let area = |radius_m: f32| {
            let work = Work::Search;
            let area = Task {
                radius_m,
                work,
                ..TASK
            };
            bid(Point { x: 11.0, y: 2.0 }, None, 0.0, area)
        };
        assert_eq!(area(2.0), Ok(0.0));
        assert_eq!(area(2.1), Err(Reason::Unreachable));
    }
}
