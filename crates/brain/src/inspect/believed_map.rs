//! The map of a robot.

use crate::perception::beliefs::Map;
use alloc::vec::Vec;
use base::geometry::Point;

/// The believed occupancy of the mission area, and where no item was observed: cells row by row
/// from the lower left corner.
#[derive(Debug, Clone, PartialEq)]
pub struct BelievedMap {
    /// Lower left corner of the first cell, in the world.
    pub corner: Point,
    /// Width of a cell.
    pub cell_m: f64,
    /// Cells in a row.
    pub columns: usize,
    /// Number of rows.
    pub rows: usize,
    /// Probability that each cell is occupied, in percent; -1 if unknown.
    pub occupancy: Vec<i8>,
    /// Probability that an item in each cell would not have been detected, in percent.
    pub unseen: Vec<u8>,
}

impl BelievedMap {
    pub(crate) fn of(map: &Map) -> Self {
        Self {
            corner: map.field.corner(),
            cell_m: map.field.cell_m,
            columns: map.field.columns,
            rows: map.field.rows,
            occupancy: map.occupancy.percent().collect(),
            unseen: map.coverage.percent().collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::perception::beliefs::BeliefsSpec;
    use crate::perception::beliefs::occupancy::Ray;
    use base::geometry::{Rectangle, Segment};

    #[test]
    fn a_map_tells_of_each_cell_what_is_believed() {
        let corner = Point { x: -2.0, y: 1.0 };
        let area = Rectangle::spanned(corner, Point { x: 8.0, y: 6.0 });
        let mut map = Map::new(&BeliefsSpec::default(), &area);
        let free = Segment {
            from: Point { x: 0.0, y: 3.1 },
            to: Point { x: 5.0, y: 3.1 },
        };
        let ray = Ray {
            free,
            hit: Some(free.to),
        };
        (0..3).for_each(|_| {
            map.occupancy.begin_scan();
            map.occupancy.add_ray(&map.field, &ray);
        });
        let believed = BelievedMap::of(&map);
        assert_eq!((believed.corner, believed.cell_m), (corner, 0.25));
        assert_eq!(believed.occupancy.len(), believed.columns * believed.rows);
        let percent = |at| believed.occupancy[map.field.cell(at).unwrap()];
        // Three times four and minus one quarter nats.
        assert_eq!(percent(free.to), 95);
        assert_eq!(percent(Point { x: 3.0, y: 3.1 }), 32);
        assert_eq!(percent(Point { x: 3.0, y: 5.1 }), -1);
        for (cell, percent) in believed.occupancy.iter().enumerate() {
            assert_eq!(map.occupancy.is_occupied(cell), *percent >= 73);
        }
        assert!(believed.unseen.iter().all(|percent| *percent == 100));
    }
}
