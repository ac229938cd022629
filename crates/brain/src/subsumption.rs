//! Which behaviour has its way: the highest that has something to do.
//!
//! After Brooks, *A robust layered control system for a mobile robot*, IEEE Journal of Robotics and
//! Automation 2(1), 1986. A behaviour that has had its way keeps it for its hold time. Without that
//! a robot locks in front of a large object: it turns away, a lower behaviour at once turns it back
//! to its course, and so on for ever.

use crate::command::Motion;
use crate::senses::Senses;
use alloc::boxed::Box;

/// A behaviour in a body.
pub(crate) trait Behaviour {
    /// What a robot remembers for it.
    type Memory: Clone;

    /// The memory of a robot that has just been switched on.
    fn memory(&self) -> Self::Memory;

    /// For so long it keeps control after it last had something to do.
    fn hold_s(&self) -> f64 {
        0.0
    }

    /// How it wants to move, if it has something to do. It is asked at each step at which no higher
    /// behaviour has control.
    fn triggered(&self, memory: &mut Self::Memory, senses: &Senses) -> Option<Motion>;

    /// How it moves while it keeps control with nothing to do.
    fn held(&self) -> Motion;

    /// Instead of being asked, it is told that a higher behaviour has control.
    fn suppressed(&self, _memory: &mut Self::Memory) {}
}

/// One robot's part in a behaviour.
#[derive(Debug, Clone)]
pub(crate) struct Layer<M> {
    memory: M,
    /// Time for which it keeps control.
    left_s: f32,
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

/// What the highest behaviour with something to do, or with hold time left, wants; if there is
/// none, to stand. The lowest comes first.
#[inline]
pub(crate) fn arbitrate<B: Behaviour>(
    behaviours: &[B],
    layers: &mut [Layer<B::Memory>],
    senses: &Senses,
) -> Motion {
    let mut wanted = None;
    for (behaviour, layer) in behaviours.iter().zip(layers).rev() {
        if wanted.is_none() {
            wanted = step(behaviour, layer, senses);
        } else {
            behaviour.suppressed(&mut layer.memory);
            pass(layer, senses);
        }
    }
    wanted.unwrap_or_default()
}

#[inline]
#[expect(clippy::cast_possible_truncation, reason = "kept short")]
fn step<B: Behaviour>(
    behaviour: &B,
    layer: &mut Layer<B::Memory>,
    senses: &Senses,
) -> Option<Motion> {
    let wanted = behaviour.triggered(&mut layer.memory, senses);
    if wanted.is_some() {
        layer.left_s = behaviour.hold_s() as f32;
        return wanted;
    }
    let is_held = layer.left_s > 0.0;
    pass(layer, senses);
    is_held.then(|| behaviour.held())
}

#[inline]
fn pass<M>(layer: &mut Layer<M>, senses: &Senses) {
    layer.left_s = (layer.left_s - senses.period_s()).max(0.0);
}
