//! The path of a search: lanes through a disc, back and forth.

use crate::io::dispatch::Task;
use base::geometry::{Point, Rectangle};

/// Maximum number of lanes.
const MAX_LANES: f64 = 1000.0;

/// An item this far beside the path, as a part of the range, is in view for half as long as one on the path. At the
/// range itself it is hardly in view, however often the robot passes: sqrt(3) / 2.
const USEFUL_RANGE: f64 = 0.866_025_403_784_438_6;

/// The path of a search of a robot.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Lanes {
    /// Maximum distance between two lanes.
    pub(crate) apart_m: f64,
    /// Where the centre of the robot can be; without it, anywhere. Lanes end at its border, as one
    /// beyond it would never be finished.
    pub(crate) within: Option<Rectangle>,
}

impl Lanes {
    /// The path of searches in a mined lane: what is beyond it is not searched, and no strip is at the edge of the view
    /// in every pass.
    pub(crate) fn in_lane(self, lane: Rectangle) -> Self {
        let in_field = |corner: Point| {
            self.within.map_or(corner, |field| Point {
                x: corner.x.clamp(field.min().x, field.max().x),
                y: corner.y.clamp(field.min().y, field.max().y),
            })
        };
        let within = Rectangle::spanned(in_field(lane.min()), in_field(lane.max()));
        Self {
            within: Some(within),
            apart_m: USEFUL_RANGE * self.apart_m,
        }
    }

    /// The corner of a number; `None` after the last.
    pub(crate) fn corner(&self, task: &Task, number: u32) -> Option<Point> {
        let (at, radius_m) = (task.at(), f64::from(task.radius_m));
        let [low_m, high_m] = self.extent_m(at, radius_m);
        let lanes = libm::ceil((high_m - low_m) / self.apart_m.max(1e-3)).clamp(1.0, MAX_LANES);
        let lane = f64::from(number / 2);
        if lane >= lanes {
            return None;
        }
        let up_m = low_m + (high_m - low_m) * (2.0 * lane + 1.0) / (2.0 * lanes);
        let side_m = libm::sqrt((radius_m * radius_m - up_m * up_m).max(0.0));
        let is_right = matches!(number % 4, 1 | 2);
        let right_m = if is_right { side_m } else { -side_m };
        let (x, y) = (at.x + right_m, at.y + up_m);
        Some(self.within.map_or(Point { x, y }, |within| Point {
            x: x.clamp(within.min().x, within.max().x),
            y: y.clamp(within.min().y, within.max().y),
        }))
    }

    /// Length of the path, from its first corner.
    pub(crate) fn length_m(&self, task: &Task) -> f64 {
        let corners = (0..).map_while(|number| self.corner(task, number));
        let mut last: Option<Point> = None;
        let mut length_m = 0.0;
        for at in corners {
            length_m += last.map_or(0.0, |last| last.to(at).length());
            last = Some(at);
        }
        length_m
    }

    /// The lowest and highest place of the lanes, relative to the centre of the area.
    fn extent_m(&self, at: Point, radius_m: f64) -> [f64; 2] {
        let whole = [-radius_m, radius_m];
        self.within.map_or(whole, |within| {
            let [min_m, max_m] = [within.min().y, within.max().y];
            whole.map(|up_m| (at.y + up_m).clamp(min_m, max_m) - at.y)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::body::RobotId;
    use crate::io::dispatch::Work;
    use crate::io::goal_id::GoalId;

    const TASK: Task = Task {
        id: GoalId {
            issuer: RobotId::OPERATOR,
            number: 0,
        },
        at_m: [3.0, 4.0],
        radius_m: 10.0,
        value: 1.0,
        service_s: 0.0,
        due_s: f32::MAX,
        work: Work::Search,
        capability: 0,
    };

    fn corners(lanes: &Lanes) -> Vec<Point> {
        let corners = (0..).map_while(|number| lanes.corner(&TASK, number));
        corners.collect()
    }

    #[test]
    fn every_place_of_the_disc_is_within_half_a_lane_of_the_path() {
        let lanes = Lanes {
            apart_m: 3.0,
            within: None,
        };
        let corners = corners(&lanes);
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
        let length_m = lanes.length_m(&TASK);
        assert!(length_m > 314.0 / 3.0 && length_m < 150.0);
    }

    #[test]
    fn no_part_of_a_mined_lane_is_at_the_edge_of_the_view_in_every_pass() {
        let lanes = Lanes {
            apart_m: 10.0,
            within: None,
        };
        let corner = |x: f64, y: f64| Point { x, y };
        let lane = Rectangle::spanned(corner(-7.0, -6.0), corner(13.0, 14.0));
        let task = Task {
            radius_m: 14.2,
            ..TASK
        };
        let lanes = lanes.in_lane(lane);
        let corners = (0..).map_while(|number| lanes.corner(&task, number));
        let rows: Vec<f64> = corners.map(|at| at.y).collect();
        let nearest = |y: f64| {
            rows.iter()
                .fold(f64::MAX, |least, row| least.min((row - y).abs()))
        };
        let sides = (0..=200).map(|part| -6.0 + f64::from(part) / 10.0);
        assert!(sides.map(nearest).all(|away_m| away_m < USEFUL_RANGE * 5.0));
    }

    #[test]
    fn lanes_end_at_the_border_and_the_part_within_has_as_many_as_it_needs() {
        let corner = |x: f64, y: f64| Point { x, y };
        let half = Lanes {
            apart_m: 3.0,
            within: Some(Rectangle::spanned(corner(0.0, 4.0), corner(50.0, 50.0))),
        };
        let corners = corners(&half);
        assert_eq!(corners.len(), 8);
        assert!(corners.iter().all(|at| at.x >= 0.0 && at.y >= 4.0));
        assert!((corners[0].y - 5.25).abs() < 1e-9);
        let outside = Lanes {
            within: Some(Rectangle::spanned(corner(20.0, 20.0), corner(50.0, 50.0))),
            ..half
        };
        assert!(outside.length_m(&TASK) < 1e-9);
    }
}
