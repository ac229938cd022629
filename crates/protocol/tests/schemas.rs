//! The schemas that the types of Python and TypeScript are generated from; `make schemas` writes them.

#![expect(clippy::unwrap_used, reason = "a test may panic")]

use serde_json::Value;
use std::fs;
use std::path::PathBuf;

/// Compares a file with a schema, or writes it.
fn check(file: &str, schema: &Value) {
    let path: PathBuf = [env!("CARGO_MANIFEST_DIR"), "../../schemas", file]
        .iter()
        .collect();
    let text = format!("{}\n", serde_json::to_string_pretty(schema).unwrap());
    if std::env::var_os("RENEW_SCHEMAS").is_some() {
        fs::write(&path, &text).unwrap();
    }
    let is_same = fs::read_to_string(&path).is_ok_and(|found| found == text);
    assert!(is_same, "{file} differs from the types: run make schemas");
}

#[test]
fn the_schema_of_brains_is_that_of_the_types() {
    check("brain.schema.json", &protocol::brain_schema());
}

#[test]
fn the_schema_of_messages_is_that_of_the_types() {
    check("page.schema.json", &protocol::page_schema());
}
