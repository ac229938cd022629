//! How runs are scored.

use base::document::{Document, Node, Section, Table, Value};

/// Largest weight, so that no sum overflows and `1e30` is told as the slip that it is.
const MAX_WEIGHT: f64 = 1e6;

/// Largest `max` of a term.
const MAX_MAX: f64 = 1e12;

/// What a term can weigh: its name and the column of a run's outcome, in the order of the sum.
pub const TERMS: [(&str, &str); 6] = [
    ("time", "time_s"),
    ("robots", "robots"),
    ("failed", "failed"),
    ("found", "found"),
    ("collisions", "collisions"),
    ("paints", "paints"),
];

/// The terms whose columns have no natural bound.
const UNBOUNDED: [&str; 1] = ["paints"];

/// A figure of merit: a weighted sum of columns of a run's outcome; higher is better.
#[derive(Debug, Clone, PartialEq)]
pub struct Merit {
    /// How the scenario names it, if it does.
    pub name: Option<&'static str>,
    /// In the order of [`TERMS`]; at least one.
    pub terms: Vec<Term>,
}

/// One summand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Term {
    /// One of [`TERMS`].
    pub name: &'static str,
    /// What it weighs.
    pub column: &'static str,
    /// By how much; not 0.
    pub weight: f64,
    /// A value above this counts as this.
    pub max: Option<f64>,
}

impl Merit {
    /// Equation 5.2 of the thesis: -(0.3 T/10 + 0.2 n + 0.5 failures in ten).
    pub const EQUATION: &str = "equation-5.2";

    /// The sheet in the thesis's appendix, which forgets to divide the time by ten.
    pub const APPENDIX: &str = "appendix";

    /// Every figure of merit that a scenario can name, with the weight of a second.
    pub const NAMES: [(&str, f64); 2] = [(Self::EQUATION, -0.03), (Self::APPENDIX, -0.3)];

    fn named(name: &'static str, time: f64) -> Self {
        let weights = TERMS.into_iter().zip([time, -0.2, -5.0]);
        let term = |((name, column), weight)| Term {
            name,
            column,
            weight,
            max: None,
        };
        Self {
            name: Some(name),
            terms: weights.map(term).collect(),
        }
    }
}

/// Puts a table where the command line gave `time=-0.03,robots=-0.2`. What is wrong with it is told
/// where the table is read, as for a table in a file.
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
        // A second weight of one term makes a list of both, which is no weight.
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

pub(super) fn merit(root: &Section) -> Option<Merit> {
    if !matches!(root.value("merit"), Some(Value::Table(_))) {
        let names = Merit::NAMES.map(|(name, time)| (name, (name, time)));
        let (name, time) = root.choice("merit", &names)?;
        return Some(Merit::named(name, time));
    }
    let table = root.section("merit");
    table.only(&TERMS.map(|(name, _)| name));
    let given = TERMS.into_iter().filter(|(name, _)| table.has(name));
    let terms: Vec<Option<Term>> = given.map(|each| term(&table, each)).collect();
    let terms: Vec<Term> = terms.into_iter().collect::<Option<_>>()?;
    let terms: Vec<Term> = terms
        .into_iter()
        .filter(|term| term.weight != 0.0)
        .collect();
    if terms.is_empty() {
        let allowed = "a table with a weight other than 0, such as { time = -0.03, robots = -0.2 }";
        root.fault("merit", allowed);
        return None;
    }
    Some(Merit { name: None, terms })
}

fn term(table: &Section, (name, column): (&'static str, &'static str)) -> Option<Term> {
    let (weight, max) = match table.value(name) {
        Some(Value::Table(_)) => weight_and_max(&table.section(name))?,
        _ => (table.number(name, -MAX_WEIGHT..=MAX_WEIGHT)?, None),
    };
    if weight != 0.0 && max.is_none() && UNBOUNDED.contains(&name) {
        let allowed = format!(
            "given a max in the scenario, such as {{ weight = {weight}, max = 6720 }}: {name} have \
             no bound of their own"
        );
        table.fault(name, &allowed);
        return None;
    }
    Some(Term {
        name,
        column,
        weight,
        max,
    })
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
    use crate::runner::Configuration;
    use crate::scenario::Clock;
    use crate::{Contact, Task};
    use base::runner::Runner;

    /// The figure of merit of `text`, put where the command line puts it if it is no TOML.
    fn read(text: &str) -> Result<Merit, String> {
        let mut document = Document::parse("t.toml", &format!("merit = {text}")).unwrap();
        make_table(&mut document);
        document.read(merit).map_err(|faults| faults.to_string())
    }

    fn weights(text: &str) -> Vec<(&'static str, f64, Option<f64>)> {
        let terms = read(text).unwrap().terms;
        terms
            .iter()
            .map(|term| (term.name, term.weight, term.max))
            .collect()
    }

    #[test]
    fn a_name_a_table_and_a_text_can_say_the_same() {
        let expected = [
            ("time", -0.03, None),
            ("robots", -0.2, None),
            ("failed", -5.0, None),
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
        let expected = [("found", 2.0, None), ("paints", -1.0, Some(100.0))];
        assert_eq!(weights(text), expected);
    }

    #[test]
    fn every_fault_is_told_at_once() {
        let text = "{ tiem = 1, robots = 1e7, failed = nan, found = { max = -1 }, paints = -1 }";
        let faults = read(text).unwrap_err();
        for expected in [
            "t.toml:1: merit.tiem = 1: must be one of the known keys here: time, robots",
            "did you mean time?",
            "merit.robots = 10000000.0: must be a number from -1000000 to 1000000",
            "merit.failed = NaN: must be a number from",
            "merit.found.weight is missing: must be a number",
            "merit.found.max = -1: must be a number from 0 to 1000000000000",
            "merit.paints = -1: must be given a max in the scenario, such as { weight = -1, max = \
             6720 }: paints have no bound",
        ] {
            assert!(faults.contains(expected), "{expected}\nnot in\n{faults}");
        }
    }

    #[test]
    fn a_text_that_is_no_list_of_weights_is_told() {
        for (text, expected) in [
            ("\"time=fast\"", "merit.time = \"fast\": must be a number"),
            ("\"time=1,time=2\"", "merit.time = [1, 2]: must be a number"),
            ("\"time=1,\"", "merit.\"\" = \"\": must be one of the known"),
            ("\"time\"", "merit = \"time\": must be one of \"equation"),
            ("\"time=0\"", "merit = {...}: must be a table with a weight"),
            ("{}", "merit = {...}: must be a table with a weight"),
            ("3", "merit = 3: must be one of \"equation-5.2\""),
            ("\"paints=1\"", "merit.paints = 1: must be given a max"),
        ] {
            let faults = read(text).unwrap_err();
            assert!(faults.contains(expected), "{expected}\nnot in\n{faults}");
        }
    }

    #[test]
    fn the_terms_that_need_a_max_are_the_columns_without_bound() {
        let columns = Configuration {
            robots: 2,
            task: Task {
                contact: Contact::Touch,
                cap_paints: 50,
            },
            clock: Clock {
                paints_per_s: 50.0,
                cap_s: 1.0,
                cap_paints: 50,
            },
        }
        .columns();
        for (name, column) in TERMS {
            let column = columns.iter().find(|each| each.name == column).unwrap();
            assert_eq!(column.greatest.is_none(), UNBOUNDED.contains(&name));
        }
    }
}
