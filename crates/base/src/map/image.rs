//! The image of a map, in one of the formats that are read.

use super::grid::{Grid, MAX_CELLS};
use super::pixel::Pixel;
use super::{pgm, png};
use crate::error::InputError;

/// Maximum size of the image of a map, in bytes: a caller of [`read`](super::read) need not read more of the file.
pub const MAX_IMAGE_BYTES: usize = 5 * MAX_CELLS;

/// First bytes of formats that are not read, which their names make easier to convert.
const OTHER_FORMATS: [(&[u8], &str); 10] = [
    (b"BM", "a BMP image"),
    (b"\xff\xd8\xff", "a JPEG image"),
    (b"GIF8", "a GIF image"),
    (b"II*\0", "a TIFF image"),
    (b"MM\0*", "a TIFF image"),
    (b"RIFF", "a WebP image"),
    (b"P1", "a PBM image"),
    (b"P4", "a PBM image"),
    (b"P3", "a PPM image"),
    (b"P6", "a PPM image"),
];

/// Reads the image `bytes`, each pixel as its `meaning`; `file` is its name in errors. The last row of the
/// image becomes the first row of the grid.
///
/// # Errors
/// The first error found.
pub(super) fn read(
    file: &str,
    bytes: &[u8],
    meaning: impl Fn(Pixel) -> i8,
) -> Result<Grid, InputError> {
    let error = |why: String| InputError {
        origin: Some(file.to_owned()),
        ..InputError::new(String::new(), None, why)
    };
    if bytes.len() > MAX_IMAGE_BYTES {
        let why = format!("the image must have at most {MAX_IMAGE_BYTES} bytes");
        return Err(error(why));
    }
    match bytes {
        [b'P', b'2' | b'5', ..] => pgm::read(file, bytes, meaning),
        _ if bytes.starts_with(&png::SIGNATURE) => png::read(bytes, meaning).map_err(error),
        _ => Err(error(not_read(bytes))),
    }
}

fn not_read(bytes: &[u8]) -> String {
    let known = OTHER_FORMATS
        .iter()
        .find(|(first, _)| bytes.starts_with(first));
    let is = known.map_or("an unknown format", |(_, name)| name);
    format!(
        "must be a PGM image (P5 or P2) or a PNG image; it is {is}: convert it, such as with \
         ImageMagick: magick IMAGE IMAGE.png"
    )
}
