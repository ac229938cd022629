//! Inspection of a robot: its percept and decision are reported, without an effect on the run.

use crate::common::{id, read, robots, start, with};
use sim::simulation::Simulation;
use std::sync::Arc;

/// Rovers whose brains run in every third step, and birds that flock.
const TEAM: &str = "
clock.time_limit_s = 200
world = { size_m = [25, 25], obstacles = [{ circle = { at_m = [12, 12], radius_m = 3 } }] }
items.mine = { count = 3 }
[robots.bird]
count = 3
radius_m = 0.1
layer = \"air\"
drive = { max_speed_m_s = 2, max_turn_rate_deg_s = 90 }
sensors.eyes = { kind = \"robots\", range_m = 5 }
brain.behaviours = [{ kind = \"flock\" }]
[robots.rover]
count = 3
model = \"ugv\"
brain.rate_hz = 3.3333333333333335
brain.arbitration = { kind = \"goals\" }
brain.behaviours = [{ kind = \"bayesian_search\" }, { kind = \"return_home\" }, { kind = \"avoid\" }]
";

const BIRD: u8 = 0;
const ROVER: u8 = 1;

fn inspecting(kind: u8) -> Simulation {
    let mut simulation = start(TEAM);
    simulation.inspect(Some(id(kind, 1)));
    simulation
}

#[test]
fn inspection_has_no_effect_on_a_robot() {
    let (mut watched, mut free) = (inspecting(ROVER), start(TEAM));
    for _ in 0..200 {
        watched.step();
        free.step();
        assert!(watched.inspection().is_some());
        assert_eq!(watched.state().hash(), free.state().hash());
    }
}

#[test]
fn the_inspected_decision_is_what_the_robot_executes() {
    for kind in [BIRD, ROVER] {
        let mut simulation = inspecting(kind);
        for tick in 0..120 {
            let inspection = simulation.inspection().unwrap();
            assert!(inspection.tick <= tick && tick - inspection.tick < 3);
            simulation.step();
            let mut robots = robots(&simulation).into_iter();
            let robot = robots.find(|robot| robot.id == id(kind, 1)).unwrap();
            let (setpoint, motion) = (robot.setpoint, inspection.decision.command.motion);
            assert!((setpoint.speed_m_s - motion.speed_m_s).abs() < 1e-11);
            assert!((setpoint.turn_rate_rad_s - motion.turn_rate_rad_s).abs() < 1e-11);
        }
    }
}

#[test]
fn between_brain_steps_the_last_decision_is_reported() {
    let mut simulation = inspecting(ROVER);
    let mut ticks = Vec::new();
    for _ in 0..7 {
        let inspection = simulation.inspection().unwrap();
        assert_eq!(simulation.inspection(), Some(inspection.clone()));
        ticks.push(inspection.tick);
        simulation.step();
    }
    assert_eq!(ticks, [0, 0, 0, 3, 3, 3, 6]);
}

#[test]
fn the_reasons_of_a_decision_are_reported() {
    let mut simulation = inspecting(ROVER);
    let (mut reached, mut pursued) = (0, 0);
    for _ in 0..300 {
        simulation.step();
        let decision = simulation.inspection().unwrap().decision;
        let belief_state = decision.belief_state.unwrap();
        for goal in &belief_state.goals {
            let [time_s, value] = [goal.time_s, goal.value];
            let precedence = value * goal.battery_probability / (1.0 + time_s / 10.0);
            assert!((goal.precedence - precedence).abs() < 1e-9, "{goal:?}");
            assert!(goal.min_remaining_m <= goal.remaining_m + 0.1, "{goal:?}");
        }
        let leads = |behaviour| decision.leading == Some(behaviour);
        let first = belief_state.goals.iter().find(|goal| goal.is_pursued);
        pursued += u32::from(first.is_some_and(|goal| leads(goal.behaviour)));
        // The active reflex, or the behaviour of the pursued goal; a heading is only chosen
        // towards a goal.
        assert!(leads(2) || first.is_none_or(|goal| leads(goal.behaviour)));
        assert!(belief_state.heading_options.is_none() || !leads(2));
        reached += u32::from(belief_state.heading_options.is_some());
    }
    assert!(reached > 200 && pursued > 200, "{reached} {pursued}");
}

#[test]
fn a_removed_or_stopped_robot_has_no_inspection() {
    let mut simulation = inspecting(ROVER);
    simulation.inspect(Some(id(ROVER, 9)));
    simulation.step();
    assert_eq!(simulation.inspection(), None);
    simulation.inspect(None);
    assert_eq!(simulation.inspection(), None);
    let mut simulation = inspecting(ROVER);
    let fewer = with(TEAM, "robots.rover.count = 1");
    simulation.change(Arc::new(read(&fewer).unwrap())).unwrap();
    assert_eq!(simulation.inspection(), None);
}

#[test]
fn the_map_of_a_robot_with_beliefs_is_reported() {
    let mut simulation = start(TEAM);
    (0..30).for_each(|_| simulation.step());
    let state = simulation.state();
    assert_eq!(state.map(id(BIRD, 0)), None);
    assert_eq!(state.map(id(ROVER, 9)), None);
    let map = state.map(id(ROVER, 0)).unwrap();
    assert_eq!(map.occupancy.len(), map.columns * map.rows);
    assert_eq!(map.unseen.len(), map.columns * map.rows);
    assert!(
        map.occupancy
            .iter()
            .any(|percent| (0..30).contains(percent))
    );
    assert!(map.occupancy.contains(&-1) && map.unseen.iter().any(|percent| *percent < 90));
}
