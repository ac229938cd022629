//! No number of looks finds an item to which all sensor models are blind.

use crate::rows::{Row, assert_published, assert_right, assert_wrong};
use crate::setup::{found, run, scenario, whole};
use base::document::Value;
use rayon::prelude::*;

const TEXT: &str = include_str!("../../../../docs/validation/blind-share.toml");

/// Probability of detection per look, and share of the items to which a model is blind.
const DETECTION: f64 = 0.2;
const BLIND: f64 = 0.2;

const ITEMS: u32 = 1000;
const RUNS: u64 = 20;

/// Numbers of looks of each robot at which finds are counted.
const LOOKS: [u16; 6] = [1, 2, 5, 10, 20, 60];

/// The robots that look, and their models.
#[derive(Clone, Copy, PartialEq)]
enum Team {
    One,
    SameModel,
    TwoModels,
}

impl Team {
    fn robots(self) -> i32 {
        if self == Self::One { 1 } else { 2 }
    }

    /// Share of the items that is found after some looks of each robot.
    fn found(self, looks: u16) -> f64 {
        let missed = (1.0 - DETECTION).powi(i32::from(looks));
        match self {
            Self::One => (1.0 - BLIND) * (1.0 - missed),
            Self::SameModel => (1.0 - BLIND) * (1.0 - missed * missed),
            Self::TwoModels => 1.0 - (BLIND + (1.0 - BLIND) * missed).powi(2),
        }
    }
}

/// Items that a team has found after each number of looks.
fn finds(team: Team, number: u64) -> [u32; LOOKS.len()] {
    let second = u32::try_from(team.robots() - 1).unwrap();
    let model = if team == Team::TwoModels {
        "radar"
    } else {
        "magnetometer"
    };
    let changes = [
        ("robots.second.count", whole(second)),
        ("robots.second.sensors.eye.model", Value::Text(model.into())),
    ];
    let mut simulation = run(&scenario(TEXT, &changes), 1, number);
    let mut done = 0;
    LOOKS.map(|looks| {
        (done..looks).for_each(|_| simulation.step());
        done = looks;
        found(&simulation)
    })
}

/// The shares found by a team, and those that `law` expects.
fn rows(series: &str, team: Team, law: impl Fn(u16) -> f64) -> Vec<Row> {
    let finds: Vec<_> = (0..RUNS)
        .into_par_iter()
        .map(|number| finds(team, number))
        .collect();
    let all = ITEMS * u32::try_from(RUNS).unwrap();
    let row = |(place, looks): (usize, &u16)| {
        let found = finds.iter().map(|finds| finds[place]).sum();
        Row::share(series, f64::from(*looks), found, all, law(*looks))
    };
    LOOKS.iter().enumerate().map(row).collect()
}

#[test]
fn the_share_found_has_the_visible_share_as_its_ceiling() {
    let teams = [
        ("one robot", Team::One),
        ("two robots of one model", Team::SameModel),
        ("two robots of two models", Team::TwoModels),
    ];
    let rows = teams.map(|(series, team)| rows(series, team, |looks| team.found(looks)));
    let rows = rows.concat();
    assert_published("blind-share.csv", &rows);
    assert_right(&rows);
    // After 60 looks only the ceilings are left.
    for (place, ceiling) in [(5, 1.0 - BLIND), (17, 1.0 - BLIND * BLIND)] {
        assert!((rows[place].expected.unwrap() - ceiling).abs() < 1e-5);
    }
}

/// The wrong models: blindness drawn for each look, which is a lower probability of detection, and
/// for each robot, though both have the same model.
#[test]
fn blindness_drawn_per_look_or_per_robot_is_detected() {
    let per_look = |looks| 1.0 - (1.0 - (1.0 - BLIND) * DETECTION).powi(i32::from(looks));
    assert_wrong(&rows("", Team::One, per_look));
    assert_wrong(&rows("", Team::SameModel, |looks| {
        Team::TwoModels.found(looks)
    }));
}

#[test]
fn a_blind_share_of_18_instead_of_20_percent_is_detected() {
    let missed = |looks: u16| (1.0 - DETECTION).powi(i32::from(looks));
    let law = |looks| (1.0 - 0.18) * (1.0 - missed(looks));
    assert_wrong(&rows("", Team::One, law));
}
