//! The scenarios that come with the program.

use base::document::Document;
use sim::scenario::ScenarioSpec;
use std::path::PathBuf;

fn folder() -> PathBuf {
    [env!("CARGO_MANIFEST_DIR"), "../..", "scenarios"]
        .iter()
        .collect()
}

/// The texts of the shipped scenarios of the metric engine, by file.
fn shipped() -> Vec<(String, String)> {
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
fn every_shipped_scenario_is_without_faults() {
    let open = |file: &str| std::fs::read(folder().join(file)).map_err(|why| why.to_string());
    let shipped = shipped();
    assert!(shipped.len() >= 2);
    for (name, text) in shipped {
        let document = Document::parse(&name, &text).unwrap();
        let read = ScenarioSpec::read_with(&document, open);
        assert!(read.is_ok(), "{}", read.unwrap_err());
    }
}
