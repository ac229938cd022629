//! Goals that controllers award to robots.

use crate::scenarios::{scenario, with};
use brain::AgentId;
use sim::judge::GoalOutcome;
use sim::run::Goal;
use sim::simulation::Simulation;
use std::collections::BTreeMap;

/// Three robots in a yard, of which two have an arm, and a controller with nine goals.
const YARD: &str = r#"
clock = { step_s = 0.2, time_limit_s = 300 }
world.size_m = [60, 60]
controllers.base = { start.at_m = [[30, 30]], radio = { range_m = 90, messages_per_step = 20 } }
robots.arm = { model = "server", capabilities = ["arm"], start.at_m = [[28, 30], [32, 30]] }
robots.eye = { model = "server", start.at_m = [[30, 27]] }
[goals.spot]
within_m = 1
placement.at_m = [[5, 5], [50, 8], [12, 50], [30, 35], [55, 55], [8, 30], [40, 20], [20, 15], [33, 56]]
[models.server]
radius_m = 0.25
drive = { max_speed_m_s = 2, max_acceleration_m_s2 = 2, max_turn_rate_deg_s = 120 }
radio = { range_m = 90, messages_per_step = 20 }
sensors.gps = { kind = "position", noise_m = 0.1 }
sensors.compass = { kind = "heading", noise_deg = 1 }
sensors.sonar = { kind = "range", rays = 16, range_m = 4 }
brain.behaviours = [{ kind = "serve" }, { kind = "avoid" }]
"#;

fn finished(text: &str) -> (Vec<Goal>, GoalOutcome) {
    let mut simulation = Simulation::new(scenario(text), 1, 0).unwrap();
    let outcome = simulation.finish().goals.unwrap();
    let goals = simulation.state().each_goal(simulation.scenario());
    (goals.collect(), outcome)
}

#[test]
fn every_goal_of_a_controller_is_served_once() {
    let (goals, outcome) = finished(YARD);
    assert_eq!((outcome.served, outcome.served_twice), (9, 0));
    assert!(goals.iter().all(|goal| goal.awarded_s <= goal.began_s));
    let robots = goals.iter().filter_map(|goal| goal.served_by);
    let robots: std::collections::BTreeSet<AgentId> = robots.collect();
    assert!(robots.len() > 1, "{robots:?}");
}

#[test]
fn robots_stay_for_the_time_of_service() {
    let (_, outcome) = finished(&with(YARD, "goals.spot.service_s = 5"));
    assert_eq!(outcome.served, 9);
    assert!((4.6..8.0).contains(&outcome.service_s), "{outcome:?}");
}

/// The times in seconds for which the robots that served the goals had been there, by their true
/// positions, and an outcome.
fn stays_s(text: &str) -> (Vec<f64>, GoalOutcome) {
    let mut simulation = Simulation::new(scenario(text), 1, 0).unwrap();
    let goals = |simulation: &Simulation| -> Vec<Goal> {
        let goals = simulation.state().each_goal(simulation.scenario());
        goals.collect()
    };
    let mut arrived_s: BTreeMap<(usize, AgentId), f64> = BTreeMap::new();
    let mut stays_s: BTreeMap<usize, f64> = BTreeMap::new();
    while stays_s.len() < 9 && simulation.time_s() < 300.0 {
        simulation.step();
        // The position at which the robots decided, which is that before the next motion.
        for (number, goal) in goals(&simulation).iter().enumerate() {
            let now_s = simulation.time_s();
            if let Some(since_s) = goal.served_by.and_then(|by| arrived_s.get(&(number, by))) {
                stays_s.entry(number).or_insert(now_s - since_s);
            }
            for robot in simulation.state().each_robot(simulation.scenario()) {
                if robot.at.to(goal.at).length() > 1.05 {
                    arrived_s.remove(&(number, robot.id));
                } else {
                    arrived_s.entry((number, robot.id)).or_insert(now_s);
                }
            }
        }
    }
    let outcome = simulation.outcome().goals.unwrap();
    (stays_s.into_values().collect(), outcome)
}

#[test]
fn a_service_takes_its_time_and_at_most_two_steps_more() {
    for service_s in [0.2, 1.0, 2.0, 5.0] {
        let text = with(YARD, &format!("goals.spot.service_s = {service_s}"));
        let text = text.replace("noise_m = 0.1", "noise_m = 0");
        let (stays_s, outcome) = stays_s(&text);
        assert_eq!(stays_s.len(), 9);
        for stay_s in stays_s {
            let is_right = stay_s > service_s - 1e-6 && stay_s < service_s + 0.4 + 1e-6;
            assert!(is_right, "{stay_s} of {service_s}");
        }
        assert!((outcome.service_s - service_s).abs() < 0.4, "{outcome:?}");
    }
}

#[test]
fn a_robot_that_is_at_the_goal_already_serves_it() {
    let one = "goals.spot = { service_s = 2, placement.at_m = [[28.2, 30]] }";
    let (goals, outcome) = finished(&with(YARD, one));
    assert_eq!((outcome.served, outcome.served_twice), (1, 0), "{goals:?}");
    assert!(outcome.service_s >= 1.6, "{outcome:?}");
}

#[test]
fn goals_that_lie_close_together_and_take_time_are_all_served() {
    let near = "goals.spot.service_s = 5\ngoals.spot.placement.at_m = \
                [[28, 33], [29, 33], [30, 33], [31, 33], [32, 33], [29, 34], [30, 34], [31, 34], [30, 35]]";
    let text = with(YARD, near);
    let served = (0..8).map(|run| {
        let mut simulation = Simulation::new(scenario(&text), 1, run).unwrap();
        simulation.finish().goals.unwrap().served
    });
    let served: Vec<u32> = served.collect();
    assert_eq!(served, [9; 8]);
}

#[test]
fn only_robots_with_the_capability_serve_a_goal() {
    let (goals, outcome) = finished(&with(YARD, "goals.spot.requires = \"arm\""));
    assert_eq!(outcome.served, 9);
    assert!(
        goals
            .iter()
            .all(|goal| goal.served_by.is_some_and(|id| id.kind == 0))
    );
}

#[test]
fn a_stationary_machine_owns_and_serves_the_goals_at_which_it_stands() {
    let text = YARD
        .replace("max_speed_m_s = 2", "max_speed_m_s = 0")
        .replace("start.at_m = [[30, 30]]", "aboard = \"eye\"");
    let four = "goals.spot.service_s = 2\n\
                goals.spot.placement.at_m = [[28.5, 30], [30, 27.5], [32, 30], [40, 40]]";
    let (goals, outcome) = finished(&with(&text, four));
    assert_eq!((outcome.served, outcome.served_twice), (3, 0), "{goals:?}");
    let by = |goal: &Goal| goal.served_by.map(|id| (id.kind, id.index));
    let served: Vec<_> = goals.iter().map(by).collect();
    assert_eq!(served, [Some((0, 0)), Some((1, 0)), Some((0, 1)), None]);
    assert_eq!(goals[3].awarded_s, None);
}

#[test]
fn an_area_that_lies_half_beyond_the_border_is_searched_and_finished() {
    for at_m in ["[0, 30]", "[30, 59.9]", "[60, 60]"] {
        let area = format!("placement.at_m = [{at_m}], within_m = 6, work = \"search\"");
        let (_, outcome) = finished(&with(YARD, &format!("goals.spot = {{ {area} }}")));
        assert_eq!(outcome.served, 1, "{at_m}");
    }
}

#[test]
fn goals_of_robots_that_break_down_are_served_by_others() {
    let broken = with(YARD, "robots.eye.mean_time_between_failures_s = 10");
    let (goals, outcome) = finished(&broken);
    assert_eq!(outcome.served, 9, "{goals:?}");
}

#[test]
fn goals_are_served_although_clocks_differ_and_messages_are_lost() {
    let clocks = with(YARD, "clock = { max_offset_s = 100, max_drift = 0.01 }");
    let lossy = "messages_per_step = 20, loss_probability = 0.3";
    let (_, outcome) = finished(&clocks.replace("messages_per_step = 20", lossy));
    assert_eq!(outcome.served, 9);
}

#[test]
fn without_controllers_robots_that_only_serve_do_nothing() {
    let none = "controllers.base.start.at_m = []";
    let (_, outcome) = finished(&with(YARD, none));
    assert_eq!((outcome.served, outcome.goals_refused), (0, 0));
}
