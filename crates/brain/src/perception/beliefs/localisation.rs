//! Localisation: the estimated pose of the robot, from odometry and from the readings of its
//! position sensor and compass, which may be late.

use super::displacement::Displacement;
use super::pose::Pose;
use super::pose_history::{Measured, PoseHistory};
use super::readings::MAX_AGE_S;
use crate::io::body::Body;
use crate::io::percept::{Percept, Reading};

/// Readings farther from the origin than this are ignored.
const MAX_COORDINATE_M: f64 = 1e7;

/// Compass readings above this absolute value are ignored.
const MAX_HEADING_RAD: f64 = 1e4;

/// The pose of the robot, now and recently.
///
/// The history is as long as the oldest reading so far was old, so that it takes next to no memory
/// without late sensors. A reading that is older than the history is ignored, but extends it.
#[derive(Debug, Clone, Default)]
pub(crate) struct Localisation {
    history: PoseHistory,
    depth_s: f64,
    /// Ages of the most recently measured readings.
    position_s: Option<f64>,
    heading_s: Option<f64>,
}

impl Localisation {
    /// The pose, once a position and a heading are known.
    pub(crate) fn pose(&self) -> Option<Pose> {
        self.history.pose()
    }

    /// The pose at the time of a measurement of this age; `None` if it is unknown.
    pub(crate) fn pose_before(&mut self, age_s: f64, body: &Body) -> Option<Pose> {
        if !(0.0..=MAX_AGE_S).contains(&age_s) {
            return None;
        }
        self.depth_s = self.depth_s.max(age_s);
        self.history.pose_before(age_s, body)
    }

    /// Updates the pose after a step with a displacement.
    pub(crate) fn update(&mut self, percept: &Percept, body: &Body, moved: &Displacement) {
        self.history.add(moved, self.depth_s);
        let elapsed_s = moved.elapsed_s;
        if let Some(heading) = unused(percept.heading_rad, &mut self.heading_s, elapsed_s)
            && heading.value.abs() <= MAX_HEADING_RAD
        {
            self.record(Measured::Heading(heading.value), heading.age_s, body);
        }
        if let Some(Reading { value: at, age_s }) =
            unused(percept.position, &mut self.position_s, elapsed_s)
            && at.x.abs() <= MAX_COORDINATE_M
            && at.y.abs() <= MAX_COORDINATE_M
        {
            self.record(Measured::Position(at), age_s, body);
        }
        self.history.update(body);
    }

    fn record(&mut self, measured: Measured, age_s: f64, body: &Body) {
        self.depth_s = self.depth_s.max(age_s);
        self.history.record(measured, age_s, body);
    }
}

/// A reading other than the most recently measured one, whose age before the elapsed time is given.
///
/// It may have been measured before that one.
fn unused<T: Copy>(
    reading: Option<Reading<T>>,
    newest_s: &mut Option<f64>,
    elapsed_s: f64,
) -> Option<Reading<T>> {
    if let Some(newest_s) = newest_s {
        *newest_s += elapsed_s;
    }
    let reading = reading.filter(|reading| (0.0..=MAX_AGE_S).contains(&reading.age_s))?;
    let before_s = newest_s.unwrap_or(f64::INFINITY);
    *newest_s = Some(reading.age_s.min(before_s));
    let is_repeated = (reading.age_s - before_s).abs() <= 0.001 * elapsed_s;
    (!is_repeated).then_some(reading)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::perception::dead_reckoning::Odometry;
    use crate::world_of_walls::{now, rover};
    use base::geometry::Point;

    const AT_REST: [f64; 2] = [0.0, 0.0];
    const AHEAD: [f64; 2] = [1.0, 0.0];

    /// The displacement in a step at constant speed and turn rate.
    fn moved([speed_m_s, rate_rad_s]: [f64; 2]) -> Displacement {
        let odometry = Odometry {
            elapsed_s: 0.1,
            speed_m_s,
            turned_rad: 0.1 * rate_rad_s,
        };
        Displacement::along(0.1 * speed_m_s, &odometry)
    }

    fn percept(x: f64, y: f64, heading_rad: f64) -> Percept {
        Percept {
            position: Some(now(Point { x, y })),
            heading_rad: Some(now(heading_rad)),
            ..Percept::default()
        }
    }

    #[test]
    fn the_pose_is_unknown_without_a_position_or_without_a_heading() {
        let mut localisation = Localisation::default();
        let only_position = Percept {
            heading_rad: None,
            ..percept(1.0, 2.0, 0.0)
        };
        localisation.update(&only_position, &rover(), &moved(AT_REST));
        assert_eq!(localisation.pose(), None);
        localisation.update(&percept(1.0, 2.0, 0.0), &rover(), &moved(AT_REST));
        assert_eq!(localisation.pose().unwrap().at, Point { x: 1.0, y: 2.0 });
    }

    #[test]
    fn odometry_predicts_the_pose_with_growing_deviation() {
        let mut localisation = Localisation::default();
        localisation.update(&percept(0.0, 0.0, 0.0), &rover(), &moved(AT_REST));
        let mut before_m = 0.0;
        for _ in 0..50 {
            localisation.update(&Percept::default(), &rover(), &moved(AHEAD));
            let pose = localisation.pose().unwrap();
            assert!(pose.deviation_m > before_m);
            before_m = pose.deviation_m;
        }
        let pose = localisation.pose().unwrap();
        assert!((pose.at.x - 5.0).abs() < 1e-9 && (pose.age_s - 5.0).abs() < 1e-9);
    }

    #[test]
    fn many_noisy_readings_give_a_precise_position() {
        let mut body = rover();
        body.position_noise_m = 2.0;
        let mut localisation = Localisation::default();
        for step in 0..400 {
            let off = if step % 2 == 0 { 2.0 } else { -2.0 };
            localisation.update(&percept(off, -off, 0.0), &body, &moved(AT_REST));
        }
        let pose = localisation.pose().unwrap();
        assert!(pose.at.length() < 0.05, "{pose:?}");
        assert!((pose.deviation_m - 0.1).abs() < 0.01, "{pose:?}");
    }

    #[test]
    fn a_repeated_reading_counts_once() {
        let mut body = rover();
        body.position_noise_m = 2.0;
        let mut localisation = Localisation::default();
        let mut repeated = percept(0.0, 0.0, 0.0);
        for step in 0..10 {
            repeated.position = Some(Reading {
                value: Point::default(),
                age_s: 0.1 * f64::from(step),
            });
            localisation.update(&repeated, &body, &moved(AT_REST));
        }
        assert!((localisation.pose().unwrap().deviation_m - 2.0).abs() < 1e-4);
    }

    #[test]
    fn a_delayed_reading_is_compensated_by_the_distance_since() {
        let mut localisation = Localisation::default();
        localisation.update(&percept(0.0, 0.0, 0.0), &rover(), &moved(AT_REST));
        let late = Percept {
            position: Some(Reading {
                value: Point { x: 4.0, y: 0.0 },
                age_s: 0.05,
            }),
            ..percept(0.0, 0.0, 0.0)
        };
        localisation.update(&late, &rover(), &moved(AHEAD));
        assert!((localisation.pose().unwrap().at.x - 4.05).abs() < 1e-9);
    }

    #[test]
    fn invalid_readings_are_ignored() {
        let mut localisation = Localisation::default();
        localisation.update(&percept(1.0, 1.0, 1.0), &rover(), &moved(AT_REST));
        let before = localisation.pose();
        for bad in [f64::NAN, f64::INFINITY, -1e300] {
            localisation.update(&percept(bad, 0.0, bad), &rover(), &moved(AT_REST));
            assert_eq!(localisation.pose().unwrap().at, before.unwrap().at);
        }
    }
}
