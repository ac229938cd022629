//! Messages arrive with the stated probability, in time, and as many as a radio takes.

use crate::rows::{Row, assert_published, assert_right, assert_wrong};
use crate::setup::{circle, places, run, scenario, whole};
use base::document::Value;
use base::geometry::Point;
use brain::{About, Command, Message, Provenance, ReceivedMessage, RobotId};
use std::collections::BTreeMap;

const TEXT: &str = include_str!("../../../../docs/validation/radio.toml");
const CALLER: Point = Point { x: 50.0, y: 50.0 };
const DELIVERED: f64 = 0.8;
const MOST: u32 = 4;
const STEPS: u32 = 4000;

/// What callers do, and what of the scenario is another.
struct Air {
    changes: Vec<(&'static str, Value)>,
    callers: u32,
    listeners: u32,
    /// Messages that each caller has in each step.
    messages: usize,
    steps: u32,
}

impl Air {
    /// One caller with one message a step, and one listener 5 m away.
    fn new(changes: Vec<(&'static str, Value)>) -> Self {
        Self {
            changes,
            callers: 1,
            listeners: 1,
            messages: 1,
            steps: STEPS,
        }
    }

    /// What each listener hears, message by message.
    fn heard(&self) -> Vec<Vec<ReceivedMessage>> {
        let mut simulation = run(&scenario(TEXT, &self.changes), 1, 0);
        let robot = |kind, index| RobotId { kind, index };
        let calls = Command {
            outbox: vec![hello(); self.messages],
            ..Command::default()
        };
        let calls = (0..self.callers).map(|caller| (robot(0, caller), calls.clone()));
        let calls: BTreeMap<RobotId, Command> = calls.collect();
        let mut heard = vec![Vec::new(); self.listeners as usize];
        for _ in 0..self.steps {
            for (listener, heard) in (0..).zip(&mut heard) {
                let percept = simulation.percept(robot(1, listener)).unwrap();
                heard.extend(percept.iter().flat_map(|percept| &percept.inbox));
            }
            simulation
                .step_with(BTreeMap::new(), calls.clone())
                .unwrap();
        }
        heard
    }

    fn messages_heard(&self) -> u32 {
        u32::try_from(self.heard()[0].len()).unwrap()
    }
}

fn hello() -> Message {
    let about = About::Item {
        kind: 0,
        at: CALLER,
        provenance: Provenance::default(),
    };
    Message {
        about,
        confidence: 1.0,
    }
}

/// The share delivered by distance, with a loss that may be another than the scenario's.
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
    let air = Air {
        listeners: 9,
        ..Air::new(changes)
    };
    let rows = distances
        .iter()
        .zip(air.heard())
        .map(|(distance_m, heard)| {
            let expected = if *distance_m <= 10.0 { DELIVERED } else { 0.0 };
            let heard = u32::try_from(heard.len()).unwrap();
            // What is sent in the last step is not heard any more.
            Row::share("share delivered", *distance_m, heard, STEPS - 1, expected)
        });
    rows.collect()
}

/// Messages heard in a step, of as many as a caller has.
fn by_messages() -> Vec<Row> {
    let rows = (1..=8_u32).map(|messages| {
        let air = Air {
            messages: messages as usize,
            ..Air::new(vec![])
        };
        let sent = messages.min(MOST);
        let share = Row::share("", 0.0, air.messages_heard(), sent * (STEPS - 1), DELIVERED);
        scaled(&share, "messages of one caller", messages, f64::from(sent))
    });
    rows.collect()
}

/// Messages heard in a step, of one from each of so many callers: at most four of those that arrive.
fn by_callers() -> Vec<Row> {
    let rows = (1..=8_u32).map(|callers| {
        let changes = vec![
            ("robots.caller.count", whole(callers)),
            (
                "robots.caller.start.at_m",
                places(circle(CALLER, 1.0, callers)),
            ),
        ];
        let air = Air {
            callers,
            ..Air::new(changes)
        };
        let (mean, variance) = at_most(MOST, callers);
        let steps = f64::from(STEPS - 1);
        Row {
            series: "callers of one message".to_owned(),
            x: f64::from(callers),
            measured: f64::from(air.messages_heard()) / steps,
            error: (variance / steps).sqrt(),
            expected: Some(mean),
        }
    });
    rows.collect()
}

/// Mean and variance of the lesser of `most` and a binomial number of `of`.
fn at_most(most: u32, of: u32) -> (f64, f64) {
    let power = |base: f64, times: u32| (0..times).map(|_| base).product::<f64>();
    let mut ways = 1.0;
    let (mut mean, mut squares) = (0.0, 0.0);
    for count in 0..=of {
        let probability = ways * power(DELIVERED, count) * power(1.0 - DELIVERED, of - count);
        let heard = f64::from(count.min(most));
        mean += probability * heard;
        squares += probability * heard * heard;
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

/// From sending to hearing: rounded up to whole steps, and one at least.
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
        let air = Air {
            steps: 100,
            ..Air::new(changes)
        };
        let heard = &air.heard()[0];
        // Every message takes as long, but for the rounding of products.
        let is_in_time = |heard: &ReceivedMessage| (heard.age_s - steps_s).abs() < 1e-12;
        assert!(heard.iter().all(is_in_time));
        let age_s = (heard[0].age_s * 1e9).round() / 1e9;
        Row::exact("age when heard", delay_s, age_s, steps_s)
    });
    rows.to_vec()
}

/// A brain that thinks twice a second hears with an age of the delay and 0 to 4 steps more.
fn by_age() -> Vec<Row> {
    let changes = vec![
        ("robots.caller.radio.loss_probability", Value::Float(0.0)),
        ("robots.caller.radio.delay_s", Value::Float(0.2)),
        ("robots.listener.brain.rate_hz", Value::Float(2.0)),
    ];
    let heard = &Air::new(changes).heard()[0];
    let all = u32::try_from(heard.len()).unwrap();
    let rows = (2..=6_u32).map(|steps| {
        let age_s = 0.1 * f64::from(steps);
        let is_so_old = |heard: &&ReceivedMessage| (heard.age_s - age_s).abs() < 1e-9;
        let count = u32::try_from(heard.iter().filter(is_so_old).count()).unwrap();
        Row::share("ages at a slow brain", age_s, count, all, 0.2)
    });
    rows.collect()
}

#[test]
fn messages_arrive_with_the_stated_probability_in_time_and_at_most_so_many() {
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
fn a_loss_of_a_quarter_is_not_one_of_a_fifth() {
    assert_wrong(&by_distance(0.25));
}
