//! Images as named planes of floats, and where they lie in the whole picture.

use crate::Chromaticities;

/// One plane: a name and one sample per pixel, row after row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Its name, such as `R` or `standard_error.R`.
    pub name: String,
    /// `width` · `height` samples.
    pub samples: Vec<f32>,
}

/// Planes of one size.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    width: usize,
    height: usize,
    channels: Vec<Channel>,
    part: String,
    chromaticities: Option<Chromaticities>,
}

impl Image {
    /// An image without channels.
    #[must_use]
    pub fn new(width: usize, height: usize) -> Self {
        Self {
            width,
            height,
            channels: Vec::new(),
            part: String::new(),
            chromaticities: None,
        }
    }

    /// The image as that part of a file that has this name; it is the layer of the channels
    /// without one.
    #[must_use]
    pub fn of_part(mut self, name: impl Into<String>) -> Self {
        self.part = name.into();
        self
    }

    /// The name of the part of a file that this is; empty if it has none.
    #[must_use]
    pub fn part(&self) -> &str {
        &self.part
    }

    /// The image with other primaries than those of Rec. 709.
    #[must_use]
    pub fn with_chromaticities(mut self, chromaticities: Option<Chromaticities>) -> Self {
        self.chromaticities = chromaticities;
        self
    }

    /// The primaries of all R, G and B, if the file says them; else they are those of Rec. 709.
    #[must_use]
    pub fn chromaticities(&self) -> Option<Chromaticities> {
        self.chromaticities
    }

    /// Adds a channel.
    ///
    /// # Panics
    /// If there are not `width` · `height` samples, or the name is taken: both are mistakes of
    /// the program, never of its input.
    pub fn push(&mut self, name: impl Into<String>, samples: Vec<f32>) {
        let name = name.into();
        assert_eq!(
            samples.len(),
            self.width * self.height,
            "channel {name} has the wrong size"
        );
        assert!(
            self.channel(&name).is_none(),
            "channel {name} already exists"
        );
        self.channels.push(Channel { name, samples });
    }

    /// The image with one more channel; see [`Image::push`].
    #[must_use]
    pub fn with(mut self, name: impl Into<String>, samples: Vec<f32>) -> Self {
        self.push(name, samples);
        self
    }

    /// Pixels in a row.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    #[must_use]
    pub fn height(&self) -> usize {
        self.height
    }

    /// The channels, in the order they were added, or alphabetically if they were read from an
    /// EXR file.
    #[must_use]
    pub fn channels(&self) -> &[Channel] {
        &self.channels
    }

    /// The channels, without the image.
    #[must_use]
    pub fn into_channels(self) -> Vec<Channel> {
        self.channels
    }

    /// The samples of the channel with this name.
    #[must_use]
    pub fn channel(&self, name: &str) -> Option<&[f32]> {
        self.channels
            .iter()
            .find(|channel| channel.name == name)
            .map(|channel| channel.samples.as_slice())
    }

    /// As [`Image::channel`], to be changed.
    pub fn channel_mut(&mut self, name: &str) -> Option<&mut [f32]> {
        self.channels
            .iter_mut()
            .find(|channel| channel.name == name)
            .map(|channel| channel.samples.as_mut_slice())
    }
}

/// Where an image lies in the whole picture, in pixels: a crop keeps its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Frame {
    /// Column and row of the image's upper left pixel in the whole picture.
    pub offset: [i32; 2],
    /// Width and height of the whole picture.
    pub size: [usize; 2],
}

impl Frame {
    /// The frame of an image that is the whole picture.
    #[must_use]
    pub fn whole(image: &Image) -> Self {
        Self {
            offset: [0, 0],
            size: [image.width(), image.height()],
        }
    }
}
