//! Goals are issued to controllers, and served by robots that report it.

use crate::common::{go, send, start, step_with, with};
use base::geometry::Point;
use brain::{About, AgentId, Command, CommitmentStatus, GoalId, Message, Reason, issuer_of};
use sim::judge::GoalOutcome;
use sim::judge::events::EventKind;
use sim::run::Goal;
use sim::simulation::Simulation;

const TWO: &str = r#"
clock.time_limit_s = 100
world.size_m = [40, 20]
controllers.base = { backup = "none", start.at_m = [[5, 5], [6, 5]], radio.range_m = 50 }
goals.spot = { placement.at_m = [[10, 10], [13, 10], [30, 10]], within_m = 0.5 }
[robots.rover]
start = { at_m = [[10, 10], [12, 12]], heading_deg = [0, 0] }
radio.range_m = 50
brain.behaviours = []
"#;

const ROVER: AgentId = AgentId::robot(0, 0);
const OTHER: AgentId = AgentId::robot(0, 1);

fn goal_id(number: u32) -> GoalId {
    let places = [[10.0, 10.0], [13.0, 10.0], [30.0, 10.0]].map(Point::from);
    GoalId {
        issuer: issuer_of(&places),
        number,
    }
}

fn about(number: u32, status: CommitmentStatus) -> Message {
    Message::to_all(About::Goal {
        id: goal_id(number),
        at: Point::default(),
        status,
    })
}

fn active(number: u32) -> Message {
    about(number, CommitmentStatus::Active)
}

fn done(number: u32) -> Message {
    about(number, CommitmentStatus::Done)
}

fn goals(simulation: &Simulation) -> Vec<Goal> {
    let scenario = simulation.scenario();
    simulation.state().each_goal(scenario).collect()
}

fn outcome(simulation: &Simulation) -> GoalOutcome {
    simulation.outcome().goals.unwrap()
}

/// A step in which the first robot drives and sends.
fn drive(simulation: &mut Simulation, speed_m_s: f64, messages: &[Message]) {
    let command = Command {
        outbox: messages.to_vec(),
        ..go(speed_m_s, 0.0)
    };
    step_with(simulation, [(ROVER, command)]);
}

#[test]
fn goals_are_issued_to_the_controllers_in_turn() {
    let mut simulation = start(TWO);
    simulation.step();
    let controllers: Vec<_> = simulation.state().each_controller().collect();
    let owned = controllers.iter().map(|controller| {
        let goals = controller.goals.iter();
        goals.map(|goal| goal.task.id).collect::<Vec<_>>()
    });
    let owned: Vec<_> = owned.collect();
    assert_eq!(owned, [vec![goal_id(0), goal_id(2)], vec![goal_id(1)]]);
    assert_eq!(controllers[0].id, AgentId::controller(1, 0));
}

/// The controllers of a run in which some have failed from the start.
fn with_failed(failed: &str) -> Simulation {
    let failed = format!("controllers.base.failed = {failed}");
    let mut simulation = start(&with(TWO, &failed));
    simulation.step();
    simulation
}

#[test]
fn a_goal_is_issued_to_a_controller_that_works() {
    let simulation = with_failed("[0]");
    let controllers = simulation.state().each_controller();
    let owned: Vec<usize> = controllers.map(|each| each.goals.len()).collect();
    assert_eq!(owned, [0, 3]);
    assert!(
        goals(&simulation)
            .iter()
            .all(|goal| goal.unserved.is_none())
    );
}

#[test]
fn a_goal_without_a_working_controller_is_reported_as_such() {
    let simulation = with_failed("[0, 1]");
    for goal in goals(&simulation) {
        assert_eq!(goal.unserved, Some(Reason::NoController));
        assert!(goal.issued_s.is_some());
    }
}

#[test]
fn a_goal_goes_to_another_kind_if_no_controller_of_its_own_works() {
    let other = "goals.spot.owner = \"base\"\n\
                 controllers = { base.failed = [0, 1], mast.radio.range_m = 50 }";
    let mut simulation = start(&with(TWO, other));
    simulation.step();
    let controllers = simulation.state().each_controller();
    let owned: Vec<usize> = controllers.map(|each| each.goals.len()).collect();
    assert_eq!(owned, [0, 0, 3]);
}

#[test]
fn a_controller_refuses_goals_beyond_its_maximum() {
    let few = "controllers.base = { count = 1, max_goals = 2 }";
    let mut simulation = start(&with(TWO, few));
    simulation.step();
    assert_eq!(outcome(&simulation).goals_refused, 1);
}

#[test]
fn goals_arrive_by_their_timetable() {
    let timetable = "goals.spot = { arrive_s = 1, every_s = 0.5 }";
    let mut simulation = start(&with(TWO, timetable));
    (0..30).for_each(|_| simulation.step());
    let issued = goals(&simulation)
        .iter()
        .map(|goal| goal.issued_s)
        .collect::<Vec<_>>();
    assert_eq!(issued, [Some(1.0), Some(1.5), Some(2.0)]);
}

#[test]
fn a_goal_is_served_by_a_robot_that_reports_it_where_it_is() {
    let mut simulation = start(TWO);
    drive(&mut simulation, 0.0, &[done(0), done(1)]);
    let served = goals(&simulation)
        .iter()
        .map(|goal| goal.served_by)
        .collect::<Vec<_>>();
    assert_eq!(served, [Some(ROVER), None, None]);
    assert_eq!(outcome(&simulation).served, 1);
}

#[test]
fn a_robot_that_reports_a_service_again_serves_once_and_another_one_serves_twice() {
    let mut simulation = start(TWO);
    for _ in 0..3 {
        drive(&mut simulation, 0.0, &[done(0)]);
    }
    assert_eq!(outcome(&simulation).served_twice, 0);
    // The other one is too far away.
    step_with(&mut simulation, [(OTHER, send(&[done(0)]))]);
    assert_eq!(outcome(&simulation).served_twice, 0);
    let near = "robots.rover.start.at_m = [[10, 10], [10.4, 10]]";
    let mut simulation = start(&with(TWO, near));
    let reader = simulation.event_reader();
    for robot in [ROVER, OTHER, OTHER] {
        step_with(&mut simulation, [(robot, send(&[done(0)]))]);
    }
    let episodes = reader.drain();
    let events = episodes[0].1.iter().map(|event| (event.tick, event.kind));
    let events = events.filter(|(_, kind)| matches!(kind, EventKind::Served { .. }));
    let by = |by| EventKind::Served { goal: (0, 0), by };
    assert_eq!(events.collect::<Vec<_>>(), [(0, by(ROVER)), (1, by(OTHER))]);
    let GoalOutcome {
        served,
        served_twice,
        ..
    } = outcome(&simulation);
    assert_eq!((served, served_twice), (1, 1));
}

#[test]
fn the_parts_of_the_time_of_a_goal_sum_to_its_total() {
    let mut simulation = start(&with(TWO, "goals.spot.service_s = 1"));
    // Waits for 1 s, sets out, stands for 0.5 s, drives 3 m, and serves for 1 s.
    (0..10).for_each(|_| drive(&mut simulation, 0.0, &[]));
    drive(&mut simulation, 0.0, &[active(1)]);
    (0..5).for_each(|_| drive(&mut simulation, 0.0, &[]));
    (0..30).for_each(|_| drive(&mut simulation, 1.0, &[]));
    drive(&mut simulation, 0.0, &[done(1)]);
    assert_eq!(outcome(&simulation).served, 0, "too early");
    (0..10).for_each(|_| drive(&mut simulation, 0.0, &[active(1)]));
    drive(&mut simulation, 0.0, &[done(1)]);
    let outcome = outcome(&simulation);
    let goal = goals(&simulation)[1];
    assert_eq!(outcome.served, 1);
    assert!((outcome.waiting_s - 1.0).abs() < 1e-9, "{outcome:?}");
    assert!((outcome.blocked_s - 0.6).abs() < 1e-9, "{outcome:?}");
    let parts = [
        outcome.waiting_s,
        outcome.travel_s,
        outcome.blocked_s,
        outcome.service_s,
    ];
    let total_s = goal.served_s.unwrap() - goal.issued_s.unwrap();
    assert!(
        (parts.iter().sum::<f64>() - total_s).abs() < 1e-9,
        "{outcome:?}"
    );
    assert!(outcome.service_s >= 1.0, "{outcome:?}");
}

#[test]
fn a_goal_is_not_served_after_its_deadline() {
    let mut simulation = start(&with(TWO, "goals.spot.deadline_s = 1"));
    (0..12).for_each(|_| simulation.step());
    drive(&mut simulation, 0.0, &[done(0)]);
    let GoalOutcome {
        served, expired, ..
    } = outcome(&simulation);
    assert_eq!((served, expired), (0, 3));
}

#[test]
fn a_run_is_complete_when_all_goals_are_served() {
    let mut simulation = start(&with(TWO, "goals.spot.count = 1"));
    simulation.step();
    assert!(!simulation.state().is_over(simulation.scenario()));
    drive(&mut simulation, 0.0, &[done(0)]);
    assert!(simulation.state().is_over(simulation.scenario()));
    assert!(!simulation.outcome().has_failed);
    let mut part = start(&with(TWO, "end.when = \"served >= 1\""));
    drive(&mut part, 0.0, &[done(0)]);
    assert!(part.state().is_over(part.scenario()));
}

#[test]
fn messages_that_a_receiver_has_no_room_for_are_counted() {
    let slow = "controllers.base.count = 0\nrobots.rover.radio.messages_per_step = 3\n\
                [robots.slow]\nstart.at_m = [[3, 3]]\nbrain.behaviours = []\n\
                radio = { range_m = 50, messages_per_step = 1 }";
    let mut simulation = start(&with(TWO, slow));
    drive(&mut simulation, 0.0, &[active(0), active(1), active(2)]);
    let outcome = outcome(&simulation);
    // The other rover receives all, and the slow robot one.
    assert_eq!((outcome.messages_sent, outcome.messages_dropped), (3, 2));
}

#[test]
fn messages_that_a_radio_does_not_send_are_counted_as_dropped() {
    let narrow = "controllers.base.count = 0\nrobots.rover.radio.messages_per_step = 1";
    let mut simulation = start(&with(TWO, narrow));
    drive(&mut simulation, 0.0, &[active(0), active(1), active(2)]);
    let outcome = outcome(&simulation);
    assert_eq!((outcome.messages_sent, outcome.messages_dropped), (1, 2));
}
