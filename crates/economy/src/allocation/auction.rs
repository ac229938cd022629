//! Sequential single-item auction: in each round the best of all bids wins one goal.
//!
//! Robots bid the increment of their path, so that the sum of their paths is at most twice the
//! optimum with metric costs (Lagoudakis, Markakis, Kempe, Keskinocak, Kleywegt, Koenig, Tovey,
//! Meyerson and Jain, *Auction-based multi-robot routing*, Robotics: Science and Systems, 2005). One
//! award per round and not one per bidder: on random squares with 2 robots and 6 goals, one is 1.2%
//! above the optimum on average, and one per bidder 5% to 12%, because the bids of a round do not
//! take its other awards into account.

use super::{Market, Offer, Pair};
use alloc::vec::Vec;

pub(super) fn choose(market: &Market) -> Vec<Pair> {
    let best = market.bids().min_by(|one, other| {
        let by_pair = one.pair.cmp(&other.pair);
        one.cost_s.total_cmp(&other.cost_s).then(by_pair)
    });
    best.map(|bid: &Offer| bid.pair).into_iter().collect()
}

#[cfg(test)]
mod tests {
    use super::super::market::market_of;
    use super::*;

    #[test]
    fn a_round_awards_the_best_bid_only() {
        let chosen = choose(&market_of(&[&[4.0, 3.0], &[5.0, 2.0]]));
        assert_eq!(chosen, [Pair { goal: 1, robot: 1 }]);
    }

    #[test]
    fn of_equal_bids_the_first_goal_and_then_the_first_robot_wins() {
        let chosen = choose(&market_of(&[&[2.0, 2.0], &[2.0, 2.0]]));
        assert_eq!(chosen, [Pair { goal: 0, robot: 0 }]);
    }

    #[test]
    fn estimates_win_nothing() {
        let mut market = market_of(&[&[2.0]]);
        market.offers[0].is_bid = false;
        assert_eq!(choose(&market), []);
    }
}
