//! Motor schemas: what all behaviours want, as one sum of vectors.
//!
//! After Arkin, *Motor schema-based mobile robot navigation*, International Journal of Robotics Research
//! 8(4), 1989. In units of the fastest that the body can, from its front:
//!
//! ```text
//! sum = mean of what behaviours want, by their gains       length 0 to 1
//!     + repulsion x what obstacles repel                   0 beyond the influence, 1 at contact
//!     + noise gain x a random direction                    kept for a time, then drawn anew
//!
//! behaviour wants    vector
//! to be somewhere    towards the place, as long as its speed
//! a motion           [speed / fastest, turn rate / fastest], at most 1 long
//! ```
//!
//! The robot turns to where the sum points, and goes as fast as the sum is long, but no faster than any
//! behaviour wants. Where the sum is nothing it would stay for ever, as in a dead end before its goal; so
//! the noise [grows](noise) while it gets nowhere. Since what behaviours want is a mean, what `repulsion`
//! and `noise` are beside it is the same for one behaviour or ten.

mod noise;
mod repulsion;
mod wanted;

use crate::arbitration::subsumption::{Layer, step};
use crate::behaviours::{Memory, Ready};
use crate::io::command::Motion;
use crate::perception::situation::Situation;
use alloc::collections::BTreeMap;
use alloc::string::String;
use alloc::vec::Vec;
pub(crate) use noise::Noise;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use wanted::{GoalState, along};

/// Parameters of motor schemas.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(inline)]
pub struct Schemas {
    /// Weight of a behaviour, by its kind. Without it, its `value`, or 1 if it has none.
    pub gains: BTreeMap<String, f64>,
    /// Obstacles nearer to the robot's footprint than this repel it, in metres; the nearer, the
    /// more.
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub influence_m: f64,
    /// Weight of an obstacle at contact, relative to 1 for all behaviours together.
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub repulsion: f64,
    /// Weight of a random direction, relative to 1 for all behaviours together.
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub noise: f64,
    /// While the robot is blocked, `noise` grows to this, and then falls again. Without effect if
    /// not above `noise`.
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub max_noise: f64,
    /// A random direction is kept for this long, in seconds.
    #[schemars(range(min = 0.0, max = 3600.0))]
    pub noise_s: f64,
    /// The robot is blocked when it wants to move and has not left a circle of this radius, in
    /// metres, for `blocked_after_s`.
    #[schemars(range(min = 0.01, max = 1000.0))]
    pub blocked_within_m: f64,
    /// Time after which the robot is blocked, in seconds. The noise takes as long to grow, and four
    /// times as long to fall.
    #[schemars(range(min = 0.1, max = 3600.0))]
    pub blocked_after_s: f64,
}

impl Default for Schemas {
    fn default() -> Self {
        Self {
            gains: BTreeMap::new(),
            influence_m: 1.0,
            repulsion: 2.0,
            noise: 0.1,
            max_noise: 3.0,
            noise_s: 4.0,
            blocked_within_m: 2.0,
            blocked_after_s: 5.0,
        }
    }
}

/// [`Schemas`] of a kind of robots.
#[derive(Debug, Clone)]
pub(crate) struct Sum {
    spec: Schemas,
    /// By the behaviours' places.
    gains: Vec<Option<f64>>,
}

impl Sum {
    /// Of behaviours with these names.
    pub(crate) fn new<'n>(spec: &Schemas, names: impl Iterator<Item = &'n str>) -> Self {
        Self {
            spec: spec.clone(),
            gains: names.map(|name| spec.gains.get(name).copied()).collect(),
        }
    }

    /// The motion along the sum; to stand, if no behaviour wants to move.
    pub(crate) fn motion(
        &self,
        behaviours: &[Ready],
        layers: &mut [Layer<Memory>],
        noise: &mut Noise,
        situation: &Situation,
    ) -> Motion {
        let mut wanted = GoalState::default();
        for ((behaviour, layer), gain) in behaviours.iter().zip(layers).zip(&self.gains) {
            if let Some(proposal) = step(behaviour, layer, situation) {
                wanted.add(&proposal, *gain, situation);
            }
        }
        let noise = noise.vector(&self.spec, wanted.most > 0.0, situation);
        if wanted.most <= 0.0 {
            return Motion::default();
        }
        let repelled = repulsion::vector(self.spec.influence_m, situation);
        let sum = wanted
            .mean()
            .plus(repelled.times(self.spec.repulsion))
            .plus(noise);
        along(sum, wanted.most, situation.body)
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

    /// One that turns at once to where it wants, so that its rate of turn says where that is.
    fn nimble() -> Body {
        Body {
            max_turn_rate_rad_s: 100.0,
            ..rover()
        }
    }

    fn still() -> Schemas {
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

    fn to(x: f64, y: f64, value: f64) -> BehaviourSpec {
        BehaviourSpec::Navigate(Navigate {
            waypoints_m: vec![Point { x, y }],
            value,
            ..Navigate::default()
        })
    }

    /// At the origin, along x, with these ranges of 16 rays all around.
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

    /// Where it turns to, and how fast it goes.
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
    fn two_attractions_make_the_mean_of_their_directions_by_their_gains() {
        // 3/4 along x and 1/4 along y.
        let turn_rad = 1.0_f64.atan2(3.0);
        let speed_m_s = 10.0_f64.sqrt() / 4.0 * (1.0 - turn_rad / FRAC_PI_3);
        let both = vec![to(9.0, 0.0, 3.0), to(0.0, 9.0, 1.0)];
        assert_near(motion(still(), both, &percept(&[])), [turn_rad, speed_m_s]);
        // The same by a gain: what it wants at a place is worth 0.1 without.
        let stay = BehaviourSpec::HoldPosition(HoldPosition {
            at_m: Some(Point { x: 0.0, y: 9.0 }),
            ..HoldPosition::default()
        });
        let schemas = Schemas {
            gains: [("navigate".into(), 6.0), ("hold_position".into(), 2.0)].into(),
            ..still()
        };
        let both = vec![stay, to(9.0, 0.0, 1.0)];
        assert_near(motion(schemas, both, &percept(&[])), [turn_rad, speed_m_s]);
    }

    #[test]
    fn a_motion_is_a_vector_too_and_needs_no_mind() {
        assert_near(
            motion(still(), vec![cruise(0.6)], &Percept::default()),
            [0.0, 0.6],
        );
        let both = vec![cruise(1.0), to(0.0, 9.0, 1.0)];
        let turn_rad = core::f64::consts::FRAC_PI_4;
        let speed_m_s = 0.5_f64.sqrt() * (1.0 - turn_rad / FRAC_PI_3);
        assert_near(motion(still(), both, &percept(&[])), [turn_rad, speed_m_s]);
    }

    #[test]
    fn it_goes_no_faster_than_any_behaviour_wants_whatever_repels_it() {
        let many = vec![cruise(0.4), cruise(0.4), cruise(0.4)];
        // At contact behind.
        let percept = percept(&[(8, 0.25)]);
        assert_near(motion(still(), many, &percept), [0.0, 0.4]);
    }

    #[test]
    fn an_obstacle_repels_linearly_from_its_influence_to_contact() {
        let schemas = Schemas {
            repulsion: 1.0,
            ..still()
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
        // Between two walls alike nothing is left.
        let both = percept(&[(4, 0.75), (12, 0.75)]);
        assert_near(motion(schemas, vec![cruise(1.0)], &both), [0.0, 1.0]);
    }

    #[test]
    fn who_wants_nothing_stands() {
        let schemas = Schemas {
            noise: 5.0,
            ..Schemas::default()
        };
        let there = vec![to(0.1, 0.0, 1.0)];
        let near = percept(&[(0, 0.3)]);
        assert_near(motion(schemas.clone(), there, &near), [0.0, 0.0]);
        let muted = Schemas {
            gains: [("cruise".into(), 0.0)].into(),
            ..schemas
        };
        assert_near(motion(muted, vec![cruise(1.0)], &near), [0.0, 0.0]);
    }

    #[test]
    fn a_room_is_roamed_and_its_walls_are_not_touched() {
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
            walk.go(&mut brain, 1);
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
        assert!(walk.least_gap_m > 0.0, "{}", walk.least_gap_m);
    }
}
