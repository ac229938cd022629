//! Periodic worlds, bodies that are points, and unlimited turn rates.

use crate::common::{Random, drive, first, go, id, message, robots, send, start, step_with};
use base::geometry::{Point, Torus};
use brain::Percept;
use sim::simulation::Simulation;
use std::f64::consts::{FRAC_PI_2, PI};

const SIZE: Torus = Torus {
    size_m: Point { x: 20.0, y: 16.0 },
};

fn world(more: &str, kinds: &str) -> String {
    format!(
        "[clock]\nstep_s = 0.1\ntime_limit_s = 100\n[world]\nsize_m = [20, 16]\nperiodic = true\n{more}\n{kinds}"
    )
}

/// A kind of robots at given positions, facing along x.
fn kind(name: &str, places: &[[f64; 2]], more: &str) -> String {
    let headings = vec![0.0; places.len()];
    format!(
        "[robots.{name}]\n\
         start = {{ at_m = {places:?}, heading_deg = {headings:?} }}\n\
         drive = {{ max_speed_m_s = 5, max_turn_rate_deg_s = 90 }}\n{more}\n"
    )
}

fn rovers(places: &[[f64; 2]], more: &str) -> Simulation {
    start(&world("", &kind("rover", places, more)))
}

fn percept(simulation: &mut Simulation, robot: u32) -> Percept {
    simulation.percept(id(0, robot)).unwrap().unwrap()
}

fn assert_near(given: f64, expected: f64) {
    assert!((given - expected).abs() < 1e-9, "{given} for {expected}");
}

#[test]
fn a_robot_that_crosses_a_border_enters_at_the_opposite_one() {
    let mut simulation = rovers(&[[19.8, 8.0]], "");
    drive(&mut simulation, 3, &[(id(0, 0), 5.0, 0.0)]);
    assert_near(first(&simulation).at.x, 1.3);
    let up = drive(&mut simulation, 200, &[(id(0, 0), 0.1, FRAC_PI_2)]);
    assert!(up.iter().flatten().all(|robot| robot.collisions == 0));
    drive(&mut simulation, 1, &[(id(0, 0), 0.0, 0.0)]);
    let at = first(&simulation).at;
    assert!((0.0..20.0).contains(&at.x) && (0.0..16.0).contains(&at.y));
}

#[test]
fn detectors_report_neighbours_and_their_courses_across_a_border() {
    let eye = "sensors = { mates = { kind = \"robots\", range_m = 3, course_noise_deg = 0 } }";
    let mut simulation = rovers(&[[0.5, 15.0], [19.5, 1.0], [10.0, 8.0]], eye);
    let turned = [0.0, FRAC_PI_2, 0.0];
    let commands = (0..)
        .zip(turned)
        .map(|(robot, turn)| (id(0, robot), go(0.0, turn)));
    step_with(&mut simulation, commands);
    let seen = percept(&mut simulation, 0).neighbours;
    assert_eq!(seen.len(), 1);
    assert_near(seen[0].range_m, 5_f64.sqrt());
    assert_near(seen[0].bearing_rad, f64::atan2(2.0, -1.0));
    assert_near(seen[0].course_rad.unwrap(), FRAC_PI_2 / 10.0);
    let back = percept(&mut simulation, 1).neighbours;
    assert_near(back[0].course_rad.unwrap(), -FRAC_PI_2 / 10.0);
}

#[test]
fn by_default_a_detector_reports_no_courses() {
    let eye = "sensors = { mates = { kind = \"robots\", range_m = 3 } }";
    let mut simulation = rovers(&[[0.5, 15.0], [0.5, 14.0]], eye);
    assert_eq!(percept(&mut simulation, 0).neighbours[0].course_rad, None);
}

#[test]
fn reported_courses_have_the_configured_error() {
    let eye = "sensors = { mates = { kind = \"robots\", range_m = 3, course_noise_deg = 10 } }";
    let mut simulation = rovers(&[[0.5, 15.0], [0.5, 14.0]], eye);
    let mut squares = 0.0;
    let samples = 4000;
    for _ in 0..samples {
        let seen = percept(&mut simulation, 0).neighbours;
        squares += seen[0].course_rad.unwrap().to_degrees().powi(2);
        step_with(
            &mut simulation,
            [0, 1].map(|robot| (id(0, robot), go(0.0, 0.0))),
        );
    }
    // The standard error of the mean square is 100 * sqrt(2 / 4000) = 2.2; seed fixed.
    let variance = squares / f64::from(samples);
    assert!((variance - 100.0).abs() < 9.0, "{variance}");
}

#[test]
fn bodies_collide_across_a_border() {
    let mut simulation = rovers(&[[19.0, 8.0], [1.0, 8.0]], "");
    let there = [(id(0, 0), 5.0, 0.0), (id(0, 1), 0.0, 0.0)];
    drive(&mut simulation, 10, &there);
    let robots = robots(&simulation);
    assert_near(robots[0].at.x, 0.6);
    assert_eq!([robots[0].collisions, robots[1].collisions], [1, 1]);
}

#[test]
fn rays_and_bodies_meet_obstacles_and_robots_across_a_border() {
    let stone = "obstacles = [{ circle = { at_m = [1, 8], radius_m = 0.5 } }]";
    let sonar = "sensors = { sonar = { kind = \"range\", rays = 4, range_m = 4 } }";
    let places = [[19.0, 8.0], [19.0, 15.5], [19.0, 1.5]];
    let mut simulation = start(&world(stone, &kind("rover", &places, sonar)));
    let ranges =
        |simulation: &mut Simulation, robot| percept(simulation, robot).scans[0].ranges_m.clone();
    assert_near(ranges(&mut simulation, 0)[0], 1.5);
    assert_near(ranges(&mut simulation, 1)[1], 1.8);
    assert_near(ranges(&mut simulation, 2)[3], 1.8);
    drive(&mut simulation, 10, &[(id(0, 0), 5.0, 0.0)]);
    assert_near(first(&simulation).at.x, 0.3);
    assert_eq!(first(&simulation).collisions, 1);
}

#[test]
fn items_are_found_across_a_corner_unless_hidden() {
    let mine = "[items.mine]\ncount = 1\nplacement = { kind = \"fixed\", at_m = [[19.5, 15.5]] }";
    let eye = "sensors = { eye = { kind = \"items\", range_m = 2 } }";
    let rover = kind("rover", &[[0.5, 0.5]], eye);
    let mut simulation = start(&world("", &format!("{mine}\n{rover}")));
    let contacts = percept(&mut simulation, 0).contacts;
    assert_near(contacts[0].range_m, 2_f64.sqrt());
    assert_near(contacts[0].bearing_rad, -0.75 * PI);
    let hut = "obstacles = [{ polygon_m = [[19.6, 15.6], [20, 15.6], [20, 16], [19.6, 16]] }]";
    let mut simulation = start(&world(hut, &format!("{mine}\n{rover}")));
    assert!(percept(&mut simulation, 0).contacts.is_empty());
}

#[test]
fn messages_cross_a_border_unless_blocked() {
    let radio = "radio = { range_m = 4, needs_line_of_sight = true }";
    let received = |more: &str| {
        let places = [[0.5, 8.0], [18.5, 8.0], [10.0, 8.0]];
        let mut simulation = start(&world(more, &kind("rover", &places, radio)));
        step_with(&mut simulation, [(id(0, 0), send(&[message(7.0)]))]);
        [1, 2].map(|robot| percept(&mut simulation, robot).inbox.len())
    };
    assert_eq!(received(""), [1, 0]);
    assert_eq!(
        received("obstacles = [{ circle = { at_m = [19.5, 8], radius_m = 0.1 } }]"),
        [0, 0]
    );
}

#[test]
fn a_radio_range_beyond_the_world_delivers_each_message_once() {
    let mut random = Random::new(5);
    let places: Vec<[f64; 2]> = (0..20).map(|_| random.point(20.0, 16.0).into()).collect();
    let radio = "radius_m = 0\nradio = { range_m = 100 }";
    let rovers = kind("rover", &places, radio).replacen("radius_m = 0.2\n", "", 1);
    let mut simulation = start(&world("", &rovers));
    step_with(&mut simulation, [(id(0, 0), send(&[message(7.0)]))]);
    let received: Vec<usize> = (1..20)
        .map(|robot| percept(&mut simulation, robot).inbox.len())
        .collect();
    assert_eq!(received, [1; 19]);
}

#[test]
fn a_translation_on_a_torus_has_no_effect() {
    let mut random = Random::new(3);
    let middle = Point { x: 10.0, y: 8.0 };
    let mut collisions = 0;
    for seed in 0..8 {
        let by = random.point(20.0, 16.0);
        let runs = [Point::default(), by].map(|by| busy(seed, by));
        let [stayed, moved] = runs.map(|mut simulation| {
            (0..150).for_each(|_| simulation.step());
            (robots(&simulation), simulation.outcome())
        });
        for (one, other) in stayed.0.iter().zip(&moved.0) {
            let back = SIZE.image(middle, SIZE.home(one.at.plus(by).to(other.at).plus(middle)));
            assert!(middle.to(back).length() < 1e-6, "{seed}: {one:?} {other:?}");
            assert_eq!(one.collisions, other.collisions);
        }
        assert_eq!(stayed.1.found, moved.1.found);
        assert!(stayed.1.found[0] > 0);
        collisions += stayed.1.collisions;
    }
    assert!(collisions > 50, "{collisions}");
}

/// A crowd of searching robots, translated by a vector.
fn busy(seed: u64, by: Point) -> Simulation {
    let mut random = Random::new(seed);
    let moved = |place: Point| SIZE.home(place.plus(by)).into();
    let mines: Vec<[f64; 2]> = (0..40).map(|_| moved(random.point(20.0, 16.0))).collect();
    let lattice = (0..20_u32).map(|number| [number % 5, number / 5]);
    let places = lattice.map(|place| moved(Point::from(place.map(|at| 4.0 * f64::from(at)))));
    let rovers = format!(
        "[items.mine]\nplacement.at_m = {mines:?}\n[robots.rover]\nstart.at_m = {:?}\n\
         drive = {{ max_speed_m_s = 2, max_turn_rate_deg_s = 90 }}\n\
         sensors.sonar = {{ kind = \"range\", rays = 8, range_m = 1.5, noise_m = 0.01 }}\n\
         sensors.eye = {{ kind = \"items\", range_m = 1, noise_m = 0.1, detection_probability = {{ mine = 0.2 }} }}\n\
         sensors.mates = {{ kind = \"robots\", range_m = 2, noise_m = 0.1, course_noise_deg = 5 }}\n\
         brain = {{ limit_speed_to_stopping_distance = false, behaviours = [\
         {{ kind = \"flock\", separation = 0, cohesion = 0.3 }}, {{ kind = \"random_bounce\", turn_at_m = 0 }}] }}",
        places.collect::<Vec<[f64; 2]>>()
    );
    start(&world("", &rovers))
}

#[test]
fn point_bodies_never_collide() {
    let points = kind("point", &[[8.0, 8.0], [12.0, 8.0]], "radius_m = 0");
    let mut simulation = start(&world("", &points));
    drive(
        &mut simulation,
        20,
        &[(id(0, 0), 5.0, 0.0), (id(0, 1), 0.0, 0.0)],
    );
    let robots = robots(&simulation);
    assert_near(robots[0].at.x, 18.0);
    assert_eq!([robots[0].collisions, robots[1].collisions], [0, 0]);
}

#[test]
fn with_an_unlimited_turn_rate_a_body_turns_at_once_and_then_drives_straight() {
    let bird = kind("bird", &[[10.0, 8.0]], "").replace(", max_turn_rate_deg_s = 90", "");
    let mut simulation = start(&world("", &bird));
    // A quarter of a turn in a step of 0.1 s.
    drive(&mut simulation, 1, &[(id(0, 0), 5.0, 10.0 * FRAC_PI_2)]);
    let bird = first(&simulation);
    assert_near(bird.at.x, 10.0);
    assert_near(bird.at.y, 8.5);
    assert_near(bird.heading_rad, FRAC_PI_2);
}
