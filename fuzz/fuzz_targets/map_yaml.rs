//! The map reader never panics, for any YAML.

#![no_main]

use base::map::{MapOptions, Unknown, read};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    let image = |_: &str| Ok(b"P2 3 2 255  0 205 254  0 254 254".to_vec());
    let options = MapOptions {
        unknown: Unknown::Solid,
        at: None,
    };
    if let Ok(map) = read("room.yaml", text, options, image) {
        assert_eq!(map.columns() * map.rows(), 6);
        for edge in map.outline() {
            assert!(edge.length_m() > 0.0, "{edge:?}");
        }
    }
});
