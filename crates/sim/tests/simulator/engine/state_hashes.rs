//! What the hash of a run covers.

use crate::common::{id, message, replaced, robots, scenario, send, start, step_with};
use sim::simulation::Simulation;

/// Robots without beliefs in a world with obstacles and terrain.
const WORLD: &str = "
terrain.mud = { speed = 0.5, areas_m = [[[1, 1], [2, 1], [2, 2]]] }
[world]
obstacles = [{ circle = { at_m = [10, 5], radius_m = 1 } }, { polygon_m = [[15, 2], [16, 2], [16, 3]] }]
[robots.rover]
start.at_m = [[4, 5], [6, 5]]
";

/// Two stationary robots with beliefs; neither relays a report of the other one.
const BELIEFS: &str = r#"
items.mine.target = false
[robots.rover]
start.at_m = [[4, 5], [6, 5]]
drive = { max_speed_m_s = 0, max_turn_rate_deg_s = 0 }
sensors = { gps.kind = "position", compass.kind = "heading" }
radio.range_m = 5
brain.arbitration.kind = "goals"
brain.behaviours = [{ kind = "hold_position" }]
brain.beliefs = { prior_count.mine = 4, trust.initial = 0.4 }
"#;

/// Whether all bodies are in the same state.
fn are_alike(one: &Simulation, other: &Simulation) -> bool {
    robots(one) == robots(other)
}

fn differ_in_hash_alone(one: &Simulation, other: &Simulation) -> bool {
    are_alike(one, other) && one.hash() != other.hash()
}

#[test]
fn scenarios_that_differ_in_one_obstacle_or_area_have_different_hashes_at_0_s() {
    let all = start(WORLD);
    for change in [
        ("at_m = [10, 5]", "at_m = [10, 5.001]"),
        ("radius_m = 1 }", "radius_m = 1.001 }"),
        ("[16, 3]]", "[16, 3.001]]"),
        ("{ circle = { at_m = [10, 5], radius_m = 1 } }, ", ""),
        ("speed = 0.5", "speed = 0.4"),
        ("speed = 0.5", "speed = 0.5, energy = 2"),
        ("[2, 2]]]", "[2, 2.001]]]"),
        ("[world]", "[world]\nsize_m = [20, 11]"),
        ("[world]", "[world]\nperiodic = true"),
    ] {
        let other = start(&replaced(WORLD, &[change]));
        assert!(differ_in_hash_alone(&all, &other), "{change:?}");
        // The state alone does not contain the world.
        assert_eq!(all.state().hash(), other.state().hash());
    }
}

#[test]
fn equal_scenarios_have_equal_hashes() {
    for text in [WORLD, BELIEFS] {
        let (mut one, mut other) = (start(text), start(text));
        for _ in 0..50 {
            assert_eq!(one.hash(), other.hash());
            one.step();
            other.step();
        }
    }
}

#[test]
fn a_changed_obstacle_changes_the_hash_of_a_run_at_once() {
    let mut simulation = start(WORLD);
    (0..10).for_each(|_| simulation.step());
    let hash = simulation.hash();
    let other = replaced(WORLD, &[("[16, 3]]", "[16, 4]]")]);
    simulation.change(scenario(&other)).unwrap();
    assert_ne!(simulation.hash(), hash);
    simulation.change(scenario(WORLD)).unwrap();
    assert_eq!(simulation.hash(), hash);
}

#[test]
fn a_world_without_obstacles_and_terrain_adds_nothing_to_the_hash_of_the_state() {
    let simulation = start(BELIEFS);
    assert_eq!(simulation.hash(), simulation.state().hash());
}

#[test]
fn a_different_prior_belief_changes_the_hash_of_robots_in_equal_states() {
    let one = start(BELIEFS);
    for change in [
        ("mine = 4", "mine = 5"),
        ("initial = 0.4", "initial = 0.3"),
        ("trust.", "cell_m = 0.5, trust."),
        ("trust.", "area_m = [[0, 0], [20, 9]], trust."),
    ] {
        let other = start(&replaced(BELIEFS, &[change]));
        assert!(differ_in_hash_alone(&one, &other), "{change:?}");
    }
}

#[test]
fn a_reported_item_that_a_robot_believes_changes_the_hash() {
    let (mut one, mut other) = (start(BELIEFS), start(BELIEFS));
    step_with(&mut one, [(id(0, 0), send(&[message(7.0)]))]);
    step_with(&mut other, [(id(0, 0), send(&[]))]);
    for _ in 0..5 {
        one.step();
        other.step();
    }
    let believed = |simulation: &Simulation| {
        let state = simulation.state().belief_state(id(0, 1)).unwrap();
        state.items.len()
    };
    assert_eq!([believed(&one), believed(&other)], [1, 0]);
    assert!(differ_in_hash_alone(&one, &other));
}

#[test]
fn a_message_changes_the_hash_until_the_brain_of_its_receiver_has_it() {
    let radio =
        "brain = { behaviours = [], rate_hz = 1 }\nradio = { range_m = 5, delay_s = 0.5 }\n";
    let text = format!("{WORLD}{radio}");
    let (mut one, mut other) = (start(&text), start(&text));
    step_with(&mut one, [(id(0, 0), send(&[message(7.0)]))]);
    step_with(&mut other, [(id(0, 0), send(&[]))]);
    // In transit for half a second, and then in the inbox until the brain steps at 1 s; without
    // beliefs nothing remains of it.
    for tick in 1..20 {
        assert!(are_alike(&one, &other));
        assert_eq!(one.hash() != other.hash(), tick <= 10, "{tick}");
        one.step();
        other.step();
    }
}

#[test]
fn messages_that_differ_in_one_part_have_different_hashes() {
    let text = format!("{WORLD}radio = {{ range_m = 5, delay_s = 0.5 }}\n");
    let after = |number: f64, confidence: f64, messages: usize| {
        let mut simulation = start(&text);
        let sent = brain::Message {
            confidence,
            ..message(number)
        };
        step_with(&mut simulation, [(id(0, 0), send(&vec![sent; messages]))]);
        simulation.hash()
    };
    let one = after(7.0, 0.5, 1);
    assert_eq!(after(7.0, 0.5, 1), one);
    for other in [after(8.0, 0.5, 1), after(7.0, 0.6, 1), after(7.0, 0.5, 2)] {
        assert_ne!(other, one);
    }
}
