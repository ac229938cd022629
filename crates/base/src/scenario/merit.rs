//! How runs are scored.

use crate::document::{Document, Node, Section, Table, Value};
use crate::engine::{MeritTerm, NamedMerit};
use std::borrow::Cow;

/// Maximum absolute weight: no sum overflows, and `1e30` is reported as the typing error that it is.
pub(super) const MAX_WEIGHT: f64 = 1e6;

/// Maximum `max` of a term.
pub(super) const MAX_MAX: f64 = 1e12;

/// A figure of merit: a weighted sum of columns of a run's outcome; higher is better.
#[derive(Debug, Clone, PartialEq)]
pub struct Merit {
    /// Its name, if it is a predefined one.
    pub name: Option<&'static str>,
    /// At least one term, in the order of the engine's merit terms.
    pub terms: Vec<Term>,
}

/// A term of a figure of merit.
#[derive(Debug, Clone, PartialEq)]
pub struct Term {
    /// Its name in scenarios.
    pub name: Cow<'static, str>,
    /// The outcome column that it reads.
    pub column: Cow<'static, str>,
    /// Its weight; not 0.
    pub weight: f64,
    /// Cap: a larger value counts as this.
    pub max: Option<f64>,
}

impl Term {
    fn new(merit_term: &MeritTerm, weight: f64, max: Option<f64>) -> Self {
        Self {
            name: merit_term.name.clone(),
            column: merit_term.column.clone(),
            weight,
            max,
        }
    }
}

/// A predefined figure of merit, reduced to the terms that the engine has.
fn named(merit: &NamedMerit, merit_terms: &[MeritTerm]) -> Merit {
    let term = |merit_term: &MeritTerm| {
        let mut weights = merit.weights.iter();
        let (_, weight) = weights.find(|(name, _)| *name == merit_term.name)?;
        Some(Term::new(merit_term, *weight, None))
    };
    Merit {
        name: Some(merit.name),
        terms: merit_terms.iter().filter_map(term).collect(),
    }
}

/// Replaces the string `time=-0.03,robots=-0.2` of the command line by a table. Its errors are
/// reported when the table is read, like those of a table in a file.
pub(super) fn make_table(document: &mut Document) {
    let Some(Node { value, origin }) = document.get(&["merit"]).cloned() else {
        return;
    };
    let Value::Text(text) = value else { return };
    if !text.contains('=') {
        return;
    }
    let mut table = Table::new();
    for part in text.split(',') {
        let (name, weight) = part.split_once('=').unwrap_or((part, ""));
        let node = Node {
            value: number(weight.trim()),
            origin: origin.clone(),
        };
        // A second weight of a term makes a list of both, which is an error later.
        let twice = |first: &mut Node| first.value = Value::List(vec![first.clone(), node.clone()]);
        let entry = table.entry(name.trim().to_owned()).and_modify(twice);
        entry.or_insert_with(|| node.clone());
    }
    document.set(&["merit"], Value::Table(table), &origin);
}

fn number(text: &str) -> Value {
    let whole = text.parse().map(Value::Integer);
    let number = whole.or_else(|_| text.parse().map(Value::Float));
    number.unwrap_or_else(|_| Value::Text(text.to_owned()))
}

pub(super) fn merit(
    root: &Section,
    merit_terms: &[MeritTerm],
    known: &[NamedMerit],
) -> Option<Merit> {
    if !matches!(root.value("merit"), Some(Value::Table(_))) {
        let names: Vec<_> = known.iter().map(|each| (each.name, each)).collect();
        return Some(named(root.choice("merit", &names)?, merit_terms));
    }
    let table = root.section("merit");
    let names: Vec<&str> = merit_terms.iter().map(|each| &*each.name).collect();
    table.only(&names);
    let given = merit_terms.iter().filter(|each| table.has(&each.name));
    let terms: Vec<Option<Term>> = given.map(|each| term(&table, each)).collect();
    let mut terms: Vec<Term> = terms.into_iter().collect::<Option<_>>()?;
    terms.retain(|term| term.weight != 0.0);
    if terms.is_empty() {
        let allowed = "a table with a weight other than 0, such as { time = -0.03, robots = -0.2 }";
        root.error("merit", allowed);
        return None;
    }
    Some(Merit { name: None, terms })
}

fn term(table: &Section, merit_term: &MeritTerm) -> Option<Term> {
    let name = &merit_term.name;
    let (weight, max) = match table.value(name) {
        Some(Value::Table(_)) => weight_and_max(&table.section(name))?,
        _ => (table.number(name, -MAX_WEIGHT..=MAX_WEIGHT)?, None),
    };
    if let Some(usual) = merit_term.usual_max
        && weight != 0.0
        && max.is_none()
    {
        let allowed = format!(
            "a table with a max, such as {{ weight = {weight}, max = {usual} }}: {name} has no \
             natural bound"
        );
        table.error(name, &allowed);
        return None;
    }
    Some(Term::new(merit_term, weight, max))
}

fn weight_and_max(term: &Section) -> Option<(f64, Option<f64>)> {
    term.only(&["weight", "max"]);
    let weight = term.number("weight", -MAX_WEIGHT..=MAX_WEIGHT);
    let max = term.has("max").then(|| term.number("max", 0.0..=MAX_MAX));
    match max {
        Some(max) => Some((weight?, Some(max?))),
        None => Some((weight?, None)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn merit_terms() -> Vec<MeritTerm> {
        let paints = MeritTerm {
            usual_max: Some(6720.0),
            ..MeritTerm::new("paints", "paints")
        };
        vec![
            MeritTerm::new("time", "time_s"),
            MeritTerm::new("robots", "robots"),
            MeritTerm::new("failed", "failed"),
            MeritTerm::new("found", "found"),
            paints,
        ]
    }

    /// The figure of merit of `text`, put where the command line puts it if it is no TOML.
    fn read(text: &str) -> Result<Merit, String> {
        let mut document = Document::parse("t.toml", &format!("merit = {text}")).unwrap();
        make_table(&mut document);
        let named = [NamedMerit::EQUATION_5_2];
        let read = document.read(|root| merit(root, &merit_terms(), &named));
        read.map_err(|errors| errors.to_string())
    }

    fn weights(text: &str) -> Vec<(String, f64, Option<f64>)> {
        let terms = read(text).unwrap().terms;
        terms
            .iter()
            .map(|term| (term.name.to_string(), term.weight, term.max))
            .collect()
    }

    #[test]
    fn a_name_a_table_and_a_text_can_say_the_same() {
        let expected = [
            ("time".to_owned(), -0.03, None),
            ("robots".to_owned(), -0.2, None),
            ("failed".to_owned(), -5.0, None),
        ];
        assert_eq!(weights("\"equation-5.2\""), expected);
        assert_eq!(
            weights("{ robots = -0.2, failed = -5, time = -0.03 }"),
            expected
        );
        assert_eq!(
            weights("\"failed=-5, robots = -0.2 ,time=-3e-2\""),
            expected
        );
    }

    #[test]
    fn a_term_can_have_a_max_and_one_without_weight_is_left_out() {
        let text = "{ paints = { weight = -1, max = 100 }, found = { weight = 2 }, time = 0 }";
        let expected = [
            ("found".to_owned(), 2.0, None),
            ("paints".to_owned(), -1.0, Some(100.0)),
        ];
        assert_eq!(weights(text), expected);
    }

    #[test]
    fn all_errors_are_reported_at_once() {
        let text = "{ tiem = 1, robots = 1e7, failed = nan, found = { max = -1 }, paints = -1 }";
        let errors = read(text).unwrap_err();
        for expected in [
            "t.toml:1: merit.tiem is not a known key: expected one of time, robots",
            "did you mean time?",
            "merit.robots = 10000000.0: must be a number from -1000000 to 1000000",
            "merit.failed = NaN: must be a number from",
            "merit.found.weight is missing: expected a number",
            "merit.found.max = -1: must be a number from 0 to 1000000000000",
            "merit.paints = -1: must be a table with a max, such as { weight = -1, max = 6720 }: \
             paints has no natural bound",
        ] {
            assert!(errors.contains(expected), "{expected}\nnot in\n{errors}");
        }
    }

    #[test]
    fn a_string_instead_of_weights_is_an_error() {
        for (text, expected) in [
            ("\"time=fast\"", "merit.time = \"fast\": must be a number"),
            ("\"time=1,time=2\"", "merit.time = [1, 2]: must be a number"),
            (
                "\"time=1,\"",
                "merit.\"\" is not a known key: expected one of",
            ),
            ("\"time\"", "merit = \"time\": must be one of \"equation"),
            ("\"time=0\"", "merit = {...}: must be a table with a weight"),
            ("{}", "merit = {...}: must be a table with a weight"),
            ("3", "merit = 3: must be one of \"equation-5.2\""),
            (
                "\"paints=1\"",
                "merit.paints = 1: must be a table with a max",
            ),
        ] {
            let errors = read(text).unwrap_err();
            assert!(errors.contains(expected), "{expected}\nnot in\n{errors}");
        }
    }
}
