//! The document reader never panics, for any text.

#![no_main]

use base::document::{Document, Section};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    for document in [
        Document::parse("file", text),
        Document::parse_yaml("file", text),
    ] {
        let errors = document.and_then(|document| {
            document.read(|root: &Section| {
                root.only(&["time_limit_s", "robots"]);
                let count = root.section("robots").integer("count", 1..=100);
                root.number("time_limit_s", 0.0..=1e6).and(count)
            })
        });
        if let Err(errors) = errors {
            assert!(!errors.to_string().is_empty());
        }
    }
});
