//! Which goals a robot can reach, and on what detour, by its map.

use super::ability::Moment;
use crate::navigation::path::Wavefront;
use crate::perception::beliefs::Map;
use base::geometry::Point;

/// An obstacle may lie this much farther away than the centre of its cell, as a fraction of the cell.
const TIGHT_CLEARANCE: f64 = 0.5;

/// Length of a diagonal step of a [`Wavefront`] in cells.
const DIAGONAL_STEP: f64 = 1.4;

/// The places that are connected to the robot's position. Unknown places count as free.
pub(crate) struct Reach<'m> {
    known: Option<(&'m Map, Wavefront)>,
    /// Cell of the robot.
    start: usize,
}

impl<'m> Reach<'m> {
    pub(crate) fn new(moment: &Moment<'m>, at: Point) -> Self {
        let has_obstacles = |map: &&Map| map.occupancy.occupied().next().is_some();
        let map = moment.map.filter(has_obstacles);
        let known = map.map(|map| {
            let mut wavefront = Wavefront::default();
            let clearance_m = moment.body.radius_m - TIGHT_CLEARANCE * map.field.cell_m;
            let whole = (&map.field, &map.occupancy);
            wavefront.expand(whole, at, clearance_m.max(0.0), |_, _| true);
            (map, wavefront)
        });
        let start = map.map_or(0, |map| map.field.nearest_cell(at));
        Self { known, start }
    }

    /// How many times as long as the straight line the path to a place is, by the map: 1 without
    /// obstacles between; `None` for a place that is not connected to the robot's position.
    pub(crate) fn detour(&self, place: Point) -> Option<f64> {
        let Some((map, wavefront)) = &self.known else {
            return Some(1.0);
        };
        let cell = map.field.nearest_cell(place);
        let to_cell_m = wavefront.cell_distance_m(&map.field, cell);
        let (cell, path_m) = to_cell_m.map_or_else(
            || wavefront.exit(&map.field, &map.occupancy, place),
            |path_m| Some((cell, path_m)),
        )?;
        let free_m = stepwise_m(map.field.centre(self.start), map.field.centre(cell));
        Some(if free_m > 0.0 {
            (path_m / free_m).max(1.0)
        } else {
            1.0
        })
    }
}

/// Distance without obstacles over the cells of a map, which is up to 8% longer than the straight line.
fn stepwise_m(from: Point, to: Point) -> f64 {
    let away = from.to(to);
    let (one_m, other_m) = (away.x.abs(), away.y.abs());
    let diagonal_m = one_m.min(other_m);
    one_m.max(other_m) - diagonal_m + DIAGONAL_STEP * diagonal_m
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::body::Body;
    use crate::io::percept::Percept;
    use crate::perception::beliefs::coverage_map::tests::map;
    use crate::perception::beliefs::occupancy::Ray;
    use base::geometry::Segment;

    #[test]
    fn a_place_within_walls_is_out_of_reach_and_one_outside_is_not() {
        let mut map = map();
        let (percept, body) = (Percept::default(), Body::default());
        let corner = |x: f64, y: f64| Point { x, y };
        // A room of 4 m x 4 m around (10, 10), seen from within.
        for along in (0..=80).map(|step| 8.0 + 0.05 * f64::from(step)) {
            let walls = [
                corner(along, 8.0),
                corner(along, 12.0),
                corner(8.0, along),
                corner(12.0, along),
            ];
            for to in walls {
                let free = Segment {
                    from: corner(10.0, 10.0),
                    to,
                };
                let hit = Some(to);
                (0..5).for_each(|_| map.occupancy.add_ray(&map.field, &Ray { free, hit }));
            }
        }
        let moment = Moment {
            percept: &percept,
            body: &body,
            beliefs: None,
            map: Some(&map),
            at: None,
            deviation_m: 0.0,
            elapsed_s: 0.1,
            battery_s: f64::INFINITY,
            charge: None,
        };
        let reach = Reach::new(&moment, corner(3.0, 3.0));
        assert_eq!(reach.detour(corner(10.0, 10.0)), None);
        assert!(
            reach
                .detour(corner(15.0, 15.0))
                .is_some_and(|detour| detour > 1.05)
        );
        assert_eq!(reach.detour(corner(3.0, 15.0)), Some(1.0));
    }
}
