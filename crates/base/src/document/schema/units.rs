//! Units of numbers, from the suffixes of their keys.
//!
//! A key such as `radius_m` gives its schema the keyword `x-unit`, here `"m"`: error messages, the
//! reference and the page's fields show it.

use super::keywords::Object;
use serde_json::Value as Json;

/// The keyword of a schema that holds its unit.
const KEYWORD: &str = "x-unit";

/// Suffixes of keys with their units and how messages write these. The first that fits counts.
const UNITS: [(&str, &str, &str); 16] = [
    ("_per_m2_s", "1/(m² s)", "per m² and second"),
    ("_j_per_m", "J/m", "joules per metre"),
    ("_per_s", "1/s", "per second"),
    ("_m_s2", "m/s²", "m/s²"),
    ("_m_s", "m/s", "m/s"),
    ("_rad_s", "rad/s", "radians per second"),
    ("_deg_s", "°/s", "degrees per second"),
    ("_m2", "m²", "m²"),
    ("_m", "m", "metres"),
    ("_s", "s", "seconds"),
    ("_rad", "rad", "radians"),
    ("_deg", "°", "degrees"),
    ("_hz", "Hz", "hertz"),
    ("_kg", "kg", "kilograms"),
    ("_j", "J", "joules"),
    ("_w", "W", "watts"),
];

/// Gives every property of a schema whose key has a unit the keyword `x-unit`.
pub fn annotate(schema: &mut Json) {
    match schema {
        Json::Object(keywords) => {
            if let Some(Json::Object(properties)) = keywords.get_mut("properties") {
                for (key, property) in properties {
                    if let Some((_, unit, _)) = UNITS.iter().find(|each| key.ends_with(each.0)) {
                        mark(property, unit);
                    }
                }
            }
            keywords.values_mut().for_each(annotate);
        }
        Json::Array(parts) => parts.iter_mut().for_each(annotate),
        _ => {}
    }
}

/// The unit of a table of numbers is that of each of them.
fn mark(property: &mut Json, unit: &str) {
    let Some(keywords) = property.as_object_mut() else {
        return;
    };
    match keywords.get_mut("additionalProperties") {
        Some(each @ Json::Object(_)) => mark(each, unit),
        _ => {
            keywords.insert(KEYWORD.to_owned(), unit.into());
        }
    }
}

/// The unit of a schema as messages write it: ` (metres)`; empty without one.
pub(super) fn unit(part: &Json, keywords: &Object) -> String {
    let symbol = part.get(KEYWORD).or(keywords.get(KEYWORD));
    let mut known = UNITS.iter();
    let known = known.find(|(_, unit, _)| symbol.is_some_and(|symbol| symbol == unit));
    known.map_or(String::new(), |(_, _, name)| format!(" ({name})"))
}
