//! Textures: `bitmap`, with the wrapping and the filter of the sampler and the transform of KHR_texture_transform.
//!
//! Both count v from the top row of the picture. The transform is u' = T R S u with R = (cos r, sin r; −sin r, cos r): a turn
//! counter-clockwise as one sees it, v pointing down.

use super::reader::Reader;
use crate::draft::{Draft, Given, word};
use ::gltf::json::Index;
use ::gltf::json::deserialize::from_value;
use ::gltf::json::extensions::texture::TextureTransform;
use ::gltf::json::material::NormalTexture;
use ::gltf::json::texture::{Info, Texture};
use ::gltf::json::validation::Checked;
use ::gltf::texture::{MagFilter, WrappingMode};
use etalon_math::float64;
use etalon_params::{Class, DMat4, Span, Value};
use glam::DVec4;

/// A use of a texture.
#[derive(Clone, Debug)]
pub(crate) struct TextureUse {
    /// The path of its `textureInfo`.
    pub(crate) path: String,
    index: Index<Texture>,
    set: u32,
    transform: Option<TextureTransform>,
}

/// What of a picture is looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Look {
    /// Its colour, encoded as sRGB.
    Colour,
    /// Its three channels as numbers.
    Numbers,
    /// One of its channels, as a number.
    Channel(&'static str),
}

impl TextureUse {
    /// The use that stands at a path.
    pub(crate) fn of(path: String, info: &Info) -> Self {
        let transform = info.extensions.as_ref();
        let transform = transform.and_then(|extensions| extensions.texture_transform.as_ref());
        Self {
            path,
            index: info.index,
            set: info.tex_coord,
            transform: transform.cloned(),
        }
    }

    /// The same of a normal map.
    pub(crate) fn of_normals(path: String, info: &NormalTexture) -> Self {
        let transform = info.extensions.as_ref();
        let transform = transform.and_then(|e| e.others.get("KHR_texture_transform"));
        Self {
            path,
            index: info.index,
            set: info.tex_coord,
            transform: transform.and_then(|value| from_value(value.clone()).ok()),
        }
    }

    /// The number of its texture coordinates.
    pub(crate) fn set(&self) -> u32 {
        let other = self.transform.as_ref().and_then(|t| t.tex_coord);
        other.unwrap_or(self.set)
    }

    fn to_uv(&self) -> Option<DMat4> {
        let transform = self.transform.as_ref()?;
        let [x, y] = transform.offset.0.map(f64::from);
        let [width, height] = transform.scale.0.map(f64::from);
        let angle = f64::from(transform.rotation.0);
        let (sin, cos) = (float64::sin(angle), float64::cos(angle));
        Some(DMat4::from_cols(
            DVec4::new(cos, -sin, 0.0, 0.0) * width,
            DVec4::new(sin, cos, 0.0, 0.0) * height,
            DVec4::Z,
            DVec4::new(x, y, 0.0, 1.0),
        ))
    }
}

impl Reader<'_> {
    /// The number of the picture that is used.
    pub(crate) fn image_of(&self, sample: &TextureUse) -> Option<usize> {
        let texture = self.root.get(sample.index)?;
        let image = texture.source.value();
        (image < self.root.images.len()).then_some(image)
    }

    /// The texture; `None` after a mistake.
    pub(crate) fn bitmap(&mut self, sample: &TextureUse, look: Look) -> Option<Given> {
        let number = sample.index.value();
        let Some(texture) = self.root.get(sample.index) else {
            let path = format!("{}.index", sample.path);
            return self.refuse(&path, "there is no such texture", "numbers of `textures`");
        };
        let path = format!("textures[{number}]");
        let Some(image) = self.image_of(sample) else {
            let accepted = "a `source` whose picture is a PNG or a JPEG";
            return self.refuse(&path, "it has no picture that is read here", accepted);
        };
        let filename = self.picture(image)?;
        let place = self.span(&format!("images[{image}]"));
        let draft = Draft::new(Class::Texture, "bitmap", self.span(&sample.path));
        let mut draft = draft.with("filename", word(&filename), place);
        draft = match look {
            Look::Colour => draft,
            Look::Numbers => draft.plain("raw", Value::Boolean(true)),
            Look::Channel(channel) => draft
                .plain("raw", Value::Boolean(true))
                .plain("channel", word(channel)),
        };
        if let Some(to_uv) = sample.to_uv() {
            draft = draft.plain("to_uv", Value::Transform(to_uv));
        }
        let sampler = texture.sampler.and_then(|index| self.root.get(index));
        if let (Some(sampler), Some(index)) = (sampler, texture.sampler) {
            let path = format!("samplers[{index}]");
            if sampler.wrap_s != sampler.wrap_t {
                let message =
                    "`wrapT` counts as `wrapS`: pictures have one rule for both directions";
                self.note(&format!("{path}.wrapT"), message);
            }
            let mode = match sampler.wrap_s {
                Checked::Valid(WrappingMode::ClampToEdge) => "clamp",
                Checked::Valid(WrappingMode::MirroredRepeat) => "mirror",
                _ => "repeat",
            };
            let place = self.span(&format!("{path}.wrapS"));
            if mode != "repeat" {
                draft = draft.with("wrap_mode", word(mode), place);
            }
            if sampler.mag_filter == Some(Checked::Valid(MagFilter::Nearest)) {
                let place = self.span(&format!("{path}.magFilter"));
                draft = draft.with("filter_type", word("nearest"), place);
            }
        }
        Some(draft.value())
    }
}

/// The product of two values.
pub(crate) fn product(a: Given, b: Given) -> Given {
    let draft = Draft::new(Class::Texture, "multiply", b.span);
    draft.given("a", a).given("b", b).value()
}

/// What a mesh has at its vertices.
pub(crate) fn of_vertices(name: &str, span: Span) -> Given {
    let draft = Draft::new(Class::Texture, "mesh_attribute", span);
    draft.plain("name", word(name)).value()
}
