use super::*;
use proptest::prelude::*;

const RADIUS_M: f64 = 0.25;

/// Step length of the reference that marches a disc along a heading, in metres.
const STRIDE_M: f64 = 0.005;

fn hit() -> impl Strategy<Value = Ray> {
    (-PI..PI, 0.05_f64..6.0).prop_map(|(bearing_rad, range_m)| Ray::new(bearing_rad, range_m))
}

fn mover() -> impl Strategy<Value = Mover> {
    let number = -4.0_f64..4.0;
    let speed = -1.5_f64..1.5;
    (number.clone(), number, speed.clone(), speed).prop_map(|(x, y, vx, vy)| Mover {
        id: None,
        at: Point { x, y },
        velocity_m_s: Point { x: vx, y: vy },
        course: Point::default(),
        radius_m: 0.3,
        braking_m_s2: 1.0,
        age_s: 0.0,
        observations: 2,
        ..Mover::default()
    })
}

/// Reference: the distance that a disc moves along a heading until it is nearer than `contact_m` to
/// a moving point and still approaching it. `drift` is the point's motion per metre of the disc's.
fn marched_m(heading: Point, at: Point, drift: Point, contact_m: f64) -> f64 {
    let distance_m = |along_m: f64| {
        heading
            .times(along_m)
            .to(at.plus(drift.times(along_m)))
            .length()
    };
    let mut along_m = 0.0;
    while along_m < HORIZON_M {
        let next_m = distance_m(along_m + STRIDE_M);
        if next_m < contact_m && next_m < distance_m(along_m) {
            return along_m;
        }
        along_m += STRIDE_M;
    }
    HORIZON_M
}

fn reachable(hits: &[Ray], movers: &[Mover], speed_m_s: f64) -> Reachable {
    let mut reachable = Reachable::default();
    reachable.update(hits, movers, (RADIUS_M, speed_m_s));
    reachable
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn free_distances_beside_obstacles_match_the_reference(
        hits in proptest::collection::vec(hit(), 0..12),
    ) {
        let reachable = reachable(&hits, &[], 1.0);
        for (heading, free_m) in reachable.free_m.iter().enumerate() {
            let heading = direction(bearing_rad(heading));
            let contact_m = RADIUS_M + OBSTACLE_MARGIN_M;
            let marched = hits.iter().map(|hit| {
                let at = direction(hit.bearing_rad).times(hit.range_m);
                marched_m(heading, at, Point::default(), contact_m)
            });
            let expected_m = marched.fold(HORIZON_M, f64::min);
            // The reference can miss an obstacle that the disc only grazes.
            let grazes = hits.iter().any(|hit| {
                let at = direction(hit.bearing_rad).times(hit.range_m);
                let is_beside = heading.dot(at).abs() < STRIDE_M;
                is_beside || (heading.cross(at).abs() - contact_m).abs() < 1e-3
            });
            let is_right = (free_m - expected_m).abs() <= 2.0 * STRIDE_M;
            prop_assert!(is_right || grazes, "{} {}", free_m, expected_m);
        }
    }

    #[test]
    fn free_distances_before_movers_match_the_reference(
        movers in proptest::collection::vec(mover(), 1..4), speed_m_s in 0.3_f64..1.5,
    ) {
        let reachable = reachable(&[], &movers, speed_m_s);
        for (heading, free_m) in reachable.free_m.iter().enumerate() {
            let heading = direction(bearing_rad(heading));
            let marched = movers.iter().map(|mover| {
                let contact_m = RADIUS_M + mover.radius_m + MOVER_MARGIN_M;
                if mover.at.length() <= contact_m {
                    return if mover.at.dot(heading) > 0.0 { 0.0 } else { HORIZON_M };
                }
                let drift = mover.velocity_m_s.times(1.0 / speed_m_s);
                marched_m(heading, mover.at, drift, contact_m)
            });
            let expected_m = marched.fold(HORIZON_M, f64::min);
            // A near miss may count as contact in only one of the two.
            let clear_m = free_m.min(expected_m);
            let is_near = movers.iter().any(|mover| {
                let at = mover.at.plus(mover.velocity_m_s.times((clear_m + 0.1) / speed_m_s));
                let contact_m = mover.radius_m + RADIUS_M + MOVER_MARGIN_M;
                heading.times(clear_m + 0.1).to(at).length() < contact_m + 0.15
            });
            let is_right = (free_m - expected_m).abs() <= 3.0 * STRIDE_M;
            prop_assert!(is_right || is_near, "{} {}", free_m, expected_m);
        }
    }

    #[test]
    fn without_obstacles_the_best_heading_is_straight_to_the_target(
        target_rad in -PI..PI, distance_m in 1.0_f64..20.0,
    ) {
        let choice = reachable(&[], &[], 1.0).best(target_rad, distance_m);
        // Turning has a small cost, so of the two headings beside the target the one further ahead
        // may win.
        let off_rad = wrapped(choice.bearing_rad - target_rad).abs();
        prop_assert!(off_rad <= 1.3 * PI / 40.0, "{choice:?}");
        let nearest =
            (0..HEADINGS).map(|heading| wrapped(bearing_rad(heading) - target_rad).abs());
        if nearest.fold(PI, f64::min) < 0.7 * PI / 40.0 {
            prop_assert!((choice.bearing_rad - target_rad).abs() < 1e-12, "{choice:?}");
        }
    }

    #[test]
    fn every_heading_that_touches_an_obstacle_is_limited(
        range_m in 0.01_f64..5.0, at_rad in -PI..PI,
    ) {
        let reachable = reachable(&[Ray::new(at_rad, range_m)], &[], 1.0);
        let at = direction(at_rad).times(range_m);
        let contact_m = RADIUS_M + OBSTACLE_MARGIN_M;
        for (heading, free_m) in reachable.free_m.iter().enumerate() {
            let heading = direction(bearing_rad(heading));
            let touches = heading.dot(at) > 0.0 && heading.cross(at).abs() < contact_m - 1e-9;
            prop_assert!(!touches || *free_m < HORIZON_M);
        }
    }
}

#[test]
fn a_blocked_target_is_passed_on_the_nearer_side() {
    let wall = [-0.3, -0.2, -0.1, 0.0, 0.1_f64].map(|bearing_rad| Ray::new(bearing_rad, 1.5));
    let choice = reachable(&wall, &[], 1.0).best(0.0, 4.0);
    assert!((0.1..0.8).contains(&choice.bearing_rad), "{choice:?}");
    assert!(choice.free_m > 4.0, "{choice:?}");
}
