//! Motor schemas: the proposals of all behaviours as one sum of vectors.
//!
//! After Arkin, *Motor schema-based mobile robot navigation*, International Journal of Robotics
//! Research 8(4), 1989. In units of the maximum speed of the body, relative to its front:
//!
//! ```text
//! sum = mean of the proposals, weighted by gains     length 0 to 1
//!     + repulsion gain x repulsion of obstacles      0 beyond the influence, 1 at contact
//!     + noise gain x random direction                kept for a time, then drawn again
//!
//! proposal       vector
//! destination    towards it, as long as its speed
//! motion         [speed / max speed, turn rate / max turn rate], at most 1 long
//! ```
//!
//! The robot turns to the direction of the sum, and its speed is the length of the sum, but at most
//! the highest speed that a behaviour proposes. Where the sum vanishes, as in a dead end before a
//! destination, the robot would stop for ever; so the noise [grows](noise) while the robot is
//! blocked. Since the proposals are averaged, the relative weight of `repulsion` and `noise` does
//! not depend on the number of behaviours.

mod noise;
mod proposal_mean;
mod repulsion;
mod spec;

use crate::arbitration::subsumption::{Layer, idle, step};
use crate::behaviours::{Memory, Ready};
use crate::io::command::Motion;
use crate::situation::Situation;
use alloc::vec::Vec;
pub(crate) use noise::Noise;
pub use spec::Schemas;

use proposal_mean::{ProposalMean, along};

/// [`Schemas`] of a kind of robot.
#[derive(Debug, Clone)]
pub(crate) struct Sum {
    spec: Schemas,
    /// In the order of the behaviours.
    gains: Vec<Option<f64>>,
}

impl Sum {
    /// For behaviours with these names.
    pub(crate) fn new<'n>(spec: &Schemas, names: impl Iterator<Item = &'n str>) -> Self {
        Self {
            spec: spec.clone(),
            gains: names.map(|name| spec.gains.get(name).copied()).collect(),
        }
    }

    /// The motion along the sum; the robot is stationary if no behaviour proposes to move.
    pub(crate) fn motion(
        &self,
        behaviours: &[Ready],
        layers: &mut [Layer<Memory>],
        noise: &mut Noise,
        situation: &Situation,
    ) -> Motion {
        let mut proposals = ProposalMean::default();
        let mut is_idle = true;
        for ((behaviour, layer), gain) in behaviours.iter().zip(layers).zip(&self.gains) {
            if let Some(proposal) = step(behaviour, layer, situation) {
                proposals.add(&proposal, *gain, situation);
                is_idle = false;
            }
        }
        if let Some((place, proposal)) = idle(behaviours).filter(|_| is_idle) {
            let gain = self.gains.get(place).copied().flatten();
            proposals.add(&proposal, gain, situation);
        }
        let noise = noise.vector(&self.spec, proposals.max_speed > 0.0, situation);
        if proposals.max_speed <= 0.0 {
            return Motion::default();
        }
        let repulsion = repulsion::vector(self.spec.influence_m, situation);
        let sum = proposals
            .mean()
            .plus(repulsion.times(self.spec.repulsion))
            .plus(noise);
        along(sum, proposals.max_speed, situation.body)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arbitration::Arbitration;
    use crate::behaviours::{Avoid, BehaviourSpec, Cruise, HoldPosition, Navigate};
    use crate::io::body::Body;
    use crate::world_of_walls::{Walk, now, room, rover};
    use crate::{Brain, BrainSpec, Percept, Scan};
    use base::geometry::Point;
    use core::f64::consts::FRAC_PI_3;
    use std::sync::Arc;

    /// It turns to any heading within one step, so that its turn rate is that heading.
    fn nimble() -> Body {
        Body {
            max_turn_rate_rad_s: 100.0,
            ..rover()
        }
    }

    fn without_noise() -> Schemas {
        Schemas {
            noise: 0.0,
            max_noise: 0.0,
            ..Schemas::default()
        }
    }

    fn brain(schemas: Schemas, behaviours: Vec<BehaviourSpec>, body: Body) -> Brain {
        let spec = BrainSpec {
            arbitration: Arbitration::Schemas(schemas),
            limit_speed_to_stopping_distance: false,
            behaviours,
            ..BrainSpec::default()
        };
        Brain::new(Arc::new(spec), Arc::new(body))
    }

    fn cruise(speed_m_s: f64) -> BehaviourSpec {
        BehaviourSpec::Cruise(Cruise {
            speed_m_s: Some(speed_m_s),
        })
    }

    fn navigate_to(x: f64, y: f64, value: f64) -> BehaviourSpec {
        BehaviourSpec::Navigate(Navigate {
            waypoints_m: vec![Point { x, y }],
            value,
            ..Navigate::default()
        })
    }

    /// At the origin, facing along x, with these ranges of 16 rays; all others are free.
    fn percept(near: &[(usize, f64)]) -> Percept {
        let mut ranges_m = vec![f64::INFINITY; 16];
        for (ray, range_m) in near {
            ranges_m[*ray] = *range_m;
        }
        Percept {
            position: Some(now(Point::default())),
            heading_rad: Some(now(0.0)),
            scans: vec![Scan {
                age_s: Some(0.0),
                ranges_m,
            }],
            ..Percept::default()
        }
    }

    /// The angle by which it turns, and its speed.
    fn motion(schemas: Schemas, behaviours: Vec<BehaviourSpec>, percept: &Percept) -> [f64; 2] {
        let motion = brain(schemas, behaviours, nimble()).step(percept).motion;
        [motion.turn_rate_rad_s * 0.1, motion.speed_m_s]
    }

    fn assert_near(motion: [f64; 2], expected: [f64; 2]) {
        let off = [motion[0] - expected[0], motion[1] - expected[1]];
        assert!(
            off.iter().all(|off| off.abs() < 1e-9),
            "{motion:?} {expected:?}"
        );
    }

    #[test]
    fn two_destinations_are_averaged_by_their_gains() {
        // 3/4 along x and 1/4 along y.
        let turn_rad = 1.0_f64.atan2(3.0);
        let speed_m_s = 10.0_f64.sqrt() / 4.0 * (1.0 - turn_rad / FRAC_PI_3);
        let both = vec![navigate_to(9.0, 0.0, 3.0), navigate_to(0.0, 9.0, 1.0)];
        assert_near(
            motion(without_noise(), both, &percept(&[])),
            [turn_rad, speed_m_s],
        );
        // The same with gains, which replace the values.
        let hold = BehaviourSpec::HoldPosition(HoldPosition {
            at_m: Some(Point { x: 0.0, y: 9.0 }),
            ..HoldPosition::default()
        });
        let schemas = Schemas {
            gains: [("navigate".into(), 6.0), ("hold_position".into(), 2.0)].into(),
            ..without_noise()
        };
        let both = vec![hold, navigate_to(9.0, 0.0, 1.0)];
        assert_near(motion(schemas, both, &percept(&[])), [turn_rad, speed_m_s]);
    }

    #[test]
    fn motions_and_destinations_are_averaged_and_motions_need_no_beliefs() {
        assert_near(
            motion(without_noise(), vec![cruise(0.6)], &Percept::default()),
            [0.0, 0.6],
        );
        let both = vec![cruise(1.0), navigate_to(0.0, 9.0, 1.0)];
        let turn_rad = core::f64::consts::FRAC_PI_4;
        let speed_m_s = 0.5_f64.sqrt() * (1.0 - turn_rad / FRAC_PI_3);
        assert_near(
            motion(without_noise(), both, &percept(&[])),
            [turn_rad, speed_m_s],
        );
    }

    #[test]
    fn repulsion_does_not_raise_the_speed_above_that_of_the_behaviours() {
        let many = vec![cruise(0.4), cruise(0.4), cruise(0.4)];
        // An obstacle behind, at contact.
        let percept = percept(&[(8, 0.25)]);
        assert_near(motion(without_noise(), many, &percept), [0.0, 0.4]);
    }

    #[test]
    fn an_obstacle_repels_linearly_from_its_influence_to_contact() {
        let schemas = Schemas {
            repulsion: 1.0,
            ..without_noise()
        };
        for (gap_m, speed_m_s) in [
            (1.5, 1.0),
            (1.0, 1.0),
            (0.75, 0.75),
            (0.25, 0.25),
            (0.0, 0.0),
        ] {
            let percept = percept(&[(0, 0.25 + gap_m)]);
            let motion = motion(schemas.clone(), vec![cruise(1.0)], &percept);
            assert_near(motion, [0.0, speed_m_s]);
        }
        let left = percept(&[(4, 0.75)]);
        let [turn_rad, _] = motion(schemas.clone(), vec![cruise(1.0)], &left);
        assert!((turn_rad + 0.5_f64.atan()).abs() < 1e-9, "{turn_rad}");
        // Equal walls on both sides cancel out.
        let both = percept(&[(4, 0.75), (12, 0.75)]);
        assert_near(motion(schemas, vec![cruise(1.0)], &both), [0.0, 1.0]);
    }

    #[test]
    fn without_a_proposal_to_move_the_robot_stands_still() {
        let schemas = Schemas {
            noise: 5.0,
            ..Schemas::default()
        };
        let there = vec![navigate_to(0.1, 0.0, 1.0)];
        let near = percept(&[(0, 0.3)]);
        assert_near(motion(schemas.clone(), there, &near), [0.0, 0.0]);
        let muted = Schemas {
            gains: [("cruise".into(), 0.0)].into(),
            ..schemas
        };
        assert_near(motion(muted, vec![cruise(1.0)], &near), [0.0, 0.0]);
    }

    #[test]
    fn a_robot_roams_a_room_without_touching_its_walls() {
        let body = rover();
        let mut walk = Walk::new(body.clone(), room(8.0, 8.0), [2.0, 3.0], 0.4);
        let spec = BrainSpec {
            arbitration: Arbitration::Schemas(Schemas::default()),
            behaviours: vec![cruise(1.0), BehaviourSpec::Avoid(Avoid::default())],
            ..BrainSpec::default()
        };
        let mut brain = Brain::new(Arc::new(spec), Arc::new(body));
        let mut bounds = [walk.at, walk.at];
        for _ in 0..3000 {
            walk.run(&mut brain, 1);
            let [low, high] = &mut bounds;
            *low = Point {
                x: low.x.min(walk.at.x),
                y: low.y.min(walk.at.y),
            };
            *high = Point {
                x: high.x.max(walk.at.x),
                y: high.y.max(walk.at.y),
            };
        }
        let size = bounds[0].to(bounds[1]);
        assert!(size.x > 4.0 && size.y > 4.0, "{size:?}");
        assert!(walk.min_gap_m > 0.0, "{}", walk.min_gap_m);
    }
}
