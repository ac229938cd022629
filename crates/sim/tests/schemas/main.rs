//! What is made from the types of a scenario: the JSON Schema for editors, and the reference part of
//! docs/scenario.md. `make schemas` writes both anew, these tests hold them to the types.

#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod editor;
mod page;

use base::document::Document;
use base::engine::Engine;
use sim::runner::Metric;
use sim::scenario::ScenarioSpec;
use std::fs;
use std::path::PathBuf;

const SCHEMA: &str = "schemas/metric.schema.json";
const PAGE: &str = "docs/scenario.md";

/// What stands before it is written by hand.
const MARK: &str = "<!-- From here on made by `make schemas` from the types. -->\n";

/// The schema of the keys that all engines share.
fn common() -> serde_json::Value {
    base::scenario::schema(&Metric, &Document::parse("", "").unwrap())
}

fn path(file: &str) -> PathBuf {
    [env!("CARGO_MANIFEST_DIR"), "../..", file].iter().collect()
}

/// Holds a file to what it should say, or writes it.
fn hold(file: &str, made: &str) {
    if std::env::var_os("RENEW_SCHEMAS").is_some() {
        fs::write(path(file), made).unwrap();
    }
    let is_same = fs::read_to_string(path(file)).is_ok_and(|text| text == made);
    assert!(
        is_same,
        "{file} is not what the types say: run make schemas"
    );
}

#[test]
fn the_schema_for_editors_is_what_the_types_say() {
    let schema = serde_json::to_string_pretty(&editor::schema()).unwrap();
    hold(SCHEMA, &format!("{schema}\n"));
}

#[test]
fn the_reference_is_what_the_types_say() {
    let text = fs::read_to_string(path(PAGE)).unwrap();
    let (by_hand, _) = text.split_once(MARK).unwrap();
    hold(PAGE, &format!("{by_hand}{MARK}{}", page::reference()));
}

/// The scenario in the tutorial.
fn tutorial() -> String {
    let text = fs::read_to_string(path(PAGE)).unwrap();
    let (_, after) = text.split_once("```toml\n").unwrap();
    let (whole, _) = after.split_once("```\n").unwrap();
    whole.to_owned()
}

fn errors(text: &str) -> Vec<String> {
    let document = Document::parse("my.toml", text).unwrap();
    let read = ScenarioSpec::read(&document);
    let errors = read.map_or_else(|errors| errors.0, |_| Vec::new());
    errors.iter().map(ToString::to_string).collect()
}

#[test]
fn the_tutorials_scenario_is_without_errors() {
    assert!(tutorial().contains("engine = \"metric\""));
    assert!(errors(&tutorial()).is_empty());
}

#[test]
fn the_tutorials_errors_are_those_that_are_told() {
    let bad = tutorial()
        .replace("radius_m = 0.25", "raduis_m = 0.25")
        .replace("range_m = 3", "range_m = -3");
    let told = errors(&bad);
    let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    let page = words(&fs::read_to_string(path(PAGE)).unwrap());
    assert_eq!(told.len(), 3, "{told:?}");
    for error in told {
        assert!(page.contains(&words(&error)), "{error}");
    }
}

#[test]
fn all_that_can_be_weighed_is_in_the_tutorial() {
    let page = fs::read_to_string(path(PAGE)).unwrap();
    for measure in Metric.measures(&Document::parse("", "").unwrap()) {
        let row = format!("| `{}` | ", measure.name);
        assert!(page.contains(&row), "{row}");
    }
}
