//! Going on with another scenario in the middle of a run.

use crate::common::{drive, first, id, message, replaced, robots, say, scenario, start, told};
use brain::{About, Percept, ReceivedMessage};
use sim::run::{Item, NoRoom, Robot, Status};
use sim::simulation::Simulation;
use std::time::{Duration, Instant};

const GROUND: &str = "
[clock]
step_s = 0.1
time_limit_s = 60
[world]
size_m = [20, 10]
obstacles = [{ circle = { at_m = [10, 5], radius_m = 1 } }]
[items.flag]
count = 3
[items.mine]
count = 5
[robots.bird]
count = 2
layer = \"air\"
radius_m = 0.3
drive = { max_speed_m_s = 5, max_turn_rate_deg_s = 90 }
[robots.bird.sensors.eye]
kind = \"items\"
range_m = 2
latency_s = 0.5
detection_probability = { mine = 0.5 }
false_alarm_rate_per_m2_s = { mine = 0.1 }
needs_line_of_sight = false
[robots.rover]
count = 6
radius_m = 0.4
drive = { max_speed_m_s = 2, max_acceleration_m_s2 = 2, max_turn_rate_deg_s = 90 }
battery = { capacity_j = 1000, idle_w = 5, move_j_per_m = 2 }
[robots.rover.sensors.sonar]
kind = \"range\"
rays = 16
range_m = 3
noise_m = 0.02
[robots.rover.sensors.mates]
kind = \"robots\"
range_m = 5
[robots.rover.sensors.eye]
kind = \"items\"
range_m = 1
[robots.rover.radio]
range_m = 20
loss_probability = 0.3
";

fn with(changes: &[(&str, &str)]) -> String {
    replaced(GROUND, changes)
}

/// A run of some seconds that goes on with these changes.
fn changed(changes: &[(&str, &str)]) -> (Vec<Robot>, Result<Simulation, NoRoom>) {
    let mut simulation = start(GROUND);
    (0..70).for_each(|_| simulation.step());
    let before = robots(&simulation);
    let hash = simulation.state().hash();
    match simulation.change(scenario(&with(changes))) {
        Ok(()) => (before, Ok(simulation)),
        Err(why) => {
            assert_eq!(simulation.state().hash(), hash, "nothing has changed");
            (before, Err(why))
        }
    }
}

fn items(simulation: &Simulation) -> Vec<Item> {
    simulation
        .state()
        .each_item(simulation.scenario())
        .collect()
}

fn of_kind(robots: &[Robot], kind: u8) -> Vec<Robot> {
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
fn with_the_same_scenario_a_run_goes_on_as_if_nothing_were() {
    let (_, simulation) = changed(&[]);
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
fn a_greater_team_has_the_robots_that_there_were_and_new_ones_beside_them() {
    let (before, simulation) = changed(&[("count = 6", "count = 40")]);
    let simulation = simulation.unwrap();
    let after = robots(&simulation);
    assert_eq!(after.len(), 42);
    assert_eq!(after[..8], before[..]);
    assert_apart(&of_kind(&after, 1), 0.4);
    assert!(
        after[8..]
            .iter()
            .all(|robot| robot.distance_m == 0.0 && robot.collisions == 0)
    );
    // In the middle of the world stands a pillar of 1 m.
    let pillar = [10.0, 5.0].into();
    assert!(
        after[8..]
            .iter()
            .all(|robot| robot.at.to(pillar).length() >= 1.4 - 1e-9)
    );
}

#[test]
fn a_smaller_team_has_lost_its_last_robots_only() {
    let (before, simulation) = changed(&[("count = 6", "count = 4"), ("count = 2", "count = 0")]);
    let mut simulation = simulation.unwrap();
    // Kinds that have no robots are still there.
    assert_eq!(robots(&simulation), before[2..6]);
    (0..50).for_each(|_| simulation.step());
    assert_eq!(robots(&simulation).len(), 4);
}

#[test]
fn a_robot_that_comes_and_goes_changes_nothing_for_the_others_meanwhile() {
    let mut simulation = start(GROUND);
    (0..70).for_each(|_| simulation.step());
    let before = robots(&simulation);
    simulation
        .change(scenario(&with(&[("count = 6", "count = 7")])))
        .unwrap();
    simulation.change(scenario(GROUND)).unwrap();
    assert_eq!(robots(&simulation), before);
}

#[test]
fn items_that_were_there_stay_and_stay_found() {
    let mut simulation = start(GROUND);
    while simulation.outcome().found[1] < 2 {
        simulation.step();
    }
    let before = items(&simulation);
    let more = with(&[("count = 3", "count = 4"), ("count = 5", "count = 9")]);
    simulation.change(scenario(&more)).unwrap();
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

const LATE: &str = "
[clock]
time_limit_s = 60
[world]
size_m = [20, 10]
[items.flag]
count = 1
placement = { kind = \"fixed\", at_m = [[2, 5]] }
[items.mine]
count = 2
placement = { kind = \"fixed\", at_m = [[1, 6], [18, 5]] }
[robots.bird]
count = 1
layer = \"air\"
radius_m = 0.4
start = { kind = \"fixed\", at_m = [[1, 5]] }
drive = { max_speed_m_s = 0, max_turn_rate_deg_s = 0 }
[robots.bird.sensors.eye]
kind = \"items\"
range_m = 2
latency_s = 0.5
";

/// A camera that is half a second late has seen an item that is then gone, and others have its
/// number.
#[test]
fn nobody_is_told_of_an_item_that_is_gone_or_of_another_in_its_place() {
    let found = |changes: &[(&str, &str)]| {
        let mut simulation = start(LATE);
        simulation.step();
        simulation
            .change(scenario(&replaced(LATE, changes)))
            .unwrap();
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
    assert_eq!(found(&[]), [[true, true, false]; 2]);
    assert_eq!(
        found(&[("count = 1\nplacement", "count = 0\nplacement")]),
        [[true, false]; 2]
    );
    let none = [
        ("count = 1\nplacement", "count = 0\nplacement"),
        ("count = 2", "count = 0"),
    ];
    assert_eq!(found(&none), [[false; 0]; 2]);
}

#[test]
fn a_run_is_complete_when_what_is_not_found_is_left_out_and_open_when_more_comes_in() {
    let mut simulation = start(GROUND);
    let is_found = |item: &Item| item.found_s.is_some();
    // Until the first mine of all is found, and no flag counts.
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
    let few = with(&[
        ("count = 3", "count = 0"),
        ("count = 5", &format!("count = {}", last + 1)),
    ]);
    simulation.change(scenario(&few)).unwrap();
    assert_eq!(simulation.state().is_over(simulation.scenario()), all_found);
    // So that the test says something whichever was found first: leave all out but clutter.
    let clutter = with(&[
        ("count = 3", "count = 0"),
        ("count = 5", "count = 5\ntarget = false"),
    ]);
    simulation.change(scenario(&clutter)).unwrap();
    assert!(!simulation.outcome().has_failed);
    simulation.change(scenario(GROUND)).unwrap();
    assert!(!simulation.state().is_over(simulation.scenario()));
    assert!(simulation.outcome().has_failed);
}

#[test]
fn the_last_item_to_be_found_can_be_left_out() {
    let line = "
[clock]
time_limit_s = 60
[world]
size_m = [20, 10]
[items.mine]
count = 2
placement = { kind = \"fixed\", at_m = [[4, 5], [18, 5]] }
[robots.rover]
count = 1
radius_m = 0.4
start = { kind = \"fixed\", at_m = [[1, 5]], heading_deg = [0] }
drive = { max_speed_m_s = 1, max_turn_rate_deg_s = 90 }
[robots.rover.sensors.eye]
kind = \"items\"
range_m = 1
";
    let mut simulation = start(line);
    drive(&mut simulation, 50, &[(id(0, 0), 1.0, 0.0)]);
    assert_eq!(simulation.outcome().found, [1]);
    let found_s = items(&simulation)[0].found_s.unwrap();
    simulation
        .change(scenario(&line.replace("count = 2", "count = 1")))
        .unwrap();
    assert!(simulation.state().is_over(simulation.scenario()));
    let outcome = simulation.outcome();
    assert!(!outcome.has_failed);
    assert_eq!(outcome.time_s, found_s);
}

#[test]
fn a_robot_is_at_once_no_faster_than_its_drive_allows() {
    let fast = "
[clock]
step_s = 0.1
time_limit_s = 60
[world]
size_m = [200, 20]
[robots.rover]
count = 1
radius_m = 0.4
start = { kind = \"fixed\", at_m = [[20, 10]], heading_deg = [0] }
drive = { max_speed_m_s = 100, max_acceleration_m_s2 = 100, max_turn_rate_deg_s = 90 }
";
    let mut simulation = start(fast);
    drive(&mut simulation, 10, &[(id(0, 0), 100.0, 0.0)]);
    assert_eq!(first(&simulation).speed_m_s, 100.0);
    let slow = fast
        .replace("max_speed_m_s = 100", "max_speed_m_s = 1")
        .replace("max_acceleration_m_s2 = 100", "max_acceleration_m_s2 = 0.1");
    simulation.change(scenario(&slow)).unwrap();
    assert_eq!(first(&simulation).speed_m_s, 1.0);
    (0..100).for_each(|_| simulation.step());
    assert!(first(&simulation).at.x < 200.0 - 0.4 + 1e-6);
}

#[test]
fn parameters_of_the_others_change_nothing_for_a_robot() {
    let (before, simulation) = changed(&[
        ("max_speed_m_s = 5", "max_speed_m_s = 4"),
        ("range_m = 2\n", "range_m = 1\n"),
    ]);
    let after = robots(&simulation.unwrap());
    assert_eq!(of_kind(&after, 1), of_kind(&before, 1));
    let birds = of_kind(&after, 0);
    assert!(birds.iter().all(|bird| bird.speed_m_s <= 4.0));
}

#[test]
fn what_has_no_room_is_refused_and_nothing_changes() {
    let pillar = "at_m = [10, 5], radius_m = 1";
    // Whoever stands in what is built over half of the world.
    let (_, refused) = changed(&[(pillar, "at_m = [0, 5], radius_m = 10")]);
    assert!(matches!(
        refused,
        Err(NoRoom::Item { .. } | NoRoom::Robot(_))
    ));
    // A robot that has grown into the wall or into another.
    let grown = "radius_m = 0.4\ndrive";
    let (_, refused) = changed(&[(grown, "radius_m = 1.4\ndrive"), ("count = 3", "count = 0")]);
    assert!(matches!(refused, Err(NoRoom::Robot(_))));
    // Birds are above what stands on the ground.
    let text = with(&[("count = 6", "count = 0"), ("count = 3", "count = 0")]);
    let text = text.replace("count = 5", "count = 0");
    let mut simulation = start(&text);
    let built = text.replace(pillar, "at_m = [10, 5], radius_m = 9.9");
    assert!(simulation.change(scenario(&built)).is_ok());
}

#[test]
fn a_given_place_that_somebody_has_by_now_is_refused() {
    let two = "
[clock]
time_limit_s = 60
[world]
size_m = [20, 10]
[robots.rover]
count = 1
radius_m = 0.4
start = { kind = \"fixed\", at_m = [[1, 5], [3, 5]], heading_deg = [0, 0] }
drive = { max_speed_m_s = 1, max_turn_rate_deg_s = 90 }
";
    let mut simulation = start(two);
    let more = scenario(&two.replace("count = 1", "count = 2"));
    drive(&mut simulation, 15, &[(id(0, 0), 1.0, 0.0)]);
    let mut other = simulation.clone();
    assert!(matches!(other.change(more.clone()), Err(NoRoom::Robot(_))));
    drive(&mut simulation, 15, &[(id(0, 0), 1.0, 0.0)]);
    assert!(simulation.change(more).is_ok());
}

/// Robots of some kinds, all within each other's sight and radio, and kinds of items.
fn talkers(kinds: &[(&str, u32)], items: &[&str], brain_hz: f64) -> String {
    let items = items
        .iter()
        .map(|name| format!("[items.{name}]\ncount = 1\n"));
    let items: String = items.collect();
    let robots = kinds.iter().map(|(name, count)| {
        // Each kind in a row of its own, whatever others there are.
        let y = 1.0 + 0.3 * f64::from(name.as_bytes()[0] - b'a');
        let places: Vec<String> = (1..=*count).map(|x| format!("[{x}, {y}]")).collect();
        format!(
            "[robots.{name}]\ncount = {count}\nradius_m = 0.1\nbrain = {{ rate_hz = {brain_hz} }}\n\
             start = {{ kind = \"fixed\", at_m = [{}] }}\n\
             drive = {{ max_speed_m_s = 0, max_turn_rate_deg_s = 0 }}\n\
             radio = {{ range_m = 50, delay_s = 1 }}\n\
             sensors = {{ mates = {{ kind = \"robots\", range_m = 50 }}, \
             eye = {{ kind = \"items\", range_m = 50 }} }}\n",
            places.join(", ")
        )
    });
    let robots: String = robots.collect();
    format!("[clock]\nstep_s = 0.1\ntime_limit_s = 60\n[world]\nsize_m = [20, 10]\n{items}{robots}")
}

/// What a robot is told from now on until so many steps later.
fn told_within(simulation: &mut Simulation, steps: u32, robot: brain::RobotId) -> Vec<Percept> {
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
fn nobody_hears_what_was_sent_to_a_robot_of_another_name() {
    let text = talkers(&[("m", 2), ("z", 1)], &[], 10.0);
    let mut simulation = start(&text);
    told(&mut simulation, [(id(0, 0), say(&[message(7.0)]))]);
    let mut same = simulation.clone();
    let other = talkers(&[("m", 2), ("y", 1)], &[], 10.0);
    simulation.change(scenario(&other)).unwrap();
    assert_eq!(inbox_of(&told_within(&mut simulation, 20, id(1, 0))), []);
    same.change(scenario(&text)).unwrap();
    assert_eq!(inbox_of(&told_within(&mut same, 20, id(1, 0))).len(), 1);
}

#[test]
fn a_message_on_its_way_keeps_its_sender_and_its_item_when_kinds_have_other_numbers() {
    let text = talkers(&[("m", 2)], &["mine"], 10.0);
    let mut simulation = start(&text);
    told(&mut simulation, [(id(0, 0), say(&[message(7.0)]))]);
    let mut without = simulation.clone();
    // A kind of no robots, and a kind of items, that come before the others.
    let more = talkers(&[("a", 0), ("m", 2)], &["flag", "mine"], 10.0);
    simulation.change(scenario(&more)).unwrap();
    let heard = inbox_of(&told_within(&mut simulation, 20, id(1, 1)));
    assert_eq!(heard.len(), 1);
    assert_eq!(heard[0].from, id(1, 0));
    let About::Item { kind, at, .. } = heard[0].message.about else {
        panic!("{heard:?}");
    };
    assert_eq!((kind, at.x), (1, 7.0));
    // Nor does it become one about another item when there are none of its kind.
    let gone = talkers(&[("m", 2)], &["flag"], 10.0);
    without.change(scenario(&gone)).unwrap();
    assert_eq!(inbox_of(&told_within(&mut without, 20, id(0, 1))), []);
}

#[test]
fn what_waits_for_a_brain_names_robots_as_they_are_called_now_and_none_that_is_gone() {
    let text = talkers(&[("b", 1), ("m", 2), ("z", 1)], &[], 0.2);
    let mut simulation = start(&text);
    simulation.step();
    for sender in [id(0, 0), id(1, 0), id(2, 0)] {
        told(&mut simulation, [(sender, say(&[message(7.0)]))]);
    }
    (0..15).for_each(|_| simulation.step());
    let other = talkers(&[("a", 1), ("m", 2), ("y", 1), ("z", 1)], &[], 0.2);
    simulation.change(scenario(&other)).unwrap();
    // Of m/1, who has seen and heard all the others before.
    let percepts = told_within(&mut simulation, 50, id(1, 1));
    let senders: Vec<_> = inbox_of(&percepts).iter().map(|heard| heard.from).collect();
    assert_eq!(senders, [id(1, 0), id(3, 0)]);
    let old = percepts.iter().flat_map(|percept| &percept.neighbours);
    let old = old.filter(|neighbour| neighbour.age_s > 3.15);
    let mut seen: Vec<_> = old.map(|neighbour| neighbour.id).collect();
    seen.sort_unstable();
    seen.dedup();
    assert_eq!(seen, [id(1, 0), id(3, 0)]);
}

const DRAINED: &str = "
[clock]
step_s = 1
time_limit_s = 1000
[world]
size_m = [20, 10]
[robots.rover]
count = 2
radius_m = 0.4
drive = { max_speed_m_s = 0, max_turn_rate_deg_s = 0 }
battery = { capacity_j = 200, idle_w = 10 }
";

/// A run in which each robot has used 100 J, with another capacity from then on.
fn recharged(capacity: &str) -> Simulation {
    let mut simulation = start(DRAINED);
    (0..10).for_each(|_| simulation.step());
    let text = replaced(DRAINED, &[("capacity_j = 200, ", capacity)]);
    simulation.change(scenario(&text)).unwrap();
    simulation
}

#[test]
fn a_battery_that_is_now_too_small_for_what_was_used_is_empty_and_nothing_is_given_back() {
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
fn a_robot_that_was_empty_goes_on_with_a_greater_battery() {
    let mut simulation = recharged("capacity_j = 50, ");
    for (capacity, left) in [("capacity_j = 10000, ", Some(0.99)), ("", None)] {
        let text = replaced(DRAINED, &[("capacity_j = 200, ", capacity)]);
        simulation.change(scenario(&text)).unwrap();
        let robot = first(&simulation);
        assert_eq!((robot.status, robot.battery), (Status::Active, left));
        let before = robot.energy_j;
        simulation.step();
        assert_eq!(first(&simulation).energy_j, before + 10.0);
        let text = replaced(DRAINED, &[("capacity_j = 200, ", "capacity_j = 50, ")]);
        simulation.change(scenario(&text)).unwrap();
        simulation.change(scenario(&text)).unwrap();
        assert_eq!(first(&simulation).status, Status::Empty);
        let text = replaced(DRAINED, &[("capacity_j = 200, ", "capacity_j = 100, ")]);
        simulation.change(scenario(&text)).unwrap();
    }
}

#[test]
fn what_robots_have_cost_is_still_told_when_they_are_gone() {
    let mut simulation = start(&DRAINED.replace("max_speed_m_s = 0", "max_speed_m_s = 0.1"));
    let brisk = |index| (id(0, index), 0.1, 0.0);
    drive(&mut simulation, 20, &[brisk(0), brisk(1)]);
    let before = simulation.outcome();
    assert!(before.distance_m > 0.0);
    assert_eq!((before.energy_j, before.robots_stopped), (400.0, 2));
    let hash = simulation.state().hash();
    for count in [1, 0, 2, 1] {
        let text = replaced(DRAINED, &[("count = 2", &format!("count = {count}"))]);
        simulation.change(scenario(&text)).unwrap();
        assert_eq!(simulation.outcome(), before);
    }
    assert_ne!(simulation.state().hash(), hash);
    // One that has come in since costs its own besides.
    simulation.step();
    assert_eq!(simulation.outcome().energy_j, before.energy_j + 10.0);
}

/// If each newcomer were compared with every other robot, this would take half a minute.
#[test]
fn a_hundred_thousand_robots_come_in_within_seconds_and_apart() {
    let many = with(&[
        ("size_m = [20, 10]", "size_m = [600, 600]"),
        ("count = 6", "count = 100000"),
        (
            "radius_m = 0.4",
            "radius_m = 0.4\nbrain = { behaviours = [] }",
        ),
        (
            "[robots.rover.radio]\nrange_m = 20\nloss_probability = 0.3\n",
            "",
        ),
    ]);
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
    let mut rovers = of_kind(&robots(&simulation), 1);
    assert_eq!(rovers.len(), 100_000);
    rovers.sort_by(|one, other| one.at.x.total_cmp(&other.at.x));
    for (place, one) in rovers.iter().enumerate() {
        let after = rovers[place + 1..].iter();
        let mut near = after.take_while(|other| other.at.x - one.at.x < 0.8);
        assert!(near.all(|other| one.at.to(other.at).length() > 0.8 - 1e-8));
    }
}
