use super::*;
use proptest::prelude::*;

const RADIUS_M: f64 = 0.25;

/// Steps of the disc that is marched along a course, in metres.
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
        looks: 2,
    })
}

/// How far a disc goes along a course until it is nearer than `reach_m` to a place that moves on, and
/// still coming nearer: marched.
fn marched_m(course: Point, at: Point, still: Point, reach_m: f64) -> f64 {
    let apart_m = |along_m: f64| {
        course
            .times(along_m)
            .to(at.plus(still.times(along_m)))
            .length()
    };
    let mut along_m = 0.0;
    while along_m < HORIZON_M {
        let next_m = apart_m(along_m + STRIDE_M);
        if next_m < reach_m && next_m < apart_m(along_m) {
            return along_m;
        }
        along_m += STRIDE_M;
    }
    HORIZON_M
}

fn looked(hits: &[Ray], movers: &[Mover], speed_m_s: f64) -> Reachable {
    let mut reachable = Reachable::default();
    reachable.look(hits, movers, (RADIUS_M, speed_m_s));
    reachable
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn a_course_is_free_as_far_as_a_disc_that_is_marched_along_it_gets(
        hits in proptest::collection::vec(hit(), 0..12),
    ) {
        let reachable = looked(&hits, &[], 1.0);
        for (course, free_m) in reachable.free_m.iter().enumerate() {
            let course = direction(bearing_rad(course));
            let reach_m = RADIUS_M + GRAZING_M;
            let marched = hits.iter().map(|hit| {
                let at = direction(hit.bearing_rad).times(hit.range_m);
                marched_m(course, at, Point::default(), reach_m)
            });
            let expected_m = marched.fold(HORIZON_M, f64::min);
            // Whom it would only graze, marching may miss.
            let grazes = hits.iter().any(|hit| {
                let at = direction(hit.bearing_rad).times(hit.range_m);
                let is_beside = course.dot(at).abs() < STRIDE_M;
                is_beside || (course.cross(at).abs() - reach_m).abs() < 1e-3
            });
            let is_right = (free_m - expected_m).abs() <= 2.0 * STRIDE_M;
            prop_assert!(is_right || grazes, "{} {}", free_m, expected_m);
        }
    }

    #[test]
    fn who_moves_is_met_where_he_will_be(
        movers in proptest::collection::vec(mover(), 1..4), speed_m_s in 0.3_f64..1.5,
    ) {
        let reachable = looked(&[], &movers, speed_m_s);
        for (course, free_m) in reachable.free_m.iter().enumerate() {
            let course = direction(bearing_rad(course));
            let marched = movers.iter().map(|mover| {
                let reach_m = RADIUS_M + mover.radius_m + MARGIN_M;
                if mover.at.length() <= reach_m {
                    return if mover.at.dot(course) > 0.0 { 0.0 } else { HORIZON_M };
                }
                let still = mover.velocity_m_s.times(1.0 / speed_m_s);
                marched_m(course, mover.at, still, reach_m)
            });
            let expected_m = marched.fold(HORIZON_M, f64::min);
            // A near miss is one for only one of both.
            let clear_m = free_m.min(expected_m);
            let is_near = movers.iter().any(|mover| {
                let at = mover.at.plus(mover.velocity_m_s.times((clear_m + 0.1) / speed_m_s));
                course.times(clear_m + 0.1).to(at).length() < mover.radius_m + RADIUS_M + MARGIN_M + 0.15
            });
            let is_right = (free_m - expected_m).abs() <= 3.0 * STRIDE_M;
            prop_assert!(is_right || is_near, "{} {}", free_m, expected_m);
        }
    }

    #[test]
    fn in_the_open_the_best_way_is_straight_to_the_aim(aim_rad in -PI..PI, away_m in 1.0_f64..20.0) {
        let choice = looked(&[], &[], 1.0).best(aim_rad, away_m);
        // Turning costs a little, so of two courses beside it the one ahead may win.
        prop_assert!(wrapped(choice.bearing_rad - aim_rad).abs() <= 1.3 * PI / 40.0, "{choice:?}");
        let nearest = (0..COURSES).map(|course| wrapped(bearing_rad(course) - aim_rad).abs());
        if nearest.fold(PI, f64::min) < 0.7 * PI / 40.0 {
            prop_assert!((choice.bearing_rad - aim_rad).abs() < 1e-12, "{choice:?}");
        }
    }

    #[test]
    fn no_course_that_would_touch_is_left_out(range_m in 0.01_f64..5.0, at_rad in -PI..PI) {
        let reachable = looked(&[Ray::new(at_rad, range_m)], &[], 1.0);
        let at = direction(at_rad).times(range_m);
        for (course, free_m) in reachable.free_m.iter().enumerate() {
            let course = direction(bearing_rad(course));
            let touches = course.dot(at) > 0.0 && course.cross(at).abs() < RADIUS_M + GRAZING_M - 1e-9;
            prop_assert!(!touches || *free_m < HORIZON_M);
        }
    }
}

#[test]
fn a_blocked_aim_is_passed_on_the_side_that_is_nearer_to_it() {
    let wall = [-0.3, -0.2, -0.1, 0.0, 0.1_f64].map(|bearing_rad| Ray::new(bearing_rad, 1.5));
    let choice = looked(&wall, &[], 1.0).best(0.0, 4.0);
    assert!((0.1..0.8).contains(&choice.bearing_rad), "{choice:?}");
    assert!(choice.free_m > 4.0, "{choice:?}");
}
