//! The JSON Schema of scenarios for editors, and the reference in `docs/scenario.md`. `make schemas`
//! generates both from the types; these tests compare the files with the types.

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

/// The text before this line is written by hand.
const MARK: &str = "<!-- From here on made by `make schemas` from the types. -->\n";

/// The schema of the keys that all engines share.
fn common() -> serde_json::Value {
    base::scenario::schema(&Metric, &Document::parse("", "").unwrap())
}

fn path(file: &str) -> PathBuf {
    [env!("CARGO_MANIFEST_DIR"), "../..", file].iter().collect()
}

/// Asserts that a file has this content, or writes it if `RENEW_SCHEMAS` is set.
fn check_or_write(file: &str, content: &str) {
    if std::env::var_os("RENEW_SCHEMAS").is_some() {
        fs::write(path(file), content).unwrap();
    }
    let is_same = fs::read_to_string(path(file)).is_ok_and(|text| text == content);
    assert!(is_same, "{file} differs from the types: run `make schemas`");
}

#[test]
fn the_schema_for_editors_matches_the_types() {
    let schema = serde_json::to_string_pretty(&editor::schema()).unwrap();
    check_or_write(SCHEMA, &format!("{schema}\n"));
}

#[test]
fn the_reference_matches_the_types() {
    let text = fs::read_to_string(path(PAGE)).unwrap();
    let (by_hand, _) = text.split_once(MARK).unwrap();
    check_or_write(PAGE, &format!("{by_hand}{MARK}{}", page::reference()));
}

/// The scenario of the tutorial.
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
fn the_errors_in_the_tutorial_are_the_actual_ones() {
    let bad = tutorial()
        .replace("radius_m = 0.25", "raduis_m = 0.25")
        .replace("range_m = 3", "range_m = -3");
    let errors = errors(&bad);
    let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    let page = words(&fs::read_to_string(path(PAGE)).unwrap());
    assert_eq!(errors.len(), 3, "{errors:?}");
    for error in errors {
        assert!(page.contains(&words(&error)), "{error}");
    }
}

#[test]
fn every_merit_term_is_in_the_tutorial() {
    let page = fs::read_to_string(path(PAGE)).unwrap();
    for term in Metric.merit_terms(&Document::parse("", "").unwrap()) {
        let row = format!("| `{}` | ", term.name);
        assert!(page.contains(&row), "{row}");
    }
}
