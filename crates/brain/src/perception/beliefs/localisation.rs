//! Localisation: the estimated pose of the robot, from odometry and from the readings of its
//! position sensor and compass, which may be late.

use super::displacement::Displacement;
use super::drive_estimate::DriveEstimate;
use super::pose::Pose;
use super::pose_history::{Measured, PoseHistory};
use super::readings::MAX_AGE_S;
use crate::io::body::Body;
use crate::io::percept::{Percept, Reading};
use crate::perception::dead_reckoning::Odometry;
use base::hashed::Hashed;

/// Readings farther from the origin than this are ignored.
const MAX_COORDINATE_M: f64 = 1e7;

/// Compass readings above this absolute value are ignored.
const MAX_HEADING_RAD: f64 = 1e4;

/// The pose of the robot, now and recently.
///
/// The history is as long as the maximum age of the readings so far, so that it takes next to no
/// memory without late sensors; while the pose is unknown, it has its maximum length. A reading that
/// is older than the history is ignored, but extends it.
#[derive(Debug, Clone, Default, Hashed)]
pub(crate) struct Localisation {
    history: PoseHistory,
    /// Speed in the last step; negative in reverse.
    speed_m_s: f64,
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

    /// The pose some time ago, for an age that has been needed before.
    pub(crate) fn pose_then(&self, age_s: f64, body: &Body) -> Option<Pose> {
        let is_kept = (0.0..=self.depth_s).contains(&age_s);
        is_kept.then(|| self.history.pose_before(age_s, body))?
    }

    /// How the drive executes commanded motion; `None` while the robot has measured all of its motion.
    pub(crate) fn drive(&self) -> Option<&DriveEstimate> {
        self.history.filter().drive()
    }

    /// Whether the body does not move although it is commanded to, as far as positions show.
    pub(crate) fn is_blocked(&self) -> bool {
        self.history.filter().is_blocked()
    }

    /// Estimated speed in the last step; negative in reverse.
    pub(crate) fn speed_m_s(&self) -> f64 {
        self.drive()
            .map_or(self.speed_m_s, DriveEstimate::speed_m_s)
    }

    /// The pose after a further motion, without readings.
    pub(crate) fn pose_after(&self, motion: &Odometry, body: &Body) -> Option<Pose> {
        let mut filter = self.history.filter().clone();
        filter.predict(&Displacement::new(self.speed_m_s, motion, body), body);
        filter.pose()
    }

    /// Updates the pose after a step with a motion. Returns the displacement of the body: where the
    /// motion was commanded, it is by what is known of the drive.
    pub(crate) fn step(
        &mut self,
        percept: &Percept,
        body: &Body,
        motion: &Odometry,
    ) -> Displacement {
        let moved = Displacement::new(self.speed_m_s, motion, body);
        self.speed_m_s = motion.speed_m_s;
        let executed = self.history.filter().executed(&moved);
        self.update(percept, body, &moved);
        executed
    }

    /// Updates the pose after a step with a displacement.
    fn update(&mut self, percept: &Percept, body: &Body, moved: &Displacement) {
        let is_known = self.pose().is_some();
        let depth_s = if is_known { self.depth_s } else { MAX_AGE_S };
        self.history.add(moved, depth_s);
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
    use crate::perception::sector::direction;
    use crate::world_of_walls::{now, rover};
    use base::geometry::Point;
    use base::trig::wrapped;

    const AT_REST: [f64; 2] = [0.0, 0.0];
    const AHEAD: [f64; 2] = [1.0, 0.0];

    /// The displacement in a step at constant speed and turn rate.
    fn moved([speed_m_s, rate_rad_s]: [f64; 2]) -> Displacement {
        let odometry = Odometry {
            elapsed_s: 0.1,
            speed_m_s,
            turned_rad: 0.1 * rate_rad_s,
            is_commanded: false,
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

    /// The true pose after a time on a circle, from the origin along x.
    fn on_circle([speed_m_s, rate_rad_s]: [f64; 2], time_s: f64) -> (Point, f64) {
        let turned_rad = rate_rad_s * time_s;
        let radius_m = speed_m_s / rate_rad_s;
        let front = direction(turned_rad);
        let at = Point {
            x: radius_m * front.y,
            y: radius_m * (1.0 - front.x),
        };
        (at, wrapped(turned_rad))
    }

    /// A percept of readings of these ages, taken on a circle.
    fn late(motion: [f64; 2], time_s: f64, [position_s, heading_s]: [f64; 2]) -> Percept {
        Percept {
            position: Some(Reading {
                value: on_circle(motion, time_s - position_s).0,
                age_s: position_s,
            }),
            heading_rad: Some(Reading {
                value: on_circle(motion, time_s - heading_s).1,
                age_s: heading_s,
            }),
            ..Percept::default()
        }
    }

    #[test]
    fn on_a_circle_late_exact_readings_give_the_exact_pose() {
        let motion = [0.7, 1.3];
        for ages_s in [[0.0, 0.0], [0.5, 0.0], [0.0, 1.0], [2.0, 0.73], [0.31, 4.9]] {
            let mut localisation = Localisation {
                depth_s: MAX_AGE_S,
                ..Localisation::default()
            };
            for step in 1..=100 {
                let time_s = 0.1 * f64::from(step);
                let percept = late(motion, time_s, ages_s);
                localisation.update(&percept, &rover(), &moved(motion));
            }
            let pose = localisation.pose().unwrap();
            let (at, heading_rad) = on_circle(motion, 10.0);
            assert!(pose.at.to(at).length() < 1e-9, "{ages_s:?} {pose:?}");
            assert!(wrapped(pose.heading_rad - heading_rad).abs() < 1e-9);
            let then = localisation.pose_before(0.23, &rover()).unwrap();
            let (at, _) = on_circle(motion, 9.77);
            assert!(then.at.to(at).length() < 1e-9, "{ages_s:?} {then:?}");
        }
    }

    /// The pose after 20 s on a circle with the same noisy readings, measured every 0.3 s and at the
    /// beginning, each with a delay of its own of up to a maximum.
    fn with_delays(max_delay_s: f64) -> Pose {
        let (mut body, motion) = (rover(), [0.7, 1.3]);
        (body.position_noise_m, body.heading_noise_rad) = (0.2, 0.05);
        let mut localisation = Localisation {
            depth_s: MAX_AGE_S,
            ..Localisation::default()
        };
        let mut waiting: Vec<(f64, f64, Measured)> = Vec::new();
        for number in 0..60_u32 {
            let measured_s = 0.3 * f64::from(number) + 0.1;
            let pseudo = |factor: u32| f64::from((number * factor + 3) % 101) / 101.0;
            let (at, heading_rad) = on_circle(motion, measured_s);
            let mut off_m = 0.5 * (pseudo(17) - 0.5);
            if number % 13 == 5 {
                // An outlier.
                off_m += 9.0;
            }
            let at = at.plus(Point {
                x: off_m,
                y: -off_m,
            });
            let due_s = |factor| measured_s + max_delay_s * pseudo(factor);
            waiting.push((due_s(29), measured_s, Measured::Position(at)));
            let heading_rad = heading_rad + 0.1 * (pseudo(41) - 0.5);
            waiting.push((due_s(53), measured_s, Measured::Heading(heading_rad)));
        }
        for step in 1..=220 {
            let time_s = 0.1 * f64::from(step);
            localisation.history.add(&moved(motion), MAX_AGE_S);
            waiting.retain(|(due_s, measured_s, measured)| {
                let is_due = *due_s <= time_s + 1e-9;
                if is_due {
                    localisation.record(*measured, time_s - measured_s, &body);
                }
                !is_due
            });
            localisation.history.update(&body);
        }
        assert!(waiting.is_empty());
        localisation.pose().unwrap()
    }

    #[test]
    fn the_pose_does_not_depend_on_when_readings_arrive() {
        let expected = with_delays(0.0);
        for max_delay_s in [0.05, 0.5, 2.0, 4.0] {
            let pose = with_delays(max_delay_s);
            assert!(pose.at.to(expected.at).length() < 1e-9, "{pose:?}");
            assert!((pose.heading_rad - expected.heading_rad).abs() < 1e-9);
            assert!((pose.deviation_m - expected.deviation_m).abs() < 1e-9);
            assert!((pose.deviation_rad - expected.deviation_rad).abs() < 1e-9);
            assert!((pose.age_s - expected.age_s).abs() < 1e-9, "{pose:?}");
        }
    }

    #[test]
    fn a_reading_is_validated_at_the_time_of_its_measurement() {
        let mut body = rover();
        (body.position_noise_m, body.heading_noise_rad) = (0.01, 0.01);
        let mut localisation = Localisation::default();
        let exact = percept(0.0, 0.0, 0.0);
        for _ in 0..20 {
            localisation.update(&exact, &body, &moved(AT_REST));
        }
        // The robot drives at 1 m/s. After 1 s, a reading from its start is right, and one of its
        // current position is an outlier.
        let at_age = |x: f64, age_s: f64| Percept {
            position: Some(Reading {
                value: Point { x, y: 0.0 },
                age_s,
            }),
            ..Percept::default()
        };
        // Extends the history.
        localisation.update(&at_age(0.0, 2.0), &body, &moved(AT_REST));
        for _ in 0..10 {
            localisation.update(&Percept::default(), &body, &moved(AHEAD));
        }
        let mut both = [localisation.clone(), localisation];
        both[0].update(&at_age(0.0, 1.1), &body, &moved(AHEAD));
        both[1].update(&at_age(1.1, 1.1), &body, &moved(AHEAD));
        let [right, outlier] = both.map(|localisation| localisation.pose().unwrap());
        assert!((right.age_s - 1.1).abs() < 1e-9, "{right:?}");
        assert!(outlier.age_s > 1.15, "{outlier:?}");
        assert!((outlier.at.x - 1.1).abs() < 0.01, "{outlier:?}");
    }

    #[test]
    fn an_old_reading_extends_the_history() {
        let mut localisation = Localisation::default();
        let before = |localisation: &mut Localisation| {
            for _ in 0..30 {
                localisation.update(&percept(0.0, 0.0, 0.0), &rover(), &moved(AT_REST));
            }
            localisation.pose_before(2.0, &rover())
        };
        assert_eq!(before(&mut localisation), None);
        assert!(before(&mut localisation).is_some());
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
