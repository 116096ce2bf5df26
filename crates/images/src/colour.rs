//! Which channels of an image are its colour, and what they are in linear Rec. 709.
//!
//! Channels whose names agree up to the last dot are a *layer*: `beauty.R`, `beauty.G` and
//! `beauty.B` are the colour of the layer `beauty`. The picture is, in this order,
//!
//! 1. R, G, B without a layer, or in one called as pictures are (`beauty`, `Combined`, …);
//! 2. without a layer, or in one called so: X, Y, Z, then luminance and chroma (Y, RY, BY), then
//!    luminance;
//! 3. R, G, B of the first layer by name that is no pass such as `AO`, else of the first pass;
//! 4. X, Y, Z and luminances of such layers;
//! 5. what is no colour by its name (`Normal`, `position`, …).
//!
//! Upper and lower case are the same.

use crate::chromaticities::xyz_to_rec_709;
use crate::layer_kind::LayerKind;
use crate::{Channel, Error, Image};
use glam::{DMat3, DVec3};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::Path;

#[cfg(test)]
mod tests;

/// The colour of an image as linear Rec. 709, and how it was found.
#[derive(Clone, Debug, PartialEq)]
pub struct Colour<'a> {
    /// Red, green and blue; three times the same if [`Colour::grey`].
    pub planes: [Cow<'a, [f32]>; 3],
    /// Opacity, from the same layer.
    pub alpha: Option<&'a [f32]>,
    /// Whether there is a luminance only.
    pub grey: bool,
    /// Remarks about the file, as whole sentences.
    pub notes: Vec<String>,
}

/// The colour model of three channels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Model {
    Rgb,
    Xyz,
    /// Y, (R − Y)/Y, (B − Y)/Y.
    LuminanceChroma,
    Luminance,
}

/// The channels of one layer that form a colour.
struct Layer<'a> {
    name: &'a str,
    kind: LayerKind,
    model: Model,
    colour: [&'a Channel; 3],
    alpha: Option<&'a Channel>,
}

impl Layer<'_> {
    /// The smaller, the likelier it is the picture.
    fn rank(&self) -> u8 {
        let group = match (self.model, self.kind) {
            (Model::Rgb, LayerKind::Unnamed) => 0,
            (Model::Rgb, LayerKind::Main) => 1,
            (_, LayerKind::Unnamed) => 2,
            (_, LayerKind::Main) => 3,
            (Model::Rgb, LayerKind::Other) => 4,
            (Model::Rgb, LayerKind::Pass) => 5,
            (_, LayerKind::Other) => 6,
            (_, LayerKind::Pass) => 7,
            (Model::Rgb, LayerKind::Data) => 8,
            (_, LayerKind::Data) => 9,
        };
        4 * group + self.model as u8
    }

    /// Its channels, in words.
    fn in_words(&self) -> String {
        let count = if self.model == Model::Luminance { 1 } else { 3 };
        let last = |channel: &&Channel| {
            let name = channel.name.rsplit('.').next();
            name.unwrap_or_default().to_owned()
        };
        let names: Vec<String> = self.colour[..count].iter().map(last).collect();
        match self.name {
            "" => names.join(", "),
            layer => format!("{} of `{layer}`", names.join(", ")),
        }
    }
}

/// The channels of a layer by the part of their names after the last dot.
struct Letters<'a>(Vec<(&'a str, &'a Channel)>);

impl<'a> Letters<'a> {
    /// The channel of this letter, or word.
    fn channel(&self, letter: &str, word: &str) -> Option<&'a Channel> {
        let exact = self.0.iter().find(|(name, _)| *name == letter);
        let alike = |(name, _): &&(&str, _)| {
            name.eq_ignore_ascii_case(letter) || name.eq_ignore_ascii_case(word)
        };
        exact
            .or_else(|| self.0.iter().find(alike))
            .map(|(_, channel)| *channel)
    }

    fn layer(&self, name: &'a str, kind: LayerKind) -> Option<Layer<'a>> {
        let of = |letter| self.channel(letter, letter);
        let rgb = || {
            Some([
                self.channel("R", "red")?,
                self.channel("G", "green")?,
                self.channel("B", "blue")?,
            ])
        };
        let (model, colour) = if let Some(rgb) = rgb() {
            (Model::Rgb, rgb)
        } else {
            let y = of("Y")?;
            match (of("X"), of("Z"), of("RY"), of("BY")) {
                (Some(x), Some(z), ..) => (Model::Xyz, [x, y, z]),
                (_, _, Some(ry), Some(by)) => (Model::LuminanceChroma, [y, ry, by]),
                _ => (Model::Luminance, [y; 3]),
            }
        };
        Some(Layer {
            name,
            kind,
            model,
            colour,
            alpha: self.channel("A", "alpha"),
        })
    }
}

/// The layers with colour, the likeliest picture first.
fn layers(image: &Image) -> Vec<Layer<'_>> {
    let mut letters: BTreeMap<&str, Letters<'_>> = BTreeMap::new();
    for channel in image.channels() {
        let (layer, name) = channel.name.rsplit_once('.').unwrap_or(("", &channel.name));
        let of_layer = letters.entry(layer).or_insert_with(|| Letters(Vec::new()));
        of_layer.0.push((name, channel));
    }
    let mut layers: Vec<_> = letters
        .into_iter()
        .filter_map(|(prefix, letters)| {
            let name = if prefix.is_empty() {
                image.part()
            } else {
                prefix
            };
            letters.layer(name, LayerKind::of(name))
        })
        .collect();
    layers.sort_by_key(Layer::rank);
    layers
}

/// How likely the picture of a file is in this image: the smaller, the likelier.
pub(crate) fn rank(image: &Image) -> u8 {
    layers(image).first().map_or(u8::MAX, Layer::rank)
}

impl Image {
    /// The picture's colour; `None` if there is none. The head of `colour.rs` says which layer
    /// is taken.
    #[must_use]
    pub fn colour(&self) -> Option<Colour<'_>> {
        let layers = layers(self);
        let (taken, others) = layers.split_first()?;
        let mut notes = Vec::new();
        let rival =
            |layer: &&Layer<'_>| layer.model <= taken.model && layer.kind != LayerKind::Data;
        let rivals: Vec<String> = others.iter().filter(rival).map(Layer::in_words).collect();
        if !rivals.is_empty() {
            notes.push(format!(
                "its colour is taken from the channels {}; there are also {}",
                taken.in_words(),
                rivals.join("; ")
            ));
        }
        let mut colour = self.convert(taken, &mut notes);
        colour.notes = notes;
        Some(colour)
    }

    /// As [`Image::colour`], for those who need one; `path` is the file the image came from.
    ///
    /// # Errors
    /// [`Error::Unsupported`] for an image without colour; it names the channels there are.
    pub fn needed_colour(&self, path: &Path) -> Result<Colour<'_>, Error> {
        self.colour().ok_or_else(|| {
            let names: Vec<&str> = self.channels().iter().map(|c| c.name.as_str()).collect();
            Error::unsupported(
                path,
                format!(
                    "it has the channels {}; R, G and B, or X, Y and Z, or Y are expected, by \
                     themselves or in a layer",
                    names.join(", ")
                ),
            )
        })
    }

    /// The colour of the layer with this name, if it has R, G and B.
    #[must_use]
    pub fn colour_of_layer(&self, name: &str) -> Option<Colour<'_>> {
        let layers = layers(self);
        let found = |layer: &&Layer<'_>| layer.name == name && layer.model == Model::Rgb;
        let mut notes = Vec::new();
        let mut colour = self.convert(layers.iter().find(found)?, &mut notes);
        colour.notes = notes;
        Some(colour)
    }

    fn convert<'a>(&'a self, layer: &Layer<'a>, notes: &mut Vec<String>) -> Colour<'a> {
        let stored = layer.colour.map(|channel| channel.samples.as_slice());
        let primaries = self.chromaticities().unwrap_or_default();
        let mut from_primaries = || {
            if primaries.is_rec_709() {
                return DMat3::IDENTITY;
            }
            primaries.to_rec_709().unwrap_or_else(|| {
                notes.push(format!(
                    "its chromaticities, {primaries}, span no space of colours and are ignored"
                ));
                DMat3::IDENTITY
            })
        };
        let planes = match layer.model {
            Model::Luminance => stored.map(Cow::Borrowed),
            _ if layer.kind == LayerKind::Data => {
                if layer.model != Model::Rgb {
                    notes.push(format!(
                        "by their name the channels {} are no colours; their numbers are taken \
                         as they are",
                        layer.in_words()
                    ));
                }
                stored.map(Cow::Borrowed)
            }
            Model::Rgb => transformed(stored, from_primaries()),
            Model::Xyz => transformed(stored, xyz_to_rec_709()),
            Model::LuminanceChroma => {
                let rgb = from_chroma(stored, primaries.luminance_weights());
                let matrix = from_primaries();
                let changed = transformed(rgb.each_ref().map(Vec::as_slice), matrix);
                changed.map(|plane| Cow::Owned(plane.into_owned()))
            }
        };
        Colour {
            planes,
            alpha: layer.alpha.map(|channel| channel.samples.as_slice()),
            grey: layer.model == Model::Luminance,
            notes: Vec::new(),
        }
    }
}

fn transformed(planes: [&[f32]; 3], matrix: DMat3) -> [Cow<'_, [f32]>; 3] {
    if matrix == DMat3::IDENTITY {
        return planes.map(Cow::Borrowed);
    }
    each(planes, |colour| matrix * colour).map(Cow::Owned)
}

/// R, G and B of luminance and chroma (OpenEXR's `RgbaYca::YCAtoRGB`): RY = (R − Y)/Y,
/// BY = (B − Y)/Y, Y = w · (R, G, B).
fn from_chroma(planes: [&[f32]; 3], weights: [f64; 3]) -> [Vec<f32>; 3] {
    each(planes, |DVec3 { x: y, y: ry, z: by }| {
        let (r, b) = ((ry + 1.0) * y, (by + 1.0) * y);
        DVec3::new(r, (y - r * weights[0] - b * weights[2]) / weights[1], b)
    })
}

/// A function of each pixel, in double precision.
fn each([a, b, c]: [&[f32]; 3], f: impl Fn(DVec3) -> DVec3) -> [Vec<f32>; 3] {
    let mut planes = [a, b, c].map(|plane| Vec::with_capacity(plane.len()));
    for ((a, b), c) in a.iter().zip(b).zip(c) {
        let [x, y, z] = [*a, *b, *c].map(f64::from);
        let colour = f(DVec3::new(x, y, z)).to_array();
        for (plane, value) in planes.iter_mut().zip(colour) {
            plane.push(value as f32);
        }
    }
    planes
}
