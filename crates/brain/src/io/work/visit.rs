//! A robot is at the place for the time of service.

use super::Manner;

pub(super) const MANNER: Manner = Manner {
    name: "visit",
    is_precise: true,
    covers_area: false,
    is_at_item: false,
    effect: None,
};
