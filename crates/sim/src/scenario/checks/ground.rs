//! Checks of obstacles and terrain areas.

use crate::world::WorldSpec;
use crate::world::grid::Still;
use crate::world::obstacles::{ObstacleSpec, RepeatSpec, Solid};
use crate::world::terrain::{Area, TerrainSpec};
use base::document::Place;
use base::error::InputError;
use base::geometry::{Disc, Point, Polygon, Rectangle};
use base::map::{self, MapOptions, OccupancyMap, Unknown};
use std::collections::BTreeMap;

/// Returns the bytes of a file that a scenario names, or the reason why it cannot.
type Open<'o> = &'o dyn Fn(&str) -> Result<Vec<u8>, String>;

/// Maximum number of corners of all obstacles that are repeated: preparing them for runs takes some seconds.
const MAX_CORNERS: usize = 100_000;

/// The valid obstacles, with all their copies; reports those that are invalid, or outside the world.
pub(super) fn solids(
    world: &WorldSpec,
    at: &Place,
    open: Open,
    errors: &mut Vec<InputError>,
) -> Vec<Solid> {
    let mut solids = Vec::new();
    let mut free_corners = MAX_CORNERS;
    for (index, obstacle) in world.obstacles.iter().enumerate() {
        let at = at.key("obstacles").item(index);
        let copies = repeat_errors(obstacle, &mut free_corners, &at)
            .and_then(|()| copies(obstacle, world, &at, open));
        match copies {
            Ok(copies) => solids.extend(copies),
            Err(found) => errors.extend(found),
        }
    }
    solids
}

/// Checks the number and the spacing of copies. Reduces the number of corners that repeated obstacles
/// may still have.
fn repeat_errors(
    obstacle: &ObstacleSpec,
    free_corners: &mut usize,
    at: &Place,
) -> Result<(), Vec<InputError>> {
    let at = at.key("repeat");
    let repeat = obstacle.repeat();
    let RepeatSpec {
        columns,
        rows,
        spacing_m,
    } = repeat;
    let is_stacked = |count: u32, spacing_m: f64| count > 1 && spacing_m == 0.0;
    if is_stacked(columns, spacing_m.x) || is_stacked(rows, spacing_m.y) {
        let allowed =
            format!("other than 0 between copies: there are {columns} along x and {rows} along y");
        return Err(vec![at.key("spacing_m").error(allowed)]);
    }
    let corners = if repeat.count() > 1 {
        obstacle.corners()
    } else {
        0
    };
    *free_corners = free_corners.checked_sub(corners).ok_or_else(|| {
        let allowed =
            format!("fewer copies: all repeated obstacles together may have {MAX_CORNERS} corners");
        vec![at.error(allowed)]
    })?;
    Ok(())
}

/// All copies of an obstacle, or the errors of the first that is invalid.
fn copies(
    obstacle: &ObstacleSpec,
    world: &WorldSpec,
    at: &Place,
    open: Open,
) -> Result<Vec<Solid>, Vec<InputError>> {
    let repeat = obstacle.repeat();
    let mut solids = Vec::new();
    for copy in repeat.copies() {
        let solid = solid(obstacle, copy.shift, at, open)?;
        if !is_there(&solid, world) {
            let advice = match obstacle {
                ObstacleSpec::Map { .. } => "; at_m places a map".to_owned(),
                _ if repeat.count() > 1 => format!(
                    "; the copy in column {} and row {} is not",
                    copy.column, copy.row
                ),
                _ => String::new(),
            };
            return Err(vec![at.error(where_obstacles_are(world) + &advice)]);
        }
        solids.push(solid);
    }
    Ok(solids)
}

/// Whether an obstacle is where obstacles may be.
fn is_there(solid: &Solid, world: &WorldSpec) -> bool {
    let rectangle = rectangle(world);
    let [least, greatest] = solid.bounds();
    if world.periodic {
        rectangle.contains(least) && rectangle.contains(greatest)
    } else {
        rectangle.overlaps(&Rectangle::spanned(least, greatest))
    }
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

/// The copy of an obstacle at `shift`.
fn solid(
    obstacle: &ObstacleSpec,
    shift: Point,
    at: &Place,
    open: Open,
) -> Result<Solid, Vec<InputError>> {
    let shifted = |corners: &[Point]| -> Vec<Point> {
        corners.iter().map(|corner| corner.plus(shift)).collect()
    };
    match obstacle {
        ObstacleSpec::Polygon { polygon_m, .. } => {
            polygon(&shifted(polygon_m), &at.key("polygon_m")).map(Solid::Polygon)
        }
        ObstacleSpec::Rectangle { rectangle, .. } => {
            let mut rectangle = *rectangle;
            rectangle.at_m = rectangle.at_m.plus(shift);
            polygon(&rectangle.corners(), &at.key("rectangle")).map(Solid::Polygon)
        }
        ObstacleSpec::Circle { circle, .. } => Ok(Solid::Disc(Disc {
            centre: circle.at_m.plus(shift),
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
