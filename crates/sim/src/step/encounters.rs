//! Encounters of robots in one step, resolved in the order of time.
//!
//! Two robots that meet are both stopped. Of two that already touch, only the one that would move
//! closer is stopped: no robot is held by another that presses against it.

use super::neighbours::Neighbours;
use super::plan::{Plan, Stop};
use crate::bodies::contact::{Encounter, meets_moving};
use crate::bodies::path::Path;
use crate::run::state::State;
use base::geometry::{Disc, Point};
use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

/// Pairs of robots that may meet, and when; kept between steps so that nothing is allocated.
#[derive(Debug, Clone, Default)]
pub(crate) struct Encounters {
    /// Ascending; the robot with the lower number first.
    pairs: Vec<Pair>,
    queue: BinaryHeap<Reverse<Meeting>>,
}

#[derive(Debug, Clone, Copy)]
struct Pair {
    robots: [u32; 2],
    reach_m: f64,
    /// From the second to its image that is nearest to the first.
    shift: Point,
    /// Fraction of the step after which they meet, as far as is known; infinite if they do not.
    share: f64,
    /// Which of them approaches the other then.
    comes: [bool; 2],
    /// Fraction of the step from which they are still to be checked; infinite if both stand.
    since: f64,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Meeting {
    share: f64,
    pair: usize,
}

impl Eq for Meeting {}

impl Ord for Meeting {
    fn cmp(&self, other: &Self) -> Ordering {
        let by_pair = || self.pair.cmp(&other.pair);
        self.share.total_cmp(&other.share).then_with(by_pair)
    }
}

impl PartialOrd for Meeting {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Encounters {
    /// Finds the pairs that are near enough to meet.
    pub(crate) fn collect(
        &mut self,
        plans: &[Plan],
        discs: &[Disc],
        neighbours: &Neighbours,
        contact_m: f64,
    ) {
        self.pairs.clear();
        self.queue.clear();
        for pair in neighbours.pairs() {
            let [one, other] = pair.map(|robot| &discs[robot as usize]);
            let image = neighbours.image(one.centre, other.centre);
            let square = one.centre.to(image).length_squared();
            if square < contact_m * contact_m {
                self.add(plans, [one, other], image, *pair);
            }
        }
    }

    /// Adds a pair of which the second is seen at its `image`.
    fn add(&mut self, plans: &[Plan], [one, other]: [&Disc; 2], image: Point, robots: [u32; 2]) {
        let reach_m = one.radius_m + other.radius_m;
        let goes_m = |robot: u32| plans[robot as usize].path.length_m.abs();
        let length_m = goes_m(robots[0]) + goes_m(robots[1]);
        let gap_m = one.centre.to(image).length() - reach_m;
        // Points touch nothing that moves.
        if gap_m <= length_m && length_m > 0.0 && reach_m > 0.0 {
            self.pairs.push(Pair {
                robots,
                reach_m,
                shift: other.centre.to(image),
                share: f64::INFINITY,
                comes: [false; 2],
                since: 0.0,
            });
        }
    }

    /// Stops robots where they meet; returns the number of new contacts.
    pub(crate) fn resolve(
        &mut self,
        plans: &mut [Plan],
        state: &State,
        neighbours: &Neighbours,
    ) -> u64 {
        let mut collisions = 0;
        for pair in 0..self.pairs.len() {
            self.predict(plans, pair);
        }
        while let Some(Reverse(Meeting { share, pair })) = self.queue.pop() {
            // A prediction from before one of them was stopped is void.
            if self.pairs[pair].share.to_bits() != share.to_bits() {
                continue;
            }
            let Pair { robots, comes, .. } = self.pairs[pair];
            let is_old = robots
                .iter()
                .all(|robot| state.body_states[*robot as usize].is_touching);
            collisions += u64::from(!is_old);
            self.pairs[pair].since = f64::INFINITY;
            for (robot, comes) in robots.into_iter().zip(comes) {
                if comes || !is_old {
                    self.stop(plans, neighbours, robot, share);
                } else {
                    let stop = &mut plans[robot as usize].stop;
                    *stop = (*stop).max(Stop::Pressed);
                }
            }
            if is_old && comes != [true; 2] {
                self.pairs[pair].since = share;
                self.predict(plans, pair);
            }
        }
        collisions
    }

    fn stop(&mut self, plans: &mut [Plan], neighbours: &Neighbours, robot: u32, share: f64) {
        let plan = &mut plans[robot as usize];
        if plan.path.until <= share {
            // It may have been stopped by a wall, which counts for itself.
            plan.stop = plan.stop.max(Stop::Robot);
            return;
        }
        plan.stop = Stop::Robot;
        plan.path.until = share;
        for other in neighbours.of(robot as usize).robots {
            let robots = [robot.min(*other), robot.max(*other)];
            if let Ok(pair) = self.pairs.binary_search_by_key(&robots, |pair| pair.robots) {
                self.predict(plans, pair);
            }
        }
    }

    /// Predicts when a pair will meet.
    fn predict(&mut self, plans: &[Plan], number: usize) {
        let pair = &mut self.pairs[number];
        pair.share = f64::INFINITY;
        if pair.since == f64::INFINITY {
            return;
        }
        let [one, other] = pair.robots.map(|robot| &plans[robot as usize].path);
        let other = Path {
            start: other.start.plus(pair.shift),
            ..*other
        };
        let encounter = meets_moving([one, &other], pair.reach_m, pair.since);
        if let Some(Encounter { share, comes }) = encounter {
            (pair.share, pair.comes) = (share, comes);
            self.queue.push(Reverse(Meeting {
                share,
                pair: number,
            }));
        }
    }
}
