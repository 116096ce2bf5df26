//! Images as named planes of floats, and where they lie in the whole picture.

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
}

impl Image {
    /// An image without channels.
    #[must_use]
    pub fn new(width: usize, height: usize) -> Self {
        Self {
            width,
            height,
            channels: Vec::new(),
        }
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

    /// The channels that hold the picture's colour: `R`, `G`, `B` (or one `Y` three times), by
    /// themselves or, failing that, in the first layer that has them (`default.R`, …).
    #[must_use]
    pub fn colour(&self) -> Option<[&[f32]; 3]> {
        self.colour_of_layer("")
            .or_else(|| self.colour_of_layer(self.colour_layer()?))
    }

    /// The opacity that belongs to [`Image::colour`], if there is any.
    #[must_use]
    pub fn alpha(&self) -> Option<&[f32]> {
        if self.colour_of_layer("").is_some() {
            self.channel("A")
        } else {
            self.channel(&format!("{}A", self.colour_layer()?))
        }
    }

    /// The prefix, dot included, of the first layer with colour.
    fn colour_layer(&self) -> Option<&str> {
        self.channels
            .iter()
            .filter_map(|channel| {
                let dot = channel.name.rfind('.')?;
                Some(&channel.name[..=dot])
            })
            .find(|layer| self.colour_of_layer(layer).is_some())
    }

    fn colour_of_layer(&self, layer: &str) -> Option<[&[f32]; 3]> {
        let channel = |name| self.channel(&format!("{layer}{name}"));
        match (channel("R"), channel("G"), channel("B"), channel("Y")) {
            (Some(r), Some(g), Some(b), _) => Some([r, g, b]),
            (_, _, _, Some(y)) => Some([y, y, y]),
            _ => None,
        }
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
