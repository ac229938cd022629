//! Sixteen rays, plainly: each against all that is near.

use std::f32::consts::TAU;

pub const RAYS: usize = 16;
pub const RANGE_M: f32 = 3.0;

/// Places relative to a robot: middle and radius.
pub type Disc = [f32; 3];
/// Relative to a robot: from one end to the other.
pub type Wall = [f32; 4];

/// How far each ray goes; the first looks ahead, the others follow to the left.
pub fn ranges(heading_rad: f32, discs: &[Disc], walls: &[Wall]) -> [f32; RAYS] {
    std::array::from_fn(|ray| {
        let way = (heading_rad + TAU * ray as f32 / RAYS as f32).sin_cos();
        let discs = discs.iter().filter_map(|disc| to_disc(way, disc));
        let walls = walls.iter().filter_map(|wall| to_wall(way, wall));
        discs.chain(walls).fold(RANGE_M, f32::min)
    })
}

/// Whether a wall may be met by a ray.
pub fn is_near([x, y, end_x, end_y]: &Wall) -> bool {
    let (along_x, along_y) = (end_x - x, end_y - y);
    let length = along_x * along_x + along_y * along_y;
    let at = (-(x * along_x + y * along_y) / length).clamp(0.0, 1.0);
    let (near_x, near_y) = (x + at * along_x, y + at * along_y);
    near_x * near_x + near_y * near_y < RANGE_M * RANGE_M
}

fn to_disc((way_y, way_x): (f32, f32), [x, y, radius_m]: &Disc) -> Option<f32> {
    let ahead = way_x * x + way_y * y;
    let root = ahead * ahead - (x * x + y * y - radius_m * radius_m);
    (ahead > 0.0 && root >= 0.0).then(|| ahead - root.sqrt())
}

fn to_wall((way_y, way_x): (f32, f32), [x, y, end_x, end_y]: &Wall) -> Option<f32> {
    let from = way_x * y - way_y * x;
    let to = way_x * end_y - way_y * end_x;
    if (from > 0.0) == (to > 0.0) {
        return None;
    }
    let area = x * end_y - y * end_x;
    let range = area / (to - from);
    (range >= 0.0).then_some(range)
}
