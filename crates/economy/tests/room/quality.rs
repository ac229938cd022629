//! The quality of auctions, by the sum of the open paths of all robots.

use crate::network::{random, unit};
use base::geometry::Point;
use economy::{Allocation, Market, Offer, Pair};
use proptest::prelude::*;

/// The length of the shortest path from a start through places.
fn path_m(at: Point, left: &[Point]) -> f64 {
    let lengths_m = (0..left.len()).map(|next| {
        let mut rest = left.to_vec();
        let place = rest.remove(next);
        at.to(place).length() + path_m(place, &rest)
    });
    lengths_m.reduce(f64::min).unwrap_or(0.0)
}

/// The sum of the paths after an auction in which robots bid exact increments.
fn auctioned_m(robots: &[Point], goals: &[Point]) -> f64 {
    let mut left: Vec<Point> = goals.to_vec();
    let mut won: Vec<Vec<Point>> = vec![Vec::new(); robots.len()];
    let sum_m = |won: &[Vec<Point>]| {
        let paths_m = robots.iter().zip(won).map(|(at, own)| path_m(*at, own));
        paths_m.sum::<f64>()
    };
    while !left.is_empty() {
        let before_m = sum_m(&won);
        let mut offers = Vec::new();
        for (goal, place) in left.iter().enumerate() {
            for robot in 0..robots.len() {
                let mut with = won.clone();
                with[robot].push(*place);
                let cost_s = sum_m(&with) - before_m;
                offers.push(Offer {
                    pair: Pair { goal, robot },
                    cost_s,
                    distance_m: cost_s,
                    is_bid: true,
                });
            }
        }
        let market = Market {
            goals: left.len(),
            is_idle: vec![true; robots.len()],
            offers,
        };
        let Pair { goal, robot } = Allocation::Auction.choose(&market)[0];
        won[robot].push(left.remove(goal));
    }
    sum_m(&won)
}

/// The smallest sum of paths of all assignments.
fn optimum_m(robots: &[Point], goals: &[Point]) -> f64 {
    let count = robots.len().pow(u32::try_from(goals.len()).unwrap());
    let sums_m = (0..count).map(|mut code| {
        let mut won: Vec<Vec<Point>> = vec![Vec::new(); robots.len()];
        for goal in goals {
            won[code % robots.len()].push(*goal);
            code /= robots.len();
        }
        let paths_m = robots.iter().zip(&won).map(|(at, own)| path_m(*at, own));
        paths_m.sum::<f64>()
    });
    sums_m.reduce(f64::min).unwrap()
}

fn places(count: impl Into<proptest::collection::SizeRange>) -> impl Strategy<Value = Vec<Point>> {
    let place = [0.0..100.0, 0.0..100.0].prop_map(Point::from);
    proptest::collection::vec(place, count)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, ..ProptestConfig::default() })]

    #[test]
    fn the_auctions_sum_of_paths_is_at_most_twice_the_optimum(
        robots in places(1..4),
        goals in places(1..6),
    ) {
        prop_assert!(auctioned_m(&robots, &goals) <= 2.0 * optimum_m(&robots, &goals) + 1e-6);
    }
}

#[test]
fn the_auction_is_on_average_within_two_percent_of_the_optimum() {
    let mut random = random(11);
    let mut place = || Point {
        x: unit(&mut random),
        y: unit(&mut random),
    };
    let ratios = (0..150).map(|_| {
        let robots = [place(), place()];
        let goals = [(); 6].map(|()| place());
        auctioned_m(&robots, &goals) / optimum_m(&robots, &goals)
    });
    // The standard error of the mean of 150 ratios is 0.3%.
    let mean = ratios.sum::<f64>() / 150.0;
    assert!(mean < 1.02, "{mean}");
}
