//! Subsumption: the highest triggered behaviour is active.
//!
//! After Brooks, *A robust layered control system for a mobile robot*, IEEE Journal of Robotics and
//! Automation 2(1), 1986. An active behaviour stays active for its hold time. Without it a robot
//! deadlocks in front of a large object: it turns away, and a lower behaviour at once turns it back.

use crate::behaviours::behaviour::Behaviour;
use crate::goals::proposal::Proposal;
use crate::situation::Situation;
use crate::situation::timer::Countdown;
use alloc::boxed::Box;
use alloc::vec::Vec;

/// The state of one robot for a behaviour.
#[derive(Debug, Clone)]
pub(crate) struct Layer<M> {
    memory: M,
    hold: Countdown,
}

impl<M> Layer<M> {
    pub(crate) fn memory_now(&self) -> &M {
        &self.memory
    }

    pub(crate) fn memory(&mut self) -> &mut M {
        &mut self.memory
    }

    /// Remaining hold time after a step of a period, in seconds.
    pub(crate) fn holds_s(&self, period_s: f64) -> f64 {
        self.hold.left_s(period_s)
    }
}

/// A layer for each behaviour.
pub(crate) fn layers<B: Behaviour>(behaviours: &[B]) -> Box<[Layer<B::Memory>]> {
    let memories = behaviours.iter().map(Behaviour::memory);
    memories
        .map(|memory| Layer {
            memory,
            hold: Countdown::default(),
        })
        .collect()
}

/// The index and proposal of the highest behaviour that is triggered or has hold time left. The
/// lowest behaviour comes first.
#[inline]
pub(crate) fn arbitrate<B: Behaviour>(
    behaviours: &[B],
    layers: &mut [Layer<B::Memory>],
    situation: &Situation,
) -> Option<(usize, Proposal)> {
    let mut proposal = None;
    for (place, (behaviour, layer)) in behaviours.iter().zip(layers).enumerate().rev() {
        if proposal.is_none() {
            proposal = step(behaviour, layer, situation).map(|proposal| (place, proposal));
        } else {
            behaviour.suppressed(&mut layer.memory);
            layer.hold.advance(situation);
        }
    }
    proposal.or_else(|| idle(behaviours))
}

/// The index and motion of the highest behaviour that moves while none proposes anything.
pub(crate) fn idle<B: Behaviour>(behaviours: &[B]) -> Option<(usize, Proposal)> {
    let mut numbered = behaviours.iter().enumerate().rev();
    numbered.find_map(|(place, behaviour)| Some((place, behaviour.idle()?.into())))
}

/// The proposals of all behaviours, the highest first, down to the first that proposes a motion:
/// lower destinations could not be served at the same time.
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
            layer.hold.advance(situation);
        } else if let Some(proposal) = step(behaviour, layer, situation) {
            has_motion = matches!(proposal, Proposal::Motion(_));
            proposals.push((place, proposal));
        }
    }
    if proposals.is_empty() {
        proposals.extend(idle(behaviours));
    }
}

/// The heading that the active behaviour turns to, if it turns to one.
#[inline]
pub(crate) fn heading_rad<B: Behaviour>(
    behaviours: &[B],
    layers: &[Layer<B::Memory>],
    active: usize,
) -> Option<f64> {
    let (behaviour, layer) = (behaviours.get(active)?, layers.get(active)?);
    behaviour.heading_rad(&layer.memory)
}

#[inline]
pub(crate) fn step<B: Behaviour>(
    behaviour: &B,
    layer: &mut Layer<B::Memory>,
    situation: &Situation,
) -> Option<Proposal> {
    let proposal = behaviour.triggered(&mut layer.memory, situation);
    if proposal.is_some() {
        layer.hold = Countdown::new(behaviour.hold_s());
        return proposal;
    }
    layer.hold.advance(situation);
    let is_held = layer.hold.is_running(situation);
    is_held.then(|| behaviour.held().into())
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
    use core::cell::Cell;

    /// Keeps heading 0: Bender's "correct", as the lowest behaviour.
    #[derive(Clone)]
    enum Test {
        Correct,
        Bundled(Ready),
    }

    impl Behaviour for Test {
        type Memory = Option<<Ready as Behaviour>::Memory>;

        fn memory(&self) -> Self::Memory {
            match self {
                Self::Correct => None,
                Self::Bundled(ready) => Some(ready.memory()),
            }
        }

        fn hold_s(&self) -> f64 {
            match self {
                Self::Correct => 0.0,
                Self::Bundled(ready) => ready.hold_s(),
            }
        }

        fn triggered(&self, memory: &mut Self::Memory, situation: &Situation) -> Option<Proposal> {
            match (self, memory) {
                (Self::Bundled(ready), Some(memory)) => ready.triggered(memory, situation),
                _ => Some(to_course_0(situation).into()),
            }
        }

        fn held(&self) -> Motion {
            match self {
                Self::Correct => Motion::default(),
                Self::Bundled(ready) => ready.held(),
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

    /// A wall 3 m wide across the path.
    fn wide_wall() -> Vec<Segment> {
        outline(&[[4.0, -1.5], [4.0, 1.5], [4.5, 1.5], [4.5, -1.5]])
    }

    /// A minute of a robot with heading 0, for a hold time of avoidance.
    fn walk(hold_s: f64) -> Walk {
        let body = rover();
        let avoid = Avoid {
            near_m: 0.3,
            hold_s,
            ..Avoid::default()
        };
        let avoid = Test::Bundled(BehaviourSpec::Avoid(avoid).ready(&body));
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
            let moved = odometry.reckon(&percept, &body, body.period_s);
            let situation = Situation {
                percept: &percept,
                body: &body,
                beliefs: None,
                localisation: None,
                peers: None,
                rings: &governor.rings,
                last_goal: &Cell::new(0),
                ahead: governor.ahead(&percept, &body, moved.speed_m_s),
                elapsed_s: body.period_s,
                turned_rad: moved.turned_rad,
                current_speed_m_s: moved.speed_m_s,
            };
            let proposal = motion(arbitrate(&behaviours, &mut layers, &situation));
            let motion = governor.limit(proposal, &situation, &odometry);
            odometry.record_command(motion);
            walk.step(motion);
        }
        walk
    }

    #[test]
    fn without_a_hold_time_it_deadlocks_in_front_of_a_large_object() {
        let walk = walk(0.0);
        assert!(walk.at.x < 4.0 && walk.at.y.abs() < 1.0, "{:?}", walk.at);
    }

    #[test]
    fn with_a_hold_time_it_passes_a_large_object() {
        let walk = walk(2.5);
        assert!(walk.at.x > 6.0, "{:?}", walk.at);
        assert!(wrapped(walk.heading_rad).abs() < 0.2);
        assert!(walk.min_gap_m > 0.0);
    }

    /// Triggered by the touch sensor.
    #[derive(Clone)]
    struct Bell {
        speed_m_s: f64,
        hold_s: f64,
        rings_at: [bool; 8],
    }

    impl Behaviour for Bell {
        /// Number of steps in which it was called, and in which it was suppressed.
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

    /// Speeds of eight steps with two such behaviours, the lower (1 m/s) and the higher (2 m/s).
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
                localisation: None,
                peers: None,
                rings: &[],
                last_goal: &Cell::new(0),
                ahead: None,
                elapsed_s: body.period_s,
                turned_rad: 0.0,
                current_speed_m_s: 0.0,
            };
            motion(arbitrate(&bells, &mut layers, &situation)).speed_m_s
        })
    }

    #[test]
    fn the_highest_triggered_behaviour_is_active_and_without_one_the_robot_stops() {
        let speeds = ring(
            (0.0, [1, 1, 1, 0, 0, 0, 0, 1]),
            (0.0, [0, 1, 1, 1, 0, 0, 1, 0]),
        );
        assert_eq!(speeds, [1.0, 2.0, 2.0, 2.0, 0.0, 0.0, 2.0, 1.0]);
    }

    #[test]
    fn a_behaviour_stays_active_for_its_hold_time_over_lower_ones() {
        let speeds = ring((0.0, [1; 8]), (0.2, [0, 1, 0, 0, 0, 0, 1, 1]));
        assert_eq!(speeds, [1.0, 2.0, 2.0, 2.0, 1.0, 1.0, 2.0, 2.0]);
    }

    #[test]
    fn a_higher_behaviour_overrides_a_hold_time_which_keeps_running() {
        let speeds = ring(
            (0.4, [1, 0, 0, 0, 0, 0, 0, 0]),
            (0.0, [0, 0, 1, 0, 0, 0, 0, 0]),
        );
        assert_eq!(speeds, [1.0, 1.0, 2.0, 1.0, 1.0, 0.0, 0.0, 0.0]);
    }
}
