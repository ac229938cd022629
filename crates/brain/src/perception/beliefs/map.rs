//! The maps of the mission area, on one grid.

use super::coverage_map::CoverageMap;
use super::field::Field;
use super::occupancy::{Occupancy, Ray};
use super::others::Others;
use super::pose::{Pose, turned};
use super::spec::BeliefsSpec;
use crate::perception::rays::{Ring, free_ranges_m};
use crate::perception::sector::direction;
use base::geometry::{Point, Rectangle, Segment};
use base::hashed::Hashed;
use base::trig::wrapped;

/// Scans are integrated into the map when the robot has moved by this fraction of a cell, has
/// turned by this angle, or after this time.
const MAP_UPDATE_CELLS: f64 = 0.25;
const MAP_UPDATE_RAD: f64 = 0.1;
const MAP_UPDATE_S: f64 = 0.5;

/// The maps of the mission area: occupancy and coverage.
#[derive(Debug, Clone, Hashed)]
pub(crate) struct Map {
    pub(crate) field: Field,
    pub(crate) occupancy: Occupancy,
    pub(crate) coverage: CoverageMap,
    /// Pose of the last map update, and the time since.
    last_update: Option<(Pose, f64)>,
}

impl Map {
    pub(crate) fn new(spec: &BeliefsSpec, area: &Rectangle) -> Self {
        let field = Field::new(area, spec.cell_m, spec.cells as usize);
        Self {
            occupancy: Occupancy::new(&field),
            coverage: CoverageMap::new(field.cells()),
            last_update: None,
            field,
        }
    }

    /// Whether scans are integrated: from about the same pose, they would only repeat the same
    /// errors.
    pub(super) fn is_update_due(&mut self, pose: &Pose, elapsed_s: f64) -> bool {
        if let Some((last, age_s)) = &mut self.last_update {
            *age_s += elapsed_s;
            let moved_m2 = last.at.to(pose.at).length_squared();
            let turned_rad = wrapped(pose.heading_rad - last.heading_rad).abs();
            let min_m = MAP_UPDATE_CELLS * self.field.cell_m;
            if *age_s < MAP_UPDATE_S && moved_m2 < min_m * min_m && turned_rad < MAP_UPDATE_RAD {
                return false;
            }
        }
        self.last_update = Some((*pose, 0.0));
        true
    }

    /// Integrates a scan into the occupancy map. Hits on moving objects are left out,
    /// those on parked robots are not.
    pub(super) fn update(
        &mut self,
        pose: &Pose,
        others: &Others,
        (ring, ranges_m): (&Ring, &[f64]),
    ) {
        let front = direction(pose.heading_rad);
        let in_world = |end: Point| pose.at.plus(turned(end, front));
        self.occupancy.begin_scan();
        let free_m = free_ranges_m(ranges_m);
        for (ray, free_m) in ring.rays(ranges_m).zip(free_m) {
            let end = ray.end();
            let is_hit = ray.range_m < ring.range_m() && !others.is_on_moving(end);
            let free_end = in_world(ray.direction.times(free_m.min(ray.range_m)));
            let free = Segment {
                from: pose.at,
                to: free_end,
            };
            self.occupancy.add_ray(
                &self.field,
                &Ray {
                    free,
                    hit: is_hit.then(|| in_world(end)),
                },
            );
        }
    }
}
