//! The speed limit of a robot that must be able to stop within what it knows to be free.
//!
//! At speed `v` the robot moves on for one period before its next step, and then needs `v^2 / (2
//! a)` to stop; if its current speed is `u > v`, slowing down takes `(u - v)^2 / (2 a)` more. All
//! this must fit into the distance that was free when the scan was measured, less what the robot
//! may have moved since. On a curve it must fit into the whole area that the curve can sweep;
//! otherwise the robot stops before it turns. `a` is slightly less than the robot's deceleration,
//! since sensors err.
//!
//! Invariant: after each step, the robot can still stop in time. A step within the limit keeps it
//! true. If no speed is within the limit, the robot brakes as hard as it can, which keeps it true
//! as well.

use crate::io::body::Body;
use crate::io::command::Motion;
use crate::io::percept::Percept;
use crate::perception::corners::Width;
use crate::perception::dead_reckoning::DeadReckoning;
use crate::perception::rays::{Free, Ring};
use crate::perception::sector::Sector;
use crate::perception::turns::Headings;
use crate::situation::{ClearAhead, Situation};
use alloc::vec::Vec;
use core::f64::consts::{FRAC_PI_2, PI};

/// Clearance around the robot, as a fraction of its radius.
const CLEARANCE: f64 = 0.05;

/// Fraction of the maximum deceleration that is relied on: a robot whose ranges are 10% too long
/// still stops in time.
pub(super) const BRAKING: f64 = 0.9;

/// The distance in which a robot is relied on to stop from a speed, in metres; `deceleration_m_s2` is its
/// maximum.
#[must_use]
pub fn stopping_m(speed_m_s: f64, deceleration_m_s2: f64) -> f64 {
    speed_m_s * speed_m_s * stopping_s2_m(deceleration_m_s2)
}

/// 1 / (2 a).
fn stopping_s2_m(deceleration_m_s2: f64) -> f64 {
    0.5 / (BRAKING * deceleration_m_s2)
}

/// The range rings of a kind of robot, and its speed limit.
#[derive(Debug, Clone)]
pub(crate) struct SpeedGovernor {
    pub(crate) rings: Vec<Ring>,
    half_width_m: f64,
    covers_front: bool,
    covers_back: bool,
    /// 1 / (2 a).
    stopping_s2_m: f64,
}

impl SpeedGovernor {
    pub(crate) fn new(body: &Body) -> Self {
        let half_width_m = body.radius_m * (1.0 + CLEARANCE);
        let width = Width {
            half_width_m,
            clearance_m: half_width_m - body.radius_m,
        };
        let ring = |ring| Ring::new(ring, width, body.period_s);
        let rings: Vec<Ring> = body.rings.iter().map(ring).collect();
        Self {
            half_width_m,
            covers_front: rings.iter().any(|ring| ring.covers_front),
            covers_back: rings.iter().any(|ring| ring.covers_back),
            rings,
            stopping_s2_m: stopping_s2_m(body.max_acceleration_m_s2),
        }
    }

    /// The free distance straight ahead, by fresh scans.
    #[inline]
    pub(crate) fn ahead(
        &self,
        percept: &Percept,
        body: &Body,
        current_speed_m_s: f64,
    ) -> Option<ClearAhead> {
        let free = |ring: &Ring, age_s, ranges_m: &[f64]| {
            let is_fresh = ring.is_fresh(age_s);
            is_fresh.then(|| ring.free_ahead(ranges_m))
        };
        self.clear(percept, body, (1.0, current_speed_m_s.max(0.0)), free)
    }

    /// The proposed motion, slowed down to the limit. A motion in a direction that no range sensor
    /// covers is not limited.
    #[inline]
    pub(crate) fn limit(
        &self,
        setpoint: Motion,
        situation: &Situation,
        odometry: &DeadReckoning,
    ) -> Motion {
        let Situation {
            body,
            current_speed_m_s,
            ..
        } = *situation;
        let is_reverse =
            current_speed_m_s < 0.0 || (current_speed_m_s == 0.0 && setpoint.speed_m_s < 0.0);
        let (sign, is_covered) = if is_reverse {
            (-1.0, self.covers_back)
        } else {
            (1.0, self.covers_front)
        };
        let current_speed_m_s = current_speed_m_s.abs();
        let setpoint_m_s = (setpoint.speed_m_s * sign).max(0.0);
        if !is_covered || (current_speed_m_s == 0.0 && setpoint_m_s == 0.0) {
            return setpoint;
        }
        let clear = self.clear_along(setpoint, sign, situation, odometry);
        let free_m = clear.map_or(0.0, |clear| clear.certain_m);
        // A turn towards where the robot could not stop is postponed until it is stationary.
        let can_turn = current_speed_m_s * current_speed_m_s * self.stopping_s2_m <= free_m;
        Motion {
            speed_m_s: sign
                * self.speed_m_s(setpoint_m_s, current_speed_m_s, free_m, body.period_s),
            turn_rate_rad_s: if can_turn {
                setpoint.turn_rate_rad_s
            } else {
                0.0
            },
        }
    }

    /// The free distance in the direction of a motion; possibly less, but enough for it, if that is
    /// faster to compute.
    #[inline]
    fn clear_along(
        &self,
        setpoint: Motion,
        sign: f64,
        situation: &Situation,
        odometry: &DeadReckoning,
    ) -> Option<ClearAhead> {
        let Situation {
            percept,
            body,
            ahead,
            current_speed_m_s,
            ..
        } = *situation;
        let is_straight = setpoint.turn_rate_rad_s == 0.0
            && sign > 0.0
            && ahead.is_some_and(|clear| {
                odometry.headings_within(clear.age_s, body) == Headings::default()
            });
        if is_straight {
            return ahead;
        }
        let current_speed_m_s = current_speed_m_s.abs();
        let setpoint_m_s = (setpoint.speed_m_s * sign).max(0.0);
        let turning_s =
            body.period_s + 2.0 * self.stopping_s2_m * current_speed_m_s.max(setpoint_m_s);
        let stopping_m = current_speed_m_s * current_speed_m_s * self.stopping_s2_m;
        let needed_m =
            stopping_m.max(self.needed_m(setpoint_m_s, current_speed_m_s, body.period_s));
        self.clear(
            percept,
            body,
            (sign, current_speed_m_s),
            |ring, age_s, ranges_m| {
                let headings = odometry.headings_within(age_s, body);
                // After a larger turn, the scan does not show where the robot moves.
                if headings.max_rad - headings.min_rad > FRAC_PI_2 {
                    return None;
                }
                // The nearest distance in any direction is cheap to compute, and mostly large enough.
                let nearest_m = ring.nearest_m(ranges_m);
                let enough_m =
                    needed_m + self.half_width_m + max_moved_m(body, current_speed_m_s, age_s);
                let turn_rad = setpoint.turn_rate_rad_s * turning_s;
                let certain_m = if nearest_m > enough_m {
                    nearest_m
                } else {
                    ring.free_m(ranges_m, &self.sector(&headings, turn_rad, sign))
                };
                Some(Free::certain(certain_m))
            },
        )
    }

    /// The minimum free distances over all rings with a complete scan, forwards or backwards; `free`
    /// returns those of one ring from the robot's centre, if they are known.
    ///
    /// A ring that does not cover the direction may still detect an obstacle beside the robot, but
    /// proves nothing when it detects none.
    #[inline]
    fn clear(
        &self,
        percept: &Percept,
        body: &Body,
        (sign, speed_m_s): (f64, f64),
        free: impl Fn(&Ring, f64, &[f64]) -> Option<Free>,
    ) -> Option<ClearAhead> {
        let mut nearest: Option<ClearAhead> = None;
        let mut is_covered = false;
        for (index, ring) in self.rings.iter().enumerate() {
            let scan = ring.complete(percept.scans.get(index));
            let Some((age_s, ranges_m)) = scan else {
                continue;
            };
            let covers = if sign > 0.0 {
                ring.covers_front
            } else {
                ring.covers_back
            };
            let free = free(ring, age_s, ranges_m);
            let Some(free) = free.filter(|free| covers || free.certain_m < ring.range_m()) else {
                continue;
            };
            is_covered |= covers;
            let used_m = self.half_width_m + max_moved_m(body, speed_m_s, age_s);
            let clear = ClearAhead {
                free_m: free.flat_m - used_m,
                certain_m: free.certain_m - used_m,
                age_s,
            };
            nearest = Some(nearest.map_or(clear, |so_far| so_far.and(clear)));
        }
        nearest.filter(|_| is_covered)
    }

    /// The area that the robot can sweep from the heading of the scan to the one where it will
    /// stand, turning all the time.
    fn sector(&self, headings: &Headings, turn_rad: f64, sign: f64) -> Sector {
        let [low_rad, high_rad] = headings.now_rad;
        let min = headings.min_rad.min(low_rad + turn_rad.min(0.0));
        let max = headings.max_rad.max(high_rad + turn_rad.max(0.0));
        // Within half a turn the robot has either stopped or started to come back.
        let over = (max - min - PI).max(0.0);
        let (min, max) = if turn_rad > 0.0 {
            (min, max - over)
        } else {
            (min + over, max)
        };
        let back_rad = if sign < 0.0 { PI } else { 0.0 };
        Sector::new(back_rad + min, back_rad + max, self.half_width_m)
    }

    /// The maximum speed, up to `setpoint_m_s`, from which the robot stops within `free_m` if its
    /// current speed is `current_speed_m_s`.
    #[inline]
    fn speed_m_s(
        &self,
        setpoint_m_s: f64,
        current_speed_m_s: f64,
        free_m: f64,
        period_s: f64,
    ) -> f64 {
        if self.needed_m(setpoint_m_s, current_speed_m_s, period_s) <= free_m {
            return setpoint_m_s;
        }
        self.max_m_s(current_speed_m_s, free_m, period_s)
            .min(setpoint_m_s)
    }

    /// The distance that the robot moves if it changes to a speed, keeps it for a period and
    /// brakes.
    #[inline]
    fn needed_m(&self, setpoint_m_s: f64, current_speed_m_s: f64, period_s: f64) -> f64 {
        let slowing_m_s = (current_speed_m_s - setpoint_m_s).max(0.0);
        let squares = setpoint_m_s * setpoint_m_s + slowing_m_s * slowing_m_s;
        setpoint_m_s * period_s + squares * self.stopping_s2_m
    }

    /// The `v` with `v period + (v^2 + max(0, now - v)^2) / (2 a) = free`, or 0.
    fn max_m_s(&self, current_speed_m_s: f64, free_m: f64, period_s: f64) -> f64 {
        if free_m <= 0.0 {
            return 0.0;
        }
        let s = self.stopping_s2_m;
        let faster = positive_root(s, period_s, free_m);
        if faster >= current_speed_m_s {
            return faster;
        }
        let left_m = free_m - current_speed_m_s * current_speed_m_s * s;
        if left_m <= 0.0 {
            return 0.0;
        }
        positive_root(2.0 * s, period_s - 2.0 * s * current_speed_m_s, left_m).min(faster)
    }
}

/// The `x >= 0` with `a x^2 + b x = c`, where `a >= 0` and `c > 0`; also for an `a` of 0.
fn positive_root(a: f64, b: f64, c: f64) -> f64 {
    2.0 * c / (b + libm::sqrt(b * b + 4.0 * a * c))
}

/// The maximum distance that the robot moved within the last `age_s`, given its current speed: it
/// was faster before by what it can brake, but never faster than its maximum speed.
#[inline]
fn max_moved_m(body: &Body, speed_m_s: f64, age_s: f64) -> f64 {
    let braking_m_s = body.max_acceleration_m_s2 * age_s / 2.0;
    (speed_m_s + braking_m_s).min(body.max_speed_m_s) * age_s
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "exact by construction")]
mod tests {
    use crate::behaviours::{BehaviourSpec, Cruise};
    use crate::world_of_walls::{Walk, Wiring, outline, ring, room, rover, square};
    use crate::{Body, Brain, BrainSpec, Command, Motion, Percept, Scan};
    use base::geometry::{Point, Segment};
    use core::cell::Cell;
    use proptest::prelude::*;
    use std::sync::Arc;

    fn cruising() -> BrainSpec {
        BrainSpec {
            behaviours: vec![BehaviourSpec::Cruise(Cruise::default())],
            ..BrainSpec::default()
        }
    }

    fn cruiser(body: &Body) -> Brain {
        Brain::new(Arc::new(cruising()), Arc::new(body.clone()))
    }

    fn speed_m_s(body: &Body, percept: &Percept) -> f64 {
        cruiser(body).step(percept).motion.speed_m_s
    }

    fn scan(age_s: f64, ranges_m: Vec<f64>) -> Percept {
        let age_s = Some(age_s);
        Percept {
            scans: vec![Scan { age_s, ranges_m }],
            ..Percept::default()
        }
    }

    /// Slow and fast, with weak and instant brakes, short and long sensor range.
    fn body() -> impl Strategy<Value = Body> {
        let steps = (0.01_f64..0.5, 0.05_f64..20.0);
        let brakes = prop_oneof![0.1_f64..30.0, Just(f64::INFINITY)];
        (steps, brakes, 0.05_f64..0.5, 8_usize..48, 0.6_f64..12.0).prop_map(
            |((period_s, max_speed_m_s), max_acceleration_m_s2, radius_m, rays, range_m)| Body {
                radius_m,
                max_speed_m_s,
                max_acceleration_m_s2,
                max_turn_rate_rad_s: 3.0,
                period_s,
                rings: vec![ring(rays, range_m)],
                ..Body::default()
            },
        )
    }

    fn wiring() -> impl Strategy<Value = Wiring> {
        let lost_share = prop_oneof![Just(0.0), 0.0..0.95];
        (0_usize..5, 0_usize..5, lost_share).prop_map(|(scans_apart, latency, lost_share)| Wiring {
            scans_apart,
            latency,
            lost_share,
            ..Wiring::default()
        })
    }

    fn wired(mut body: Body, wiring: Wiring) -> Body {
        let steps = |count: usize| f64::from(u32::try_from(count).unwrap()) * body.period_s;
        let (period_s, latency_s) = (steps(wiring.scans_apart + 1), steps(wiring.latency));
        for ring in &mut body.rings {
            (ring.period_s, ring.latency_s) = (period_s, latency_s);
        }
        body
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(400))]

        #[test]
        fn a_robot_within_the_speed_limit_never_hits_a_wall(
            body in body(), wiring in wiring(), course in -3.1_f64..3.1, x in 0.6_f64..19.4,
        ) {
            let body = wired(body, wiring);
            let mut walk = Walk::new(body.clone(), room(20.0, 9.0), [x, 4.0], course);
            walk.wiring = wiring;
            walk.run(&mut cruiser(&body), 600);
            prop_assert!(walk.min_gap_m > 0.0, "{} m", walk.min_gap_m);
        }

        #[test]
        fn a_robot_never_hits_a_corner_between_two_rays(
            corners in proptest::collection::vec((2.0..18.0_f64, 1.0..8.0_f64, 0.0..1.6_f64), 12),
            rays in 132_usize..240, speed_m_s in 1.0..2.0_f64, wiring in wiring(), course in -3.1_f64..3.1,
        ) {
            let body = Body { max_speed_m_s: speed_m_s, rings: vec![ring(rays, 8.0)], ..rover() };
            let body = wired(body, wiring);
            let mut walls = room(20.0, 9.0);
            for (x, y, angle_rad) in corners {
                walls.extend(square(Point { x, y }, angle_rad, 0.5));
            }
            let mut walk = Walk::new(body.clone(), walls, [1.0, 4.5], course);
            walk.wiring = wiring;
            prop_assume!(walk.gap_m(walk.at) > 0.0);
            walk.run(&mut cruiser(&body), 300);
            prop_assert!(walk.min_gap_m > 0.0, "{} m", walk.min_gap_m);
        }

        #[test]
        fn a_robot_on_changing_curves_never_hits_a_wall(
            body in body(), wiring in wiring(), course in -3.1_f64..3.1,
            rates in proptest::collection::vec((prop_oneof![-3.0_f64..3.0, Just(0.0)], 1_usize..40), 1..60),
        ) {
            let body = wired(body, wiring);
            let governor = super::SpeedGovernor::new(&body);
            let mut odometry = super::DeadReckoning::default();
            let mut walk = Walk::new(body.clone(), room(20.0, 9.0), [7.0, 4.0], course);
            walk.wiring = wiring;
            let rates = rates.iter().flat_map(|(rate, steps)| std::iter::repeat_n(*rate, *steps));
            for rate in rates.cycle().take(300) {
                let percept = walk.percept();
                let current_speed_m_s = odometry.reckon(&percept, &body, body.period_s).speed_m_s;
                let situation = super::Situation {
                    beliefs: None,
                    localisation: None,
                    peers: None,
                    percept: &percept,
                    body: &body,
                    rings: &governor.rings,
                    last_goal: &Cell::new(0),
                    ahead: governor.ahead(&percept, &body, current_speed_m_s),
                    elapsed_s: body.period_s,
                    turned_rad: 0.0,
                    current_speed_m_s,
                };
                let setpoint = Motion { speed_m_s: body.max_speed_m_s, turn_rate_rad_s: rate };
                let motion = governor.limit(setpoint, &situation, &odometry);
                odometry.record_command(motion);
                walk.step(motion);
            }
            prop_assert!(walk.min_gap_m > 0.0, "{} m", walk.min_gap_m);
        }
    }

    #[test]
    fn without_the_limit_a_robot_hits_the_wall() {
        let spec = BrainSpec {
            limit_speed_to_stopping_distance: false,
            ..cruising()
        };
        let mut walk = Walk::new(rover(), room(20.0, 9.0), [4.0, 4.0], 0.0);
        walk.run(&mut Brain::new(Arc::new(spec), Arc::new(rover())), 300);
        assert!(walk.min_gap_m <= 0.0);
    }

    #[test]
    fn a_robot_within_the_limit_still_gets_near_the_wall() {
        let mut walk = Walk::new(rover(), room(20.0, 9.0), [4.0, 4.0], 0.3);
        walk.run(&mut cruiser(&rover()), 600);
        assert!(walk.min_gap_m < 0.1, "{} m", walk.min_gap_m);
    }

    #[test]
    fn a_robot_stands_still_without_a_valid_scan() {
        let body = rover();
        let free = vec![f64::INFINITY; 16];
        assert!(speed_m_s(&body, &scan(0.0, free.clone())) == 1.0);
        let mut broken = free.clone();
        broken[0] = f64::NAN;
        for percept in [
            Percept::default(),
            scan(0.0, Vec::new()),
            scan(0.0, vec![f64::INFINITY; 15]),
            scan(4.0, free.clone()),
            scan(f64::INFINITY, free.clone()),
            scan(f64::NAN, free),
            scan(0.0, broken),
        ] {
            assert!(speed_m_s(&body, &percept) == 0.0, "{percept:?}");
        }
    }

    #[test]
    fn an_older_scan_lowers_the_speed() {
        let mut body = rover();
        body.max_speed_m_s = 9.0;
        body.rings[0].period_s = 1.0;
        let speed = |age| speed_m_s(&body, &scan(age, vec![f64::INFINITY; 16]));
        assert!(speed(0.0) > speed(0.5) && speed(0.5) > speed(1.0) && speed(1.0) > 0.0);
    }

    #[test]
    fn a_robot_without_a_range_sensor_to_the_front_is_not_limited() {
        let mut body = rover();
        body.rings[0].bearings_rad = vec![1.5, -1.5];
        assert!(speed_m_s(&body, &Percept::default()) == 1.0);
        body.rings.clear();
        assert!(speed_m_s(&body, &Percept::default()) == 1.0);
    }

    #[test]
    fn the_limit_matches_its_formula() {
        // v period + v^2 / (2 a) = free, with 0.9 of the body's deceleration.
        // The clearance covers corners between rays at this distance.
        let mut ranges = vec![f64::INFINITY; 360];
        ranges[0] = 0.3 + 0.25 * 1.05;
        let mut body = rover();
        body.rings = vec![ring(360, 3.0)];
        let speed = speed_m_s(&body, &scan(0.0, ranges));
        let needed_m = 0.1 * speed + speed * speed / (2.0 * 0.9);
        assert!((needed_m - 0.3).abs() < 1e-12, "{speed}");
    }

    #[test]
    fn a_robot_stops_before_a_wall_although_every_range_is_four_per_cent_too_long() {
        let mut body = rover();
        (body.max_speed_m_s, body.rings[0].range_m) = (5.0, 10.0);
        let across = Segment {
            from: Point { x: 12.0, y: -9.0 },
            to: Point { x: 12.0, y: 9.0 },
        };
        let mut walk = Walk::new(body.clone(), vec![across], [0.0, 0.0], 0.0);
        let mut brain = cruiser(&body);
        for _ in 0..200 {
            let mut percept = walk.percept();
            let ranges_m = percept.scans[0].ranges_m.iter_mut();
            ranges_m.for_each(|range_m| *range_m *= 1.04);
            let motion = brain.step(&percept).motion;
            walk.step(motion);
        }
        assert!(walk.at.x > 11.0 && walk.min_gap_m > 0.0, "{:?}", walk.at);
    }

    #[test]
    fn an_obstacle_ahead_that_only_a_ring_at_the_side_detects_stops_the_robot() {
        let mut body = rover();
        let mut side = body.rings[0].clone();
        (body.rings[0].bearings_rad, side.bearings_rad) = (vec![-0.1, 0.0, 0.1], vec![0.9, 1.1]);
        body.rings.push(side);
        let speed = |aside_m: f64| {
            let mut percept = scan(0.0, vec![f64::INFINITY; 3]);
            let ranges_m = vec![aside_m; 2];
            percept.scans.push(Scan {
                age_s: Some(0.0),
                ranges_m,
            });
            speed_m_s(&body, &percept)
        };
        assert_eq!(speed(f64::INFINITY), 1.0);
        assert_eq!(speed(0.5), 1.0);
        assert!(speed(0.28) < 0.15);
    }

    #[test]
    fn a_robot_passes_a_door_twenty_centimetres_wider_than_itself() {
        let mut walls = room(8.0, 4.0);
        for wall in [
            [[4.0, 0.0], [4.0, 1.65], [4.1, 1.65], [4.1, 0.0]],
            [[4.0, 2.35], [4.0, 4.0], [4.1, 4.0], [4.1, 2.35]],
        ] {
            walls.extend(outline(&wall));
        }
        let mut walk = Walk::new(rover(), walls, [1.0, 2.0], 0.0);
        walk.run(&mut cruiser(&rover()), 200);
        assert!(walk.at.x > 7.0, "{:?}", walk.at);
    }

    #[test]
    fn a_reversing_robot_stops_before_a_wall() {
        let mut body = rover();
        body.max_reverse_speed_m_s = 1.0;
        let across = Segment {
            from: Point { x: 0.0, y: 9.0 },
            to: Point { x: 0.0, y: -9.0 },
        };
        let mut walk = Walk::new(body.clone(), vec![across], [2.0, 0.0], 0.0);
        let spec = BrainSpec {
            behaviours: vec![BehaviourSpec::Cruise(Cruise {
                speed_m_s: Some(-1.0),
            })],
            ..BrainSpec::default()
        };
        walk.run(&mut Brain::new(Arc::new(spec), Arc::new(body)), 100);
        assert!((0.0..0.1).contains(&walk.min_gap_m), "{}", walk.min_gap_m);
    }

    #[test]
    fn step_into_returns_the_same_command_as_step() {
        let percept = scan(0.0, vec![1.0; 16]);
        let mut command = Command::default();
        cruiser(&rover()).step_into(&percept, &mut command);
        assert_eq!(command, cruiser(&rover()).step(&percept));
    }
}
