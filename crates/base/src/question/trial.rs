//! Whether each value of each factor is allowed: it is put into the scenario, which is read.

use super::names::{Unknown, read};
use super::values::{Values, values};
use super::vary::{in_order_of, put};
use super::{Configuration, Engine};
use crate::document::{Document, Node, Value};
use crate::fault::{Fault, Faults, shortened};

/// Bad values of one factor that are told one by one.
const TOLD: usize = 3;

/// What is wrong with single values: each is put into the document, which is read. `given` is what
/// the engine reads without it, and `known` what is wrong without it.
pub(super) fn faults_of_values(
    engine: &dyn Engine,
    document: &Document,
    given: Option<&Configuration>,
    known: &[Fault],
) -> Vec<Fault> {
    let Some(Value::Table(vary)) = document.get(&["study", "vary"]).map(|node| &node.value) else {
        return Vec::new();
    };
    // Where a section is no table, a value in it would make it one, and its other keys be missing.
    let is_readable = |path: &&str| {
        let below = |fault: &Fault| path.strip_prefix(fault.path.as_str());
        let mut below = known.iter().filter_map(below);
        !below.any(|rest| rest.starts_with('.'))
    };
    let paths = in_order_of(engine, vary.keys().map(String::as_str)).filter(is_readable);
    let trial = Trial {
        engine,
        document,
        given,
        known,
    };
    paths
        .filter_map(|path| Some(trial.faults(path, vary.get(path)?)))
        .flatten()
        .collect()
}

/// A scenario in which values are tried.
struct Trial<'t> {
    engine: &'t dyn Engine,
    document: &'t Document,
    given: Option<&'t Configuration>,
    known: &'t [Fault],
}

impl Trial<'_> {
    /// What is wrong with the values of one factor.
    fn faults(&self, path: &str, node: &Node) -> Vec<Fault> {
        let (given, origin) = (&node.value, &node.origin);
        let values = match given {
            Value::Text(text) => values(text).ok(),
            _ => None,
        };
        let values = match values {
            Some(Values::Listed(values)) => values,
            Some(Values::Between(low, high)) => vec![Value::Float(low), Value::Float(high)],
            None => return Vec::new(),
        };
        let mut varied = self.document.clone();
        let mut faults = Vec::new();
        for value in values {
            put(&mut varied, path, &value, origin);
            faults.extend(self.fault(path, &value, origin, &varied));
        }
        let keys: Vec<&str> = path.split('.').collect();
        let unknown = Unknown::on(&keys, self.engine, self.document);
        if let Some(unknown) = unknown.filter(|_| !faults.is_empty()) {
            return vec![unknown.fault(given, origin, &[])];
        }
        self.shortened(faults, path, origin)
    }

    /// What is wrong with a value that has been put into a document.
    fn fault(&self, path: &str, value: &Value, origin: &str, varied: &Document) -> Option<Fault> {
        match read(self.engine, varied) {
            Err(Faults(told)) => {
                let new = told.into_iter().find(|fault| !self.known.contains(fault));
                new.map(|fault| about(path, value, origin, fault))
            }
            Ok(read) => self.given.filter(|given| !is_alike(given, &read)).map(|_| {
                let allowed = "of a robot, an item or another thing that the scenario has";
                Fault {
                    origin: Some(origin.to_owned()),
                    ..Fault::new(path.to_owned(), Some(value.to_string()), allowed.to_owned())
                }
            }),
        }
    }

    /// The first faults, and how many more there are. Of a path that the scenario does not have one
    /// will do: the path itself may be wrong.
    fn shortened(&self, mut faults: Vec<Fault>, path: &str, origin: &str) -> Vec<Fault> {
        let keys: Vec<&str> = path.split('.').collect();
        let is_there = self.document.get(&keys).is_some();
        let told = if is_there { TOLD } else { 1 };
        let more = faults.len().saturating_sub(told);
        if more > 0 {
            faults.truncate(told);
            let path = shortened(path);
            let sentence = format!("{more} more values of {path} are not allowed either");
            faults.push(Fault {
                origin: Some(origin.to_owned()),
                ..Fault::new(String::new(), None, sentence)
            });
        }
        faults
    }
}

/// Whether two configurations have the same kinds of robots, and tell the same columns: with a
/// misspelt name a value would make a kind of its own.
fn is_alike(one: &Configuration, other: &Configuration) -> bool {
    let kinds = |of: &Configuration| -> Vec<String> {
        of.robots.iter().map(|(kind, _)| kind.clone()).collect()
    };
    let names = |of: &Configuration| -> Vec<_> {
        let columns = of.runner.columns().into_iter();
        columns.map(|column| column.name).collect()
    };
    kinds(one) == kinds(other) && names(one) == names(other)
}

/// A value's fault as the factor's: one that is told elsewhere, as of a cap that is too many paints
/// at a varied rate, would not name what to change.
fn about(path: &str, value: &Value, origin: &str, fault: Fault) -> Fault {
    if fault.path == path {
        return fault;
    }
    let other = shortened(&fault.path);
    let allowed = format!("one with which {other} is {}", fault.allowed);
    Fault {
        origin: Some(origin.to_owned()),
        ..Fault::new(path.to_owned(), Some(value.to_string()), allowed)
    }
}
