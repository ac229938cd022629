//! Vehicles that pass a lane once it has been declared clear.

use super::clearance::LANE;
use crate::common::{scenario, step_with, with};
use brain::{Act, ActKind, AgentId, Command};
use sim::judge::events::EventKind;
use sim::judge::{Outcome, PassageOutcome};
use sim::passage::VehicleStatus;
use sim::simulation::Simulation;

/// The controllers are the third kind of participants.
const STATION: AgentId = AgentId::controller(2, 0);

/// Three vehicles on a path of 3 m: in a lane that is alike everywhere, at y = 10.
const PASSAGE: &str = "
passage = { width_m = 3, vehicles = 3, speed_m_s = 4, gap_m = 10 }
items.clutter.count = 0
";

/// The lane with a passage, and mines at these places with this hazard.
fn with_mines(places: &str, hazard: &str) -> Simulation {
    let count = places.matches('[').count() - 1;
    let mines = format!(
        "items.mine = {{ count = {count}, number = \"fixed\", placement.at_m = {places},
         hazard = {{ radius_m = 0, {hazard} }} }}"
    );
    Simulation::new(scenario(&with(LANE, &format!("{PASSAGE}{mines}"))), 1, 0).unwrap()
}

/// The controller makes a statement in the first step, whatever is known.
fn state(simulation: &mut Simulation, kind: ActKind) {
    let at = base::geometry::Point::default();
    let command = Command {
        acts: vec![Act { kind, at }],
        ..Command::default()
    };
    step_with(simulation, [(STATION, command)]);
}

fn passed(mut simulation: Simulation) -> (PassageOutcome, Outcome) {
    state(&mut simulation, ActKind::DeclareClear);
    let outcome = simulation.finish();
    (outcome.passage.clone().unwrap(), outcome)
}

fn counts(of: &PassageOutcome) -> (u32, u32, u32) {
    (of.passed, of.lost, of.mines_on_path)
}

#[test]
fn vehicles_pass_a_lane_that_is_declared_clear_and_the_run_goes_on_until_they_have() {
    let (passage, outcome) = passed(with_mines("[[20, 5]]", "destroy_probability = 1"));
    assert_eq!(counts(&passage), (3, 0, 0));
    assert!(!passage.first_lost && !passage.last_lost);
    assert!((passage.length_m - 40.0).abs() < 1e-9);
    // 40 m, and two gaps of 10 m, at 4 m/s.
    assert_eq!(passage.passed_s, 15.0);
    // The declaration completes the run, as without vehicles.
    assert!(!outcome.has_failed && outcome.time_s == 0.0);
}

#[test]
fn without_a_declaration_the_passage_is_stated_only() {
    let mut simulation = with_mines("[[20, 10]]", "destroy_probability = 1");
    state(&mut simulation, ActKind::GiveUp);
    let outcome = simulation.finish();
    let passage = outcome.passage.unwrap();
    assert_eq!(counts(&passage), (0, 0, 1));
    // One mine is expected in 12 m; vehicles pass 3 m.
    let risk = 1.0 - (-0.25_f64).exp();
    assert!(
        (passage.first_risk - risk).abs() < 1e-3,
        "{}",
        passage.first_risk
    );
    assert_eq!(
        (passage.passed_s, simulation.state().each_vehicle().count()),
        (300.0, 0)
    );
}

#[test]
fn a_mine_that_detonates_destroys_one_vehicle_and_one_that_does_not_destroys_all() {
    for (detonates, expected) in [(true, (2, 1, 1)), (false, (0, 3, 1))] {
        let hazard = format!("destroy_probability = 1, detonates = {detonates}");
        let mut simulation = with_mines("[[20, 11.4]]", &hazard);
        let reader = simulation.event_reader();
        state(&mut simulation, ActKind::DeclareClear);
        let outcome = simulation.finish();
        let passage = outcome.passage.unwrap();
        assert_eq!(counts(&passage), expected);
        assert!(passage.first_lost);
        let vehicles: Vec<_> = simulation.state().each_vehicle().collect();
        assert_eq!(vehicles[0].status, VehicleStatus::Lost);
        assert!((vehicles[0].at.x - 20.0).abs() < 1e-9, "{:?}", vehicles[0]);
        let events = reader.drain().into_iter().flat_map(|(_, events)| events);
        let lost = events.filter(|event| matches!(event.kind, EventKind::VehicleLost { .. }));
        assert_eq!(lost.count(), expected.1 as usize);
    }
}

#[test]
fn only_mines_within_the_width_and_in_the_lane_destroy_vehicles() {
    // Beside the path, and before and behind the lane, on the path.
    let places = "[[20, 11.6], [20, 8.4], [7.5, 10], [48.5, 10]]";
    let (passage, _) = passed(with_mines(places, "destroy_probability = 1"));
    assert_eq!(counts(&passage), (3, 0, 0));
    let (passage, _) = passed(with_mines("[[8, 10], [48, 10]]", "destroy_probability = 1"));
    assert_eq!(counts(&passage), (1, 2, 2));
}

#[test]
fn each_mine_is_drawn_once_for_each_vehicle() {
    let mut lost = 0;
    for run in 0..100 {
        let text = format!(
            "{PASSAGE}items.mine = {{ count = 1, number = \"fixed\", placement.at_m = [[20, 10]],
             hazard = {{ radius_m = 0, destroy_probability = 0.1 }} }}"
        );
        let simulation = Simulation::new(scenario(&with(LANE, &text)), 1, run).unwrap();
        lost += passed(simulation).0.lost;
    }
    // 1 - 0.9^3 of the runs lose a vehicle: 27.1, with a standard deviation of 4.4.
    assert!((14..=41).contains(&lost), "{lost}");
}

#[test]
fn the_time_limit_ends_a_passage() {
    let text = format!("{PASSAGE}clock.time_limit_s = 10\nitems.mine.hazard.radius_m = 0");
    let simulation = Simulation::new(scenario(&with(LANE, &text)), 1, 3).unwrap();
    let (passage, _) = passed(simulation);
    assert!(passage.passed + passage.lost < 3);
    assert_eq!(passage.passed_s, 10.0);
}

#[test]
fn a_run_with_vehicles_that_continues_with_another_scenario_keeps_them() {
    let mut simulation = with_mines("[[20, 10]]", "destroy_probability = 1");
    state(&mut simulation, ActKind::DeclareClear);
    for _ in 0..30 {
        simulation.step();
    }
    let before: Vec<_> = simulation.state().each_vehicle().collect();
    assert_eq!(before[0].status, VehicleStatus::Lost);
    let same = simulation.scenario().clone();
    simulation.change(same).unwrap();
    let after: Vec<_> = simulation.state().each_vehicle().collect();
    assert_eq!(before, after);
    assert_eq!(counts(&simulation.finish().passage.unwrap()), (2, 1, 1));
}

#[test]
fn what_has_been_stated_of_a_passage_stays() {
    let mines = "items.mine.hazard.radius_m = 0\n";
    let was = scenario(&with(LANE, &format!("{PASSAGE}{mines}")));
    let wider = PASSAGE.replace("width_m = 3, vehicles = 3", "width_m = 4, vehicles = 2");
    let now = scenario(&with(LANE, &format!("{wider}{mines}")));
    let mut simulation = Simulation::new(was.clone(), 1, 3).unwrap();
    let errors = |simulation: &Simulation| simulation.state().without_effect(&was, &now);
    assert_eq!(errors(&simulation).len(), 0);
    state(&mut simulation, ActKind::DeclareClear);
    let errors = errors(&simulation);
    let paths: Vec<&str> = errors.iter().map(|error| error.path.as_str()).collect();
    assert_eq!(paths, ["passage.width_m", "passage.vehicles"]);
}

#[test]
fn controllers_that_clear_a_lane_state_how_much_of_it_is_cleared_and_the_risk_of_vehicles() {
    let text =
        format!("{PASSAGE}items.mine.hazard = {{ radius_m = 0, destroy_probability = 0.8 }}");
    let scenario = scenario(&with(LANE, &text));
    for run in 0..4 {
        let mut simulation = Simulation::new(scenario.clone(), 1, run).unwrap();
        let outcome = simulation.finish();
        let clearance = outcome.clearance.as_ref().unwrap();
        assert!(clearance.is_declared);
        let passage = outcome.passage.as_ref().unwrap();
        assert!(0.0 < passage.first_risk && passage.first_risk < clearance.stated_risk);
        assert!(passage.last_risk < passage.first_risk);
        assert_eq!(passage.passed + passage.lost, 3);
        let [cleared] = outcome.cleared[..] else {
            panic!("one kind of mines: {:?}", outcome.cleared);
        };
        assert!(cleared.low <= cleared.stated && cleared.stated <= cleared.high);
        assert!(cleared.stated > 0.9 && cleared.high == 1.0, "{cleared:?}");
        assert!(!clearance.is_clear || cleared.truth == 1.0);
    }
}
