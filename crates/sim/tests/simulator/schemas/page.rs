//! The reference of scenarios, with every key.

use base::document::schema::Schema;
use serde_json::{Map, Value as Json};
use sim::scenario::ScenarioSpec;
use std::fmt::Write;

/// Definitions that several keys share, by the headings of their own sections.
const SHARED: [(&str, &str); 3] = [
    ("Term", "A term"),
    ("Placement", "A placement"),
    ("Detection", "A detection"),
];

/// The text of the reference.
pub(crate) fn reference() -> String {
    let common = Schema::closed(super::common().try_into().unwrap());
    let mut page = Page {
        schema: &common,
        text: String::from("\n## Every key\n\n### Top level\n\n"),
    };
    page.section(common.json(), "");
    page.shared();
    page.schema = ScenarioSpec::schema();
    let root = page.schema.json()["properties"].as_object().unwrap();
    for (key, part) in root {
        match key.as_str() {
            // Its keys are those of another section.
            "models" => page.head("`[models.NAME]`", part, part),
            _ => page.inner(part, key),
        }
    }
    page.shared();
    page.text
}

struct Page<'s> {
    schema: &'s Schema,
    text: String,
}

type Object = Map<String, Json>;

impl<'s> Page<'s> {
    /// The sections of the definitions that several keys share.
    fn shared(&mut self) {
        for (name, heading) in SHARED {
            let definitions = &self.schema.json()["definitions"];
            if let Some(part) = definitions.get(name) {
                self.head(heading, part, part);
                self.section(part, "");
            }
        }
    }

    /// The table at `path` and the heading of its own section, if it has one.
    fn own_section(&self, part: &'s Json, path: &str) -> Option<(&'s Json, String)> {
        let keywords = self.schema.keywords(part).unwrap();
        let (inner, heading) = match (keywords.get("additionalProperties"), keywords.get("items")) {
            (Some(each @ Json::Object(_)), _) => (each, format!("`[{path}.NAME]`")),
            (_, Some(each @ Json::Object(_))) => (each, format!("`[[{path}]]`")),
            _ => (part, format!("`[{path}]`")),
        };
        let is_own = shared(part).is_none() && shared(inner).is_none() && self.is_table(inner);
        is_own.then_some((inner, heading))
    }

    /// Writes the section of the table at `path`, if it has one.
    fn inner(&mut self, part: &'s Json, path: &str) {
        if let Some((inner, heading)) = self.own_section(part, path) {
            self.head(&heading, part, inner);
            let path = heading.trim_matches(|c| "`[]".contains(c)).to_owned();
            self.section(inner, &path);
        }
    }

    fn head(&mut self, heading: &str, part: &Json, inner: &Json) {
        let of_type = self.schema.keywords(inner).unwrap().get("description");
        let mut all: Vec<String> = Vec::new();
        let each = self.schema.keywords(inner).unwrap();
        let each = each
            .get("additionalProperties")
            .and_then(|each| self.schema.keywords(each));
        let of_each = each.and_then(|each| each.get("description"));
        for text in [
            part.get("description"),
            inner.get("description"),
            of_type,
            of_each,
        ] {
            let text = text.and_then(Json::as_str).unwrap_or_default();
            let text = text.replace("\n\n", " ");
            if !text.is_empty() && !all.contains(&text) {
                all.push(text);
            }
        }
        write!(self.text, "### {heading}\n\n{}\n\n", all.join(" ")).unwrap();
    }

    /// Whether `part` is a table, or has a variant that is one.
    fn is_table(&self, part: &Json) -> bool {
        let keywords = self.schema.keywords(part).unwrap();
        keywords.contains_key("properties")
            || forms(keywords).iter().any(|form| self.is_table(form))
    }

    /// Writes the keys of a table, then the sections of the tables in it.
    fn section(&mut self, part: &'s Json, path: &str) {
        let keywords = self.schema.keywords(part).unwrap();
        let forms = forms(keywords);
        if forms.is_empty() {
            self.rows(keywords, path, &|_| true);
        } else {
            self.forms(forms, path);
        }
        let mut seen: Vec<&str> = Vec::new();
        let every = forms.iter().chain([part]);
        let inner: Vec<_> = every.flat_map(|form| self.properties(form)).collect();
        for (key, inner) in inner {
            if !seen.contains(&key.as_str()) {
                seen.push(key);
                self.inner(inner, &joined(path, key));
            }
        }
    }

    fn properties(&self, part: &'s Json) -> impl Iterator<Item = (&'s String, &'s Json)> + use<'s> {
        let keywords = self.schema.keywords(part).unwrap();
        keywords
            .get("properties")
            .and_then(Json::as_object)
            .into_iter()
            .flatten()
    }

    /// Writes the variants in order, then the keys that all of them share.
    fn forms(&mut self, forms: &'s [Json], path: &str) {
        let is_common = |key: &str| {
            let of = |form| self.properties(form).find(|(name, _)| *name == key);
            let first = of(&forms[0]);
            forms.len() > 1 && first.is_some() && forms.iter().all(|form| of(form) == first)
        };
        let common: Vec<String> = self
            .properties(&forms[0])
            .map(|(key, _)| key.clone())
            .filter(|key| is_common(key))
            .collect();
        for form in forms {
            let keywords = self.schema.keywords(form).unwrap();
            let about = keywords
                .get("description")
                .and_then(Json::as_str)
                .unwrap_or_default();
            let kind = self
                .properties(form)
                .find_map(|(_, part)| part["const"].as_str());
            let name = kind.map_or_else(
                || self.schema.expected(form),
                |kind| format!("`kind = \"{kind}\"`"),
            );
            let line = format!("**{}.** {about}", capital(&name));
            write!(self.text, "{}\n\n", line.trim_end()).unwrap();
            self.rows(keywords, path, &|key| {
                !common.iter().any(|each| each == key)
            });
        }
        if !common.is_empty() {
            self.text.push_str("**Common to every kind:**\n\n");
            let keywords = self.schema.keywords(&forms[0]).unwrap();
            self.rows(keywords, path, &|key| common.iter().any(|each| each == key));
        }
    }

    /// Writes a table of the keys that satisfy `is_included`.
    fn rows(&mut self, keywords: &'s Object, path: &str, is_included: &dyn Fn(&str) -> bool) {
        let required = keywords.get("required").and_then(Json::as_array);
        let is_required =
            |key: &str| required.is_some_and(|keys| keys.iter().any(|each| each == key));
        let properties = keywords.get("properties").and_then(Json::as_object);
        let properties = properties.into_iter().flatten();
        let is_shown = |(key, part): &(&String, &Json)| {
            is_included(key) && part.get("const").is_none_or(|_| *key == "engine")
        };
        let rows: Vec<_> = properties.filter(is_shown).collect();
        if rows.is_empty() {
            return;
        }
        self.text
            .push_str("| key | description | allowed values | default |\n|---|---|---|---|\n");
        for (key, part) in rows {
            let keywords = self.schema.keywords(part).unwrap();
            let about = part.get("description").or(keywords.get("description"));
            let about = about
                .and_then(Json::as_str)
                .unwrap_or_default()
                .replace("\n\n", " ");
            let own = self.own_section(part, &joined(path, key));
            let default = match part.get("default").or(keywords.get("default")) {
                Some(default) if own.is_some() && !is_plain(default) => "see there".to_owned(),
                Some(default) => format!("`{}`", toml(default)),
                None if is_required(key) => "required".to_owned(),
                None => "none".to_owned(),
            };
            let allowed =
                own.map_or_else(|| self.allowed(part), |(_, heading)| link("see", &heading));
            writeln!(self.text, "| `{key}` | {about} | {allowed} | {default} |").unwrap();
        }
        self.text.push('\n');
    }

    /// The allowed values of a key.
    fn allowed(&self, part: &Json) -> String {
        if let Some(heading) = shared(part) {
            return link("", heading);
        }
        let keywords = self.schema.keywords(part).unwrap();
        if let Some(each @ Json::Object(_)) = keywords.get("additionalProperties") {
            return format!("for each name, {}", self.allowed(each));
        }
        self.schema.expected(part)
    }
}

fn joined(path: &str, key: &str) -> String {
    let dot = if path.is_empty() { "" } else { "." };
    format!("{path}{dot}{key}")
}

/// A link to the section with a heading.
fn link(before: &str, heading: &str) -> String {
    let kept = heading.to_lowercase().replace(' ', "-");
    let anchor: String = kept
        .chars()
        .filter(|c| c.is_alphanumeric() || *c == '-')
        .collect();
    let name = if heading.starts_with('`') {
        heading.to_owned()
    } else {
        heading.to_lowercase()
    };
    format!("{before} [{name}](#{anchor})").trim().to_owned()
}

fn forms(keywords: &Object) -> &[Json] {
    let parts = keywords
        .get("oneOf")
        .or(keywords.get("anyOf"))
        .and_then(Json::as_array);
    parts.map_or(&[], |parts| parts)
}

fn shared(part: &Json) -> Option<&'static str> {
    let target = part["$ref"].as_str()?.strip_prefix("#/definitions/")?;
    SHARED
        .iter()
        .find(|(name, _)| *name == target)
        .map(|(_, heading)| *heading)
}

/// Whether a default is short enough for the table of keys.
fn is_plain(default: &Json) -> bool {
    toml(default).len() <= 40
}

/// A value as TOML on one line.
fn toml(value: &Json) -> String {
    match value {
        Json::Object(table) => {
            let entries = table
                .iter()
                .map(|(key, value)| format!("{key} = {}", toml(value)));
            let entries: Vec<String> = entries.collect();
            if entries.is_empty() {
                "{}".to_owned()
            } else {
                format!("{{ {} }}", entries.join(", "))
            }
        }
        Json::Array(items) => {
            let items: Vec<String> = items.iter().map(toml).collect();
            format!("[{}]", items.join(", "))
        }
        Json::Number(number) => number
            .as_f64()
            .map_or(number.to_string(), |number| number.to_string()),
        plain => plain.to_string(),
    }
}

fn capital(text: &str) -> String {
    let mut chars = text.chars();
    let first = chars.next().map(|first| first.to_uppercase().to_string());
    first.unwrap_or_default() + chars.as_str()
}
