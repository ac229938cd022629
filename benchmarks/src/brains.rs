//! A hundred robots with beliefs, goals, trust, navigation around each other, and a reflex.
//!
//! They start along the walls of a hall of 70 m with pillars, and each navigates to a place further along
//! the walls. Meanwhile, they search for items and report them to each other.

use crate::scenarios::read;
use crate::threads::by_turns;
use sim::scenario::Scenario;
use sim::simulation::Simulation;
use std::sync::Arc;

const ROBOTS: u32 = 100;

/// Destination of each robot, as a number of positions further along: opposite, so that all meet in the
/// middle, or across a corner.
const CROSSINGS: [(&str, u32); 2] = [("opposite", 50), ("round a corner", 20)];

/// Steps of a run: most robots are then half way.
const STEPS: u32 = 400;

/// Samples for each number of threads.
const PIECES: u32 = 9;

/// Everything except the number of robots, their starts and their destinations.
const TEXT: &str = r#"
[clock]
time_limit_s = 10000

[world]
size_m = [70, 70]
obstacles = [
    { circle = { at_m = [20, 20], radius_m = 1 } },
    { circle = { at_m = [50, 20], radius_m = 1 } },
    { circle = { at_m = [50, 50], radius_m = 1 } },
    { circle = { at_m = [20, 50], radius_m = 1 } },
]

[items.mine]
count = 20

[robots.rover]
radius_m = 0.25
drive = { max_speed_m_s = 1, max_acceleration_m_s2 = 1, max_turn_rate_deg_s = 120 }
radio = { range_m = 10 }

[robots.rover.sensors]
sonar = { kind = "range", rays = 24, range_m = 4 }
gps = { kind = "position", noise_m = 0.1 }
compass = { kind = "heading", noise_deg = 1 }
eye = { kind = "robots", range_m = 6 }

[robots.rover.sensors.camera]
kind = "items"
range_m = 3
fov_deg = 70
detection_probability = { mine = 0.7 }
false_alarm_rate_per_m2_s = { mine = 0.001 }
rate_hz = 5
"#;

/// Prints the table.
pub(crate) fn report() {
    println!("| destination | threads | thousands of updates/s | thousands/s, wall clock | hash |");
    println!("|---|---|---|---|---|");
    for (name, further) in CROSSINGS {
        compare(name, further);
    }
}

/// Alternates between one thread and two.
fn compare(name: &str, further: u32) {
    let simulation = Simulation::new(Arc::new(scenario(further)), 1, 0);
    let mut simulation = simulation.expect("there is room");
    let start = simulation.state().clone();
    let updates = f64::from(ROBOTS) * f64::from(STEPS);
    let (rates, hash) = by_turns(PIECES, updates / 1e3, |_| {
        simulation.restore(start.clone());
        (0..STEPS).for_each(|_| simulation.step());
        simulation.state().hash()
    });
    for each in &rates {
        let (threads, rate, by_wall) = (each.threads, each.a_second, each.by_wall);
        println!("| {name} | {threads} | {rate:.0} | {by_wall:.0} | {hash:016x} |");
    }
}

fn scenario(further: u32) -> Scenario {
    let [from, to] = [0, further].map(|shift| {
        let places = (0..ROBOTS).map(|number| place((number + shift) % ROBOTS));
        places.collect::<Vec<_>>().join(", ")
    });
    let text = format!(
        "{TEXT}\n[robots.rover.start]\nkind = \"fixed\"\nat_m = [{from}]\n\n\
         [robots.rover.brain]\narbitration = {{ kind = \"goals\" }}\nbehaviours = [\
         {{ kind = \"navigate\", assignment = \"one_each\", waypoints_m = [{to}] }}, {{ kind = \"avoid\" }}]\n"
    );
    let text = text.replacen(
        "[robots.rover]\n",
        &format!("[robots.rover]\ncount = {ROBOTS}\n"),
        1,
    );
    read("brains.toml", &text)
}

/// Positions along the walls, a quarter of the robots at each.
fn place(number: u32) -> String {
    let (side, along) = (number / 25, 1.0 + 2.75 * f64::from(number % 25));
    let [x, y] = match side {
        0 => [along, 1.0],
        1 => [69.0, along],
        2 => [70.0 - along, 69.0],
        _ => [1.0, 70.0 - along],
    };
    format!("[{x}, {y}]")
}
