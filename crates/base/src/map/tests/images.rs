//! PNG images.

use super::*;
use ::png::{BitDepth, ColorType, Encoder};

/// An image of 11 x 9 pixels, of which that in column x and row y is (23 x + 29 y) mod 256.
const INTERLACED: &[u8] = include_bytes!("interlaced.png");

const SCALE: [&str; 3] = ["mode: scale", "free_thresh: 0.2", "occupied_thresh: 0.4"];

struct Palette<'p> {
    colours: &'p [u8],
    opacities: &'p [u8],
}

/// A PNG image of `columns` by one pixel.
fn png(columns: u32, format: (ColorType, BitDepth), data: &[u8]) -> Vec<u8> {
    png_with(columns, format, data, None)
}

fn png_with(
    columns: u32,
    (colour, depth): (ColorType, BitDepth),
    data: &[u8],
    palette: Option<&Palette>,
) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, columns, 1);
    encoder.set_color(colour);
    encoder.set_depth(depth);
    if let Some(Palette { colours, opacities }) = palette {
        encoder.set_palette(*colours);
        encoder.set_trns(*opacities);
    }
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(data).unwrap();
    writer.finish().unwrap();
    bytes
}

/// The header of an image of this size, without any data.
fn header(columns: u32, rows: u32) -> Vec<u8> {
    let mut bytes = Vec::new();
    drop(
        Encoder::new(&mut bytes, columns, rows)
            .write_header()
            .unwrap(),
    );
    bytes
}

fn occupancies_of(lines: &[&str], image: &[u8]) -> Vec<i8> {
    occupancies(&load(&yaml(lines), image).unwrap())
}

#[test]
fn grey_pixels_of_every_depth_are_read_as_those_of_a_pgm_image() {
    let (grey, palette) = (ColorType::Grayscale, ColorType::Indexed);
    let black_and_white = [100, 0, 100, 0, 100];
    assert_eq!(
        occupancies_of(&[], &png(5, (grey, BitDepth::One), &[0b0101_0000])),
        black_and_white
    );
    // 0, 1, 2, 3 of 3: probabilities 1, 2/3, 1/3, 0.
    let two_bits = png(4, (grey, BitDepth::Two), &[0b0001_1011]);
    assert_eq!(occupancies_of(&[], &two_bits), [100, 100, -1, 0]);
    let four_bits = png(3, (grey, BitDepth::Four), &[0x0a, 0xf0]);
    assert_eq!(occupancies_of(&[], &four_bits), [100, -1, 0]);
    let bytes = png(3, (grey, BitDepth::Eight), &[0, 205, 254]);
    assert_eq!(occupancies_of(&[], &bytes), [100, -1, 0]);
    assert_eq!(
        load(ROOM, &bytes).unwrap(),
        load(ROOM, b"P2 3 1 255  0 205 254").unwrap()
    );
    let words = png(3, (grey, BitDepth::Sixteen), &[0, 1, 128, 0, 255, 255]);
    assert_eq!(occupancies_of(&[], &words), [100, -1, 0]);
    let colours = Palette {
        colours: &[254, 254, 254, 0, 0, 0],
        opacities: &[],
    };
    let indices = png_with(5, (palette, BitDepth::One), &[0b1010_1000], Some(&colours));
    assert_eq!(occupancies_of(&[], &indices), black_and_white);
}

#[test]
fn an_interlaced_image_is_read() {
    let map = load(&yaml(&["mode: raw"]), INTERLACED).unwrap();
    assert_eq!((map.columns(), map.rows()), (11, 9));
    for (column, row) in (0..11).flat_map(|column| (0..9).map(move |row| (column, row))) {
        let value = (column * 23 + row * 29) % 256;
        let expected = if value <= 100 {
            i8::try_from(value).unwrap()
        } else {
            -1
        };
        assert_eq!(
            map.occupancy(column, 8 - row),
            Some(expected),
            "{column} {row}"
        );
    }
}

#[test]
fn a_colour_counts_as_the_mean_of_its_channels() {
    let format = (ColorType::Rgb, BitDepth::Eight);
    let image = png(3, format, &[255, 0, 0, 200, 100, 0, 255, 255, 240]);
    // Means 85, 100 and 250: probabilities 0.67, 0.61 and 0.02.
    assert_eq!(occupancies_of(&[], &image), [100, -1, 0]);
    assert_eq!(occupancies_of(&["mode: raw"], &image), [85, 100, -1]);
}

#[test]
fn in_trinary_mode_opacity_counts_as_one_more_channel() {
    // Opaque black has a mean of 63.75, 0.75 of occupancy; opaque 205 one of 217.5, 0.147; transparent
    // white one of 191.25, 0.25.
    let grey = (ColorType::GrayscaleAlpha, BitDepth::Eight);
    let image = png(3, grey, &[0, 255, 205, 255, 255, 0]);
    assert_eq!(occupancies_of(&[], &image), [100, 0, -1]);
    let colour = (ColorType::Rgba, BitDepth::Eight);
    let data = [0, 0, 0, 255, 205, 205, 205, 255, 255, 255, 255, 0];
    assert_eq!(occupancies_of(&[], &png(3, colour, &data)), [100, 0, -1]);
}

#[test]
fn in_scale_mode_what_is_not_opaque_is_unknown() {
    let grey = (ColorType::GrayscaleAlpha, BitDepth::Eight);
    let image = png(4, grey, &[0, 254, 0, 255, 255, 255, 255, 0]);
    assert_eq!(occupancies_of(&SCALE, &image), [-1, 100, 0, -1]);
    let colours = Palette {
        colours: &[0, 0, 0, 255, 255, 255],
        opacities: &[0],
    };
    let format = (ColorType::Indexed, BitDepth::Eight);
    let image = png_with(2, format, &[0, 1], Some(&colours));
    assert_eq!(occupancies_of(&SCALE, &image), [-1, 0]);
}

#[test]
fn in_raw_mode_opacity_is_ignored() {
    let wide = (ColorType::Rgba, BitDepth::Sixteen);
    // 64 of 255 in 16 bits.
    let data = [[64, 64].repeat(3), vec![0, 0]].concat();
    assert_eq!(occupancies_of(&["mode: raw"], &png(1, wide, &data)), [64]);
}

#[test]
fn a_png_that_is_too_large_is_rejected_before_memory_is_allocated() {
    for (image, expected) in [
        (
            header(2_000_000_000, 2_000_000_000),
            "room.pgm: the image must have at most 64000000 pixels, not 2000000000 x 2000000000",
        ),
        (
            header(8000, 8000),
            "room.pgm: truncated: 8000 x 8000 pixels need at least 62023 bytes; it has 45",
        ),
    ] {
        assert_eq!(errors(ROOM, &image), expected);
    }
}

#[test]
fn a_damaged_png_is_an_error_that_names_the_file() {
    let whole = png(3, (ColorType::Rgb, BitDepth::Eight), &[0; 9]);
    for length in 0..whole.len() {
        let error = errors(ROOM, &whole[..length]);
        assert!(error.starts_with("room.pgm: "), "{length}: {error}");
    }
    let cut = errors(ROOM, &whole[..whole.len() - 12]);
    assert_eq!(cut, "room.pgm: truncated: the PNG image has no end");
    let mut garbled = whole.clone();
    garbled[45] ^= 1;
    let error = errors(ROOM, &garbled);
    assert!(
        error.starts_with("room.pgm: not a valid PNG image: CRC error"),
        "{error}"
    );
}

#[test]
fn an_animation_is_an_error() {
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, 1, 1);
    encoder.set_animated(1, 0).unwrap();
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(&[0]).unwrap();
    writer.finish().unwrap();
    assert_eq!(
        errors(ROOM, &bytes),
        "room.pgm: must be a PNG image without animation"
    );
}

#[test]
fn the_error_of_another_format_names_it_and_what_is_read() {
    for (image, name) in [
        (&b"BM\x36\0"[..], "a BMP image"),
        (b"\xff\xd8\xff\xe0", "a JPEG image"),
        (b"GIF89a", "a GIF image"),
        (b"II*\0", "a TIFF image"),
        (b"P4 1 1", "a PBM image"),
        (b"<svg/>", "an unknown format"),
    ] {
        assert_eq!(
            errors(ROOM, image),
            format!(
                "room.pgm: must be a PGM image (P5 or P2) or a PNG image; it is {name}: convert it, such \
                 as with ImageMagick: magick IMAGE IMAGE.png"
            )
        );
    }
}

proptest! {
    #[test]
    fn no_change_of_a_png_makes_the_reader_fail_otherwise_than_by_an_error(
        place in 0_usize..INTERLACED.len(), value: u8, tail in prop::collection::vec(any::<u8>(), 0..200),
    ) {
        let mut image = INTERLACED.to_vec();
        image[place] = value;
        let _ = load(ROOM, &image);
        let cut = [&INTERLACED[..place], &tail].concat();
        let _ = load(ROOM, &cut);
    }
}
