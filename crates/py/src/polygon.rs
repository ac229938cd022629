//! Polygons: whether they are simple, and what they contain.

use base::geometry::{Point, Polygon};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// What is wrong with the corners of a polygon; None if it is simple and has an area.
#[pyfunction]
#[expect(clippy::needless_pass_by_value, reason = "PyO3 passes an owned list")]
pub(crate) fn polygon_error(corners: Vec<[f64; 2]>) -> Option<String> {
    polygon(&corners).err()
}

/// Whether a simple polygon contains each point, its boundary included. Raises a `ValueError` if it is
/// not simple.
#[pyfunction]
#[expect(clippy::needless_pass_by_value, reason = "PyO3 passes an owned list")]
pub(crate) fn polygon_contains(
    corners: Vec<[f64; 2]>,
    points: Vec<[f64; 2]>,
) -> PyResult<Vec<bool>> {
    let polygon = polygon(&corners).map_err(PyValueError::new_err)?;
    let points = points.into_iter();
    Ok(points.map(|point| polygon.contains(point.into())).collect())
}

fn polygon(corners: &[[f64; 2]]) -> Result<Polygon, String> {
    let corners: Vec<Point> = corners.iter().copied().map(Point::from).collect();
    Polygon::new(&corners).map_err(|error| error.to_string())
}
