//! Noise that grows while a robot gets nowhere.
//!
//! Gains that change with how the robot fares are after Clark, Arkin and Ram, *Learning momentum: on-line
//! performance enhancement for reactive systems*, 1992.

use super::Schemas;
use crate::perception::beliefs::pose::turned;
use crate::perception::sector::direction;
use crate::perception::situation::Situation;
use base::geometry::Point;
use base::trig::wrapped;
use core::f64::consts::PI;

/// It falls at this share of the rate at which it grows: who comes back to a dead end still has some.
const FALLS: f64 = 0.25;

/// One robot's noise. It needs no position: wheels and turns say how far it has come.
#[derive(Debug, Clone, Default)]
pub(crate) struct Noise {
    /// What it has grown by.
    more: f64,
    /// From the robot's front, and for how long it stays.
    towards_rad: f64,
    stays_s: f64,
    /// The middle of the circle that it has not left, from its front, and since when.
    from: Point,
    since_s: f64,
}

impl Noise {
    /// The vector of this step.
    pub(super) fn vector(
        &mut self,
        spec: &Schemas,
        wants_to_move: bool,
        situation: &Situation,
    ) -> Point {
        self.move_on(situation);
        let has_left = self.from.length() > spec.blocked_within_m;
        if has_left || !wants_to_move {
            (self.from, self.since_s) = (Point::default(), 0.0);
        }
        self.grow(spec, situation.body.period_s);
        if self.stays_s <= 0.0 {
            self.draw(situation);
            self.stays_s = spec.noise_s;
        }
        self.stays_s -= situation.body.period_s;
        direction(self.towards_rad).times(spec.noise + self.more)
    }

    /// Carries on what it knows from its front.
    fn move_on(&mut self, situation: &Situation) {
        let (turned_rad, way_m) = (
            situation.turned_rad,
            situation.now_m_s * situation.body.period_s,
        );
        self.towards_rad = wrapped(self.towards_rad - turned_rad);
        let gone = Point { x: way_m, y: 0.0 };
        self.from = turned(gone.to(self.from), direction(-turned_rad));
        self.since_s += situation.body.period_s;
    }

    fn grow(&mut self, spec: &Schemas, period_s: f64) {
        let most = (spec.max_noise - spec.noise).max(0.0);
        let change = most * period_s / spec.blocked_after_s;
        let is_blocked = self.since_s > spec.blocked_after_s;
        let change = if is_blocked { change } else { -FALLS * change };
        self.more = (self.more + change).max(0.0).min(most);
    }

    fn draw(&mut self, situation: &Situation) {
        let mut dice = situation.dice();
        // The first four numbers are for behaviours.
        (0..4).for_each(|_| {
            dice.unit();
        });
        self.towards_rad = dice.between(-PI, PI);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Percept;
    use crate::world_of_walls::rover;

    /// How long the noise of a robot is after each of so many seconds at a speed.
    fn lengths(noise: &mut Noise, speed_m_s: f64, seconds: u32) -> Vec<f64> {
        let (body, spec) = (rover(), Schemas::default());
        let situation = Situation {
            percept: &Percept::default(),
            body: &body,
            beliefs: None,
            rings: &[],
            ahead: None,
            turned_rad: 0.0,
            now_m_s: speed_m_s,
        };
        let steps = (0..10 * seconds).map(|_| noise.vector(&spec, true, &situation).length());
        let all: Vec<f64> = steps.collect();
        all.into_iter().skip(9).step_by(10).collect()
    }

    #[test]
    fn it_grows_while_the_robot_gets_nowhere_and_falls_slower_while_it_does() {
        let mut noise = Noise::default();
        let stuck = lengths(&mut noise, 0.0, 20);
        let near = |length: f64, expected: f64| (length - expected).abs() < 0.1;
        assert!(stuck[..5].iter().all(|length| near(*length, 0.1)));
        // By 2.9 within 5 s, and then no more.
        assert!(
            near(stuck[7], 0.1 + 2.9 * 3.0 / 5.0) && near(stuck[19], 3.0),
            "{stuck:?}"
        );
        let moving = lengths(&mut noise, 1.0, 30);
        assert!(near(moving[11], 3.0 - 2.9 * 10.0 / 20.0), "{moving:?}");
        assert!(near(moving[29], 0.1));
    }

    #[test]
    fn a_direction_is_kept_for_its_time_also_while_the_robot_turns() {
        let (body, spec) = (rover(), Schemas::default());
        let mut noise = Noise::default();
        let mut heading_rad = 0.0;
        let courses = (0..80_u32).map(|step| {
            let percept = Percept {
                dice: [step; 4],
                ..Percept::default()
            };
            heading_rad += 0.05;
            let situation = Situation {
                percept: &percept,
                body: &body,
                beliefs: None,
                rings: &[],
                ahead: None,
                turned_rad: 0.05,
                now_m_s: 0.0,
            };
            let vector = noise.vector(&spec, true, &situation);
            wrapped(heading_rad + libm::atan2(vector.y, vector.x))
        });
        let courses: Vec<f64> = courses.collect();
        let is_same = |pair: &[f64]| wrapped(pair[0] - pair[1]).abs() < 1e-9;
        let changes: Vec<usize> = (1..80)
            .filter(|step| !is_same(&courses[step - 1..=*step]))
            .collect();
        assert_eq!(changes, [40]);
    }

    #[test]
    fn noise_that_must_not_grow_stays() {
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
            rings: &[],
            ahead: None,
            turned_rad: 0.0,
            now_m_s: 0.0,
        };
        let mut noise = Noise::default();
        for _ in 0..200 {
            let more = noise.vector(&spec, true, &situation).length() - 0.5;
            assert!(more.abs() < 1e-9 && noise.more == 0.0);
        }
    }
}
