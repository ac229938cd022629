//! Changing the scenario while messages and observations are pending.

use crate::common::{id, message, scenario, send, start, step_with};
use brain::{About, Percept, ReceivedMessage};
use sim::simulation::Simulation;

/// Kinds of items, and robots that all see each other and are within radio range.
fn within_range(kinds: &[(&str, u32)], items: &[&str], brain_hz: f64) -> String {
    let items = items.iter().map(|name| format!("items.{name} = {{}}\n"));
    let items: String = items.collect();
    let robots = kinds.iter().map(|(name, count)| {
        // Each kind is in its own row, independent of the other kinds.
        let y = 1.0 + 0.3 * f64::from(name.as_bytes()[0] - b'a');
        let places: Vec<[f64; 2]> = (1..=*count).map(|x| [f64::from(x), y]).collect();
        format!(
            "[robots.{name}]\nradius_m = 0.1\nbrain.rate_hz = {brain_hz}\nstart.at_m = {places:?}\n\
             drive = {{ max_speed_m_s = 0, max_turn_rate_deg_s = 0 }}\n\
             radio = {{ range_m = 50, delay_s = 1 }}\nsensors.mates = {{ kind = \"robots\", range_m = 50 }}\n\
             sensors.eye = {{ kind = \"items\", range_m = 50 }}\n"
        )
    });
    let robots: String = robots.collect();
    items + &robots
}

/// The percepts of a robot over a number of steps.
fn percepts_within(simulation: &mut Simulation, steps: u32, robot: brain::AgentId) -> Vec<Percept> {
    let mut percepts = Vec::new();
    for _ in 0..steps {
        percepts.extend(simulation.percept(robot).unwrap());
        simulation.step();
    }
    percepts
}

fn inbox_of(percepts: &[Percept]) -> Vec<ReceivedMessage> {
    percepts
        .iter()
        .flat_map(|percept| percept.inbox.clone())
        .collect()
}

#[test]
fn a_pending_message_to_a_removed_robot_is_discarded() {
    let text = within_range(&[("m", 2), ("z", 1)], &[], 10.0);
    let mut simulation = start(&text);
    step_with(&mut simulation, [(id(0, 0), send(&[message(7.0)]))]);
    let mut same = simulation.clone();
    let other = within_range(&[("m", 2), ("y", 1)], &[], 10.0);
    simulation.change(scenario(&other)).unwrap();
    assert_eq!(
        inbox_of(&percepts_within(&mut simulation, 20, id(1, 0))),
        []
    );
    same.change(scenario(&text)).unwrap();
    assert_eq!(inbox_of(&percepts_within(&mut same, 20, id(1, 0))).len(), 1);
}

#[test]
fn a_pending_message_keeps_its_sender_and_item_when_kinds_are_renumbered() {
    let text = within_range(&[("m", 2)], &["mine"], 10.0);
    let mut simulation = start(&text);
    step_with(&mut simulation, [(id(0, 0), send(&[message(7.0)]))]);
    let mut without = simulation.clone();
    // A kind without robots and a kind of items come first in the order of names.
    let more = within_range(&[("a", 0), ("m", 2)], &["flag", "mine"], 10.0);
    simulation.change(scenario(&more)).unwrap();
    let received = inbox_of(&percepts_within(&mut simulation, 20, id(1, 1)));
    assert_eq!(received.len(), 1);
    assert_eq!(received[0].from, id(1, 0));
    let About::Item { kind, at, .. } = received[0].message.about else {
        panic!("{received:?}");
    };
    assert_eq!((kind, at.x), (1, 7.0));
    // It is discarded when its kind of item is removed.
    let gone = within_range(&[("m", 2)], &["flag"], 10.0);
    without.change(scenario(&gone)).unwrap();
    assert_eq!(inbox_of(&percepts_within(&mut without, 20, id(0, 1))), []);
}

#[test]
fn pending_percepts_use_the_new_robot_ids_and_omit_removed_robots() {
    let text = within_range(&[("b", 1), ("m", 2), ("z", 1)], &[], 0.2);
    let mut simulation = start(&text);
    simulation.step();
    for sender in [id(0, 0), id(1, 0), id(2, 0)] {
        step_with(&mut simulation, [(sender, send(&[message(7.0)]))]);
    }
    (0..15).for_each(|_| simulation.step());
    let other = within_range(&[("a", 1), ("m", 2), ("y", 1), ("z", 1)], &[], 0.2);
    simulation.change(scenario(&other)).unwrap();
    // The percepts of m/1, which has seen all the others and received their messages.
    let percepts = percepts_within(&mut simulation, 50, id(1, 1));
    let senders: Vec<_> = inbox_of(&percepts)
        .iter()
        .map(|received| received.from)
        .collect();
    assert_eq!(senders, [id(1, 0), id(3, 0)]);
    let old = percepts.iter().flat_map(|percept| &percept.neighbours);
    let old = old.filter(|neighbour| neighbour.age_s > 3.15);
    let mut seen: Vec<_> = old.map(|neighbour| neighbour.id).collect();
    seen.sort_unstable();
    seen.dedup();
    assert_eq!(seen, [id(1, 0), id(3, 0)]);
}
