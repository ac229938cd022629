//! The YAML file of a map, and the meaning of its pixels and coordinates.

use super::pixel::Pixel;
use crate::document::{Document, Section, Value};
use crate::error::{InputError, InputErrors, nearest};
use crate::geometry::Point;
use crate::hashed::Hashed;
use crate::trig;

const KEYS: [&str; 7] = [
    "image",
    "resolution",
    "origin",
    "negate",
    "occupied_thresh",
    "free_thresh",
    "mode",
];

/// All of them but for `mode`.
const REQUIRED: &[&str] = KEYS.split_at(6).0;

/// Conversion of pixels to occupancies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Mode {
    Trinary,
    Scale,
    Raw,
}

const MODES: [(&str, Mode); 3] = [
    ("trinary", Mode::Trinary),
    ("scale", Mode::Scale),
    ("raw", Mode::Raw),
];

/// The contents of the YAML file.
#[derive(Debug, Clone, PartialEq, Hashed)]
pub(super) struct Settings {
    /// Name of the image, as written.
    #[hashed(skip)]
    pub(super) image: String,
    /// Side of a pixel, in metres.
    pub(super) resolution_m: f64,
    /// Origin of the image's name, for errors.
    #[hashed(skip)]
    source: String,
    /// Lower left corner.
    origin: Point,
    /// Sine and cosine of the yaw.
    turn: (f64, f64),
    #[hashed(skip)]
    is_negated: bool,
    occupied_threshold: f64,
    free_threshold: f64,
    #[hashed(skip)]
    mode: Mode,
}

// The others decide how the image is read, and its cells contain the result.

pub(super) fn read(file: &str, text: &str) -> Result<Settings, InputErrors> {
    Document::parse_yaml(file, text)?.read(|root| {
        report_misspelt(root);
        let image = root.line("image");
        let resolution_m = root.number("resolution", 1e-4..=100.0);
        let pose = pose(root);
        let is_negated = is_negated(root);
        let thresholds = thresholds(root);
        let mode = if root.has("mode") {
            root.choice("mode", &MODES)
        } else {
            Some(Mode::Trinary)
        };
        let (origin, yaw_rad) = pose?;
        let (free_threshold, occupied_threshold) = thresholds?;
        Some(Settings {
            image: image?,
            resolution_m: resolution_m?,
            source: root.origin("image").to_owned(),
            origin,
            turn: trig::sin_cos(yaw_rad),
            is_negated: is_negated?,
            occupied_threshold,
            free_threshold,
            mode: mode?,
        })
    })
}

/// Reports the keys that are nearly one that is missing. Other keys of maps differ between programs, and
/// `map_server` ignores them.
fn report_misspelt(root: &Section) {
    for key in root.keys().filter(|key| !KEYS.contains(key)) {
        let missing = REQUIRED.iter().copied().filter(|known| !root.has(known));
        if nearest(key, missing).is_some() {
            root.report_unknown(key, &KEYS);
        }
    }
}

fn pose(root: &Section) -> Option<(Point, f64)> {
    let numbers = root.numbers("origin", -1e6..=1e6)?;
    if let [x, y, yaw_rad] = numbers[..] {
        return Some((Point { x, y }, yaw_rad));
    }
    root.error(
        "origin",
        "a list of three numbers: x and y in metres, yaw in radians",
    );
    None
}

fn is_negated(root: &Section) -> Option<bool> {
    match root.value("negate") {
        Some(Value::Bool(value)) => Some(*value),
        Some(Value::Integer(value @ 0..=1)) => Some(*value == 1),
        _ => {
            root.error("negate", "0, 1, false or true");
            None
        }
    }
}

/// The free and the occupied threshold.
fn thresholds(root: &Section) -> Option<(f64, f64)> {
    let free = root.number("free_thresh", 0.0..=1.0);
    let occupied = root.number("occupied_thresh", 0.0..=1.0);
    let (free, occupied) = (free?, occupied?);
    if free >= occupied {
        root.error(
            "free_thresh",
            &format!("a number below occupied_thresh, which is {occupied:?}"),
        );
        return None;
    }
    Some((free, occupied))
}

impl Settings {
    /// The same with the lower left corner of the image at another place, if there is one.
    pub(super) fn placed(self, at: Option<Point>) -> Self {
        let origin = at.unwrap_or(self.origin);
        Self { origin, ..self }
    }

    /// The lower left corner of the image.
    pub(super) fn origin(&self) -> Point {
        self.origin
    }

    /// The error that the image cannot be used.
    pub(super) fn image_error(&self, why: &str) -> InputError {
        let value = Some(format!("{:?}", self.image));
        let allowed = format!("the name of a PGM or PNG image; {why}");
        InputError {
            origin: Some(self.source.clone()),
            ..InputError::new("image".to_owned(), value, allowed)
        }
    }

    /// Occupancy of a pixel: 0 to 100, or -1.
    pub(super) fn occupancy(&self, pixel: Pixel) -> i8 {
        if self.mode == Mode::Scale && !pixel.is_opaque() {
            return -1;
        }
        let (shade, white) = match self.mode {
            Mode::Trinary => pixel.brightness_with_opacity(),
            Mode::Scale | Mode::Raw => pixel.brightness(),
        };
        let (shade, white) = (f64::from(shade), f64::from(white));
        if self.mode == Mode::Raw {
            let raw = (255.0 * shade / white).round();
            return if raw <= 100.0 { percent(raw) } else { -1 };
        }
        let dark = if self.is_negated {
            shade
        } else {
            white - shade
        };
        let occupancy = dark / white;
        let (free, occupied) = (self.free_threshold, self.occupied_threshold);
        if occupancy > occupied {
            100
        } else if occupancy < free {
            0
        } else if self.mode == Mode::Scale {
            percent(((occupancy - free) / (occupied - free) * 100.0).round_ties_even())
        } else {
            -1
        }
    }

    /// Converts cell coordinates to world coordinates.
    pub(super) fn place(&self, column: f64, row: f64) -> Point {
        let (sine, cosine) = self.turn;
        let (x, y) = (column * self.resolution_m, row * self.resolution_m);
        self.origin.plus(Point {
            x: x * cosine - y * sine,
            y: x * sine + y * cosine,
        })
    }

    /// The column and the row of a point in world coordinates; `None` if they are out of range.
    pub(super) fn cell(&self, place: Point) -> Option<(u32, u32)> {
        let (sine, cosine) = self.turn;
        let way = self.origin.to(place);
        let column = (way.x * cosine + way.y * sine) / self.resolution_m;
        let row = (way.y * cosine - way.x * sine) / self.resolution_m;
        Some((whole(column)?, whole(row)?))
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "within the range"
)]
fn whole(value: f64) -> Option<u32> {
    (0.0..f64::from(u32::MAX))
        .contains(&value)
        .then_some(value as u32)
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "a whole number from 0 to 100"
)]
fn percent(value: f64) -> i8 {
    value as i8
}
