//! Checks of obstacles and terrain areas.

use crate::world::WorldSpec;
use crate::world::grid::Still;
use crate::world::obstacles::{ObstacleSpec, Solid};
use crate::world::terrain::{Area, TerrainSpec};
use base::document::Place;
use base::error::InputError;
use base::geometry::{Disc, Point, Polygon, Rectangle};
use base::map::{self, MapOptions, OccupancyMap, Unknown};
use std::collections::BTreeMap;

/// Returns the bytes of a file that a scenario names, or the reason why it cannot.
type Open<'o> = &'o dyn Fn(&str) -> Result<Vec<u8>, String>;

/// The valid obstacles; reports those that are invalid, or outside the world.
pub(super) fn solids(
    world: &WorldSpec,
    at: &Place,
    open: Open,
    errors: &mut Vec<InputError>,
) -> Vec<Solid> {
    let mut solids = Vec::new();
    let rectangle = rectangle(world);
    for (index, obstacle) in world.obstacles.iter().enumerate() {
        let at = at.key("obstacles").item(index);
        match solid(obstacle, &at, open) {
            Ok(solid) => {
                let [least, greatest] = solid.bounds();
                let is_there = if world.periodic {
                    rectangle.contains(least) && rectangle.contains(greatest)
                } else {
                    rectangle.overlaps(&Rectangle::spanned(least, greatest))
                };
                if is_there {
                    solids.push(solid);
                } else {
                    let is_map = matches!(obstacle, ObstacleSpec::Map { .. });
                    let advice = if is_map { "; at_m places a map" } else { "" };
                    errors.push(at.error(where_obstacles_are(world) + advice));
                }
            }
            Err(found) => errors.extend(found),
        }
    }
    solids
}

/// The rectangle of a world.
pub(super) fn rectangle(world: &WorldSpec) -> Rectangle {
    let [width, height] = world.size_m;
    let corner = Point {
        x: width.0,
        y: height.0,
    };
    Rectangle::spanned(Point::default(), corner)
}

fn where_obstacles_are(world: &WorldSpec) -> String {
    if world.periodic {
        format!("wholly in {}, because the world is periodic", words(world))
    } else {
        format!("at least partly in {}", words(world))
    }
}

/// The rectangle of a world, in words.
pub(super) fn words(world: &WorldSpec) -> String {
    let [width, height] = world.size_m;
    format!("the world, from [0, 0] to [{}, {}]", width.0, height.0)
}

fn solid(obstacle: &ObstacleSpec, at: &Place, open: Open) -> Result<Solid, Vec<InputError>> {
    match obstacle {
        ObstacleSpec::Polygon { polygon_m } => {
            polygon(polygon_m, &at.key("polygon_m")).map(Solid::Polygon)
        }
        ObstacleSpec::Circle { circle } => Ok(Solid::Disc(Disc {
            centre: circle.at_m,
            radius_m: circle.radius_m,
        })),
        ObstacleSpec::Map {
            map,
            at_m,
            unknown_is_occupied,
        } => {
            let unknown = match unknown_is_occupied {
                true => Unknown::Solid,
                false => Unknown::Free,
            };
            let options = MapOptions { unknown, at: *at_m };
            read_map(map, options, &at.key("map"), open).map(Solid::Map)
        }
    }
}

/// The map in a YAML file; the image that it names is beside it.
fn read_map(
    file: &str,
    options: MapOptions,
    at: &Place,
    open: Open,
) -> Result<OccupancyMap, Vec<InputError>> {
    let refusal = |why: String| vec![at.error(format!("a file that can be read: {why}"))];
    let bytes = open(file).map_err(refusal)?;
    let text = String::from_utf8(bytes).map_err(|why| refusal(why.to_string()))?;
    let folder = file.rsplit_once('/').map(|(folder, _)| folder);
    let beside = |image: &str| match folder {
        Some(folder) if !image.starts_with('/') => open(&format!("{folder}/{image}")),
        _ => open(image),
    };
    map::read(file, &text, options, beside).map_err(|errors| errors.0)
}

/// The areas of all classes of terrain.
pub(super) fn areas(
    classes: &BTreeMap<String, TerrainSpec>,
    at: &Place,
    errors: &mut Vec<InputError>,
) -> Vec<Area> {
    let mut areas = Vec::new();
    for (name, class) in classes {
        let at = at.key(name).key("areas_m");
        for (index, corners) in class.areas_m.iter().enumerate() {
            match polygon(corners, &at.item(index)) {
                Ok(polygon) => areas.push(Area::new(polygon, class)),
                Err(found) => errors.extend(found),
            }
        }
    }
    areas
}

fn polygon(corners: &[Point], at: &Place) -> Result<Polygon, Vec<InputError>> {
    Polygon::new(corners).map_err(|error| vec![at.error(error.to_string())])
}
