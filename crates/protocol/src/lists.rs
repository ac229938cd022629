//! Entries of the lists of the server, and errors of input.

use schemars::JsonSchema;
use serde::Serialize;

/// A simulator.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Engine {
    /// Metres, seconds and joules.
    Metric,
    /// The grid simulator of 2003.
    Classic,
}

/// Where a scenario is.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Origin {
    /// Part of the program.
    Bundled,
    /// A file below the server's folder.
    Folder,
}

/// A scenario of the gallery.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ScenarioEntry {
    /// Its id.
    pub id: String,
    /// Its name.
    pub name: String,
    /// The simulator that runs it.
    pub engine: Engine,
    /// Its summary.
    pub summary: String,
    /// Where it is.
    #[serde(rename = "where")]
    pub origin: Origin,
    /// The title of its group; entries of a group follow each other.
    pub group: String,
}

/// An error of input.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct InputError {
    /// The file that contains it.
    pub file: Option<String>,
    /// The line of the file, from 1.
    pub line: Option<u32>,
    /// The keys from the root, separated by dots.
    pub path: String,
    /// The given value.
    pub value: Option<String>,
    /// What is allowed, as the end of "must be ...".
    pub allowed: String,
    /// The nearest allowed name.
    pub suggestion: Option<String>,
    /// All of this in one sentence.
    pub message: String,
}

/// A scenario that has no errors.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Checked {
    /// Its name.
    pub name: String,
    /// The simulator that runs it.
    pub engine: Engine,
    /// Its summary.
    pub summary: String,
}

/// A recording.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct RecordingEntry {
    /// Its id.
    pub id: String,
    /// The size of the file.
    pub bytes: u64,
    /// When it was saved, in seconds since 1970.
    pub saved_at_s: f64,
    /// The run; null if there is an `error`.
    pub run: Option<RecordedRun>,
    /// Why the recording cannot be opened.
    pub error: Option<String>,
}

/// The run of a recording.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct RecordedRun {
    /// The name of its scenario file.
    pub scenario: String,
    /// The seed as a decimal number.
    pub seed: String,
    /// The number of the run as a decimal number.
    pub run: String,
    /// The version that recorded it.
    pub program: String,
    /// The engine that recorded it; null if it is unknown.
    pub engine: Option<String>,
    /// Its steps; null if the file is truncated or being written.
    pub steps: Option<u64>,
    /// Its simulated time, so far if the file is being written; null if it is truncated.
    pub length_s: Option<f64>,
    /// Whether a program is still writing it.
    pub is_being_written: bool,
}

/// What the library of the page knows of an entry of a list, beside the list itself.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct LibraryEntry {
    /// Its id, as in the list of its kind.
    pub id: String,
    /// Its title; empty if it has none.
    pub title: String,
    /// Its note, of any number of lines.
    pub note: String,
    /// Its tags.
    pub tags: Vec<String>,
    /// The size of its files.
    pub bytes: u64,
    /// When its files were last written, in seconds since 1970.
    pub changed_s: f64,
    /// Whether it is part of the program: it can only be duplicated.
    pub is_bundled: bool,
    /// Why its title, note and tags cannot be read.
    pub error: Option<String>,
}

/// All entries of a kind.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct LibraryList {
    /// In the order of their ids.
    pub entries: Vec<LibraryEntry>,
}

/// An entry that was deleted, and can be restored.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Deleted {
    /// What restores it.
    pub token: String,
    /// Its kind, as in the addresses of the library.
    pub kind: String,
    /// Its id.
    pub id: String,
    /// Its title; empty if it has none.
    pub title: String,
}
