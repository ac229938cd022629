//! Position sensor: a satellite receiver.

use super::buffers::Buffers;
use super::detection_sink::DetectionSink;
use super::scene::Scene;
use super::sensor_frame::{NoisePurpose, SensorFrame};
use super::sensor_kind::{Amounts, Instrument, Provides, SensorContext, SensorKind, Vicinity};
use base::geometry::Point;
use base::noise::normal_pair;
use brain::{Body, Percept, Reading};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A position in world coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PositionSpec {
    /// Standard deviation along each axis, in metres.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub noise_m: f64,
    /// Standard deviation of a slow error along each axis, in metres, in addition to the noise.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub drift_m: f64,
    /// Time after which the slow error is independent of what it was, in seconds.
    #[serde(default = "a_minute")]
    #[schemars(range(min = 0.1, max = 1e6))]
    pub drift_s: f64,
}

fn a_minute() -> f64 {
    60.0
}

impl SensorKind for PositionSpec {
    type Instrument = PositionSensor;
    const PROVIDES: &'static [Provides] = &[Provides::Position];
    const EXAMPLE: &'static str = "gps = { kind = \"position\" }";

    fn instrument(&self, _context: &SensorContext) -> PositionSensor {
        PositionSensor {
            noise_m: self.noise_m,
            drift: Drift::new(self),
        }
    }

    fn extend_body(&self, _context: &SensorContext, body: &mut Body) {
        body.position_noise_m = body.position_noise_m.max(self.noise_m);
        if let Some(drift) = Drift::new(self) {
            body.position_drift_m = body.position_drift_m.max(drift.deviation_m);
            body.position_drift_s = body.position_drift_s.max(drift.independent_after_s);
        }
    }

    fn amounts(&self, _period_s: f64, _around: &impl Vicinity) -> Amounts {
        Amounts {
            values: 2.0,
            ..Amounts::default()
        }
    }
}

/// A position sensor, converted for measurements.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PositionSensor {
    noise_m: f64,
    drift: Option<Drift>,
}

impl Instrument for PositionSensor {
    #[inline]
    fn measure(
        &self,
        frame: &SensorFrame,
        scene: &impl Scene,
        buffers: &mut Buffers,
        _sink: &mut impl DetectionSink,
    ) {
        let values = &mut buffers.values;
        let [x, y] = frame.deviations().map(|deviation| deviation * self.noise_m);
        values.clear();
        values.extend([frame.at.x + x, frame.at.y + y]);
        if let Some(drift) = self.drift {
            let error = drift.at(frame, scene.time_s());
            values[0] += error.x;
            values[1] += error.y;
        }
    }

    #[inline]
    fn write(&self, percept: &mut Percept, _ring: usize, age_s: f64, values: &mut Vec<f64>) {
        if let [x, y] = values[..] {
            let value = Point { x, y };
            percept.position = Some(Reading { value, age_s });
        }
    }
}

/// The slow error of a position sensor, a function of the time: independent normal deviates at even times, half of
/// `drift_s` apart, and in between the mean of two, weighted by nearness and scaled to the same variance.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Drift {
    deviation_m: f64,
    independent_after_s: f64,
}

impl Drift {
    /// `None` without a slow error.
    fn new(spec: &PositionSpec) -> Option<Self> {
        (spec.drift_m > 0.0).then_some(Self {
            deviation_m: spec.drift_m,
            independent_after_s: spec.drift_s,
        })
    }

    /// The error at a time.
    fn at(&self, frame: &SensorFrame, time_s: f64) -> Point {
        let place = 2.0 * time_s / self.independent_after_s;
        let (knot, later) = (place.floor(), place.fract());
        let earlier = 1.0 - later;
        let scale = self.deviation_m / (earlier * earlier + later * later).sqrt();
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "times are from 0 to 1e9 s"
        )]
        let knot = knot as u64;
        let [from, to] = [knot, knot + 1].map(|knot| {
            let [x, y, ..] = frame.words_at(NoisePurpose::Drift, knot);
            normal_pair([x, y])
        });
        let [x, y] = [0, 1].map(|axis| scale * (earlier * from[axis] + later * to[axis]));
        Point { x, y }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::static_geometry::StaticGeometry;
    use base::noise::Noise;
    use base::random::Entity;

    const DRIFT: Drift = Drift {
        deviation_m: 0.5,
        independent_after_s: 60.0,
    };

    /// The errors of a run at some times.
    fn errors<const N: usize>(run: u64, times_s: [f64; N]) -> [Point; N] {
        let size_m = Point { x: 1.0, y: 1.0 };
        let frame = SensorFrame {
            at: Point::default(),
            front: Point { x: 1.0, y: 0.0 },
            noise: Noise::of(7, run, Entity { kind: 1, index: 2 }),
            sensor: 3,
            measurement: 0,
            geometry: &StaticGeometry::new(size_m, &[], &[], 1.0),
            is_clear: true,
        };
        times_s.map(|time_s| DRIFT.at(&frame, time_s))
    }

    /// The mean product of two numbers of a run over 20 000 runs: of independent ones with a standard deviation of 0.5,
    /// it has a standard error of 0.0018, and their mean square has one of 0.0025.
    fn mean(product: impl Fn(u64) -> f64) -> f64 {
        (0..20_000).map(product).sum::<f64>() / 20_000.0
    }

    /// Each of the 9 numbers is within 5 standard errors: wrong for a right drift less than once in 100 000 seeds.
    #[test]
    fn the_drift_has_its_deviation_at_all_times_and_is_independent_after_its_time() {
        for time_s in [0.0, 10.0, 47.3] {
            let square = mean(|run| errors(run, [time_s])[0].x.powi(2));
            assert!((square - 0.25).abs() < 5.0 * 0.0025, "{time_s}: {square}");
            let later = mean(|run| {
                let [now, then] = errors(run, [time_s, time_s + 60.0]);
                now.x * then.x
            });
            assert!(later.abs() < 5.0 * 0.0018, "{time_s}: {later}");
            let axes = mean(|run| errors(run, [time_s]).map(|error| error.x * error.y)[0]);
            assert!(axes.abs() < 5.0 * 0.0018, "{time_s}: {axes}");
        }
    }

    #[test]
    fn the_drift_is_slow() {
        for run in 0..100 {
            for second in 0..200 {
                let time_s = f64::from(second);
                let [now, then] = errors(run, [time_s, time_s + 0.1]);
                // At most the difference of two deviates, and the scale between them, in 300 parts.
                assert!(now.to(then).length() < 0.05, "{run} {time_s}");
            }
        }
    }
}
