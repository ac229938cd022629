//! Energy consumption against values computed by hand.

use crate::common::{first, go, id, robots, start, step_with, with};
use brain::{Command, Motion, SensorRequest};
use sim::run::Status;
use sim::simulation::Simulation;

/// A robot with this battery at the left end of a long field, facing along it.
fn field(battery: &str, more: &str) -> String {
    format!(
        "[clock]\nstep_s = 0.1\ntime_limit_s = 1000\n[world]\nsize_m = [100, 10]\n\
         [terrain.mud]\nspeed = 0.5\nenergy = 3\nareas_m = [[[50, 0], [100, 0], [100, 10], [50, 10]]]\n\
         [robots.rover]\ncount = 1\nradius_m = 0.5\n\
         start = {{ kind = \"fixed\", at_m = [[10, 5], [10, 7], [10, 3]], heading_deg = [0, 0, 0] }}\n\
         drive = {{ max_speed_m_s = 2, max_reverse_speed_m_s = 2, max_turn_rate_deg_s = 90 }}\n\
         brain = {{ behaviours = [] }}\nbattery = {{ {battery} }}\n{more}"
    )
}

fn drive(simulation: &mut Simulation, steps: u32, speed: f64, turn: f64) {
    (0..steps).for_each(|_| step_with(simulation, [(id(0, 0), go(speed, turn))]));
}

fn assert_energy(simulation: &Simulation, expected_j: f64) {
    let energy_j = first(simulation).energy_j;
    assert!(
        (energy_j - expected_j).abs() < 1e-9 * expected_j.max(1.0),
        "{energy_j} {expected_j}"
    );
}

const VALUES: &str = "idle_w = 10, move_w = 4, move_j_per_m = 7";

#[test]
fn a_stationary_robot_consumes_its_idle_power() {
    let mut simulation = start(&field(VALUES, ""));
    drive(&mut simulation, 30, 0.0, 0.0);
    assert_energy(&simulation, 10.0 * 3.0);
}

#[test]
fn moving_consumes_power_and_energy_per_metre_forwards_and_in_reverse() {
    for speed in [2.0, 0.5, -2.0] {
        let mut simulation = start(&field(VALUES, ""));
        drive(&mut simulation, 30, speed, 0.0);
        assert_energy(&simulation, 14.0 * 3.0 + 7.0 * speed.abs() * 3.0);
    }
}

#[test]
fn turning_on_the_spot_consumes_the_power_of_moving() {
    let mut simulation = start(&field(VALUES, ""));
    drive(&mut simulation, 30, 0.0, 1.0);
    assert_energy(&simulation, 14.0 * 3.0);
}

#[test]
fn a_robot_blocked_by_a_wall_consumes_no_energy_of_motion() {
    let mut simulation = start(&field(VALUES, ""));
    // 9.5 m to the wall behind it at 2 m/s, then one more second.
    drive(&mut simulation, 58, -2.0, 0.0);
    let moving_s = 4.8;
    assert_energy(&simulation, 10.0 * 5.8 + 4.0 * moving_s + 7.0 * 9.5);
}

#[test]
fn the_energy_factor_of_terrain_applies_to_motion_only() {
    let text = field(VALUES, "").replace("[10, 5]", "[60, 5]");
    let mut simulation = start(&text);
    drive(&mut simulation, 20, 2.0, 0.0);
    // Half the speed.
    assert!((first(&simulation).distance_m - 2.0).abs() < 1e-9);
    assert_energy(&simulation, 10.0 * 2.0 + 3.0 * (4.0 * 2.0 + 7.0 * 2.0));
    drive(&mut simulation, 10, 0.0, 0.0);
    assert_energy(&simulation, 10.0 * 3.0 + 3.0 * (4.0 * 2.0 + 7.0 * 2.0));
    // Terrain does not affect a flying robot.
    let mut simulation = start(&text.replace("radius_m = 0.5", "radius_m = 0.5\nlayer = \"air\""));
    drive(&mut simulation, 20, 2.0, 0.0);
    assert_energy(&simulation, 14.0 * 2.0 + 7.0 * 4.0);
}

#[test]
fn energy_per_metre_grows_with_the_relative_mass_of_the_payload() {
    let loaded = "robots.rover = { mass_kg = 20, payload_kg = 5 }";
    let mut simulation = start(&with(&field(VALUES, ""), loaded));
    drive(&mut simulation, 10, 2.0, 0.0);
    assert_energy(&simulation, 14.0 + 7.0 * 2.0 * 1.25);
}

#[test]
fn active_sensors_and_the_radio_consume_their_power() {
    let more = "[robots.rover.sensors.compass]\nkind = \"heading\"\npower_w = 1\n\
                [robots.rover.sensors.gps]\nkind = \"position\"\npower_w = 2\nrate_hz = 1\n\
                [robots.rover.radio]\nrange_m = 5\npower_w = 8\n";
    let mut simulation = start(&field("idle_w = 10", more));
    drive(&mut simulation, 10, 0.0, 0.0);
    assert_energy(&simulation, 21.0);
    let switch = |on| Command {
        requests: vec![SensorRequest { sensor: 1, on }],
        ..Command::default()
    };
    // A switch takes effect in the step of the command.
    step_with(&mut simulation, [(id(0, 0), switch(false))]);
    drive(&mut simulation, 9, 0.0, 0.0);
    assert_energy(&simulation, 21.0 + 19.0);
    step_with(&mut simulation, [(id(0, 0), switch(true))]);
    assert_energy(&simulation, 40.0 + 2.1);
}

#[test]
fn a_robot_stops_after_the_step_that_empties_its_battery() {
    // 2 J per step: 9 J last for four and a half steps.
    let mut simulation = start(&field("capacity_j = 9, idle_w = 20", ""));
    let mut states = Vec::new();
    for _ in 0..7 {
        drive(&mut simulation, 1, 1.0, 0.0);
        let robot = first(&simulation);
        states.push((robot.status, robot.energy_j, robot.battery.unwrap()));
        assert_eq!(simulation.outcome().energy_j, robot.energy_j);
    }
    let expected = [2.0, 4.0, 6.0, 8.0, 9.0, 9.0, 9.0];
    for (step, (status, energy_j, battery)) in states.into_iter().enumerate() {
        assert!((energy_j - expected[step]).abs() < 1e-12);
        assert!((battery - (1.0 - expected[step] / 9.0)).abs() < 1e-12);
        let is_empty = step >= 4;
        assert_eq!(status == Status::Empty, is_empty, "{step}");
    }
    let robot = first(&simulation);
    assert!(
        (robot.distance_m - 0.5).abs() < 1e-12,
        "it still moves in the step that empties the battery"
    );
    assert_eq!(robot.setpoint, Motion::default());
    assert_eq!(simulation.outcome().robots_stopped, 1);
    assert!(simulation.state().is_over(simulation.scenario()));
    assert_eq!(simulation.percept(id(0, 0)).unwrap(), None);
}

#[test]
fn a_percept_contains_the_remaining_energy() {
    let mut simulation = start(&field("capacity_j = 100, idle_w = 20", ""));
    drive(&mut simulation, 10, 0.0, 0.0);
    let percept = simulation.percept(id(0, 0)).unwrap().unwrap();
    assert!((percept.battery.unwrap().value - 0.8).abs() < 1e-12);
    // An infinite battery has no reading; a robot without a battery consumes nothing.
    let mut simulation = start(&field("idle_w = 20", ""));
    drive(&mut simulation, 10, 0.0, 0.0);
    assert_eq!(simulation.percept(id(0, 0)).unwrap().unwrap().battery, None);
    assert_energy(&simulation, 20.0);
    let text = field("idle_w = 20", "").replace("battery = { idle_w = 20 }", "");
    let mut simulation = start(&text);
    drive(&mut simulation, 10, 1.0, 0.0);
    assert_energy(&simulation, 0.0);
}

#[test]
fn a_run_ends_when_the_last_robot_has_stopped() {
    let text = field("capacity_j = 4, idle_w = 20", "");
    let strong = "robots.rover.count = 2\n[robots.zebra]\nbattery = { capacity_j = 8, idle_w = 20 }\n\
                  drive = { max_speed_m_s = 0, max_turn_rate_deg_s = 0 }\n";
    let mut simulation = start(&with(&text, strong));
    let outcome = simulation.finish();
    assert_eq!(simulation.state().tick(), 4);
    assert_eq!(outcome.robots_stopped, 3);
    // Without targets the run cannot fail, and its duration is the time limit.
    assert_eq!((outcome.has_failed, outcome.time_s), (false, 1000.0));
    assert!((outcome.energy_j - 16.0).abs() < 1e-12);
    assert!(
        robots(&simulation)
            .iter()
            .all(|robot| robot.status == Status::Empty)
    );
}
