//! What pages show of a run beside its frames, as data: layers of the view, and panels of text and tables.
//!
//! The server makes them, each subject in a file of its own. The page draws every layer with one painter, every key of a legend
//! with one component and every panel with another, and knows no subject.

use base::geometry::Point;
use schemars::JsonSchema;
use serde::Serialize;
use std::collections::BTreeMap;

/// What pages can show of a run; part of its setting.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Offer {
    /// Layers of the view, from bottom to top.
    pub layers: Vec<LayerOffer>,
    /// Panels, in the order of their tabs.
    pub panels: Vec<PanelOffer>,
    /// Kinds of events.
    pub events: Vec<EventKind>,
    /// Numbers that can be drawn over time.
    pub signals: Vec<SignalOffer>,
    /// The same of each robot: in their ids, `{robot}` stands for its name.
    pub robot_signals: Vec<SignalOffer>,
    /// The columns of the outcome that apply to the scenario, in the order in which they are displayed: first those that answer
    /// its question.
    pub columns: Vec<ColumnOffer>,
}

/// A column of the outcome, as pages display it.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ColumnOffer {
    /// Its name in outcomes.
    pub id: String,
    /// Its label.
    pub label: String,
    /// Its unit; empty without one. Values of the unit % are shares, 0 to 1.
    pub unit: String,
    /// The group that it is displayed in.
    pub group: String,
    /// What it is, in a sentence.
    pub help: String,
    /// Whether it is one of those that answer the question of the scenario.
    pub is_first: bool,
    /// When its value is known.
    pub known: Known,
    /// Columns of which one must be true, or above 0, before its value is known; empty for none.
    pub after: Vec<String>,
    /// The column of the event whose time it is, which is displayed in the place of that event; null for none.
    pub time_of: Option<String>,
    /// The columns whose sum is the number of all, of which it counts some; empty for none.
    pub out_of: Vec<String>,
    /// The number of all, if that is the same in all runs; null if not.
    pub all: Option<u32>,
}

/// When the value of a column is known.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Known {
    /// At any time: it counts what has happened.
    Always,
    /// At the end of the run; until then the simulated time is displayed.
    Clock,
    /// At the end of the run.
    AtEnd,
    /// At the end of the run, and displayed only if it is true.
    Reason,
}

/// A layer that pages can show.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct LayerOffer {
    /// Its name in messages.
    pub id: String,
    /// The label of its switch.
    pub label: String,
    /// Whether it is shown at first.
    pub is_on: bool,
    /// Where it is drawn.
    pub place: LayerPlace,
    /// The heading of its keys in the legend; layers with the same heading are under it together.
    pub heading: String,
    /// The keys of the legend.
    pub keys: Vec<Key>,
}

/// Where a layer is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LayerPlace {
    /// Below the grid.
    Ground,
    /// Below obstacles, items and robots.
    Below,
    /// Above the robots.
    Above,
}

/// An entry of the legend: a sample, drawn as on the canvas, and its meaning.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Key {
    /// The meaning.
    pub label: String,
    /// Glyphs, from back to front.
    pub glyphs: Vec<Glyph>,
    /// A line.
    pub line: Option<Stroke>,
    /// An area.
    pub area: Option<Fill>,
    /// The outline of that area.
    pub outline: Option<Stroke>,
}

/// A panel that pages can show.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct PanelOffer {
    /// Its name in messages.
    pub id: String,
    /// The label of its tab, or its heading.
    pub label: String,
    /// Whether it is about the selected robot, and stands with what else is known of that.
    pub is_of_robot: bool,
}

/// A kind of events that can happen in a run.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct EventKind {
    /// Its name in messages.
    pub id: String,
    /// Its label.
    pub label: String,
    /// The colour of its marks.
    pub colour: Colour,
    /// Whether it is shown at first.
    pub is_on: bool,
}

/// A number that can be drawn over time.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct SignalOffer {
    /// Its name in messages.
    pub id: String,
    /// What it is.
    pub label: String,
    /// Its unit; empty without one.
    pub unit: String,
    /// What it is a number of, such as the name of a controller.
    pub of: String,
}

/// The layers and panels that a page has requested.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Shown {
    /// The current tick.
    pub tick: u64,
    /// The layers by id.
    pub layers: BTreeMap<String, Layer>,
    /// The panels by id.
    pub panels: BTreeMap<String, Panel>,
}

/// A name of a colour of the page, of which each theme has its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Colour {
    Accent,
    Border,
    Cleared,
    Ground,
    ItemFound,
    ItemMissed,
    Muted,
    #[serde(rename = "owner-1")]
    Owner1,
    #[serde(rename = "owner-2")]
    Owner2,
    #[serde(rename = "owner-3")]
    Owner3,
    #[serde(rename = "owner-4")]
    Owner4,
    #[serde(rename = "owner-5")]
    Owner5,
    #[serde(rename = "owner-6")]
    Owner6,
    #[serde(rename = "risk-1")]
    Risk1,
    #[serde(rename = "risk-2")]
    Risk2,
    #[serde(rename = "risk-3")]
    Risk3,
    #[serde(rename = "risk-4")]
    Risk4,
    #[serde(rename = "risk-5")]
    Risk5,
    RobotBroken,
    RobotCollided,
    RobotWarning,
    Text,
}

/// A layer: its parts are drawn in this order.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Layer {
    /// The lower left and the upper right corner of the box to which raster and lines are clipped; null for none.
    pub clip: Option<[Point; 2]>,
    /// A raster.
    pub raster: Option<Raster>,
    /// Areas.
    pub areas: Vec<Area>,
    /// Lines.
    pub lines: Vec<Line>,
    /// The symbols of markers: each has glyphs, from back to front.
    pub symbols: Vec<Vec<Glyph>>,
    /// Markers.
    pub markers: Vec<Marker>,
}

/// A raster of square cells.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Raster {
    /// Its lower left corner.
    pub corner: Point,
    /// The side of a cell.
    pub cell: f64,
    /// Columns.
    pub columns: u32,
    /// Rows.
    pub rows: u32,
    /// Base64 of one byte per cell, the lowest row first.
    pub cells: String,
    /// The colours of the bytes.
    pub scale: Scale,
}

/// The colours of the bytes of a raster.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Scale {
    /// What the bytes are, with the unit.
    pub label: String,
    /// The byte with the first colour; lower ones have it, too.
    pub first: u8,
    /// The byte with the last colour; higher ones have it, too.
    pub last: u8,
    /// The colours, evenly distributed between these bytes.
    pub colours: Vec<Colour>,
    /// Labels of places on the scale.
    pub ticks: Vec<ScaleTick>,
}

/// A label of a scale.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ScaleTick {
    /// The label.
    pub label: String,
    /// Its place, 0 for the first colour to 1 for the last.
    pub place: f64,
}

/// A stroke.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Stroke {
    /// Its colour.
    pub colour: Colour,
    /// Its width in pixels.
    pub width_px: f64,
    /// Whether it is dashed.
    pub is_dashed: bool,
}

/// A fill.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Fill {
    /// Its colour.
    pub colour: Colour,
    /// Its opacity, 0 to 1.
    pub opacity: f64,
}

/// An area: a polygon or a circle.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Area {
    /// Its corners; empty for a circle.
    pub polygon: Vec<Point>,
    /// The circle; null for a polygon.
    pub circle: Option<Circle>,
    /// The inside; null if it is not filled.
    pub fill: Option<Fill>,
    /// The outline; null if it has none.
    pub outline: Option<Stroke>,
    /// The opacity of all of it, 0 to 1.
    pub opacity: f64,
}

/// A circle in the world.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Circle {
    /// Its centre.
    pub at: Point,
    /// The robot that carries the centre, between two messages; null for none.
    pub robot: Option<String>,
    /// Its radius.
    pub radius: f64,
}

/// A line.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Line {
    /// Its points; only the last one, if it begins at a robot.
    pub points: Vec<Point>,
    /// The robot at which it begins, which stands out while that is selected; null for none. In a periodic world, the line is
    /// the shortest to the end.
    pub robot: Option<String>,
    /// The stroke.
    pub stroke: Stroke,
    /// A band of this width below the stroke, in units of the world, of the same colour; null for none.
    pub band: Option<f64>,
    /// The opacity, 0 to 1.
    pub opacity: f64,
}

/// A marker at a place, as large at every zoom.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Marker {
    /// The place.
    pub at: Point,
    /// The robot that carries it, between two messages; null for none.
    pub robot: Option<String>,
    /// The index of its symbol.
    pub symbol: u32,
    /// A label on the right; null for none.
    pub label: Option<String>,
    /// The opacity, 0 to 1.
    pub opacity: f64,
    /// What a click on it chooses; null for nothing.
    pub chooses: Option<Choose>,
}

/// A shape around a place.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Glyph {
    /// The shape.
    pub shape: Shape,
    /// Its radius in pixels.
    pub radius_px: f64,
    /// Its radius in units of the world, if that is larger; null for none.
    pub radius: Option<f64>,
    /// The inside; null if it is not filled.
    pub fill: Option<Fill>,
    /// The outline; null if it has none.
    pub outline: Option<Stroke>,
    /// Whether the outline has a rim in the colour of the ground, to stand out.
    pub has_rim: bool,
}

/// The shape of a glyph.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Shape {
    /// A circle.
    Circle,
    /// A triangle with a corner at the top.
    Triangle,
    /// A square with a corner at the top.
    Diamond,
    /// A square.
    Square,
    /// A hexagon.
    Hexagon,
    /// Two crossed lines.
    Cross,
    /// A tick: done.
    Tick,
}

/// A value that a click chooses, or takes back if it is chosen.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Choose {
    /// What is chosen; the page sends it back in `choices`.
    pub key: String,
    /// The value.
    pub value: String,
    /// The panel that shows the consequence.
    pub panel: String,
}

/// A panel: its sections.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Panel {
    /// What its heading counts; null for nothing.
    pub note: Option<String>,
    /// The sections.
    pub sections: Vec<Section>,
}

/// A section of a panel.
#[derive(Debug, Clone, Default, Serialize, JsonSchema)]
pub struct Section {
    /// Its heading; null for none.
    pub heading: Option<String>,
    /// A choice before everything else.
    pub choice: Option<Choice>,
    /// The switch of a layer without which the rest of the section is hidden; null for none.
    pub switch: Option<Switch>,
    /// Paragraphs.
    pub paragraphs: Vec<Paragraph>,
    /// A button that changes the scenario; null for none.
    pub button: Option<Button>,
    /// A filter of the rows of the table; null for none.
    pub filter: Option<Filter>,
    /// A table; null for none.
    pub table: Option<Table>,
    /// The heading of the part of the legend at its end; null for none.
    pub legend: Option<String>,
}

/// A filter of the rows of a table. What is entered is sent back in `choices`: the server filters, so that each row of a
/// table can be reached, however long it is.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Filter {
    /// The label of the search field.
    pub label: String,
    /// The key of the search words, all of which a row contains.
    pub words_key: String,
    /// The key of the ids of the kinds of rows that are hidden, separated by commas.
    pub hidden_key: String,
    /// The kinds of rows that there are.
    pub kinds: Vec<FilterKind>,
    /// The number of rows that pass the filter, and of all rows.
    pub passed: [u32; 2],
}

/// A kind of rows, which can be hidden.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct FilterKind {
    /// Its id.
    pub id: String,
    /// Its label.
    pub label: String,
    /// The number of its rows.
    pub count: u32,
    /// Whether they are shown.
    pub is_on: bool,
}

/// A choice among names.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Choice {
    /// What is chosen; the page sends it back in `choices`.
    pub key: String,
    /// The label.
    pub label: String,
    /// The names.
    pub options: Vec<String>,
    /// The name that is chosen.
    pub chosen: String,
}

/// The switch of a layer in a panel.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Switch {
    /// The id of the layer.
    pub layer: String,
    /// Its label.
    pub label: String,
}

/// A paragraph.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Paragraph {
    /// The text.
    pub text: String,
    /// How it stands out.
    pub emphasis: Emphasis,
}

/// How words stand out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Emphasis {
    /// Not at all.
    Plain,
    /// It is the statement that counts.
    Strong,
    /// It explains.
    Muted,
}

/// A button that sets a switch of the scenario; runs that cannot be changed do not show it.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Button {
    /// The label.
    pub label: String,
    /// The path of the switch.
    pub path: String,
}

/// A table.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Table {
    /// The columns; empty for a table without a head, of labels and numbers.
    pub columns: Vec<Column>,
    /// The rows that are shown.
    pub rows: Vec<Row>,
    /// The number of all rows.
    pub total: u32,
}

/// A column of a table.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Column {
    /// Its head.
    pub label: String,
    /// Whether it has numbers, which stand on the right.
    pub is_number: bool,
}

/// A row of a table.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Row {
    /// A cell per column.
    pub cells: Vec<Cell>,
    /// A line below it; null for none.
    pub note: Option<String>,
    /// The ids of signals that it displays, which are drawn over time on request.
    pub signals: Vec<String>,
    /// The place that it is about, which pages mark in the view on request; null for none.
    pub at: Option<Point>,
}

/// A cell of a table.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Cell {
    /// The text.
    pub text: String,
    /// Smaller words after it; empty for none.
    pub note: String,
    /// The colour of a patch before it; null for none.
    pub colour: Option<Colour>,
    /// What a click on it chooses; null for nothing.
    pub chooses: Option<Choose>,
    /// Whether that is chosen.
    pub is_chosen: bool,
}
