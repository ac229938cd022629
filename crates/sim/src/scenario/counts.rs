//! The largest numbers of items and robots in the configurations of a study.

use super::features::Features;
use super::ready::Scenario;
use super::spec::ScenarioSpec;
use crate::world::item_number::ItemNumber;
use base::document::{Document, Node, Value};
use base::scenario::largest;

impl ScenarioSpec {
    /// Each kind of items, with the largest number of them in a run of any configuration of a document. Works on documents
    /// with errors, too.
    pub(crate) fn max_counts(document: &Document) -> Vec<(String, u32)> {
        let kinds = Self::names(document, &["items"]).unwrap_or_default();
        let kinds = kinds.into_iter().map(|name| {
            let count = max_number(document, &name);
            (name, count)
        });
        kinds.collect()
    }

    /// Whether runs of any configuration of a document draw their number of items of a kind.
    pub(crate) fn may_draw_number(document: &Document, name: &str) -> bool {
        let varied = format!("items.{name}.number");
        let number = document.get(&["items", name, "number"]);
        let is_drawn = |node: &Node| node.value == Value::Text("poisson".to_owned());
        number.is_some_and(is_drawn) || document.get(&["study", "vary", &varied]).is_some()
    }
}

impl Scenario {
    /// Its optional parts.
    pub(crate) fn features(&self) -> Features {
        Features {
            goals: !self.goals.is_empty(),
            acts: self.has_acts,
            clearance: self.clearance().is_some(),
            passage: self.passage.is_some(),
        }
    }
}

impl ScenarioSpec {
    /// The optional parts of any configuration of a document. Works on documents with errors, too.
    pub(crate) fn features(document: &Document) -> Features {
        Features {
            goals: Self::has_goals(document),
            acts: Self::has_acts(document),
            clearance: Self::may_clear(document),
            passage: Self::may_pass(document),
        }
    }

    /// Whether controllers are to clear a lane. Works on documents with errors, too.
    fn may_clear(document: &Document) -> bool {
        let names = Self::names(document, &["controllers"]).unwrap_or_default();
        let mut names = names.iter();
        names.any(|name| document.get(&["controllers", name, "clearance"]).is_some())
    }

    /// Whether vehicles are to pass the lane. Works on documents with errors, too.
    fn may_pass(document: &Document) -> bool {
        document.get(&["passage"]).is_some()
    }

    /// The kinds of items that are targets in any configuration of a document. Works on documents with errors, too.
    pub(crate) fn mines(document: &Document) -> Vec<String> {
        let mut names = Self::names(document, &["items"]).unwrap_or_default();
        names.retain(|name| Self::may_be_target(document, name));
        names
    }

    /// Whether items of a kind are targets in any configuration of a document.
    fn may_be_target(document: &Document, name: &str) -> bool {
        let factor = format!("items.{name}.target");
        let target = document.get(&["items", name, "target"]);
        let is_target = target.is_none_or(|node| node.value != Value::Bool(false));
        is_target || document.get(&["study", "vary", &factor]).is_some()
    }

    /// Whether anything can happen to items besides detections in any configuration of a document.
    pub(crate) fn has_acts(document: &Document) -> bool {
        let filled = Self::filled(document);
        let has = |table: &str, keys: &[&str]| {
            let names = Self::names(document, &[table]).unwrap_or_default();
            let mut paths = names
                .iter()
                .flat_map(|name| keys.iter().map(move |key| [table, name, key]));
            paths.any(|path| filled.get(&path).is_some() || is_varied(document, &path.join(".")))
        };
        has("items", &["hazard", "completed_by"])
            || has("robots", &["tools"])
            || has("models", &["tools"])
    }
}

/// Whether a study varies a key or one below it.
fn is_varied(document: &Document, path: &str) -> bool {
    let varied = document.get(&["study", "vary"]).map(|node| &node.value);
    let Some(Value::Table(varied)) = varied else {
        return false;
    };
    let is_part = |key: &String| {
        key.strip_prefix(path)
            .is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
    };
    varied.keys().any(is_part)
}

impl ScenarioSpec {
    /// Whether a document has kinds of goals. Works on documents with errors, too.
    pub(crate) fn has_goals(document: &Document) -> bool {
        Self::names(document, &["goals"]).is_some_and(|names| !names.is_empty())
    }
}

impl Scenario {
    /// The scenario as one of the configurations of a document.
    pub(super) fn among_those_of(mut self, document: &Document) -> Self {
        self.has_acts = ScenarioSpec::has_acts(document);
        for kind in &mut self.items {
            kind.max_count = max_number(document, &kind.name);
            kind.may_be_target = ScenarioSpec::may_be_target(document, &kind.name);
        }
        self
    }
}

/// The largest number of items of a kind in a run.
pub(super) fn max_number(document: &Document, name: &str) -> u32 {
    let count = max_count(document, "items", name);
    if ScenarioSpec::may_draw_number(document, name) {
        ItemNumber::Poisson.max(count)
    } else {
        count
    }
}

/// The largest count of items or robots of a kind, by the table of its kinds.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "numbers out of range are errors; here they become the nearest number"
)]
pub(super) fn max_count(document: &Document, table: &str, name: &str) -> u32 {
    largest(document, &[table, name, "count"]).unwrap_or_default() as u32
}
