//! The setting in which the frames of a run are drawn.

use crate::page::{Json, LoggedChange};
use crate::shown::Offer;
use crate::timeline::VersionView;
use base::document::schema::Parameter;
use base::geometry::Point;
use schemars::JsonSchema;
use serde::Serialize;
use std::collections::BTreeMap;

/// Everything that stays the same from frame to frame until the scenario changes.
///
/// Lengths are in the unit of the world; y points up.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Setting {
    /// Frames name the generation of the setting that they are drawn in.
    pub generation: u64,
    /// The simulated duration of a step.
    pub step_s: f64,
    /// The scenario, with all defaults.
    pub document: BTreeMap<String, Json>,
    /// The numbers, switches and choices of the scenario.
    pub parameters: Vec<Parameter>,
    /// The names of the robots, in the order of frames.
    pub robots: Vec<String>,
    /// The names of the robots that had external bodies from the start, such as real robots.
    pub external: Vec<String>,
    /// The changes up to now.
    pub changes: Vec<LoggedChange>,
    /// The changes up to the latest tick; null if they are those of the recording.
    pub log: Option<Vec<LoggedChange>>,
    /// The versions of the run, in the order of their numbers.
    pub versions: Vec<VersionView>,
    /// The number of the version that is displayed.
    pub version: u64,
    /// Whether an undo can be redone.
    pub can_redo: bool,
    /// The world.
    pub world: WorldView,
    /// The robot kinds.
    pub kinds: Vec<KindView>,
    /// The items.
    pub items: Vec<ItemView>,
    /// The item kinds, in the order of the indices in percepts.
    pub item_kinds: Vec<String>,
    /// Obstacles other than maps, with all copies.
    pub obstacles: Vec<ObstacleView>,
    /// Maps of obstacles.
    pub maps: Vec<MapView>,
    /// What pages can show of the run besides.
    pub offer: Offer,
}

/// The unit of a world.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub enum Unit {
    /// Metres.
    #[serde(rename = "m")]
    Metres,
    /// Pixels of the window of the classic simulator.
    #[serde(rename = "px")]
    Pixels,
}

/// The world of a run.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct WorldView {
    /// Its width and height.
    pub size: Point,
    /// Whether opposite borders are connected.
    pub periodic: bool,
    /// The unit of all lengths.
    pub unit: Unit,
    /// The side of its cells; null if it has none.
    pub cell: Option<f64>,
}

/// A robot kind.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct KindView {
    /// Its name.
    pub name: String,
    /// The number of robots.
    pub count: u32,
    /// The radius of the body.
    pub radius: f64,
    /// Whether it flies over obstacles.
    pub is_flying: bool,
    /// The range of its radio; null if it has none.
    pub radio_range_m: Option<f64>,
    /// The areas that its sensors cover.
    pub sensors: Vec<SensorView>,
    /// Its range rings, in the order of the scans in percepts.
    pub rings: Vec<RingView>,
}

/// The sector that a sensor covers.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct SensorView {
    /// The name of the sensor.
    pub name: String,
    /// The kind of the sensor.
    pub kind: String,
    /// Its range.
    pub range_m: f64,
    /// The angle of the sector.
    pub width_rad: f64,
    /// The middle of the sector, from the front of the robot.
    pub facing_rad: f64,
}

/// The rays of a range ring.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct RingView {
    /// The bearing of each ray, from the front of the robot.
    pub bearings_rad: Vec<f64>,
    /// Its range.
    pub range_m: f64,
}

/// An item.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ItemView {
    /// The name of its kind.
    pub kind: String,
    /// Its position.
    pub at: Point,
    /// Whether the robots search for it.
    pub target: bool,
    /// Outlines of the places from which a robot finds it, if there are any.
    pub contact: Vec<Vec<Point>>,
}

/// An obstacle other than a map: a polygon or a circle.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ObstacleView {
    /// Its index in `world.obstacles` of the scenario; copies of a shape have the same.
    pub entry: u32,
    /// Its corners; null if it is a circle.
    pub polygon: Option<Vec<Point>>,
    /// The circle; null if it is a polygon.
    pub circle: Option<CircleView>,
}

/// A circle.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct CircleView {
    /// Its centre.
    pub at: Point,
    /// Its radius.
    pub radius: f64,
}

/// An obstacle map.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct MapView {
    /// Its corners, anticlockwise; the first row is between the first two.
    pub corners: [Point; 4],
    /// Columns.
    pub columns: u32,
    /// Rows.
    pub rows: u32,
    /// Base64 of one byte per cell: 0 free, 1 unknown, 2 occupied.
    pub cells: String,
}
