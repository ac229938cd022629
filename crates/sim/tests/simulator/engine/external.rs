//! External bodies: percepts are inputs, and commands are returned to the caller.

use crate::common::{Random, go, id, robots, scenario, start};
use base::geometry::Point;
use brain::{AgentId, Contact, Neighbour, Percept, Reading, Scan};
use sim::bodies::external::ExternalSpec;
use sim::run::Status;
use sim::simulation::{NoRobot, Simulation, StepInputs};
use std::collections::BTreeMap;
use std::sync::Arc;

const FIELD: &str = "
clock.time_limit_s = 1000
world.obstacles = [{ circle = { at_m = [10, 5], radius_m = 1 } }]
items.flag.placement.at_m = [[2, 8], [6, 8.5]]
items.mine.placement.at_m = [[6, 8], [19, 9]]
[robots.rover]
radius_m = 0.4
start = { at_m = [[2, 2], [4, 2], [16, 8]], heading_deg = [0, 90, 45] }
drive = { max_speed_m_s = 2, max_turn_rate_deg_s = 90 }
collision = { max_collisions = 1 }
battery = { capacity_j = 20, idle_w = 10 }
sensors.sonar = { kind = \"range\", rays = 8, range_m = 3 }
sensors.eye = { kind = \"items\", range_m = 1, detection_probability = { flag = 0, mine = 0 } }
";

const OUT: AgentId = AgentId::robot(0, 0);

fn now<T>(value: T) -> Option<Reading<T>> {
    Some(Reading { value, age_s: 0.0 })
}

fn at(x: f64, y: f64) -> Percept {
    Percept {
        position: now(Point { x, y }),
        ..Percept::default()
    }
}

/// A current scan that is equally far in all directions.
fn scans(range_m: f64) -> Vec<Scan> {
    vec![Scan {
        age_s: Some(0.0),
        ranges_m: vec![range_m; 8],
    }]
}

/// External bodies of robots whose readings all come with their percepts.
fn plain<const N: usize>(robots: [AgentId; N]) -> [(AgentId, ExternalSpec); N] {
    robots.map(|robot| (robot, ExternalSpec::default()))
}

fn with(simulation: &mut Simulation, percept: Percept) -> BTreeMap<AgentId, brain::Command> {
    let percepts = BTreeMap::from([(OUT, percept)]);
    simulation.step_with(percepts, BTreeMap::new()).unwrap()
}

#[test]
fn a_body_is_at_the_pose_of_its_last_percept() {
    let mut simulation = start(FIELD);
    let percept = Percept {
        heading_rad: now(7.0),
        ..at(5.5, 6.5)
    };
    with(&mut simulation, percept);
    for _ in 0..10 {
        let robot = robots(&simulation)[0];
        assert_eq!(robot.at, Point { x: 5.5, y: 6.5 });
        assert!((robot.heading_rad - (7.0 - std::f64::consts::TAU)).abs() < 1e-12);
        assert!(robot.is_external);
        assert_eq!((robot.distance_m, robot.speed_m_s), (0.0, 0.0));
        assert_eq!(simulation.percept(OUT).unwrap(), None);
        simulation.step();
    }
    // A missing reading leaves the value unchanged.
    with(
        &mut simulation,
        Percept {
            heading_rad: now(1.0),
            ..Percept::default()
        },
    );
    let robot = robots(&simulation)[0];
    assert_eq!(
        (robot.at, robot.heading_rad),
        (Point { x: 5.5, y: 6.5 }, 1.0)
    );
}

#[test]
fn other_robots_see_a_body_at_its_reported_pose() {
    let mut simulation = start(FIELD);
    let ahead = |simulation: &mut Simulation| {
        let percept = simulation.percept(id(0, 1)).unwrap().unwrap();
        percept.scans[0].ranges_m[0]
    };
    assert_eq!(ahead(&mut simulation), f64::INFINITY);
    // While no other robot moves, neighbour lists stay valid for many steps.
    let still = BTreeMap::from([(id(0, 1), go(0.0, 0.0)), (id(0, 2), go(0.0, 0.0))]);
    for (y, expected) in [(4.0, 1.6), (4.5, 2.1), (9.0, f64::INFINITY), (4.0, 1.6)] {
        let percepts = BTreeMap::from([(OUT, at(4.0, y))]);
        simulation.step_with(percepts, still.clone()).unwrap();
        let found = ahead(&mut simulation);
        assert!(
            found == expected || (found - expected).abs() < 1e-12,
            "{y}: {found}"
        );
    }
}

#[test]
fn commands_equal_those_of_a_brain_with_the_same_percepts() {
    let mut simulation = start(FIELD);
    let shared = Arc::clone(simulation.scenario());
    let mut brain = shared.brain(0).unwrap().clone();
    let mut random = Random::new(3);
    for _ in 0..500 {
        let ranges_m: Vec<f64> = (0..8)
            .map(|_| random.one_of(&[0.5, 0.9, 2.0, f64::INFINITY]))
            .collect();
        let scan = Scan {
            age_s: random.one_of(&[Some(0.0), Some(0.1), None]),
            ranges_m,
        };
        let percept = Percept {
            random_words: [0; 4].map(|_: u32| random.below(u32::MAX)),
            touch: now(random.below(10) == 0),
            scans: vec![scan],
            ..at(5.5, 6.5)
        };
        let expected = brain.step(&percept);
        let answers = with(&mut simulation, percept);
        assert_eq!(answers, BTreeMap::from([(OUT, expected)]));
    }
}

#[test]
fn a_contact_finds_the_nearest_item_of_its_kind_within_a_metre() {
    let contact = |kind: u16, x: f64, y: f64| {
        // From [5, 5], facing along y.
        let (ahead, left) = (y - 5.0, 5.0 - x);
        Contact {
            sensor: 0,
            kind,
            range_m: ahead.hypot(left),
            bearing_rad: libm::atan2(left, ahead),
            age_s: 0.0,
        }
    };
    let found_by = |contacts: &[Contact]| {
        let mut simulation = start(FIELD);
        let percept = Percept {
            heading_rad: now(std::f64::consts::FRAC_PI_2),
            contacts: contacts.to_vec(),
            ..at(5.0, 5.0)
        };
        with(&mut simulation, percept);
        let outcome = simulation.outcome();
        (outcome.found, outcome.false_alarms)
    };
    assert_eq!(found_by(&[contact(1, 6.0, 8.0)]), (vec![0, 1], 0));
    assert_eq!(found_by(&[contact(1, 6.0, 8.99)]), (vec![0, 1], 0));
    assert_eq!(found_by(&[contact(1, 6.0, 9.01)]), (vec![0, 0], 1));
    // A flag is nearer to that position than the mine.
    assert_eq!(found_by(&[contact(1, 6.0, 8.5)]), (vec![0, 1], 0));
    assert_eq!(found_by(&[contact(0, 6.0, 8.1)]), (vec![1, 0], 0));
    assert_eq!(found_by(&[contact(7, 6.0, 8.0)]), (vec![0, 0], 1));
    let all = [
        contact(0, 2.0, 8.0),
        contact(0, 6.0, 8.5),
        contact(1, 3.0, 3.0),
    ];
    assert_eq!(found_by(&all), (vec![2, 0], 1));
}

#[test]
fn a_percept_for_an_unknown_robot_is_an_error_without_effect() {
    let mut simulation = start(FIELD);
    let hash = simulation.state().hash();
    let unknown = id(0, 3);
    let percepts = BTreeMap::from([(OUT, at(1.0, 1.0)), (unknown, Percept::default())]);
    let refused = simulation.step_with(percepts, BTreeMap::new());
    assert_eq!(refused.unwrap_err(), NoRobot(unknown));
    let commands = BTreeMap::from([(unknown, go(1.0, 0.0))]);
    let percepts = BTreeMap::from([(OUT, at(1.0, 1.0))]);
    assert_eq!(
        simulation.step_with(percepts, commands).unwrap_err(),
        NoRobot(unknown)
    );
    assert_eq!(simulation.percept(unknown).unwrap_err(), NoRobot(unknown));
    assert_eq!(simulation.state().hash(), hash);
    assert!(!robots(&simulation)[0].is_external);
}

/// An external body reports its own battery and damage.
#[test]
fn simulated_collisions_and_energy_do_not_stop_an_external_body() {
    let mut simulation = start(FIELD);
    with(&mut simulation, at(2.0, 2.0));
    let into = BTreeMap::from([(id(0, 1), go(2.0, 0.0))]);
    // The second robot faces along y, collides with the body in front of it, and breaks.
    let percepts = BTreeMap::from([(OUT, at(4.0, 3.0))]);
    simulation.step_with(percepts, into.clone()).unwrap();
    simulation
        .step_with(BTreeMap::from([(OUT, at(4.0, 3.0))]), into)
        .unwrap();
    assert_eq!(robots(&simulation)[1].status, Status::Broken);
    assert!(simulation.outcome().collisions >= 1);
    // In the simulation its battery would be empty after two seconds.
    for _ in 0..40 {
        let answers = with(&mut simulation, at(4.0, 3.0));
        assert_eq!(answers.len(), 1);
    }
    let body = robots(&simulation)[0];
    assert_eq!((body.status, body.energy_j), (Status::Active, 0.0));
    assert_eq!(robots(&simulation)[2].status, Status::Empty);
}

#[test]
fn a_declared_body_stands_where_it_starts_until_its_first_percept() {
    let declared = start(FIELD).with_external(plain([OUT])).unwrap();
    let mut simulation = declared.clone();
    assert_ne!(simulation.state().hash(), start(FIELD).state().hash());
    let there = robots(&simulation)[0].at;
    for _ in 0..10 {
        assert_eq!(simulation.percept(OUT).unwrap(), None);
        simulation.step();
        let robot = robots(&simulation)[0];
        assert!(robot.is_external && robot.at == there && robot.energy_j == 0.0);
    }
    // Another robot would have moved.
    assert_ne!(robots(&simulation)[2].at, robots(&start(FIELD))[2].at);
    with(&mut simulation, at(5.5, 6.5));
    assert_eq!(robots(&simulation)[0].at, Point { x: 5.5, y: 6.5 });
}

#[test]
fn a_body_that_is_declared_external_acts_like_one_that_becomes_external() {
    let mut becomes = start(FIELD);
    let mut declared = start(FIELD).with_external(plain([OUT])).unwrap();
    for step in 0..50 {
        let percept = at(2.0 + f64::from(step) / 10.0, 6.5);
        assert_eq!(
            with(&mut becomes, percept.clone()),
            with(&mut declared, percept)
        );
        assert_eq!(becomes.state().hash(), declared.state().hash());
    }
}

#[test]
fn an_unknown_robot_cannot_be_declared_external() {
    let refused = start(FIELD).with_external(plain([OUT, id(0, 3)]));
    assert_eq!(refused.unwrap_err(), NoRobot(id(0, 3)));
}

#[test]
fn a_percept_that_is_not_later_than_the_one_before_repeats_the_motion_and_nothing_else() {
    let mut simulation = start(FIELD);
    let percept = Percept {
        time_s: Some(3.0),
        scans: scans(f64::INFINITY),
        ..at(2.0, 2.0)
    };
    let first = with(&mut simulation, percept.clone());
    assert!(first[&OUT].motion.speed_m_s > 0.0);
    // Elsewhere, near an obstacle, and its detector reports an item where there is none.
    let late = Percept {
        scans: scans(0.45),
        contacts: vec![Contact {
            sensor: 0,
            kind: 0,
            range_m: 0.5,
            bearing_rad: 0.0,
            age_s: 0.0,
        }],
        position: now(Point { x: 9.0, y: 2.0 }),
        ..percept
    };
    for time_s in [3.0, 2.0, f64::NAN] {
        let late = Percept {
            time_s: Some(time_s),
            ..late.clone()
        };
        let answers = with(&mut simulation, late);
        let repeated = go(
            first[&OUT].motion.speed_m_s,
            first[&OUT].motion.turn_rate_rad_s,
        );
        assert_eq!(answers, BTreeMap::from([(OUT, repeated)]));
        assert_eq!(robots(&simulation)[0].at, Point { x: 2.0, y: 2.0 });
        assert_eq!(simulation.outcome().false_alarms, 0);
    }
    let next = Percept {
        time_s: Some(3.1),
        ..late
    };
    assert_ne!(with(&mut simulation, next), first);
    assert_eq!(robots(&simulation)[0].at, Point { x: 9.0, y: 2.0 });
    assert_eq!(simulation.outcome().false_alarms, 1);
}

#[test]
fn a_percept_of_a_step_that_was_not_finished_can_be_given_again() {
    let mut simulation = start(FIELD);
    let percepts = || {
        let percept = Percept {
            time_s: Some(3.0),
            scans: scans(f64::INFINITY),
            ..at(2.0, 2.0)
        };
        BTreeMap::from([(OUT, percept)])
    };
    let inputs = StepInputs {
        percepts: percepts(),
        ..StepInputs::default()
    };
    let begun = simulation.begin_step(inputs, &[]);
    drop(begun.unwrap());
    let mut at_once = start(FIELD);
    let command = at_once.step_with(percepts(), BTreeMap::new()).unwrap();
    assert_ne!(command[&OUT], go(0.0, 0.0));
    assert_eq!(
        simulation.step_with(percepts(), BTreeMap::new()).unwrap(),
        command
    );
}

#[test]
fn a_change_keeps_external_bodies() {
    let mut simulation = start(FIELD).with_external(plain([OUT])).unwrap();
    simulation.step();
    let before = simulation.state().clone();
    simulation
        .change(scenario(&crate::common::with(
            FIELD,
            "robots.rover.count = 2",
        )))
        .unwrap();
    let external: Vec<bool> = robots(&simulation)
        .iter()
        .map(|robot| robot.is_external)
        .collect();
    assert_eq!(external, [true, false]);
    simulation.change(scenario(FIELD)).unwrap();
    simulation.restore(before.clone());
    assert_eq!(simulation.state().hash(), before.hash());
    assert!(robots(&simulation)[0].is_external);
}

fn absurd(random: &mut Random) -> f64 {
    let values = [
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        1e300,
        -1e300,
        -1.0,
        0.0,
        1e-300,
        3.0,
    ];
    random.one_of(&values)
}

#[test]
fn absurd_percepts_are_handled() {
    for seed in 0..40 {
        let mut random = Random::new(seed);
        let mut simulation = Simulation::new(scenario(FIELD), seed, 0).unwrap();
        for _ in 0..40 {
            let mut number = || absurd(&mut random);
            let percept = Percept {
                time_s: Some(number()),
                position: now(Point {
                    x: number(),
                    y: number(),
                }),
                heading_rad: now(number()),
                motion: Some(Reading {
                    value: crate::common::motion(number(), number()),
                    age_s: number(),
                }),
                battery: now(number()),
                touch: Some(Reading {
                    value: true,
                    age_s: number(),
                }),
                scans: vec![
                    Scan {
                        age_s: Some(number()),
                        ranges_m: vec![number(), number()],
                    },
                    Scan {
                        age_s: Some(0.0),
                        ranges_m: vec![number(); 8],
                    },
                ],
                contacts: vec![
                    Contact {
                        sensor: 0,
                        kind: 1,
                        range_m: number(),
                        bearing_rad: number(),
                        age_s: number()
                    };
                    3
                ],
                neighbours: vec![Neighbour {
                    range_m: number(),
                    course_rad: None,
                    bearing_rad: number(),
                    age_s: 0.0,
                    uncertainty_m: 0.0,
                    id: id(9, 9),
                }],
                ..Percept::default()
            };
            let mut commands = BTreeMap::new();
            commands.insert(id(0, 1), go(number(), number()));
            let answers = simulation
                .step_with(BTreeMap::from([(OUT, percept)]), commands)
                .unwrap();
            assert!(answers.values().all(|command| {
                command.motion.speed_m_s.abs() <= 2.0 && command.motion.turn_rate_rad_s.abs() < 1.6
            }));
            for robot in robots(&simulation) {
                assert!(robot.at.x.is_finite() && robot.at.y.is_finite());
                assert!(robot.heading_rad.abs() <= 3.15, "{robot:?}");
                assert!(robot.speed_m_s.abs() <= 2.0 && robot.energy_j <= 20.0);
            }
            let _ = simulation.percept(id(0, 2)).unwrap();
        }
        assert!(simulation.outcome().is_finite());
    }
}

#[test]
fn rays_of_an_external_body_meet_obstacles_and_robots() {
    let text = FIELD
        .replace("[4, 2]", "[7.5, 5]")
        .replace("[0, 90, 45]", "[0, 0, 45]");
    let mut simulation = start(&text);
    let ahead_m = |simulation: &mut Simulation| {
        simulation.percept(id(0, 1)).unwrap().unwrap().scans[0].ranges_m[0]
    };
    assert!((ahead_m(&mut simulation) - 1.5).abs() < 1e-12);
    for x in [9.0, 9.3, 9.5, 10.0] {
        let (percepts, commands) = ([(OUT, at(x, 5.0))], [(id(0, 1), go(0.0, 0.0))]);
        simulation
            .step_with(percepts.into(), commands.into())
            .unwrap();
        let nearest_m = f64::min(9.0, x - 0.4) - 7.5;
        assert!((ahead_m(&mut simulation) - nearest_m).abs() < 1e-12, "{x}");
    }
}
