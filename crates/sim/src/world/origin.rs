//! Where a world lies on the earth.

use base::geodesy::LocalFrame;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Geographic position and orientation, for robots with a satellite receiver or a compass. It changes no
/// simulated run.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct OriginSpec {
    /// WGS 84 latitude of the point [0, 0], in degrees; north is positive.
    #[schemars(range(min = -LocalFrame::MAX_LATITUDE_DEG, max = LocalFrame::MAX_LATITUDE_DEG))]
    pub latitude_deg: f64,
    /// WGS 84 longitude of the point [0, 0], in degrees; east is positive.
    #[schemars(range(min = -180.0, max = 180.0))]
    pub longitude_deg: f64,
    /// True bearing of the y axis: clockwise from north, in degrees.
    #[serde(default)]
    #[schemars(range(min = -360.0, max = 360.0))]
    pub rotation_deg: f64,
    /// Magnetic declination: bearing of magnetic north, in degrees; east is positive.
    #[serde(default)]
    #[schemars(range(min = -180.0, max = 180.0))]
    pub declination_deg: f64,
}
