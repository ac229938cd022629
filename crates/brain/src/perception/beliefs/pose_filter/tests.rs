use super::*;
use crate::perception::dead_reckoning::Odometry;
use crate::world_of_walls::rover;

#[test]
fn a_pose_that_overflows_is_forgotten_and_corrected_by_the_next_readings() {
    let mut filter = PoseFilter::default();
    let correct = |filter: &mut PoseFilter| {
        filter.correct_heading(1.0, 0.1);
        filter.correct_position(Point { x: 2.0, y: 3.0 }, 0.1);
    };
    correct(&mut filter);
    let absurd = Odometry {
        elapsed_s: 0.1,
        speed_m_s: f64::INFINITY,
        turned_rad: 0.0,
        is_commanded: false,
    };
    filter.predict(&Displacement::along(f64::INFINITY, &absurd), &rover());
    assert_eq!(filter.pose(), None);
    correct(&mut filter);
    let pose = filter.pose().expect("both are known again");
    assert_eq!(pose.at, Point { x: 2.0, y: 3.0 });
}

/// Steps a robot of these true parameters: factor on the speed, curvature and lag. It drives and turns for two
/// minutes, and measures its position each second.
fn learnt([speed_scale, curvature_rad_m, lag_s]: [f64; 3]) -> PoseFilter {
    let mut filter = PoseFilter::default();
    let mut drive = DriveEstimate::default();
    drive.speed_scale = speed_scale;
    (drive.curvature_rad_m, drive.lag_s) = (curvature_rad_m, lag_s);
    let (mut at, mut heading_rad) = (Point::default(), 0.0);
    for step in 0..1200 {
        let [speed_m_s, rate_rad_s] = match step / 25 % 4 {
            0 => [0.0, 0.8],
            2 => [0.0, -0.5],
            _ => [0.6, 0.0],
        };
        let odometry = Odometry {
            elapsed_s: 0.1,
            speed_m_s,
            turned_rad: 0.1 * rate_rad_s,
            is_commanded: true,
        };
        let moved = Displacement::along(0.1 * speed_m_s, &odometry);
        let lagged = drive.lagged(&moved);
        let executed = drive.executed(&moved, &lagged);
        drive.advance(&lagged);
        at = at.plus(turned(executed.chord, direction(heading_rad)));
        heading_rad = wrapped(heading_rad + executed.turned_rad);
        filter.predict(&moved, &rover());
        filter.correct_heading(heading_rad, 0.01);
        if step % 10 == 9 {
            filter.correct_position(at, 0.1);
        }
    }
    filter
}

#[test]
fn the_parameters_of_a_drive_are_learnt() {
    for [speed_scale, curvature_rad_m, lag_s] in
        [[0.5, 0.0, 0.05], [1.2, 0.1, 0.25], [0.9, -0.2, 0.5]]
    {
        let drive = learnt([speed_scale, curvature_rad_m, lag_s])
            .drive
            .unwrap()
            .estimate;
        assert!((drive.speed_scale - speed_scale).abs() < 0.02, "{drive:?}");
        assert!((drive.turn_scale - 1.0).abs() < 0.02, "{drive:?}");
        assert!(
            (drive.curvature_rad_m - curvature_rad_m).abs() < 0.02,
            "{drive:?}"
        );
        assert!((drive.lag_s - lag_s).abs() < 0.03, "{drive:?}");
    }
}

#[test]
fn the_factors_of_odometry_are_learnt() {
    let mut body = rover();
    (body.position_noise_m, body.heading_noise_rad) = (0.2, 0.05);
    for [speed_scale, turn_scale] in [[1.05, 1.0], [1.2, 1.0], [0.9, 1.1], [1.0, 0.8]] {
        let mut filter = PoseFilter::default();
        let (mut at, mut heading_rad) = (Point::default(), 0.0);
        for step in 0..1200 {
            let [speed_m_s, rate_rad_s] = [0.6, if step / 40 % 3 == 0 { 0.8 } else { -0.1 }];
            let moved = |speed_m_s: f64, rate_rad_s: f64| {
                let odometry = Odometry {
                    elapsed_s: 0.1,
                    speed_m_s,
                    turned_rad: 0.1 * rate_rad_s,
                    is_commanded: false,
                };
                Displacement::along(0.1 * speed_m_s, &odometry)
            };
            let true_chord = moved(speed_m_s, rate_rad_s).chord;
            at = at.plus(turned(true_chord, direction(heading_rad)));
            heading_rad = wrapped(heading_rad + 0.1 * rate_rad_s);
            let measured = moved(speed_scale * speed_m_s, turn_scale * rate_rad_s);
            filter.predict(&measured, &body);
            if step % 10 == 9 {
                filter.correct_heading(heading_rad, body.heading_noise_rad);
                filter.correct_position(at, body.position_noise_m);
            }
        }
        let pose = filter.pose().unwrap();
        let off_m = pose.at.to(at).length();
        assert!(
            off_m < pose.deviation_m,
            "{speed_scale} {turn_scale} {pose:?}"
        );
        let drive = filter.drive.unwrap().estimate;
        assert!(
            (drive.speed_scale * speed_scale - 1.0).abs() < 0.02,
            "{drive:?}"
        );
        assert!(
            (drive.turn_scale * turn_scale - 1.0).abs() < 0.02,
            "{drive:?}"
        );
    }
}

#[test]
fn a_robot_that_measures_its_motion_estimates_no_drive() {
    let mut filter = PoseFilter::default();
    let measured = Odometry {
        elapsed_s: 0.1,
        speed_m_s: 1.0,
        turned_rad: 0.0,
        is_commanded: false,
    };
    filter.predict(&Displacement::along(0.1, &measured), &rover());
    assert!(filter.drive().is_none());
}
