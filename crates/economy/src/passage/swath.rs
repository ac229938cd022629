//! What lies within the width of a path.

use super::risk::Contents;
use super::settings::Passage;
use crate::clearance::{BelievedMark, LanePicture};
use alloc::vec::Vec;
use base::geometry::{Point, Rectangle, Segment};
use brain::MARK_KINDS;

/// Samples within the width of the path, for the share of a cell that lies in it.
const PER_WIDTH: f64 = 8.0;

/// Samples along each side of a cell, at least and at most.
const MIN_SAMPLES: f64 = 4.0;
const MAX_SAMPLES: f64 = 400.0;

/// Samples of the position of a mark along each axis, and how far they reach, in deviations.
const MARK_SAMPLES: u32 = 24;
const REACH_DEVIATIONS: f64 = 4.5;

/// Marks with a lower probability of a mine within the path are left out.
const MIN_PROBABILITY: f64 = 1e-12;

/// A path with its width.
pub(super) struct Swath {
    pieces: Vec<Segment>,
    half_width_m: f64,
}

impl Swath {
    pub(super) fn new(path: &[Point], width_m: f64) -> Self {
        let pieces = path.windows(2).map(|ends| Segment {
            from: ends[0],
            to: ends[1],
        });
        Self {
            pieces: pieces.collect(),
            half_width_m: width_m / 2.0,
        }
    }

    /// The mines that are expected within it.
    pub(super) fn contents(&self, picture: &LanePicture, passage: &Passage) -> Contents {
        let lane = picture.clearance().lane;
        let mut unmarked = [0.0; MARK_KINDS];
        for cell in 0..lane.cells() {
            let share = self.share_of(&lane.cell_area(cell));
            if share > 0.0 {
                let here = picture.unmarked_of_kinds(cell);
                let kinds = unmarked.iter_mut().zip(here);
                kinds.for_each(|(sum, expected)| *sum += share * expected);
            }
        }
        let marks = picture.marks().filter_map(|mark| {
            let inside = self.probability_of(&mark, &lane.area());
            let mines = mark.mine_of_kinds(&lane).map(|mine| mine * inside);
            let [along_m, _] = passage.grid.coordinates(mark.at);
            let is_relevant = mines.iter().sum::<f64>() > MIN_PROBABILITY;
            is_relevant.then(|| (along_m / passage.grid.length_m(), mines))
        });
        Contents {
            unmarked,
            marks: marks.collect(),
        }
    }

    /// The share of a cell that lies in it.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "small numbers"
    )]
    fn share_of(&self, cell: &Rectangle) -> f64 {
        let size = cell.size();
        let centre = cell.min().plus(size.times(0.5));
        let near = self.near(centre, size.length() / 2.0);
        if near.is_empty() {
            return 0.0;
        }
        let samples = |side_m: f64| {
            let samples = libm::ceil(side_m / self.half_width_m * PER_WIDTH / 2.0);
            samples.clamp(MIN_SAMPLES, MAX_SAMPLES) as u32
        };
        let (right, up) = (samples(size.x), samples(size.y));
        let step = Point {
            x: size.x / f64::from(right),
            y: size.y / f64::from(up),
        };
        let soft_m = step.x.max(step.y);
        let mut inside = 0.0;
        for column in 0..right {
            for row in 0..up {
                let at = cell.min().plus(Point {
                    x: (f64::from(column) + 0.5) * step.x,
                    y: (f64::from(row) + 0.5) * step.y,
                });
                inside += self.cover(&near, at, soft_m);
            }
        }
        inside / f64::from(right) / f64::from(up)
    }

    /// Probability that what has been marked lies in it, and in the lane.
    fn probability_of(&self, mark: &BelievedMark, lane: &Rectangle) -> f64 {
        let reach_m = REACH_DEVIATIONS * mark.deviation_m;
        let near = self.near(mark.at, reach_m * core::f64::consts::SQRT_2);
        if near.is_empty() {
            return 0.0;
        }
        let step_m = 2.0 * reach_m / f64::from(MARK_SAMPLES);
        let away_m = |sample: u32| (f64::from(sample) + 0.5) * step_m - reach_m;
        let weight = |away_m: f64| {
            let deviations = away_m / mark.deviation_m;
            libm::exp(-deviations * deviations / 2.0)
        };
        let (mut inside, mut total) = (0.0, 0.0);
        for right in 0..MARK_SAMPLES {
            for up in 0..MARK_SAMPLES {
                let (x, y) = (away_m(right), away_m(up));
                let at = mark.at.plus(Point { x, y });
                let weight = weight(x) * weight(y);
                total += weight;
                if lane.contains(at) {
                    inside += weight * self.cover(&near, at, step_m);
                }
            }
        }
        inside / total
    }

    /// The pieces of the path that are near to a place.
    fn near(&self, at: Point, within_m: f64) -> Vec<Segment> {
        let near = self.pieces.iter();
        let near = near.filter(|piece| piece.distance_m(at) <= self.half_width_m + within_m);
        near.copied().collect()
    }

    /// The share of a small square around a place that lies in it.
    fn cover(&self, near: &[Segment], at: Point, side_m: f64) -> f64 {
        let away_m = near.iter().map(|piece| piece.distance_m(at));
        let away_m = away_m.fold(f64::INFINITY, f64::min);
        ((self.half_width_m - away_m) / side_m + 0.5).clamp(0.0, 1.0)
    }
}
