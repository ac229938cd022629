//! The path of a search: lanes through a disc, back and forth.

use crate::io::work::Task;
use base::geometry::{Point, Rectangle};

/// Maximum number of lanes.
const MAX_LANES: f64 = 1000.0;

/// An item this far beside the path, as a part of the range, is in view for half as long as one on the path. At the
/// range itself it is hardly in view, however often the robot passes: sqrt(3) / 2.
const USEFUL_RANGE: f64 = 0.866_025_403_784_438_6;

/// The lanes at the border are at least as far from it as this part of the distance that they have if all are the same distance
/// apart.
const MIN_BORDER: f64 = 0.5;

/// An item between two lanes is at most this far from both, as a part of the range.
const MAX_BETWEEN: f64 = 0.93;

/// The path of a search of a robot.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Lanes {
    /// Maximum distance between two lanes.
    pub(crate) apart_m: f64,
    /// Where the centre of the robot can be; without it, anywhere. Lanes end at its border, as one
    /// beyond it would never be finished.
    pub(crate) within: Option<Rectangle>,
    /// Whether items at the border are to be in view for as long as those between two lanes; otherwise, all lanes are the
    /// same distance apart.
    pub(crate) is_balanced: bool,
}

/// The places of lanes across an area.
struct Across {
    count: f64,
    /// Distance of the first and the last one from the border.
    border_m: f64,
    apart_m: f64,
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
            is_balanced: true,
        }
    }

    /// The corner of a number; `None` after the last.
    pub(crate) fn corner(&self, task: &Task, number: u32) -> Option<Point> {
        let (at, radius_m) = (task.at(), f64::from(task.radius_m));
        let [low_m, high_m] = self.extent_m(at, radius_m);
        let across = self.across(high_m - low_m);
        let lane = f64::from(number / 2);
        if lane >= across.count {
            return None;
        }
        let up_m = low_m + across.border_m + lane * across.apart_m;
        let side_m = libm::sqrt((radius_m * radius_m - up_m * up_m).max(0.0));
        let is_right = matches!(number % 4, 1 | 2);
        let right_m = if is_right { side_m } else { -side_m };
        let (x, y) = (at.x + right_m, at.y + up_m);
        Some(self.within.map_or(Point { x, y }, |within| Point {
            x: x.clamp(within.min().x, within.max().x),
            y: y.clamp(within.min().y, within.max().y),
        }))
    }

    /// The lanes across an area of a height, as few as possible.
    ///
    /// The border is in view from one lane only, the middle between two lanes from both. An item at a distance d from a
    /// lane is in view along `2 sqrt(r^2 - d^2)`, so that both are in view for the same time if
    ///
    /// ```text
    /// a^2 - e^2 = 3 r^2     a: distance of two lanes, e: distance of the border, 2 e + (n - 1) a = height
    /// ```
    fn across(&self, height_m: f64) -> Across {
        let count = libm::ceil(height_m / self.apart_m.max(1e-3)).clamp(1.0, MAX_LANES);
        let even_m = height_m / (2.0 * count);
        let gaps = count - 1.0;
        if gaps < 1.0 || !self.is_balanced {
            return Across {
                count,
                border_m: even_m,
                apart_m: 2.0 * even_m,
            };
        }
        let range_m = self.apart_m / (2.0 * USEFUL_RANGE);
        // With a as a function of e, the lower root; there is none if lanes are so dense that all are in view from several.
        let square = 4.0 - gaps * gaps;
        let constant = height_m * height_m - 3.0 * gaps * gaps * range_m * range_m;
        let discriminant = 16.0 * height_m * height_m - 4.0 * square * constant;
        let root_m = 2.0 * constant / (4.0 * height_m + libm::sqrt(discriminant.max(0.0)));
        let max_apart_m = 2.0 * MAX_BETWEEN * range_m;
        let min_border_m = (MIN_BORDER * even_m).max((height_m - gaps * max_apart_m) / 2.0);
        let border_m = root_m.max(min_border_m).min(even_m);
        Across {
            count,
            border_m,
            apart_m: (height_m - 2.0 * border_m) / gaps,
        }
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
    use crate::io::agent_id::AgentId;
    use crate::io::goal_id::{GoalId, Issuer};
    use crate::io::work::Work;

    const TASK: Task = Task {
        id: GoalId {
            issuer: Issuer::Agent(AgentId::OPERATOR),
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
            is_balanced: false,
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
            is_balanced: false,
        };
        let corner = |x: f64, y: f64| Point { x, y };
        let lane = Rectangle::spanned(corner(-7.0, -6.0), corner(13.0, 14.0));
        let task = Task {
            radius_m: 14.2,
            ..TASK
        };
        let lanes = lanes.in_lane(lane);
        for height_m in 1..=60 {
            let across = lanes.across(f64::from(height_m));
            assert!(across.border_m <= USEFUL_RANGE * 5.0 + 1e-9);
            assert!(across.count < 2.0 || across.apart_m <= 2.0 * MAX_BETWEEN * 5.0 + 1e-9);
        }
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
    fn the_border_of_a_mined_lane_is_in_view_for_as_long_as_the_middle_between_two_lanes() {
        let along_m = |away_m: f64| libm::sqrt(4.0 * 4.0 - away_m * away_m);
        for height_m in [9.0, 13.0, 17.0, 20.0, 26.0] {
            let lanes = Lanes {
                apart_m: USEFUL_RANGE * 8.0,
                within: None,
                is_balanced: true,
            };
            let across = lanes.across(height_m);
            let all_m = 2.0 * across.border_m + (across.count - 1.0) * across.apart_m;
            assert!((all_m - height_m).abs() < 1e-9);
            let even = Lanes {
                is_balanced: false,
                ..lanes
            };
            let least =
                |across: &Across| along_m(across.border_m).min(2.0 * along_m(across.apart_m / 2.0));
            assert!(
                least(&across) >= least(&even.across(height_m)),
                "{height_m}"
            );
            let difference_m = along_m(across.border_m) - 2.0 * along_m(across.apart_m / 2.0);
            assert!(
                difference_m.abs() < 1e-6
                    || across.border_m < 2.0
                    || across.apart_m > 2.0 * MAX_BETWEEN * 4.0 - 1e-9,
                "{height_m}: {difference_m}"
            );
        }
    }

    #[test]
    fn lanes_end_at_the_border_and_the_part_within_has_as_many_as_it_needs() {
        let corner = |x: f64, y: f64| Point { x, y };
        let half = Lanes {
            apart_m: 3.0,
            within: Some(Rectangle::spanned(corner(0.0, 4.0), corner(50.0, 50.0))),
            is_balanced: false,
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
