//! The same scenario, seed and run give identical bytes on every path of execution.

use super::random;
use crate::common::{Random, id, read, robots, scenario, start};
use base::engine::{BlockOptions, Runner};
use base::geometry::Point;
use brain::{About, AgentId, Command, Message, Percept, Provenance, Receiver};
use rayon::ThreadPoolBuilder;
use sim::judge::Outcome;
use sim::runner::Runs;
use sim::scenario::Scenario;
use sim::simulation::Simulation;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Everything that a step computes in parallel: rays, radios, items, contacts, two layers.
pub(crate) fn crowd(robots: u32, side_m: f64) -> String {
    let birds = robots / 5;
    let rovers = robots - birds;
    format!(
        "[clock]\nstep_s = 0.1\ntime_limit_s = 100\n[world]\nsize_m = [{side_m}, {side_m}]\n\
         obstacles = [{{ circle = {{ at_m = [10, 10], radius_m = 3 }} }}, {{ polygon_m = [[15, 2], [16, 2], [16, 9]] }}]\n\
         [items.mine]\ncount = {robots}\n[items.scrap]\ncount = 50\ntarget = false\n\
         [robots.bird]\ncount = {birds}\nlayer = \"air\"\nradius_m = 0.3\n\
         drive = {{ max_speed_m_s = 5, max_acceleration_m_s2 = 3, max_turn_rate_deg_s = 90 }}\n\
         [robots.bird.sensors.eye]\nkind = \"items\"\nrange_m = 2\nlatency_s = 0.3\nneeds_line_of_sight = false\n\
         detection_probability = {{ mine = 0.1 }}\nfalse_alarm_rate_per_m2_s = {{ scrap = 0.01 }}\n\
         [robots.bird.radio]\nrange_m = 6\nloss_probability = 0.2\n\
         [robots.rover]\ncount = {rovers}\nradius_m = 0.25\n\
         drive = {{ max_speed_m_s = 1, max_acceleration_m_s2 = 2, max_turn_rate_deg_s = 120 }}\n\
         battery = {{ capacity_j = 60, idle_w = 5, move_j_per_m = 20 }}\ncollision = {{ stop_duration_s = 0.3, max_collisions = 20 }}\n\
         [robots.rover.sensors.sonar]\nkind = \"range\"\nrays = 12\nrange_m = 2\nnoise_m = 0.02\nmiss_probability = 0.1\n\
         [robots.rover.sensors.gps]\nkind = \"position\"\nnoise_m = 1\nrate_hz = 3\n\
         [robots.rover.sensors.mates]\nkind = \"robots\"\nrange_m = 3\ndetection_probability = 0.5\nnoise_m = 0.1\n\
         [robots.rover.sensors.eye]\nkind = \"items\"\nrange_m = 1\ndetection_probability = {{ mine = 0.05, scrap = 0.1 }}\n\
         [robots.rover.radio]\nrange_m = 4\nloss_probability = 0.2\ndelay_s = 0.2\nneeds_line_of_sight = true\n"
    )
}

/// Every seventh robot sends a message, and every eleventh gets a motion command.
pub(crate) fn commands(simulation: &Simulation, step: u32) -> BTreeMap<AgentId, Command> {
    let command_of = |(number, robot): (u32, AgentId)| {
        let mut command = Command::default();
        if (number + step).is_multiple_of(7) {
            command.outbox = vec![
                Message {
                    to: Receiver::All,
                    about: About::Item {
                        kind: 0,
                        at: Point::default(),
                        provenance: Provenance::default(),
                        kind_share: None
                    },
                    confidence: f64::from(number),
                };
                2
            ];
        } else if (number + step).is_multiple_of(11) {
            command.motion.speed_m_s = 1.0;
        } else {
            return None;
        }
        Some((robot, command))
    };
    let ids = robots(simulation).into_iter().map(|robot| robot.id);
    (0..).zip(ids).filter_map(command_of).collect()
}

/// Asserts that a run is the same whether or not `inspect` is called after each step.
pub(crate) fn assert_no_effect(inspect: impl Fn(&mut Simulation, u32)) {
    let text = crowd(120, 40.0);
    let (mut inspected, mut free) = (start(&text), start(&text));
    for step in 0..100 {
        for simulation in [&mut inspected, &mut free] {
            let commands = commands(simulation, step);
            simulation.step_with(BTreeMap::new(), commands).unwrap();
        }
        inspect(&mut inspected, step);
        assert_eq!(inspected.state().hash(), free.state().hash());
    }
    assert_eq!(inspected.outcome(), free.outcome());
}

/// State hashes after each step, percepts of some robots, and the outcome.
fn trace(simulation: &mut Simulation, steps: u32) -> (Vec<u64>, Vec<Option<Percept>>, Outcome) {
    let (mut hashes, mut percepts) = (Vec::new(), Vec::new());
    for step in 0..steps {
        let commands = commands(simulation, step);
        simulation.step_with(BTreeMap::new(), commands).unwrap();
        hashes.push(simulation.state().hash());
        let some = robots(simulation)
            .into_iter()
            .map(|robot| robot.id)
            .step_by(97);
        for id in some.collect::<Vec<_>>() {
            percepts.push(simulation.percept(id).unwrap());
        }
    }
    (hashes, percepts, simulation.outcome())
}

#[test]
fn a_world_of_5000_robots_is_identical_for_any_number_of_threads() {
    let scenario = scenario(&crowd(5000, 160.0));
    let on = |threads| {
        let pool = ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        let mut simulation = Simulation::new(Arc::clone(&scenario), 3, 1).unwrap();
        pool.install(|| trace(&mut simulation, 12))
    };
    let alone = on(1);
    assert!(
        alone.2.collisions > 20 && alone.2.found[0] > 100,
        "{:?}",
        alone.2
    );
    let received = alone
        .1
        .iter()
        .flatten()
        .map(|percept| percept.inbox.len())
        .sum::<usize>();
    assert!(received > 50, "{received}");
    for threads in [2, 3, 8] {
        assert_eq!(on(threads), alone, "{threads} threads");
    }
}

#[test]
fn the_age_of_neighbour_lists_has_no_effect() {
    let scenario = scenario(&crowd(120, 25.0));
    let rebuilt = |each: u32| {
        let mut simulation = Simulation::new(Arc::clone(&scenario), 1, 0).unwrap();
        let mut hashes = Vec::new();
        for step in 0..120 {
            if each > 0 && step % each == 0 {
                // Restoring a state rebuilds the lists.
                simulation.restore(simulation.state().clone());
            }
            let commands = commands(&simulation, step);
            simulation.step_with(BTreeMap::new(), commands).unwrap();
            hashes.push(simulation.state().hash());
        }
        (hashes, simulation.outcome())
    };
    let never = rebuilt(0);
    for each in [1, 2, 7, 50] {
        assert_eq!(rebuilt(each), never, "every {each} steps");
    }
}

#[test]
fn a_run_continues_from_any_copy_of_its_state() {
    let scenario = scenario(&crowd(60, 20.0));
    let mut simulation = Simulation::new(Arc::clone(&scenario), 1, 0).unwrap();
    let mut states = vec![simulation.state().clone()];
    for _ in 0..60 {
        simulation.step();
        states.push(simulation.state().clone());
    }
    // In reverse order, and into a simulation that is in a different state.
    let mut other = Simulation::new(scenario, 99, 7).unwrap();
    (0..10).for_each(|_| other.step());
    for (tick, state) in states.iter().enumerate().rev().step_by(7) {
        other.restore(state.clone());
        for later in &states[tick..60] {
            assert_eq!(other.state().hash(), later.hash());
            other.step();
        }
        assert_eq!(other.outcome(), simulation.outcome());
    }
}

/// The outcome of a run that is stepped one by one.
fn by_hand(scenario: &Arc<Scenario>, seed: u64, run: u64) -> Option<Outcome> {
    let mut simulation = Simulation::new(Arc::clone(scenario), seed, run).ok()?;
    Some(simulation.finish())
}

#[test]
fn runs_of_a_block_equal_runs_stepped_one_by_one() {
    for seed in 0..60 {
        let Ok(scenario) = read(&random::text(seed)) else {
            continue;
        };
        let runs = Runs(Arc::new(scenario));
        let names: Vec<_> = runs
            .columns()
            .into_iter()
            .map(|column| column.name)
            .collect();
        // One block, and blocks of one run: only the former reuses its scratch memory.
        let block = runs.run_block(seed, 3..9, BlockOptions::ALONE);
        for (place, run) in (3..9).enumerate() {
            let alone = runs.run_block(seed, run..run + 1, BlockOptions::ALONE);
            let bits = |columns: &[Vec<f64>], place: usize| -> Vec<u64> {
                columns
                    .iter()
                    .map(|column| column[place].to_bits())
                    .collect()
            };
            assert_eq!(bits(&block, place), bits(&alone, 0), "{seed}");
            let Some(outcome) = by_hand(&runs.0, seed, run) else {
                assert!(alone[0][0].is_nan());
                continue;
            };
            let value =
                |name: &str| alone[names.iter().position(|other| other == name).unwrap()][0];
            assert_eq!(value("time_s"), outcome.time_s);
            assert_eq!(value("energy_j"), outcome.energy_j);
            assert_eq!(value("distance_m"), outcome.distance_m);
            assert_eq!(value("collisions"), outcome.collisions as f64);
            assert_eq!(value("false_alarms"), outcome.false_alarms as f64);
            assert_eq!(value("robots_stopped"), f64::from(outcome.robots_stopped));
            assert_eq!(value("failed"), f64::from(u8::from(outcome.has_failed)));
        }
    }
}

/// A robot's random numbers, and its position and those of items, do not depend on other robots.
#[test]
fn an_added_robot_or_kind_does_not_affect_robots_that_do_not_meet_it() {
    let field = |rovers: u32, more: &str| {
        format!(
            "[clock]\ntime_limit_s = 100\n[world]\nsize_m = [500, 500]\n[items.mine]\ncount = 20\n\
             placement = {{ kind = \"clustered\", clusters = 3, spread_m = 9 }}\n\
             [robots.rover]\ncount = {rovers}\nradius_m = 0.3\n\
             [robots.rover.sensors.gps]\nkind = \"position\"\nnoise_m = 2\n\
             [robots.rover.sensors.sonar]\nkind = \"range\"\nrays = 9\nrange_m = 4\nnoise_m = 0.1\nspurious_return_probability = 0.5\n\
             [robots.rover.sensors.eye]\nkind = \"items\"\nrange_m = 50\ndetection_probability = {{ mine = 0.5 }}\nnoise_m = 1\n\
             false_alarm_rate_per_m2_s = {{ mine = 0.001 }}\n{more}"
        )
    };
    let kind = "[robots.zebra]\ncount = 5\nradius_m = 0.3\n";
    let items = "[items.stone]\ncount = 7\ntarget = false\n";
    let perceived = |text: &str| {
        let mut simulation = start(text);
        let mut percepts = Vec::new();
        for _ in 0..30 {
            let percepts_now = (0..6).map(|index| simulation.percept(id(0, index)).unwrap());
            // Percepts contain the size of the team.
            percepts
                .extend(percepts_now.map(|percept| percept.map(|p| Percept { team_size: 0, ..p })));
            simulation.step();
        }
        let items = simulation.state().each_item(simulation.scenario());
        let mines: Vec<_> = items.filter(|item| item.kind == 0).collect();
        (percepts, mines)
    };
    let alone = perceived(&field(6, ""));
    let contacts = alone
        .0
        .iter()
        .flatten()
        .map(|percept| percept.contacts.len())
        .sum::<usize>();
    assert!(contacts > 100, "{contacts}");
    // In a world of this size no robot sees or meets another.
    assert_eq!(perceived(&field(7, "")).0, alone.0);
    assert_eq!(perceived(&field(40, "")).0, alone.0);
    assert_eq!(perceived(&field(6, kind)), alone);
    assert_eq!(perceived(&field(6, items)).1, alone.1);
}

/// Detections of an item use random numbers of its kind and index, independent of other kinds.
#[test]
fn more_items_of_one_kind_do_not_affect_detections_of_another() {
    let field = |mines: u32| {
        format!(
            "[clock]\ntime_limit_s = 100\n[world]\nsize_m = [20, 20]\n[items.mine]\ncount = {mines}\n\
             [items.stone]\ncount = 9\ntarget = false\n[robots.rover]\ncount = 1\nradius_m = 0.3\n\
             drive = {{ max_speed_m_s = 0, max_turn_rate_deg_s = 0 }}\n\
             [robots.rover.sensors.eye]\nkind = \"items\"\nrange_m = 50\nnoise_m = 1\n\
             detection_probability = {{ mine = 0.5, stone = 0.5 }}\n"
        )
    };
    let seen = |mines: u32| {
        let mut simulation = start(&field(mines));
        let mut stones = Vec::new();
        for _ in 0..50 {
            let contacts = simulation.percept(id(0, 0)).unwrap().unwrap().contacts;
            stones.extend(contacts.into_iter().filter(|contact| contact.kind == 1));
            simulation.step();
        }
        stones.sort_by(|one, other| one.range_m.total_cmp(&other.range_m));
        stones
    };
    assert!(seen(3).len() > 100);
    assert_eq!(seen(3), seen(5));
}

#[test]
fn seeds_and_runs_give_different_worlds() {
    let text = crowd(20, 20.0);
    let scenario = scenario(&text);
    let mut random = Random::new(1);
    let mut hashes = std::collections::BTreeSet::new();
    for _ in 0..50 {
        let (seed, run) = (
            u64::from(random.below(1 << 30)),
            u64::from(random.below(1 << 30)),
        );
        let simulation = Simulation::new(Arc::clone(&scenario), seed, run).unwrap();
        assert!(hashes.insert(simulation.state().hash()));
        let again = Simulation::new(Arc::clone(&scenario), seed, run).unwrap();
        assert_eq!(simulation.state().hash(), again.state().hash());
    }
}
