//! Detectors that detect items that there are, with probabilities.

use super::ScenarioSpec;
use crate::sensing::Measures;
use crate::sensing::items::{Detection, ItemsSpec};
use base::document::Place;
use base::fault::Fault;

/// Most false contacts that a scenario may ask for, so that a slip is told and not simulated.
const MAX_FALSE_ALARMS: f64 = 1000.0;

pub(super) fn faults(spec: &ScenarioSpec, at: &Place) -> Vec<Fault> {
    let kinds: Vec<&str> = spec.items.keys().map(String::as_str).collect();
    let mut faults = Vec::new();
    for (robot, of) in &spec.robots {
        for (name, sensor) in &of.sensors {
            let at = at.key("robots").key(robot).key("sensors").key(name);
            match &sensor.measures {
                Measures::Items(items) => faults.extend(faults_of(items, &kinds, &at)),
                Measures::Robots(robots) => {
                    let detection = robots.detects.as_ref();
                    faults.extend(detection.and_then(|each| fault_of(each, &at.key("detects"))));
                }
                _ => {}
            }
        }
    }
    faults
}

fn faults_of(items: &ItemsSpec, kinds: &[&str], at: &Place) -> Vec<Fault> {
    let mut faults = Vec::new();
    let unknown = |kind: &str, at: &Place| {
        let is_known = kinds.contains(&kind);
        (!is_known).then(|| at.key(kind).names_none_of(kind, kinds.iter().copied()))
    };
    let detects = at.key("detects");
    for (kind, detection) in items.detects.iter().flatten() {
        faults.extend(unknown(kind, &detects));
        faults.extend(fault_of(detection, &detects.key(kind)));
    }
    let alarms = at.key("false_alarms_per_m2_s");
    for (kind, rate) in &items.false_alarms_per_m2_s {
        faults.extend(unknown(kind, &alarms));
        if !(0.0..=MAX_FALSE_ALARMS).contains(rate) {
            let allowed = format!("a number from 0 to {MAX_FALSE_ALARMS}");
            faults.push(alarms.key(kind).fault(allowed));
        }
    }
    faults
}

fn fault_of(detection: &Detection, at: &Place) -> Option<Fault> {
    let Detection::Table(rows) = detection else {
        return None;
    };
    let ascends = rows.windows(2).all(|pair| pair[0][0] < pair[1][0]);
    let is_fine =
        |[distance, probability]: &[f64; 2]| *distance >= 0.0 && (0.0..=1.0).contains(probability);
    let allowed = "at least one pair of a distance of at least 0 and a probability from 0 to 1, each \
                   distance above the one before";
    let is_right = !rows.is_empty() && ascends && rows.iter().all(is_fine);
    (!is_right).then(|| at.fault(allowed))
}
