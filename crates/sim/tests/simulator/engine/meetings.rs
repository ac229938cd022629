//! Contacts within a step, compared with a reference that uses many tiny steps.

use crate::common::{Random, go, id, motion, robots, scenario, start, step_with};
use base::engine::{BlockOptions, Runner};
use base::geometry::Point;
use base::trig::sin_cos;
use brain::Motion;
use sim::runner::Runs;
use sim::simulation::Simulation;

/// Number of tiny steps per step.
const TINY: u32 = 10_000;

const SIDE_M: f64 = 4.0;

/// A body that moves in tiny steps.
#[derive(Debug, Clone, Copy)]
struct Body {
    at: Point,
    radius_m: f64,
    heading_rad: f64,
    motion: Motion,
    is_stopped: bool,
}

impl Body {
    /// Its position a tiny step later, on the arc of its whole step.
    fn next(&self, start: &Self, tick: u32) -> Point {
        let share = f64::from(tick) / f64::from(TINY);
        let turn = self.motion.turn_rate_rad_s * share;
        let length = self.motion.speed_m_s * share;
        let (sine, cosine) = sin_cos(start.heading_rad + turn / 2.0);
        let chord = if turn == 0.0 {
            1.0
        } else {
            libm::sin(turn / 2.0) / (turn / 2.0)
        };
        let way = Point { x: cosine, y: sine }.times(length * chord);
        start.at.plus(way)
    }

    fn meets_border(&self) -> bool {
        let Point { x, y } = self.at;
        [x, y, SIDE_M - x, SIDE_M - y]
            .iter()
            .any(|gap| *gap < self.radius_m)
    }
}

/// One step of a second as many tiny steps; a body stops at its first contact. Returns the number
/// of contacts, of two bodies or of a body and the border.
fn tiny_steps(bodies: &mut [Body]) -> u64 {
    let starts = bodies.to_vec();
    let mut contacts = std::collections::BTreeSet::new();
    for tick in 1..=TINY {
        let before = bodies.to_vec();
        for (body, start) in bodies
            .iter_mut()
            .zip(&starts)
            .filter(|(body, _)| !body.is_stopped)
        {
            body.at = body.next(start, tick);
        }
        let after = bodies.to_vec();
        for one in 0..bodies.len() {
            if after[one].meets_border() {
                contacts.insert((one, one));
                bodies[one].is_stopped = true;
                bodies[one].at = before[one].at;
            }
            for other in 0..one {
                let reach_m = after[one].radius_m + after[other].radius_m;
                if after[one].at.to(after[other].at).length() < reach_m {
                    contacts.insert((one, other));
                    for stopped in [one, other] {
                        bodies[stopped].is_stopped = true;
                        bodies[stopped].at = before[stopped].at;
                    }
                }
            }
        }
    }
    contacts.len() as u64
}

/// Robots of three sizes with random positions and headings.
fn crowd(random: &mut Random) -> Vec<Body> {
    let mut bodies: Vec<Body> = Vec::new();
    while bodies.len() < 9 {
        let radius_m = [0.1, 0.25, 0.4][bodies.len() / 3];
        let room = Point {
            x: radius_m,
            y: radius_m,
        };
        let at = random
            .point(SIDE_M - 2.0 * radius_m, SIDE_M - 2.0 * radius_m)
            .plus(room);
        let body = Body {
            at,
            radius_m,
            heading_rad: random.between(-3.0, 3.0),
            motion: motion(random.between(-2.0, 3.0), random.one_of(&[0.0, 1.0, -2.5])),
            is_stopped: false,
        };
        let is_apart = |other: &Body| at.to(other.at).length() > radius_m + other.radius_m;
        if bodies.iter().all(is_apart) {
            bodies.push(body);
        }
    }
    bodies
}

/// A scenario with the bodies as robots, three per kind, with these names and in this order.
fn text(bodies: &[Body], names: [&str; 3], order: [usize; 3]) -> String {
    let kinds = names.iter().zip(bodies.chunks(3)).map(|(name, group)| {
        let places = order.map(|place| group[place].at).map(|at| format!("[{}, {}]", at.x, at.y));
        let headings = order.map(|place| group[place].heading_rad.to_degrees().to_string());
        format!(
            "[robots.{name}]\ncount = 3\nradius_m = {}\n\
             start = {{ kind = \"fixed\", at_m = [{}], heading_deg = [{}] }}\n\
             drive = {{ max_speed_m_s = 3, max_reverse_speed_m_s = 3, max_turn_rate_deg_s = 170 }}\n",
            group[0].radius_m,
            places.join(", "),
            headings.join(", ")
        )
    });
    let world = "[clock]\nstep_s = 1\ntime_limit_s = 100\n[world]\n";
    format!(
        "{world}size_m = [{SIDE_M}, {SIDE_M}]\n{}",
        kinds.collect::<String>()
    )
}

/// One step of the engine with the bodies' motions; returns their new positions in order.
fn step(bodies: &[Body], names: [&str; 3], order: [usize; 3]) -> (Vec<Point>, Simulation) {
    let mut simulation = start(&text(bodies, names, order));
    let mut sorted = names;
    sorted.sort_unstable();
    let number = |body: usize| {
        let kind = sorted
            .iter()
            .position(|name| *name == names[body / 3])
            .unwrap();
        let index = order.iter().position(|place| *place == body % 3).unwrap();
        (kind, index)
    };
    let commands = bodies
        .iter()
        .enumerate()
        .map(|(body, Body { motion, .. })| {
            let (kind, index) = number(body);
            let id = id(u8::try_from(kind).unwrap(), u32::try_from(index).unwrap());
            (id, go(motion.speed_m_s, motion.turn_rate_rad_s))
        });
    let commands: Vec<_> = commands.collect();
    step_with(&mut simulation, commands);
    let all = robots(&simulation);
    let at = |body: usize| {
        let (kind, index) = number(body);
        all[3 * kind + index].at
    };
    ((0..bodies.len()).map(at).collect(), simulation)
}

#[test]
fn robots_stop_where_tiny_steps_stop_them() {
    let (mut stopped, mut contacts_in_all) = (0, 0);
    for seed in 0..25 {
        let bodies = crowd(&mut Random::new(seed));
        let (places, simulation) = step(&bodies, ["a", "b", "c"], [0, 1, 2]);
        let mut expected = bodies.clone();
        let contacts = tiny_steps(&mut expected);
        // A tiny step is 0.3 mm long and its chord deviates from the arc by up to 0.2 mm, so that
        // a grazing contact may occur in one of the two only. Such scenes are skipped.
        let mut wider = bodies.clone();
        wider.iter_mut().for_each(|body| body.radius_m += 5e-4);
        if tiny_steps(&mut wider) != contacts {
            continue;
        }
        for (place, body) in places.iter().zip(&expected) {
            let error_m = place.to(body.at).length();
            assert!(error_m < 3e-3, "seed {seed}: {error_m} {body:?}");
        }
        assert_eq!(simulation.outcome().collisions, contacts, "seed {seed}");
        for (robot, body) in robots(&simulation).iter().zip(&expected) {
            assert_eq!(robot.is_touching, body.is_stopped, "seed {seed}");
            assert_eq!(robot.collisions, u32::from(body.is_stopped), "seed {seed}");
            assert!(!body.is_stopped || robot.speed_m_s == 0.0);
        }
        stopped += expected.iter().filter(|body| body.is_stopped).count();
        contacts_in_all += contacts;
    }
    assert!(
        stopped > 100 && contacts_in_all > 60,
        "{stopped} {contacts_in_all}"
    );
}

#[test]
fn the_order_of_robots_and_kinds_has_no_effect() {
    for seed in 0..60 {
        let bodies = crowd(&mut Random::new(seed));
        let (places, simulation) = step(&bodies, ["a", "b", "c"], [0, 1, 2]);
        for (names, order) in [
            (["a", "b", "c"], [2, 0, 1]),
            (["c", "b", "a"], [0, 1, 2]),
            (["b", "c", "a"], [1, 2, 0]),
        ] {
            let (others, other) = step(&bodies, names, order);
            assert_eq!(places, others, "seed {seed}");
            assert_eq!(simulation.outcome().collisions, other.outcome().collisions);
        }
    }
}

/// Six robots converge on a stationary one: eight simultaneous contacts.
#[test]
fn a_step_has_at_most_one_contact_per_robot() {
    let about = (0..6).map(|place| {
        let (sine, cosine) = sin_cos(f64::from(place) * std::f64::consts::FRAC_PI_3);
        format!("[{}, {}]", 4.0 + 1.2 * cosine, 4.0 + 1.2 * sine)
    });
    let kind = |name: &str, count: u32, speed: u32, start: String| {
        format!(
            "[robots.{name}]\ncount = {count}\nradius_m = 0.5\n\
             start = {{ kind = \"fixed\", {start} }}\n\
             drive = {{ max_speed_m_s = {speed}, max_turn_rate_deg_s = 90 }}\n\
             brain = {{ behaviours = [{{ kind = \"cruise\" }}] }}\n",
        )
    };
    let inwards = "heading_deg = [180, -120, -60, 0, 60, 120]";
    let around = format!(
        "at_m = [{}], {inwards}",
        about.collect::<Vec<_>>().join(", ")
    );
    let text = format!(
        "[clock]\nstep_s = 0.1\ntime_limit_s = 0.1\n[world]\nsize_m = [8, 8]\n{}{}",
        kind("around", 6, 3, around),
        kind("middle", 1, 0, "at_m = [[4, 4]]".to_owned())
    );
    let runs = Runs(scenario(&text));
    let columns = runs.columns();
    let place = columns
        .iter()
        .position(|column| column.name == "collisions")
        .unwrap();
    assert_eq!(runs.run_block(1, 0..1, BlockOptions::ALONE)[place], [7.0]);
    assert_eq!(columns[place].bounds.max, Some(7.0));
}
