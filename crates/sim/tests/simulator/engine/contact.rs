//! No robot passes through an obstacle or another robot, at any speed and step length.

use crate::common::{Random, go, robots, start, step_with};
use base::geometry::{Polygon, Rectangle};
use sim::run::Robot;
use sim::simulation::Simulation;
use sim::world::obstacles::Solid;

const SIDE_M: f64 = 120.0;

/// Smaller overlaps, in metres, are rounding errors.
const HAIR_M: f64 = 1e-6;

/// A wall of a centimetre divides the world; both halves contain obstacles, and one of them a
/// closed cell of thin walls. Robots have various radii; some are points.
fn maze(random: &mut Random) -> String {
    let step_s = random.one_of(&[0.05, 0.3, 1.0]);
    let acceleration = random.one_of(&[
        "",
        "max_acceleration_m_s2 = 30,",
        "max_acceleration_m_s2 = 900,",
    ]);
    let turn = random.one_of(&[170.0, 30.0, 3.0]) / step_s;
    let mut kinds = String::new();
    for (name, radius_m, layer) in [
        ("big", 1.5, "ground"),
        ("middle", 0.3, "ground"),
        ("point", 0.0, "ground"),
        ("bird", 0.5, "air"),
    ] {
        kinds += &format!(
            "[robots.{name}]\ncount = 6\nradius_m = {radius_m}\nlayer = \"{layer}\"\n\
             drive = {{ max_speed_m_s = 100, max_reverse_speed_m_s = 60, {acceleration}\n\
             max_turn_rate_deg_s = {turn} }}\n"
        );
    }
    let [x, y] = [random.between(65.0, 100.0), random.between(5.0, 100.0)];
    format!(
        "[clock]\nstep_s = {step_s}\ntime_limit_s = 1000\n[world]\nsize_m = [{SIDE_M}, {SIDE_M}]\nobstacles = [\n\
         {{ polygon_m = [[60, -1], [60.01, -1], [60.01, 121], [60, 121]] }},\n\
         {{ polygon_m = [[10, 10], [40, 12], [12, 40]] }},\n\
         {{ polygon_m = [[40, 80], [40, 100], [20, 100], [20, 99.99], [39.99, 99.99], [39.99, 80]] }},\n\
         {{ circle = {{ at_m = [{x}, {y}], radius_m = 4 }} }},\n\
         {{ circle = {{ at_m = [30, 60], radius_m = 0.01 }} }},\n\
         ]\n{kinds}"
    )
}

fn radius_m(robot: &Robot) -> f64 {
    // Kinds are in alphabetical order: big, bird, middle, point.
    [1.5, 0.5, 0.3, 0.0][usize::from(robot.id.kind)]
}

fn is_bird(robot: &Robot) -> bool {
    robot.id.kind == 1
}

/// The penetration depth of a robot's centre into a polygon; positive inside.
fn depth_m(polygon: &Polygon, robot: &Robot) -> f64 {
    let edges = polygon.edges().map(|edge| edge.distance_m(robot.at));
    let nearest_m = edges.fold(f64::INFINITY, f64::min);
    let is_in = polygon.contains(robot.at);
    if is_in { nearest_m } else { -nearest_m }
}

fn assert_free(simulation: &Simulation, context: &str) {
    let world = simulation.scenario().world();
    let all = robots(simulation);
    for (place, robot) in all.iter().enumerate() {
        let radius_m = radius_m(robot);
        let inner = Rectangle::spanned(
            [radius_m - HAIR_M; 2].into(),
            [SIDE_M - radius_m + HAIR_M; 2].into(),
        );
        assert!(
            inner.contains(robot.at),
            "{context}: {robot:?} in {world:?}"
        );
        for other in all[..place]
            .iter()
            .filter(|other| is_bird(other) == is_bird(robot))
        {
            let gap_m = robot.at.to(other.at).length() - radius_m - self::radius_m(other);
            assert!(gap_m > -HAIR_M, "{context}: {gap_m} {robot:?} {other:?}");
        }
        for solid in simulation
            .scenario()
            .solids()
            .iter()
            .filter(|_| !is_bird(robot))
        {
            let depth_m = match solid {
                Solid::Polygon(polygon) => depth_m(polygon, robot) + radius_m,
                Solid::Disc(disc) => disc.radius_m + radius_m - disc.centre.to(robot.at).length(),
                Solid::Map(_) => f64::NEG_INFINITY,
            };
            assert!(depth_m < HAIR_M, "{context}: {depth_m} {robot:?} {solid:?}");
        }
    }
}

#[test]
fn no_robot_overlaps_or_passes_through_anything_at_any_speed_and_step() {
    for seed in 0..20 {
        let mut random = Random::new(seed);
        let text = maze(&mut random);
        let mut simulation = start(&text);
        let is_left = |robot: &Robot| robot.at.x < 60.005;
        let sides: Vec<bool> = robots(&simulation).iter().map(is_left).collect();
        assert_free(&simulation, &format!("seed {seed}, start"));
        for step in 0..40 {
            let commands = robots(&simulation).into_iter().map(|robot| {
                let speed = random.one_of(&[100.0, 100.0, -60.0, 20.0, 1.0, 0.0]);
                let turn = random.one_of(&[0.0, 0.0, 100.0, -100.0, 1.0, -0.1]);
                (robot.id, go(speed, turn))
            });
            let commands: Vec<_> = commands.collect();
            step_with(&mut simulation, commands);
            let context = format!("seed {seed}, step {step}");
            assert_free(&simulation, &context);
            for (robot, was_left) in robots(&simulation).iter().zip(&sides) {
                assert!(
                    is_bird(robot) || is_left(robot) == *was_left,
                    "{context}: {robot:?}"
                );
            }
        }
    }
}
