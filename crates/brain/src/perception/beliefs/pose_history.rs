//! The recent motion of the robot with the readings measured during it, and the pose at each moment
//! of it.
//!
//! A late reading corrects the pose at the time of its measurement; the motion and the readings
//! since are then applied to the corrected pose again. So the pose depends only on which readings
//! have arrived, and not on when: it is the pose of a robot with the same readings without delay.

use super::displacement::Displacement;
use super::pose::Pose;
use super::pose_filter::PoseFilter;
use crate::io::body::Body;
use alloc::collections::VecDeque;
use base::geometry::Point;
use base::hashed::Hashed;
use core::mem;

/// Maximum number of parts: five seconds at 10 Hz. Above it, the shortest parts are joined.
const MAX_PARTS: usize = 64;

/// Parts that a step can add: one for itself, and one for the time of each reading.
const MAX_NEW_PARTS: usize = 3;

/// Two times are the same if they differ by at most this.
const SAME_TIME_S: f64 = 1e-5;

/// A value measured by a sensor of the pose.
#[derive(Debug, Clone, Copy)]
pub(super) enum Measured {
    Position(Point),
    Heading(f64),
}

/// A part of the motion, with the readings measured at its end, and the pose after them.
#[derive(Debug, Clone, Default, Hashed)]
struct Part {
    moved: Displacement,
    position: Option<Point>,
    heading_rad: Option<f64>,
    after: PoseFilter,
}

/// The recent motion in parts, the oldest first.
#[derive(Debug, Clone, Default, Hashed)]
pub(super) struct PoseHistory {
    /// The pose before the oldest part.
    before: PoseFilter,
    parts: VecDeque<Part>,
    /// Number of parts whose poses are up to date, from the oldest one.
    valid: usize,
    /// Scratch memory, to avoid allocations.
    #[hashed(skip)]
    scratch: PoseFilter,
}

impl PoseHistory {
    /// The pose now.
    pub(super) fn pose(&self) -> Option<Pose> {
        self.filter().pose()
    }

    /// The filter of the pose now.
    pub(super) fn filter(&self) -> &PoseFilter {
        self.after(self.parts.len())
    }

    /// Adds a displacement; parts that ended more than `depth_s` ago are dropped.
    ///
    /// The pose is up to date after [`PoseHistory::update`].
    pub(super) fn add(&mut self, moved: &Displacement, depth_s: f64) {
        let stale = self.stale(moved.elapsed_s, depth_s);
        if let Some(last) = stale.checked_sub(1) {
            mem::swap(&mut self.before, &mut self.parts[last].after);
            self.parts.drain(..last);
            // Its memory is used again.
            self.parts.rotate_left(1);
        } else {
            self.parts.push_back(Part::default());
        }
        if let Some(part) = self.parts.back_mut() {
            (part.moved, part.position, part.heading_rad) = (*moved, None, None);
        }
        while self.parts.len() + MAX_NEW_PARTS > MAX_PARTS + 1 {
            self.join_shortest();
        }
        self.valid = self.parts.len() - 1;
    }

    /// The number of parts that will have ended more than `depth_s` ago after a further time.
    fn stale(&self, elapsed_s: f64, depth_s: f64) -> usize {
        let mut end_s: f64 = self.parts.iter().map(|part| part.moved.elapsed_s).sum();
        end_s += elapsed_s;
        let is_stale = |part: &&Part| {
            end_s -= part.moved.elapsed_s;
            end_s > depth_s + SAME_TIME_S
        };
        self.parts.iter().take_while(is_stale).count()
    }

    /// Records a reading at the time of its measurement, unless there is one of its sensor already.
    /// A reading from before the oldest part is ignored.
    pub(super) fn record(&mut self, measured: Measured, age_s: f64, body: &Body) {
        let Some((place, after_s)) = self.part_at(age_s) else {
            return;
        };
        if let Some(after_s) = after_s {
            self.split(place, after_s, body);
        }
        if let Some(part) = self.parts.get_mut(place) {
            match measured {
                Measured::Position(at) => _ = part.position.get_or_insert(at),
                Measured::Heading(heading_rad) => _ = part.heading_rad.get_or_insert(heading_rad),
            }
            self.valid = self.valid.min(place);
        }
    }

    /// Brings the poses up to date with the recorded displacements and readings.
    pub(super) fn update(&mut self, body: &Body) {
        let last = self
            .valid
            .checked_sub(1)
            .map(|last| &self.parts[last].after);
        self.scratch.clone_from(last.unwrap_or(&self.before));
        let filter = &mut self.scratch;
        for part in self.parts.range_mut(self.valid..) {
            filter.predict(&part.moved, body);
            if let Some(heading_rad) = part.heading_rad {
                filter.correct_heading(heading_rad, body.heading_noise_rad);
            }
            if let Some(at) = part.position {
                filter.correct_position(at, body.position_noise_m);
            }
            part.after.clone_from(filter);
        }
        self.valid = self.parts.len();
    }

    /// The pose some time ago by the readings measured until then; `None` if it is unknown, or from
    /// before the oldest part.
    pub(super) fn pose_before(&self, age_s: f64, body: &Body) -> Option<Pose> {
        let (place, after_s) = self.part_at(age_s)?;
        let Some(after_s) = after_s else {
            return self.after(place + 1).pose();
        };
        let [until, _] = self.parts.get(place)?.moved.split(after_s, body);
        let mut filter = self.after(place).clone();
        filter.predict(&until, body);
        filter.pose()
    }

    /// The pose after a number of parts.
    fn after(&self, parts: usize) -> &PoseFilter {
        let last = parts.checked_sub(1).and_then(|last| self.parts.get(last));
        last.map_or(&self.before, |part| &part.after)
    }

    /// Index of the part that was in progress some time ago, and the time since its beginning;
    /// `None` instead of a time at its end.
    fn part_at(&self, age_s: f64) -> Option<(usize, Option<f64>)> {
        let mut end_s = 0.0;
        for (place, part) in self.parts.iter().enumerate().rev() {
            if age_s <= end_s + SAME_TIME_S {
                return Some((place, None));
            }
            let after_s = end_s + part.moved.elapsed_s - age_s;
            if after_s > SAME_TIME_S {
                return Some((place, Some(after_s)));
            }
            end_s += part.moved.elapsed_s;
        }
        None
    }

    fn split(&mut self, place: usize, after_s: f64, body: &Body) {
        let Some(part) = self.parts.get_mut(place) else {
            return;
        };
        let [until, from] = part.moved.split(after_s, body);
        part.moved = from;
        self.parts.insert(
            place,
            Part {
                moved: until,
                ..Part::default()
            },
        );
    }

    /// Joins the two shortest neighbouring parts. The readings at the end of the first one remain in
    /// the poses, until a late reading from before them arrives.
    fn join_shortest(&mut self) {
        let pairs = self.parts.iter().zip(self.parts.iter().skip(1)).enumerate();
        let shortest = pairs.min_by(|(_, one), (_, other)| cost_s(*one).total_cmp(&cost_s(*other)));
        let Some((place, _)) = shortest else {
            return;
        };
        if let Some(first) = self.parts.remove(place)
            && let Some(second) = self.parts.get_mut(place)
        {
            second.moved = first.moved.then(&second.moved);
        }
    }
}

/// The total time of two parts; infinite if the first one has a reading of a sensor, and the second
/// one has none.
fn cost_s((first, second): (&Part, &Part)) -> f64 {
    let loses_position = first.position.is_some() && second.position.is_none();
    let loses_heading = first.heading_rad.is_some() && second.heading_rad.is_none();
    if loses_position || loses_heading {
        f64::INFINITY
    } else {
        first.moved.elapsed_s + second.moved.elapsed_s
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::perception::dead_reckoning::Odometry;
    use crate::world_of_walls::rover;

    const DEPTH_S: f64 = 5.0;

    /// A history of 10 s at 100 Hz and 1 m/s along x, with an exact compass in each step, and an exact
    /// position every 0.2 s that is late.
    fn fast(late_s: f64) -> PoseHistory {
        let mut history = PoseHistory::default();
        let ahead = Odometry {
            elapsed_s: 0.01,
            speed_m_s: 1.0,
            turned_rad: 0.0,
            is_commanded: false,
        };
        for step in 1..=1000 {
            history.add(&Displacement::along(0.01, &ahead), DEPTH_S);
            history.record(Measured::Heading(0.0), 0.0, &rover());
            if step % 20 == 0 {
                let at = Point {
                    x: 0.01 * f64::from(step) - late_s,
                    y: 0.0,
                };
                history.record(Measured::Position(at), late_s, &rover());
            }
            history.update(&rover());
            assert!(history.parts.len() <= MAX_PARTS);
        }
        history
    }

    #[test]
    fn a_fast_brain_joins_parts_and_keeps_the_whole_time() {
        for late_s in [0.0, 0.5, 4.7] {
            let history = fast(late_s);
            let total_s: f64 = history.parts.iter().map(|part| part.moved.elapsed_s).sum();
            assert!(total_s > 4.9, "{total_s}");
            let pose = history.pose().unwrap();
            assert!((pose.at.x - 10.0).abs() < 1e-9, "{pose:?}");
            assert!((pose.age_s - late_s).abs() < 0.011, "{pose:?}");
            let then = history.pose_before(3.21, &rover());
            let is_right = |then: Pose| (then.at.x - 6.79).abs() < 1e-9;
            assert!(then.is_none_or(is_right), "{then:?}");
        }
    }

    #[test]
    fn a_part_is_dropped_once_its_end_is_older_than_the_history() {
        let mut history = PoseHistory::default();
        for _ in 0..100 {
            history.add(
                &Displacement::along(
                    0.0,
                    &Odometry {
                        elapsed_s: 0.1,
                        speed_m_s: 0.0,
                        turned_rad: 0.0,
                        is_commanded: false,
                    },
                ),
                1.0,
            );
            history.update(&rover());
        }
        // Those that ended 0, 0.1, ..., 1 s ago.
        assert_eq!(history.parts.len(), 11);
    }
}
