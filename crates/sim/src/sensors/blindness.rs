//! Items that sensors of a model never detect.

use super::sensor_frame::NoisePurpose;
use base::noise::{Noise, share};
use base::random::Entity;

/// The items to which all sensors of one model are blind.
///
/// One draw per item, model and run decides, whichever robot looks and however often. It does not
/// depend on the share: with a larger share, a sensor is blind to the same items and to more.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Blindness {
    model: u32,
    /// By the kind of item.
    shares: Vec<f64>,
}

impl Blindness {
    /// For shares by kind of item; `None` if all are 0.
    pub(super) fn new(model: u32, shares: Vec<f64>) -> Option<Self> {
        let is_any = shares.iter().any(|share| *share > 0.0);
        is_any.then_some(Self { model, shares })
    }

    /// The items of one run.
    pub(super) fn in_run(&self, [seed, run]: [u64; 2]) -> BlindItems<'_> {
        let model = Entity {
            kind: self.model,
            index: 0,
        };
        BlindItems {
            shares: &self.shares,
            noise: Noise::of(seed, run, model),
        }
    }
}

/// The items of one run to which all sensors of one model are blind.
pub(super) struct BlindItems<'b> {
    shares: &'b [f64],
    noise: Noise,
}

impl BlindItems<'_> {
    /// Whether an item of a kind is one of them.
    pub(super) fn contains(&self, kind: u16, thing: Entity) -> bool {
        let blind = self.shares[usize::from(kind)];
        // A model may have the name of a kind of robots; no robot uses this purpose.
        let words = self.noise.words(
            NoisePurpose::Blindness as u32,
            u64::from(thing.kind) << 32,
            thing.index,
        );
        blind > 0.0 && share(words[0]) < blind
    }
}
