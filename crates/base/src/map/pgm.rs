//! Greyscale images in PGM, plain (P2) and raw (P5), as netpbm.sourceforge.net/doc/pgm.html defines them.

use super::grid::{Grid, size};
use super::pixel::Pixel;
use crate::error::InputError;

/// Reads the image `bytes`, which begin with P2 or P5; `file` is its name in errors.
///
/// # Errors
/// The first error found.
pub(super) fn read(
    file: &str,
    bytes: &[u8],
    meaning: impl Fn(Pixel) -> i8,
) -> Result<Grid, InputError> {
    let mut reader = Reader {
        bytes,
        at: 0,
        is_text: true,
    };
    image(&mut reader, meaning).map_err(|allowed| InputError {
        origin: Some(reader.origin(file)),
        ..InputError::new(String::new(), None, allowed)
    })
}

fn image(reader: &mut Reader, meaning: impl Fn(Pixel) -> i8) -> Result<Grid, String> {
    let header = Header::read(reader)?;
    let mut cells = Vec::with_capacity(header.size);
    for _ in 0..header.size {
        let value = header.pixel(reader)?;
        if value > header.greatest {
            let greatest = header.greatest;
            return Err(format!(
                "a pixel is {value}, above the maximum value {greatest}"
            ));
        }
        cells.push(meaning(Pixel::grey(value, header.greatest)));
    }
    if !reader.rest().iter().all(u8::is_ascii_whitespace) {
        return Err("data follows the last pixel of the image".to_owned());
    }
    Grid::of_image(header.columns, header.rows, cells)
        .ok_or_else(|| "the image has no pixels".to_owned())
}

struct Header {
    is_plain: bool,
    columns: u32,
    rows: u32,
    greatest: u16,
    /// Number of pixels. The file has enough bytes for all of them.
    size: usize,
}

impl Header {
    fn read(reader: &mut Reader) -> Result<Self, String> {
        let is_plain = reader.bytes.starts_with(b"P2");
        reader.at = 2;
        let columns = reader.number("the width", u32::MAX)?;
        let rows = reader.number("the height", u32::MAX)?;
        let size = size(columns, rows)?;
        let greatest = reader.number("the maximum value", 65_535)?;
        let greatest = u16::try_from(greatest).unwrap_or(u16::MAX);
        if !is_plain && !reader.skip_one_space() {
            return Err("white space must follow the maximum value".to_owned());
        }
        reader.is_text = is_plain;
        let header = Self {
            is_plain,
            columns,
            rows,
            greatest,
            size,
        };
        let (needed, given) = (header.min_bytes(), reader.rest().len());
        if given < needed {
            return Err(format!(
                "truncated: {columns} x {rows} pixels need {needed} bytes, and {given} follow"
            ));
        }
        Ok(header)
    }

    /// Minimum number of bytes of the pixels.
    fn min_bytes(&self) -> usize {
        match (self.is_plain, self.greatest) {
            // One digit per pixel, and separators.
            (true, _) => 2 * self.size - 1,
            (false, 256..) => 2 * self.size,
            (false, _) => self.size,
        }
    }

    fn pixel(&self, reader: &mut Reader) -> Result<u16, String> {
        if self.is_plain {
            return reader.plain_pixel();
        }
        let high = if self.greatest > 255 {
            reader.byte()?
        } else {
            0
        };
        Ok(u16::from_be_bytes([high, reader.byte()?]))
    }
}

struct Reader<'b> {
    bytes: &'b [u8],
    at: usize,
    /// Whether the present part of the file is text, with lines.
    is_text: bool,
}

impl Reader<'_> {
    fn rest(&self) -> &[u8] {
        &self.bytes[self.at..]
    }

    fn byte(&mut self) -> Result<u8, String> {
        let byte = self.bytes.get(self.at).copied();
        self.at += usize::from(byte.is_some());
        byte.ok_or_else(|| "truncated within the pixels".to_owned())
    }

    /// A number of the header, at least 1.
    fn number(&mut self, what: &str, max: u32) -> Result<u32, String> {
        let digits = self.digits();
        let number = std::str::from_utf8(digits)
            .ok()
            .and_then(|text| text.parse().ok());
        number
            .filter(|number| (1..=max).contains(number))
            .ok_or_else(|| {
                let given = String::from_utf8_lossy(&digits[..digits.len().min(20)]);
                format!("{what} must be a whole number from 1 to {max}, not {given:?}")
            })
    }

    fn plain_pixel(&mut self) -> Result<u16, String> {
        let digits = self.digits();
        let number = std::str::from_utf8(digits)
            .ok()
            .and_then(|text| text.parse().ok());
        number.ok_or_else(|| match digits {
            [] => "truncated within the pixels, or a pixel is not a number".to_owned(),
            _ => "a pixel is above 65535".to_owned(),
        })
    }

    /// The digits after white space and comments; empty without white space.
    fn digits(&mut self) -> &[u8] {
        if !self.skip_one_space() {
            return &[];
        }
        while self.skip_one_space() {}
        let rest = &self.bytes[self.at..];
        let length = rest.iter().take_while(|byte| byte.is_ascii_digit()).count();
        self.at += length;
        &rest[..length]
    }

    /// Skips one white space character, or a comment with its line end.
    fn skip_one_space(&mut self) -> bool {
        let rest = self.rest();
        let length = match rest.first() {
            Some(b'#') => {
                let end = rest.iter().position(|byte| matches!(byte, b'\n' | b'\r'));
                end.map_or(rest.len(), |end| end + 1)
            }
            Some(byte) if byte.is_ascii_whitespace() || *byte == 0x0b => 1,
            _ => 0,
        };
        self.at += length;
        length > 0
    }

    /// The present position, for errors: file and line in text, only the file in raw pixels.
    fn origin(&self, file: &str) -> String {
        let read = self.bytes[..self.at].split(|&byte| byte == b'\n');
        if self.is_text {
            format!("{file}:{}", read.count())
        } else {
            file.to_owned()
        }
    }
}
