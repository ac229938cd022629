//! Each goal to the nearest robot that bids for it, whatever else that robot serves: the baseline of
//! a parallel auction, whose cost has no bound relative to the optimum.

use super::{Market, Offer, Pair};
use alloc::vec::Vec;

pub(super) fn choose(market: &Market) -> Vec<Pair> {
    let mut nearest: Vec<Option<Offer>> = alloc::vec![None; market.goals];
    for bid in market.bids() {
        let best = &mut nearest[bid.pair.goal];
        let key = |offer: &Offer| (offer.distance_m, offer.pair.robot);
        if best.is_none_or(|best| key(bid) < key(&best)) {
            *best = Some(*bid);
        }
    }
    nearest.into_iter().flatten().map(|bid| bid.pair).collect()
}

#[cfg(test)]
mod tests {
    use super::super::market::market_of;
    use super::*;

    #[test]
    fn every_goal_goes_to_the_nearest_bidder_even_if_one_robot_gets_all() {
        let chosen = choose(&market_of(&[
            &[1.0, 2.0],
            &[3.0, 4.0],
            &[f64::INFINITY, 9.0],
        ]));
        let robots: Vec<usize> = chosen.iter().map(|pair| pair.robot).collect();
        assert_eq!(robots, [0, 0, 1]);
    }

    #[test]
    fn of_two_robots_at_the_same_distance_the_first_gets_the_goal() {
        assert_eq!(
            choose(&market_of(&[&[2.0, 2.0]])),
            [Pair { goal: 0, robot: 0 }]
        );
    }
}
