//! What the warden of a drive answers to pages, and the drive that a page belongs to.
#![expect(dead_code, reason = "only the schemas of these types are used")]

use base::geometry::Point;
use schemars::JsonSchema;
use std::collections::BTreeMap;

/// The state of a drive.
#[derive(JsonSchema)]
pub(crate) struct WardenState {
    /// Since the start of the drive.
    time_s: f64,
    fleet: String,
    recording: String,
    is_ending: bool,
    is_held: bool,
    /// Whether the emergency stop is latched.
    is_stopped: bool,
    operator: Option<Operator>,
    robots: Vec<WardenRobot>,
    events: Vec<WardenEvent>,
}

/// Whether the client of the request is the operator, or another one is.
#[derive(JsonSchema)]
#[schemars(rename_all = "snake_case")]
enum Operator {
    You,
    Other,
}

/// What is known of a robot.
#[derive(JsonSchema)]
struct WardenRobot {
    /// Such as `bender/0`.
    name: String,
    driver: String,
    mode: Mode,
    is_armed: bool,
    action: Action,
    /// The setpoint.
    requested: Option<RequestedMotion>,
    /// The newest motor line or lines.
    written: Option<WrittenLine>,
    /// Whether the inputs confirm a standstill.
    is_standing: bool,
    /// The fastest motion that the inputs do not exclude; null unless they confirm a standstill.
    unseen: Option<Unseen>,
    /// The ports whose values are doubted: they have to change, or to be confirmed by hand.
    doubted: Vec<String>,
    faults: Vec<FaultView>,
    latched: Vec<FaultView>,
    blockers: Vec<FaultView>,
    warnings: Vec<FaultView>,
    links: Vec<WardenLink>,
    position: Option<Position>,
    heading: Option<Heading>,
    ranges: Option<Ranges>,
    battery: Option<Battery>,
    waypoints: Vec<Waypoint>,
    navigates: bool,
}

/// Where the setpoints of a robot come from: its brain, or an operator.
#[derive(JsonSchema)]
#[schemars(rename_all = "snake_case")]
enum Mode {
    Auto,
    Manual,
}

/// What the rules decide for a robot.
#[derive(JsonSchema)]
#[schemars(rename_all = "snake_case")]
enum Action {
    Move,
    Stop,
    LatchedStop,
}

/// A motion that is requested.
#[derive(JsonSchema)]
struct RequestedMotion {
    speed_m_s: f64,
    turn_rate_rad_s: f64,
    heading_rad: Option<f64>,
}

/// A motor line.
#[derive(JsonSchema)]
struct WrittenLine {
    line: String,
    age_s: f64,
    /// Whether the robot's kernel has acknowledged it.
    is_acknowledged: bool,
}

/// The fastest motion that inputs do not exclude.
#[derive(JsonSchema)]
struct Unseen {
    speed_m_s: f64,
    /// Null without an input for headings.
    turn_rate_rad_s: Option<f64>,
}

/// A fault, with its reason in words.
#[derive(JsonSchema)]
struct FaultView {
    name: String,
    reason: String,
}

/// The connection to a port of a robot.
#[derive(JsonSchema)]
struct WardenLink {
    port: String,
    state: LinkState,
    age_s: Option<f64>,
    max_age_s: Option<f64>,
    reason: String,
}

/// The state of a connection.
#[derive(JsonSchema)]
#[schemars(rename_all = "snake_case")]
enum LinkState {
    Connecting,
    Connected,
    Lost,
}

/// The newest position. Latitude and longitude are null far from the world.
#[derive(JsonSchema)]
struct Position {
    port: String,
    x_m: f64,
    y_m: f64,
    latitude_deg: Option<f64>,
    longitude_deg: Option<f64>,
    uncertainty_m: f64,
    age_s: f64,
}

/// The newest heading.
#[derive(JsonSchema)]
struct Heading {
    port: String,
    magnetic_deg: f64,
    /// Counterclockwise from the x axis of the world.
    world_deg: f64,
    age_s: f64,
}

/// The newest ranges.
#[derive(JsonSchema)]
struct Ranges {
    port: String,
    /// Null without an echo, or without any value if it is not known.
    values_m: Vec<Option<f64>>,
    is_known: Vec<bool>,
    age_s: f64,
}

/// The charge of a battery.
#[derive(JsonSchema)]
struct Battery {
    share: f64,
    is_estimated: bool,
}

/// A waypoint or a goal of a robot. Latitude and longitude are null far from the world.
#[derive(JsonSchema)]
struct Waypoint {
    goal: String,
    x_m: f64,
    y_m: f64,
    latitude_deg: Option<f64>,
    longitude_deg: Option<f64>,
    verdict: String,
    served_by: Option<String>,
    /// Why it is not served, in words; null if it is, or may still be.
    reason: Option<String>,
}

/// An event of a drive.
#[derive(JsonSchema)]
struct WardenEvent {
    number: u64,
    time_s: f64,
    level: Level,
    robot: Option<String>,
    text: String,
}

/// How serious an event is.
#[derive(JsonSchema)]
#[schemars(rename_all = "snake_case")]
enum Level {
    Info,
    Warning,
    Error,
}

/// The drive that the page's server belongs to.
#[derive(JsonSchema)]
pub(crate) struct Drive {
    warden: Warden,
    fleet: String,
    origin: WorldOrigin,
    /// What the map draws of each robot, by name.
    robots: BTreeMap<String, RobotOnMap>,
}

/// The port of the warden on this machine, and what requests to it have to contain.
#[derive(JsonSchema)]
struct Warden {
    port: u16,
    token: String,
}

/// Where the world lies; see `[world.origin]` of a scenario.
#[expect(clippy::struct_field_names, reason = "their unit")]
#[derive(JsonSchema)]
struct WorldOrigin {
    latitude_deg: f64,
    longitude_deg: f64,
    rotation_deg: f64,
    declination_deg: f64,
}

/// What the map draws of a robot besides its state.
#[derive(JsonSchema)]
struct RobotOnMap {
    /// The corners of its fence; null if it has none.
    fence_m: Option<Vec<Point>>,
    sonars: Vec<Sonar>,
}

/// A range sensor as the map draws it.
#[derive(JsonSchema)]
struct Sonar {
    /// Its direction from the robot's heading, counterclockwise.
    facing_deg: f64,
    /// Its longest range.
    max_m: f64,
}
