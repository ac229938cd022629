//! Blind robots collide at the rate of molecules of a two-dimensional gas.

use crate::rows::{Row, assert_published, assert_right, assert_wrong};
use crate::setup::{Random, away, partners, robots, run, scenario, step, whole};
use base::document::Value;
use brain::{AgentId, Command};
use sim::run::Robot;
use std::collections::BTreeMap;
use std::f64::consts::PI;

const TEXT: &str = include_str!("../../../../docs/validation/collisions.toml");
const RADIUS_M: f64 = 0.1;
const SPEED_M_S: f64 = 1.0;
const STEP_S: f64 = 0.25;

/// Side of the square of possible disc centres.
const SIDE_M: f64 = 60.0;
const RUNS: u64 = 40;
const STEPS: u32 = 200;

/// The result of a run: contacts per robot and second, and the fraction of time in which robots were
/// free.
struct Gas {
    rate: f64,
    free: f64,
}

fn gas(count: u32, changes: &[(&str, Value)], number: u64) -> Gas {
    let scenario = scenario(
        TEXT,
        &[&[("robots.disc.count", whole(count))], changes].concat(),
    );
    let radius_m = changes.iter().find(|(path, _)| path.ends_with("radius_m"));
    let radius_m = match radius_m {
        Some((_, Value::Float(radius_m))) => *radius_m,
        _ => RADIUS_M,
    };
    let mut simulation = run(&scenario, u64::from(count), number);
    let mut random = Random::of_run(number);
    let mut before = robots(&simulation);
    let mut turned = BTreeMap::new();
    let (mut contacts, mut free_m) = (0, 0.0);
    for _ in 0..STEPS {
        let commands = away(&before, &simulation, radius_m, &mut random);
        step(&mut simulation, commands.clone());
        let now = robots(&simulation);
        contacts += new_contacts(&before, &now, radius_m);
        free_m += gone_free_m(&before, &now, &turned);
        (before, turned) = (now, commands);
    }
    let robot_s = f64::from(count) * f64::from(STEPS) * STEP_S;
    Gas {
        rate: f64::from(contacts) / robot_s,
        free: free_m / (robot_s * SPEED_M_S),
    }
}

/// The total distance of robots in a step, without those that have just turned away from a contact:
/// that contact has not ended, so that touching again in this step does not count as a new one.
fn gone_free_m(before: &[Robot], now: &[Robot], turned: &BTreeMap<AgentId, Command>) -> f64 {
    let pairs = before.iter().zip(now);
    let free = pairs.filter(|(robot, _)| !turned.contains_key(&robot.id));
    free.map(|(before, now)| now.distance_m - before.distance_m)
        .sum()
}

/// Robots that collided with another in a step, both free before. A collision with a robot that is
/// still stopped by an earlier contact does not count as new.
fn new_contacts(before: &[Robot], now: &[Robot], radius_m: f64) -> u32 {
    let pairs = before.iter().zip(now);
    let new = pairs.filter(|(before, now)| now.collisions > before.collisions);
    let new: Vec<Robot> = new.map(|(_, now)| *now).collect();
    let met = new
        .iter()
        .filter(|robot| !partners(&new, robot, radius_m).is_empty());
    u32::try_from(met.count()).unwrap()
}

/// Contacts per robot and second. Two robots touch when their centres are 2R apart, so each sweeps a
/// width of 4R at a mean relative speed of 4/pi times its own, over n - 1 others in the area of
/// centres, during the fraction of time in which both are free.
fn kinetic(count: u32, free: f64) -> f64 {
    let reach_m = 2.0 * RADIUS_M;
    let relative_m_s = 4.0 / PI * SPEED_M_S;
    let others_per_m2 = f64::from(count - 1) / (SIDE_M * SIDE_M);
    let rate = 2.0 * reach_m * relative_m_s * others_per_m2;
    rate * free * free * inside(reach_m) * crowding(count)
}

/// The mean fraction of a circle around a uniform point of the square that is inside the square.
fn inside(radius_m: f64) -> f64 {
    let share = radius_m / SIDE_M;
    1.0 - 4.0 / PI * share + share * share / PI
}

/// The pair correlation of discs at contact, (1 - 7/16 e) / (1 - e)^2, with the fraction e of the
/// area that they cover. D. Henderson, *A simple equation of state for hard discs*, Molecular
/// Physics 30 (1975).
fn crowding(count: u32) -> f64 {
    let covered = f64::from(count) * PI * RADIUS_M * RADIUS_M / (SIDE_M * SIDE_M);
    (1.0 - 7.0 / 16.0 * covered) / ((1.0 - covered) * (1.0 - covered))
}

fn rows(series: &str, counts: &[u32], changes: &[(&str, Value)]) -> Vec<Row> {
    let rows = counts.iter().map(|count| {
        let runs: Vec<Gas> = (0..RUNS)
            .map(|number| gas(*count, changes, number))
            .collect();
        let rates: Vec<f64> = runs.iter().map(|run| run.rate).collect();
        let free: Vec<f64> = runs.iter().map(|run| run.free).collect();
        let free = Row::mean("", 0.0, &free, None).measured;
        Row::mean(
            series,
            f64::from(*count),
            &rates,
            Some(kinetic(*count, free)),
        )
    });
    rows.collect()
}

#[test]
fn blind_robots_collide_at_the_rate_of_molecules_of_a_gas() {
    let counts = [100, 200, 400];
    let mut all = rows("no stop", &counts, &[]);
    let stop = [("robots.disc.collision.stop_duration_s", Value::Float(2.0))];
    all.extend(rows("2 s stop", &counts, &stop));
    assert_published("collisions.csv", &all);
    assert_right(&all);
}

#[test]
fn a_radius_5_percent_smaller_is_detected() {
    let smaller = [("robots.disc.radius_m", Value::Float(0.95 * RADIUS_M))];
    assert_wrong(&rows("no stop", &[400], &smaller));
}
