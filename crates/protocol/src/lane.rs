//! The mined lane of a run, as the page displays it.

use base::geometry::Point;
use brain::MarkVerdict;
use schemars::JsonSchema;
use serde::Serialize;

/// The mined lane of a run, sent only of runs whose controllers are to clear one.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Lanes {
    /// The current tick.
    pub tick: u64,
    /// The truth: number of mines in the lane that are not destroyed.
    pub mines_left: u32,
    /// The truth: the vehicles that pass the lane; none before it is declared clear.
    pub vehicles: Vec<VehicleView>,
    /// What each controller believes of the lane, in the order of their kinds and indices.
    pub lanes: Vec<LaneView>,
}

/// What a controller believes of a lane.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct LaneView {
    /// The name of the controller, KIND/INDEX.
    pub controller: String,
    /// The lower left and the upper right corner of the lane.
    pub corners: [Point; 2],
    /// The side of a cell.
    pub cell_m: f64,
    /// Columns of cells.
    pub columns: u32,
    /// Rows of cells.
    pub rows: u32,
    /// Base64 of one byte per cell, the lowest row first: expected mines per full cell, on the scale below. Cells that
    /// reach beyond the lane are scaled by their area.
    pub expected: String,
    /// The scale of these bytes.
    pub scale: LaneScale,
    /// The places that robots have marked.
    pub marks: Vec<MarkView>,
    /// The remaining risk.
    pub risk: RiskView,
    /// The lane is declared clear when the probability that at least one mine is left is below this.
    pub declare_below: f64,
    /// What the controller has stated about the lane; null until then.
    pub statement: Option<LaneStatementView>,
    /// The share of the mines that are cleared, for each kind that makes the lane unsafe.
    pub cleared: Vec<ClearedView>,
    /// The path on which vehicles are to pass; null until the controller has stated one.
    pub passage: Option<PassageView>,
}

/// A logarithmic scale of bytes: byte `b` stands for up to `min x (max / min)^(b / 255)`, and more than a byte less. 0 also
/// stands for less than `min`, and 255 for more than `max`.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct LaneScale {
    /// The value of byte 0.
    pub min: f64,
    /// The value of byte 255.
    pub max: f64,
    /// Cells with up to this byte are cleared: if all cells were like them, the lane would be declared clear.
    pub cleared: u8,
}

/// A place that robots have marked, as a controller believes it to be.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct MarkView {
    /// Its number, which never changes.
    pub number: u32,
    /// Its position.
    pub at: Point,
    /// Standard deviation of the position along each axis.
    pub deviation_m: f64,
    /// Probability that it holds a mine that has not been neutralised.
    pub mine: f64,
    /// The last statement about it; null if there is none.
    pub verdict: Option<MarkVerdict>,
    /// Number of charges that have gone off there and destroyed nothing.
    pub failed_charges: u32,
}

/// The remaining risk of a lane, as a controller believes it to be.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct RiskView {
    /// Expected number of mines without a mark.
    pub unmarked: f64,
    /// Expected number of mines at marks.
    pub marked: f64,
    /// Probability that at least one mine is left in the lane.
    pub probability: f64,
}

/// What a controller has stated about a lane.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct LaneStatementView {
    /// Whether it has declared the lane clear; otherwise it has given it up.
    pub is_clear: bool,
    /// The probability that at least one mine is left, at that time.
    pub risk: f64,
    /// That time, on its clock.
    pub at_s: f64,
}

/// The share of the mines of a kind that are cleared, as a controller believes it to be.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ClearedView {
    /// The kind of items.
    pub kind: String,
    /// Expected number of mines that have been neutralised.
    pub cleared: f64,
    /// Expected number of mines that are left.
    pub left: f64,
    /// Mean of the share that is cleared, 0 to 1.
    pub share: f64,
    /// Lower end of the interval that contains the share with a probability of at least 95%.
    pub low: f64,
    /// Its upper end.
    pub high: f64,
}

/// A path through a lane, and the risk of the vehicles that drive on it.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct PassageView {
    /// The corners of its middle line, from one short side of the lane to the other.
    pub path: Vec<Point>,
    /// Its width.
    pub width_m: f64,
    /// Its length.
    pub length_m: f64,
    /// Expected number of mines within its width.
    pub mines: f64,
    /// The probability that each vehicle is destroyed, in their order.
    pub risks: Vec<f64>,
}

/// A vehicle that passes a lane.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct VehicleView {
    /// Its name, vehicle/INDEX.
    pub name: String,
    /// Its position; the beginning of the path before it has entered the lane.
    pub at: Point,
    /// Whether it has entered the lane.
    pub has_entered: bool,
    /// What has become of it.
    pub status: VehicleStatus,
}

/// What has become of a vehicle that passes a lane.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum VehicleStatus {
    /// It is before the path, or on it.
    Driving,
    /// It has reached the other end of the lane.
    Passed,
    /// A mine has destroyed it.
    Lost,
}
