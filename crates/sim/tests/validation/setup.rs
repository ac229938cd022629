//! Scenarios, and scripted motions of robots.

use base::document::{Document, Node, Value};
use base::geometry::Point;
use base::random::{Entity, Purpose, Stream, stream, unit};
use base::trig::{sin_cos, wrapped};
use brain::{AgentId, Command, Motion};
use sim::run::Robot;
use sim::scenario::{Scenario, ScenarioSpec};
use sim::simulation::Simulation;
use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

/// Maximum gap to a wall or another body that counts as a contact, in metres.
const TOUCH_M: f64 = 1e-6;

/// The scenario of a document with changed values, by their paths.
pub(crate) fn scenario(text: &str, changes: &[(&str, Value)]) -> Arc<Scenario> {
    let mut document = Document::parse("validation", text).unwrap();
    for (path, value) in changes {
        let path: Vec<&str> = path.split('.').collect();
        document.set(&path, value.clone(), "the check");
    }
    let read = ScenarioSpec::read(&document);
    Arc::new(read.unwrap_or_else(|errors| panic!("{errors}")).scenario)
}

/// A simulation of a run at tick 0.
pub(crate) fn run(scenario: &Arc<Scenario>, seed: u64, run: u64) -> Simulation {
    Simulation::new(Arc::clone(scenario), seed, run).unwrap()
}

/// A list value.
pub(crate) fn list(values: impl IntoIterator<Item = Value>) -> Value {
    let node = |value| Node {
        value,
        origin: "the check".to_owned(),
    };
    Value::List(values.into_iter().map(node).collect())
}

/// A list value of positions.
pub(crate) fn places(places: impl IntoIterator<Item = Point>) -> Value {
    let place = |Point { x, y }| list([x, y].map(Value::Float));
    list(places.into_iter().map(place))
}

/// An integer value.
pub(crate) fn whole(number: u32) -> Value {
    Value::Integer(number.into())
}

/// Evenly spaced points on a circle.
pub(crate) fn circle(centre: Point, radius_m: f64, count: u32) -> impl Iterator<Item = Point> {
    (0..count).map(move |number| {
        let (y, x) = sin_cos(f64::from(number) / f64::from(count) * std::f64::consts::TAU);
        centre.plus(Point { x, y }.times(radius_m))
    })
}

/// The only robot of a simulation.
pub(crate) fn only(simulation: &Simulation) -> Robot {
    let mut robots = simulation.state().each_robot(simulation.scenario());
    robots.next().unwrap()
}

/// The id of the first robot of a kind.
pub(crate) const fn first_of(kind: u8) -> AgentId {
    AgentId::robot(kind, 0)
}

/// A command to move.
pub(crate) fn moving(speed_m_s: f64, turn_rate_rad_s: f64) -> Command {
    let motion = Motion {
        speed_m_s,
        turn_rate_rad_s,
    };
    Command {
        motion,
        ..Command::default()
    }
}

/// A command to turn on the spot by an angle within one step.
pub(crate) fn turning(by_rad: f64, step_s: f64) -> Command {
    moving(0.0, by_rad / step_s)
}

/// One step with these commands; the brains of other robots decide for them.
pub(crate) fn step(simulation: &mut Simulation, commands: BTreeMap<AgentId, Command>) {
    if commands.is_empty() {
        simulation.step();
    } else {
        simulation.step_with(BTreeMap::new(), commands).unwrap();
    }
}

/// Random numbers for scripted motions.
pub(crate) struct Random(Stream);

impl Random {
    pub(crate) fn of_run(run: u64) -> Self {
        let script = Entity { kind: 0, index: 0 };
        // A seed that simulations do not use.
        Self(stream(0x5C21_7000, run, script, Purpose::Noise))
    }

    /// A uniform number from 0 to 1.
    pub(crate) fn unit(&mut self) -> f64 {
        unit(&mut self.0)
    }

    /// The turn of a robot away from its contacts, given their normals, by the cosine law: the sine
    /// of the angle from the first normal is uniform.
    fn turn_away_rad(&mut self, heading_rad: f64, normals: &[Point]) -> f64 {
        let normal = normals[0];
        let facing_rad = libm::atan2(normal.y, normal.x);
        for _ in 0..1000 {
            let angle_rad = libm::asin(2.0 * self.unit() - 1.0);
            let course_rad = facing_rad + angle_rad;
            let (y, x) = sin_cos(course_rad);
            let way = Point { x, y };
            if normals.iter().all(|normal| normal.dot(way) > 0.0) {
                return wrapped(course_rad - heading_rad);
            }
        }
        // It is blocked on all sides: another direction is tried in the next step.
        FRAC_PI_2
    }
}

/// Commands that turn all robots with contacts away from them by the cosine law.
pub(crate) fn away(
    robots: &[Robot],
    simulation: &Simulation,
    radius_m: f64,
    random: &mut Random,
) -> BTreeMap<AgentId, Command> {
    let scenario = simulation.scenario();
    let touching = robots.iter().filter(|robot| robot.is_touching);
    let turns = touching.filter_map(|robot| {
        let mut normals = walls_at(robot.at, scenario, radius_m);
        if radius_m > 0.0 {
            normals.extend(partners(robots, robot, radius_m));
        }
        let is_known = !normals.is_empty();
        is_known.then(|| {
            let turn_rad = random.turn_away_rad(robot.heading_rad, &normals);
            (robot.id, turning(turn_rad, scenario.step_s()))
        })
    });
    turns.collect()
}

/// Directions from the robots in contact with one towards it.
pub(crate) fn partners(robots: &[Robot], robot: &Robot, radius_m: f64) -> Vec<Point> {
    let others = robots.iter().filter(|other| other.id != robot.id);
    let ways = others.map(|other| other.at.to(robot.at));
    ways.filter(|way| way.length_squared() < (2.0 * radius_m + TOUCH_M).powi(2))
        .collect()
}

/// Inward normals of the world's walls in contact with a body.
fn walls_at(at: Point, scenario: &Scenario, radius_m: f64) -> Vec<Point> {
    let size = scenario.world().size();
    let near_m = radius_m + TOUCH_M;
    let walls = [
        (at.x, 1.0, 0.0),
        (size.x - at.x, -1.0, 0.0),
        (at.y, 0.0, 1.0),
        (size.y - at.y, 0.0, -1.0),
    ];
    let touched = walls.iter().filter(|(gap_m, ..)| *gap_m < near_m);
    touched.map(|&(_, x, y)| Point { x, y }).collect()
}

/// All robots of a run.
pub(crate) fn robots(simulation: &Simulation) -> Vec<Robot> {
    let scenario = simulation.scenario();
    simulation.state().each_robot(scenario).collect()
}

/// Items found so far.
pub(crate) fn found(simulation: &Simulation) -> u32 {
    simulation.outcome().found.iter().sum()
}

/// Effective sweep width with measurements every `apart_m`, relative to continuous measurement.
///
/// The union of discs of radius r in a row with spacing d has the area d sqrt(r^2 - d^2/4) +
/// 2 r^2 asin(d / 2r) per disc, which is divided by d and by 2r.
pub(crate) fn relative_sweep_width(apart_m: f64, radius_m: f64) -> f64 {
    let q = apart_m / (2.0 * radius_m);
    f64::midpoint((1.0 - q * q).sqrt(), libm::asin(q) / q)
}

/// Time since a run began.
#[expect(clippy::cast_precision_loss, reason = "few steps")]
pub(crate) fn time_s(simulation: &Simulation) -> f64 {
    simulation.state().tick() as f64 * simulation.scenario().step_s()
}
