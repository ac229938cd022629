//! A ring of rays that measure distances.

use super::eye::{Eye, Use};
use super::rays::{Near, Rays};
use base::noise::{normal_pair, share};
use base::trig::wrapped;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Rays from the robot's centre, evenly spread over the field of view.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RangeSpec {
    /// Rays; a whole circle has the first ahead, a sector one on each edge.
    #[schemars(range(min = 1, max = 1440))]
    pub rays: u32,
    /// Angle that they cover, in degrees.
    #[serde(default = "whole_circle")]
    #[schemars(range(min = 0.0, max = 360.0))]
    pub fov_deg: f64,
    /// Its middle, in degrees anticlockwise from the robot's front.
    #[serde(default)]
    #[schemars(range(min = -180.0, max = 180.0))]
    pub facing_deg: f64,
    /// Nothing farther from the robot's centre is measured, in metres.
    #[schemars(range(min = 0.01, max = 10_000.0))]
    pub range_m: f64,
    /// Standard deviation of each distance, in metres.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub noise_m: f64,
    /// More standard deviation, as a share of the distance.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub noise_share: f64,
    /// Probability that a ray's echo is lost.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub miss: f64,
    /// Probability that a ray has an echo of nothing, at any distance up to what is there.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub false_echo: f64,
}

pub(super) fn whole_circle() -> f64 {
    360.0
}

/// A ring, as looks need it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Ring {
    rays: Rays,
    pub(crate) bearings_rad: Vec<f64>,
    pub(crate) range_m: f64,
    noise_m: f64,
    noise_share: f64,
    miss: f64,
    false_echo: f64,
}

impl Ring {
    pub(crate) fn new(spec: &RangeSpec) -> Self {
        let bearings_rad = bearings(spec);
        Self {
            rays: Rays::new(&bearings_rad),
            bearings_rad,
            range_m: spec.range_m,
            noise_m: spec.noise_m,
            noise_share: spec.noise_share,
            miss: spec.miss,
            false_echo: spec.false_echo,
        }
    }

    /// The distance of each ray's echo, infinite where none comes back.
    #[inline]
    pub(crate) fn look(&self, eye: &Eye, near: &Near, words: &mut Vec<u32>, to: &mut Vec<f64>) {
        self.rays.cast(eye.front, near, self.range_m, to);
        if self.miss > 0.0 || self.false_echo > 0.0 {
            self.lose_and_invent(eye, words, to);
        }
        if self.noise_m > 0.0 || self.noise_share > 0.0 {
            self.blur(eye, words, to);
        }
        for distance in to {
            *distance = if *distance < self.range_m {
                *distance
            } else {
                f64::INFINITY
            };
        }
    }

    fn blur(&self, eye: &Eye, words: &mut Vec<u32>, to: &mut [f64]) {
        draw(eye, Use::Error, to.len(), words);
        let (pairs, _) = words.as_chunks::<2>();
        for (distances, pair) in to.chunks_mut(2).zip(pairs) {
            for (distance, deviation) in distances.iter_mut().zip(normal_pair(*pair)) {
                let spread = self.noise_m + self.noise_share * *distance;
                // What was out of range stays so: there is no echo to be measured.
                if *distance < self.range_m {
                    *distance = (*distance + spread * deviation).max(0.0);
                }
            }
        }
    }

    fn lose_and_invent(&self, eye: &Eye, words: &mut Vec<u32>, to: &mut [f64]) {
        draw(eye, Use::Echo, 2 * to.len(), words);
        let (pairs, _) = words.as_chunks::<2>();
        for (distance, [chance, place]) in to.iter_mut().zip(pairs) {
            let chance = share(*chance);
            if chance < self.miss {
                *distance = self.range_m;
            } else if chance > 1.0 - self.false_echo {
                *distance *= share(*place);
            }
        }
    }
}

fn draw(eye: &Eye, used: Use, count: usize, words: &mut Vec<u32>) {
    words.clear();
    words.resize(count.next_multiple_of(4), 0);
    let used = used.of_sensor(eye.sensor);
    eye.noise.fill(used, eye.look, 0, words);
}

/// A whole circle has no ray twice; a sector has one on each edge.
fn bearings(spec: &RangeSpec) -> Vec<f64> {
    let (fov_rad, facing_rad) = (spec.fov_deg.to_radians(), spec.facing_deg.to_radians());
    let rays = f64::from(spec.rays);
    let bearing = |ray: u32| {
        let ray = f64::from(ray);
        let from_middle = if spec.fov_deg >= 360.0 {
            ray / rays * fov_rad
        } else if spec.rays == 1 {
            0.0
        } else {
            (ray / (rays - 1.0) - 0.5) * fov_rad
        };
        wrapped(facing_rad + from_middle)
    };
    (0..spec.rays).map(bearing).collect()
}

#[cfg(test)]
mod tests;
