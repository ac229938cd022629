//! A robot searches the area around the place, in lanes, or from where it sees all of it.

use super::Manner;

pub(super) const MANNER: Manner = Manner {
    name: "search",
    is_precise: false,
    covers_area: true,
    is_at_item: false,
    effect: None,
};
