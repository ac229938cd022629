//! A ring of rays that measure distances.

#![expect(
    clippy::inline_always,
    reason = "it is compiled for the vectors of its callers"
)]

use super::buffers::{Buffers, RingBuffers};
use super::detection_sink::DetectionSink;
use super::outline::{BlockedBy, Outline};
use super::rays::{GROUP, Rays};
use super::scene::Scene;
use super::sector::whole_circle;
use super::sensor_frame::{NoisePurpose, SensorFrame};
use super::sensor_kind::{Amounts, Instrument, Provides, SensorContext, SensorKind, Vicinity};
use base::noise::{BATCH, normal_pairs, share_of};
use base::trig::wrapped;
use brain::{Body, Percept, RangeRing};
use pulp::{Arch, Simd, WithSimd};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::array::from_fn;
use std::f64::consts::TAU;

/// Rays from the centre of the robot, evenly spaced over the field of view.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RangeSpec {
    /// Number of rays. On a full circle the first one points forward; in a sector there is one on
    /// each edge.
    #[schemars(range(min = 1, max = 1440))]
    pub rays: u32,
    /// Field of view, in degrees.
    #[serde(default = "whole_circle")]
    #[schemars(range(min = 0.0, max = 360.0))]
    pub fov_deg: f64,
    /// Direction of its centre, in degrees anticlockwise from the robot's front.
    #[serde(default)]
    #[schemars(range(min = -180.0, max = 180.0))]
    pub facing_deg: f64,
    /// Maximum range from the centre of the robot, in metres.
    #[schemars(range(min = 0.01, max = 10_000.0))]
    pub range_m: f64,
    /// Standard deviation of each distance, in metres.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub noise_m: f64,
    /// Additional standard deviation, as a fraction of the distance.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub relative_noise: f64,
    /// Probability that the return of a ray is lost.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub miss_probability: f64,
    /// Probability that a ray has a spurious return, at a uniformly distributed distance up to the
    /// real obstacle.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub spurious_return_probability: f64,
}

impl SensorKind for RangeSpec {
    type Instrument = Ring;
    const PROVIDES: &'static [Provides] = &[Provides::Distances];
    const EXAMPLE: &'static str = "sonar = { kind = \"range\", rays = 8, range_m = 4 }";

    fn instrument(&self, _context: &SensorContext) -> Ring {
        Ring::new(self)
    }

    fn range_m(&self) -> Option<f64> {
        Some(self.range_m)
    }

    fn extend_body(&self, context: &SensorContext, body: &mut Body) {
        body.rings.push(RangeRing {
            bearings_rad: bearings(self),
            range_m: self.range_m,
            period_s: context.period_s,
            latency_s: context.latency_s,
        });
    }

    fn amounts(&self, _period_s: f64, _around: &impl Vicinity) -> Amounts {
        Amounts {
            values: f64::from(self.rays),
            ..Amounts::default()
        }
    }
}

/// A ring, converted for measurements.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Ring {
    rays: Rays,
    /// Number of its rays: those of [`Rays`] come in whole groups.
    count: usize,
    width_rad: f64,
    facing_rad: f64,
    range_m: f64,
    noise_m: f64,
    relative_noise: f64,
    miss_probability: f64,
    spurious_return_probability: f64,
}

impl Instrument for Ring {
    const IS_RING: bool = true;

    #[inline]
    fn measure(
        &self,
        frame: &SensorFrame,
        scene: &impl Scene,
        buffers: &mut Buffers,
        _sink: &mut impl DetectionSink,
    ) {
        buffers.gather(scene);
        self.distances(frame, &mut buffers.rays, &mut buffers.values);
    }

    #[inline]
    fn write(&self, percept: &mut Percept, ring: usize, age_s: f64, values: &mut Vec<f64>) {
        let scan = &mut percept.scans[ring];
        scan.age_s = Some(age_s);
        std::mem::swap(&mut scan.ranges_m, values);
    }

    fn outline(&self) -> Option<Outline> {
        Some(Outline {
            range_m: self.range_m,
            width_rad: self.width_rad,
            facing_rad: self.facing_rad,
            blocked_by: BlockedBy::Bodies,
        })
    }
}

impl Ring {
    pub(crate) fn new(spec: &RangeSpec) -> Self {
        Self {
            width_rad: spec.fov_deg.to_radians(),
            facing_rad: spec.facing_deg.to_radians(),
            noise_m: spec.noise_m,
            relative_noise: spec.relative_noise,
            miss_probability: spec.miss_probability,
            spurious_return_probability: spec.spurious_return_probability,
            ..Self::exact(spec.range_m, &bearings(spec))
        }
    }

    /// A ring without errors, with a ray along each of the bearings.
    pub(crate) fn exact(range_m: f64, bearings_rad: &[f64]) -> Self {
        Self {
            rays: Rays::new(bearings_rad),
            count: bearings_rad.len(),
            width_rad: TAU,
            facing_rad: 0.0,
            range_m,
            noise_m: 0.0,
            relative_noise: 0.0,
            miss_probability: 0.0,
            spurious_return_probability: 0.0,
        }
    }

    /// The distance of each ray's return, infinite without one.
    ///
    /// One pass in the widest vectors of the machine.
    #[inline]
    pub(crate) fn distances(
        &self,
        frame: &SensorFrame,
        buffers: &mut RingBuffers,
        to: &mut Vec<f64>,
    ) {
        self.look_with(instruction_set(), frame, buffers, to);
    }

    #[inline]
    fn look_with(
        &self,
        arch: Arch,
        frame: &SensorFrame,
        buffers: &mut RingBuffers,
        to: &mut Vec<f64>,
    ) {
        to.resize(self.rays.groups() * GROUP, 0.0);
        buffers.deviations.resize(self.rays.groups(), [0.0; GROUP]);
        let (to_groups, _) = to.as_chunks_mut();
        arch.dispatch(RingLook {
            ring: self,
            frame,
            buffers,
            to: to_groups,
        });
        to.truncate(self.count);
    }
}

/// The widest instruction set of this machine.
#[cfg(not(test))]
pub(crate) fn instruction_set() -> Arch {
    Arch::new()
}

#[cfg(test)]
pub(crate) use tests::instruction_set;

/// One measurement of a ring, as one piece of work for vectors.
struct RingLook<'a> {
    ring: &'a Ring,
    frame: &'a SensorFrame<'a>,
    buffers: &'a mut RingBuffers,
    to: &'a mut [[f64; GROUP]],
}

impl WithSimd for RingLook<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self {
            ring,
            frame,
            buffers,
            to,
        } = self;
        let RingBuffers { near, deviations } = buffers;
        // First, because it waits for nothing: the processor continues with it while rays are cast.
        if ring.is_noisy() {
            deviate(frame, deviations);
        }
        ring.rays.cast(simd, (frame.front, ring.range_m), near, to);
        if ring.spurious_return_probability > 0.0 {
            ring.invent(frame, to);
        }
        if ring.miss_probability > 0.0 {
            ring.lose(frame, to);
        }
        for (distances, deviations) in to.iter_mut().zip(deviations) {
            *distances = from_fn(|lane| ring.measured(distances[lane], deviations[lane]));
        }
    }
}

/// Draws a normal deviate for each ray.
#[inline(always)]
fn deviate(frame: &SensorFrame, to: &mut [[f64; GROUP]]) {
    for (batch, groups) in (0..).zip(to.chunks_mut(GROUPS)) {
        let words = frame.batch_words(NoisePurpose::Error, batch);
        for (pair, words) in groups.chunks_mut(2).zip(words.chunks(2)) {
            let drawn = normal_pairs([&words[0], &words[1]]);
            for (deviations, drawn) in pair.iter_mut().zip(drawn) {
                *deviations = drawn;
            }
        }
    }
}

/// Random numbers are drawn in batches of four groups of rays.
const GROUPS: usize = BATCH / GROUP;

/// Groups are written as a whole: stores of single lanes would delay the next load.
impl Ring {
    #[inline(always)]
    fn lose(&self, frame: &SensorFrame, to: &mut [[f64; GROUP]]) {
        for (batch, groups) in (0..).zip(to.chunks_mut(GROUPS)) {
            let chances = frame.batch_words(NoisePurpose::Echo, batch);
            for (distances, chances) in groups.iter_mut().zip(&chances) {
                *distances = from_fn(|lane| {
                    let is_lost = share_of(chances[lane]) < self.miss_probability;
                    if is_lost {
                        self.range_m
                    } else {
                        distances[lane]
                    }
                });
            }
        }
    }

    /// The lowest random numbers of a ray mean a loss, the highest a spurious return; a loss takes
    /// precedence.
    #[inline(always)]
    fn invent(&self, frame: &SensorFrame, to: &mut [[f64; GROUP]]) {
        for (batch, groups) in (0..).zip(to.chunks_mut(GROUPS)) {
            let chances = frame.batch_words(NoisePurpose::Echo, batch);
            let places = frame.batch_words(NoisePurpose::EchoPlace, batch);
            for ((distances, chances), places) in groups.iter_mut().zip(&chances).zip(&places) {
                *distances = from_fn(|lane| {
                    let is_false = share_of(chances[lane]) > 1.0 - self.spurious_return_probability;
                    let before = distances[lane] * share_of(places[lane]);
                    if is_false { before } else { distances[lane] }
                });
            }
        }
    }

    fn is_noisy(&self) -> bool {
        self.noise_m > 0.0 || self.relative_noise > 0.0
    }

    /// What is out of range stays out of range, whatever the noise: there is no return to measure.
    #[inline(always)]
    fn measured(&self, distance: f64, deviation: f64) -> f64 {
        let spread = self.noise_m + self.relative_noise * distance;
        let measured = distance + spread * deviation;
        let measured = if measured > 0.0 { measured } else { 0.0 };
        let is_echo = (distance < self.range_m) && (measured < self.range_m);
        if is_echo { measured } else { f64::INFINITY }
    }
}

impl RangeSpec {
    /// The angle between neighbouring rays, if there are several.
    pub(crate) fn gap_rad(&self) -> Option<f64> {
        let is_full = self.fov_deg >= 360.0;
        let gaps = self.rays.checked_sub(u32::from(!is_full));
        let gaps = gaps.filter(|_| self.rays > 1 && self.fov_deg > 0.0)?;
        Some(self.fov_deg.to_radians() / f64::from(gaps))
    }
}

fn bearings(spec: &RangeSpec) -> Vec<f64> {
    let (width_rad, facing_rad) = (spec.fov_deg.to_radians(), spec.facing_deg.to_radians());
    spread(spec.rays, width_rad, facing_rad)
}

/// Bearings of rays: a full circle has none twice, a sector has one on each edge.
pub(crate) fn spread(rays: u32, width_rad: f64, facing_rad: f64) -> Vec<f64> {
    let count = f64::from(rays);
    let bearing = |ray: u32| {
        let ray = f64::from(ray);
        let from_middle = if width_rad >= TAU {
            ray / count * width_rad
        } else if rays == 1 {
            0.0
        } else {
            (ray / (count - 1.0) - 0.5) * width_rad
        };
        wrapped(facing_rad + from_middle)
    };
    (0..rays).map(bearing).collect()
}

#[cfg(test)]
pub(crate) mod tests;
