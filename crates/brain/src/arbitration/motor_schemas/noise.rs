//! Noise that grows while a robot is blocked.
//!
//! Gains that adapt to the robot's progress are after Clark, Arkin and Ram, *Learning momentum:
//! on-line performance enhancement for reactive systems*, 1992.

use super::spec::Schemas;
use crate::perception::beliefs::pose::turned;
use crate::perception::sector::direction;
use crate::situation::Situation;
use base::geometry::Point;
use base::trig::wrapped;
use core::f64::consts::PI;

/// The noise falls at this fraction of the rate at which it grows, so that some is left when the
/// robot returns to a dead end.
const FALL_RATE: f64 = 0.25;

/// The noise of one robot. It needs no position: the distance covered comes from odometry.
#[derive(Debug, Clone, Default)]
pub(crate) struct Noise {
    /// Amount by which it has grown.
    growth: f64,
    /// The random direction, relative to the robot's front, and the time until the next one.
    direction_rad: f64,
    next_in_s: f64,
    /// The centre of the circle that the robot has not left, relative to its front, and the time
    /// since when.
    centre: Point,
    within_s: f64,
}

impl Noise {
    /// The vector of this step.
    pub(super) fn vector(
        &mut self,
        spec: &Schemas,
        is_motion_proposed: bool,
        situation: &Situation,
    ) -> Point {
        self.advance(situation);
        let has_left = self.centre.length() > spec.blocked_within_m;
        if has_left || !is_motion_proposed {
            (self.centre, self.within_s) = (Point::default(), 0.0);
        }
        self.grow(spec, situation.elapsed_s);
        self.next_in_s -= situation.elapsed_s;
        if self.next_in_s <= 0.0 {
            self.draw(situation);
            self.next_in_s = spec.noise_s;
        }
        direction(self.direction_rad).times(spec.noise + self.growth)
    }

    /// Moves the direction and the centre to the robot's new front.
    fn advance(&mut self, situation: &Situation) {
        let (turned_rad, distance_m) = (
            situation.turned_rad,
            situation.current_speed_m_s * situation.elapsed_s,
        );
        self.direction_rad = wrapped(self.direction_rad - turned_rad);
        let moved = Point {
            x: distance_m,
            y: 0.0,
        };
        self.centre = turned(moved.to(self.centre), direction(-turned_rad));
        self.within_s += situation.elapsed_s;
    }

    fn grow(&mut self, spec: &Schemas, elapsed_s: f64) {
        let max_growth = (spec.max_noise - spec.noise).max(0.0);
        let change = max_growth * elapsed_s / spec.blocked_after_s;
        let is_blocked = self.within_s > spec.blocked_after_s;
        let change = if is_blocked {
            change
        } else {
            -FALL_RATE * change
        };
        self.growth = (self.growth + change).max(0.0).min(max_growth);
    }

    fn draw(&mut self, situation: &Situation) {
        let mut random = situation.random_words();
        // The first four numbers belong to the behaviours.
        (0..4).for_each(|_| {
            random.unit();
        });
        self.direction_rad = random.between(-PI, PI);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Percept;
    use crate::world_of_walls::rover;
    use core::cell::Cell;

    /// The length of a robot's noise after each second at a speed.
    fn lengths(noise: &mut Noise, speed_m_s: f64, seconds: u32) -> Vec<f64> {
        let (body, spec) = (rover(), Schemas::default());
        let situation = Situation {
            percept: &Percept::default(),
            body: &body,
            beliefs: None,
            localisation: None,
            peers: None,
            rings: &[],
            last_goal: &Cell::new(0),
            ahead: None,
            elapsed_s: 0.1,
            turned_rad: 0.0,
            current_speed_m_s: speed_m_s,
        };
        let steps = (0..10 * seconds).map(|_| noise.vector(&spec, true, &situation).length());
        let all: Vec<f64> = steps.collect();
        all.into_iter().skip(9).step_by(10).collect()
    }

    #[test]
    fn noise_grows_while_the_robot_is_blocked_and_falls_more_slowly_when_it_moves() {
        let mut noise = Noise::default();
        let stuck = lengths(&mut noise, 0.0, 20);
        let near = |length: f64, expected: f64| (length - expected).abs() < 0.1;
        assert!(stuck[..5].iter().all(|length| near(*length, 0.1)));
        // It grows by 2.9 within 5 s, and then stays.
        assert!(
            near(stuck[7], 0.1 + 2.9 * 3.0 / 5.0) && near(stuck[19], 3.0),
            "{stuck:?}"
        );
        let moving = lengths(&mut noise, 1.0, 30);
        assert!(near(moving[11], 3.0 - 2.9 * 10.0 / 20.0), "{moving:?}");
        assert!(near(moving[29], 0.1));
    }

    #[test]
    fn a_direction_is_kept_for_its_time_while_the_robot_turns() {
        let (body, spec) = (rover(), Schemas::default());
        let mut noise = Noise::default();
        let mut heading_rad = 0.0;
        let directions = (0..80_u32).map(|step| {
            let percept = Percept {
                random_words: [step; 4],
                ..Percept::default()
            };
            heading_rad += 0.05;
            let situation = Situation {
                percept: &percept,
                body: &body,
                beliefs: None,
                localisation: None,
                peers: None,
                rings: &[],
                last_goal: &Cell::new(0),
                ahead: None,
                elapsed_s: 0.1,
                turned_rad: 0.05,
                current_speed_m_s: 0.0,
            };
            let vector = noise.vector(&spec, true, &situation);
            wrapped(heading_rad + libm::atan2(vector.y, vector.x))
        });
        let directions: Vec<f64> = directions.collect();
        let is_same = |pair: &[f64]| wrapped(pair[0] - pair[1]).abs() < 1e-9;
        let changes: Vec<usize> = (1..80)
            .filter(|step| !is_same(&directions[step - 1..=*step]))
            .collect();
        assert_eq!(changes, [40]);
    }

    #[test]
    fn noise_without_room_to_grow_stays_constant() {
        let (body, spec) = (
            rover(),
            Schemas {
                noise: 0.5,
                max_noise: 0.0,
                ..Schemas::default()
            },
        );
        let percept = Percept::default();
        let situation = Situation {
            percept: &percept,
            body: &body,
            beliefs: None,
            localisation: None,
            peers: None,
            rings: &[],
            last_goal: &Cell::new(0),
            ahead: None,
            elapsed_s: 0.1,
            turned_rad: 0.0,
            current_speed_m_s: 0.0,
        };
        let mut noise = Noise::default();
        for _ in 0..200 {
            let growth = noise.vector(&spec, true, &situation).length() - 0.5;
            assert!(growth.abs() < 1e-9 && noise.growth == 0.0);
        }
    }
}
