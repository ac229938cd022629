//! The schema of brains is that of the types; `make schemas` writes it.

use std::fs;

#[test]
fn the_schema_of_brains_is_that_of_the_types() {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../schemas/brain.schema.json"
    );
    let text = format!("{:#}\n", protocol::brain_schema());
    if std::env::var_os("RENEW_SCHEMAS").is_some() {
        fs::write(path, &text).unwrap();
    }
    let found = fs::read_to_string(path).unwrap();
    assert!(
        found == text,
        "brain.schema.json differs from the types: run make schemas"
    );
}
