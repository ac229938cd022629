//! Common random numbers: the random numbers of a kind do not depend on which other kinds exist.

use crate::common::{go, id, message, robots, send, start, step_with, with};
use base::geometry::Point;
use brain::{AgentId, Percept};
use sim::simulation::Simulation;

const ROVERS: &str = r#"
world = { size_m = [20, 15], obstacles = [{ circle = { at_m = [10, 5], radius_m = 1 } }] }
items.mine.count = 9
[items.clutter]
count = 9
target = false
placement = { kind = "clustered", clusters = 3, spread_m = 1 }
[robots.rover]
count = 5
radius_m = 0.3
sensors.compass = { kind = "heading", noise_deg = 5 }
sensors.mates = { kind = "robots", range_m = 9, detection_probability = 0.5, noise_m = 0.1 }
radio = { range_m = 50, loss_probability = 0.5 }
sensors.eye = { kind = "items", range_m = 2, latency_s = 0.3, noise_m = 0.1,
    detection_probability = { clutter = 0.2, mine = 0.3 },
    false_alarm_rate_per_m2_s = { clutter = 0.2, mine = 0.1 } }
sensors.sonar = { kind = "range", rays = 12, range_m = 3, noise_m = 0.02, miss_probability = 0.1 }
"#;

/// Kinds that are first in alphabetical order, and do not interact with the others.
const OTHERS: &str = r#"
items.aaa = { count = 20, target = false }
[robots.aaa]
count = 4
layer = "air"
radius_m = 0.4
drive = { max_speed_m_s = 5, max_turn_rate_deg_s = 90 }
"#;

fn kind(simulation: &Simulation, name: &str) -> u8 {
    let mut names = simulation.scenario().robot_kinds();
    u8::try_from(names.position(|other| other == name).unwrap()).unwrap()
}

/// A rover's percept without neighbours, contacts and messages of the added kinds.
fn perceived(simulation: &mut Simulation, index: u32) -> Percept {
    let rover = kind(simulation, "rover");
    let mut percept = simulation.percept(id(rover, index)).unwrap().unwrap();
    let named = |id: AgentId| AgentId { kind: 0, ..id };
    percept.neighbours.retain(|other| other.id.kind == rover);
    for other in &mut percept.neighbours {
        other.id = named(other.id);
    }
    for received in &mut percept.inbox {
        received.from = named(received.from);
    }
    let first = simulation.scenario().item_kinds().next() == Some("aaa");
    for contact in &mut percept.contacts {
        contact.kind -= u16::from(first);
    }
    percept
        .contacts
        .sort_by(|one, other| one.range_m.total_cmp(&other.range_m));
    percept
}

/// Places of the items of a kind.
fn places(simulation: &Simulation, name: &str) -> Vec<Point> {
    let kinds: Vec<&str> = simulation.scenario().item_kinds().collect();
    let items = simulation.state().each_item(simulation.scenario());
    let items = items.filter(|item| kinds[usize::from(item.kind)] == name);
    items.map(|item| item.at).collect()
}

fn rovers(simulation: &Simulation) -> Vec<(Point, f64, u32)> {
    let rover = kind(simulation, "rover");
    let rovers = robots(simulation).into_iter();
    let rovers = rovers.filter(|robot| robot.id.kind == rover);
    let seen = rovers.map(|robot| (robot.at, robot.heading_rad, robot.collisions));
    seen.collect()
}

/// One step in which the first rover sends a message, and the next gets a motion command.
fn step(simulation: &mut Simulation) {
    let rover = kind(simulation, "rover");
    step_with(
        simulation,
        [
            (id(rover, 0), send(&[message(1.0); 2])),
            (id(rover, 1), go(0.3, 1.0)),
        ],
    );
}

#[test]
fn robots_of_another_kind_do_not_affect_other_streams() {
    let mut alone = start(ROVERS);
    let mut among = start(&with(ROVERS, OTHERS));
    assert_eq!(kind(&among, "rover"), 1);
    let mut contacts = 0;
    for _ in 0..200 {
        assert_eq!(rovers(&alone), rovers(&among));
        for index in 0..5 {
            let percept = perceived(&mut alone, index);
            contacts += percept.contacts.len();
            let same = Percept {
                id: percept.id,
                ..perceived(&mut among, index)
            };
            assert_eq!(percept, same);
        }
        step(&mut alone);
        step(&mut among);
    }
    assert!(contacts > 100, "{contacts}");
}

#[test]
fn items_of_another_kind_do_not_move_the_others() {
    let [alone, among] = [start(ROVERS), start(&with(ROVERS, OTHERS))];
    for name in ["clutter", "mine"] {
        assert_eq!(places(&alone, name), places(&among, name));
    }
}

#[test]
fn kinds_of_different_names_have_different_streams() {
    let renamed = start(&ROVERS.replace("rover", "tank").replace("mine", "flag"));
    let alone = start(ROVERS);
    let ats = [&alone, &renamed].map(|run| robots(run).iter().map(|robot| robot.at).collect());
    let [here, there]: [Vec<Point>; 2] = ats;
    assert!(here.iter().all(|at| !there.contains(at)));
    let flags = places(&renamed, "flag");
    assert!(places(&alone, "mine").iter().all(|at| !flags.contains(at)));
}
