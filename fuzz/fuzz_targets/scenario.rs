//! The scenario reader never panics, for any text, and every error has an origin.

#![no_main]

use base::document::Document;
use libfuzzer_sys::fuzz_target;
use sim::scenario::ScenarioSpec;

fn open(file: &str) -> Result<Vec<u8>, String> {
    match file {
        "room.yaml" => Ok("image: room.pgm\nresolution: 0.5\norigin: [9, 8, 0.5]\nnegate: 0\n\
                           occupied_thresh: 0.65\nfree_thresh: 0.196\n"
            .into()),
        "room.pgm" => Ok("P2 3 2 255  0 205 254  0 254 254".into()),
        _ => Err("there is no such file".to_owned()),
    }
}

fuzz_target!(|text: &str| {
    let read = Document::parse("t", text)
        .and_then(|document| ScenarioSpec::read_with(&document, open).map(drop));
    if let Err(errors) = read {
        assert!(!errors.0.is_empty());
        for error in errors.0 {
            assert!(error.origin.is_some(), "{error}");
            assert!(!error.allowed.starts_with("readable"), "{error}");
        }
    }
});
