use super::*;
use crate::io::agent_id::AgentId;
use crate::io::body::Other;
use crate::io::percept::{Neighbour, Percept};
use crate::perception::beliefs::displacement::Displacement;
use crate::perception::beliefs::others::Others;
use crate::world_of_walls::rover;
use base::random::{Entity, Purpose, Stream, stream, unit};
use base::trig::wrapped;
use core::f64::consts::{PI, TAU};
use proptest::prelude::*;
use std::collections::VecDeque;

/// Substeps of a step, after each of which the distances are checked.
const SUBSTEPS: u32 = 10;

fn odometry(body: &Body, speed_m_s: f64, turned_rad: f64) -> Odometry {
    Odometry {
        elapsed_s: body.period_s,
        speed_m_s,
        turned_rad,
        is_commanded: false,
    }
}

/// A robot that follows the rule, and knows the others from exact percepts.
struct TestRobot {
    body: Body,
    at: Point,
    heading_rad: f64,
    speed_m_s: f64,
    others: Others,
    traffic: Traffic,
    /// Its proposed motion, and the remaining steps of the proposal.
    proposal: (Motion, u32),
    turned_rad: f64,
    moved_m: f64,
    /// What it detected in the last steps, and does not know yet.
    seen: VecDeque<Vec<Neighbour>>,
    latency: u32,
}

impl TestRobot {
    fn new(body: Body, at: Point, heading_rad: f64) -> Self {
        Self {
            body,
            at,
            heading_rad,
            speed_m_s: 0.0,
            others: Others::default(),
            traffic: Traffic::default(),
            proposal: (Motion::default(), 0),
            turned_rad: 0.0,
            moved_m: 0.0,
            seen: VecDeque::new(),
            latency: 0,
        }
    }

    fn percept(&mut self, own: usize, crowd: &[(u8, Point)]) -> Percept {
        let numbered = (0..).zip(crowd).filter(|(number, _)| *number != own);
        let neighbours = numbered.map(|(number, (kind, at))| {
            let way = self.at.to(*at);
            Neighbour {
                course_rad: None,
                range_m: way.length(),
                bearing_rad: wrapped(libm::atan2(way.y, way.x) - self.heading_rad),
                age_s: 0.0,
                uncertainty_m: 0.0,
                id: AgentId::robot(*kind, u32::try_from(number).unwrap()),
            }
        });
        // All were stationary before the first step.
        let neighbours: Vec<Neighbour> = neighbours.collect();
        let missing = self.latency as usize + 1 - self.seen.len();
        self.seen.extend(vec![neighbours; missing]);
        let mut neighbours = self.seen.pop_front().unwrap();
        for neighbour in &mut neighbours {
            neighbour.age_s = f64::from(self.latency) * self.body.period_s;
        }
        Percept {
            neighbours,
            ..Percept::default()
        }
    }

    /// A random motion, kept for a while: one in three towards the centre of the crowd, some of
    /// them without translation.
    fn wanted(&mut self, random: &mut Stream) -> Motion {
        let (motion, left) = self.proposal;
        if left > 0 {
            self.proposal.1 -= 1;
            return motion;
        }
        let back_rad = wrapped(libm::atan2(-self.at.y, -self.at.x) - self.heading_rad);
        let turn = self.body.max_turn_rate_rad_s;
        let turn_rate_rad_s = match random.bounded(3) {
            0 => (2.0 * unit(random) - 1.0) * turn,
            1 => 0.0,
            _ => (back_rad / self.body.period_s).clamp(-turn, turn),
        };
        let speed_m_s = match random.bounded(8) {
            0 => 0.0,
            1 => -self.body.max_reverse_speed_m_s,
            2..5 => unit(random) * self.body.max_speed_m_s,
            _ => self.body.max_speed_m_s,
        };
        let motion = Motion {
            speed_m_s,
            turn_rate_rad_s,
        };
        self.proposal = (motion, random.bounded(12));
        motion
    }

    fn decide(&mut self, percept: &Percept, wanted: Motion) -> Motion {
        let (body, turned_rad) = (&self.body, self.turned_rad);
        let current_speed_m_s = self.speed_m_s;
        let odometry = odometry(body, current_speed_m_s, turned_rad);
        let moved = Displacement::along(self.moved_m, &odometry);
        self.others.update(percept, body, &moved, None);
        self.traffic.update(&self.others.movers, body, &odometry);
        self.traffic.limit(wanted, body, current_speed_m_s)
    }

    fn begin_step(&mut self) {
        (self.moved_m, self.turned_rad) = (0.0, 0.0);
    }

    fn advance(&mut self, command: Motion) {
        let substep_s = self.body.period_s / f64::from(SUBSTEPS);
        let max_change_m_s = self.body.max_acceleration_m_s2 * substep_s;
        let before_m_s = self.speed_m_s;
        let change_m_s = (command.speed_m_s - before_m_s).clamp(-max_change_m_s, max_change_m_s);
        self.speed_m_s += change_m_s;
        let change_s = change_m_s.abs() / self.body.max_acceleration_m_s2;
        let distance_m = self.speed_m_s * substep_s - change_m_s * change_s / 2.0;
        let turned_rad = command.turn_rate_rad_s * substep_s;
        let way = direction(self.heading_rad + turned_rad / 2.0).times(distance_m);
        self.at = self.at.plus(way);
        self.heading_rad = wrapped(self.heading_rad + turned_rad);
        self.moved_m += distance_m;
        self.turned_rad += turned_rad;
    }
}

/// Robots at random positions around the origin, of the given kinds in turn, none too near to
/// another.
fn crowd(random: &mut Stream, bodies: &[Body], count: usize) -> Vec<TestRobot> {
    let mut crowd: Vec<TestRobot> = Vec::new();
    let mut radius_m = 1.0;
    while crowd.len() < count {
        radius_m *= 1.01;
        let kind = crowd.len() % bodies.len();
        let at = direction(TAU * unit(random)).times(radius_m * unit(random));
        let is_free = |other: &TestRobot| {
            let min_m = other.body.radius_m + bodies[kind].radius_m + 2.0 * CLEARANCE_M;
            other.at.to(at).length() > min_m
        };
        if crowd.iter().all(is_free) {
            let heading_rad = PI * (2.0 * unit(random) - 1.0);
            crowd.push(TestRobot::new(bodies[kind].clone(), at, heading_rad));
        }
    }
    crowd
}

fn min_gap_m(crowd: &[TestRobot]) -> f64 {
    let mut min_m = f64::INFINITY;
    for (number, one) in crowd.iter().enumerate() {
        for other in &crowd[..number] {
            let apart_m = one.at.to(other.at).length();
            min_m = min_m.min(apart_m - one.body.radius_m - other.body.radius_m);
        }
    }
    min_m
}

/// Simulates some steps; returns the minimum gap between two robots, and the distance that all of
/// them travelled.
fn simulate(crowd: &mut [TestRobot], random: &mut Stream, steps: u32) -> (f64, f64) {
    let (mut min_m, mut travelled_m) = (f64::INFINITY, 0.0);
    for _ in 0..steps {
        let kinds = crowd[0].body.others.len();
        let kind = |number| u8::try_from(number % kinds).unwrap();
        let numbered = crowd.iter().enumerate();
        let positions: Vec<(u8, Point)> = numbered.map(|(n, one)| (kind(n), one.at)).collect();
        let mut decide = |(own, one): (usize, &mut TestRobot)| {
            let wanted = one.wanted(random);
            let percept = one.percept(own, &positions);
            one.decide(&percept, wanted)
        };
        let commands: Vec<Motion> = crowd.iter_mut().enumerate().map(&mut decide).collect();
        crowd.iter_mut().for_each(TestRobot::begin_step);
        for _ in 0..SUBSTEPS {
            let all = crowd.iter_mut().zip(&commands);
            all.for_each(|(one, command)| one.advance(*command));
            min_m = min_m.min(min_gap_m(crowd));
        }
        travelled_m += crowd.iter().map(|one| one.moved_m.abs()).sum::<f64>();
    }
    (min_m, travelled_m)
}

fn bodies(numbers: &[[f64; 5]]) -> Vec<Body> {
    let bodies: Vec<Body> = numbers
        .iter()
        .map(|[radius_m, speed, acceleration, turn, back]| Body {
            radius_m: *radius_m,
            max_speed_m_s: *speed,
            max_reverse_speed_m_s: back * speed,
            max_acceleration_m_s2: *acceleration,
            max_turn_rate_rad_s: *turn,
            ..rover()
        })
        .collect();
    let other = |body: &Body| Other {
        radius_m: body.radius_m,
        max_acceleration_m_s2: body.max_acceleration_m_s2,
        is_in_the_way: true,
        detectors: Vec::new(),
    };
    let others: Vec<Other> = bodies.iter().map(other).collect();
    let with_others = |body: Body| Body {
        others: others.clone(),
        ..body
    };
    bodies.into_iter().map(with_others).collect()
}

/// Small and large, slow and fast bodies, with weak brakes and with instant stops.
fn any_body() -> impl Strategy<Value = [f64; 5]> {
    let acceleration = prop_oneof![3 => 0.5_f64..4.0, 1 => Just(f64::INFINITY)];
    let back = prop_oneof![Just(0.0), Just(1.0)];
    (0.1_f64..0.5, 0.3_f64..3.0, acceleration, 0.2_f64..3.0, back).prop_map(
        |(radius, speed, acceleration, turn, back)| [radius, speed, acceleration, turn, back],
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn robots_that_follow_the_rule_never_touch_whatever_they_want(
        seed: u64, count in 2_usize..25, kinds in proptest::collection::vec(any_body(), 1..3),
    ) {
        let mut random = random(seed);
        let mut crowd = crowd(&mut random, &bodies(&kinds), count);
        let (min_m, _) = simulate(&mut crowd, &mut random, 300);
        prop_assert!(min_m > 0.0, "{min_m}");
    }

    #[test]
    fn robots_that_are_too_near_already_do_not_come_nearer(seed: u64, overlap_m in 0.01_f64..0.3) {
        let mut random = random(seed);
        let bodies = bodies(&[[0.25, 1.0, 1.0, 1.5, 0.0]]);
        let place = |x| Point { x, y: 0.0 };
        let mut pair: Vec<TestRobot> = [0.0, 0.5 - overlap_m]
            .map(|x| TestRobot::new(bodies[0].clone(), place(x), TAU * unit(&mut random)))
            .into();
        let (min_m, _) = simulate(&mut pair, &mut random, 200);
        prop_assert!(min_m > -overlap_m - 1e-3, "{min_m}");
    }
}

fn random(seed: u64) -> Stream {
    stream(seed, 0, Entity { kind: 0, index: 0 }, Purpose::Start)
}

/// The mean speed of six robots that see each other late by a number of steps.
fn mean_speed_m_s(latency: u32) -> f64 {
    let mut random = random(7);
    let mut crowd = crowd(&mut random, &bodies(&[[0.25, 1.0, 1.0, 1.5, 0.0]]), 6);
    for one in &mut crowd {
        one.latency = latency;
    }
    let (_, travelled_m) = simulate(&mut crowd, &mut random, 600);
    travelled_m / (6.0 * 60.0)
}

/// Measured, not proven: fast robots with a large latency may touch.
#[test]
fn robots_that_see_each_other_late_do_not_touch() {
    for (latency, max_speed_m_s) in [(1, 2.0), (3, 1.0), (3, 2.0), (5, 1.0), (9, 1.0)] {
        for seed in 0..15 {
            let mut random = random(seed);
            let mut crowd = crowd(
                &mut random,
                &bodies(&[[0.25, max_speed_m_s, 1.0, 1.5, 0.0]]),
                6,
            );
            for one in &mut crowd {
                one.latency = latency;
            }
            let (min_m, _) = simulate(&mut crowd, &mut random, 300);
            assert!(min_m > 0.0, "{latency} {max_speed_m_s} {seed}: {min_m}");
        }
    }
}

#[test]
fn robots_still_make_progress() {
    // Many of them want to be at the centre; each alone would move at half its maximum speed.
    assert!(mean_speed_m_s(0) > 0.15);
    assert!(mean_speed_m_s(3) > 0.05);
}

fn mover(at: [f64; 2], velocity_m_s: [f64; 2]) -> Mover {
    Mover {
        id: None,
        at: at.into(),
        velocity_m_s: velocity_m_s.into(),
        course: Point::default(),
        radius_m: 0.25,
        braking_m_s2: 1.0,
        age_s: 0.0,
        observations: 2,
        ..Mover::default()
    }
}

fn limited(movers: &[Mover], wanted: [f64; 2], current_speed_m_s: f64) -> [f64; 2] {
    let mut traffic = Traffic::default();
    traffic.update(
        movers,
        &rover(),
        &odometry(&rover(), current_speed_m_s, 0.0),
    );
    let wanted = Motion {
        speed_m_s: wanted[0],
        turn_rate_rad_s: wanted[1],
    };
    let motion = traffic.limit(wanted, &rover(), current_speed_m_s);
    [motion.speed_m_s, motion.turn_rate_rad_s]
}

#[test]
#[expect(clippy::float_cmp, reason = "exact by construction")]
fn a_robot_that_stands_in_a_crowd_may_turn_but_not_move() {
    let crowd = [0, 1, 2, 3, 4, 5].map(|sixth| {
        let at = direction(f64::from(sixth) * TAU / 6.0).times(0.51);
        mover([at.x, at.y], [0.0, 0.0])
    });
    assert_eq!(limited(&crowd, [1.0, 1.5], 0.0), [0.0, 1.5]);
    // Even if another robot approaches fast.
    let approaching = [mover([-1.0, 0.0], [3.0, 0.0])];
    assert_eq!(limited(&approaching, [0.0, 1.5], 0.0), [0.0, 1.5]);
    assert_eq!(limited(&approaching, [1.0, 1.5], 0.0), [0.0, 1.5]);
}

#[test]
#[expect(clippy::float_cmp, reason = "exact by construction")]
fn robots_brake_straight_ahead_when_their_stopping_paths_cross() {
    let crossing = [mover([0.4, -0.5], [0.0, 2.0])];
    assert_eq!(limited(&crossing, [1.0, 1.0], 1.0), [0.0, 0.0]);
}

#[test]
#[expect(clippy::float_cmp, reason = "exact by construction")]
fn robots_that_move_away_or_are_far_away_do_not_matter() {
    for far in [
        mover([-1.0, 0.0], [-1.0, 0.0]),
        mover([5.0, 0.0], [-1.0, 0.0]),
    ] {
        assert_eq!(limited(&[far], [1.0, 0.5], 1.0), [1.0, 0.5]);
    }
}
