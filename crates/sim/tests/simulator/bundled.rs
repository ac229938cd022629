//! The bundled scenarios and robots.

use base::document::{Document, Value};
use sim::bodies::models::Model;
use sim::scenario::ScenarioSpec;
use std::path::PathBuf;

fn root() -> PathBuf {
    [env!("CARGO_MANIFEST_DIR"), "../.."].iter().collect()
}

fn folder() -> PathBuf {
    root().join("scenarios")
}

/// File names and contents of the bundled scenarios of the metric engine.
fn bundled() -> Vec<(String, String)> {
    let files = std::fs::read_dir(folder())
        .unwrap()
        .map(|entry| entry.unwrap().path());
    let tomls = files.filter(|file| file.extension().is_some_and(|end| end == "toml"));
    let all = tomls.map(|file| {
        let name = file.file_name().unwrap().to_str().unwrap().to_owned();
        (name, std::fs::read_to_string(file).unwrap())
    });
    all.filter(|(_, text)| text.contains("engine = \"metric\""))
        .collect()
}

#[test]
fn every_bundled_scenario_is_without_errors() {
    let open = |file: &str| std::fs::read(folder().join(file)).map_err(|why| why.to_string());
    let bundled = bundled();
    assert!(bundled.len() >= 2);
    for (name, text) in bundled {
        let document = Document::parse(&name, &text).unwrap();
        let read = ScenarioSpec::read_with(&document, open);
        assert!(read.is_ok(), "{}", read.unwrap_err());
    }
}

/// The paths of all numbers in a table, and the numbers.
fn numbers(value: &Value, path: &str) -> Vec<(String, String)> {
    match value {
        Value::Table(table) => table
            .iter()
            .flat_map(|(key, node)| {
                let dot = if path.is_empty() { "" } else { "." };
                numbers(&node.value, &format!("{path}{dot}{key}"))
            })
            .collect(),
        Value::Integer(number) => vec![(path.to_owned(), number.to_string())],
        Value::Float(number) => vec![(path.to_owned(), number.to_string())],
        _ => Vec::new(),
    }
}

#[test]
fn every_figure_of_a_bundled_robot_is_in_docs_with_its_source() {
    let page = std::fs::read_to_string(root().join("docs/robots.md")).unwrap();
    for (name, model) in Model::NAMES {
        let (_, after) = page.split_once(&format!("\n## {name}\n")).unwrap();
        let section = after.split("\n## ").next().unwrap();
        let rows = section
            .lines()
            .filter(|line| line.starts_with("| `"))
            .count();
        let document = Document::parse(name, model.text()).unwrap();
        let numbers = numbers(&document.get(&[]).unwrap().value, "");
        for (path, number) in &numbers {
            let row = format!("| `{path}` | {number} | ");
            assert!(section.contains(&row), "{name}: {row}");
        }
        assert_eq!(rows, numbers.len(), "{name}");
    }
}
