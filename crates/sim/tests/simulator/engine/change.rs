//! Changing the scenario in the middle of a run.

use crate::common::{drive, first, id, replaced, robots, scenario, start, with};
use sim::run::{Item, NoRoom, Robot, Status};
use sim::simulation::Simulation;
use std::time::{Duration, Instant};

const GROUND: &str = r#"
world.obstacles = [{ circle = { at_m = [10, 5], radius_m = 1 } }]
items.flag.count = 3
items.mine.count = 5
[robots.bird]
count = 2
layer = "air"
radius_m = 0.3
drive = { max_speed_m_s = 5, max_turn_rate_deg_s = 90 }
sensors.eye = { kind = "items", range_m = 2, latency_s = 0.5, detection_probability.mine = 0.5,
    false_alarm_rate_per_m2_s.mine = 0.1, needs_line_of_sight = false }
[robots.rover]
count = 6
radius_m = 0.4
drive = { max_speed_m_s = 2, max_acceleration_m_s2 = 2, max_turn_rate_deg_s = 90 }
battery = { capacity_j = 1000, idle_w = 5, move_j_per_m = 2 }
sensors.sonar = { kind = "range", rays = 16, range_m = 3, noise_m = 0.02 }
sensors.mates = { kind = "robots", range_m = 5 }
sensors.eye = { kind = "items", range_m = 1 }
radio = { range_m = 20, loss_probability = 0.3 }
"#;

/// A run that continues with a changed scenario after some seconds; also its robots before.
fn changed(changes: &str) -> (Vec<Robot>, Result<Simulation, NoRoom>) {
    let mut simulation = start(GROUND);
    (0..70).for_each(|_| simulation.step());
    let before = robots(&simulation);
    let hash = simulation.state().hash();
    match simulation.change(scenario(&with(GROUND, changes))) {
        Ok(()) => (before, Ok(simulation)),
        Err(why) => {
            assert_eq!(
                simulation.state().hash(),
                hash,
                "a rejected change has no effect"
            );
            (before, Err(why))
        }
    }
}

fn change(simulation: &mut Simulation, text: &str) {
    simulation.change(scenario(text)).unwrap();
}

fn items(simulation: &Simulation) -> Vec<Item> {
    simulation
        .state()
        .each_item(simulation.scenario())
        .collect()
}

fn robots_of_kind(robots: &[Robot], kind: u8) -> Vec<Robot> {
    robots
        .iter()
        .copied()
        .filter(|robot| robot.id.kind == kind)
        .collect()
}

fn assert_apart(robots: &[Robot], radius_m: f64) {
    for (place, one) in robots.iter().enumerate() {
        for other in &robots[..place] {
            assert!(
                one.at.to(other.at).length() > 2.0 * radius_m - 1e-8,
                "{one:?} {other:?}"
            );
        }
    }
}

#[test]
fn changing_to_the_same_scenario_has_no_effect() {
    let (_, simulation) = changed("");
    let mut simulation = simulation.unwrap();
    let mut other = start(GROUND);
    (0..70).for_each(|_| other.step());
    for _ in 0..200 {
        assert_eq!(simulation.state().hash(), other.state().hash());
        simulation.step();
        other.step();
    }
    assert_eq!(simulation.outcome(), other.outcome());
}

#[test]
fn a_larger_team_keeps_its_robots_and_adds_new_ones() {
    let (before, simulation) = changed("robots.rover.count = 40");
    let simulation = simulation.unwrap();
    let after = robots(&simulation);
    assert_eq!(after.len(), 42);
    assert_eq!(after[..8], before[..]);
    assert_apart(&robots_of_kind(&after, 1), 0.4);
    assert!(
        after[8..]
            .iter()
            .all(|robot| robot.distance_m == 0.0 && robot.collisions == 0)
    );
    // A pillar of 1 m is in the middle of the world.
    let pillar = [10.0, 5.0].into();
    assert!(
        after[8..]
            .iter()
            .all(|robot| robot.at.to(pillar).length() >= 1.4 - 1e-9)
    );
}

#[test]
fn a_smaller_team_loses_only_its_last_robots() {
    let (before, simulation) = changed("robots = { bird.count = 0, rover.count = 4 }");
    let mut simulation = simulation.unwrap();
    // Kinds without robots remain.
    assert_eq!(robots(&simulation), before[2..6]);
    (0..50).for_each(|_| simulation.step());
    assert_eq!(robots(&simulation).len(), 4);
}

#[test]
fn adding_and_removing_a_robot_does_not_affect_the_others() {
    let mut simulation = start(GROUND);
    (0..70).for_each(|_| simulation.step());
    let before = robots(&simulation);
    change(&mut simulation, &with(GROUND, "robots.rover.count = 7"));
    change(&mut simulation, GROUND);
    assert_eq!(robots(&simulation), before);
}

#[test]
fn existing_items_stay_in_place_and_stay_found() {
    let mut simulation = start(GROUND);
    while simulation.outcome().found[1] < 2 {
        simulation.step();
    }
    let before = items(&simulation);
    let more = "items = { flag.count = 4, mine.count = 9 }";
    change(&mut simulation, &with(GROUND, more));
    let after = items(&simulation);
    assert_eq!(after[..3], before[..3]);
    assert_eq!(after[4..9], before[3..]);
    assert!(
        after[9..]
            .iter()
            .chain(&after[3..4])
            .all(|item| item.found_s.is_none())
    );
}

const LATE: &str = r#"
items.flag.placement.at_m = [[2, 5]]
items.mine.placement.at_m = [[1, 6], [18, 5]]
[robots.bird]
layer = "air"
radius_m = 0.4
start.at_m = [[1, 5]]
drive = { max_speed_m_s = 0, max_turn_rate_deg_s = 0 }
sensors.eye = { kind = "items", range_m = 2, latency_s = 0.5 }
"#;

/// A camera with a latency of half a second has detected an item that is then removed; another
/// item gets its index.
#[test]
fn pending_detections_of_removed_items_are_discarded() {
    let found = |changes: &str| {
        let mut simulation = start(LATE);
        simulation.step();
        change(&mut simulation, &with(LATE, changes));
        (0..4).for_each(|_| simulation.step());
        assert_eq!(simulation.outcome().found.iter().sum::<u32>(), 0);
        let mut outcomes = Vec::new();
        for _ in 0..2 {
            simulation.step();
            let found: Vec<bool> = items(&simulation)
                .iter()
                .map(|item| item.found_s.is_some())
                .collect();
            outcomes.push(found);
        }
        outcomes
    };
    assert_eq!(found(""), [[true, true, false]; 2]);
    assert_eq!(found("items.flag.count = 0"), [[true, false]; 2]);
    let none = "items = { flag.count = 0, mine.count = 0 }";
    assert_eq!(found(none), [[false; 0]; 2]);
}

#[test]
fn removing_the_remaining_items_completes_a_run_and_adding_some_reopens_it() {
    let mut simulation = start(GROUND);
    let is_found = |item: &Item| item.found_s.is_some();
    // Until the first mine is found; flags do not count.
    while !items(&simulation)
        .iter()
        .any(|item| item.kind == 1 && is_found(item))
    {
        simulation.step();
    }
    let found: Vec<Item> = items(&simulation)
        .into_iter()
        .filter(|item| item.kind == 1)
        .collect();
    let last = found.iter().rposition(is_found).unwrap();
    let all_found = found[..=last].iter().all(is_found);
    let few = format!("items = {{ flag.count = 0, mine.count = {} }}", last + 1);
    change(&mut simulation, &with(GROUND, &few));
    assert_eq!(simulation.state().is_over(simulation.scenario()), all_found);
    // Remove everything but clutter, so that it does not matter which mine was found first.
    let clutter = "items = { flag.count = 0, mine.target = false }";
    change(&mut simulation, &with(GROUND, clutter));
    assert!(!simulation.outcome().has_failed);
    change(&mut simulation, GROUND);
    assert!(!simulation.state().is_over(simulation.scenario()));
    assert!(simulation.outcome().has_failed);
}

#[test]
fn the_last_remaining_item_can_be_removed() {
    let line = r#"
items.mine.placement.at_m = [[4, 5], [18, 5]]
[robots.rover]
radius_m = 0.4
start = { at_m = [[1, 5]], heading_deg = [0] }
sensors.eye = { kind = "items", range_m = 1 }
"#;
    let mut simulation = start(line);
    drive(&mut simulation, 50, &[(id(0, 0), 1.0, 0.0)]);
    assert_eq!(simulation.outcome().found, [1]);
    let found_s = items(&simulation)[0].found_s.unwrap();
    change(&mut simulation, &with(line, "items.mine.count = 1"));
    assert!(simulation.state().is_over(simulation.scenario()));
    let outcome = simulation.outcome();
    assert!(!outcome.has_failed);
    assert_eq!(outcome.time_s, found_s);
}

#[test]
fn a_lower_maximum_speed_applies_at_once() {
    let fast = "
world.size_m = [200, 20]
[robots.rover]
radius_m = 0.4
start = { at_m = [[20, 10]], heading_deg = [0] }
drive = { max_speed_m_s = 100, max_acceleration_m_s2 = 100, max_turn_rate_deg_s = 90 }
";
    let mut simulation = start(fast);
    drive(&mut simulation, 10, &[(id(0, 0), 100.0, 0.0)]);
    assert_eq!(first(&simulation).speed_m_s, 100.0);
    let slow = "robots.rover.drive = { max_speed_m_s = 1, max_acceleration_m_s2 = 0.1 }";
    change(&mut simulation, &with(fast, slow));
    assert_eq!(first(&simulation).speed_m_s, 1.0);
    (0..100).for_each(|_| simulation.step());
    assert!(first(&simulation).at.x < 200.0 - 0.4 + 1e-6);
}

#[test]
fn parameters_of_other_kinds_do_not_affect_a_robot() {
    let bird = "robots.bird = { drive.max_speed_m_s = 4, sensors.eye.range_m = 1 }";
    let (before, simulation) = changed(bird);
    let after = robots(&simulation.unwrap());
    assert_eq!(robots_of_kind(&after, 1), robots_of_kind(&before, 1));
    let birds = robots_of_kind(&after, 0);
    assert!(birds.iter().all(|bird| bird.speed_m_s <= 4.0));
}

#[test]
fn a_change_without_room_is_rejected_without_effect() {
    // A robot would be inside an obstacle that covers half of the world.
    let pillar = |circle: &str| format!("world.obstacles = [{{ circle = {{ {circle} }} }}]");
    let (_, refused) = changed(&pillar("at_m = [0, 5], radius_m = 10"));
    assert!(matches!(
        refused,
        Err(NoRoom::Item { .. } | NoRoom::Robot(_))
    ));
    // A larger radius would overlap the wall or another robot.
    let (_, refused) = changed("robots.rover.radius_m = 1.4\nitems.flag.count = 0");
    assert!(matches!(refused, Err(NoRoom::Robot(_))));
    // Birds are above obstacles on the ground.
    let birds = "robots.rover.count = 0\nitems = { flag.count = 0, mine.count = 0 }";
    let birds = with(GROUND, birds);
    let mut simulation = start(&birds);
    let built = with(&birds, &pillar("at_m = [10, 5], radius_m = 9.9"));
    assert!(simulation.change(scenario(&built)).is_ok());
}

#[test]
fn a_fixed_start_that_is_occupied_by_now_is_rejected() {
    let two = "
[robots.rover]
count = 1
radius_m = 0.4
start = { at_m = [[1, 5], [3, 5]], heading_deg = [0, 0] }
";
    let mut simulation = start(two);
    let more = scenario(&with(two, "robots.rover.count = 2"));
    drive(&mut simulation, 15, &[(id(0, 0), 1.0, 0.0)]);
    let mut other = simulation.clone();
    assert!(matches!(other.change(more.clone()), Err(NoRoom::Robot(_))));
    drive(&mut simulation, 15, &[(id(0, 0), 1.0, 0.0)]);
    assert!(simulation.change(more).is_ok());
}

const DRAINED: &str = "
clock = { step_s = 1, time_limit_s = 1000 }
[robots.rover]
count = 2
radius_m = 0.4
drive = { max_speed_m_s = 0, max_turn_rate_deg_s = 0 }
battery = { capacity_j = 200, idle_w = 10 }
";

fn drained(capacity: &str) -> String {
    replaced(DRAINED, &[("capacity_j = 200, ", capacity)])
}

/// A run in which the capacity changes after each robot has used 100 J.
fn recharged(capacity: &str) -> Simulation {
    let mut simulation = start(DRAINED);
    (0..10).for_each(|_| simulation.step());
    change(&mut simulation, &drained(capacity));
    simulation
}

#[test]
fn a_capacity_below_the_energy_used_empties_the_battery_without_a_refund() {
    let mut simulation = recharged("capacity_j = 50, ");
    for _ in 0..3 {
        for robot in robots(&simulation) {
            assert_eq!(robot.battery, Some(0.0));
            assert_eq!(robot.status, Status::Empty);
            assert_eq!(robot.energy_j, 100.0);
        }
        simulation.step();
    }
    assert_eq!(simulation.outcome().energy_j, 200.0);
}

#[test]
fn an_empty_robot_moves_again_with_a_larger_battery() {
    let mut simulation = recharged("capacity_j = 50, ");
    for (capacity, left) in [("capacity_j = 10000, ", Some(0.99)), ("", None)] {
        change(&mut simulation, &drained(capacity));
        let robot = first(&simulation);
        assert_eq!((robot.status, robot.battery), (Status::Active, left));
        let before = robot.energy_j;
        simulation.step();
        assert_eq!(first(&simulation).energy_j, before + 10.0);
        change(&mut simulation, &drained("capacity_j = 50, "));
        change(&mut simulation, &drained("capacity_j = 50, "));
        assert_eq!(first(&simulation).status, Status::Empty);
        change(&mut simulation, &drained("capacity_j = 100, "));
    }
}

#[test]
fn the_outcome_includes_the_cost_of_removed_robots() {
    let mut simulation = start(&DRAINED.replace("max_speed_m_s = 0", "max_speed_m_s = 0.1"));
    let brisk = |index| (id(0, index), 0.1, 0.0);
    drive(&mut simulation, 20, &[brisk(0), brisk(1)]);
    let before = simulation.outcome();
    assert!(before.distance_m > 0.0);
    assert_eq!((before.energy_j, before.robots_stopped), (400.0, 2));
    let hash = simulation.state().hash();
    for count in [1, 0, 2, 1] {
        let count = format!("robots.rover.count = {count}");
        change(&mut simulation, &with(DRAINED, &count));
        assert_eq!(simulation.outcome(), before);
    }
    assert_ne!(simulation.state().hash(), hash);
    // A robot added since then adds its own cost.
    simulation.step();
    assert_eq!(simulation.outcome().energy_j, before.energy_j + 10.0);
}

/// Comparing each new robot with every other one would take half a minute.
#[test]
fn adding_a_hundred_thousand_robots_takes_seconds_and_they_do_not_overlap() {
    let many = replaced(
        GROUND,
        &[("radio = { range_m = 20, loss_probability = 0.3 }\n", "")],
    );
    let large =
        "world.size_m = [600, 600]\nrobots.rover = { count = 100000, brain.behaviours = [] }";
    let many = with(&many, large);
    let few = scenario(&many.replace("count = 100000", "count = 1000"));
    let (few, many) = (Simulation::new(few, 1, 0).unwrap(), scenario(&many));
    let mut simulation = few;
    drive(&mut simulation, 20, &[(id(1, 0), 2.0, 0.0)]);
    let begin = Instant::now();
    simulation.change(many).unwrap();
    assert!(
        begin.elapsed() < Duration::from_secs(10),
        "{:?}",
        begin.elapsed()
    );
    let mut rovers = robots_of_kind(&robots(&simulation), 1);
    assert_eq!(rovers.len(), 100_000);
    rovers.sort_by(|one, other| one.at.x.total_cmp(&other.at.x));
    for (place, one) in rovers.iter().enumerate() {
        let after = rovers[place + 1..].iter();
        let mut near = after.take_while(|other| other.at.x - one.at.x < 0.8);
        assert!(near.all(|other| one.at.to(other.at).length() > 0.8 - 1e-8));
    }
}
