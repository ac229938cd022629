//! Robots whose paths cross: whether all reach their destinations without a collision.

use crate::listed;
use crate::scenarios::scenario;
use base::geometry::Point;
use base::random::{Entity, Purpose, Stream, stream, unit};
use rayon::prelude::*;
use sim::simulation::Simulation;
use std::fmt::Write as _;

/// The kind of robot; positions are appended.
const ROVER: &str = "
radius_m = 0.25
drive = { max_speed_m_s = 1, max_acceleration_m_s2 = 1, max_turn_rate_deg_s = 120 }
[robots.rover.sensors]
sonar = { kind = \"range\", rays = 24, range_m = 4 }
gps = { kind = \"position\" }
compass = { kind = \"heading\" }
eye = { kind = \"robots\", range_m = 6 }
";

/// Start positions and destinations; each robot starts facing its destination.
struct Crossing {
    size_m: [f64; 2],
    obstacles: String,
    from: Vec<Point>,
    to: Vec<Point>,
    time_limit_s: u32,
}

const STEPS_PER_S: u32 = 10;

#[derive(Debug, Clone, Copy, PartialEq)]
struct Crossed {
    all_arrived: bool,
    collisions: u64,
}

impl Crossing {
    fn run(&self) -> Crossed {
        let mut simulation = Simulation::new(scenario(&self.text()), 1, 0).unwrap();
        for _ in 0..self.time_limit_s * STEPS_PER_S {
            simulation.step();
            if self.have_all_arrived(&simulation) {
                break;
            }
        }
        Crossed {
            all_arrived: self.have_all_arrived(&simulation),
            collisions: simulation.outcome().collisions,
        }
    }

    fn have_all_arrived(&self, simulation: &Simulation) -> bool {
        let robots = simulation.state().each_robot(simulation.scenario());
        let mut places = robots.zip(&self.to);
        places.all(|(robot, to)| robot.at.to(*to).length() < 0.5)
    }

    fn text(&self) -> String {
        let [width, height] = self.size_m;
        let mut text = format!(
            "[clock]\ntime_limit_s = 10000\n[world]\nsize_m = [{width}, {height}]\nobstacles = [{}]\n\
             [robots.rover]\ncount = {}\n{ROVER}\n[robots.rover.start]\nkind = \"fixed\"\nat_m = {}\n",
            self.obstacles,
            self.from.len(),
            listed(&self.from)
        );
        writeln!(
            text,
            "[robots.rover.brain]\nbehaviours = [{{ kind = \"navigate\", assignment = \"one_each\", \
             within_m = 0.3, waypoints_m = {} }}]",
            listed(&self.to)
        )
        .unwrap();
        text
    }
}

fn random(seed: u64) -> Stream {
    stream(seed, 0, Entity { kind: 0, index: 0 }, Purpose::Start)
}

/// Whether a position is at least `apart_m` from all others.
fn apart(places: &[Point], place: Point, apart_m: f64) -> bool {
    places
        .iter()
        .all(|other| other.to(place).length() >= apart_m)
}

/// 50 robots around the border of a square of 50 m, each with the opposite point as destination.
fn square(seed: u64) -> Crossing {
    let mut random = random(seed);
    let (mut from, mut to) = (Vec::new(), Vec::new());
    while from.len() < 50 {
        let along = 1.0 + 48.0 * unit(&mut random);
        let [x, y] = match random.bounded(4) {
            0 => [along, 1.0],
            1 => [49.0, along],
            2 => [along, 49.0],
            _ => [1.0, along],
        };
        let (place, opposite) = (
            Point { x, y },
            Point {
                x: 50.0 - x,
                y: 50.0 - y,
            },
        );
        if apart(&from, place, 0.8) && apart(&to, opposite, 0.8) {
            from.push(place);
            to.push(opposite);
        }
    }
    Crossing {
        size_m: [50.0, 50.0],
        obstacles: String::new(),
        from,
        to,
        time_limit_s: 400,
    }
}

/// The same on a circle of 20 m: all paths meet in the middle.
fn circle(seed: u64) -> Crossing {
    let mut crossing = square(seed);
    let mut random = random(seed);
    let places = (0..50).map(|number| {
        let angle = std::f64::consts::TAU * (f64::from(number) + 0.2 * unit(&mut random)) / 50.0;
        Point {
            x: 25.0 + 20.0 * angle.cos(),
            y: 25.0 + 20.0 * angle.sin(),
        }
    });
    crossing.from = places.collect();
    let opposite = crossing.from.iter().map(|at| Point {
        x: 50.0 - at.x,
        y: 50.0 - at.y,
    });
    crossing.to = opposite.collect();
    crossing
}

/// Five robots against five in a corridor of 20 m with a width of 2.6 robots.
fn corridor(seed: u64) -> Crossing {
    let mut random = random(seed);
    let (low, high) = (3.0, 3.0 + 2.6 * 0.5);
    let mut from: Vec<Point> = Vec::new();
    let mut to = Vec::new();
    while from.len() < 10 {
        let is_left = from.len() < 5;
        let along = 5.0 * unit(&mut random);
        let x = if is_left { 8.0 + along } else { 28.0 - along };
        let place = Point {
            x,
            y: low + 0.3 + (high - low - 0.6) * unit(&mut random),
        };
        if apart(&from, place, 0.6) {
            let row = to.len() % 5;
            #[expect(clippy::cast_precision_loss, reason = "few")]
            let y = 1.2 + 1.2 * row as f64;
            to.push(Point {
                x: if is_left { 33.0 } else { 3.0 },
                y,
            });
            from.push(place);
        }
    }
    let wall = |y0: f64, y1: f64| {
        format!("{{ polygon_m = [[8, {y0}], [28, {y0}], [28, {y1}], [8, {y1}]] }}")
    };
    Crossing {
        size_m: [36.0, 7.3],
        obstacles: format!("{}, {}", wall(0.0, low), wall(high, 7.3)),
        from,
        to,
        time_limit_s: 400,
    }
}

/// Of 100 runs: the number in which all robots arrived, and the number without a collision.
fn of_100(make: impl Fn(u64) -> Crossing + Sync) -> [usize; 2] {
    let seeds = (1..=100_u64).into_par_iter();
    let crossed: Vec<Crossed> = seeds.map(|seed| make(seed).run()).collect();
    let count = |is_it: fn(&&Crossed) -> bool| crossed.iter().filter(is_it).count();
    [
        count(|crossed| crossed.all_arrived),
        count(|crossed| crossed.collisions == 0),
    ]
}

#[test]
fn fifty_robots_cross_a_square_with_few_collisions() {
    let [arrived, untouched] = of_100(square);
    assert_eq!(arrived, 100);
    assert!(untouched >= 95, "{untouched}");
}

#[test]
fn five_against_five_pass_each_other_in_a_narrow_corridor() {
    let [arrived, _] = of_100(corridor);
    assert!(arrived >= 99, "{arrived}");
}

#[test]
fn fifty_robots_with_paths_through_one_point_arrive() {
    for seed in 1..=3 {
        let crossed = circle(seed).run();
        assert!(
            crossed.all_arrived && crossed.collisions == 0,
            "{seed}: {crossed:?}"
        );
    }
}
