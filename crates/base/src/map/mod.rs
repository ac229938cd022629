//! ROS occupancy maps, as loaded by `map_server` and `nav2_map_server`: a YAML file and a PGM
//! or PNG image.
//!
//! **What a pixel means** (`wiki.ros.org/map_server`, "Value Interpretation", and `map_io.cpp` of
//! `nav2_map_server` in ROS 2 Humble and Jazzy). The image's first row is the map's top. Of a pixel of
//! value v, the mean of its colour channels, the occupancy probability is p = (m - v) / m, where m is the
//! greatest value, 255 in most files; v / m if `negate` is set. Then, by `mode`,
//!
//! * `trinary`: 100 (occupied) if p > `occupied_thresh`, 0 (free) if p < `free_thresh`, else -1
//!   (unknown). In an image with transparency, v is the mean of red, green, blue and opacity;
//! * `scale`: the same without opacity, but in between 100 (p - `free_thresh`) / (`occupied_thresh` -
//!   `free_thresh`), rounded, halves to the even number; -1 for a pixel that is not opaque;
//! * `raw`: 255 v / m, rounded, or -1 if that is above 100, for any value of `negate`.
//!
//! Keys of the YAML file that `map_server` does not read are ignored.
//!
//! `origin` is the pose [x, y, yaw] of the lower left corner of the lower left pixel: the map is
//! rotated about it, anticlockwise, by `yaw` radians. (Much of ROS ignores the yaw; here it is used.)
//! [`MapOptions::at`] replaces x and y.
//!
//! **Solid cells:** those of occupancy 100; unknown cells are free. With [`Unknown::Solid`], all cells
//! that are not known to be free (0) are solid. Outside the map, nothing is solid.

mod grid;
mod image;
mod outline;
mod pgm;
mod pixel;
mod png;
mod settings;

pub use grid::MAX_CELLS;
pub use image::MAX_IMAGE_BYTES;
pub use outline::MAX_SEGMENTS;

use crate::error::{InputError, InputErrors};
use crate::geometry::{Point, Rectangle, Segment};
use crate::hashed::Hashed;
use grid::Grid;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use settings::Settings;

/// Treatment of cells that are neither free nor occupied.
#[derive(
    Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Hashed,
)]
#[serde(rename_all = "snake_case")]
pub enum Unknown {
    /// They are free.
    #[default]
    Free,
    /// They are occupied.
    Solid,
}

/// How a world uses a map.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct MapOptions {
    /// Treatment of cells that are neither free nor occupied.
    pub unknown: Unknown,
    /// Position of the lower left corner of the image in the world, instead of the `origin` in the file.
    pub at: Option<Point>,
}

/// An occupancy grid of square cells.
#[derive(Debug, Clone, PartialEq, Hashed)]
pub struct OccupancyMap {
    /// Occupancy as in ROS: 0 to 100, or -1. The lowest row is first.
    cells: Grid,
    settings: Settings,
    unknown: Unknown,
    #[hashed(skip)]
    outline: Vec<Segment>,
}

// The outline follows from the cells.

/// Reads the map with the YAML `text`; `file` is its name in errors.
///
/// `open` returns the bytes of the image that the YAML names, or the reason why it cannot; a relative
/// name is relative to the YAML file. At most [`MAX_IMAGE_BYTES`] are used. The map takes one byte per
/// cell and 32 per wall; memory is allocated only for data that is present.
///
/// # Errors
/// All errors of the YAML; if there are none, the first error of the image.
///
/// ```
/// use base::map::{read, MapOptions};
/// let text = "image: room.pgm\nresolution: 0.5\norigin: [1, 2, 0]\nnegate: 0\n\
///             occupied_thresh: 0.65\nfree_thresh: 0.196\n";
/// let open = |_: &str| Ok(b"P2 3 2 255  0 205 254  0 254 254".to_vec());
/// let map = read("room.yaml", text, MapOptions::default(), open)?;
/// assert!(map.is_solid([1.25, 2.75].into()));
/// assert!(!map.is_solid([1.75, 2.75].into()));
/// assert_eq!(map.outline().len(), 4);
/// # Ok::<(), base::error::InputErrors>(())
/// ```
pub fn read(
    file: &str,
    text: &str,
    options: MapOptions,
    open: impl FnOnce(&str) -> Result<Vec<u8>, String>,
) -> Result<OccupancyMap, InputErrors> {
    let settings = settings::read(file, text)?;
    let only = |error| InputErrors(vec![error]);
    let bytes = open(&settings.image).map_err(|why| only(settings.image_error(&why)))?;
    let meaning = |pixel| settings.occupancy(pixel);
    let cells = image::read(&settings.image, &bytes, meaning).map_err(only)?;
    drop(bytes);
    let settings = settings.placed(options.at);
    OccupancyMap::new(cells, settings, options.unknown).map_err(only)
}

impl OccupancyMap {
    fn new(cells: Grid, settings: Settings, unknown: Unknown) -> Result<Self, InputError> {
        let is_solid = |occupancy| is_solid(occupancy, unknown);
        let corner = |column, row| settings.place(f64::from(column), f64::from(row));
        let outline = outline::trace(&cells, is_solid, corner).ok_or_else(|| {
            let why =
                format!("it has more than {MAX_SEGMENTS} straight walls: smooth its outlines");
            settings.image_error(&why)
        })?;
        Ok(Self {
            cells,
            settings,
            unknown,
            outline,
        })
    }

    /// Position of the lower left corner of the image in the world.
    #[must_use]
    pub fn origin(&self) -> Point {
        self.settings.origin()
    }

    /// Number of cells along the x axis of the map.
    #[must_use]
    pub fn columns(&self) -> u32 {
        self.cells.columns()
    }

    /// Number of cells along the y axis of the map.
    #[must_use]
    pub fn rows(&self) -> u32 {
        self.cells.rows()
    }

    /// Side of a cell, in metres.
    #[must_use]
    pub fn resolution_m(&self) -> f64 {
        self.settings.resolution_m
    }

    /// Occupancy of a cell, counted from the lower left: 0 free, 100 occupied, -1 unknown; `None`
    /// outside the map.
    #[must_use]
    pub fn occupancy(&self, column: u32, row: u32) -> Option<i8> {
        self.cells.get(column, row)
    }

    /// Number of occupied cells, and of those whose centres are outside of `world`.
    #[must_use]
    pub fn occupied_and_outside(&self, world: Rectangle) -> (usize, usize) {
        let (mut occupied, mut outside) = (0, 0);
        for row in 0..self.rows() {
            for column in 0..self.columns() {
                if self.occupancy(column, row) == Some(100) {
                    let (x, y) = (f64::from(column) + 0.5, f64::from(row) + 0.5);
                    occupied += 1;
                    outside += usize::from(!world.contains(self.settings.place(x, y)));
                }
            }
        }
        (occupied, outside)
    }

    /// Whether `point` is in a solid cell. A point between two cells is in one of them.
    #[must_use]
    pub fn is_solid(&self, point: Point) -> bool {
        let at = self.settings.cell(point);
        let occupancy = at.and_then(|(column, row)| self.occupancy(column, row));
        occupancy.is_some_and(|occupancy| is_solid(occupancy, self.unknown))
    }

    /// The boundary between solid and free cells as maximal straight segments, in world coordinates.
    ///
    /// They form closed lines with free space on their left. Adjacent segments have bit-identical ends,
    /// so that there are no gaps, also where two solid cells touch at a corner only.
    #[must_use]
    pub fn outline(&self) -> &[Segment] {
        &self.outline
    }

    /// The corners of the map in world coordinates, anticlockwise from its origin.
    #[must_use]
    pub fn corners(&self) -> [Point; 4] {
        let (right, top) = (f64::from(self.columns()), f64::from(self.rows()));
        [[0.0, 0.0], [right, 0.0], [right, top], [0.0, top]]
            .map(|[column, row]| self.settings.place(column, row))
    }

    /// The axis-aligned bounding box of the map.
    #[must_use]
    pub fn bounds(&self) -> Rectangle {
        let [a, b, c, d] = self.corners();
        Rectangle::spanned(a, b).joined(&Rectangle::spanned(c, d))
    }
}

fn is_solid(occupancy: i8, unknown: Unknown) -> bool {
    match unknown {
        Unknown::Free => occupancy == 100,
        Unknown::Solid => occupancy != 0,
    }
}

#[cfg(test)]
mod tests;
