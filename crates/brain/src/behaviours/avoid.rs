//! Avoiding what is too near.

use super::common::{ahead, half_sight_m};
use crate::behaviours::behaviour::Behaviour;
use crate::goals::proposal::Proposal;
use crate::io::body::{Body, RangeRing};
use crate::io::command::Motion;
use crate::perception::rays::valid_m;
use crate::situation::Situation;
use crate::situation::timer::Stopwatch;
use alloc::vec::Vec;
use core::f64::consts::{FRAC_PI_4, PI, TAU};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Difference below which two sides count as equally free, in metres.
const SAME_M: f64 = 0.01;

/// Time limit for reversing and turning, if contact persists or the compass is stuck, in seconds.
const PATIENCE_S: f32 = 10.0;

/// Turn rate assumed for a robot that cannot turn, in rad/s.
const MIN_TURN_RATE_RAD_S: f64 = 1e-3;

/// Avoids what is too near: turns on the spot, to the freer side, until the way is clear. After a
/// contact it first reverses, if the body can, and turns by at least an eighth of a turn.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(inline)]
pub struct Avoid {
    /// What is nearer to the robot's footprint than this is too near, in metres; at most half the
    /// range of its range sensors.
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub near_m: f64,
    /// The way is clear when everything is farther than `near_m` by this, in metres; at most
    /// `near_m`.
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub clearance_hysteresis_m: f64,
    /// Angle about the front that is checked, in degrees.
    #[schemars(range(min = 0.0, max = 360.0))]
    pub sector_deg: f64,
    /// Distance to reverse from what the robot touches, in metres.
    #[schemars(range(min = 0.0, max = 100.0))]
    pub reverse_distance_m: f64,
    /// Time to move straight on once the way is clear, before lower behaviours are active again, in
    /// seconds. Without it a robot with a goal can be trapped in front of a large obstacle: it
    /// turns away, and at once back to its goal.
    #[schemars(range(min = 0.0, max = 3600.0))]
    pub hold_s: f64,
    /// Speed while it moves straight on, in m/s. Without it, the maximum speed of the body.
    #[schemars(range(min = 0.0, max = 100.0))]
    pub speed_m_s: Option<f64>,
}

impl Default for Avoid {
    fn default() -> Self {
        Self {
            near_m: 0.15,
            clearance_hysteresis_m: 0.05,
            sector_deg: 120.0,
            reverse_distance_m: 0.2,
            hold_s: 1.0,
            speed_m_s: None,
        }
    }
}

/// [`Avoid`] in a body.
#[derive(Debug, Clone)]
pub(crate) struct Ready {
    near_m: f64,
    clear_m: f64,
    hold_s: f64,
    held: Motion,
    back: Motion,
    backing_s: f64,
    turn_rate_rad_s: f64,
    /// The rays in the left and right half of the sector, per ring.
    sides: Vec<[Vec<usize>; 2]>,
}

/// State of the behaviour.
#[derive(Debug, Clone)]
pub(crate) enum Memory {
    /// The time for which the path has been clear.
    Clear { since: Stopwatch },
    /// Reversing: remaining time once contact has ended, and remaining time until the timeout.
    Backing { left_s: f32, patience_s: f32 },
    /// Turning: time since the start, and remaining minimum angle.
    Turning {
        is_left: bool,
        since_s: f32,
        min_rad: f32,
    },
}

/// The initial state.
const CLEAR: Memory = Memory::Clear {
    since: Stopwatch::START,
};

impl Ready {
    pub(super) fn new(spec: &Avoid, body: &Body) -> Self {
        let half_rad = (spec.sector_deg / 2.0).to_radians();
        let rings = body.rings.iter();
        let sides = rings.map(|ring| {
            [(0.0, half_rad), (-half_rad, 0.0)].map(|bounds| rays_within(ring, bounds))
        });
        let back_m_s = body.max_reverse_speed_m_s;
        let near_m = spec.near_m.min(half_sight_m(body));
        Self {
            near_m,
            clear_m: near_m + spec.clearance_hysteresis_m.min(near_m),
            hold_s: spec.hold_s,
            held: ahead(spec.speed_m_s, body),
            back: ahead(Some(-back_m_s), body),
            backing_s: if back_m_s > 0.0 {
                spec.reverse_distance_m / back_m_s
            } else {
                0.0
            },
            turn_rate_rad_s: body.max_turn_rate_rad_s.max(MIN_TURN_RATE_RAD_S),
            sides: sides.collect(),
        }
    }
}

/// The minimum range of some rays; infinite if there are none.
#[inline]
fn shortest_m(ranges_m: &[f64], rays: &[usize]) -> f64 {
    let mut shortest_m = f64::INFINITY;
    for ray in rays {
        let length_m = valid_m(ranges_m.get(*ray).copied().unwrap_or_default());
        if length_m < shortest_m {
            shortest_m = length_m;
        }
    }
    shortest_m
}

/// The rays with bearings within some bounds.
fn rays_within(ring: &RangeRing, (min_rad, max_rad): (f64, f64)) -> Vec<usize> {
    let rays = ring.bearings_rad.iter().enumerate();
    let within = rays.filter(|(_, bearing)| (min_rad..=max_rad).contains(bearing));
    within.map(|(ray, _)| ray).collect()
}

impl Behaviour for Ready {
    type Memory = Memory;

    fn memory(&self) -> Memory {
        CLEAR
    }

    #[inline]
    fn hold_s(&self) -> f64 {
        self.hold_s
    }

    #[inline]
    fn triggered(&self, memory: &mut Memory, situation: &Situation) -> Option<Proposal> {
        self.next_motion(memory, situation).map(Proposal::Motion)
    }

    fn held(&self) -> Motion {
        self.held
    }

    #[inline]
    fn suppressed(&self, memory: &mut Memory) {
        *memory = CLEAR;
    }
}

impl Ready {
    #[inline]
    fn next_motion(&self, memory: &mut Memory, situation: &Situation) -> Option<Motion> {
        match memory {
            Memory::Clear { since } => {
                let clear_s = since.read_s(situation);
                self.look(memory, clear_s, situation)
            }
            Memory::Backing { .. } => Some(self.continue_reversing(memory, situation)),
            Memory::Turning { .. } => self.continue_turning(memory, situation),
        }
    }

    #[inline]
    #[expect(clippy::cast_possible_truncation, reason = "kept short")]
    fn look(&self, memory: &mut Memory, clear_s: f64, situation: &Situation) -> Option<Motion> {
        if situation.touches(clear_s) || situation.is_blocked(clear_s) {
            if self.backing_s <= 0.0 {
                return Some(self.turn_by_chance(memory, situation));
            }
            *memory = Memory::Backing {
                left_s: self.backing_s as f32,
                patience_s: PATIENCE_S,
            };
            return Some(self.back);
        }
        let [left_m, right_m] = self.nearest_m(situation);
        let is_near = left_m.min(right_m) < self.near_m;
        if !is_near && situation.is_stopped(clear_s) {
            return Some(self.turn_by_chance(memory, situation));
        }
        is_near.then(|| self.turn(memory, [left_m, right_m], 0.0, situation))
    }

    fn continue_reversing(&self, memory: &mut Memory, situation: &Situation) -> Motion {
        let Memory::Backing { left_s, patience_s } = memory else {
            return Motion::default();
        };
        if !situation.is_held() {
            *left_s -= situation.step_s();
        }
        *patience_s -= situation.step_s();
        if left_s.min(*patience_s) > situation.half_step_s() {
            self.back
        } else {
            self.turn_by_chance(memory, situation)
        }
    }

    fn turn_by_chance(&self, memory: &mut Memory, situation: &Situation) -> Motion {
        let mut random_words = situation.random_words();
        // The first random word selects the side.
        random_words.unit();
        let min_rad = random_words.between(FRAC_PI_4, PI);
        self.turn(memory, self.nearest_m(situation), min_rad, situation)
    }

    #[expect(clippy::cast_possible_truncation, reason = "kept short")]
    fn turn(
        &self,
        memory: &mut Memory,
        [left_m, right_m]: [f64; 2],
        min_rad: f64,
        situation: &Situation,
    ) -> Motion {
        // NaN if nothing is detected on either side.
        let differs = (left_m - right_m).abs() >= SAME_M;
        let is_left = if differs {
            left_m > right_m
        } else {
            situation.random_words().below(2) == 0
        };
        *memory = Memory::Turning {
            is_left,
            since_s: 0.0,
            min_rad: min_rad as f32,
        };
        self.on_the_spot(is_left)
    }

    #[expect(clippy::cast_possible_truncation, reason = "kept short")]
    fn continue_turning(&self, memory: &mut Memory, situation: &Situation) -> Option<Motion> {
        let Memory::Turning {
            is_left,
            since_s,
            min_rad,
        } = memory
        else {
            return None;
        };
        let is_left = *is_left;
        if !situation.is_held() {
            *since_s += situation.step_s();
        }
        *min_rad -= situation.turned_rad.abs() as f32;
        let has_turned = *min_rad <= 0.0 || *since_s >= PATIENCE_S;
        let is_round = f64::from(*since_s) * self.turn_rate_rad_s > TAU;
        let [left_m, right_m] = self.nearest_m(situation);
        // If no direction is clear, it stops at the best one.
        let clear_m = if is_round { self.near_m } else { self.clear_m };
        if has_turned && left_m.min(right_m) >= clear_m {
            *memory = CLEAR;
            return None;
        }
        Some(self.on_the_spot(is_left))
    }

    fn on_the_spot(&self, is_left: bool) -> Motion {
        let rate = self.turn_rate_rad_s;
        Motion {
            speed_m_s: 0.0,
            turn_rate_rad_s: if is_left { rate } else { -rate },
        }
    }

    /// Distances from the footprint to the nearest obstacle on the left and on the right; infinite if
    /// none is detected.
    #[inline]
    fn nearest_m(&self, situation: &Situation) -> [f64; 2] {
        let mut nearest_m = [f64::INFINITY; 2];
        for (ranges_m, [left, right]) in situation.scans_with(&self.sides) {
            nearest_m[0] = shortest_m(ranges_m, left).min(nearest_m[0]);
            nearest_m[1] = shortest_m(ranges_m, right).min(nearest_m[1]);
        }
        nearest_m.map(|nearest_m| nearest_m - situation.body.radius_m)
    }
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "exact by construction")]
mod tests {
    use super::*;
    use crate::behaviours::{BehaviourSpec, Cruise};
    use crate::world_of_walls::{Walk, now, outline, room, rover};
    use crate::{Brain, BrainSpec, Percept, Scan};
    use proptest::prelude::*;
    use std::sync::Arc;

    fn brain(body: &Body) -> Brain {
        let behaviours = vec![
            BehaviourSpec::Cruise(Cruise::default()),
            BehaviourSpec::Avoid(Avoid::default()),
        ];
        let spec = BrainSpec {
            behaviours,
            ..BrainSpec::default()
        };
        Brain::new(Arc::new(spec), Arc::new(body.clone()))
    }

    fn percept(ranges: &[(usize, f64)], random_words: u32, touches: bool) -> Percept {
        let mut ranges_m = vec![2.0; 16];
        for (ray, range_m) in ranges {
            ranges_m[*ray] = *range_m;
        }
        Percept {
            random_words: [random_words; 4],
            touch: Some(now(touches)),
            scans: vec![Scan {
                age_s: Some(0.0),
                ranges_m,
            }],
            ..Percept::default()
        }
    }

    proptest! {
        #[test]
        fn it_turns_to_the_freer_side(random_words: u32, near in 0.25_f64..0.35, far in 0.5_f64..2.0) {
            for (near_ray, sign) in [(1, -1.0), (15, 1.0)] {
                let ranges = [(near_ray, near), (16 - near_ray, far)];
                let motion = brain(&rover()).step(&percept(&ranges, random_words, false)).motion;
                prop_assert_eq!(motion.speed_m_s, 0.0);
                prop_assert!(motion.turn_rate_rad_s * sign > 1.0);
            }
        }

        #[test]
        fn obstacles_beside_or_behind_are_ignored(ray in 4_usize..=12, range in 0.25_f64..2.0) {
            let motion = brain(&rover()).step(&percept(&[(ray, range)], 0, false)).motion;
            prop_assert_eq!(motion.turn_rate_rad_s, 0.0);
        }
    }

    #[test]
    fn between_equally_free_sides_it_chooses_at_random() {
        let turn = |random_words| {
            let percept = percept(&[(0, 0.3)], random_words, false);
            brain(&rover()).step(&percept).motion.turn_rate_rad_s
        };
        assert!(turn(0) > 1.0 && turn(u32::MAX) < -1.0);
    }

    #[test]
    fn it_keeps_turning_to_one_side_until_clear_and_then_drives_straight_for_its_hold_time() {
        let mut brain = brain(&rover());
        let mut step = |ranges: &[(usize, f64)]| brain.step(&percept(ranges, 0, false)).motion;
        assert!(step(&[(1, 0.3)]).turn_rate_rad_s < 0.0);
        // First the other side is freer, then the obstacle is farther away but not yet clear.
        assert!(step(&[(1, 0.4), (15, 0.3)]).turn_rate_rad_s < 0.0);
        assert!(step(&[(15, 0.42)]).turn_rate_rad_s < 0.0);
        let straight = step(&[(15, 0.46)]);
        assert!(straight.turn_rate_rad_s == 0.0 && straight.speed_m_s > 0.0);
    }

    #[test]
    fn it_reverses_from_a_contact_and_turns_by_at_least_an_eighth() {
        let mut body = rover();
        body.max_reverse_speed_m_s = 0.5;
        let mut brain = brain(&body);
        for _ in 0..10 {
            brain.step(&percept(&[], 0, false));
        }
        let mut step = |touches| brain.step(&percept(&[], 0, touches)).motion;
        assert!((0..30).all(|_| step(true).speed_m_s == -0.5));
        let motions: Vec<Motion> = (0..40).map(|_| step(false)).collect();
        let backing = motions.iter().take_while(|motion| motion.speed_m_s < 0.0);
        assert_eq!(backing.count(), 3);
        let turning = motions.iter().skip(3).map(|motion| motion.turn_rate_rad_s);
        let turned: f64 = turning
            .take_while(|rate| *rate != 0.0)
            .map(|rate| rate * 0.1)
            .sum();
        assert!((FRAC_PI_4..FRAC_PI_4 + 0.4).contains(&turned), "{turned}");
    }

    #[test]
    fn a_turn_does_not_progress_while_a_collision_stops_the_robot() {
        let mut brain = brain(&rover());
        let mut step = |touches, turn_rate_rad_s| {
            let value = Motion {
                speed_m_s: 0.0,
                turn_rate_rad_s,
            };
            let percept = Percept {
                motion: Some(now(value)),
                ..percept(&[], 0, touches)
            };
            brain.step(&percept).motion.turn_rate_rad_s
        };
        assert!((0..6).all(|_| step(false, 0.0) == 0.0));
        assert!((0..100).all(|_| step(true, 0.0) != 0.0));
        let turning = (0..40).take_while(|_| step(false, PI / 2.0) != 0.0);
        assert_eq!(turning.count(), 4);
    }

    #[test]
    fn contact_is_ignored_while_it_leaves() {
        let mut brain = brain(&rover());
        let mut step = |touches| brain.step(&percept(&[], 0, touches)).motion.turn_rate_rad_s;
        assert!((0..5).all(|_| step(true) == 0.0));
        assert!(step(true) != 0.0 || step(true) != 0.0);
    }

    #[test]
    fn it_leaves_a_dead_end_that_is_hardly_wider_than_the_robot() {
        let alley = outline(&[[0.0, -0.4], [3.0, -0.4], [3.0, 0.4], [0.0, 0.4]]);
        let walls = alley.into_iter().take(3).collect();
        let mut walk = Walk::new(rover(), walls, [1.0, 0.0], 0.0);
        walk.run(&mut brain(&rover()), 600);
        assert!(walk.at.x < 0.0, "{:?}", walk.at);
    }

    #[test]
    fn without_range_sensors_it_leaves_a_wall_on_contact() {
        let mut body = rover();
        body.rings.clear();
        body.max_reverse_speed_m_s = 0.5;
        let mut walk = Walk::new(body.clone(), room(5.0, 5.0), [2.5, 2.5], 0.3);
        walk.wiring.touch = true;
        let mut brain = brain(&body);
        let mut touches = 0;
        let mut farthest_m = 0.0_f64;
        for _ in 0..3000 {
            let before = walk.is_touching;
            walk.run(&mut brain, 1);
            touches += usize::from(walk.is_touching && !before);
            farthest_m = farthest_m.max((walk.at.x - 2.5).hypot(walk.at.y - 2.5));
        }
        assert!(touches > 20 && farthest_m > 2.25, "{touches} {farthest_m}");
    }
}
