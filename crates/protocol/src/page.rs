//! Messages from the page to the server of a run.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A message of the page.
///
/// `open`, `step`, `seek` and `undo` move the run to a tick, which can take a while. A message that
/// changes the run meanwhile is executed on arrival; `pause`, `seek` and `open` take effect
/// immediately.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(tag = "type", rename_all = "snake_case")]
pub enum PageMessage {
    /// Open a run, paused at a tick.
    Open(Open),
    /// Play the run.
    Play(Play),
    /// Pause the run.
    Pause {},
    /// Take steps, and pause.
    Step(Step),
    /// Move to a tick, and pause there.
    Seek(Seek),
    /// Set a value of the scenario from now on.
    Change(Change),
    /// Return to the version in which the last change was made: the run is at the same tick as if the change had not
    /// been made.
    Undo {},
    /// Return to the version that was left by the last `undo`.
    Redo {},
    /// Display a version of the run, at the same tick.
    ChooseVersion(ChooseVersion),
    /// Save the run up to its latest tick as a recording.
    Save {},
    /// Cancel the recording that is being saved.
    CancelSave {},
    /// Request the scenario as it is now.
    Export {},
    /// Select the robot that states and maps describe.
    Select(Select),
    /// Select what is sent with frames.
    Show(Show),
    /// Request the outcome over time.
    RequestSeries(SeriesRequest),
    /// Select the signals that are sampled.
    Chart(Chart),
    /// Acknowledge that a frame has been drawn, and all before it. At most three frames are not
    /// acknowledged.
    Acknowledge(Acknowledge),
}

/// A message without content.
#[derive(Debug, Clone, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Empty {}

/// Which run to open; exactly one of `scenario`, `text`, `study`, `recording` and `live` is given.
#[derive(Debug, Clone, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Open {
    /// A scenario by its id in the gallery.
    pub scenario: Option<String>,
    /// The text of a scenario, TOML.
    pub text: Option<String>,
    /// A configuration of a study; the run is the same as in the study.
    pub study: Option<StudyMember>,
    /// A recording by its id.
    pub recording: Option<String>,
    /// Whether to join the live run of the server, at the present. All pages share it: it can neither be
    /// moved nor changed.
    pub live: bool,
    /// The seed as a decimal number; by default that of the study, or 0. A recording has its own.
    #[schemars(regex(pattern = r"^[0-9]{1,20}$"))]
    pub seed: Option<String>,
    /// The number of the run as a decimal number; 0 by default. A recording has its own.
    #[schemars(regex(pattern = r"^[0-9]{1,20}$"))]
    pub run: Option<String>,
    /// Changes to make when the run reaches their ticks; by default those of the recording.
    pub changes: Option<Vec<LoggedChange>>,
    /// The tick to move to.
    #[schemars(range(min = 0, max = 9_007_199_254_740_992_u64))]
    pub tick: u64,
}

/// A configuration of a study.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StudyMember {
    /// The id of the study.
    pub id: String,
    /// The index of the configuration.
    #[schemars(range(min = 0, max = 9_007_199_254_740_992_u64))]
    pub configuration: u64,
}

/// A change of the scenario: the tick, the path and the new value.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LoggedChange(pub u64, pub String, pub Json);

/// Any value of JSON.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Json(pub serde_json::Value);

/// The playback speed.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Play {
    /// A multiple of real time; null for as fast as possible.
    #[schemars(range(min = 0.01, max = 100_000.0))]
    pub speed: Option<f64>,
}

/// Steps to take.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Step {
    /// Steps forward, or backward if negative.
    #[schemars(range(min = -9_007_199_254_740_992_i64, max = 1_000_000))]
    pub steps: i64,
}

impl Default for Step {
    fn default() -> Self {
        Self { steps: 1 }
    }
}

/// The tick to move to.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Seek {
    /// The tick.
    #[schemars(range(min = 0, max = 9_007_199_254_740_992_u64))]
    pub tick: u64,
}

/// A new value of the scenario.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Change {
    /// The keys from the root, separated by dots, such as `clock.time_limit_s`.
    pub path: String,
    /// A value as in the scenario file.
    pub value: Json,
    /// Whether it replaces the last change of this path if the run has not advanced since then, as
    /// when a slider is dragged.
    #[serde(default)]
    pub replaces_last: bool,
}

/// The version to display.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ChooseVersion {
    /// Its number.
    #[schemars(range(min = 0, max = 9_007_199_254_740_992_u64))]
    pub version: u64,
}

/// The signals that are sampled; initially none.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Chart {
    /// Their ids: those that the setting offers, and `robot/NAME/PATH`, a number in the inspection of a robot.
    #[schemars(length(max = 16), inner(length(max = 200)))]
    pub signals: Vec<String>,
}

/// The selected robot.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Select {
    /// Its name, KIND/INDEX; null for none.
    pub robot: Option<String>,
}

/// What is sent with frames; initially nothing.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Show {
    /// Ids of layers that the setting offers; and `links`, radio links between robots, and `footprints`, the areas that
    /// sensors cover.
    #[schemars(length(max = 100), inner(length(max = 100)))]
    pub layers: Vec<String>,
    /// Ids of panels that the setting offers.
    #[serde(default)]
    #[schemars(length(max = 100), inner(length(max = 100)))]
    pub panels: Vec<String>,
    /// What has been chosen in panels and with markers, by key.
    #[serde(default)]
    pub choices: BTreeMap<String, String>,
}

/// The part of the outcome over time that the page does not have.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SeriesRequest {
    /// The first tick of that part.
    #[schemars(range(min = 0, max = 9_007_199_254_740_992_u64))]
    pub since: u64,
}

/// A frame that has been drawn.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Acknowledge {
    /// The number of the frame.
    #[schemars(range(min = 0, max = 9_007_199_254_740_992_u64))]
    pub frame: u64,
}
