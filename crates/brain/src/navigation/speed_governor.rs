//! No faster than it sees: a robot must be able to stop within what it knows to be free.
//!
//! At speed `v` it goes on for a period before it can think again, and then needs `v^2 / (2 a)` to
//! stop; if it already goes at `u > v`, slowing down takes `(u - v)^2 / (2 a)` more. All this must
//! fit into what was free when the scan was measured, less what it may have gone since. Along a
//! curve it must fit into all that the curve can sweep, or the robot stops before it turns. For `a`
//! it takes a little less than it has, since sensors err.
//!
//! In words of an invariant: after each step it can still stop in time. If the scan leaves room for
//! the next step that stays so by the law; if not, it brakes as hard as it can, and it stays so too.

use crate::io::body::Body;
use crate::io::command::Motion;
use crate::io::percept::Percept;
use crate::perception::dead_reckoning::DeadReckoning;
use crate::perception::rays::Ring;
use crate::perception::sector::Sector;
use crate::perception::situation::{ClearAhead, Situation};
use alloc::vec::Vec;
use core::f64::consts::{FRAC_PI_2, PI};

/// Room that it keeps around itself, as a share of its radius.
const ROOM: f64 = 0.05;

/// It counts on this share of its brakes: who sees 10% too far still stops in time.
const BRAKING: f64 = 0.9;

/// The range rings of a kind of robot, and its law of speed.
#[derive(Debug, Clone)]
pub(crate) struct SpeedGovernor {
    pub(crate) rings: Vec<Ring>,
    half_width_m: f64,

    looks_ahead: bool,
    looks_behind: bool,
    /// 1 / (2 a).
    stopping_s2_m: f64,
}

impl SpeedGovernor {
    pub(crate) fn new(body: &Body) -> Self {
        let half_width_m = body.radius_m * (1.0 + ROOM);
        let ring = |ring| Ring::new(ring, half_width_m, body.period_s);
        let rings: Vec<Ring> = body.rings.iter().map(ring).collect();
        Self {
            half_width_m,
            looks_ahead: rings.iter().any(|ring| ring.looks_ahead),
            looks_behind: rings.iter().any(|ring| ring.looks_behind),
            rings,
            stopping_s2_m: 0.5 / (BRAKING * body.max_acceleration_m_s2),
        }
    }

    /// What is seen straight ahead.
    #[inline]
    pub(crate) fn ahead(&self, percept: &Percept, body: &Body, now_m_s: f64) -> Option<ClearAhead> {
        let free_m = |ring: &Ring, _, ranges_m: &[f64]| Some(ring.free_ahead_m(ranges_m));
        self.seen(percept, body, (1.0, now_m_s.max(0.0)), free_m)
    }

    /// What sight allows of a motion; in a direction in which the body has no range sensor it is
    /// blind, and not limited.
    #[inline]
    pub(crate) fn limited(
        &self,
        wanted: Motion,
        situation: &Situation,
        moved: &DeadReckoning,
    ) -> Motion {
        let Situation { body, now_m_s, .. } = *situation;
        let goes_back = now_m_s < 0.0 || (now_m_s == 0.0 && wanted.speed_m_s < 0.0);
        let way = if goes_back { -1.0 } else { 1.0 };
        let looks = if way > 0.0 {
            self.looks_ahead
        } else {
            self.looks_behind
        };
        let now_m_s = now_m_s.abs();
        let wanted_m_s = (wanted.speed_m_s * way).max(0.0);
        if !looks || (now_m_s == 0.0 && wanted_m_s == 0.0) {
            return wanted;
        }
        let seen = self.on_the_way(wanted, way, situation, moved);
        let free_m = seen.map_or(0.0, |seen| seen.free_m);
        // A turn that leads where it could not stop waits until it stands.
        let can_turn = now_m_s * now_m_s * self.stopping_s2_m <= free_m;
        Motion {
            speed_m_s: way * self.speed_m_s(wanted_m_s, now_m_s, free_m, body.period_s),
            turn_rate_rad_s: if can_turn {
                wanted.turn_rate_rad_s
            } else {
                0.0
            },
        }
    }

    /// What is seen where a motion leads; less, but enough for it, if that is sooner told.
    #[inline]
    fn on_the_way(
        &self,
        wanted: Motion,
        way: f64,
        situation: &Situation,
        moved: &DeadReckoning,
    ) -> Option<ClearAhead> {
        let Situation {
            percept,
            body,
            ahead,
            now_m_s,
            ..
        } = *situation;
        let goes_straight = wanted.turn_rate_rad_s == 0.0
            && way > 0.0
            && ahead.is_some_and(|seen| moved.turned_within_rad(seen.age_s) == 0.0);
        if goes_straight {
            return ahead;
        }
        let now_m_s = now_m_s.abs();
        let wanted_m_s = (wanted.speed_m_s * way).max(0.0);
        let turning_s = body.period_s + 2.0 * self.stopping_s2_m * now_m_s.max(wanted_m_s);
        let stopping_m = now_m_s * now_m_s * self.stopping_s2_m;
        let needed_m = stopping_m.max(self.way_m(wanted_m_s, now_m_s, body.period_s));
        self.seen(percept, body, (way, now_m_s), |ring, age_s, ranges_m| {
            let turned_rad = moved.turned_within_rad(age_s);
            // Turned farther than that, what it saw is not where it goes.
            if turned_rad.abs() > FRAC_PI_2 {
                return None;
            }
            // The nearest anywhere is soon told, and mostly it is far enough.
            let nearest_m = ring.nearest_m(ranges_m);
            let enough_m = needed_m + self.half_width_m + gone_m(body, now_m_s, age_s);
            let turn_rad = wanted.turn_rate_rad_s * turning_s;
            Some(if nearest_m > enough_m {
                nearest_m
            } else {
                ring.free_m(ranges_m, &self.sector(turned_rad, turn_rad, way))
            })
        })
    }

    /// The nearest that rings see on the way, ahead or back; each is asked how far from the centre it
    /// sees, if it can tell.
    ///
    /// One that looks elsewhere may see something in the way beside the body, but that it sees
    /// nothing says nothing.
    #[inline]
    fn seen(
        &self,
        percept: &Percept,
        body: &Body,
        (way, speed_m_s): (f64, f64),
        free_m: impl Fn(&Ring, f64, &[f64]) -> Option<f64>,
    ) -> Option<ClearAhead> {
        let mut nearest: Option<ClearAhead> = None;
        let mut has_looked = false;
        for (place, ring) in self.rings.iter().enumerate() {
            let scan = ring.fresh(percept.scans.get(place));
            let Some((age_s, ranges_m)) = scan else {
                continue;
            };
            let looks = if way > 0.0 {
                ring.looks_ahead
            } else {
                ring.looks_behind
            };
            let free_m = free_m(ring, age_s, ranges_m);
            let Some(free_m) = free_m.filter(|free_m| looks || *free_m < ring.range_m()) else {
                continue;
            };
            has_looked |= looks;
            let free_m = free_m - self.half_width_m - gone_m(body, speed_m_s, age_s);
            let so_far = nearest.unwrap_or(ClearAhead { free_m, age_s });
            nearest = Some(ClearAhead {
                free_m: free_m.min(so_far.free_m),
                age_s: age_s.max(so_far.age_s),
            });
        }
        nearest.filter(|_| has_looked)
    }

    /// Courses from where it looked to where it will stand, turning all the time.
    fn sector(&self, turned_rad: f64, turn_rad: f64, way: f64) -> Sector {
        let last_rad = turned_rad + turn_rad;
        let least = turned_rad.min(last_rad).min(0.0);
        let most = turned_rad.max(last_rad).max(0.0);
        // Within half a turn it has either come to stand or begun to come back.
        let over = (most - least - PI).max(0.0);
        let (least, most) = if turn_rad > 0.0 {
            (least, most - over)
        } else {
            (least + over, most)
        };
        let back_rad = if way < 0.0 { PI } else { 0.0 };
        Sector::new(back_rad + least, back_rad + most, self.half_width_m)
    }

    /// The most, up to `wanted_m_s`, at which it can stop within `free_m` if it goes at `now_m_s`.
    #[inline]
    fn speed_m_s(&self, wanted_m_s: f64, now_m_s: f64, free_m: f64, period_s: f64) -> f64 {
        if self.way_m(wanted_m_s, now_m_s, period_s) <= free_m {
            return wanted_m_s;
        }
        self.most_m_s(now_m_s, free_m, period_s).min(wanted_m_s)
    }

    /// How far it goes if it wants to go so fast for a period, and then brakes.
    #[inline]
    fn way_m(&self, wanted_m_s: f64, now_m_s: f64, period_s: f64) -> f64 {
        let slowing_m_s = (now_m_s - wanted_m_s).max(0.0);
        let squares = wanted_m_s * wanted_m_s + slowing_m_s * slowing_m_s;
        wanted_m_s * period_s + squares * self.stopping_s2_m
    }

    /// The `v` with `v period + (v^2 + max(0, now - v)^2) / (2 a) = free`, or 0.
    fn most_m_s(&self, now_m_s: f64, free_m: f64, period_s: f64) -> f64 {
        if free_m <= 0.0 {
            return 0.0;
        }
        let s = self.stopping_s2_m;
        let faster = positive_root(s, period_s, free_m);
        if faster >= now_m_s {
            return faster;
        }
        let left_m = free_m - now_m_s * now_m_s * s;
        if left_m <= 0.0 {
            return 0.0;
        }
        positive_root(2.0 * s, period_s - 2.0 * s * now_m_s, left_m).min(faster)
    }
}

/// The `x >= 0` with `a x^2 + b x = c`, where `a >= 0` and `c > 0`; also for an `a` of 0.
fn positive_root(a: f64, b: f64, c: f64) -> f64 {
    2.0 * c / (b + libm::sqrt(b * b + 4.0 * a * c))
}

/// At most so far it went within the last `age_s` if it now goes at a speed: before that it was
/// faster by what it can brake, and never faster than it can go.
#[inline]
fn gone_m(body: &Body, speed_m_s: f64, age_s: f64) -> f64 {
    let braking_m_s = body.max_acceleration_m_s2 * age_s / 2.0;
    (speed_m_s + braking_m_s).min(body.max_speed_m_s) * age_s
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "exact by construction")]
mod tests {
    use crate::behaviours::{BehaviourSpec, Cruise};
    use crate::world_of_walls::{Walk, Wiring, outline, ring, room, rover};
    use crate::{Body, Brain, BrainSpec, Command, Motion, Percept, Scan};
    use base::geometry::{Point, Segment};
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

    /// From very slow to very fast, sluggish to instant, near to far sighted.
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
        (0_usize..5, 0_usize..5).prop_map(|(scans_apart, latency)| Wiring {
            scans_apart,
            latency,
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
        fn a_robot_that_goes_no_faster_than_it_sees_never_hits_a_wall(
            body in body(), wiring in wiring(), course in -3.1_f64..3.1, x in 0.6_f64..19.4,
        ) {
            let body = wired(body, wiring);
            let mut walk = Walk::new(body.clone(), room(20.0, 9.0), [x, 4.0], course);
            walk.wiring = wiring;
            walk.go(&mut cruiser(&body), 600);
            prop_assert!(walk.least_gap_m > 0.0, "{} m", walk.least_gap_m);
        }

        #[test]
        fn it_hits_none_along_a_curve(
            body in body(), wiring in wiring(), course in -3.1_f64..3.1, rate in -3.0_f64..3.0,
        ) {
            let body = wired(body, wiring);
            let sight = super::SpeedGovernor::new(&body);
            let mut moved = super::DeadReckoning::default();
            let mut walk = Walk::new(body.clone(), room(20.0, 9.0), [7.0, 4.0], course);
            walk.wiring = wiring;
            for _ in 0..300 {
                let percept = walk.percept();
                let now_m_s = moved.now_m_s(&percept, &body);
                let situation = super::Situation {
                    beliefs: None,
                    percept: &percept,
                    body: &body,
                    rings: &sight.rings,
                    ahead: sight.ahead(&percept, &body, now_m_s),
                    turned_rad: 0.0,
                    now_m_s,
                };
                let wanted = Motion { speed_m_s: body.max_speed_m_s, turn_rate_rad_s: rate };
                let motion = sight.limited(wanted, &situation, &moved);
                moved.told(motion, &body);
                walk.step(motion);
            }
            prop_assert!(walk.least_gap_m > 0.0, "{} m", walk.least_gap_m);
        }
    }

    #[test]
    fn without_the_law_it_hits_the_wall() {
        let spec = BrainSpec {
            limit_speed_to_stopping_distance: false,
            ..cruising()
        };
        let mut walk = Walk::new(rover(), room(20.0, 9.0), [4.0, 4.0], 0.0);
        walk.go(&mut Brain::new(Arc::new(spec), Arc::new(rover())), 300);
        assert!(walk.least_gap_m <= 0.0);
    }

    #[test]
    fn it_comes_near_to_the_wall_all_the_same() {
        let mut walk = Walk::new(rover(), room(20.0, 9.0), [4.0, 4.0], 0.3);
        walk.go(&mut cruiser(&rover()), 600);
        assert!(walk.least_gap_m < 0.1, "{} m", walk.least_gap_m);
    }

    #[test]
    fn it_stands_without_a_scan_and_with_a_stale_or_broken_one() {
        let body = rover();
        let free = vec![f64::INFINITY; 16];
        assert!(speed_m_s(&body, &scan(0.0, free.clone())) == 1.0);
        let mut broken = free.clone();
        broken[0] = f64::NAN;
        for percept in [
            Percept::default(),
            scan(0.0, Vec::new()),
            scan(0.0, vec![f64::INFINITY; 15]),
            scan(0.6, free.clone()),
            scan(f64::NAN, free),
            scan(0.0, broken),
        ] {
            assert!(speed_m_s(&body, &percept) == 0.0, "{percept:?}");
        }
    }

    #[test]
    fn the_older_the_scan_the_slower_it_goes() {
        let mut body = rover();
        body.max_speed_m_s = 9.0;
        body.rings[0].period_s = 1.0;
        let speed = |age| speed_m_s(&body, &scan(age, vec![f64::INFINITY; 16]));
        assert!(speed(0.0) > speed(0.5) && speed(0.5) > speed(1.0) && speed(1.0) > 0.0);
    }

    #[test]
    fn a_robot_without_range_sensors_or_with_some_that_look_aside_only_is_not_limited() {
        let mut body = rover();
        body.rings[0].bearings_rad = vec![1.5, -1.5];
        assert!(speed_m_s(&body, &Percept::default()) == 1.0);
        body.rings.clear();
        assert!(speed_m_s(&body, &Percept::default()) == 1.0);
    }

    #[test]
    fn the_law_is_the_one_of_its_source() {
        // v period + v^2 / (2 a) = free with nine tenths of a.
        let mut ranges = vec![f64::INFINITY; 16];
        ranges[0] = 0.3 + 0.25 * 1.05;
        let speed = speed_m_s(&rover(), &scan(0.0, ranges));
        let way_m = 0.1 * speed + speed * speed / (2.0 * 0.9);
        assert!((way_m - 0.3).abs() < 1e-12, "{speed}");
    }

    #[test]
    fn it_stops_before_a_wall_though_every_range_is_four_per_cent_too_far() {
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
        assert!(walk.at.x > 11.0 && walk.least_gap_m > 0.0, "{:?}", walk.at);
    }

    #[test]
    fn what_a_ring_at_the_side_sees_in_the_way_stops_it() {
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
    fn it_passes_a_door_that_is_a_hand_wider_than_itself() {
        let mut walls = room(8.0, 4.0);
        for wall in [
            [[4.0, 0.0], [4.0, 1.65], [4.1, 1.65], [4.1, 0.0]],
            [[4.0, 2.35], [4.0, 4.0], [4.1, 4.0], [4.1, 2.35]],
        ] {
            walls.extend(outline(&wall));
        }
        let mut walk = Walk::new(rover(), walls, [1.0, 2.0], 0.0);
        walk.go(&mut cruiser(&rover()), 200);
        assert!(walk.at.x > 7.0, "{:?}", walk.at);
    }

    #[test]
    fn backing_it_stops_before_a_wall_too() {
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
        walk.go(&mut Brain::new(Arc::new(spec), Arc::new(body)), 100);
        assert!(
            (0.0..0.1).contains(&walk.least_gap_m),
            "{}",
            walk.least_gap_m
        );
    }

    #[test]
    fn a_command_of_a_step_into_is_the_same_as_that_of_a_step() {
        let percept = scan(0.0, vec![1.0; 16]);
        let mut command = Command::default();
        cruiser(&rover()).step_into(&percept, &mut command);
        assert_eq!(command, cruiser(&rover()).step(&percept));
    }
}
