//! Effects of a contact: the robot stops, is delayed, and may break; it counts as one collision.

use crate::common::{self, Random, first, go, id, robots, start, step_with};
use base::geometry::Point;
use base::trig::sin_cos;
use sim::run::{Robot, Status};
use sim::simulation::Simulation;
use std::f64::consts::FRAC_PI_2;

/// One robot half a metre from the wall that it faces, at 1 m/s; or two that face each other.
fn text(collision: &str, robots: u32) -> String {
    format!(
        "[clock]\nstep_s = 0.1\ntime_limit_s = 100\n[world]\nsize_m = [10, 10]\n\
         [robots.rover]\ncount = {robots}\nradius_m = 0.5\n\
         start = {{ kind = \"fixed\", at_m = [[9, 5], [7, 5]], heading_deg = [0, 0] }}\n\
         drive = {{ max_speed_m_s = 1, max_reverse_speed_m_s = 1, max_turn_rate_deg_s = 180 }}\n\
         collision = {{ {collision} }}\n"
    )
}

/// Steps with constant commands for robots of the first kind, by index; returns all robots after
/// each step.
fn drive(simulation: &mut Simulation, steps: u32, commands: &[(u32, f64, f64)]) -> Vec<Vec<Robot>> {
    let commands = commands.iter();
    let commands: Vec<_> = commands
        .map(|(index, speed, turn)| (id(0, *index), *speed, *turn))
        .collect();
    common::drive(simulation, steps, &commands)
}

#[test]
fn driving_on_against_a_wall_counts_as_one_collision() {
    let mut simulation = start(&text("", 1));
    let ways = drive(&mut simulation, 40, &[(0, 1.0, 0.0)]);
    // 0.5 m at 1 m/s: contact at the end of the fifth step or in the sixth.
    assert!(ways[3][0].collisions == 0 && !ways[3][0].is_touching);
    assert!(
        ways[5..]
            .iter()
            .all(|robots| robots[0].collisions == 1 && robots[0].is_touching)
    );
    assert!((first(&simulation).at.x - 9.5).abs() < 1e-9);
    assert!((first(&simulation).distance_m - 0.5).abs() < 1e-9);
    assert_eq!(simulation.outcome().collisions, 1);
}

#[test]
fn a_robot_in_contact_with_a_wall_can_turn_on_the_spot_and_leave() {
    let mut simulation = start(&text("", 1));
    drive(&mut simulation, 10, &[(0, 1.0, 0.0)]);
    // A quarter turn: it faces along the wall.
    drive(&mut simulation, 5, &[(0, 0.0, std::f64::consts::PI)]);
    assert!(!first(&simulation).is_touching);
    drive(&mut simulation, 20, &[(0, 1.0, 0.0)]);
    let robot = first(&simulation);
    assert!(
        (robot.at.y - 7.0).abs() < 1e-9 && (robot.at.x - 9.5).abs() < 1e-9,
        "{robot:?}"
    );
    assert_eq!(robot.collisions, 1);
    // Returning after the contact has ended is a new contact.
    drive(&mut simulation, 5, &[(0, 0.0, -std::f64::consts::PI)]);
    drive(&mut simulation, 5, &[(0, -1.0, 0.0)]);
    drive(&mut simulation, 9, &[(0, 1.0, 0.0)]);
    assert_eq!(first(&simulation).collisions, 2);
    assert_eq!(simulation.outcome().collisions, 2);
}

#[test]
fn reversing_from_a_wall_ends_the_contact_at_once() {
    let mut simulation = start(&text("", 1));
    drive(&mut simulation, 10, &[(0, 1.0, 0.0)]);
    let ways = drive(&mut simulation, 3, &[(0, -1.0, 0.0)]);
    assert!((ways[0][0].at.x - 9.4).abs() < 1e-9 && !ways[0][0].is_touching);
    assert!((ways[2][0].at.x - 9.2).abs() < 1e-9);
}

#[test]
fn a_collision_stops_a_robot_for_stop_duration_s() {
    for (stop_duration_s, steps) in [(0.0, 0), (0.3, 3), (0.25, 3), (1.0, 10)] {
        let mut simulation = start(&text(&format!("stop_duration_s = {stop_duration_s}"), 1));
        let mut hit = 0;
        while first(&simulation).collisions == 0 {
            drive(&mut simulation, 1, &[(0, 1.0, 0.0)]);
            hit += 1;
            assert!(hit < 9);
        }
        let ways = drive(&mut simulation, steps + 2, &[(0, -1.0, 1.0)]);
        for (step, robots) in ways.iter().enumerate() {
            let is_held = step < steps as usize;
            assert_eq!(robots[0].at.x > 9.499, is_held, "{stop_duration_s} {step}");
            assert_eq!(robots[0].is_touching, is_held, "{stop_duration_s} {step}");
            // A stopped robot neither drives nor turns.
            assert_eq!(
                robots[0].heading_rad == 0.0,
                is_held,
                "{stop_duration_s} {step}"
            );
        }
    }
}

#[test]
fn a_robot_breaks_after_max_collisions() {
    let mut simulation = start(&text("max_collisions = 3", 1));
    for collision in 1..=3 {
        assert_eq!(first(&simulation).status, Status::Active);
        drive(&mut simulation, 8, &[(0, 1.0, 0.0)]);
        assert_eq!(first(&simulation).collisions, collision);
        drive(&mut simulation, 3, &[(0, -1.0, 0.0)]);
    }
    assert_eq!(first(&simulation).status, Status::Broken);
    assert_eq!(simulation.outcome().robots_stopped, 1);
    assert!(simulation.state().is_over(simulation.scenario()));
    let at = first(&simulation).at;
    drive(&mut simulation, 5, &[(0, -1.0, 1.0)]);
    assert_eq!(first(&simulation).at, at);
}

#[test]
fn a_contact_of_two_robots_stops_both_and_counts_once() {
    let mut simulation = start(&text("stop_duration_s = 0.2", 2));
    // The second approaches from behind at 1 m/s, the first reverses at 0.5 m/s; the gap is 1 m.
    let ways = drive(&mut simulation, 9, &[(0, -0.5, 0.0), (1, 1.0, 0.0)]);
    let last = &ways[8];
    assert!((last[0].at.x - last[1].at.x - 1.0).abs() < 1e-9);
    assert!((last[0].at.x - (9.0 - 1.0 / 3.0)).abs() < 1e-9);
    assert!(
        last.iter()
            .all(|robot| robot.collisions == 1 && robot.is_touching)
    );
    assert!(last.iter().all(|robot| robot.speed_m_s == 0.0));
    assert_eq!(simulation.outcome().collisions, 1);
    // Separated again, both can move.
    drive(&mut simulation, 5, &[(0, 0.5, 0.0), (1, -0.5, 0.0)]);
    assert!(robots(&simulation).iter().all(|robot| !robot.is_touching));
    assert_eq!(simulation.outcome().collisions, 1);
}

#[test]
fn a_robot_hit_from_behind_stops_too() {
    let mut simulation = start(&text("", 2));
    let ways = drive(&mut simulation, 11, &[(0, -0.001, 0.0), (1, 1.0, 0.0)]);
    assert_eq!(ways[8][0].collisions, 0);
    assert!(ways[10].iter().all(|robot| robot.collisions == 1));
    assert_eq!(simulation.outcome().collisions, 1);
}

#[test]
fn a_broken_robot_is_an_obstacle() {
    let mut simulation = start(&text("max_collisions = 1", 2));
    let ways = drive(&mut simulation, 30, &[(0, 1.0, 0.0), (1, 1.0, 0.0)]);
    let last = &ways[29];
    assert!(last.iter().all(|robot| robot.status == Status::Broken));
    assert!((last[1].at.x - 8.5).abs() < 1e-9, "{last:?}");
    assert_eq!(simulation.outcome().collisions, 2);
}

/// Two robots in contact in a wide world. The second faces the first, which is at bearing
/// `apart_rad` from it, with heading `course_rad`.
fn touching(collision: &str, apart_rad: f64, course_rad: f64) -> String {
    let (y, x) = sin_cos(apart_rad);
    let behind = Point {
        x: 50.0 - x,
        y: 50.0 - y,
    };
    let degrees = [course_rad, apart_rad].map(f64::to_degrees);
    format!(
        "[clock]\nstep_s = 0.1\ntime_limit_s = 100\n[world]\nsize_m = [100, 100]\n\
         [robots.rover]\ncount = 2\nradius_m = 0.5\n\
         start = {{ kind = \"fixed\", at_m = [[50, 50], [{}, {}]], heading_deg = {degrees:?} }}\n\
         drive = {{ max_speed_m_s = 2, max_reverse_speed_m_s = 2, max_turn_rate_deg_s = 180 }}\n\
         collision = {{ {collision} }}\n",
        behind.x, behind.y
    )
}

#[test]
fn a_slow_robot_can_drive_away_from_a_faster_one_behind_it() {
    let random = &mut Random::new(5);
    let mut pressed = 0;
    for scene in 0..200 {
        let apart_rad = random.between(-3.0, 3.0);
        // Away from the one behind, or past it.
        let any_rad = random.between(-1.5, 1.5);
        let off_rad = random.one_of(&[any_rad, FRAC_PI_2, -FRAC_PI_2, 0.0]);
        let slow_m_s = random.between(0.1, 0.9);
        let mut simulation = start(&touching("", apart_rad, apart_rad + off_rad));
        // It collides with the stationary one, and keeps driving against it.
        drive(&mut simulation, 3, &[(0, 0.0, 0.0), (1, 2.0, 0.0)]);
        assert!(robots(&simulation).iter().all(|robot| robot.is_touching));
        let ways = drive(&mut simulation, 20, &[(0, slow_m_s, 0.0), (1, 2.0, 0.0)]);
        // Leaving sideways lets the other one pass eventually.
        let is_pressing = |(_, now): &(u32, &Vec<Robot>)| now[1].is_touching;
        for (step, now) in (1..).zip(&ways).take_while(is_pressing) {
            let way_m = slow_m_s * 0.1 * f64::from(step);
            let context = format!("scene {scene}, step {step}: {off_rad} {now:?}");
            assert!((now[0].distance_m - way_m).abs() < 1e-9, "{context}");
            assert!(now[0].at.to(now[1].at).length() > 1.0 - 1e-9, "{context}");
            assert_eq!(now[0].speed_m_s, slow_m_s, "{context}");
            assert!(!now[0].is_touching, "{context}");
            assert!(now.iter().all(|robot| robot.collisions == 1), "{context}");
            pressed += 1;
        }
    }
    assert!(pressed > 200 * 10, "{pressed}");
}

#[test]
fn a_stationary_robot_that_is_pushed_reports_contact_and_counts_one_collision() {
    let mut simulation = start(&touching("stop_duration_s = 0.3", 0.4, 0.4));
    let ways = drive(&mut simulation, 20, &[(0, 0.0, 0.0), (1, 1.0, 0.0)]);
    let mut all = ways[1..].iter().flatten();
    assert!(all.all(|robot| robot.is_touching && robot.collisions == 1 && robot.distance_m < 1e-9));
    assert_eq!(simulation.outcome().collisions, 1);
}

#[test]
fn an_arc_that_returns_to_the_same_contact_within_a_step_stops_there() {
    // It leaves on an arc of half a turn that ends at the robot pushing it.
    for turn_rad_s in [3.1, -3.1] {
        let text =
            touching("", 0.0, 0.9_f64.copysign(turn_rad_s)).replace("step_s = 0.1", "step_s = 1");
        let mut simulation = start(&text);
        drive(&mut simulation, 1, &[(0, 0.0, 0.0), (1, 2.0, 0.0)]);
        let ways = drive(&mut simulation, 1, &[(0, 2.0, turn_rad_s), (1, 2.0, 0.0)]);
        let gap_m = ways[0][0].at.to(ways[0][1].at).length() - 1.0;
        assert!(
            gap_m.abs() < 1e-9 && ways[0][0].distance_m > 1.0,
            "{gap_m} {ways:?}"
        );
    }
}

#[test]
fn robots_in_a_dense_crowd_do_not_overlap() {
    for seed in 0..20 {
        let random = &mut Random::new(seed);
        let step_s = random.one_of(&[0.05, 0.2]);
        let kind = |name: &str, radius_m: f64| {
            format!(
                "[robots.{name}]\ncount = 12\nradius_m = {radius_m}\n\
                 drive = {{ max_speed_m_s = 3, max_reverse_speed_m_s = 2, max_turn_rate_deg_s = 700 }}\n"
            )
        };
        let kinds = kind("big", 0.3) + &kind("small", 0.15);
        let mut simulation = start(&format!(
            "[clock]\nstep_s = {step_s}\ntime_limit_s = 100\n[world]\nsize_m = [4, 4]\n{kinds}"
        ));
        let mut touching = 0;
        for _ in 0..150 {
            let commands = robots(&simulation).into_iter().map(|robot| {
                let speed = random.one_of(&[3.0, 3.0, 1.0, 0.2, -2.0]);
                (robot.id, go(speed, random.one_of(&[0.0, 0.0, 12.0, -5.0])))
            });
            let commands: Vec<_> = commands.collect();
            step_with(&mut simulation, commands);
            let now = robots(&simulation);
            for (place, one) in now.iter().enumerate() {
                touching += u32::from(one.is_touching);
                for other in &now[..place] {
                    let gap_m = one.at.to(other.at).length() - one.radius_m - other.radius_m;
                    assert!(gap_m > -1e-9, "seed {seed}: {gap_m} {one:?} {other:?}");
                }
            }
        }
        assert!(touching > 1000, "{touching}");
    }
}
