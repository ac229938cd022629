//! Sequential single-item auction for the time of the last robot: robots bid the whole time of their paths.
//!
//! In each round, the bid with the smallest time until the robot has served all of its goals wins (the rule `MiniMax` of Lagoudakis
//! et al., *Auction-based multi-robot routing*, Robotics: Science and Systems, 2005). The work is spread over the robots,
//! for a longer sum of paths than with [`auction`](super::auction).

use super::{Market, Pair};
use alloc::vec::Vec;

pub(super) fn choose(market: &Market) -> Vec<Pair> {
    let best = market.bids().min_by(|one, other| {
        let by_total = one.total_s.total_cmp(&other.total_s);
        let by_cost = one.cost_s.total_cmp(&other.cost_s);
        by_total.then(by_cost).then(one.pair.cmp(&other.pair))
    });
    best.map(|bid| bid.pair).into_iter().collect()
}

#[cfg(test)]
mod tests {
    use super::super::market::market_of;
    use super::*;

    #[test]
    fn the_robot_that_has_served_all_of_its_goals_first_wins() {
        let mut market = market_of(&[&[1.0, 3.0]]);
        market.offers[0].total_s = 9.0;
        assert_eq!(choose(&market), [Pair { goal: 0, robot: 1 }]);
    }
}
