//! Where the robot believes itself to be.

use super::doubt::{Doubted, Off, Verdict};
use crate::io::body::Body;
use crate::io::percept::{Percept, Reading};
use crate::perception::sector::direction;
use base::geometry::Point;
use base::trig::wrapped;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Wheels err by this share of the way, and of the turn.
const DRIFT: f64 = 0.02;

/// Also one that stands may be pushed, by some millimetre and some hundredth of a degree in a second: the
/// variances grow by at least so much a second, in m^2 and rad^2. So a robot that has stood for long still
/// follows its sensors.
const PUSHED_M2_S: f64 = 1e-6;
const PUSHED_RAD2_S: f64 = 1e-8;

/// Readings older than this are not of now.
const OLDEST_S: f64 = 5.0;

/// What is farther away than this is nonsense, in metres.
const FARTHEST_M: f64 = 1e7;

/// A position and a course, each with its standard deviation.
///
/// Both are carried on by what the wheels say, and corrected by each new reading in proportion to
/// the variances (Kalman, *A new approach to linear filtering and prediction problems*, 1960, in one
/// dimension): gain = own variance / (own variance + the sensor's). A reading that is five deviations off
/// is left out, unless three in a row agree: then the robot begins anew with the last.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Pose {
    /// In the world.
    pub at: Point,
    /// 0 along x, anticlockwise, from -pi to pi.
    pub heading_rad: f64,
    /// Of its position, along each axis.
    pub deviation_m: f64,
    /// Of its course.
    pub deviation_rad: f64,
    /// Time since the last position came in.
    pub age_s: f64,
}

/// What is known of the pose so far.
#[derive(Debug, Clone, Default)]
pub(crate) struct Localisation {
    at: Option<(Point, f64)>,
    heading: Option<(f64, f64)>,
    /// Covariance of position and course: who goes on in a wrong course is off to the side.
    aside: Point,
    other_at: Doubted<Point>,
    other_heading: Doubted<f64>,
    /// Ages of the last readings.
    position_s: Option<f64>,
    heading_s: Option<f64>,
    age_s: f64,
}

impl Localisation {
    /// The pose, once a position and a course have come in.
    pub(crate) fn pose(&self) -> Option<Pose> {
        let ((at, at_variance), (heading_rad, variance)) = (self.at?, self.heading?);
        Some(Pose {
            at,
            heading_rad,
            deviation_m: libm::sqrt(at_variance),
            deviation_rad: libm::sqrt(variance),
            age_s: self.age_s,
        })
    }

    /// Takes in a step in which the body went `way_m` and turned.
    pub(crate) fn take_in(&mut self, percept: &Percept, body: &Body, way_m: f64, turned_rad: f64) {
        self.carry_on(way_m, turned_rad, body.period_s);
        self.age_s += body.period_s;
        if let Some(heading) = fresh(percept.heading_rad, &mut self.heading_s, body.period_s) {
            self.take_heading(
                &heading,
                body,
                turned_rad / body.period_s.max(f64::MIN_POSITIVE),
            );
        }
        if let Some(position) = fresh(percept.position, &mut self.position_s, body.period_s) {
            self.take_position(
                &position,
                body,
                way_m / body.period_s.max(f64::MIN_POSITIVE),
            );
        }
    }

    /// Takes a course that was read while the body turned at `rate_rad_s`.
    fn take_heading(&mut self, heading: &Reading<f64>, body: &Body, rate_rad_s: f64) {
        let since_rad = rate_rad_s * heading.age_s;
        // It may have turned the other way.
        let room_rad = since_rad.abs() + body.max_turn_rate_rad_s * heading.age_s;
        self.correct_heading(heading.value + since_rad, body.heading_noise_rad, room_rad);
    }

    /// Takes a position that was read while the body went at `speed_m_s`.
    fn take_position(&mut self, position: &Reading<Point>, body: &Body, speed_m_s: f64) {
        let since_m = speed_m_s * position.age_s;
        let heading_rad = self.heading.map_or(0.0, |(heading_rad, _)| heading_rad);
        let read = position.value.plus(direction(heading_rad).times(since_m));
        // It may have gone the other way.
        let room_m = since_m.abs() + body.max_speed_m_s * position.age_s;
        if self.correct_position(read, body.position_noise_m, room_m) {
            self.age_s = position.age_s;
        }
    }

    fn carry_on(&mut self, way_m: f64, turned_rad: f64, period_s: f64) {
        if let (Some((at, variance)), Some((heading_rad, of_heading))) =
            (&mut self.at, self.heading)
        {
            // Along the chord of its arc.
            let way = direction(heading_rad + turned_rad / 2.0).times(way_m);
            *at = at.plus(way);
            *variance += (DRIFT * way_m) * (DRIFT * way_m) + PUSHED_M2_S * period_s;
            // P' = F P F^T with d(at)/d(course) = the way turned to the left, the mean of both axes.
            *variance += way.cross(self.aside) + way_m * way_m * of_heading / 2.0;
            *variance = variance.max(0.0);
            let left = Point {
                x: -way.y,
                y: way.x,
            };
            self.aside = self.aside.plus(left.times(of_heading));
            self.other_at.carry_on(|at| at.plus(way));
        }
        if let Some((heading_rad, variance)) = &mut self.heading {
            *heading_rad = wrapped(*heading_rad + turned_rad);
            *variance += (DRIFT * turned_rad) * (DRIFT * turned_rad) + PUSHED_RAD2_S * period_s;
            self.other_heading.carry_on(|heading| heading + turned_rad);
        }
    }

    fn correct_heading(&mut self, read_rad: f64, noise_rad: f64, room_rad: f64) {
        if !read_rad.is_finite() || read_rad.abs() > 1e4 {
            return;
        }
        let sensor = noise_rad * noise_rad;
        let (before_rad, own) = self.heading.unwrap_or((read_rad, f64::INFINITY));
        let off_rad = wrapped(read_rad - before_rad);
        let off = Off {
            by: off_rad.abs(),
            variances: [own, sensor],
            room: room_rad,
        };
        let apart_rad = |last: &f64| wrapped(read_rad - last).abs();
        let verdict = self.other_heading.judge(read_rad, &off, apart_rad);
        if let Some(own) = variance_then(verdict, own) {
            let gain = gain(own, sensor);
            let heading_rad = wrapped(before_rad + gain * off_rad);
            self.heading = Some((heading_rad, own_after(own, sensor)));
            self.aside = self.aside.times(1.0 - gain);
        }
    }

    /// Whether it was taken.
    fn correct_position(&mut self, read: Point, noise_m: f64, room_m: f64) -> bool {
        // Whatever is not a number is not near.
        let is_sensible = read.x.abs() <= FARTHEST_M && read.y.abs() <= FARTHEST_M;
        if !is_sensible {
            return false;
        }
        let sensor = noise_m * noise_m;
        // Without a course nothing has carried it on.
        let carried = self.at.filter(|_| self.heading.is_some());
        let (before, own) = carried.unwrap_or((read, f64::INFINITY));
        let off = Off {
            by: before.to(read).length(),
            variances: [own, sensor],
            room: room_m,
        };
        let apart_m = |last: &Point| last.to(read).length();
        let verdict = self.other_at.judge(read, &off, apart_m);
        if let Some(own) = variance_then(verdict, own) {
            let gain = gain(own, sensor);
            let at = before.plus(before.to(read).times(gain));
            self.at = Some((at, own_after(own, sensor)));
            self.aside = self.aside.times(1.0 - gain);
        }
        verdict != Verdict::Far
    }
}

/// How sure one then is of what is believed before the reading; `None` if that is left out.
fn variance_then(verdict: Verdict, own: f64) -> Option<f64> {
    match verdict {
        Verdict::Near => Some(own),
        Verdict::Instead => Some(f64::INFINITY),
        Verdict::Far => None,
    }
}

/// A reading that was not taken in before: one that was told of before is older by a period.
pub(crate) fn fresh<T: Copy>(
    reading: Option<Reading<T>>,
    last_age_s: &mut Option<f64>,
    period_s: f64,
) -> Option<Reading<T>> {
    let reading = reading.filter(|reading| (0.0..=OLDEST_S).contains(&reading.age_s));
    let before_s = core::mem::replace(last_age_s, reading.map(|reading| reading.age_s));
    let is_new = |age_s: f64| before_s.is_none_or(|before_s| age_s < before_s + 0.999 * period_s);
    reading.filter(|reading| is_new(reading.age_s))
}

/// How far to go from what is believed to what is read, 0 to 1.
fn gain(own: f64, sensor: f64) -> f64 {
    if own.is_infinite() || sensor == 0.0 {
        1.0
    } else {
        own / (own + sensor)
    }
}

/// The variance after a reading.
fn own_after(own: f64, sensor: f64) -> f64 {
    if own.is_infinite() {
        sensor
    } else {
        own * (1.0 - gain(own, sensor))
    }
}

impl Pose {
    /// So far behind what seems to stand before it a place may still be in view: where it stands, and so
    /// where it has put things on its map, errs by more than two deviations only once in twenty times.
    pub(crate) fn blur_m(&self) -> f64 {
        2.0 * self.deviation_m
    }

    /// Where in the world what lies at `way` from the robot's front is.
    #[inline]
    pub(crate) fn world_of(&self, way: Point) -> Point {
        self.at.plus(turned(way, direction(self.heading_rad)))
    }

    /// The way from the robot to a place in the world, from its front.
    #[inline]
    pub(crate) fn own(&self, place: Point) -> Point {
        let front = direction(self.heading_rad);
        let back = Point {
            x: front.x,
            y: -front.y,
        };
        turned(self.at.to(place), back)
    }
}

/// `way` turned as x is turned to `front`, which is of length 1.
#[inline]
pub(crate) fn turned(way: Point, front: Point) -> Point {
    Point {
        x: way.x * front.x - way.y * front.y,
        y: way.x * front.y + way.y * front.x,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world_of_walls::{now, rover};

    fn percept(x: f64, y: f64, heading_rad: f64) -> Percept {
        Percept {
            position: Some(now(Point { x, y })),
            heading_rad: Some(now(heading_rad)),
            ..Percept::default()
        }
    }

    #[test]
    fn without_a_position_or_without_a_course_nobody_knows_where_he_is() {
        let mut here = Localisation::default();
        let only_place = Percept {
            heading_rad: None,
            ..percept(1.0, 2.0, 0.0)
        };
        here.take_in(&only_place, &rover(), 0.0, 0.0);
        assert_eq!(here.pose(), None);
        here.take_in(&percept(1.0, 2.0, 0.0), &rover(), 0.0, 0.0);
        assert_eq!(here.pose().unwrap().at, Point { x: 1.0, y: 2.0 });
    }

    #[test]
    fn it_goes_on_by_its_wheels_and_is_less_and_less_sure() {
        let mut here = Localisation::default();
        here.take_in(&percept(0.0, 0.0, 0.0), &rover(), 0.0, 0.0);
        let mut before_m = 0.0;
        for _ in 0..50 {
            here.take_in(&Percept::default(), &rover(), 0.1, 0.0);
            let pose = here.pose().unwrap();
            assert!(pose.deviation_m > before_m);
            before_m = pose.deviation_m;
        }
        let pose = here.pose().unwrap();
        assert!((pose.at.x - 5.0).abs() < 1e-9 && (pose.age_s - 5.0).abs() < 1e-9);
    }

    #[test]
    fn of_many_bad_readings_it_makes_a_good_one() {
        let mut body = rover();
        body.position_noise_m = 2.0;
        let mut here = Localisation::default();
        for step in 0..400 {
            let off = if step % 2 == 0 { 2.0 } else { -2.0 };
            here.take_in(&percept(off, -off, 0.0), &body, 0.0, 0.0);
        }
        let pose = here.pose().unwrap();
        assert!(pose.at.length() < 0.05, "{pose:?}");
        assert!((pose.deviation_m - 0.1).abs() < 0.01, "{pose:?}");
    }

    #[test]
    fn a_reading_that_is_told_of_again_and_again_counts_once() {
        let mut body = rover();
        body.position_noise_m = 2.0;
        let mut here = Localisation::default();
        let mut told = percept(0.0, 0.0, 0.0);
        for step in 0..10 {
            told.position = Some(Reading {
                value: Point::default(),
                age_s: 0.2 + 0.1 * f64::from(step),
            });
            here.take_in(&told, &body, 0.0, 0.0);
        }
        assert!((here.pose().unwrap().deviation_m - 2.0).abs() < 1e-4);
    }

    #[test]
    fn a_late_reading_is_carried_on_by_what_it_went_since() {
        let mut here = Localisation::default();
        here.take_in(&percept(0.0, 0.0, 0.0), &rover(), 0.0, 0.0);
        let late = Percept {
            position: Some(Reading {
                value: Point { x: 4.0, y: 0.0 },
                age_s: 0.05,
            }),
            ..percept(0.0, 0.0, 0.0)
        };
        here.take_in(&late, &rover(), 0.1, 0.0);
        assert!((here.pose().unwrap().at.x - 4.05).abs() < 1e-9);
    }

    #[test]
    fn nonsense_moves_nobody() {
        let mut here = Localisation::default();
        here.take_in(&percept(1.0, 1.0, 1.0), &rover(), 0.0, 0.0);
        let before = here.pose();
        for bad in [f64::NAN, f64::INFINITY, -1e300] {
            here.take_in(&percept(bad, 0.0, bad), &rover(), 0.0, 0.0);
            assert_eq!(here.pose().unwrap().at, before.unwrap().at);
        }
    }
}
