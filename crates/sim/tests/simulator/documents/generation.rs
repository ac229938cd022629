//! Random values that match a schema, and random mutations of values.

use base::document::schema::Schema;
use base::document::{Node, Table, Value};
use serde_json::{Map, Value as Json};

/// Random numbers (Steele, Lea and Flood, *Fast splittable pseudorandom number generators*, 2014).
pub(crate) struct Random(pub(crate) u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    /// A random number below `end`.
    pub(crate) fn below(&mut self, end: usize) -> usize {
        usize::try_from(self.next() % end as u64).unwrap()
    }

    fn pick<'t, T>(&mut self, all: &'t [T]) -> &'t T {
        &all[self.below(all.len())]
    }
}

fn node(value: Value) -> Node {
    Node {
        value,
        origin: "t:1".to_owned(),
    }
}

/// A random value that `part` allows.
pub(crate) fn generate(schema: &Schema, part: &Json, random: &mut Random) -> Value {
    let Some(keywords) = schema.keywords(part) else {
        return Value::Bool(true);
    };
    if keywords.contains_key("x-names") {
        return generate(schema, &keywords["anyOf"][0], random);
    }
    for key in ["oneOf", "anyOf"] {
        if let Some(forms) = keywords.get(key).and_then(Json::as_array) {
            return generate(schema, random.pick(forms), random);
        }
    }
    if let Some(only) = keywords.get("const").and_then(Json::as_str) {
        return Value::Text(only.to_owned());
    }
    if let Some(names) = keywords.get("enum").and_then(Json::as_array) {
        return Value::Text(random.pick(names).as_str().unwrap().to_owned());
    }
    match keywords["type"].as_str().unwrap() {
        "object" => Value::Table(table(schema, keywords, random)),
        "array" => Value::List(list(schema, keywords, random)),
        "boolean" => Value::Bool(random.below(2) == 0),
        "string" => Value::Text((*random.pick(&["a", "mine", "ä\n"])).to_owned()),
        "integer" => Value::Integer(integer(keywords, random)),
        _ => number(keywords, random),
    }
}

fn table(schema: &Schema, keywords: &Map<String, Json>, random: &mut Random) -> Table {
    let required = keywords.get("required").and_then(Json::as_array);
    let is_required = |key: &str| required.is_some_and(|keys| keys.iter().any(|each| each == key));
    let mut table = Table::new();
    let properties = keywords.get("properties").and_then(Json::as_object);
    for (key, part) in properties.into_iter().flatten() {
        if is_required(key) || random.below(2) == 0 {
            table.insert(key.clone(), node(generate(schema, part, random)));
        }
    }
    if let Some(others @ Json::Object(_)) = keywords.get("additionalProperties") {
        for name in &["a", "mine", "best", "b c"][..random.below(4)] {
            table.insert((*name).to_owned(), node(generate(schema, others, random)));
        }
    }
    table
}

fn list(schema: &Schema, keywords: &Map<String, Json>, random: &mut Random) -> Vec<Node> {
    let bound = |key| keywords.get(key).and_then(Json::as_u64);
    let least = usize::try_from(bound("minItems").unwrap_or(0)).unwrap();
    let most = bound("maxItems").map_or(least + 3, |most| usize::try_from(most).unwrap());
    let length = least + random.below(most.min(least + 3) - least + 1);
    let items = (0..length).map(|_| node(generate(schema, &keywords["items"], random)));
    items.collect()
}

#[expect(clippy::cast_possible_truncation, reason = "bounds of 32 bits")]
fn integer(keywords: &Map<String, Json>, random: &mut Random) -> i64 {
    let bound = |key: &str, other| keywords.get(key).and_then(Json::as_f64).unwrap_or(other) as i64;
    let (least, most) = (bound("minimum", -9.0), bound("maximum", 9.0));
    *random.pick(&[
        least,
        most,
        least + (most - least) / 3,
        (least + 1).min(most),
    ])
}

fn number(keywords: &Map<String, Json>, random: &mut Random) -> Value {
    let bound = |key: &str, other| keywords.get(key).and_then(Json::as_f64).unwrap_or(other);
    let (least, most) = (bound("minimum", -1e300), bound("maximum", 1e300));
    let within = (least.max(0.0) + 1.0).min(most);
    let value = *random.pick(&[least, most, least / 2.0 + most / 2.0, within]);
    match random.below(2) {
        #[expect(clippy::cast_possible_truncation, reason = "checked to be whole")]
        0 if value.fract() == 0.0 && value.abs() < 1e15 => Value::Integer(value as i64),
        _ => Value::Float(value),
    }
}

/// Changes a random part of `value`.
pub(crate) fn mutate(value: &mut Value, random: &mut Random) {
    match value {
        Value::Table(table) if !table.is_empty() && random.below(8) > 0 => {
            let keys: Vec<String> = table.keys().cloned().collect();
            let key = random.pick(&keys);
            match random.below(8) {
                0 => drop(table.remove(key)),
                1 => {
                    let twin = table[key].clone();
                    table.insert(format!("{key}_"), twin);
                }
                _ => {
                    if let Some(node) = table.get_mut(key) {
                        mutate(&mut node.value, random);
                    }
                }
            }
        }
        Value::List(items) if !items.is_empty() && random.below(4) > 0 => {
            let at = random.below(items.len());
            match random.below(6) {
                0 => drop(items.remove(at)),
                1 => items.push(items[at].clone()),
                _ => mutate(&mut items[at].value, random),
            }
        }
        _ => *value = junk(random),
    }
}

fn junk(random: &mut Random) -> Value {
    let numbers = [f64::NAN, f64::INFINITY, -1.0, 1e-300, 1e300, -0.0, 0.5, 3.0];
    match random.below(12) {
        0 => Value::Bool(true),
        1 => Value::Integer(*random.pick(&[i64::MIN, i64::MAX, -1, 0, 1, 1_000_000])),
        2 => Value::Text(
            (*random.pick(&["", "mine", "ugv", "fixed", "range", "room.yaml"])).to_owned(),
        ),
        3 => Value::Date("1979-05-27".to_owned()),
        4 => Value::List(vec![node(junk(random))]),
        5 => Value::Table(Table::new()),
        6 => Value::Table([("kind".to_owned(), node(junk(random)))].into()),
        _ => Value::Float(*random.pick(&numbers)),
    }
}
