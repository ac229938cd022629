//! Missions for which a controller plans goals itself.

pub(super) mod lane;
