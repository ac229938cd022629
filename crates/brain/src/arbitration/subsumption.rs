//! Which behaviour has its way: the highest that has something to do.
//!
//! After Brooks, *A robust layered control system for a mobile robot*, IEEE Journal of Robotics and
//! Automation 2(1), 1986. A behaviour that has had its way keeps it for its hold time. Without that
//! a robot locks in front of a large object: it turns away, a lower behaviour at once turns it back
//! to its course, and so on for ever.

use crate::behaviours::behaviour::Behaviour;
use crate::goals::proposal::Proposal;
use crate::perception::situation::Situation;
use alloc::boxed::Box;
use alloc::vec::Vec;

/// One robot's part in a behaviour.
#[derive(Debug, Clone)]
pub(crate) struct Layer<M> {
    memory: M,
    /// Time for which it keeps control.
    left_s: f32,
}

impl<M> Layer<M> {
    pub(crate) fn memory(&mut self) -> &mut M {
        &mut self.memory
    }

    /// It keeps control for so long though it has nothing to do.
    pub(crate) fn holds_s(&self) -> f64 {
        self.left_s.into()
    }
}

/// A layer for each behaviour.
pub(crate) fn layers<B: Behaviour>(behaviours: &[B]) -> Box<[Layer<B::Memory>]> {
    let memories = behaviours.iter().map(Behaviour::memory);
    memories
        .map(|memory| Layer {
            memory,
            left_s: 0.0,
        })
        .collect()
}

/// What the highest behaviour with something to do, or with hold time left, asks for, and its
/// place. The lowest comes first.
#[inline]
pub(crate) fn arbitrate<B: Behaviour>(
    behaviours: &[B],
    layers: &mut [Layer<B::Memory>],
    situation: &Situation,
) -> Option<(usize, Proposal)> {
    let mut wanted = None;
    for (place, (behaviour, layer)) in behaviours.iter().zip(layers).enumerate().rev() {
        if wanted.is_none() {
            wanted = step(behaviour, layer, situation).map(|proposal| (place, proposal));
        } else {
            behaviour.suppressed(&mut layer.memory);
            pass(layer, situation);
        }
    }
    wanted
}

/// What all behaviours ask for, the highest first, down to the first that wants a motion: where it
/// wants to be, nobody below it can know.
pub(crate) fn proposals<B: Behaviour>(
    behaviours: &[B],
    layers: &mut [Layer<B::Memory>],
    situation: &Situation,
    proposals: &mut Vec<(usize, Proposal)>,
) {
    proposals.clear();
    let mut has_motion = false;
    for (place, (behaviour, layer)) in behaviours.iter().zip(layers).enumerate().rev() {
        if has_motion {
            behaviour.suppressed(&mut layer.memory);
            pass(layer, situation);
        } else if let Some(proposal) = step(behaviour, layer, situation) {
            has_motion = matches!(proposal, Proposal::Motion(_));
            proposals.push((place, proposal));
        }
    }
}

#[inline]
#[expect(clippy::cast_possible_truncation, reason = "kept short")]
pub(crate) fn step<B: Behaviour>(
    behaviour: &B,
    layer: &mut Layer<B::Memory>,
    situation: &Situation,
) -> Option<Proposal> {
    let wanted = behaviour.triggered(&mut layer.memory, situation);
    if wanted.is_some() {
        layer.left_s = behaviour.hold_s() as f32;
        return wanted;
    }
    // Half a step, so that rounding adds none.
    let is_held = layer.left_s > situation.period_s() / 2.0;
    pass(layer, situation);
    is_held.then(|| behaviour.held().into())
}

#[inline]
fn pass<M>(layer: &mut Layer<M>, situation: &Situation) {
    layer.left_s = (layer.left_s - situation.period_s()).max(0.0);
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "exact by construction")]
mod tests {
    use super::*;
    use crate::behaviours::{Avoid, BehaviourSpec, Ready};
    use crate::io::command::Motion;
    use crate::navigation::speed_governor::SpeedGovernor;
    use crate::perception::dead_reckoning::DeadReckoning;
    use crate::world_of_walls::{Walk, Wiring, outline, rover};
    use base::geometry::Segment;
    use base::trig::wrapped;

    /// Keeps to the course 0: Bender's "correct", in the lowest place.
    #[derive(Clone)]
    enum Test {
        Correct,
        Shipped(Ready),
    }

    impl Behaviour for Test {
        type Memory = Option<<Ready as Behaviour>::Memory>;

        fn memory(&self) -> Self::Memory {
            match self {
                Self::Correct => None,
                Self::Shipped(ready) => Some(ready.memory()),
            }
        }

        fn hold_s(&self) -> f64 {
            match self {
                Self::Correct => 0.0,
                Self::Shipped(ready) => ready.hold_s(),
            }
        }

        fn triggered(&self, memory: &mut Self::Memory, situation: &Situation) -> Option<Proposal> {
            match (self, memory) {
                (Self::Shipped(ready), Some(memory)) => ready.triggered(memory, situation),
                _ => Some(to_course_0(situation).into()),
            }
        }

        fn held(&self) -> Motion {
            match self {
                Self::Correct => Motion::default(),
                Self::Shipped(ready) => ready.held(),
            }
        }
    }

    fn motion(proposal: Option<(usize, Proposal)>) -> Motion {
        match proposal {
            Some((_, Proposal::Motion(motion))) => motion,
            _ => Motion::default(),
        }
    }

    fn to_course_0(situation: &Situation) -> Motion {
        let off_rad = situation.percept.heading_rad.unwrap().value;
        let is_off = off_rad.abs() > 0.1;
        Motion {
            speed_m_s: if is_off { 0.0 } else { 1.0 },
            turn_rate_rad_s: if is_off { -1.5 * off_rad.signum() } else { 0.0 },
        }
    }

    /// A wall 3 m wide across the way.
    fn wide_wall() -> Vec<Segment> {
        outline(&[[4.0, -1.5], [4.0, 1.5], [4.5, 1.5], [4.5, -1.5]])
    }

    /// Where a robot with course 0 has come to after a minute, if avoidance holds for a time.
    fn walk(hold_s: f64) -> Walk {
        let body = rover();
        let avoid = Avoid {
            near_m: 0.3,
            hold_s,
            ..Avoid::default()
        };
        let avoid = Test::Shipped(BehaviourSpec::Avoid(avoid).ready(&body));
        let behaviours = [Test::Correct, avoid];
        let (mut layers, mut odometry) = (layers(&behaviours), DeadReckoning::default());
        let governor = SpeedGovernor::new(&body);
        let mut walk = Walk::new(body.clone(), wide_wall(), [0.0, 0.0], 0.0);
        walk.wiring = Wiring {
            compass: true,
            ..Wiring::default()
        };
        for _ in 0..600 {
            let percept = walk.percept();
            let turned_rad = odometry.update(&percept, &body);
            let now_m_s = odometry.now_m_s(&percept, &body);
            let situation = Situation {
                percept: &percept,
                body: &body,
                beliefs: None,
                rings: &governor.rings,
                ahead: governor.ahead(&percept, &body, now_m_s),
                turned_rad,
                now_m_s,
            };
            let wanted = motion(arbitrate(&behaviours, &mut layers, &situation));
            let motion = governor.limit(wanted, &situation, &odometry);
            odometry.record_command(motion, &body);
            walk.step(motion);
        }
        walk
    }

    #[test]
    fn without_a_hold_it_locks_in_front_of_a_large_object() {
        let walk = walk(0.0);
        assert!(walk.at.x < 4.0 && walk.at.y.abs() < 1.0, "{:?}", walk.at);
    }

    #[test]
    fn with_a_hold_it_gets_around() {
        let walk = walk(2.5);
        assert!(walk.at.x > 6.0, "{:?}", walk.at);
        assert!(wrapped(walk.heading_rad).abs() < 0.2);
        assert!(walk.min_gap_m > 0.0);
    }

    /// Has something to do when the touch sensor says so.
    #[derive(Clone)]
    struct Bell {
        speed_m_s: f64,
        hold_s: f64,
        rings_at: [bool; 8],
    }

    impl Behaviour for Bell {
        /// Steps at which it was asked, and at which it was told that it must wait.
        type Memory = [usize; 2];

        fn memory(&self) -> [usize; 2] {
            [0, 0]
        }

        fn hold_s(&self) -> f64 {
            self.hold_s
        }

        fn triggered(&self, memory: &mut [usize; 2], _: &Situation) -> Option<Proposal> {
            let step = memory[0] + memory[1];
            memory[0] += 1;
            self.rings_at[step].then(|| self.held().into())
        }

        fn held(&self) -> Motion {
            Motion {
                speed_m_s: self.speed_m_s,
                turn_rate_rad_s: 0.0,
            }
        }

        fn suppressed(&self, memory: &mut [usize; 2]) {
            memory[1] += 1;
        }
    }

    /// Speeds of eight steps of two bells, the lower (1 m/s) and the higher (2 m/s).
    fn ring(lower: (f64, [u8; 8]), higher: (f64, [u8; 8])) -> [f64; 8] {
        let bell = |speed_m_s, (hold_s, at): (f64, [u8; 8])| Bell {
            speed_m_s,
            hold_s,
            rings_at: at.map(|rings| rings == 1),
        };
        let bells = [bell(1.0, lower), bell(2.0, higher)];
        let (mut layers, body) = (layers(&bells), rover());
        std::array::from_fn(|_| {
            let situation = Situation {
                percept: &crate::Percept::default(),
                body: &body,
                beliefs: None,
                rings: &[],
                ahead: None,
                turned_rad: 0.0,
                now_m_s: 0.0,
            };
            motion(arbitrate(&bells, &mut layers, &situation)).speed_m_s
        })
    }

    #[test]
    fn the_highest_with_something_to_do_has_its_way_and_with_none_it_stands() {
        let speeds = ring(
            (0.0, [1, 1, 1, 0, 0, 0, 0, 1]),
            (0.0, [0, 1, 1, 1, 0, 0, 1, 0]),
        );
        assert_eq!(speeds, [1.0, 2.0, 2.0, 2.0, 0.0, 0.0, 2.0, 1.0]);
    }

    #[test]
    fn a_behaviour_keeps_control_for_its_hold_time_against_lower_ones() {
        let speeds = ring((0.0, [1; 8]), (0.2, [0, 1, 0, 0, 0, 0, 1, 1]));
        assert_eq!(speeds, [1.0, 2.0, 2.0, 2.0, 1.0, 1.0, 2.0, 2.0]);
    }

    #[test]
    fn a_higher_behaviour_wins_over_a_hold_which_runs_on_meanwhile() {
        let speeds = ring(
            (0.4, [1, 0, 0, 0, 0, 0, 0, 0]),
            (0.0, [0, 0, 1, 0, 0, 0, 0, 0]),
        );
        assert_eq!(speeds, [1.0, 1.0, 2.0, 1.0, 1.0, 0.0, 0.0, 0.0]);
    }
}
