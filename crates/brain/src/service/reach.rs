//! Which goals a robot can reach, and on what detour, by its map.

use super::ability::Moment;
use crate::navigation::path::Wavefront;
use crate::perception::beliefs::Map;
use alloc::vec::Vec;
use base::geometry::Point;
use core::cell::OnceCell;

/// An obstacle may lie this much farther away than the centre of its cell, as a fraction of the cell.
const TIGHT_CLEARANCE: f64 = 0.5;

/// Length of a diagonal step of a [`Wavefront`] in cells.
const DIAGONAL_STEP: f64 = 1.4;

/// Of more obstacles than this, it is not tested one by one whether they are in the way.
const MAX_OBSTACLES: usize = 64;

/// The places that are connected to the robot's position. Unknown places count as free.
pub(crate) struct Reach<'m> {
    at: Point,
    /// None without obstacles.
    map: Option<&'m Map>,
    /// Cell of the robot.
    start: usize,
    clearance_m: f64,
    /// Columns and rows of the occupied cells, if they are few.
    obstacles: Option<Vec<[i32; 2]>>,
    /// Computed for the first place with an obstacle in the way.
    wavefront: OnceCell<Wavefront>,
}

impl<'m> Reach<'m> {
    pub(crate) fn new(moment: &Moment<'m>, at: Point) -> Self {
        let has_obstacles = |map: &&Map| map.occupancy.occupied().next().is_some();
        let map = moment.map.filter(has_obstacles);
        let clearance_m = map.map_or(0.0, |map| {
            moment.body.radius_m - TIGHT_CLEARANCE * map.field.cell_m
        });
        Self {
            at,
            map,
            start: map.map_or(0, |map| map.field.nearest_cell(at)),
            clearance_m: clearance_m.max(0.0),
            obstacles: map.and_then(few_obstacles),
            wavefront: OnceCell::new(),
        }
    }

    /// How many times as long as the straight line the path to a place is, by the map: 1 without
    /// obstacles between; `None` for a place that is not connected to the robot's position.
    pub(crate) fn detour(&self, place: Point) -> Option<f64> {
        let Some(map) = self.map else {
            return Some(1.0);
        };
        let cell = map.field.nearest_cell(place);
        if !self.may_be_obstructed(map, cell) {
            return Some(1.0);
        }
        let wavefront = self.wavefront.get_or_init(|| {
            let mut wavefront = Wavefront::default();
            let whole = (&map.field, &map.occupancy);
            wavefront.expand(whole, self.at, self.clearance_m, |_, _| true);
            wavefront
        });
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

    /// Whether an obstacle is near the rectangle of cells between the robot and a cell: in a free one, no path over cells is
    /// longer than without obstacles.
    fn may_be_obstructed(&self, map: &Map, cell: usize) -> bool {
        let Some(obstacles) = &self.obstacles else {
            return true;
        };
        #[expect(clippy::cast_possible_truncation, reason = "a few cells")]
        let margin = (self.clearance_m / map.field.cell_m) as i32 + 1;
        let [from, to] = [self.start, cell].map(|cell| map.field.column_and_row_of(cell));
        let is_within = |at: &[i32; 2]| {
            (0..2).all(|axis| {
                let (low, high) = (from[axis].min(to[axis]), from[axis].max(to[axis]));
                (low - margin..=high + margin).contains(&at[axis])
            })
        };
        obstacles.iter().any(is_within)
    }
}

/// The columns and rows of all occupied cells, if they are few.
fn few_obstacles(map: &Map) -> Option<Vec<[i32; 2]>> {
    let occupied = map.occupancy.occupied();
    let places = occupied.map(|cell| map.field.column_and_row_of(cell));
    let some: Vec<[i32; 2]> = places.take(MAX_OBSTACLES + 1).collect();
    (some.len() <= MAX_OBSTACLES).then_some(some)
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

    fn moment<'m>(percept: &'m Percept, body: &'m Body, map: &'m Map) -> Moment<'m> {
        Moment {
            percept,
            body,
            beliefs: None,
            map: Some(map),
            at: None,
            deviation_m: 0.0,
            elapsed_s: 0.1,
            battery_s: f64::INFINITY,
            charge: None,
        }
    }

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
        let moment = moment(&percept, &body, &map);
        let reach = Reach::new(&moment, corner(3.0, 3.0));
        assert_eq!(reach.detour(corner(10.0, 10.0)), None);
        assert!(
            reach
                .detour(corner(15.0, 15.0))
                .is_some_and(|detour| detour > 1.05)
        );
        assert_eq!(reach.detour(corner(3.0, 15.0)), Some(1.0));
    }

    #[test]
    fn a_path_is_computed_only_if_an_obstacle_may_be_in_the_way() {
        let (percept, body) = (Percept::default(), Body::default());
        for seed in 0..20_u32 {
            let mut map = map();
            let place = |number: u32| {
                let along = |salt: u32| {
                    let word = (seed * 131 + number + 7 * salt).wrapping_mul(2_654_435_769);
                    1.0 + f64::from(word >> 16) / 65_536.0 * 17.0
                };
                Point {
                    x: along(1),
                    y: along(2),
                }
            };
            for number in 0..12 {
                let (to, from) = (place(number), Point { x: 0.5, y: 0.5 });
                let free = Segment { from, to };
                let hit = Some(to);
                (0..9).for_each(|_| map.occupancy.add_ray(&map.field, &Ray { free, hit }));
            }
            let moment = moment(&percept, &body, &map);
            let mut whole = Reach::new(&moment, place(99));
            let lazy = Reach::new(&moment, place(99));
            assert!(lazy.obstacles.is_some());
            whole.obstacles = None;
            for number in 100..140 {
                let detours = [&lazy, &whole].map(|reach| reach.detour(place(number)));
                let [one, other] = detours.map(|detour| detour.unwrap_or(0.0));
                assert!((one - other).abs() < 1e-9, "{one} {other}");
            }
        }
    }
}
