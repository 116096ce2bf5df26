//! What image metrics compare: rows of red, green and blue numbers.

/// A borrowed image of three interleaved channels, row by row, all finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Picture<'a> {
    values: &'a [f32],
    width: usize,
    height: usize,
}

/// Why images cannot be measured. Refusing is not agreeing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PictureError {
    /// The number of values is not 3 · width · height, or there are none.
    BadShape {
        /// Values given.
        values: usize,
        /// The width in pixels.
        width: usize,
        /// The height in pixels.
        height: usize,
    },
    /// A value is infinite or not a number.
    NotFinite {
        /// The pixel's column.
        x: usize,
        /// The pixel's row.
        y: usize,
        /// The channel: 0, 1 or 2.
        channel: usize,
    },
    /// The two images do not have the same size.
    DifferentSizes {
        /// Width and height of the one under test.
        test: (usize, usize),
        /// Width and height of the reference.
        reference: (usize, usize),
    },
    /// An automatic range of exposures needs a reference whose median luminance is positive.
    NoExposure,
    /// An option is out of range.
    BadOption {
        /// Which.
        option: &'static str,
    },
}

impl std::fmt::Display for PictureError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::BadShape {
                values,
                width,
                height,
            } => write!(
                f,
                "{values} values are not {width} × {height} pixels of three channels"
            ),
            Self::NotFinite { x, y, channel } => {
                write!(f, "channel {channel} of pixel ({x}, {y}) is not finite")
            }
            Self::DifferentSizes { test, reference } => write!(
                f,
                "the image is {} × {}, the reference {} × {}",
                test.0, test.1, reference.0, reference.1
            ),
            Self::NoExposure => f.write_str(
                "the reference's median luminance is not positive: give a range of exposures",
            ),
            Self::BadOption { option } => write!(f, "{option} is out of range"),
        }
    }
}

impl std::error::Error for PictureError {}

impl<'a> Picture<'a> {
    /// An image of `width` × `height` pixels.
    ///
    /// # Errors
    /// [`PictureError`] unless there are 3 · width · height > 0 values, all finite.
    pub fn new(values: &'a [f32], width: usize, height: usize) -> Result<Self, PictureError> {
        let pixels = width.checked_mul(height).and_then(|n| n.checked_mul(3));
        if values.is_empty() || pixels != Some(values.len()) {
            return Err(PictureError::BadShape {
                values: values.len(),
                width,
                height,
            });
        }
        if let Some(bad) = values.iter().position(|value| !value.is_finite()) {
            return Err(PictureError::NotFinite {
                x: bad / 3 % width,
                y: bad / 3 / width,
                channel: bad % 3,
            });
        }
        Ok(Self {
            values,
            width,
            height,
        })
    }

    /// The numbers, interleaved.
    #[must_use]
    pub fn values(&self) -> &'a [f32] {
        self.values
    }

    /// The width in pixels.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// The height in pixels.
    #[must_use]
    pub fn height(&self) -> usize {
        self.height
    }

    /// The pixels, row by row.
    pub fn pixels(&self) -> impl ExactSizeIterator<Item = [f64; 3]> + Clone + 'a {
        self.values
            .chunks_exact(3)
            .map(|p| [p[0], p[1], p[2]].map(f64::from))
    }

    /// Refuses a reference of another size.
    pub(crate) fn same_size(&self, reference: &Self) -> Result<(), PictureError> {
        let size = |picture: &Self| (picture.width, picture.height);
        if size(self) == size(reference) {
            Ok(())
        } else {
            Err(PictureError::DifferentSizes {
                test: size(self),
                reference: size(reference),
            })
        }
    }
}
