//! A pixel of an image.

/// A pixel: its colour channels, and its opacity if the image has transparency.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pixel {
    /// Sum of the colour channels.
    colours: u32,
    /// Number of colour channels.
    channels: u32,
    opacity: Option<u32>,
    /// Greatest value of a channel.
    greatest: u32,
}

impl Pixel {
    /// A pixel of an image with one channel.
    pub(super) fn grey(value: u16, greatest: u16) -> Self {
        Self {
            colours: value.into(),
            channels: 1,
            opacity: None,
            greatest: greatest.into(),
        }
    }

    /// A pixel with red, green and blue, and its opacity if the image has transparency.
    pub(super) fn rgb(colours: [u16; 3], opacity: Option<u16>, greatest: u16) -> Self {
        Self {
            colours: colours.map(u32::from).iter().sum(),
            channels: 3,
            opacity: opacity.map(u32::from),
            greatest: greatest.into(),
        }
    }

    pub(super) fn is_opaque(&self) -> bool {
        self.opacity.is_none_or(|opacity| opacity == self.greatest)
    }

    /// The sum of the colour channels, and that of a white pixel.
    pub(super) fn brightness(&self) -> (u32, u32) {
        (self.colours, self.channels * self.greatest)
    }

    /// The same with opacity as one more channel, if the image has it.
    pub(super) fn brightness_with_opacity(&self) -> (u32, u32) {
        let (shade, white) = self.brightness();
        self.opacity.map_or((shade, white), |opacity| {
            (shade + opacity, white + self.greatest)
        })
    }
}
