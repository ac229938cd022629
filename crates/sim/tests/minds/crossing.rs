//! Robots in each other's way: who wants to be where, and whether all get there without a collision.

use crate::{listed, scenario};
use base::geometry::Point;
use base::random::{Entity, Purpose, Stream, stream, unit};
use rayon::prelude::*;
use sim::simulation::Simulation;
use std::fmt::Write as _;

/// What robots are; their places follow.
const ROVER: &str = "
radius_m = 0.25
drive = { max_speed_m_s = 1, max_acceleration_m_s2 = 1, max_turn_rate_deg_s = 120 }
[robots.rover.sensors]
sonar = { kind = \"range\", rays = 24, range_m = 4 }
gps = { kind = \"position\" }
compass = { kind = \"heading\" }
eye = { kind = \"robots\", range_m = 6 }
";

/// Robots that start at places, each with the course to where it wants to be.
struct Crossing {
    size_m: [f64; 2],
    obstacles: String,
    from: Vec<Point>,
    to: Vec<Point>,
    time_limit_s: u32,
}

const STEPS_A_SECOND: u32 = 10;

#[derive(Debug, Clone, Copy, PartialEq)]
struct Crossed {
    all_arrived: bool,
    collisions: u64,
}

impl Crossing {
    fn run(&self) -> Crossed {
        let mut simulation = Simulation::new(scenario(&self.text()), 1, 0).unwrap();
        for _ in 0..self.time_limit_s * STEPS_A_SECOND {
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

fn dice(seed: u64) -> Stream {
    stream(seed, 0, Entity { kind: 0, index: 0 }, Purpose::Start)
}

/// Whether a place is at least so far from all others.
fn apart(places: &[Point], place: Point, apart_m: f64) -> bool {
    places
        .iter()
        .all(|other| other.to(place).length() >= apart_m)
}

/// 50 robots about the border of a square of 50 m, each wants to the point opposite.
fn square(seed: u64) -> Crossing {
    let mut dice = dice(seed);
    let (mut from, mut to) = (Vec::new(), Vec::new());
    while from.len() < 50 {
        let along = 1.0 + 48.0 * unit(&mut dice);
        let [x, y] = match dice.bounded(4) {
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

/// The same on a circle of 20 m: all meet in the middle.
fn circle(seed: u64) -> Crossing {
    let mut crossing = square(seed);
    let mut dice = dice(seed);
    let places = (0..50).map(|number| {
        let angle = std::f64::consts::TAU * (f64::from(number) + 0.2 * unit(&mut dice)) / 50.0;
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

/// Five against five in a corridor of 20 m that is 2.6 robots wide.
fn corridor(seed: u64) -> Crossing {
    let mut dice = dice(seed);
    let (low, high) = (3.0, 3.0 + 2.6 * 0.5);
    let mut from: Vec<Point> = Vec::new();
    let mut to = Vec::new();
    while from.len() < 10 {
        let is_left = from.len() < 5;
        let along = 5.0 * unit(&mut dice);
        let x = if is_left { 8.0 + along } else { 28.0 - along };
        let place = Point {
            x,
            y: low + 0.3 + (high - low - 0.6) * unit(&mut dice),
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

/// So many of 100 in which all arrived, and in which nobody touched anything.
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
fn fifty_robots_cross_a_square_and_hardly_ever_touch() {
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
fn fifty_robots_whose_ways_all_meet_in_one_point_get_through() {
    for seed in 1..=3 {
        let crossed = circle(seed).run();
        assert!(
            crossed.all_arrived && crossed.collisions == 0,
            "{seed}: {crossed:?}"
        );
    }
}
