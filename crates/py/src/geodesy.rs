//! The place of a world on the earth.

use crate::arguments::Arguments;
use base::geodesy::{Geographic, LocalFrame as Frame};
use base::geometry::Point;
use pyo3::prelude::*;
use std::ops::RangeInclusive;

const LATITUDE: (RangeInclusive<f64>, &str) = (-90.0..=90.0, "degrees");
const ORIGIN_LATITUDE: (RangeInclusive<f64>, &str) = (
    -Frame::MAX_LATITUDE_DEG..=Frame::MAX_LATITUDE_DEG,
    "degrees",
);
const LONGITUDE: (RangeInclusive<f64>, &str) = (-180.0..=180.0, "degrees");
const DECLINATION: (RangeInclusive<f64>, &str) = (-180.0..=180.0, "degrees");
const BEARING: (RangeInclusive<f64>, &str) = (-360.0..=360.0, "degrees");
const HEADING: (RangeInclusive<f64>, &str) = (-1e6..=1e6, "radians");
const DISTANCE: (RangeInclusive<f64>, &str) =
    (-Frame::MAX_DISTANCE_M..=Frame::MAX_DISTANCE_M, "metres");

/// Converts between geographic coordinates (WGS 84) and those of a world.
#[pyclass(frozen, module = "agent_economy._core")]
pub(crate) struct LocalFrame(Frame);

#[pymethods]
impl LocalFrame {
    /// A world with the point (0, 0) at this place, whose y axis has the true bearing `rotation_deg`.
    #[new]
    #[pyo3(
        signature = (latitude_deg, longitude_deg, rotation_deg=None, declination_deg=None),
        text_signature = "(latitude_deg, longitude_deg, rotation_deg=0.0, declination_deg=0.0)"
    )]
    fn new(
        latitude_deg: &Bound<PyAny>,
        longitude_deg: &Bound<PyAny>,
        rotation_deg: Option<&Bound<PyAny>>,
        declination_deg: Option<&Bound<PyAny>>,
    ) -> PyResult<Self> {
        let check = Arguments::default();
        let (latitude_deg, longitude_deg, rotation_deg, declination_deg) = (
            check.number("latitude_deg", latitude_deg, ORIGIN_LATITUDE),
            check.number("longitude_deg", longitude_deg, LONGITUDE),
            rotation_deg.map_or(Some(0.0), |it| check.number("rotation_deg", it, BEARING)),
            declination_deg.map_or(Some(0.0), |it| {
                check.number("declination_deg", it, DECLINATION)
            }),
        );
        let frame = (|| {
            let origin = Geographic {
                latitude_deg: latitude_deg?,
                longitude_deg: longitude_deg?,
            };
            Some(Frame::new(origin, rotation_deg?, declination_deg?))
        })();
        check.or_errors(frame).map(Self)
    }

    /// `x_m` and `y_m` of a geographic place.
    fn to_local(
        &self,
        latitude_deg: &Bound<PyAny>,
        longitude_deg: &Bound<PyAny>,
    ) -> PyResult<(f64, f64)> {
        let check = Arguments::default();
        let latitude_deg = check.number("latitude_deg", latitude_deg, LATITUDE);
        let longitude_deg = check.number("longitude_deg", longitude_deg, LONGITUDE);
        let place = latitude_deg.zip(longitude_deg);
        let (latitude_deg, longitude_deg) = check.or_errors(place)?;
        let Point { x, y } = self.0.to_local(Geographic {
            latitude_deg,
            longitude_deg,
        });
        Ok((x, y))
    }

    /// Latitude and longitude of a point of the world, in degrees.
    fn to_geographic(&self, x_m: &Bound<PyAny>, y_m: &Bound<PyAny>) -> PyResult<(f64, f64)> {
        let check = Arguments::default();
        let x_m = check.number("x_m", x_m, DISTANCE);
        let y_m = check.number("y_m", y_m, DISTANCE);
        let (x, y) = check.or_errors(x_m.zip(y_m))?;
        let place = self.0.to_geographic(Point { x, y });
        Ok((place.latitude_deg, place.longitude_deg))
    }

    /// The heading of a robot whose compass reads a magnetic bearing. The compass points `mounting_deg`
    /// clockwise of its front.
    #[pyo3(
        signature = (magnetic_bearing_deg, mounting_deg=None),
        text_signature = "($self, magnetic_bearing_deg, mounting_deg=0.0)"
    )]
    fn heading_rad(
        &self,
        magnetic_bearing_deg: &Bound<PyAny>,
        mounting_deg: Option<&Bound<PyAny>>,
    ) -> PyResult<f64> {
        let check = Arguments::default();
        let bearing_deg = check.number("magnetic_bearing_deg", magnetic_bearing_deg, BEARING);
        let mounting_deg =
            mounting_deg.map_or(Some(0.0), |it| check.number("mounting_deg", it, BEARING));
        let (bearing_deg, mounting_deg) = check.or_errors(bearing_deg.zip(mounting_deg))?;
        Ok(self.0.compass_heading_rad(bearing_deg, mounting_deg))
    }

    /// The magnetic bearing of a heading, from 0 to below 360.
    fn magnetic_bearing_deg(&self, heading_rad: &Bound<PyAny>) -> PyResult<f64> {
        let check = Arguments::default();
        let heading_rad = check.number("heading_rad", heading_rad, HEADING);
        let heading_rad = check.or_errors(heading_rad)?;
        Ok(self.0.magnetic_bearing_deg(heading_rad))
    }
}
