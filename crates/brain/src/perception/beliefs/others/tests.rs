use super::*;
use crate::io::agent_id::AgentId;
use crate::io::body::Other;
use crate::perception::beliefs::Beliefs;
use crate::perception::beliefs::BeliefsSpec;
use crate::perception::dead_reckoning::Odometry;
use crate::world_of_walls::rover;
use base::trig::wrapped;
use proptest::prelude::*;

const OTHER: AgentId = AgentId::robot(0, 7);

fn neighbour(id: AgentId, at: Point) -> Neighbour {
    Neighbour {
        course_rad: None,
        range_m: at.length(),
        bearing_rad: libm::atan2(at.y, at.x),
        age_s: 0.0,
        uncertainty_m: 0.0,
        id,
    }
}

const STILL: Odometry = Odometry {
    elapsed_s: 0.1,
    speed_m_s: 0.0,
    turned_rad: 0.0,
    is_commanded: false,
};

fn percept(neighbours: Vec<Neighbour>) -> Percept {
    Percept {
        neighbours,
        ..Percept::default()
    }
}

/// One observation at rest.
fn observe(others: &mut Others, neighbours: Vec<Neighbour>) {
    others.update(
        &percept(neighbours),
        &rover(),
        &Displacement::along(0.0, &STILL),
        None,
    );
}

/// The track of a robot with a constant velocity after a number of exact observations by a moving
/// and turning robot, and the true relative velocity.
fn tracked([speed, rate]: [f64; 2], velocity: Point, steps: u32) -> (Mover, Point) {
    let mut others = Others::default();
    let (mut at, mut heading_rad) = (Point::default(), 0.3);
    let mut other = Point { x: 3.0, y: -1.0 };
    let turned_rad = rate * 0.1;
    let turning = Odometry {
        turned_rad,
        is_commanded: false,
        ..STILL
    };
    let moved = Displacement::along(speed * 0.1, &turning);
    let at_rest = Displacement::along(0.0, &STILL);
    for step in 0..steps {
        if step > 0 {
            at = at.plus(turned(moved.chord, direction(heading_rad)));
            heading_rad = wrapped(heading_rad + turned_rad);
            other = other.plus(velocity.times(0.1));
        }
        let observed = turned(at.to(other), direction(-heading_rad));
        let percept = percept(vec![neighbour(OTHER, observed)]);
        others.update(
            &percept,
            &rover(),
            if step > 0 { &moved } else { &at_rest },
            None,
        );
    }
    (others.movers[0], turned(velocity, direction(-heading_rad)))
}

proptest! {
    #[test]
    fn two_exact_observations_give_the_velocity_for_any_own_motion(
        own in [-1.0_f64..1.0, -1.5_f64..1.5], vx in -2.0_f64..2.0, vy in -2.0_f64..2.0,
        steps in 2_u32..20,
    ) {
        let (mover, velocity) = tracked(own, Point { x: vx, y: vy }, steps);
        prop_assert!(mover.velocity_m_s.to(velocity).length() < 1e-6, "{mover:?} {velocity:?}");
        prop_assert_eq!(mover.observations, steps);
    }
}

#[test]
fn one_observation_gives_no_velocity() {
    let (mover, _) = tracked([1.0, 0.5], Point { x: 1.0, y: 0.0 }, 1);
    assert!(mover.speed_m_s() < 1e-12 && mover.observations == 1);
}

#[test]
fn a_track_without_observations_is_predicted_for_a_second() {
    let mut others = Others::default();
    for x in [2.0, 2.1] {
        observe(&mut others, vec![neighbour(OTHER, Point { x, y: 0.0 })]);
    }
    for _ in 0..9 {
        observe(&mut others, Vec::new());
    }
    assert!((others.movers[0].at.x - 3.0).abs() < 1e-9);
    observe(&mut others, Vec::new());
    observe(&mut others, Vec::new());
    assert!(others.movers.is_empty());
}

#[test]
fn a_delayed_observation_is_compensated() {
    let mut others = Others::default();
    for step in 0..4 {
        let late = Neighbour {
            age_s: 0.05,
            ..neighbour(
                OTHER,
                Point {
                    x: 2.0 + 0.1 * f64::from(step),
                    y: 0.0,
                },
            )
        };
        observe(&mut others, vec![late]);
    }
    let mover = others.movers[0];
    assert!((mover.velocity_m_s.x - 1.0).abs() < 1e-9 && (mover.at.x - 2.35).abs() < 1e-9);
}

/// Greatest error, in metres, of the position of a robot that stands 3 m beside a curving one, which detects
/// it a number of steps late and updates its beliefs 100 times per second.
fn max_error_of_late_detections_m(late: u16) -> f64 {
    let mut others = Others::default();
    let step = Odometry {
        elapsed_s: 0.01,
        turned_rad: 0.015,
        ..STILL
    };
    let moved = Displacement::along(0.01, &step);
    let parked = Point { x: 1.0, y: 3.0 };
    let (mut at, mut heading_rad) = (Point::default(), 0.0);
    let mut seen = Vec::new();
    let age_s = f64::from(late) * step.elapsed_s;
    let late = usize::from(late);
    let mut error_m: f64 = 0.0;
    for number in 0..500 {
        at = at.plus(turned(moved.chord, direction(heading_rad)));
        heading_rad += step.turned_rad;
        let truth = turned(at.to(parked), direction(-heading_rad));
        seen.push(truth);
        let arrived = number >= late && number % 10 == 0;
        let detection = arrived.then(|| Neighbour {
            age_s,
            ..neighbour(OTHER, seen[number - late])
        });
        let percept = percept(detection.into_iter().collect());
        others.update(&percept, &rover(), &moved, None);
        // The first detections find no path yet.
        if number >= 3 * late {
            error_m = error_m.max(others.movers[0].at.to(truth).length());
        }
    }
    error_m
}

#[test]
fn a_detection_of_more_steps_ago_than_places_are_kept_is_compensated() {
    for late in [20, 40, 80] {
        let error_m = max_error_of_late_detections_m(late);
        assert!(error_m < 0.02, "{late} steps late: {error_m} m");
    }
}

#[test]
fn invalid_neighbours_and_flying_ones_are_ignored() {
    let mut body = rover();
    body.others = vec![Other::default()];
    let near = neighbour(OTHER, Point { x: 1.0, y: 0.0 });
    let mut others = Others::default();
    others.update(
        &percept(vec![near]),
        &body,
        &Displacement::along(0.0, &STILL),
        None,
    );
    for bad in [f64::NAN, f64::INFINITY, -1.0] {
        let off = [
            Neighbour {
                range_m: bad,
                ..near
            },
            Neighbour {
                bearing_rad: 11.0 * bad,
                course_rad: None,
                ..near
            },
            Neighbour { age_s: bad, ..near },
        ];
        observe(&mut others, off.into());
    }
    assert!(others.movers.is_empty());
}

#[test]
fn the_tracks_with_the_earliest_possible_collision_are_kept() {
    let mut others = Others::default();
    let robot = |index| AgentId::robot(0, index);
    let step = |number: u32| {
        let position =
            |index: u32| direction(f64::from(index)).times(1.0 + 0.02 * f64::from(index));
        let still = (0..20).map(|index| neighbour(robot(index), position(index)));
        let x = 4.0 - 0.3 * f64::from(number);
        let approaching = neighbour(robot(99), Point { x, y: 0.0 });
        still.chain([approaching]).collect::<Vec<_>>()
    };
    // Alone at first, so that its velocity is known.
    observe(&mut others, step(0).split_off(20));
    (1..4).for_each(|number| observe(&mut others, step(number)));
    let ids: Vec<AgentId> = others.movers.iter().filter_map(|mover| mover.id).collect();
    assert_eq!(ids.len(), MAX_MOVERS);
    assert!(ids.contains(&robot(99)) && ids.contains(&robot(0)) && !ids.contains(&robot(19)));
}

#[test]
fn renumbered_robots_keep_their_tracks_and_removed_ones_lose_them() {
    let body = rover();
    let mut beliefs = Beliefs::new(&BeliefsSpec::default(), &body);
    let robot = |index| AgentId::robot(0, index);
    let both = |first| {
        let position = |y| Point { x: 2.0, y };
        percept(vec![
            neighbour(robot(first), position(0.0)),
            neighbour(robot(5), position(1.0)),
        ])
    };
    beliefs.update(&both(3), &body, &[], &STILL);
    beliefs.renumber(&|id: AgentId| (id.index == 3).then_some(robot(1)));
    let movers = &beliefs.others.movers;
    assert_eq!(
        movers.iter().map(|mover| mover.id).collect::<Vec<_>>(),
        [Some(robot(1))]
    );
    beliefs.update(&both(1), &body, &[], &STILL);
    assert_eq!(beliefs.others.movers[0].observations, 2);
}

/// Whether a hit on a robot still counts as one on a moving object after it has stood for a time, and
/// then moved by a distance.
fn is_moving_after(standing_s: f64, moved_m: f64) -> bool {
    let mut others = Others::default();
    let at = |x: f64| Point { x, y: 0.5 };
    let mut time_s = 0.0;
    while time_s <= standing_s {
        observe(&mut others, vec![neighbour(OTHER, at(2.0))]);
        time_s += STILL.elapsed_s;
    }
    for step in 0..10 {
        let x = 2.0 + 0.1 * moved_m * f64::from(step + 1);
        observe(&mut others, vec![neighbour(OTHER, at(x))]);
    }
    let hit = others.movers[0].at;
    assert!(others.is_on_mover(hit));
    others.is_on_moving(hit)
}

#[test]
fn a_robot_is_parked_after_twenty_seconds_in_one_place_until_it_moves_on() {
    assert!(is_moving_after(15.0, 0.0));
    assert!(!is_moving_after(21.0, 0.0));
    assert!(!is_moving_after(21.0, 0.3));
    assert!(is_moving_after(21.0, 1.0));
}

/// Whether a robot that stands at a place in the world is parked for one that is out of sight of it for
/// a minute, and finds it in another place.
fn is_parked_after_a_minute(moved: Point) -> bool {
    let mut others = Others::default();
    let mut see = |pose: &Pose, at: Option<Point>| {
        let neighbours = at.map(|at| neighbour(OTHER, pose.in_own_frame(at)));
        let percept = percept(neighbours.into_iter().collect());
        let moved = Displacement::along(0.0, &STILL);
        others.update(&percept, &rover(), &moved, Some(pose));
        others.movers.first().is_some_and(Mover::is_parked)
    };
    let place = Point { x: 5.0, y: 3.0 };
    let pose = Pose {
        at: Point { x: 2.0, y: 2.0 },
        heading_rad: 1.0,
        deviation_m: 0.0,
        deviation_rad: 0.0,
        age_s: 0.0,
    };
    assert!(!see(&pose, Some(place)));
    (0..600).for_each(|_| assert!(!see(&pose, None)));
    let other_pose = Pose {
        at: Point { x: 8.0, y: 5.0 },
        heading_rad: -2.0,
        ..pose
    };
    see(&other_pose, Some(place.plus(moved)))
}

#[test]
fn a_robot_that_is_found_where_it_was_a_minute_ago_is_parked() {
    assert!(is_parked_after_a_minute(Point::default()));
    assert!(is_parked_after_a_minute(Point { x: 0.3, y: 0.2 }));
    assert!(!is_parked_after_a_minute(Point { x: 1.0, y: 0.0 }));
}

#[test]
fn a_robot_is_parked_for_a_noisy_sensor() {
    let body = Body {
        neighbour_noise_m: 0.3,
        ..rover()
    };
    let mut others = Others::default();
    // A square wave is as noisy as its amplitude.
    for step in 0..250 {
        let side = if step % 2 == 0 { 0.3 } else { -0.3 };
        let at = Point {
            x: 3.0 + side,
            y: side,
        };
        let moved = Displacement::along(0.0, &STILL);
        others.update(&percept(vec![neighbour(OTHER, at)]), &body, &moved, None);
    }
    assert!(others.movers[0].is_parked());
}
