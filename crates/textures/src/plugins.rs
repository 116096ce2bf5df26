//! The list of texture and spectrum plugins: how each reads its parameters.

use crate::pixels::{Image, Pixels, Values};
use crate::reader::Use;
use crate::{Bitmap, Checkerboard, Constant, Filter, Illuminated, MeshAttribute};
use crate::{Texture, TextureReader, UvTransform, Wrap};
use etalon_params::{Class, Diagnostic, Params, Value, plugins};
use etalon_spectrum::{Blackbody, Spectrum};
use etalon_transport::Role;
use glam::{UVec2, Vec3};
use std::sync::Arc;

/// Names of the textures and spectra that are built.
pub const BUILT: &[&str] = &[
    "bitmap",
    "blackbody",
    "checkerboard",
    "d65",
    "irregular",
    "mesh_attribute",
    "rawconstant",
    "regular",
    "srgb",
    "uniform",
];

impl TextureReader<'_> {
    /// Reads a nested object; `None` after a mistake.
    pub(crate) fn plugin(&mut self, params: &Params<'_>, purpose: Use) -> Option<Texture> {
        let plugin = &params.node.plugin;
        let texture = match plugin.value.as_str() {
            "bitmap" => self.bitmap(params, purpose.role).map(Texture::Bitmap),
            "checkerboard" => Some(self.checkerboard(params, purpose.role)),
            "mesh_attribute" => mesh_attribute(params, purpose.role).map(Texture::MeshAttribute),
            "d65" => self.d65(params),
            "rawconstant" => rawconstant(params),
            "uniform" | "regular" | "irregular" | "blackbody" | "srgb" => {
                let spectrum = self.spectrum(params, plugin.value.as_str());
                let span = plugin.span;
                spectrum
                    .and_then(|spectrum| self.not_negative(spectrum, purpose, span))
                    .map(|spectrum| Texture::Constant(Constant::new(spectrum)))
            }
            _ => {
                let built = BUILT.iter().copied();
                self.diagnostics
                    .push(plugins::not_built(params.node, built));
                return None;
            }
        };
        params.finish();
        texture
    }

    fn checkerboard(&mut self, params: &Params<'_>, role: Role) -> Texture {
        let nested = Use { role, nested: true };
        Texture::Checkerboard(Checkerboard {
            colours: [
                self.parameter_in(params, "color0", Some(0.4), nested),
                self.parameter_in(params, "color1", Some(0.2), nested),
            ],
            to_uv: UvTransform::from_params(params),
        })
    }

    fn d65(&mut self, params: &Params<'_>) -> Option<Texture> {
        let scale = params.float_where("scale", 1.0, "a finite number not below 0", |x| {
            x >= 0.0 && x.is_finite()
        }) as f32;
        let children = params.children(Class::Texture);
        let colour = params.property("color");
        let spectrum = match (colour, children.as_slice()) {
            (None, []) => Spectrum::d65(1.0).ok(),
            (Some(property), []) => {
                let emission = Use {
                    role: Role::Emission,
                    nested: false,
                };
                match &property.value {
                    Value::Rgb(rgb) => self.colour(*rgb, emission, property.span),
                    other => {
                        let kind = other.kind();
                        params.error_at(
                            "color",
                            format!("`color` must be an rgb colour, not {kind}"),
                        );
                        None
                    }
                }
            }
            (None, [(property, _)]) => {
                let nested = Use {
                    role: Role::Emission,
                    nested: true,
                };
                let inner = self.value(property, nested);
                return Some(Texture::Illuminated(Illuminated { inner, scale }));
            }
            _ => {
                params.error("`d65` takes either `color` or one nested texture");
                None
            }
        }?;
        Some(Texture::Constant(Constant::new(spectrum.scaled(scale))))
    }

    fn spectrum(&self, params: &Params<'_>, plugin: &str) -> Option<Spectrum> {
        let span = params.node.plugin.span;
        let numbers = |name| numbers(params, name);
        let required = |name| {
            let number = params.float(name);
            if number.is_none() && !params.has(name) {
                params.missing(name, "a number");
            }
            number
        };
        let spectrum = match plugin {
            "uniform" => Spectrum::uniform(required("value")?),
            "regular" => {
                let (min, max) = (required("wavelength_min"), required("wavelength_max"));
                let values = numbers("values")?;
                Spectrum::regular(min?, max?, &values)
            }
            "irregular" => {
                let (wavelengths, values) = (numbers("wavelengths"), numbers("values"));
                Spectrum::irregular(&wavelengths?, &values?)
            }
            "blackbody" => {
                let min = params.float_or("wavelength_min", etalon_spectrum::LAMBDA_MIN);
                let max = params.float_or("wavelength_max", etalon_spectrum::LAMBDA_MAX);
                Blackbody::with_range(required("temperature")?, min, max)
                    .map(|body| Spectrum::Blackbody(Arc::new(body)))
            }
            _ => {
                let unbounded = params.boolean_or("unbounded", false);
                let Some(property) = params.property("color") else {
                    params.missing("color", "an rgb colour");
                    return None;
                };
                let Value::Rgb(rgb) = &property.value else {
                    let kind = property.value.kind();
                    params.error_at(
                        "color",
                        format!("`color` must be an rgb colour, not {kind}"),
                    );
                    return None;
                };
                let role = if unbounded {
                    Role::Unbounded
                } else {
                    Role::Reflectance
                };
                let purpose = Use {
                    role,
                    nested: false,
                };
                return self.colour(*rgb, purpose, property.span);
            }
        };
        self.checked(spectrum, span)
    }

    fn bitmap(&mut self, params: &Params<'_>, role: Role) -> Option<Bitmap> {
        let raw = params.boolean_or("raw", false);
        let filter = match params.choice("filter_type", "bilinear", &["bilinear", "nearest"]) {
            "nearest" => Filter::Nearest,
            _ => Filter::Bilinear,
        };
        let wrap = match params.choice("wrap_mode", "repeat", &["repeat", "mirror", "clamp"]) {
            "mirror" => Wrap::Mirror,
            "clamp" => Wrap::Clamp,
            _ => Wrap::Repeat,
        };
        let to_uv = UvTransform::from_params(params);
        let Some(filename) = params.string("filename") else {
            if !params.has("filename") {
                params.missing("filename", "the name of an image file");
            }
            return None;
        };
        let image = self.image(params, filename, raw, role)?;
        Some(Bitmap {
            image,
            filter,
            wrap,
            to_uv,
        })
    }

    /// The image in a file, prepared for lookup; files are read once.
    fn image(
        &mut self,
        params: &Params<'_>,
        filename: &str,
        raw: bool,
        role: Role,
    ) -> Option<Arc<Image>> {
        let key = (filename.to_owned(), raw, role != Role::Reflectance);
        if let Some(image) = self.set.images.get(&key) {
            return Some(Arc::clone(image));
        }
        let property = params.property("filename")?;
        let fail = |message: String, help: Option<String>| {
            let mut diagnostic = Diagnostic::error(property.span, message);
            diagnostic.help = help;
            self.diagnostics.push(diagnostic);
        };
        let bytes = match self.assets.bytes(filename) {
            Ok(bytes) => bytes,
            Err(error) => {
                fail(error.message, error.help);
                return None;
            }
        };
        let pixels = match Pixels::decode(&bytes, raw, filename) {
            Ok(pixels) => pixels,
            Err(message) => {
                fail(message, None);
                return None;
            }
        };
        let negative = matches!(&pixels.values, Values::One(v) if v.iter().any(|&x| x < 0.0));
        if negative && role == Role::Emission {
            fail(
                format!("`{filename}` has negative values, which no light can emit"),
                None,
            );
            return None;
        }
        let image = Image::new(pixels, raw, role);
        if image.moved > 0 {
            let UVec2 { x, y } = image.size;
            let message = format!(
                "{} of the {} texels of `{filename}` lie outside of what this colour can be; \
                 their components count as the nearest that can",
                image.moved,
                u64::from(x) * u64::from(y),
            );
            self.diagnostics
                .push(Diagnostic::note(property.span, message));
        }
        let image = Arc::new(image);
        self.set.images.insert(key, Arc::clone(&image));
        Some(image)
    }
}

fn mesh_attribute(params: &Params<'_>, role: Role) -> Option<MeshAttribute> {
    let scale = params.float_where("scale", 1.0, "a finite number not below 0", |x| {
        x >= 0.0 && x.is_finite()
    }) as f32;
    let Some(name) = params.string("name") else {
        if !params.has("name") {
            params.missing("name", "`vertex_…` or `face_…`");
        }
        return None;
    };
    if !name.starts_with("vertex_") && !name.starts_with("face_") {
        params.refuse("name", format!("`{name}`"), "`vertex_…` or `face_…`");
        return None;
    }
    Some(MeshAttribute {
        name: name.to_owned(),
        scale,
        role,
    })
}

fn rawconstant(params: &Params<'_>) -> Option<Texture> {
    let Some(property) = params.property("value") else {
        params.missing("value", "a number or three");
        return None;
    };
    let constant = match &property.value {
        Value::Float(x) if x.is_finite() => Constant::uniform(*x as f32),
        Value::Integer(i) => Constant::uniform(*i as f32),
        Value::Vector(v) if v.is_finite() => Constant::raw(v.as_vec3()),
        Value::Rgb(v) if v.is_finite() => Constant::raw(Vec3::from_array(v.as_vec3().to_array())),
        other => {
            let kind = other.kind();
            params.error_at(
                "value",
                format!("`value` must be a finite number or three, not {kind}"),
            );
            return None;
        }
    };
    Some(Texture::Constant(constant))
}

/// A list of numbers separated by commas or spaces.
fn numbers(params: &Params<'_>, name: &str) -> Option<Vec<f64>> {
    let Some(text) = params.string(name) else {
        if !params.has(name) {
            params.missing(name, "numbers separated by commas or spaces");
        }
        return None;
    };
    let words = text.split([',', ' ', '\t', '\n', '\r']);
    words
        .filter(|word| !word.is_empty())
        .map(|word| {
            let number = word.parse::<f64>().ok();
            if number.is_none() {
                params.error_at(name, format!("`{word}` in `{name}` is not a number"));
            }
            number
        })
        .collect()
}
