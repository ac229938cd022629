//! A robot that is watched: what it perceives and decides is told, and nothing else changes.

use crate::common::{id, read, robots, start};
use sim::simulation::Simulation;
use std::sync::Arc;

/// Rovers that think in every third step, and birds that go with the others.
const TEAM: &str = "
[clock]
time_limit_s = 200
[world]
size_m = [25, 25]
obstacles = [{ circle = { at_m = [12, 12], radius_m = 3 } }]
[items.mine]
count = 3
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

fn watching(kind: u8) -> Simulation {
    let mut simulation = start(TEAM);
    simulation.inspect(Some(id(kind, 1)));
    simulation
}

#[test]
fn who_is_watched_does_what_it_would_do() {
    let (mut watched, mut free) = (watching(ROVER), start(TEAM));
    for _ in 0..200 {
        watched.step();
        free.step();
        assert!(watched.inspection().is_some());
        assert_eq!(watched.state().hash(), free.state().hash());
    }
}

#[test]
fn what_is_told_is_what_the_robot_then_does() {
    for kind in [BIRD, ROVER] {
        let mut simulation = watching(kind);
        for tick in 0..120 {
            let told = simulation.inspection().unwrap();
            assert!(told.tick <= tick && tick - told.tick < 3);
            simulation.step();
            let mut robots = robots(&simulation).into_iter();
            let robot = robots.find(|robot| robot.id == id(kind, 1)).unwrap();
            let (wanted, motion) = (robot.wanted, told.decision.command.motion);
            assert!((wanted.speed_m_s - motion.speed_m_s).abs() < 1e-11);
            assert!((wanted.turn_rate_rad_s - motion.turn_rate_rad_s).abs() < 1e-11);
        }
    }
}

#[test]
fn between_two_steps_of_its_brain_the_last_is_told() {
    let mut simulation = watching(ROVER);
    let mut ticks = Vec::new();
    for _ in 0..7 {
        let told = simulation.inspection().unwrap();
        assert_eq!(simulation.inspection(), Some(told.clone()));
        ticks.push(told.tick);
        simulation.step();
    }
    assert_eq!(ticks, [0, 0, 0, 3, 3, 3, 6]);
}

#[test]
fn why_it_goes_there_is_told() {
    let mut simulation = watching(ROVER);
    let (mut reached, mut pursued) = (0, 0);
    for _ in 0..300 {
        simulation.step();
        let decision = simulation.inspection().unwrap().decision;
        let belief_state = decision.belief_state.unwrap();
        for goal in &belief_state.goals {
            let [time_s, value] = [goal.time_s, goal.value];
            let precedence = value * goal.likely / (1.0 + time_s / 10.0);
            assert!((goal.precedence - precedence).abs() < 1e-9, "{goal:?}");
            assert!(goal.best_m <= goal.left_m + 0.1, "{goal:?}");
        }
        let leads = |behaviour| decision.leading == Some(behaviour);
        let first = belief_state.goals.iter().find(|goal| goal.is_pursued);
        pursued += u32::from(first.is_some_and(|goal| leads(goal.behaviour)));
        // Its reflex, or the behaviour whose goal it has; a place is chosen only on the way to one.
        assert!(leads(2) || first.is_none_or(|goal| leads(goal.behaviour)));
        assert!(belief_state.reach.is_none() || !leads(2));
        reached += u32::from(belief_state.reach.is_some());
    }
    assert!(reached > 200 && pursued > 200, "{reached} {pursued}");
}

#[test]
fn a_robot_that_is_gone_or_cannot_go_on_has_nothing_to_tell() {
    let mut simulation = watching(ROVER);
    simulation.inspect(Some(id(ROVER, 9)));
    simulation.step();
    assert_eq!(simulation.inspection(), None);
    simulation.inspect(None);
    assert_eq!(simulation.inspection(), None);
    let mut simulation = watching(ROVER);
    let fewer = TEAM.replace("[robots.rover]\ncount = 3", "[robots.rover]\ncount = 1");
    simulation.change(Arc::new(read(&fewer).unwrap())).unwrap();
    assert_eq!(simulation.inspection(), None);
}

#[test]
fn a_map_is_told_of_who_has_one() {
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
