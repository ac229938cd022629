//! Controllers are agents without a body: they take part in communication, fail, and change in mid-run.

use crate::common::{go, id, message, replaced, robots, scenario, send, start, step_with, with};
use brain::AgentId;
use sim::run::{Controller, Status};
use sim::simulation::Simulation;

const ONE: &str = r#"
clock.time_limit_s = 100
world.size_m = [40, 20]
goals.spot.placement.at_m = [[20, 10], [22, 10], [24, 10], [26, 10]]
[robots.rover]
price = 10
start = { at_m = [[10, 10], [12, 12]], heading_deg = [0, 0] }
radio.range_m = 5
brain.behaviours = []
[controllers.base]
count = 2
backup = "none"
price = 3
start.at_m = [[8, 10], [30, 5], [31, 5]]
radio.range_m = 5
"#;

const ROVER: AgentId = AgentId::robot(0, 0);

fn controllers(simulation: &Simulation) -> Vec<Controller> {
    simulation.state().each_controller().collect()
}

fn owned(simulation: &Simulation) -> Vec<usize> {
    let controllers = controllers(simulation);
    controllers.iter().map(|each| each.goals.len()).collect()
}

#[test]
fn controllers_count_as_no_robots_but_are_paid_for() {
    let simulation = start(ONE);
    assert_eq!(robots(&simulation).len(), 2);
    let runs = sim::runner::Runs(simulation.scenario().clone());
    let columns = base::engine::Runner::columns(&runs);
    let values = runs.values(&simulation.outcome()).unwrap();
    let value = |name: &str| {
        let place = columns.iter().position(|column| column.name == name);
        values[place.unwrap()]
    };
    assert_eq!(
        [value("robots"), value("price"), value("goals")],
        [2.0, 26.0, 4.0]
    );
}

#[test]
fn a_controller_aboard_goes_where_its_robot_goes_and_fails_with_it() {
    let start_m = "start.at_m = [[8, 10], [30, 5], [31, 5]]";
    let text = replaced(ONE, &[(start_m, "aboard = \"rover\"")]);
    let mut simulation = start(&with(&text, "robots.rover.collision.max_collisions = 1"));
    for _ in 0..320 {
        step_with(&mut simulation, [(ROVER, go(1.0, 0.0))]);
        assert_eq!(controllers(&simulation)[0].at, robots(&simulation)[0].at);
    }
    assert_eq!(robots(&simulation)[0].status, Status::Broken);
    let working = controllers(&simulation)
        .iter()
        .map(|each| each.is_working)
        .collect::<Vec<_>>();
    assert_eq!(working, [false, true]);
}

#[test]
fn links_reach_controllers() {
    let mut simulation = start(ONE);
    let links = simulation.links(None, 100).unwrap();
    let links = links
        .iter()
        .map(|link| (link.from, link.to))
        .collect::<Vec<_>>();
    // Robots 0 and 1, then controllers 2 and 3.
    assert_eq!(links, [(0, 1), (0, 2), (1, 2)]);
}

#[test]
fn controllers_fail_at_random_times() {
    let never = start(ONE);
    let failing = "controllers.base.mean_time_between_failures_s = 5\n\
                   robots.rover.mean_time_between_failures_s = 5";
    let mut simulation = start(&with(ONE, failing));
    let mut other = never;
    for _ in 0..1000 {
        simulation.step();
        other.step();
    }
    assert!(controllers(&simulation).iter().all(|each| !each.is_working));
    assert!(
        robots(&simulation)
            .iter()
            .all(|robot| robot.status == Status::Broken)
    );
    assert!(controllers(&other).iter().all(|each| each.is_working));
    assert!(
        robots(&other)
            .iter()
            .all(|robot| robot.status == Status::Active)
    );
}

#[test]
fn robots_and_controllers_that_the_scenario_names_have_failed_for_good() {
    let failed = "controllers.base.failed = [1, 7]\nrobots.rover.failed = [0]";
    let text = with(ONE, failed);
    let failed = |simulation: &Simulation| {
        let robots = robots(simulation);
        let controllers = controllers(simulation);
        let robots = robots.iter().map(|robot| robot.status == Status::Broken);
        let controllers = controllers.iter().map(|each| !each.is_working);
        robots.chain(controllers).collect::<Vec<bool>>()
    };
    assert_eq!(failed(&start(&text)), [true, false, false, true]);
    let mut simulation = start(ONE);
    simulation.step();
    assert_eq!(failed(&simulation), [false; 4]);
    // Nothing is repaired by a change.
    for text in [text.as_str(), ONE] {
        simulation.change(scenario(text)).unwrap();
        simulation.step();
        assert_eq!(failed(&simulation), [true, false, false, true]);
    }
}

#[test]
fn a_command_from_outside_replaces_the_step_of_a_controller() {
    let base = AgentId::controller(1, 0);
    let mut simulation = start(ONE);
    let state = simulation.state().clone();
    let percept = simulation.percept(base).unwrap().unwrap();
    assert_eq!((percept.id, percept.inbox.len()), (base, 2));
    assert_eq!(simulation.state().hash(), state.hash());
    step_with(&mut simulation, [(base, send(&[message(1.0)]))]);
    assert_eq!(owned(&simulation), [0, 2]);
    simulation.step();
    let perceived = simulation.percept(ROVER).unwrap().unwrap();
    assert!(perceived.inbox.iter().all(|received| received.from == base));
    assert!(simulation.percept(AgentId::controller(1, 2)).is_err());
}

#[test]
fn controllers_keep_their_goals_when_others_are_added_or_removed() {
    let mut simulation = start(ONE);
    (0..5).for_each(|_| simulation.step());
    assert_eq!(owned(&simulation), [2, 2]);
    let more = with(ONE, "controllers.base.count = 3");
    simulation.change(scenario(&more)).unwrap();
    simulation.step();
    assert_eq!(owned(&simulation), [2, 2, 0]);
    // Goals of a controller that is removed are issued to those that stay.
    let fewer = with(ONE, "controllers.base.count = 1");
    simulation.change(scenario(&fewer)).unwrap();
    simulation.step();
    assert_eq!(owned(&simulation), [4]);
    let none = with(ONE, "controllers.base.count = 0");
    simulation.change(scenario(&none)).unwrap();
    simulation.step();
    simulation.change(scenario(ONE)).unwrap();
    simulation.step();
    assert_eq!(owned(&simulation), [2, 2]);
}

/// Controllers in range of each other that vote for owners, and goals that no robot serves.
const MAJORITY: &str = "
clock.time_limit_s = 200
world.size_m = [40, 20]
goals.spot.placement.at_m = [[20, 10], [22, 10], [24, 10], [26, 10]]
robots.rover = { start.at_m = [[10, 10]], radio.range_m = 50, brain.behaviours = [] }
controllers.base = { start.at_m = [[8, 10], [30, 5], [31, 5], [9, 9], [7, 7]], radio.range_m = 50 }
";

/// The goals that are owned a time after the number of controllers has changed.
fn owned_after(counts: [u32; 2], time_s: f64) -> Vec<usize> {
    let text = |count: u32| with(MAJORITY, &format!("controllers.base.count = {count}"));
    let mut simulation = start(&text(counts[0]));
    (0..50).for_each(|_| simulation.step());
    assert_eq!(owned(&simulation).iter().sum::<usize>(), 4, "{counts:?}");
    simulation.change(scenario(&text(counts[1]))).unwrap();
    let end_s = simulation.time_s() + time_s;
    while simulation.time_s() < end_s {
        simulation.step();
    }
    owned(&simulation)
}

#[test]
fn each_goal_has_an_owner_after_the_number_of_controllers_has_changed() {
    for counts in [[1, 3], [2, 3], [3, 5], [3, 4], [1, 5]] {
        let owned = owned_after(counts, 5.0);
        assert_eq!(owned.iter().sum::<usize>(), 4, "{counts:?}: {owned:?}");
    }
    for counts in [[3, 2], [5, 3], [5, 2], [3, 1], [2, 1]] {
        let owned = owned_after(counts, 60.0);
        assert_eq!(owned.iter().sum::<usize>(), 4, "{counts:?}: {owned:?}");
    }
}

#[test]
fn the_memory_of_controllers_is_part_of_the_state_hash_and_of_snapshots() {
    let mut simulation = start(ONE);
    simulation.hash_decisions(1);
    let before = simulation.state().clone();
    simulation.step();
    let (hash, decisions) = (simulation.hash(), simulation.state().decision_hash());
    simulation.restore(before);
    simulation.step();
    assert_eq!(
        (simulation.hash(), simulation.state().decision_hash()),
        (hash, decisions)
    );
    let mut other = start(&with(ONE, "goals.spot.value = 2"));
    other.hash_decisions(1);
    other.step();
    assert_ne!(other.hash(), hash);
    assert_ne!(other.state().decision_hash(), decisions);
}

#[test]
fn robots_of_a_removed_kind_leave_the_ids_of_controllers_valid() {
    let ant = "robots.ant = { radius_m = 0.1, start.at_m = [[3, 3]], brain.behaviours = [] }";
    let mut simulation = start(&with(ONE, ant));
    step_with(&mut simulation, [(id(1, 0), send(&[message(1.0)]))]);
    assert_eq!(controllers(&simulation)[0].id, AgentId::controller(2, 0));
    simulation.change(scenario(ONE)).unwrap();
    assert_eq!(controllers(&simulation)[0].id, AgentId::controller(1, 0));
    simulation.step();
    assert_eq!(owned(&simulation), [2, 2]);
}

#[test]
fn clocks_have_their_own_offset_and_drift() {
    let time_s = |text: &str| {
        let mut simulation = start(text);
        (0..100).for_each(|_| simulation.step());
        [0, 1].map(|robot| {
            let percept = simulation.percept(id(0, robot)).unwrap();
            percept.unwrap().time_s.unwrap()
        })
    };
    assert_eq!(time_s(ONE), [10.0, 10.0]);
    let drifting = with(ONE, "clock = { max_offset_s = 3, max_drift = 0.01 }");
    let times_s = time_s(&drifting);
    assert!(times_s[0] != times_s[1] && times_s.iter().all(|time_s| (9.9..13.2).contains(time_s)));
}
