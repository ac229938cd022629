//! What a rule of allocation knows.

use alloc::vec::Vec;

/// The goals without an assignee, the robots in range, and the offers of robots for goals.
#[derive(Debug, Clone, Default)]
pub struct Market {
    /// Number of goals.
    pub goals: usize,
    /// For each robot, whether it serves no goal.
    pub is_idle: Vec<bool>,
    /// At most one per pair.
    pub offers: Vec<Offer>,
}

/// What it costs that a robot serves a goal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Offer {
    /// The goal and the robot.
    pub pair: Pair,
    /// Expected time divided by confidence and value.
    pub cost_s: f64,
    /// The same of the time until the robot has served all of its goals and this one.
    pub total_s: f64,
    /// Distance between them.
    pub distance_m: f64,
    /// Whether the robot has bid; otherwise, the controller estimates the cost from its position.
    pub is_bid: bool,
}

/// Indices of a goal and a robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Pair {
    /// Index of the goal.
    pub goal: usize,
    /// Index of the robot.
    pub robot: usize,
}

impl Market {
    /// The offers that are bids.
    pub fn bids(&self) -> impl Iterator<Item = &Offer> {
        self.offers.iter().filter(|offer| offer.is_bid)
    }
}

/// A market in which every robot is idle and bids these costs, by goals and robots.
#[cfg(test)]
pub(crate) fn market_of(costs_s: &[&[f64]]) -> Market {
    let rows = costs_s.iter().enumerate();
    let offers = rows.flat_map(|(goal, row)| {
        let each = row.iter().enumerate();
        each.map(move |(robot, cost_s)| Offer {
            pair: Pair { goal, robot },
            cost_s: *cost_s,
            total_s: *cost_s,
            distance_m: *cost_s,
            is_bid: true,
        })
    });
    Market {
        goals: costs_s.len(),
        is_idle: alloc::vec![true; costs_s.first().map_or(0, |row| row.len())],
        offers: offers.filter(|offer| offer.cost_s.is_finite()).collect(),
    }
}
