use super::*;
use proptest::prelude::*;
use std::f64::consts::FRAC_PI_2;
use std::fmt::Write;

mod images;

const ROOM: &str = "image: room.pgm\nresolution: 0.5\norigin: [1, 2, 0]\nnegate: 0\n\
                    occupied_thresh: 0.65\nfree_thresh: 0.196\n";

/// The distance, in lengths of `direction`, at which the ray from `origin` meets the free side of a
/// wall; the solid side, and a ray along the wall, meet nothing. An end on the ray counts for both
/// sides, so that a ray between two walls with a common end meets one of them.
fn hit(wall: &Segment, origin: Point, direction: Point) -> Option<f64> {
    let (from, to) = (origin.to(wall.from), origin.to(wall.to));
    let (right, left) = (direction.cross(from), direction.cross(to));
    let comes_from_free = right <= 0.0 && left >= 0.0 && left > right;
    let ahead = (direction.dot(from) * left - direction.dot(to) * right)
        / ((left - right) * direction.length_squared());
    (comes_from_free && ahead >= 0.0).then_some(ahead)
}

/// `ROOM` with lines instead of those for the same keys, or further ones.
fn yaml(lines: &[&str]) -> String {
    let key = |line: &str| line.split(':').next().map(str::to_owned);
    let changed: Vec<_> = lines.iter().map(|line| key(line)).collect();
    let kept = ROOM.lines().filter(|line| !changed.contains(&key(line)));
    let lines: Vec<_> = kept.chain(lines.iter().copied()).collect();
    lines.join(
        "
",
    ) + "
"
}

fn load(text: &str, image: &[u8]) -> Result<OccupancyMap, InputErrors> {
    read("room.yaml", text, MapOptions::default(), |_| {
        Ok(image.to_vec())
    })
}

fn errors(text: &str, image: &[u8]) -> String {
    load(text, image).unwrap_err().to_string()
}

/// The map of rows of cells as a person would draw them: `#` occupied, `.` free, `?` unknown.
fn drawn(rows: &[&str], lines: &[&str], unknown: Unknown) -> OccupancyMap {
    let mut image = format!("P2 {} {} 255", rows[0].len(), rows.len());
    for cell in rows.iter().flat_map(|row| row.chars()) {
        let value = match cell {
            '#' => 0,
            '?' => 205,
            _ => 254,
        };
        write!(image, " {value}").unwrap();
    }
    let options = MapOptions { unknown, at: None };
    let open = |_: &str| Ok(image.into_bytes());
    read("room.yaml", &yaml(lines), options, open).unwrap()
}

/// Occupancies, the lowest row first.
fn occupancies(map: &OccupancyMap) -> Vec<i8> {
    let cells = (0..map.rows()).flat_map(|row| (0..map.columns()).map(move |at| (at, row)));
    cells
        .map(|(column, row)| map.occupancy(column, row).unwrap())
        .collect()
}

/// Area within the outline by the shoelace formula; what is solid runs clockwise.
fn area_within(outline: &[Segment]) -> f64 {
    -outline
        .iter()
        .map(|edge| edge.from.cross(edge.to))
        .sum::<f64>()
        / 2.0
}

#[test]
fn the_first_row_of_the_image_is_the_top_of_the_map() {
    let map = load(ROOM, b"P2 3 2 255  0 205 254  254 0 254").unwrap();
    assert_eq!((map.columns(), map.rows()), (3, 2));
    assert_eq!(occupancies(&map), [0, 100, 0, 100, -1, 0]);
    let bounds = Rectangle::spanned([1.0, 2.0].into(), [2.5, 3.0].into());
    assert_eq!(map.bounds(), bounds);
    assert!(map.is_solid([1.75, 2.25].into()));
    assert!(map.is_solid([1.25, 2.75].into()));
    assert!(!map.is_solid([0.75, 2.75].into()));
}

#[test]
fn the_yaw_turns_the_map_anticlockwise_about_its_lower_left_corner() {
    let turn = format!("origin: [1, 2, {FRAC_PI_2}]");
    let map = drawn(&["..#"], &[&turn], Unknown::Free);
    // The cell from 1.0 to 1.5 along the map's x is from 1.0 to 1.5 above its origin.
    assert!(map.is_solid([0.75, 3.25].into()));
    assert!(!map.is_solid([0.75, 2.75].into()));
    let corners = map.corners();
    for (corner, expected) in corners
        .iter()
        .zip([[1.0, 2.0], [1.0, 3.5], [0.5, 3.5], [0.5, 2.0]])
    {
        assert!(corner.to(expected.into()).length() < 1e-12, "{corner:?}");
    }
    assert!((area_within(map.outline()) - 0.25).abs() < 1e-12);
}

#[test]
fn a_probability_at_a_threshold_is_unknown() {
    // Probabilities 0.2, 0.4, 0.6, 0.8 and 1, from (255 - v) / 255.
    let image = b"P2 5 1 255  204 153 102 51 0";
    let text = yaml(&["free_thresh: 0.4", "occupied_thresh: 0.8"]);
    assert_eq!(
        occupancies(&load(&text, image).unwrap()),
        [0, -1, -1, -1, 100]
    );
}

#[test]
fn negate_makes_white_occupied() {
    let image = b"P2 4 1 255  0 20 205 255";
    for (negate, expected) in [("0", [100, 100, -1, 0]), ("1", [0, 0, 100, 100])] {
        let text = yaml(&[&format!("negate: {negate}")]);
        assert_eq!(occupancies(&load(&text, image).unwrap()), expected);
    }
    let negated = load(&yaml(&["negate: true"]), image).unwrap();
    assert_eq!(occupancies(&negated), [0, 0, 100, 100]);
}

#[test]
fn scale_maps_what_lies_between_the_thresholds_to_percents() {
    // Probabilities 0.1, 0.2, 0.225 (12.5 %, to the even), 0.3, 0.4, 0.5 of 1000.
    let image = b"P2 6 1 1000  900 800 775 700 600 500";
    let text = yaml(&["mode: scale", "free_thresh: 0.2", "occupied_thresh: 0.4"]);
    assert_eq!(
        occupancies(&load(&text, image).unwrap()),
        [0, 0, 12, 50, 100, 100]
    );
}

#[test]
fn raw_takes_the_pixel_as_the_percentage() {
    let image = b"P2 5 1 255  0 64 100 101 255";
    for negate in ["negate: 0", "negate: 1"] {
        let map = load(&yaml(&["mode: raw", negate]), image).unwrap();
        assert_eq!(occupancies(&map), [0, 64, 100, -1, -1]);
    }
}

#[test]
fn what_is_unknown_is_occupied_on_request() {
    let rows = ["#?.", "..?"];
    let free = drawn(&rows, &[], Unknown::Free);
    let solid = drawn(&rows, &[], Unknown::Solid);
    assert!((area_within(free.outline()) - 0.25).abs() < 1e-12);
    assert!((area_within(solid.outline()) - 0.75).abs() < 1e-12);
    assert!(solid.is_solid([2.25, 2.25].into()) && !free.is_solid([2.25, 2.25].into()));
}

#[test]
fn edges_are_as_long_as_they_are_straight() {
    let map = drawn(
        &["......", ".####.", ".#..#.", ".####.", "......"],
        &[],
        Unknown::Free,
    );
    assert_eq!(map.outline().len(), 8);
    assert!((area_within(map.outline()) - 10.0 * 0.25).abs() < 1e-12);
}

#[test]
fn edges_end_where_two_cells_touch_by_a_corner() {
    let map = drawn(&[".#", "#."], &[], Unknown::Free);
    let corner = Point { x: 1.5, y: 2.5 };
    let at_corner = |edge: &&Segment| edge.from == corner || edge.to == corner;
    assert_eq!(map.outline().iter().filter(at_corner).count(), 4);
}

#[test]
fn all_errors_of_the_yaml_are_reported_at_once_with_their_lines() {
    let text = "image: ''\nresolution: -0.05\norigin: [0, .nan]\nnegate: 2\n\
                occupied_tresh: 0.65\nfree_thresh: 1.5\nmode: trinery\n";
    assert_eq!(
        errors(text, b""),
        "room.yaml:5: occupied_tresh is not a known key: expected one of image, \
         resolution, origin, negate, occupied_thresh, free_thresh, mode; \
         did you mean occupied_thresh?\n\
         room.yaml:1: image = \"\": must be a non-empty string of one line\n\
         room.yaml:2: resolution = -0.05: must be a number from 0.0001 to 100\n\
         room.yaml:3: origin[1] = NaN: must be a number from -1000000 to 1000000\n\
         room.yaml:4: negate = 2: must be 0, 1, false or true\n\
         room.yaml:6: free_thresh = 1.5: must be a number from 0 to 1\n\
         room.yaml: occupied_thresh is missing: expected a number from 0 to 1\n\
         room.yaml:7: mode = \"trinery\": must be one of \"trinary\", \"scale\", \"raw\"; \
         did you mean \"trinary\"?"
    );
}

#[test]
fn keys_that_map_server_does_not_read_are_ignored() {
    // As of nav2_system_tests/maps/map_circular.yaml, and of other programs.
    let lines = [
        "map_type: occupancy",
        "width: 3",
        "name: [a, {b: c}]",
        "modes: raw",
    ];
    let image = b"P2 3 1 255  0 205 254";
    let map = load(&yaml(&lines), image).unwrap();
    assert_eq!(map, load(ROOM, image).unwrap());
    let error = errors(&yaml(&["map_type: occupancy", "negate: 2"]), image);
    assert_eq!(
        error,
        "room.yaml:7: negate = 2: must be 0, 1, false or true"
    );
}

#[test]
fn a_key_that_is_nearly_a_missing_one_is_reported_with_it() {
    let text = ROOM.replace("resolution:", "resolutoin:") + "map_type: occupancy\n";
    assert_eq!(
        errors(&text, b""),
        "room.yaml:2: resolutoin is not a known key: expected one of image, resolution, origin, negate, \
         occupied_thresh, free_thresh, mode; did you mean resolution?\n\
         room.yaml: resolution is missing: expected a number from 0.0001 to 100"
    );
}

#[test]
fn a_map_is_moved_to_a_given_place_and_keeps_its_yaw() {
    let turned = yaml(&[&format!("origin: [-10, -10, {FRAC_PI_2}]")]);
    let options = MapOptions {
        at: Some([1.0, 2.0].into()),
        ..MapOptions::default()
    };
    let open = |_: &str| Ok(b"P2 3 1 255  254 254 0".to_vec());
    let map = read("room.yaml", &turned, options, open).unwrap();
    let there = drawn(
        &["..#"],
        &[&format!("origin: [1, 2, {FRAC_PI_2}]")],
        Unknown::Free,
    );
    assert_eq!(map, there);
    assert_eq!(map.origin(), [1.0, 2.0].into());
}

#[test]
fn occupied_cells_outside_of_a_rectangle_are_counted_by_their_centres() {
    // The origin that SLAM programs write: the world begins in the middle of the map.
    let rows = ["#..#", "?..#", "#..#", "#..?"];
    let map = drawn(
        &rows,
        &["origin: [-1, -1, 0]", "mode: trinary"],
        Unknown::Solid,
    );
    let world = Rectangle::spanned(Point::default(), [2.0, 2.0].into());
    assert_eq!(map.occupied_and_outside(world), (6, 4));
    let whole = Rectangle::spanned([-1.0, -1.0].into(), [1.0, 1.0].into());
    assert_eq!(map.occupied_and_outside(whole), (6, 0));
}

#[test]
fn thresholds_are_in_order_and_the_pose_has_three_numbers() {
    let text = yaml(&["origin: [0, 0]", "free_thresh: 0.7"]);
    assert_eq!(
        errors(&text, b""),
        "room.yaml:5: origin = [0, 0]: must be a list of three numbers: x and y in metres, yaw in radians\n\
         room.yaml:6: free_thresh = 0.7: must be a number below occupied_thresh, which is 0.65"
    );
}

#[test]
fn an_image_that_cannot_be_opened_is_reported_at_its_key() {
    let errors = read("a/room.yaml", ROOM, MapOptions::default(), |name| {
        Err(format!("{name} is not there"))
    });
    assert_eq!(
        errors.unwrap_err().to_string(),
        "a/room.yaml:1: image = \"room.pgm\": must be the name of a PGM or PNG image; \
         room.pgm is not there"
    );
}

#[test]
fn a_header_with_a_wrong_size_is_rejected_before_memory_is_allocated() {
    for (image, expected) in [
        (
            &b"P5 1000000000 1000000000 255\n"[..],
            "room.pgm:1: the image must have at most 64000000 pixels, not 1000000000 x 1000000000",
        ),
        (
            b"P5 4294967296 1 255\n",
            "room.pgm:1: the width must be a whole number from 1 to 4294967295, not \"4294967296\"",
        ),
        (
            b"P5 0 1 255\n",
            "room.pgm:1: the width must be a whole number from 1 to 4294967295, not \"0\"",
        ),
        (
            b"P5\n3\n-1 255\n",
            "room.pgm:3: the height must be a whole number from 1 to 4294967295, not \"\"",
        ),
        (
            b"P5\n8000 8000 255\n12345",
            "room.pgm: truncated: 8000 x 8000 pixels need 64000000 bytes, and 5 follow",
        ),
        (
            b"P5\n2 1 256\n123",
            "room.pgm: truncated: 2 x 1 pixels need 4 bytes, and 3 follow",
        ),
        (
            b"P2\n3 1 255\n1 2",
            "room.pgm:2: truncated: 3 x 1 pixels need 5 bytes, and 4 follow",
        ),
        (
            b"P2\n3 1 255\n100 200\n",
            "room.pgm:4: truncated within the pixels, or a pixel is not a number",
        ),
        (b"P2\n1 1 255\n70000", "room.pgm:3: a pixel is above 65535"),
        (
            b"P2\n1 1 254\n255",
            "room.pgm:3: a pixel is 255, above the maximum value 254",
        ),
        (
            b"P5 1 1 9\n\n",
            "room.pgm: a pixel is 10, above the maximum value 9",
        ),
        (
            b"P5 1 1 255\n12",
            "room.pgm: data follows the last pixel of the image",
        ),
        (
            b"P5 1 1 65536\n12",
            "room.pgm:1: the maximum value must be a whole number from 1 to 65535, not \"65536\"",
        ),
        (
            b"P5 1 1",
            "room.pgm:1: the maximum value must be a whole number from 1 to 65535, not \"\"",
        ),
        (
            b"P6 1 1 255\n123",
            "room.pgm: must be a PGM image (P5 or P2) or a PNG image; it is a PPM image: convert it, \
             such as with ImageMagick: magick IMAGE IMAGE.png",
        ),
        (
            b"",
            "room.pgm: must be a PGM image (P5 or P2) or a PNG image; it is an unknown format: convert \
             it, such as with ImageMagick: magick IMAGE IMAGE.png",
        ),
    ] {
        assert_eq!(errors(ROOM, image), expected);
    }
}

#[test]
fn comments_may_stand_anywhere_in_the_header() {
    let image = b"P5# CREATOR: map_saver.cpp 0.050 m/pix\n2 # two\n1\n#\n255#last\n\x00\xfe";
    assert_eq!(occupancies(&load(ROOM, image).unwrap()), [100, 0]);
}

#[test]
fn a_short_yaml_cannot_become_a_large_document() {
    let laughs = "a: &a [ha, ha]\nb: &b [*a, *a]\nimage: [*b, *b]\n";
    assert_eq!(
        errors(laughs, b""),
        "room.yaml:2: must be a document without aliases (*name)"
    );
    let deep = format!("image: {}", "[".repeat(60_000));
    assert!(errors(&deep, b"").starts_with("room.yaml:1: not valid YAML"));
    let long = format!("image: {}", "a".repeat(70_000));
    assert_eq!(
        errors(&long, b""),
        "room.yaml: a file of at most 65536 bytes; it has 70007"
    );
}

#[test]
fn unsupported_yaml_is_an_error() {
    for (text, expected) in [
        ("- image", "room.yaml: not a YAML mapping of keys to values"),
        (
            "image: a\n---\nimage: b\n",
            "room.yaml:3: must be one YAML document, not several",
        ),
        (
            "image: !!str a\n",
            "room.yaml:1: must be a document without tags (!name)",
        ),
        (
            "[a]: b\n",
            "room.yaml:1: must be a document whose keys are plain names",
        ),
    ] {
        assert_eq!(errors(text, b""), expected);
    }
    let twice = errors(&format!("{ROOM}image: other.pgm\n"), b"");
    assert_eq!(
        twice,
        "room.yaml:7: must be a document with \"image\" only once"
    );
}

#[test]
fn a_map_with_too_many_walls_is_an_error() {
    let mut image = b"P5 1600 1600 255\n".to_vec();
    image.extend((0..1600 * 1600).map(|at| if (at + at / 1600) % 2 == 0 { 0 } else { 254 }));
    assert_eq!(
        errors(ROOM, &image),
        "room.yaml:1: image = \"room.pgm\": must be the name of a PGM or PNG image; \
         it has more than 4000000 straight walls: smooth its outlines"
    );
}

/// A map of random cells, some of them occupied, turned and moved.
fn random_map() -> impl Strategy<Value = OccupancyMap> {
    let size = (1_usize..9, 1_usize..9);
    let cells = size.prop_flat_map(|(columns, rows)| {
        let row = prop::collection::vec(prop::sample::select(vec!['#', '.', '?']), columns);
        prop::collection::vec(row, rows)
    });
    (cells, -4.0..4.0_f64, any::<bool>()).prop_map(|(cells, yaw, is_solid)| {
        let rows: Vec<String> = cells.iter().map(|row| row.iter().collect()).collect();
        let rows: Vec<&str> = rows.iter().map(String::as_str).collect();
        let unknown = if is_solid {
            Unknown::Solid
        } else {
            Unknown::Free
        };
        drawn(&rows, &[&format!("origin: [-3.7, 11.1, {yaw}]")], unknown)
    })
}

/// The middle of each cell, and whether it is solid.
fn middles(map: &OccupancyMap) -> Vec<(Point, bool)> {
    let cells = (0..map.rows()).flat_map(|row| (0..map.columns()).map(move |at| (at, row)));
    cells
        .map(|(column, row)| {
            let place = map
                .settings
                .place(f64::from(column) + 0.5, f64::from(row) + 0.5);
            (
                place,
                is_solid(map.occupancy(column, row).unwrap(), map.unknown),
            )
        })
        .collect()
}

proptest! {
    #[test]
    fn the_area_within_the_outline_is_that_of_the_solid_cells(map in random_map()) {
        let solid = middles(&map).iter().filter(|(_, is_solid)| *is_solid).count();
        let area = f64::from(u32::try_from(solid).unwrap()) * 0.25;
        prop_assert!((area_within(map.outline()) - area).abs() < 1e-9);
    }

    #[test]
    fn the_outline_is_closed(map in random_map()) {
        let ends = |end: fn(&Segment) -> Point| {
            let bits = |at: Point| (at.x.to_bits(), at.y.to_bits());
            let mut ends: Vec<_> = map.outline().iter().map(|edge| bits(end(edge))).collect();
            ends.sort_unstable();
            ends
        };
        prop_assert_eq!(ends(|edge| edge.from), ends(|edge| edge.to));
    }

    #[test]
    fn places_are_solid_where_their_cell_is(map in random_map()) {
        for (place, is_solid) in middles(&map) {
            prop_assert_eq!(map.is_solid(place), is_solid);
        }
        prop_assert!(!map.is_solid(map.settings.place(-0.1, 0.5)));
    }

    #[test]
    fn free_space_is_on_the_left_of_the_outline(map in random_map()) {
        for edge in map.outline() {
            let way = edge.way();
            let left = Point { x: -way.y, y: way.x }.times(0.1 / way.length());
            let near = edge.from.plus(way.times(0.1 / way.length()));
            prop_assert!(!map.is_solid(near.plus(left)));
            prop_assert!(map.is_solid(near.plus(left.times(-1.0))));
        }
    }

    #[test]
    fn no_ray_gets_into_what_is_solid(map in random_map(), nudge in -8_i32..=8) {
        // Through every corner of cells, where edges meet or two solid cells touch.
        let nearest = |origin, direction| {
            let hits = map.outline().iter().filter_map(|edge| hit(edge, origin, direction));
            hits.fold(f64::INFINITY, f64::min)
        };
        let (solid, free): (Vec<_>, Vec<_>) = middles(&map).into_iter().partition(|at| at.1);
        for (origin, _) in &free {
            for (target, _) in &solid {
                prop_assert!(nearest(*origin, origin.to(*target)) < 1.0);
            }
            for end in map.outline().iter().map(|edge| edge.from) {
                let way = origin.to(end);
                let x = way.x * (1.0 + f64::from(nudge) * f64::EPSILON);
                let beyond = origin.plus(way.times(1.01));
                if map.is_solid(beyond) {
                    let hit = nearest(*origin, Point { x, ..way });
                    prop_assert!(hit < 1.01);
                }
            }
        }
    }

    #[test]
    fn every_pixel_of_an_image_is_read_from_the_bottom_row_up(
        columns in 1_u32..40, rows in 1_u32..40, seed: u64, is_wide: bool, is_plain: bool,
    ) {
        let mut stream = crate::random::Stream::from_u64_seed(seed);
        let greatest: u16 = if is_wide { 65_535 } else { 255 };
        let pixels: Vec<u16> = (0..columns * rows)
            .map(|_| u16::try_from(stream.bounded(u32::from(greatest) + 1)).unwrap())
            .collect();
        let mut image = format!("P5 {columns} {rows}\n{greatest}\n").into_bytes();
        if is_plain {
            image[1] = b'2';
            image.extend(pixels.iter().flat_map(|pixel| format!("{pixel} ").into_bytes()));
        } else if is_wide {
            image.extend(pixels.iter().flat_map(|pixel| pixel.to_be_bytes()));
        } else {
            image.extend(pixels.iter().map(|pixel| u8::try_from(*pixel).unwrap()));
        }
        let upper = |value: u32| i8::from_le_bytes([if is_wide { value >> 8 } else { value }.to_le_bytes()[0]]);
        let read = pgm::read("room.pgm", &image, |pixel| upper(pixel.brightness().0)).unwrap();
        let rows_from_the_top = pixels.chunks_exact(columns as usize);
        for (row, expected) in (0..rows).rev().zip(rows_from_the_top) {
            for (column, pixel) in (0..columns).zip(expected) {
                prop_assert_eq!(read.get(column, row), Some(upper((*pixel).into())));
            }
        }
    }

    #[test]
    fn no_bytes_make_the_reader_fail_otherwise_than_by_an_error(
        text in "[a-z_:0-9.\\[\\]{}&*!#'\"\\n -]{0,200}", image in prop::collection::vec(any::<u8>(), 0..200),
    ) {
        let _ = load(&text, &image);
        let _ = load(ROOM, &image);
        let raw = [&b"P5 7 9 255\n"[..], &image].concat();
        let _ = load(ROOM, &raw);
    }
}
