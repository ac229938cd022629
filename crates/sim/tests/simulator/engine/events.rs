//! Events of a run, for recordings.

use crate::common::{go, id, robots, scenario, start, step_with, with};
use sim::judge::events::{Event, EventKind, EventReader};
use sim::run::{Item, Status};
use sim::simulation::{Simulation, StepInputs};
use std::collections::BTreeMap;

/// Robots of two kinds that collide, break, run empty and find items.
const CROWD: &str = r#"
world.size_m = [14, 10]
items.flag.count = 2
items.mine.count = 12
[robots.cart]
count = 4
radius_m = 0.4
drive = { max_speed_m_s = 2, max_turn_rate_deg_s = 90 }
collision.max_collisions = 3
sensors.eye = { kind = "items", range_m = 1.5 }
brain.behaviours = [{ kind = "cruise" }]
[robots.rover]
count = 4
radius_m = 0.4
battery = { capacity_j = 100, idle_w = 5, move_j_per_m = 2 }
sensors.eye = { kind = "items", range_m = 1.5 }
brain.behaviours = [{ kind = "cruise" }]
"#;

/// Two robots of different kinds, both next to the same item.
const PAIR: &str = r#"
world.size_m = [14, 10]
items.mine.placement.at_m = [[5, 5]]
robots.cart = { start.at_m = [[4, 5]], sensors.eye = { kind = "items", range_m = 2 } }
robots.rover = { start.at_m = [[6, 5]], sensors.eye = { kind = "items", range_m = 2 } }
"#;

fn drained(reader: &EventReader) -> Vec<Event> {
    let episodes = reader.drain().into_iter();
    episodes.flat_map(|(_, events)| events).collect()
}

fn items(simulation: &Simulation) -> Vec<Item> {
    let state = simulation.state();
    state.each_item(simulation.scenario()).collect()
}

#[test]
fn events_are_the_finds_collisions_and_stops_of_a_run() {
    let mut simulation = start(CROWD);
    let reader = simulation.event_reader();
    (0..500).for_each(|_| simulation.step());
    let events = drained(&reader);
    let (mut found, mut collisions, mut stopped) = (0, BTreeMap::new(), BTreeMap::new());
    for event in &events {
        match event.kind {
            EventKind::Detected {
                item: (kind, index),
                by,
            } => {
                let item = items(&simulation)[usize::from(kind) * 2 + index as usize];
                let at_s = Some(event.time_s(simulation.scenario()));
                assert_eq!(
                    (item.kind, item.found_s, item.found_by),
                    (kind, at_s, Some(by))
                );
                found += 1;
            }
            EventKind::Collided { robot, total } => {
                let before = collisions.insert(robot, total).unwrap_or(0);
                assert_eq!(total, before + 1, "one event per collision");
            }
            EventKind::Status { robot, status } => {
                assert!(stopped.insert(robot, status).is_none());
            }
            _ => unreachable!("there are no goals, tools, hazards and controllers"),
        }
    }
    assert_eq!(found, simulation.outcome().found.iter().sum::<u32>());
    for robot in robots(&simulation) {
        let total = collisions.get(&robot.id).copied().unwrap_or(0);
        assert_eq!(total, robot.collisions);
        let status = stopped.get(&robot.id).copied().unwrap_or_default();
        assert_eq!(status, robot.status);
    }
    let are_all_in_order = events.is_sorted_by_key(|event| event.tick);
    assert!(are_all_in_order && found > 3 && collisions.len() > 3);
    assert!(stopped.values().any(|status| *status == Status::Broken));
    assert!(stopped.values().any(|status| *status == Status::Empty));
    assert!(drained(&reader).is_empty());
}

#[test]
fn readers_change_nothing_in_a_run_and_each_reads_all_events() {
    let (mut plain, mut read) = (start(CROWD), start(CROWD));
    let (one, other) = (read.event_reader(), read.event_reader());
    let mut events = Vec::new();
    for _ in 0..300 {
        plain.step();
        read.step();
        events.extend(drained(&one));
        assert_eq!(plain.state().hash(), read.state().hash());
    }
    assert_eq!(plain.outcome(), read.outcome());
    assert_eq!(events, drained(&other));
    assert!(!events.is_empty());
}

#[test]
fn of_robots_that_detect_an_item_in_the_same_step_the_first_found_it_wherever_they_decide() {
    for outside in [&[][..], &[0], &[1], &[0, 1]] {
        let mut simulation = start(PAIR);
        let reader = simulation.event_reader();
        let begun = simulation.begin_step(StepInputs::default(), outside);
        simulation.finish_step(begun.unwrap());
        let (item, by) = ((0, 0), id(0, 0));
        let kind = EventKind::Detected { item, by };
        assert_eq!(drained(&reader), [Event { tick: 0, kind }], "{outside:?}");
        assert_eq!(items(&simulation)[0].found_by, Some(by));
    }
}

#[test]
fn a_second_detection_is_no_event() {
    let mut simulation = start(PAIR);
    let stay = [(id(0, 0), go(0.0, 0.0)), (id(1, 0), go(0.0, 0.0))];
    step_with(&mut simulation, stay.clone());
    let reader = simulation.event_reader();
    (0..20).for_each(|_| step_with(&mut simulation, stay.clone()));
    assert!(drained(&reader).is_empty());
}

#[test]
fn events_keep_the_numbers_of_the_scenario_in_which_they_happened() {
    let mut simulation = start(PAIR);
    let reader = simulation.event_reader();
    simulation.step();
    // Kinds are numbered in the order of their names.
    let ant = "[robots.ant]\nradius_m = 0.1\nsensors.eye = { kind = \"items\", range_m = 20 }\n";
    let other = "robots.cart.count = 0\nitems.mine.placement.at_m = [[5, 5], [5, 6]]\n";
    let text = with(PAIR, &format!("{other}{ant}"));
    simulation.change(scenario(&text)).unwrap();
    simulation.step();
    let episodes = reader.drain();
    let by = |place: usize| {
        let (scenario, events) = &episodes[place];
        let [
            Event {
                kind: EventKind::Detected { by, .. },
                ..
            },
        ] = events[..]
        else {
            panic!("one find: {events:?}");
        };
        scenario.robot_kinds().nth(by.kind.into()).unwrap()
    };
    assert_eq!((episodes.len(), by(0), by(1)), (2, "cart", "ant"));
    let found_by: Vec<_> = items(&simulation)
        .iter()
        .map(|item| item.found_by)
        .collect();
    // The robot that found the first item was removed.
    assert_eq!(found_by, [None, Some(id(0, 0))]);
}

#[test]
fn the_robot_that_found_an_item_keeps_its_finds_when_kinds_are_renumbered() {
    let mut simulation = start(PAIR);
    simulation.step();
    let first = with(PAIR, "robots.ant.radius_m = 0.1");
    simulation.change(scenario(&first)).unwrap();
    assert_eq!(items(&simulation)[0].found_by, Some(id(1, 0)));
}

#[test]
fn a_run_that_returns_to_an_earlier_step_gives_its_events_again() {
    let mut simulation = start(CROWD);
    let reader = simulation.event_reader();
    (0..100).for_each(|_| simulation.step());
    let (state, copy) = (simulation.state().clone(), simulation.clone());
    (0..200).for_each(|_| simulation.step());
    let all = {
        let mut plain = start(CROWD);
        let reader = plain.event_reader();
        (0..300).for_each(|_| plain.step());
        drained(&reader)
    };
    simulation.restore(state);
    (0..200).for_each(|_| simulation.step());
    simulation.return_to(copy.clone());
    (0..200).for_each(|_| simulation.step());
    // A copy has no readers.
    let mut other = copy;
    other.step();
    assert_eq!(drained(&reader), all);
}
