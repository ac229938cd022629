//! A robot looks closer at a mark until it confirms or rejects it, and fences off what it cannot neutralise.

use super::{Effect, Manner};

pub(super) const MANNER: Manner = Manner {
    name: "interrogate",
    is_precise: false,
    covers_area: false,
    is_at_item: true,
    effect: Some(Effect::Isolate),
};
