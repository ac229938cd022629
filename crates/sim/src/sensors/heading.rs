//! Heading sensor: a compass.

use super::buffers::Buffers;
use super::detection_sink::DetectionSink;
use super::scene::Scene;
use super::sensor_frame::SensorFrame;
use super::sensor_kind::{Amounts, Instrument, Provides, SensorContext, SensorKind, Vicinity};
use base::trig::wrapped;
use brain::{Body, Percept, Reading};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A heading in world coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct HeadingSpec {
    /// Standard deviation, in degrees.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 360.0))]
    pub noise_deg: f64,
}

impl SensorKind for HeadingSpec {
    type Instrument = Compass;
    const PROVIDES: &'static [Provides] = &[Provides::Heading];
    const EXAMPLE: &'static str = "compass = { kind = \"heading\" }";

    fn instrument(&self, _context: &SensorContext) -> Compass {
        Compass {
            noise_rad: self.noise_deg.to_radians(),
        }
    }

    fn extend_body(&self, _context: &SensorContext, body: &mut Body) {
        body.heading_noise_rad = body.heading_noise_rad.max(self.noise_deg.to_radians());
    }

    fn amounts(&self, _period_s: f64, _around: &impl Vicinity) -> Amounts {
        Amounts {
            values: 1.0,
            ..Amounts::default()
        }
    }
}

/// A compass, converted for measurements.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Compass {
    noise_rad: f64,
}

impl Instrument for Compass {
    #[inline]
    fn measure(
        &self,
        frame: &SensorFrame,
        scene: &impl Scene,
        buffers: &mut Buffers,
        _sink: &mut impl DetectionSink,
    ) {
        let error_rad = self.noise_rad * frame.deviations()[0];
        buffers.values.clear();
        buffers
            .values
            .push(wrapped(scene.heading_rad() + error_rad));
    }

    #[inline]
    fn write(&self, percept: &mut Percept, _ring: usize, age_s: f64, values: &mut Vec<f64>) {
        if let [value] = values[..] {
            percept.heading_rad = Some(Reading { value, age_s });
        }
    }
}
