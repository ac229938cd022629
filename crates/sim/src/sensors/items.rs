//! Item detector.

mod detector;
mod errors;
mod spec;

pub(crate) use detector::ItemDetector;
pub use spec::ItemsSpec;

use super::confusion::matrix;
use super::detection::Detection;
use super::sector::Sector;
use super::sensor_kind::{Amounts, Provides, SensorContext, SensorKind, Vicinity};
use base::document::Place;
use base::error::InputError;
use brain::Detector;

impl SensorKind for ItemsSpec {
    type Instrument = ItemDetector;
    const PROVIDES: &'static [Provides] = &[Provides::Items];
    const EXAMPLE: &'static str = "eye = { kind = \"items\", range_m = 3 }";

    fn instrument(&self, context: &SensorContext) -> ItemDetector {
        ItemDetector::new(self, context)
    }

    fn range_m(&self) -> Option<f64> {
        Some(self.sector.range_m)
    }

    /// As it is believed to be.
    fn detector(&self, context: &SensorContext) -> Option<Detector> {
        let SensorContext {
            owner,
            name,
            item_kinds,
            ..
        } = *context;
        let believed = self.as_believed(item_kinds.iter());
        let sector = &believed.sector;
        let always = Detection::Constant(1.0);
        let detection_probability =
            item_kinds
                .iter()
                .map(|kind| match &believed.detection_probability {
                    None => always.pairs(sector.range_m),
                    Some(detection_probability) => detection_probability
                        .get(kind)
                        .map_or_else(Vec::new, |detection| detection.pairs(sector.range_m)),
                });
        let rates = item_kinds
            .iter()
            .map(|kind| believed.false_alarm_rate_per_m2_s.get(kind));
        let blind_share = believed.blind_shares(item_kinds);
        let lookalike_share = believed.appearances(item_kinds);
        let confusion = if believed.confusion.is_empty() {
            Vec::new()
        } else {
            matrix(&believed.confusion, item_kinds)
        };
        // Otherwise it does not matter.
        let is_of_model = !blind_share.is_empty() || !lookalike_share.is_empty();
        Some(Detector {
            sensor: context.number,
            model: if is_of_model {
                self.model_key(owner, name)
            } else {
                0
            },
            blind_share,
            lookalike_share,
            confusion,
            range_m: sector.range_m,
            width_rad: sector.fov_deg.to_radians(),
            facing_rad: sector.facing_deg.to_radians(),
            detection_probability: detection_probability.collect(),
            false_alarms_per_m2: rates
                .map(|rate| rate.copied().unwrap_or(0.0) * context.period_s)
                .collect(),
            noise_m: believed.noise_m,
            needs_line_of_sight: believed.needs_line_of_sight,
        })
    }

    /// False alarms, and the items that it may detect.
    fn amounts(&self, period_s: f64, around: &impl Vicinity) -> Amounts {
        let area_m2 = Sector::new(&self.sector).area_m2();
        let contacts = around.items_within(area_m2).map(|(kind, items)| {
            let kinds = self.detection_probability.as_ref();
            let is_known = kinds.is_none_or(|kinds| kinds.contains_key(kind));
            let items = if is_known { items } else { 0.0 };
            self.false_alarms_per_measurement(kind, period_s) + items
        });
        Amounts {
            contacts: contacts.sum(),
            observations: 1.0,
            ..Amounts::default()
        }
    }

    fn errors(&self, context: &SensorContext, at: &Place) -> Vec<InputError> {
        errors::errors(self, context, at)
    }
}

#[cfg(test)]
mod tests;
