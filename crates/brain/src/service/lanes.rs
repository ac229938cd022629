//! The path of a search: lanes through a disc, back and forth.

use crate::io::dispatch::Task;
use base::geometry::Point;

/// Maximum number of lanes.
const MAX_LANES: f64 = 1000.0;

/// The corner of a number on the path of a search; `None` after the last.
pub(crate) fn corner(task: &Task, lane_m: f64, number: u32) -> Option<Point> {
    let radius_m = f64::from(task.radius_m);
    let lanes = lanes(task, lane_m);
    let lane = f64::from(number / 2);
    if lane >= lanes {
        return None;
    }
    let up_m = radius_m * ((2.0 * lane + 1.0) / lanes - 1.0);
    let side_m = libm::sqrt((radius_m * radius_m - up_m * up_m).max(0.0));
    let is_right = matches!(number % 4, 1 | 2);
    let right_m = if is_right { side_m } else { -side_m };
    let at = task.at();
    Some(at.plus(Point {
        x: right_m,
        y: up_m,
    }))
}

/// Length of the path, from its first corner.
pub(crate) fn length_m(task: &Task, lane_m: f64) -> f64 {
    let corners = (0..).map_while(|number| corner(task, lane_m, number));
    let mut last: Option<Point> = None;
    let mut length_m = 0.0;
    for at in corners {
        length_m += last.map_or(0.0, |last| last.to(at).length());
        last = Some(at);
    }
    length_m
}

fn lanes(task: &Task, lane_m: f64) -> f64 {
    libm::ceil(2.0 * f64::from(task.radius_m) / lane_m.max(1e-3)).clamp(1.0, MAX_LANES)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::dispatch::Work;
    use crate::io::goal_id::GoalId;

    #[test]
    fn every_place_of_the_disc_is_within_half_a_lane_of_the_path() {
        let task = Task {
            id: GoalId::default(),
            at_m: [3.0, 4.0],
            radius_m: 10.0,
            value: 1.0,
            service_s: 0.0,
            due_s: f32::MAX,
            work: Work::Search,
            capability: 0,
        };
        let corners = (0..).map_while(|number| corner(&task, 3.0, number));
        let corners: Vec<Point> = corners.collect();
        assert_eq!(corners.len(), 14);
        let centre = Point { x: 3.0, y: 4.0 };
        assert!(corners.iter().all(|at| centre.to(*at).length() < 10.001));
        // Lanes are level, and the next one begins on the side where the last one ends.
        for lane in corners.chunks(2) {
            assert!((lane[0].y - lane[1].y).abs() < 1e-9);
        }
        for turn in corners[1..13].chunks(2) {
            assert!((turn[1].y - turn[0].y - 20.0 / 7.0).abs() < 1e-9);
            assert!((turn[1].x - 3.0) * (turn[0].x - 3.0) > 0.0);
        }
        assert!(length_m(&task, 3.0) > 314.0 / 3.0 && length_m(&task, 3.0) < 150.0);
    }
}
