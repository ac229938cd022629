//! Searching by random bounces.

use super::common::{ahead, half_sight_m};
use super::turn::Turn;
use crate::behaviours::behaviour::Behaviour;
use crate::goals::proposal::Proposal;
use crate::io::body::Body;
use crate::io::command::Motion;
use crate::perception::rays::Ring;
use crate::situation::Situation;
use crate::situation::timer::Stopwatch;
use base::trig::wrapped;
use core::f64::consts::{FRAC_PI_4, TAU};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Minimum turn of a robot without range sensors, in radians.
const MIN_BLIND_RAD: f64 = FRAC_PI_4;

/// Searches by random bounces: moves straight on until something is in its way or touches it, turns
/// on the spot to a heading drawn at random among those that look free, and continues. A robot
/// without range sensors turns by any angle but a small one.
///
/// Needs no compass: the turn lasts for as long as the angle takes, and is more accurate with one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(inline)]
pub struct RandomBounce {
    /// Distance from its footprint to an obstacle ahead at which it turns, in metres; it brakes in
    /// time for that. At most half the range of its range sensors.
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub turn_at_m: f64,
    /// Time to move straight on after a turn before lower behaviours are active again, in seconds.
    #[schemars(range(min = 0.0, max = 3600.0))]
    pub hold_s: f64,
    /// Speed while it moves straight on, in m/s. Without it, the maximum speed of the body.
    #[schemars(range(min = 0.0, max = 100.0))]
    pub speed_m_s: Option<f64>,
}

impl Default for RandomBounce {
    fn default() -> Self {
        Self {
            turn_at_m: 0.5,
            hold_s: 0.0,
            speed_m_s: None,
        }
    }
}

/// [`RandomBounce`] in a body.
#[derive(Debug, Clone)]
pub(crate) struct Ready {
    turn_at_m: f64,
    half_sight_m: f64,
    hold_s: f64,
    held: Motion,
}

/// State of the behaviour.
#[derive(Debug, Clone)]
pub(crate) enum Memory {
    /// Moving straight on, for this time.
    Straight {
        since: Stopwatch,
    },
    Turning(Turn),
}

/// The initial state.
const STRAIGHT: Memory = Memory::Straight {
    since: Stopwatch::START,
};

impl Ready {
    pub(super) fn new(spec: &RandomBounce, body: &Body) -> Self {
        let half_sight_m = half_sight_m(body);
        Self {
            turn_at_m: spec.turn_at_m.min(half_sight_m),
            half_sight_m,
            hold_s: spec.hold_s,
            held: ahead(spec.speed_m_s, body),
        }
    }
}

impl Behaviour for Ready {
    type Memory = Memory;

    fn memory(&self) -> Memory {
        STRAIGHT
    }

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

    /// Straight on. Lower behaviours that propose something take precedence.
    fn idle(&self) -> Option<Motion> {
        Some(self.held)
    }

    #[inline]
    fn suppressed(&self, memory: &mut Memory) {
        *memory = STRAIGHT;
    }
}

impl Ready {
    #[inline]
    fn next_motion(&self, memory: &mut Memory, situation: &Situation) -> Option<Motion> {
        match memory {
            Memory::Straight { since } => {
                let straight_s = since.read_s(situation);
                let near_m = (self.turn_at_m + situation.stopping_m()).min(self.half_sight_m);
                let is_stopped = situation.is_obstacle_ahead(near_m, straight_s)
                    || situation.touches(straight_s);
                is_stopped.then(|| self.turn(memory, situation))
            }
            Memory::Turning(turn) => {
                let motion = turn.next_motion(situation);
                if motion.is_none() {
                    *memory = STRAIGHT;
                }
                motion
            }
        }
    }

    fn turn(&self, memory: &mut Memory, situation: &Situation) -> Motion {
        let (turn, motion) = Turn::by(self.new_course_rad(situation), situation.body);
        *memory = Memory::Turning(turn);
        motion
    }

    /// The angle to a new heading, from -pi to pi: that of a ray longer than the turning distance, or
    /// else of the longest ray, plus up to half the angle to the next ray.
    fn new_course_rad(&self, situation: &Situation) -> f64 {
        let mut random_words = situation.random_words();
        let free_m = situation.body.radius_m + self.turn_at_m;
        let is_free = |(_, _, range_m): &(&Ring, usize, f64)| *range_m > free_m;
        let count = rays(situation)
            .filter(is_free)
            .fold(0, |count, _| count + 1);
        let chosen = rays(situation)
            .filter(is_free)
            .nth(random_words.below(count) as usize);
        let longest = || rays(situation).max_by(|a, b| a.2.total_cmp(&b.2));
        let angle_rad = match chosen.or_else(longest) {
            Some((ring, ray, _)) => ring.bearing_beside_rad(ray, random_words.between(-0.5, 0.5)),
            None => random_words.between(MIN_BLIND_RAD, TAU - MIN_BLIND_RAD),
        };
        wrapped(angle_rad)
    }
}

/// The rays of recent scans: ring, index in the ring, and range.
fn rays<'s>(situation: &'s Situation) -> impl Iterator<Item = (&'s Ring, usize, f64)> {
    situation.scans().flat_map(|(ring, ranges_m)| {
        let rays = 0..ranges_m.len();
        rays.map(move |ray| (ring, ray, ring.ray_m(ranges_m, ray)))
    })
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "exact by construction")]
mod tests {
    use super::*;
    use crate::behaviours::{BehaviourSpec, Cruise};
    use crate::world_of_walls::{Walk, Wiring, now, room, rover};
    use crate::{Arbitration, Brain, BrainSpec, Percept, Scan, Schemas};
    use proptest::prelude::*;
    use std::sync::Arc;

    fn brain(body: &Body, bounce: RandomBounce) -> Brain {
        let behaviours = vec![
            BehaviourSpec::Cruise(Cruise::default()),
            BehaviourSpec::RandomBounce(bounce),
        ];
        let spec = BrainSpec {
            behaviours,
            ..BrainSpec::default()
        };
        Brain::new(Arc::new(spec), Arc::new(body.clone()))
    }

    /// The number of squares of 1 m that it has visited after a time.
    fn squares_visited(walk: &mut Walk, brain: &mut Brain, seconds: usize) -> usize {
        let mut visited = std::collections::BTreeSet::new();
        for _ in 0..seconds {
            walk.run(brain, 10);
            #[expect(clippy::cast_possible_truncation, reason = "within the room")]
            visited.insert([walk.at.x.floor() as i32, walk.at.y.floor() as i32]);
        }
        visited.len()
    }

    #[test]
    fn it_searches_the_whole_room_without_touching_walls() {
        let body = rover();
        for wiring in [
            Wiring::default(),
            Wiring {
                compass: true,
                scans_apart: 1,
                latency: 1,
                ..Wiring::default()
            },
        ] {
            let mut walk = Walk::new(body.clone(), room(5.0, 5.0), [2.5, 2.5], 0.3);
            walk.wiring = wiring;
            let squares =
                squares_visited(&mut walk, &mut brain(&body, RandomBounce::default()), 600);
            assert!(squares >= 24, "{squares} of 25");
            assert!(walk.min_gap_m > 0.0, "{}", walk.min_gap_m);
        }
    }

    #[test]
    fn as_the_only_behaviour_it_searches_the_whole_room() {
        let schemas = Arbitration::Schemas(Schemas::default());
        for arbitration in [Arbitration::Subsumption, Arbitration::Goals, schemas] {
            let spec = BrainSpec {
                behaviours: vec![BehaviourSpec::RandomBounce(RandomBounce::default())],
                arbitration,
                ..BrainSpec::default()
            };
            let mut walk = Walk::new(rover(), room(5.0, 5.0), [2.5, 2.5], 0.3);
            let mut brain = Brain::new(Arc::new(spec), Arc::new(rover()));
            assert!(squares_visited(&mut walk, &mut brain, 600) >= 24);
        }
    }

    /// If it braked only at the turning distance, it would get near enough for obstacle avoidance to
    /// take over, which turns by the minimum angle, and the robot would follow the walls.
    #[test]
    fn low_deceleration_does_not_make_it_follow_the_walls() {
        let mut body = rover();
        (body.max_speed_m_s, body.max_acceleration_m_s2) = (2.0, 2.0);
        body.rings[0].range_m = 5.0;
        let mut walk = Walk::new(body.clone(), room(20.0, 20.0), [9.0, 9.0], 0.3);
        let mut brain = Brain::new(Arc::new(BrainSpec::default()), Arc::new(body));
        let mut in_the_middle = 0;
        for _ in 0..2000 {
            walk.run(&mut brain, 10);
            let off_m = (walk.at.x - 10.0).abs().max((walk.at.y - 10.0).abs());
            in_the_middle += u32::from(off_m < 5.0);
        }
        // A quarter of the room: about 500 for a uniform distribution, 10 along the walls.
        assert!(in_the_middle > 200, "{in_the_middle}");
    }

    #[test]
    fn without_range_sensors_it_searches_by_touch() {
        let mut body = rover();
        body.rings.clear();
        let mut walk = Walk::new(body.clone(), room(5.0, 5.0), [2.5, 2.5], 0.3);
        walk.wiring.touch = true;
        let squares = squares_visited(&mut walk, &mut brain(&body, RandomBounce::default()), 600);
        assert!(squares >= 24, "{squares} of 25");
    }

    #[test]
    fn it_moves_with_a_sensor_range_below_the_turning_distance() {
        let mut body = rover();
        body.rings[0].range_m = 0.6;
        let mut walk = Walk::new(body.clone(), room(9.0, 9.0), [4.0, 4.0], 0.0);
        walk.run(&mut brain(&body, RandomBounce::default()), 20);
        assert!(walk.at.x > 4.3, "{:?}", walk.at);
    }

    /// The angle of its turn for given ranges, with a compass or without.
    fn turn_rad(ranges_m: &[f64], random_words: [u32; 4], has_compass: bool) -> f64 {
        let body = rover();
        let mut brain = brain(&body, RandomBounce::default());
        let mut turned_rad = 0.0;
        for step in 0..60 {
            let command = brain.step(&Percept {
                random_words,
                heading_rad: has_compass.then(|| now(wrapped(3.0 + turned_rad))),
                scans: vec![Scan {
                    age_s: Some(0.0),
                    ranges_m: ranges_m.to_vec(),
                }],
                ..Percept::default()
            });
            if step > 0 && command.motion.turn_rate_rad_s == 0.0 {
                break;
            }
            turned_rad += command.motion.turn_rate_rad_s * body.period_s;
        }
        turned_rad
    }

    proptest! {
        #[test]
        fn it_turns_to_a_free_heading(random_words: [u32; 4], has_compass: bool, free in 1_usize..16) {
            let mut ranges = [0.5; 16];
            ranges[free] = 2.0;
            let bearing = wrapped(f64::from(u32::try_from(free).unwrap()) * TAU / 16.0);
            let off = wrapped(turn_rad(&ranges, random_words, has_compass) - bearing);
            prop_assert!(off.abs() <= TAU / 32.0 + 0.03, "{off}");
        }

        #[test]
        fn without_a_free_heading_it_turns_to_the_longest_range(random_words: [u32; 4]) {
            let mut ranges = [0.5; 16];
            ranges[4] = 0.6;
            let off = turn_rad(&ranges, random_words, false) - TAU / 4.0;
            prop_assert!(off.abs() <= TAU / 32.0 + 0.03, "{off}");
        }
    }

    #[test]
    fn all_free_headings_are_equally_likely() {
        // Seven free rays and 7000 evenly spaced random words: an error of at most one.
        let mut ranges = [2.0; 16];
        for ray in [0, 1, 2, 3, 4, 12, 13, 14, 15] {
            ranges[ray] = 0.5;
        }
        let mut counts = [0_u32; 7];
        for draw in 0..7000_u32 {
            let random_words = [draw * (u32::MAX / 7000), 1 << 31, 0, 0];
            let bearing = turn_rad(&ranges, random_words, false).rem_euclid(TAU);
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "5 to 11"
            )]
            let ray = (bearing / (TAU / 16.0)).round() as usize;
            counts[ray - 5] += 1;
        }
        assert!(
            counts.iter().all(|count| (999..=1001).contains(count)),
            "{counts:?}"
        );
    }

    #[test]
    fn a_turn_that_does_not_end_times_out() {
        let mut body = rover();
        body.max_turn_rate_rad_s = 0.0;
        let mut brain = brain(&body, RandomBounce::default());
        let walled = |range_m| Percept {
            scans: vec![Scan {
                age_s: Some(0.0),
                ranges_m: vec![range_m; 16],
            }],
            ..Percept::default()
        };
        for _ in 0..10 {
            assert_eq!(brain.step(&walled(0.5)).motion.speed_m_s, 0.0);
        }
        let speeds = (0..700).map(|_| brain.step(&walled(3.0)).motion.speed_m_s);
        assert!(speeds.fold(0.0, f64::max) == 1.0);
    }
}
