//! Events of goals, controllers and lanes.

use super::clearance::LANE;
use crate::common::start;
use brain::{AgentId, GoalId, MarkVerdict};
use sim::judge::events::{EventKind, EventReader};
use sim::run::{Controller, Goal};
use sim::simulation::Simulation;
use std::collections::BTreeMap;

/// Goals that are served, that arrive later, that no robot can serve, and that expire; one of two controllers fails.
const GOALS: &str = r#"
clock.time_limit_s = 100
world.size_m = [40, 20]
controllers.base = { start.at_m = [[5, 5], [6, 5]], radio.range_m = 80, mean_time_between_failures_s = 40 }
goals.heavy = { placement.at_m = [[34, 5]], requires = "lift", owner = "base" }
goals.late = { placement.at_m = [[39, 19]], deadline_s = 3 }
goals.near = { placement.at_m = [[10, 10], [13, 10]], every_s = 2 }
[robots.lifter]
failed = [0]
capabilities = ["lift"]
start.at_m = [[2, 2]]
radio.range_m = 80
sensors.gps = { kind = "position" }
sensors.compass = { kind = "heading" }
brain.arbitration.kind = "goals"
brain.behaviours = [{ kind = "serve" }]
[robots.rover]
start = { at_m = [[10, 12], [12, 12]], heading_deg = [0, 0] }
radius_m = 0.3
drive = { max_speed_m_s = 1, max_turn_rate_deg_s = 90 }
radio.range_m = 80
sensors.gps = { kind = "position" }
sensors.compass = { kind = "heading" }
brain.arbitration.kind = "goals"
brain.behaviours = [{ kind = "serve" }]
"#;

fn drained(reader: &EventReader) -> Vec<(u64, EventKind)> {
    let episodes = reader.drain().into_iter();
    let events = episodes.flat_map(|(_, events)| events);
    events.map(|event| (event.tick, event.kind)).collect()
}

fn goals(simulation: &Simulation) -> Vec<Goal> {
    let state = simulation.state();
    state.each_goal(simulation.scenario()).collect()
}

/// The robot to which each controller has awarded each of its goals.
fn awarded(simulation: &Simulation) -> BTreeMap<(AgentId, GoalId), AgentId> {
    let of = |controller: Controller| {
        let goals = controller.goals.into_iter();
        let by = controller.id;
        goals.filter_map(move |goal| Some(((by, goal.task.id), goal.assignee?.0)))
    };
    simulation.state().each_controller().flat_map(of).collect()
}

fn working(simulation: &Simulation) -> Vec<AgentId> {
    let working = simulation.state().each_controller();
    let working = working.filter(|each| each.is_working);
    working.map(|each| each.id).collect()
}

#[test]
fn events_of_goals_are_those_that_the_run_knows_of_each() {
    let mut simulation = start(GOALS);
    let reader = simulation.event_reader();
    let before = working(&simulation);
    (0..600).for_each(|_| simulation.step());
    let events = drained(&reader);
    let at = |wanted: EventKind| {
        let all = events.iter().filter(|(_, kind)| *kind == wanted);
        all.map(|(tick, _)| *tick).collect::<Vec<_>>()
    };
    let steps = |time_s: f64| (time_s / simulation.scenario().step_s()).round() as u64;
    for goal in goals(&simulation) {
        let name = (goal.kind, goal.index);
        let issued = goal.issued_s.map(steps);
        assert_eq!(at(EventKind::Issued { goal: name }), Vec::from_iter(issued));
        let expired = at(EventKind::Expired { goal: name });
        assert_eq!(expired.len(), usize::from(goal.has_expired));
        let unserved = |(_, kind): &&(u64, EventKind)| matches!(kind, EventKind::Unserved { goal, .. } if *goal == name);
        let last = events.iter().rfind(unserved).map(|(_, kind)| *kind);
        let reason = goal.unserved;
        assert_eq!(
            last,
            reason.map(|reason| EventKind::Unserved { goal: name, reason })
        );
        let awarded = events.iter().filter(
            |(_, kind)| matches!(kind, EventKind::Awarded { goal, .. } if goal.place == Some(name)),
        );
        assert_eq!(awarded.count() > 0, goal.served_by.is_some());
    }
    assert!(goals(&simulation).iter().any(|goal| goal.has_expired));
    assert!(
        goals(&simulation)
            .iter()
            .any(|goal| goal.unserved.is_some())
    );
    let now = working(&simulation);
    let failed = before.iter().filter(|each| !now.contains(each));
    for &controller in failed.clone() {
        assert_eq!(at(EventKind::Failed { controller }).len(), 1);
    }
    assert!(failed.count() > 0);
    let sent = |about: &str| {
        let of =
            |kind: &EventKind| matches!(kind, EventKind::Sent { about: of, .. } if *of == about);
        events.iter().filter(|(_, kind)| of(kind)).count()
    };
    assert!(sent("award") > 0 && sent("commitment") > 0 && sent("completion") > 0);
}

#[test]
fn each_award_is_an_event_in_the_step_in_which_a_controller_holds_it() {
    let mut simulation = start(LANE);
    let reader = simulation.event_reader();
    let mut before = awarded(&simulation);
    let mut count = 0;
    for _ in 0..600 {
        simulation.step();
        let now = awarded(&simulation);
        let new = now.iter().filter(|(key, to)| before.get(key) != Some(to));
        let new = new
            .map(|((by, id), to)| (*by, *id, *to))
            .collect::<Vec<_>>();
        let events = drained(&reader).into_iter();
        let events = events.filter_map(|(_, kind)| match kind {
            EventKind::Awarded { goal, by, to } => Some((by, goal.id, to)),
            _ => None,
        });
        assert_eq!(events.collect::<Vec<_>>(), new);
        count += new.len();
        before = now;
    }
    assert!(count > 5, "{count}");
}

#[test]
fn events_of_a_lane_are_its_marks_their_verdicts_and_the_statement() {
    let mut simulation = start(LANE);
    let reader = simulation.event_reader();
    simulation.finish();
    let mut marks: BTreeMap<(AgentId, u32), Option<MarkVerdict>> = BTreeMap::new();
    let mut stated = Vec::new();
    for (_, kind) in drained(&reader) {
        match kind {
            EventKind::Marked {
                by,
                number,
                verdict,
            } => {
                marks.insert((by, number), verdict);
            }
            EventKind::Stated { by, is_clear, risk } => stated.push((by, is_clear, risk)),
            _ => {}
        }
    }
    let lane = simulation.state().each_lane().next().unwrap();
    let by = lane.controller;
    let expected = lane
        .marks
        .iter()
        .map(|mark| ((by, mark.number), mark.verdict));
    assert_eq!(marks, expected.collect());
    assert!(marks.len() > 1);
    let statement = lane.statement.unwrap();
    assert_eq!(stated, [(by, statement.is_clear, Some(statement.risk))]);
}

#[test]
fn a_run_that_returns_reports_awards_of_its_new_future_again() {
    let mut simulation = start(LANE);
    let reader = simulation.event_reader();
    (0..100).for_each(|_| simulation.step());
    let state = simulation.state().clone();
    let events = |simulation: &mut Simulation| {
        let _ = drained(&reader);
        (0..300).for_each(|_| simulation.step());
        drained(&reader)
    };
    let first = events(&mut simulation);
    simulation.restore(state);
    assert_eq!(events(&mut simulation), first);
    assert!(
        first
            .iter()
            .any(|(_, kind)| matches!(kind, EventKind::Awarded { .. }))
    );
}

#[test]
fn a_copy_that_stepped_without_readers_reports_only_what_happens_from_then_on() {
    let mut simulation = start(LANE);
    let reader = simulation.event_reader();
    (0..100).for_each(|_| simulation.step());
    let mut copy = simulation.clone();
    (0..300).for_each(|_| copy.step());
    let tick = copy.state().tick();
    simulation.return_to(copy);
    let _ = drained(&reader);
    let before = awarded(&simulation);
    simulation.step();
    let now = awarded(&simulation);
    let new = now.iter().filter(|(key, to)| before.get(key) != Some(to));
    let events = drained(&reader);
    let is_award = |(_, kind): &&(u64, EventKind)| matches!(kind, EventKind::Awarded { .. });
    assert_eq!(events.iter().filter(is_award).count(), new.count());
    assert!(events.iter().all(|(at, _)| *at == tick));
}
