//! The quality of auctions, by the sum of the open paths of all robots.

use crate::network::{Weather, random, unit};
use crate::team::{STEP_S, Team, brain};
use base::geometry::Point;
use economy::{Allocation, Market, Offer, Pair, Settings, assignment};
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
                    total_s: cost_s,
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

/// The starts of robots, and the places that a controller has awarded to each when all goals are, or when each robot has
/// one; `delay_s` is how long messages take.
struct Awarded {
    starts: Vec<Point>,
    won: Vec<Vec<Point>>,
    issued: Vec<Point>,
}

impl Awarded {
    fn new(
        allocation: Allocation,
        [robots, goals, of_each]: [u32; 3],
        delay_s: f64,
        seed: u64,
    ) -> Self {
        let settings = Settings {
            allocation,
            answer_s: 2.0 * (delay_s + STEP_S),
            service_lease_s: 120.0,
            ..Settings::default()
        };
        let weather = Weather {
            min_delay_s: delay_s,
            ..Weather::default()
        };
        let mut team = Team::new([robots, 1], &settings, weather, seed);
        // So slow that they bid from where they start.
        let slow = brain(
            &[],
            &format!(r#", "speed_m_s": 0.001, "max_goals": {of_each}"#),
        );
        for robot in &mut team.robots {
            robot.brain = Some(slow.clone());
        }
        let starts = team.robots.iter().map(|robot| robot.at).collect();
        team.issue_random(goals, 100.0);
        let issued = team.issued_places();
        let all = goals.min(robots * of_each) as usize;
        let mut won = Vec::new();
        while won.iter().map(Vec::len).sum::<usize>() < all {
            assert!(team.now_s < 60.0, "seed {seed}: {won:?}");
            team.step();
            won = team.served_places();
        }
        Self {
            starts,
            won,
            issued,
        }
    }

    /// The sum of the paths over the optimum.
    fn ratio(&self) -> f64 {
        let paths_m = self.starts.iter().zip(&self.won);
        let sum_m: f64 = paths_m.map(|(at, own)| path_m(*at, own)).sum();
        sum_m / optimum_m(&self.starts, &self.issued)
    }
}

fn mean(ratios: impl Iterator<Item = f64>) -> f64 {
    let ratios: Vec<f64> = ratios.collect();
    ratios.iter().sum::<f64>() / f64::from(u32::try_from(ratios.len()).unwrap())
}

#[test]
fn awards_are_as_good_as_the_auction_however_slow_the_radio_is() {
    // The standard error of the mean of 60 ratios is 0.5%.
    for delay_s in [0.0, 0.3, 1.0] {
        let awarded = |seed| Awarded::new(Allocation::Auction, [2, 6, 6], delay_s, seed);
        let mean = mean((0..60).map(|seed| awarded(seed).ratio()));
        assert!(mean < 1.02, "{delay_s} s: {mean}");
    }
    let awarded = |seed| Awarded::new(Allocation::Auction, [4, 8, 8], 0.3, seed);
    let mean = mean((0..12).map(|seed| awarded(seed).ratio()));
    assert!(mean < 1.04, "{mean}");
}

#[test]
fn the_optimal_rule_awards_the_optimal_assignment_of_all_goals() {
    let ratio = |seed| {
        let Awarded {
            starts,
            won,
            issued,
        } = Awarded::new(Allocation::Optimal, [20, 40, 1], 0.1, seed);
        let costs_m = starts
            .iter()
            .flat_map(|at| issued.iter().map(|goal| at.to(*goal).length()));
        let costs_m: Vec<f64> = costs_m.collect();
        let assigned = assignment([starts.len(), issued.len()], &costs_m);
        let optimum_m = assigned.iter().enumerate();
        let optimum_m =
            optimum_m.map(|(robot, goal)| costs_m[robot * issued.len() + goal.unwrap()]);
        let sum_m = starts.iter().zip(&won).map(|(at, own)| path_m(*at, own));
        sum_m.sum::<f64>() / optimum_m.sum::<f64>()
    };
    let mean = mean((0..6).map(ratio));
    assert!(mean < 1.02, "{mean}");
}

#[test]
fn an_auction_for_the_last_robot_spreads_the_goals() {
    let longest_m = |allocation, seed| {
        let Awarded { starts, won, .. } = Awarded::new(allocation, [2, 6, 6], 0.1, seed);
        let paths_m = starts.iter().zip(&won);
        paths_m
            .map(|(at, own)| path_m(*at, own))
            .fold(0.0, f64::max)
    };
    let ratio =
        |seed| longest_m(Allocation::AuctionLast, seed) / longest_m(Allocation::Auction, seed);
    let mean = mean((0..60).map(ratio));
    assert!(mean < 0.95, "{mean}");
}
