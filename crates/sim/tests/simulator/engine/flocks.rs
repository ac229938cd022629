//! Robots whose only behaviour is `flock` are computed together, with the same results as separate
//! brains.

use crate::common::{go, id, robots, scenario, start, step_with};
use brain::{AgentId, Command, SensorRequest};
use rayon::ThreadPoolBuilder;
use sim::simulation::Simulation;
use std::collections::BTreeMap;

/// Birds with the rule of `ABMFrameworksComparison`, in steps of a second.
pub(crate) fn birds(count: u32, side_m: f64, more: &str) -> String {
    format!(
        "[clock]\nstep_s = 1\ntime_limit_s = 1000\n[world]\nsize_m = [{side_m}, {side_m}]\nperiodic = true\n\
         [robots.bird]\ncount = {count}\nradius_m = 0\ndrive = {{ max_speed_m_s = 1 }}\n\
         sensors.eyes = {{ kind = \"robots\", range_m = 15, course_noise_deg = 0 }}\n\
         [[robots.bird.brain.behaviours]]\nkind = \"flock\"\nseparation_m = 4\n\
         separation = 0.015\nalignment = 0.05\ncohesion = 0.03\n{more}\n"
    )
}

/// The turn rates that the brains command, given their percepts.
fn commanded_by_percepts(simulation: &mut Simulation) -> Vec<(AgentId, f64)> {
    let ids: Vec<AgentId> = robots(simulation).iter().map(|robot| robot.id).collect();
    let commanded = |id: &AgentId| {
        let percept = simulation.percept(*id).unwrap().unwrap();
        let mut brain = simulation.scenario().brain(id.kind).unwrap().clone();
        (*id, brain.step(&percept).motion.turn_rate_rad_s)
    };
    ids.iter().map(commanded).collect()
}

fn assert_same_as_by_percepts(text: &str, steps: u32) {
    let mut simulation = start(text);
    let mut turned = 0.0_f64;
    for _ in 0..steps {
        let expected = commanded_by_percepts(&mut simulation);
        simulation.step();
        for (robot, (id, turn_rate)) in robots(&simulation).iter().zip(expected) {
            let off = (robot.setpoint.turn_rate_rad_s - turn_rate).abs();
            assert!(off < 1e-11, "{id:?}: {:?} for {turn_rate}", robot.setpoint);
            turned = turned.max(turn_rate.abs());
        }
    }
    assert!(turned > 0.01, "{turned}");
}

#[test]
fn a_flock_equals_separate_brains_with_percepts() {
    assert_same_as_by_percepts(&birds(300, 120.0, ""), 40);
    assert_same_as_by_percepts(&birds(150, 40.0, "noise_deg = 40\naverages = false"), 20);
}

#[test]
fn a_flock_of_discs_among_other_robots_equals_separate_brains() {
    let others = "[robots.a_rover]\ncount = 30\nradius_m = 0.4\n\
                  drive = { max_speed_m_s = 2, max_turn_rate_deg_s = 60 }\n\
                  sensors.sonar = { kind = \"range\", rays = 6, range_m = 3 }\n\
                  [robots.duck]\ncount = 40\nradius_m = 0.5\n\
                  drive = { max_speed_m_s = 1, max_turn_rate_deg_s = 45 }\n\
                  sensors.eyes = { kind = \"robots\", range_m = 9 }\n\
                  brain.behaviours = [{ kind = \"flock\", separation_m = 3 }]";
    let text = birds(60, 60.0, others);
    let mut simulation = start(&text);
    for _ in 0..40 {
        let expected = commanded_by_percepts(&mut simulation);
        simulation.step();
        let flocks = robots(&simulation);
        let flocks = flocks
            .iter()
            .zip(expected)
            .filter(|(robot, _)| robot.id.kind > 0);
        for (robot, (id, turn_rate)) in flocks {
            let off = (robot.setpoint.turn_rate_rad_s - turn_rate).abs();
            assert!(off < 1e-11, "{id:?}: {:?} for {turn_rate}", robot.setpoint);
        }
    }
    assert!(simulation.outcome().collisions > 0);
}

#[test]
fn a_flock_is_identical_for_any_number_of_threads_and_from_any_copy() {
    let scenario = scenario(&birds(5000, 530.0, "noise_deg = 5"));
    let hashes = |threads: usize| {
        let pool = ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        let mut simulation = Simulation::new(scenario.clone(), 1, 0).unwrap();
        pool.install(|| {
            let steps = (0..30).map(|_| {
                simulation.step();
                let copy = simulation.state().clone();
                simulation.restore(copy);
                simulation.state().hash()
            });
            steps.collect::<Vec<u64>>()
        })
    };
    let one = hashes(1);
    assert_eq!(one, hashes(2));
    assert_eq!(one, hashes(3));
    assert!(one.windows(2).all(|pair| pair[0] != pair[1]));
}

#[test]
fn an_external_command_does_not_affect_the_rest_of_a_step() {
    let text = birds(200, 100.0, "noise_deg = 5");
    let (mut plain, mut commanded) = (start(&text), start(&text));
    for _ in 0..30 {
        plain.step();
        let setpoint = robots(&plain)[7].setpoint;
        let command = go(setpoint.speed_m_s, setpoint.turn_rate_rad_s);
        step_with(&mut commanded, [(id(0, 7), command)]);
        assert_eq!(plain.state().hash(), commanded.state().hash());
    }
}

#[test]
fn a_robot_with_its_sensor_off_continues_straight() {
    let mut simulation = start(&birds(100, 60.0, ""));
    let off = Command {
        requests: vec![SensorRequest {
            sensor: 0,
            on: false,
        }],
        ..go(1.0, 0.0)
    };
    step_with(&mut simulation, [(id(0, 3), off)]);
    for _ in 0..10 {
        simulation.step();
        let turns: Vec<f64> = robots(&simulation)
            .iter()
            .map(|robot| robot.setpoint.turn_rate_rad_s.abs())
            .collect();
        assert!(turns[3] == 0.0 && turns.iter().sum::<f64>() > 0.1);
    }
    simulation
        .step_with(BTreeMap::new(), BTreeMap::new())
        .unwrap();
}

#[test]
fn a_flock_with_latency_or_collisions_uses_percepts() {
    let text = birds(60, 60.0, "");
    let late = text.replace("range_m = 15", "range_m = 15, latency_s = 2");
    let mut simulation = start(&late);
    simulation.step();
    assert!(
        robots(&simulation)
            .iter()
            .all(|robot| robot.setpoint.turn_rate_rad_s == 0.0)
    );
    let battery = "[robots.bird.battery]\ncapacity_j = 10\nidle_w = 1\n";
    let mut simulation = start(&format!("{text}\n{battery}"));
    (0..12).for_each(|_| simulation.step());
    assert!(
        robots(&simulation)
            .iter()
            .all(|robot| robot.distance_m <= 10.0)
    );
    assert!(simulation.state().is_over(simulation.scenario()));
}
