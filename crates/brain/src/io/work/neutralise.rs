//! A robot acts on the item of a confirmed mark, and looks again.

use super::{Effect, Manner};

pub(super) const MANNER: Manner = Manner {
    name: "neutralise",
    is_precise: false,
    covers_area: false,
    is_at_item: true,
    effect: Some(Effect::Neutralise),
};
