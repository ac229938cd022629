//! Terrain.

use super::grid::{NearCells, Still};
use base::geometry::{Point, Polygon};
use base::hashed::Hashed;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A class of terrain, for ground robots. Where two overlap, the one whose name sorts last applies.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TerrainSpec {
    /// Factor on the maximum speed.
    #[serde(default = "one")]
    #[schemars(range(min = 0.0, max = 10.0))]
    pub speed: f64,
    /// Factor on the energy of motion.
    #[serde(default = "one")]
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub energy: f64,
    /// Polygons, each a list of corners in order, in metres.
    pub areas_m: Vec<Vec<Point>>,
}

fn one() -> f64 {
    1.0
}

/// The effect of the terrain on a robot.
#[derive(Debug, Clone, Copy, PartialEq, Hashed)]
pub(crate) struct TerrainFactors {
    /// Factor on the maximum speed.
    pub(crate) speed: f64,
    /// Factor on the energy of motion.
    pub(crate) energy: f64,
}

impl TerrainFactors {
    pub(crate) const NO_EFFECT: Self = Self {
        speed: 1.0,
        energy: 1.0,
    };
}

/// A polygon of one class of terrain.
#[derive(Debug, Clone, PartialEq, Hashed)]
pub struct Area {
    polygon: Polygon,
    terrain_factors: TerrainFactors,
}

impl Area {
    /// An area of the class that `spec` describes.
    #[must_use]
    pub fn new(polygon: Polygon, spec: &TerrainSpec) -> Self {
        let terrain_factors = TerrainFactors {
            speed: spec.speed,
            energy: spec.energy,
        };
        Self {
            polygon,
            terrain_factors,
        }
    }

    pub(crate) fn speed(&self) -> f64 {
        self.terrain_factors.speed
    }
}

impl Still for Area {
    fn bounds(&self) -> [Point; 2] {
        let bounds = self.polygon.bounds();
        [bounds.min(), bounds.max()]
    }

    fn distance(&self, from: Point) -> f64 {
        self.polygon.distance_m(from)
    }
}

/// All areas, found by place.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Terrain {
    areas: Vec<Area>,
    near: NearCells,
}

impl Terrain {
    /// `areas`, ordered so that later ones override earlier ones.
    pub(crate) fn new(size_m: Point, areas: Vec<Area>) -> Self {
        // A place is within no more than the areas that its cell touches.
        const CELL_M: f64 = 1.0;
        Self {
            near: NearCells::new(size_m, &areas, CELL_M),
            areas,
        }
    }

    /// The largest factors anywhere, at least 1.
    pub(crate) fn most(&self) -> TerrainFactors {
        let most = |most: TerrainFactors, area: &Area| TerrainFactors {
            speed: most.speed.max(area.terrain_factors.speed),
            energy: most.energy.max(area.terrain_factors.energy),
        };
        self.areas.iter().fold(TerrainFactors::NO_EFFECT, most)
    }

    #[inline]
    pub(crate) fn at(&self, place: Point) -> TerrainFactors {
        let numbers = self.near.at(place).iter().rev();
        let mut areas = numbers.map(|number| &self.areas[*number as usize]);
        let area = areas.find(|area| area.polygon.contains(place));
        area.map_or(TerrainFactors::NO_EFFECT, |area| area.terrain_factors)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn area(corners: &[[f64; 2]], speed: f64) -> Area {
        let corners: Vec<Point> = corners.iter().map(|corner| Point::from(*corner)).collect();
        let spec = TerrainSpec {
            speed,
            energy: 1.0 / speed,
            areas_m: Vec::new(),
        };
        Area::new(Polygon::new(&corners).unwrap(), &spec)
    }

    proptest! {
        #[test]
        fn the_last_area_that_contains_a_place_determines_its_terrain(
            areas in prop::collection::vec(
                ((0.0..9.0, 0.0..9.0), (0.1..5.0, 0.1..5.0), 0.1..2.0_f64), 0..20,
            ),
            place in (0.0..=10.0, 0.0..=10.0),
        ) {
            let areas: Vec<Area> = areas.into_iter().map(|((x, y), (wide, high), speed)| {
                area(&[[x, y], [x + wide, y], [x, y + high]], speed)
            }).collect();
            let place = Point::from([place.0, place.1]);
            let last = areas.iter().rev().find(|area| area.polygon.contains(place));
            let expected = last.map_or(TerrainFactors::NO_EFFECT, |area| area.terrain_factors);
            let terrain = Terrain::new(Point { x: 10.0, y: 10.0 }, areas.clone());
            prop_assert_eq!(terrain.at(place), expected);
            let most = terrain.most();
            prop_assert!(most.speed >= expected.speed && most.energy >= expected.energy);
        }
    }

    #[test]
    fn the_edge_of_an_area_belongs_to_it() {
        let mud = area(&[[1.0, 1.0], [3.0, 1.0], [3.0, 2.0], [1.0, 2.0]], 0.5);
        let terrain = Terrain::new(Point { x: 4.0, y: 4.0 }, vec![mud]);
        let speed = |x: f64, y: f64| terrain.at(Point { x, y }).speed;
        assert_eq!(
            [speed(1.0, 1.5), speed(2.0, 2.0), speed(3.0, 1.0)],
            [0.5; 3]
        );
        assert_eq!(
            [speed(0.999, 1.5), speed(2.0, 2.001), speed(0.0, 0.0)],
            [1.0; 3]
        );
    }
}
