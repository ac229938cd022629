//! Where a look is from, and its random numbers.

use crate::world::static_geometry::StaticGeometry;
use base::geometry::Point;
use base::noise::{Noise, normal_pair};
use base::philox::Blocks;
use base::random::Entity;

/// What a look draws random numbers for. The numbers stay: a change changes every result.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub(crate) enum NoisePurpose {
    /// Whether the look gives anything.
    Dropout = 0,
    /// The error of a value; the normal deviations of rays.
    Error = 1,
    /// A thing that may be detected, by its number.
    Thing = 2,
    /// Things that are not there.
    FalseAlarm = 3,
    /// Whether a ray's echo is lost or false.
    Echo = 4,
    /// What a brain has for dice; not a sensor's.
    Dice = 5,
    /// A message that may be lost; not a sensor's.
    Radio = 6,
    /// How far away a false echo is.
    EchoPlace = 7,
    /// The error of a course that is told.
    Orientation = 8,
}

/// Uses of one sensor are numbered on from here.
const USES: u32 = 16;

impl NoisePurpose {
    /// Its number for one sensor of a robot.
    #[inline]
    pub(crate) fn of_sensor(self, sensor: u32) -> u32 {
        USES * sensor + self as u32
    }
}

/// One robot's look with one sensor.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SensorFrame<'a> {
    pub(crate) at: Point,
    /// Direction of the robot's front, of length 1.
    pub(crate) front: Point,
    pub(crate) noise: Noise,
    /// Place of the sensor among the robot's.
    pub(crate) sensor: u32,
    /// Number of the look.
    pub(crate) look: u64,
    /// What can be in the way.
    pub(crate) stands: &'a StaticGeometry,
    /// Whether it is known to be in no way.
    pub(crate) is_clear: bool,
}

impl SensorFrame<'_> {
    #[inline]
    pub(crate) fn words(&self, used: NoisePurpose, index: u32) -> [u32; 4] {
        self.noise
            .words(used.of_sensor(self.sensor), self.look, index)
    }

    /// The words for one thing of a kind.
    #[inline]
    pub(crate) fn words_of(&self, used: NoisePurpose, thing: Entity) -> [u32; 4] {
        // Looks are at most 1e8: the kind is in the half of their number that is free.
        let time = u64::from(thing.kind) << 32 | self.look;
        self.noise
            .words(used.of_sensor(self.sensor), time, thing.index)
    }

    /// A word for each thing of a hand: see [`Noise::deal`].
    #[inline(always)]
    #[expect(
        clippy::inline_always,
        reason = "it is compiled for the caller's vectors"
    )]
    pub(crate) fn deal(&self, used: NoisePurpose, hand: u32) -> Blocks {
        self.noise
            .deal(used.of_sensor(self.sensor), self.look, hand)
    }

    /// The way to a place of the world, from the robot's front.
    #[inline]
    pub(crate) fn own(&self, place: Point) -> Point {
        let way = self.at.to(place);
        Point {
            x: self.front.dot(way),
            y: self.front.cross(way),
        }
    }

    /// The place of the world at a way from the robot's front.
    pub(crate) fn world_of(&self, way: Point) -> Point {
        Point {
            x: self.at.x + self.front.x * way.x - self.front.y * way.y,
            y: self.at.y + self.front.y * way.x + self.front.x * way.y,
        }
    }

    /// Whether nothing that stands still hides a place.
    pub(crate) fn sees(&self, place: Point) -> bool {
        self.is_clear || self.stands.is_open(self.at, place)
    }
}

/// A place with a normal error along each axis, from the last three of a draw's words.
#[inline]
pub(crate) fn blurred(way: Point, noise_m: f64, words: [u32; 4]) -> Point {
    if noise_m == 0.0 {
        return way;
    }
    let [x, y] = normal_pair([words[1], words[2]]);
    way.plus(Point { x, y }.times(noise_m))
}
