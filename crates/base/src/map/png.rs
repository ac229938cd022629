//! PNG images of any colour type and depth, interlaced or not (www.w3.org/TR/png).

use super::grid::{Grid, size};
use super::pixel::Pixel;
use ::png::{
    BitDepth, ColorType, Decoder, DecodingError, Info, InterlaceInfo, Reader, Transformations,
    expand_interlaced_row,
};
use std::io::Cursor;

/// The first bytes of every PNG image.
pub(super) const SIGNATURE: [u8; 8] = *b"\x89PNG\r\n\x1a\n";

/// Deflate compresses by this factor at most.
const MAX_COMPRESSION: usize = 1032;

/// Reads an image.
///
/// # Errors
/// The first error found.
pub(super) fn read(bytes: &[u8], meaning: impl Fn(Pixel) -> i8) -> Result<Grid, String> {
    let mut decoder = Decoder::new(Cursor::new(bytes));
    decoder.set_transformations(Transformations::EXPAND);
    decoder.set_ignore_text_chunk(true);
    decoder.set_ignore_iccp_chunk(true);
    let info = decoder.read_header_info().map_err(damaged)?;
    let (columns, rows) = info.size();
    let size = size(columns, rows)?;
    let min_bytes = info.raw_bytes() / MAX_COMPRESSION;
    if bytes.len() < min_bytes {
        let given = bytes.len();
        return Err(format!(
            "truncated: {columns} x {rows} pixels need at least {min_bytes} bytes; it has {given}"
        ));
    }
    let mut reader = decoder.read_info().map_err(damaged)?;
    refuse_animation(reader.info())?;
    let cells = cells(&mut reader, size, meaning)?;
    reader.finish().map_err(damaged)?;
    Grid::of_image(columns, rows, cells).ok_or_else(|| "the image has no pixels".to_owned())
}

#[expect(clippy::needless_pass_by_value, reason = "for map_err")]
fn damaged(why: DecodingError) -> String {
    match why {
        DecodingError::IoError(_) => "truncated: the PNG image has no end".to_owned(),
        DecodingError::LimitsExceeded => "the rows of the PNG image are too long".to_owned(),
        _ => format!("not a valid PNG image: {why}"),
    }
}

/// The first frame of an animation need not have the size of the image.
fn refuse_animation(info: &Info) -> Result<(), String> {
    match (&info.animation_control, &info.frame_control) {
        (None, None) => Ok(()),
        _ => Err("must be a PNG image without animation".to_owned()),
    }
}

/// The cells of all pixels, row by row.
fn cells(
    reader: &mut Reader<Cursor<&[u8]>>,
    size: usize,
    meaning: impl Fn(Pixel) -> i8,
) -> Result<Vec<i8>, String> {
    let columns = reader.info().width as usize;
    let format = Format::new(reader.output_color_type());
    let mut cells = vec![0; size];
    let mut first = 0;
    while let Some(row) = reader.next_interlaced_row().map_err(damaged)? {
        let row_cells = format.pixels(row.data());
        let row_cells = row_cells.map(|pixel| meaning(pixel).cast_unsigned());
        match row.interlace() {
            InterlaceInfo::Adam7(place) => {
                let row_cells: Vec<u8> = row_cells.collect();
                expand_interlaced_row(&mut cells, columns, &row_cells, place, 8);
            }
            InterlaceInfo::Null(_) => {
                let row = cells.iter_mut().skip(first).take(columns);
                row.zip(row_cells).for_each(|(cell, value)| *cell = value);
                first += columns;
            }
        }
    }
    Ok(cells.into_iter().map(u8::cast_signed).collect())
}

/// The layout of pixels: channels of one or two bytes, without palettes.
#[derive(Clone, Copy)]
struct Format {
    is_wide: bool,
    has_colour: bool,
    has_opacity: bool,
}

impl Format {
    fn new((colour, depth): (ColorType, BitDepth)) -> Self {
        Self {
            is_wide: depth == BitDepth::Sixteen,
            has_colour: matches!(colour, ColorType::Rgb | ColorType::Rgba),
            has_opacity: matches!(colour, ColorType::GrayscaleAlpha | ColorType::Rgba),
        }
    }

    /// The pixels of a row.
    fn pixels(self, row: &[u8]) -> impl Iterator<Item = Pixel> {
        let colours = if self.has_colour { 3 } else { 1 };
        let channels = colours + usize::from(self.has_opacity);
        let bytes = if self.is_wide { 2 } else { 1 };
        let greatest = if self.is_wide { u16::MAX } else { 255 };
        row.chunks_exact(channels * bytes).map(move |pixel| {
            let channel = |number: usize| {
                if self.is_wide {
                    u16::from_be_bytes([pixel[2 * number], pixel[2 * number + 1]])
                } else {
                    pixel[number].into()
                }
            };
            let opacity = self.has_opacity.then(|| channel(colours));
            let rgb = [0, 1, 2].map(|colour| channel(colour.min(colours - 1)));
            Pixel::rgb(rgb, opacity, greatest)
        })
    }
}
