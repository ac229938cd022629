//! Messages arrive with the stated probability and delay, up to the capacity of a radio.

use crate::rows::{Row, assert_published, assert_right, assert_wrong};
use crate::setup::{circle, places, run, scenario, whole};
use base::document::Value;
use base::geometry::Point;
use brain::{About, AgentId, Command, Message, Provenance, ReceivedMessage, Receiver};
use std::collections::BTreeMap;

const TEXT: &str = include_str!("../../../../docs/validation/radio.toml");
const CALLER: Point = Point { x: 50.0, y: 50.0 };
const DELIVERED: f64 = 0.8;
const MAX_MESSAGES: u32 = 4;
const STEPS: u32 = 4000;

/// Messages of the callers, and changed values of the scenario.
struct Setup {
    changes: Vec<(&'static str, Value)>,
    callers: u32,
    listeners: u32,
    /// Messages per caller and step.
    messages: usize,
    steps: u32,
}

impl Setup {
    /// One caller with one message per step, and one listener 5 m away.
    fn new(changes: Vec<(&'static str, Value)>) -> Self {
        Self {
            changes,
            callers: 1,
            listeners: 1,
            messages: 1,
            steps: STEPS,
        }
    }

    /// The messages that each listener receives.
    fn received(&self) -> Vec<Vec<ReceivedMessage>> {
        let mut simulation = run(&scenario(TEXT, &self.changes), 1, 0);
        let robot = |kind, index| AgentId::robot(kind, index);
        let commands = Command {
            outbox: vec![hello(); self.messages],
            ..Command::default()
        };
        let commands = (0..self.callers).map(|caller| (robot(0, caller), commands.clone()));
        let commands: BTreeMap<AgentId, Command> = commands.collect();
        let mut received = vec![Vec::new(); self.listeners as usize];
        for _ in 0..self.steps {
            for (listener, received) in (0..).zip(&mut received) {
                let percept = simulation.percept(robot(1, listener)).unwrap();
                received.extend(percept.iter().flat_map(|percept| &percept.inbox));
            }
            simulation
                .step_with(BTreeMap::new(), commands.clone())
                .unwrap();
        }
        received
    }

    fn message_count(&self) -> u32 {
        u32::try_from(self.received()[0].len()).unwrap()
    }
}

fn hello() -> Message {
    let about = About::Item {
        kind: 0,
        at: CALLER,
        provenance: Provenance::default(),
        kind_share: None,
    };
    Message {
        to: Receiver::All,
        about,
        confidence: 1.0,
    }
}

/// The share delivered by distance, for a loss probability.
fn by_distance(loss: f64) -> Vec<Row> {
    let distances = [1.0, 3.0, 5.0, 7.0, 9.0, 9.99, 10.01, 12.0, 15.0];
    let listeners = distances.map(|distance_m| Point {
        x: CALLER.x + distance_m,
        ..CALLER
    });
    let changes = vec![
        ("robots.caller.radio.loss_probability", Value::Float(loss)),
        ("robots.listener.count", whole(9)),
        ("robots.listener.start.at_m", places(listeners)),
    ];
    let setup = Setup {
        listeners: 9,
        ..Setup::new(changes)
    };
    let rows = distances
        .iter()
        .zip(setup.received())
        .map(|(distance_m, received)| {
            let expected = if *distance_m <= 10.0 { DELIVERED } else { 0.0 };
            let received = u32::try_from(received.len()).unwrap();
            // Messages of the last step do not arrive within the run.
            Row::share(
                "share delivered",
                *distance_m,
                received,
                STEPS - 1,
                expected,
            )
        });
    rows.collect()
}

/// Messages received per step by the number that a caller sends.
fn by_messages() -> Vec<Row> {
    let rows = (1..=8_u32).map(|messages| {
        let setup = Setup {
            messages: messages as usize,
            ..Setup::new(vec![])
        };
        let sent = messages.min(MAX_MESSAGES);
        let share = Row::share(
            "",
            0.0,
            setup.message_count(),
            sent * (STEPS - 1),
            DELIVERED,
        );
        scaled(&share, "messages of one caller", messages, f64::from(sent))
    });
    rows.collect()
}

/// Messages received per step by the number of callers with one message each; a listener receives
/// at most four of those that arrive.
fn by_callers() -> Vec<Row> {
    let rows = (1..=8_u32).map(|callers| {
        let changes = vec![
            ("robots.caller.count", whole(callers)),
            (
                "robots.caller.start.at_m",
                places(circle(CALLER, 1.0, callers)),
            ),
        ];
        let setup = Setup {
            callers,
            ..Setup::new(changes)
        };
        let (mean, variance) = at_most(MAX_MESSAGES, callers);
        let steps = f64::from(STEPS - 1);
        Row {
            series: "callers of one message".to_owned(),
            x: f64::from(callers),
            measured: f64::from(setup.message_count()) / steps,
            error: (variance / steps).sqrt(),
            expected: Some(mean),
        }
    });
    rows.collect()
}

/// Mean and variance of the minimum of `max` and a binomial number of `of`.
fn at_most(max: u32, of: u32) -> (f64, f64) {
    let power = |base: f64, times: u32| (0..times).map(|_| base).product::<f64>();
    let mut ways = 1.0;
    let (mut mean, mut squares) = (0.0, 0.0);
    for count in 0..=of {
        let probability = ways * power(DELIVERED, count) * power(1.0 - DELIVERED, of - count);
        let received = f64::from(count.min(max));
        mean += probability * received;
        squares += probability * received * received;
        ways = ways * f64::from(of - count) / f64::from(count + 1);
    }
    (mean, squares - mean * mean)
}

fn scaled(share: &Row, series: &str, x: u32, by: f64) -> Row {
    Row {
        series: series.to_owned(),
        x: f64::from(x),
        measured: by * share.measured,
        error: by * share.error,
        expected: share.expected.map(|expected| by * expected),
    }
}

/// Delay from sending to receiving: rounded up to whole steps, and at least one.
fn by_delay() -> Vec<Row> {
    let delays = [
        (0.0, 0.1),
        (0.1, 0.1),
        (0.11, 0.2),
        (0.25, 0.3),
        (0.3, 0.3),
        (0.5, 0.5),
        (0.94, 1.0),
    ];
    let rows = delays.map(|(delay_s, steps_s)| {
        let changes = vec![
            ("robots.caller.radio.loss_probability", Value::Float(0.0)),
            ("robots.caller.radio.delay_s", Value::Float(delay_s)),
        ];
        let setup = Setup {
            steps: 100,
            ..Setup::new(changes)
        };
        let received = &setup.received()[0];
        // All delays are equal up to rounding.
        let is_in_time = |received: &ReceivedMessage| (received.age_s - steps_s).abs() < 1e-12;
        assert!(received.iter().all(is_in_time));
        let age_s = (received[0].age_s * 1e9).round() / 1e9;
        Row::exact("age at receipt", delay_s, age_s, steps_s)
    });
    rows.to_vec()
}

/// A brain at 2 Hz receives messages with an age of the delay plus 0 to 4 steps.
fn by_age() -> Vec<Row> {
    let changes = vec![
        ("robots.caller.radio.loss_probability", Value::Float(0.0)),
        ("robots.caller.radio.delay_s", Value::Float(0.2)),
        ("robots.listener.brain.rate_hz", Value::Float(2.0)),
    ];
    let received = &Setup::new(changes).received()[0];
    let all = u32::try_from(received.len()).unwrap();
    let rows = (2..=6_u32).map(|steps| {
        let age_s = 0.1 * f64::from(steps);
        let has_this_age = |received: &&ReceivedMessage| (received.age_s - age_s).abs() < 1e-9;
        let count = u32::try_from(received.iter().filter(has_this_age).count()).unwrap();
        Row::share("ages at a slow brain", age_s, count, all, 0.2)
    });
    rows.collect()
}

#[test]
fn messages_arrive_with_the_stated_probability_delay_and_maximum_number() {
    let rows = [
        by_distance(0.2),
        by_messages(),
        by_callers(),
        by_delay(),
        by_age(),
    ];
    let rows = rows.concat();
    assert_published("radio.csv", &rows);
    assert_right(&rows);
    let beyond = rows.iter().filter(|row| row.expected == Some(0.0));
    assert!(beyond.clone().count() == 3 && beyond.clone().all(|row| row.measured == 0.0));
}

#[test]
fn a_loss_probability_of_a_quarter_instead_of_a_fifth_is_detected() {
    assert_wrong(&by_distance(0.25));
}
