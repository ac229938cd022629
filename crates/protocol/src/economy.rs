//! The goals and controllers of a run, as the page displays them.

use base::geometry::Point;
use brain::Verdict;
use schemars::JsonSchema;
use serde::Serialize;

/// The goals and controllers of a run, sent only of runs that have any.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Economy {
    /// The current tick.
    pub tick: u64,
    /// All goals, in the order of their kinds and indices.
    pub goals: Vec<GoalView>,
    /// All controllers, in the order of their kinds and indices.
    pub controllers: Vec<ControllerView>,
    /// The selected robot, and the goals that it serves; null if there is no such robot.
    pub service: Option<ServiceView>,
}

/// A goal of a run.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct GoalView {
    /// Its name, KIND/INDEX.
    pub name: String,
    /// Its position.
    pub at: Point,
    /// Its status.
    pub status: GoalStatus,
    /// The name of the controller that owns it; null if none does.
    pub owner: Option<String>,
    /// The name of the controller that inherits it; null if none does.
    pub heir: Option<String>,
    /// The name of the robot that it is awarded to, or that served it.
    pub robot: Option<String>,
    /// Remaining time of that robot's lease, on the owner's clock; null if it has none.
    pub lease_s: Option<f64>,
    /// Why no robot can serve it at present; null if one can.
    pub unserved: Option<String>,
}

/// The status of a goal of a run.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum GoalStatus {
    /// It has not arrived.
    Pending,
    /// It is awarded to no robot.
    Open,
    /// It is awarded to a robot.
    Awarded,
    /// It was served.
    Served,
    /// Its deadline is over.
    Expired,
}

/// A controller of a run.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ControllerView {
    /// Its name, KIND/INDEX.
    pub name: String,
    /// Its position.
    pub at: Point,
    /// The name of the robot that carries it; null if its position is fixed.
    pub aboard: Option<String>,
    /// Range of its radio.
    pub range_m: f64,
    /// Whether it sends and receives.
    pub is_working: bool,
    /// Number of goals that it refused.
    pub refused: u32,
    /// Names of goals that it owned until their lease ended.
    pub orphans: Vec<String>,
}

/// A robot and the goals of controllers that it serves.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ServiceView {
    /// The name of the robot, KIND/INDEX.
    pub robot: String,
    /// The goals, in the order in which it serves them.
    pub goals: Vec<ServedGoalView>,
}

/// A goal that a robot serves.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ServedGoalView {
    /// Its name, KIND/INDEX; null if it is not of the scenario.
    pub goal: Option<String>,
    /// Its position.
    pub at: Point,
    /// The name of the controller that awarded it.
    pub owner: String,
    /// Remaining time of the lease, on the robot's clock.
    pub lease_s: f64,
    /// Its state, as the robot knows it.
    pub verdict: Verdict,
}
