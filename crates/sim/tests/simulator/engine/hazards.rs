//! Items that destroy robots.

use super::acts::{LANE, OAV, UGV, act};
use crate::common::{go, read, scenario, start, step_with, with};
use base::engine::{BlockOptions, Runner};
use base::geometry::Point;
use brain::{ActKind, Command};
use sim::judge::events::EventKind;
use sim::run::Status;
use sim::runner::Runs;
use sim::simulation::Simulation;

/// The lane with a dangerous mine, 1 m in front of the robot on the ground.
fn lane(hazard: &str) -> String {
    let changes = format!(
        "items.mine.hazard = {{ {hazard} }}\nrobots.oav.start.at_m = [[4, 5.6]]\n\
         robots.ugv.start.heading_deg = [0]"
    );
    with(LANE, &changes)
}

/// Drives both robots past the mine, the one on the ground over it.
fn drive(simulation: &mut Simulation, steps: u32) {
    for _ in 0..steps {
        step_with(simulation, [(OAV, go(1.0, 0.0)), (UGV, go(1.0, 0.0))]);
    }
}

fn status(simulation: &Simulation, robot: usize) -> Status {
    let robots = simulation.state().each_robot(simulation.scenario());
    robots.map(|robot| robot.status).nth(robot).unwrap()
}

#[test]
fn a_robot_on_the_ground_that_comes_near_enough_is_destroyed_with_the_mine() {
    let mut simulation = start(&lane("radius_m = 0.25"));
    let reader = simulation.event_reader();
    // Its footprint is 0.2 m from the mine when it is at 4.5.
    drive(&mut simulation, 4);
    assert_eq!(status(&simulation, 1), Status::Active);
    drive(&mut simulation, 16);
    assert_eq!(
        [status(&simulation, 0), status(&simulation, 1)],
        [Status::Active, Status::Broken]
    );
    let events = reader.drain().into_iter().flat_map(|(_, events)| events);
    let destroyed = events.filter(|event| matches!(event.kind, EventKind::Destroyed { .. }));
    let (robot, item) = (UGV, (0, 0));
    let destroyed: Vec<_> = destroyed.map(|event| (event.tick, event.kind)).collect();
    assert_eq!(destroyed, [(4, EventKind::Destroyed { robot, item })]);
    let outcome = simulation.outcome();
    let acts = outcome.acts.unwrap();
    assert_eq!((acts.robots_lost, acts.left, acts.neutralised), (1, 0, 0));
    assert_eq!(
        (outcome.robots_stopped, outcome.has_failed, outcome.time_s),
        (1, false, 0.4)
    );
}

#[test]
fn a_mine_that_does_not_detonate_is_left() {
    let mut simulation = start(&lane("radius_m = 0.2, detonates = false"));
    drive(&mut simulation, 20);
    let acts = simulation.outcome().acts.unwrap();
    assert_eq!((acts.robots_lost, acts.left), (1, 1));
}

#[test]
fn a_mine_that_was_isolated_is_still_a_danger_and_one_that_was_neutralised_is_none() {
    for (kind, status_then) in [
        (ActKind::Isolate, Status::Broken),
        (ActKind::Neutralise, Status::Active),
    ] {
        let mut simulation = start(&lane("radius_m = 0.2"));
        for _ in 0..10 {
            step_with(
                &mut simulation,
                [(UGV, act(kind, Point { x: 5.0, y: 5.0 }))],
            );
        }
        drive(&mut simulation, 20);
        assert_eq!(status(&simulation, 1), status_then, "{kind:?}");
    }
}

/// Of 600 robots that a mine destroys with probability 0.4, the number that is destroyed is within 4 standard deviations
/// of 240 with a probability above 0.9999; the seed is fixed. A robot that stays near is not drawn for again.
#[test]
fn a_mine_destroys_each_robot_once_with_its_probability() {
    let scenario = scenario(&lane("radius_m = 0.5, destroy_probability = 0.4"));
    let mut lost = 0;
    for run in 0..600 {
        let mut simulation = Simulation::new(scenario.clone(), 9, run).unwrap();
        drive(&mut simulation, 5);
        let before = simulation.outcome().acts.unwrap().robots_lost;
        for _ in 0..50 {
            step_with(&mut simulation, [(UGV, Command::default())]);
        }
        lost += simulation.outcome().acts.unwrap().robots_lost;
        assert_eq!(simulation.outcome().acts.unwrap().robots_lost, before);
    }
    let sd = (600.0_f64 * 0.4 * 0.6).sqrt();
    assert!((f64::from(lost) - 240.0).abs() < 4.0 * sd, "{lost}");
}

#[test]
fn columns_of_acts_exist_only_where_anything_can_happen_to_items_and_are_bounded() {
    let names = |text: &str| {
        let runs = Runs(scenario(text));
        let columns = runs.columns().into_iter();
        columns
            .map(|column| (column.name.into_owned(), column.bounds.max))
            .collect::<Vec<_>>()
    };
    let bounds = names(&lane("radius_m = 0.2"));
    let max = |name: &str| {
        let column = bounds.iter().find(|(column, _)| column == name);
        column.unwrap_or_else(|| panic!("{name}")).1
    };
    for (name, bound) in [
        ("marked", 1.0),
        ("confirmed", 1.0),
        ("neutralised", 1.0),
        ("left", 1.0),
        ("robots_lost", 2.0),
        ("unmarked_from_air", 1.0),
        ("met_unmarked", 1.0),
        ("false_marks", 4800.0),
        ("false_confirmations", 4800.0),
    ] {
        assert_eq!(max(name), Some(bound), "{name}");
    }
    let end = LANE.find("[robots.ugv.tools]").unwrap();
    let plain = LANE[..end]
        .replace("completed_by = \"neutralised\", ", "")
        .replace("tools.mark.range_m = 20\n", "");
    assert!(names(&plain).iter().all(|(name, _)| name != "left"));
    let varied = "study.vary = { \"items.mine.completed_by\" = \"detected,confirmed\" }";
    assert!(
        names(&with(&plain, varied))
            .iter()
            .any(|(name, _)| name == "left")
    );
}

#[test]
fn outcomes_of_runs_with_hazards_are_in_their_columns() {
    let cruise = "robots.ugv.brain.behaviours = [{ kind = \"cruise\" }]";
    let runs = Runs(scenario(&with(&lane("radius_m = 0.2"), cruise)));
    let values = runs.run_block(1, 0..2, BlockOptions::ALONE);
    let columns = runs.columns();
    let value = |name: &str| {
        let place = columns.iter().position(|column| column.name == name);
        values[place.unwrap()][0]
    };
    assert_eq!(
        ["robots_lost", "left", "failed"].map(value),
        [1.0, 0.0, 0.0]
    );
}

#[test]
fn a_hazard_has_a_radius_and_a_probability() {
    for (hazard, path) in [
        ("destroy_probability = 0.5", "items.mine.hazard.radius_m"),
        (
            "radius_m = 1, destroy_probability = 1.5",
            "items.mine.hazard.destroy_probability",
        ),
        ("radius_m = -1", "items.mine.hazard.radius_m"),
    ] {
        let errors = read(&lane(hazard)).unwrap_err().to_string();
        assert!(errors.contains(path), "{errors}");
    }
}
