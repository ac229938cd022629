//! The JSON Schema of classic scenarios: `make schemas` generates it, and this test compares the file.

use std::fs;
use std::path::Path;

#[test]
fn the_schema_for_editors_is_what_the_reader_allows() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../schemas/classic.schema.json");
    let schema = serde_json::to_string_pretty(&classic::scenario::schema()).unwrap();
    let made = format!("{schema}\n");
    if std::env::var_os("RENEW_SCHEMAS").is_some() {
        fs::write(&file, &made).unwrap();
    }
    let is_same = fs::read_to_string(&file).is_ok_and(|text| text == made);
    assert!(
        is_same,
        "classic.schema.json differs from the types: run `make schemas`"
    );
}
