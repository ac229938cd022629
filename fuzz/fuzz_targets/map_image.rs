//! The map reader never panics, for any image, and the outline of every map encloses its solid cells.

#![no_main]

use base::map::{MapOptions, read};
use libfuzzer_sys::fuzz_target;

const ROOM: &str = "image: room.pgm\nresolution: 1\norigin: [0, 0, 0]\nnegate: 0\n\
                    occupied_thresh: 0.65\nfree_thresh: 0.196\n";

fuzz_target!(|image: &[u8]| {
    let Ok(map) = read("room.yaml", ROOM, MapOptions::default(), |_| {
        Ok(image.to_vec())
    }) else {
        return;
    };
    let cells = (0..map.rows()).flat_map(|row| (0..map.columns()).map(move |at| (at, row)));
    let solid = cells.filter(|&(column, row)| map.occupancy(column, row) == Some(100));
    let doubled: f64 = map
        .outline()
        .iter()
        .map(|edge| edge.from.cross(edge.to))
        .sum();
    assert_eq!(-doubled / 2.0, solid.count() as f64);
});
