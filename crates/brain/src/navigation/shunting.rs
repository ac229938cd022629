//! Giving way: what to do when nobody gets on.
//!
//! Robots that meet head-on in an aisle keep to the right; where that is not enough, the one on the
//! left-hand side goes back and lets the other pass, and who still gets nowhere goes some random way
//! for a while, each time for longer, until the knot is loose (Yuta and Premvuti, *Coordinating
//! autonomous and centralized decision making to achieve cooperative behaviors between multiple mobile
//! robots*, IROS 1992, call the going back "shunting"; the growing times are those of Metcalfe and
//! Boggs, *Ethernet*, 1976).

use crate::io::random_words::RandomWords;
use crate::perception::beliefs::mover::Mover;
use crate::perception::rays::Ray;
use crate::perception::sector::direction;
use base::geometry::Point;
use base::trig::wrapped;
use core::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

/// Whose way to the aim becomes shorter by less than this share of its greatest speed gets nowhere.
///
/// The way, not the distance: that around a wall leads away from the aim.
const NOWHERE: f64 = 0.2;

/// It gives way after so long, half as soon on the left-hand side and three times as late on the
/// right-hand one, and for so long; in seconds.
const PATIENCE_S: f64 = 2.0;
const AWAY_S: f64 = 2.0;

/// Each time for longer by this factor, but no longer than by that.
const LONGER: f64 = 1.5;
const LONGEST: f64 = 6.0;

/// Others farther than this are in nobody's way, in metres.
const NEAR_M: f64 = 2.0;

/// To one who comes towards it, it keeps right by this.
const KEEP_RIGHT_RAD: f64 = 0.2;

/// One comes towards it if he does not pass it farther aside than this, in metres.
const ASIDE_M: f64 = 1.5;

/// An aim that moves by less is the same, in metres.
const SAME_AIM_M: f64 = 1.0;

/// Sides that differ by less than this are equally wide, in metres.
const SAME_M: f64 = 0.1;

/// What one robot remembers of getting nowhere.
#[derive(Debug, Clone)]
pub(crate) struct Shunting {
    /// Where it wanted to be, and how far that was.
    aim: Point,
    left_m: f64,
    nowhere_s: f64,
    /// Its random share of patience, 0.5 to 1.5.
    share: f64,
    /// For so long it gives way, along a course from its front.
    left_s: f64,
    course_rad: f64,
    factor: f64,
}

impl Default for Shunting {
    fn default() -> Self {
        Self {
            aim: Point::default(),
            left_m: f64::INFINITY,
            nowhere_s: 0.0,
            share: 1.0,
            left_s: 0.0,
            course_rad: 0.0,
            factor: 1.0,
        }
    }
}

/// What is to be known of a step.
pub(crate) struct Step<'s> {
    /// In the world: where it wants to be; and from its front: the next place on the way there.
    pub(crate) aim: Point,
    pub(crate) way: Point,
    /// The way left to the aim.
    pub(crate) left_m: f64,
    pub(crate) turned_rad: f64,
    pub(crate) period_s: f64,
    pub(crate) max_speed_m_s: f64,
    pub(crate) hits: &'s [Ray],
    pub(crate) movers: &'s [Mover],
}

impl Shunting {
    /// The way to take instead of the one that it wants, from its front.
    pub(crate) fn instead(&mut self, step: &Step, mut dice: RandomWords) -> Point {
        self.course_rad = wrapped(self.course_rad - step.turned_rad);
        let progress_m = self.left_m - step.left_m;
        let is_other = self.aim.to(step.aim).length() > SAME_AIM_M;
        self.aim = step.aim;
        if is_other {
            self.nowhere_s = 0.0;
        } else if self.left_s > 0.0 {
            self.left_s -= step.period_s;
        } else {
            self.count(progress_m, step);
        }
        self.left_m = step.left_m;
        if self.left_s <= 0.0 && self.is_at_an_end(step) {
            self.give_way(step, &mut dice);
        }
        if self.left_s > 0.0 {
            return direction(self.course_rad).times(NEAR_M);
        }
        keeping_right(step)
    }

    /// Whether it gives way now.
    pub(crate) fn gives_way(&self) -> bool {
        self.left_s > 0.0
    }

    fn count(&mut self, progress_m: f64, step: &Step) {
        let least_m = NOWHERE * step.max_speed_m_s * step.period_s;
        if is_turning_there(step) {
            return;
        }
        if progress_m < least_m {
            self.nowhere_s += step.period_s;
        } else {
            self.nowhere_s = (self.nowhere_s - 2.0 * step.period_s).max(0.0);
            self.factor = (self.factor - 0.1 * step.period_s).max(1.0);
        }
    }

    fn is_at_an_end(&self, step: &Step) -> bool {
        let factor = match side(step) {
            Side::Left => 0.5,
            Side::Right => 3.0,
            Side::Neither => 1.0,
        };
        self.nowhere_s > factor * PATIENCE_S * self.share
    }

    fn give_way(&mut self, step: &Step, dice: &mut RandomWords) {
        let aim_rad = libm::atan2(step.way.y, step.way.x);
        self.course_rad = wrapped(match side(step) {
            Side::Left => aim_rad + PI + KEEP_RIGHT_RAD,
            _ => away_rad(step, aim_rad) + dice.between(-FRAC_PI_2, FRAC_PI_2) - 0.3,
        });
        self.left_s = AWAY_S * self.factor * dice.between(0.5, 1.5);
        self.factor = (self.factor * LONGER).min(LONGEST);
        self.nowhere_s = 0.0;
        self.share = dice.between(0.5, 1.5);
    }
}

/// Whether it still turns to its way: that takes its time, and nobody is in the way of it.
fn is_turning_there(step: &Step) -> bool {
    let aside_rad = libm::atan2(step.way.y, step.way.x);
    aside_rad.abs() > FRAC_PI_4 && step.turned_rad * aside_rad > 0.0
}

/// On which side of an aisle a robot is.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Side {
    Left,
    Right,
    Neither,
}

fn side(step: &Step) -> Side {
    let aim_rad = libm::atan2(step.way.y, step.way.x);
    let [left_m, right_m] = [FRAC_PI_2, -FRAC_PI_2].map(|side_rad| {
        let within = |hit: &&Ray| wrapped(hit.bearing_rad - aim_rad - side_rad).abs() < FRAC_PI_4;
        let ranges_m = step.hits.iter().filter(within).map(|hit| hit.range_m);
        ranges_m.fold(NEAR_M, f64::min)
    });
    if right_m > left_m + SAME_M {
        Side::Left
    } else if left_m > right_m + SAME_M {
        Side::Right
    } else {
        Side::Neither
    }
}

/// The course away from those who are near; back, if nobody is.
fn away_rad(step: &Step, aim_rad: f64) -> f64 {
    let near = step.movers.iter().map(|mover| mover.at);
    let near = near.filter(|at| (1e-6..NEAR_M).contains(&at.length()));
    let away = near.fold(Point::default(), |away, at| {
        let apart_m = at.length();
        away.plus(at.times(-1.0 / (apart_m * apart_m * apart_m)))
    });
    if away.length_squared() > 1e-12 {
        libm::atan2(away.y, away.x)
    } else {
        aim_rad + PI
    }
}

/// The way, or a little to the right of it if somebody comes along it.
fn keeping_right(step: &Step) -> Point {
    let length_m = step.way.length();
    if length_m <= 0.0 {
        return step.way;
    }
    let front = step.way.times(1.0 / length_m);
    let comes = |mover: &Mover| {
        let is_ahead = mover.at.dot(front) > 0.0 && mover.at.cross(front).abs() < ASIDE_M;
        is_ahead && mover.course.dot(front) < -0.5
    };
    if step.movers.iter().any(comes) {
        let right = direction(-KEEP_RIGHT_RAD);
        crate::perception::beliefs::pose::turned(step.way, right)
    } else {
        step.way
    }
}

#[cfg(test)]
mod tests;
