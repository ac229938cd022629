//! What stands on the field, as `speed field` writes it.

use serde::Deserialize;

/// Lengths in metres.
#[derive(Deserialize)]
pub struct Field {
    pub side_m: f32,
    /// Middle and radius.
    pub pillars: Vec<[f32; 3]>,
    /// Least and greatest corner.
    pub boxes: Vec<[f32; 4]>,
    /// Place, and heading in radians.
    pub robots: Vec<[f32; 3]>,
}

impl Field {
    /// Sides of boxes and of the field, from one end to the other.
    pub fn walls(&self) -> Vec<[f32; 4]> {
        let room = [0.0, 0.0, self.side_m, self.side_m];
        let outlines = self.boxes.iter().copied().chain([room]);
        let sides = |[x, y, far_x, far_y]: [f32; 4]| {
            [
                [x, y, far_x, y],
                [far_x, y, far_x, far_y],
                [far_x, far_y, x, far_y],
                [x, far_y, x, y],
            ]
        };
        outlines.flat_map(sides).collect()
    }
}
