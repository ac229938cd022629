//! The pose from which a sensor measures, and its random numbers.

use crate::world::static_geometry::StaticGeometry;
use base::geometry::Point;
use base::noise::{Noise, normal_pair};
use base::philox::Blocks;
use base::random::Entity;

/// The purpose of a random number. The values are fixed: a change changes every result.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub(crate) enum NoisePurpose {
    /// Whether a measurement yields anything.
    DropOut = 0,
    /// The error of a value; the normal deviates of rays.
    Error = 1,
    /// Something that may be detected, by its number.
    Thing = 2,
    /// False alarms.
    FalseAlarm = 3,
    /// Whether the return of a ray is lost or spurious.
    Echo = 4,
    /// The random words of a percept; not a sensor's.
    RandomWords = 5,
    /// Whether a message is lost; not a sensor's.
    Radio = 6,
    /// The distance of a spurious return.
    EchoPlace = 7,
    /// The error of a measured heading.
    Orientation = 8,
    /// Which of too many messages are received; not a sensor's.
    Inbox = 9,
    /// The clock of a robot or controller; not a sensor's.
    Clock = 10,
    /// Whether a robot or controller fails; not a sensor's.
    Failure = 11,
    /// Whether sensors of a model can detect an item; not a robot's.
    Blindness = 12,
    /// The slow error of a position, by its time.
    Drift = 13,
    /// Whether a charge destroys an item; not a sensor's.
    Act = 14,
    /// Whether an item destroys a robot; not a sensor's.
    Hazard = 15,
    /// The error of the place from which virtual sensors measure; not a sensor's, and beyond all of these.
    Place = 512,
}

/// Purposes of one sensor are numbered from here.
const USES: u32 = 16;

impl NoisePurpose {
    /// Its number for one sensor of a robot.
    #[inline]
    pub(crate) fn of_sensor(self, sensor: u32) -> u32 {
        USES * sensor + self as u32
    }
}

/// One measurement of one sensor of one robot.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SensorFrame<'a> {
    pub(crate) at: Point,
    /// Unit vector of the robot's heading.
    pub(crate) front: Point,
    pub(crate) noise: Noise,
    /// Index of the sensor on the robot.
    pub(crate) sensor: u32,
    /// Number of the measurement.
    pub(crate) measurement: u64,
    /// What can block the view.
    pub(crate) geometry: &'a StaticGeometry,
    /// Whether it is known that nothing does.
    pub(crate) is_clear: bool,
}

impl SensorFrame<'_> {
    #[inline]
    pub(crate) fn words(&self, used: NoisePurpose, index: u32) -> [u32; 4] {
        self.noise
            .words(used.of_sensor(self.sensor), self.measurement, index)
    }

    /// Two standard normal deviates for the error of a measurement.
    #[inline]
    pub(super) fn deviations(&self) -> [f64; 2] {
        let [a, b, ..] = self.words(NoisePurpose::Error, 0);
        normal_pair([a, b])
    }

    /// The random words for a time that does not depend on measurements.
    pub(crate) fn words_at(&self, used: NoisePurpose, time: u64) -> [u32; 4] {
        self.noise.words(used.of_sensor(self.sensor), time, 0)
    }

    /// The random words for one thing of a kind.
    #[inline]
    pub(crate) fn words_of(&self, used: NoisePurpose, thing: Entity) -> [u32; 4] {
        // Measurements number at most 1e8: the kind is in the unused half of their number.
        let time = u64::from(thing.kind) << 32 | self.measurement;
        self.noise
            .words(used.of_sensor(self.sensor), time, thing.index)
    }

    /// A random word for each entity of a batch: see [`Noise::batch_words`].
    #[inline(always)]
    #[expect(
        clippy::inline_always,
        reason = "it is compiled for the caller's vectors"
    )]
    pub(crate) fn batch_words(&self, used: NoisePurpose, batch: u32) -> Blocks {
        self.noise
            .batch_words(used.of_sensor(self.sensor), self.measurement, batch)
    }

    /// The vector to a place of the world, relative to the robot's front.
    #[inline]
    pub(crate) fn own(&self, place: Point) -> Point {
        let way = self.at.to(place);
        Point {
            x: self.front.dot(way),
            y: self.front.cross(way),
        }
    }

    /// The place in the world at a vector relative to the robot's front.
    pub(crate) fn world_of(&self, way: Point) -> Point {
        Point {
            x: self.at.x + self.front.x * way.x - self.front.y * way.y,
            y: self.at.y + self.front.y * way.x + self.front.x * way.y,
        }
    }

    /// Whether no static geometry hides a place.
    pub(crate) fn sees(&self, place: Point) -> bool {
        self.is_clear || self.geometry.is_open(self.at, place)
    }
}

/// The distance and the bearing of what lies at a vector relative to the robot's front.
#[inline]
pub(super) fn polar(way: Point) -> (f64, f64) {
    (way.length(), libm::atan2(way.y, way.x))
}

/// A place with a normal error along each axis, from the last three words of a draw.
#[inline]
pub(crate) fn blurred(way: Point, noise_m: f64, words: [u32; 4]) -> Point {
    if noise_m == 0.0 {
        return way;
    }
    let [x, y] = normal_pair([words[1], words[2]]);
    way.plus(Point { x, y }.times(noise_m))
}
