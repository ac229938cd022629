//! The sensor manager: a referee between the world and the robots.
//!
//! A robot gets what its sensors can detect, and misses the rest. One file per sensor kind, with
//! the interface of `sensor_kind.rs`.

pub(crate) mod backlog;
pub(crate) mod believed;
pub(crate) mod blindness;
pub(crate) mod buffers;
pub(crate) mod confusion;
pub mod detection;
pub(crate) mod detection_sink;
pub mod heading;
pub mod items;
mod lookalikes;
pub(crate) mod memory;
pub(crate) mod outline;
pub(crate) mod pass;
pub(crate) mod pending;
pub mod position;
pub mod range;
pub(crate) mod rays;
pub mod robots;
pub(crate) mod scene;
pub mod sector;
mod sensor;
pub(crate) mod sensor_frame;
pub(crate) mod sensor_kind;

pub(crate) use sensor::Sensor;
pub use sensor::SensorSpec;
pub use sensor_kind::KindFacts;

use base::document::Place;
use base::error::InputError;
use brain::{Body, Detector, Percept};
use buffers::Buffers;
use detection_sink::DetectionSink;
use outline::Outline;
use scene::Scene;
use schemars::JsonSchema;
use sensor_frame::SensorFrame;
use sensor_kind::{AmongKinds, Amounts, Instrument, SensorContext, SensorKind, Vicinity};
use serde::{Deserialize, Serialize};

/// All kinds of sensors: purpose, variant, file and specification. The name of the file is that of
/// the kind in scenarios.
macro_rules! sensors {
    ($($(#[doc = $purpose:literal])+ $kind:ident($file:ident::$spec:ident);)+) => {
        /// What a sensor measures.
        #[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
        #[serde(tag = "kind", rename_all = "snake_case")]
        pub enum Measures {
            $($(#[doc = $purpose])+ $kind($file::$spec),)+
        }

        /// What a sensor measures, converted for measurements.
        #[derive(Debug, Clone, PartialEq)]
        pub(crate) enum Measure {
            $($kind(<$file::$spec as SensorKind>::Instrument),)+
        }

        /// All kinds, in the order of the list.
        pub const KINDS: &[KindFacts] =
            &[$(KindFacts::of::<$file::$spec>(stringify!($file))),+];

        impl Measures {
            /// What is the same for all sensors of its kind.
            pub(crate) fn facts(&self) -> &'static KindFacts {
                match self {
                    $(Self::$kind(_) => {
                        const { &KindFacts::of::<$file::$spec>(stringify!($file)) }
                    })+
                }
            }

            fn measure(&self, context: &SensorContext) -> Measure {
                match self {
                    $(Self::$kind(spec) => Measure::$kind(spec.instrument(context)),)+
                }
            }

            /// Maximum range; `None` if it measures only the robot itself.
            pub(crate) fn range_m(&self) -> Option<f64> {
                match self {
                    $(Self::$kind(spec) => spec.range_m(),)+
                }
            }

            pub(crate) fn extend_body(&self, context: &SensorContext, body: &mut Body) {
                match self {
                    $(Self::$kind(spec) => spec.extend_body(context, body),)+
                }
            }

            pub(crate) fn detector(&self, context: &SensorContext) -> Option<Detector> {
                match self {
                    $(Self::$kind(spec) => spec.detector(context),)+
                }
            }

            pub(crate) fn amounts(&self, period_s: f64, around: &impl Vicinity) -> Amounts {
                match self {
                    $(Self::$kind(spec) => spec.amounts(period_s, around),)+
                }
            }

            pub(crate) fn errors(&self, context: &SensorContext, at: &Place) -> Vec<InputError> {
                match self {
                    $(Self::$kind(spec) => spec.errors(context, at),)+
                }
            }
        }

        impl Measure {
            #[inline]
            pub(crate) fn measure(
                &self,
                frame: &SensorFrame,
                scene: &impl Scene,
                buffers: &mut Buffers,
                sink: &mut impl DetectionSink,
            ) {
                match self {
                    $(Self::$kind(instrument) => instrument.measure(frame, scene, buffers, sink),)+
                }
            }

            #[inline]
            pub(crate) fn write(
                &self,
                percept: &mut Percept,
                ring: usize,
                age_s: f64,
                values: &mut Vec<f64>,
            ) {
                match self {
                    $(Self::$kind(instrument) => instrument.write(percept, ring, age_s, values),)+
                }
            }

            pub(crate) fn outline(&self) -> Option<Outline> {
                match self {
                    $(Self::$kind(instrument) => instrument.outline(),)+
                }
            }
        }

        $(
            among!(Measures, $kind, $file::$spec);
            among!(Measure, $kind, <$file::$spec as SensorKind>::Instrument);
        )+
    };
}

/// Typed access to a variant.
macro_rules! among {
    ($all:ident, $kind:ident, $type:ty) => {
        impl AmongKinds<$all> for $type {
            fn of(all: &$all) -> Option<&Self> {
                match all {
                    $all::$kind(this) => Some(this),
                    _ => None,
                }
            }

            fn of_mut(all: &mut $all) -> Option<&mut Self> {
                match all {
                    $all::$kind(this) => Some(this),
                    _ => None,
                }
            }
        }
    };
}

sensors! {
    /// Distances along rays: sonar, infrared, laser scanner.
    Range(range::RangeSpec);
    /// Items: a camera, a metal detector.
    Items(items::ItemsSpec);
    /// Other robots.
    Robots(robots::RobotsSpec);
    /// The position of the robot: a satellite receiver.
    Position(position::PositionSpec);
    /// The heading of the robot: a compass.
    Heading(heading::HeadingSpec);
}

#[cfg(test)]
mod tests;
