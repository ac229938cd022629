//! Checks that detectors detect existing items, with valid probabilities.

use crate::poisson::MAX_MEAN;
use crate::scenario::spec::ScenarioSpec;
use crate::schedule::Schedule;
use crate::sensors::Measures;
use crate::sensors::detection::Detection;
use crate::sensors::items::ItemsSpec;
use base::document::Place;
use base::error::InputError;

/// Maximum false alarm rate, so that a typing error is reported instead of simulated.
const MAX_FALSE_ALARMS: f64 = 1000.0;

pub(super) fn errors(spec: &ScenarioSpec, at: &Place) -> Vec<InputError> {
    let kinds: Vec<&str> = spec.items.keys().map(String::as_str).collect();
    let mut errors = Vec::new();
    let robots = spec.robots.iter();
    let robots = robots.map(|(kind, of)| (at.key("robots").key(kind), &of.sensors));
    let controllers = spec.controllers.iter();
    let controllers = controllers.map(|(kind, of)| (at.key("controllers").key(kind), &of.sensors));
    for (at, sensors) in robots.chain(controllers) {
        for (name, sensor) in sensors {
            let at = at.key("sensors").key(name);
            match &sensor.measures {
                Measures::Items(items) => {
                    errors.extend(errors_of(items, &kinds, &at));
                    let step_s = spec.clock.step_s;
                    let period_s = Schedule::new(sensor.rate_hz, step_s).period_s(step_s);
                    errors.extend(too_many(items, period_s, &at));
                }
                Measures::Robots(robots) => {
                    let detection = robots.detection_probability.as_ref();
                    errors.extend(
                        detection.and_then(|each| error_of(each, &at.key("detection_probability"))),
                    );
                }
                _ => {}
            }
        }
    }
    errors
}

fn errors_of(items: &ItemsSpec, kinds: &[&str], at: &Place) -> Vec<InputError> {
    let mut errors = Vec::new();
    let unknown = |kind: &str, at: &Place| {
        let is_known = kinds.contains(&kind);
        (!is_known).then(|| at.key(kind).unknown_key(kind, kinds.iter().copied()))
    };
    let believed = items.believed.as_ref();
    let tables = [
        (at.clone(), items.detection_probability.as_ref()),
        (
            at.key("believed"),
            believed.map(|each| &each.detection_probability),
        ),
    ];
    for (at, table) in tables {
        let at = at.key("detection_probability");
        for (kind, detection) in table.into_iter().flatten() {
            errors.extend(unknown(kind, &at));
            errors.extend(error_of(detection, &at.key(kind)));
        }
    }
    let alarms = at.key("false_alarm_rate_per_m2_s");
    for (kind, rate) in &items.false_alarm_rate_per_m2_s {
        errors.extend(unknown(kind, &alarms));
        if !(0.0..=MAX_FALSE_ALARMS).contains(rate) {
            let allowed = format!("a number from 0 to {MAX_FALSE_ALARMS}");
            errors.push(alarms.key(kind).error(allowed));
        }
    }
    errors
}

/// More false alarms than one measurement can yield.
fn too_many(items: &ItemsSpec, period_s: f64, at: &Place) -> Vec<InputError> {
    let rates = items.false_alarm_rate_per_m2_s.iter();
    let rates = rates.filter(|(_, rate)| (0.0..=MAX_FALSE_ALARMS).contains(*rate));
    let means = rates.map(|(kind, _)| (kind, items.false_alarms_per_measurement(kind, period_s)));
    let errors = means.filter(|(_, mean)| *mean > MAX_MEAN).map(|(kind, mean)| {
        let allowed = format!(
            "lower, so that a measurement has at most {MAX_MEAN} false alarms; in its whole range and \
             {period_s} s it has {mean:.0}"
        );
        at.key("false_alarm_rate_per_m2_s").key(kind).error(allowed)
    });
    errors.collect()
}

fn error_of(detection: &Detection, at: &Place) -> Option<InputError> {
    let Detection::Table(rows) = detection else {
        return None;
    };
    let ascends = rows.windows(2).all(|pair| pair[0][0] < pair[1][0]);
    let is_fine =
        |[distance, probability]: &[f64; 2]| *distance >= 0.0 && (0.0..=1.0).contains(probability);
    let allowed = "at least one pair of a distance of at least 0 and a probability from 0 to 1, each \
                   distance above the one before";
    let is_right = !rows.is_empty() && ascends && rows.iter().all(is_fine);
    (!is_right).then(|| at.error(allowed))
}
