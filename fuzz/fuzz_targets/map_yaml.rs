//! The map reader never panics, for any YAML.

#![no_main]

use base::map::{Unknown, read};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    let image = |_: &str| Ok(b"P2 3 2 255  0 205 254  0 254 254".to_vec());
    if let Ok(map) = read("room.yaml", text, Unknown::Solid, image) {
        assert_eq!(map.columns() * map.rows(), 6);
        for edge in map.outline() {
            assert!(edge.length_m() > 0.0, "{edge:?}");
        }
    }
});
