//! Ground and air layers: collisions, terrain and visibility across layers.

use crate::common::{drive, go, id, robots, start, step_with, with};
use sim::simulation::Simulation;

/// Rovers and birds on lines along x with a pillar, in a field of 20 m with mud.
const FIELD: &str = r#"
clock.time_limit_s = 100
world.obstacles = [{ circle = { at_m = [10, 5], radius_m = 1 } }]
terrain.mud = { speed = 0.5, areas_m = [[[0, 7], [20, 7], [20, 10], [0, 10]]] }
[robots.bird]
layer = "air"
radius_m = 0.5
start = { at_m = [[4, 5], [2, 2], [16, 2]], heading_deg = [0, 0, 180] }
drive = { max_speed_m_s = 2, max_turn_rate_deg_s = 90 }
sensors.sonar = { kind = "range", rays = 1, range_m = 18 }
[robots.rover]
radius_m = 0.5
start = { at_m = [[4, 5], [10, 2], [4, 8]], heading_deg = [0, 0, 0] }
drive = { max_speed_m_s = 2, max_turn_rate_deg_s = 90 }
sensors.sonar = { kind = "range", rays = 1, range_m = 18 }
"#;

fn all_ahead(simulation: &mut Simulation, steps: u32) {
    let ids = robots(simulation).into_iter().map(|robot| robot.id);
    let ahead: Vec<_> = ids.map(|id| (id, 2.0, 0.0)).collect();
    drive(simulation, steps, &ahead);
}

#[test]
fn birds_fly_over_obstacles_and_rovers_and_stop_at_the_border() {
    let mut simulation = start(FIELD);
    all_ahead(&mut simulation, 100);
    let all = robots(&simulation);
    assert!(
        (all[0].at.x - 19.5).abs() < 1e-9,
        "over the pillar, to the border"
    );
    assert!((all[3].at.x - 8.5).abs() < 1e-9, "to the pillar");
    // Two birds meet half-way, above the rover.
    assert!((all[1].at.x - 8.5).abs() < 1e-9 && (all[2].at.x - 9.5).abs() < 1e-9);
    assert!((all[4].at.x - 19.5).abs() < 1e-9);
    let collisions: Vec<u32> = all.iter().map(|robot| robot.collisions).collect();
    assert_eq!(collisions, [1, 1, 1, 1, 1, 0]);
    assert_eq!(simulation.outcome().collisions, 4);
}

#[test]
fn rays_meet_obstacles_and_robots_of_their_layer() {
    let mut simulation = start(FIELD);
    let range_m = |simulation: &mut Simulation, kind, index| {
        simulation.percept(id(kind, index)).unwrap().unwrap().scans[0].ranges_m[0]
    };
    // The rays of a bird above a rover meet the border and other birds, not the rover or the pillar.
    assert_eq!(range_m(&mut simulation, 0, 0), 16.0);
    assert_eq!(range_m(&mut simulation, 0, 1), 13.5);
    assert_eq!(range_m(&mut simulation, 1, 0), 5.0);
    assert_eq!(range_m(&mut simulation, 1, 1), 10.0);
}

#[test]
fn terrain_slows_robots_on_the_ground() {
    let mut simulation = start(FIELD);
    all_ahead(&mut simulation, 10);
    let all = robots(&simulation);
    assert!((all[5].distance_m - 1.0).abs() < 1e-9 && (all[5].speed_m_s - 1.0).abs() < 1e-12);
    let in_mud = "robots.bird.start.at_m = [[4, 8], [2, 2], [16, 2]]";
    let mut simulation = start(&with(FIELD, in_mud));
    all_ahead(&mut simulation, 10);
    assert!(
        (robots(&simulation)[0].distance_m - 2.0).abs() < 1e-9,
        "terrain does not slow flying robots"
    );
}

#[test]
fn constant_speed_and_turn_rate_give_an_exact_circle() {
    let mut simulation = start(FIELD);
    // A circle of 0.4 m in 60 steps.
    let turn = std::f64::consts::TAU / 6.0;
    let begin = robots(&simulation)[4];
    for step in 1..=60_u32 {
        step_with(&mut simulation, [(id(1, 1), go(0.4 * turn, turn))]);
        let robot = robots(&simulation)[4];
        let angle = f64::from(step) * turn * 0.1;
        let x = 10.0 + 0.4 * libm::sin(angle);
        let y = 2.0 + 0.4 * (1.0 - libm::cos(angle));
        assert!(
            robot.at.to([x, y].into()).length() < 1e-12,
            "{step}: {robot:?}"
        );
    }
    assert!(robots(&simulation)[4].at.to(begin.at).length() < 1e-12);
}

/// The number of neighbours that a bird sees: another robot is across a wall.
fn across_a_wall(other: &str) -> usize {
    let text = format!(
        "clock.time_limit_s = 10\n\
         world.obstacles = [{{ polygon_m = [[9, 1], [10, 1], [10, 9], [9, 9]] }}]\n\
         [robots.bird]\nlayer = \"air\"\nradius_m = 0.5\nstart.at_m = [[5, 5]]\n\
         drive = {{ max_speed_m_s = 2, max_turn_rate_deg_s = 90 }}\n\
         sensors.eye = {{ kind = \"robots\", range_m = 15 }}\n\
         [robots.other]\nlayer = \"{other}\"\nradius_m = 0.5\nstart.at_m = [[15, 5]]\n\
         drive = {{ max_speed_m_s = 2, max_turn_rate_deg_s = 90 }}\n"
    );
    let percept = start(&text).percept(id(0, 0)).unwrap().unwrap();
    percept.neighbours.len()
}

#[test]
fn a_wall_hides_a_flying_robot_from_the_ground_and_not_from_flying_robots() {
    assert_eq!(across_a_wall("air"), 1);
    assert_eq!(across_a_wall("ground"), 0);
}
