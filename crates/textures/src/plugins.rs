//! The list of texture and spectrum plugins: how each reads its parameters.

use crate::pixels::{Image, Pixels, Values};
use crate::reader::Use;
use crate::{Bitmap, Checkerboard, Constant, Filter, Illuminated, MeshAttribute};
use crate::{Texture, TextureReader, UvTransform, Wrap};
use etalon_params::{Class, Diagnostic, Params, Value, plugins};
use etalon_spectrum::spd::check_unit;
use etalon_spectrum::{Blackbody, Spectrum};
use etalon_transport::Role;
use glam::{DVec3, UVec2};
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
            "d65" => self.d65(params, purpose),
            "rawconstant" => self.rawconstant(params, purpose),
            "uniform" | "regular" | "irregular" | "blackbody" | "srgb" => {
                let spectrum = self.spectrum(params, plugin.value.as_str());
                let span = plugin.span;
                spectrum
                    .and_then(|spectrum| self.admitted(spectrum, purpose, span))
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

    /// A number or three as they are; a reflectance is held to 1 all the same.
    fn rawconstant(&self, params: &Params<'_>, purpose: Use) -> Option<Texture> {
        let Some(property) = params.property("value") else {
            params.missing("value", "a number or three");
            return None;
        };
        let values = match &property.value {
            Value::Float(x) if x.is_finite() => DVec3::splat(*x),
            Value::Integer(i) => DVec3::splat(*i as f64),
            Value::Vector(v) | Value::Rgb(v) if v.is_finite() => *v,
            other => {
                let kind = other.kind();
                params.error_at(
                    "value",
                    format!("`value` must be a finite number or three, not {kind}"),
                );
                return None;
            }
        };
        let values = if purpose.role == Role::Reflectance && values.max_element() > 1.0 {
            self.note_held(property.span);
            values.min(DVec3::ONE)
        } else {
            values
        };
        Some(Texture::Constant(match &property.value {
            Value::Float(_) | Value::Integer(_) => Constant::uniform(values.x as f32),
            _ => Constant::raw(values.as_vec3()),
        }))
    }

    fn d65(&mut self, params: &Params<'_>, purpose: Use) -> Option<Texture> {
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
        let spectrum = self.held(spectrum.scaled(scale), purpose, params.node.plugin.span);
        Some(Texture::Constant(Constant::new(spectrum)))
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
                in_nanometres(params, "wavelength_max", max.as_slice())?;
                let values = numbers("values")?;
                Spectrum::regular(min?, max?, &values)
            }
            "irregular" => {
                let (wavelengths, values) = (numbers("wavelengths"), numbers("values"));
                in_nanometres(params, "wavelengths", wavelengths.as_deref().unwrap_or(&[]))?;
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
                if !unbounded {
                    // As in Mitsuba: who asks for this plugin gets no other colour.
                    return self.checked(Spectrum::reflectance(rgb.to_array()), property.span);
                }
                let purpose = Use {
                    role: Role::Unbounded,
                    nested: false,
                };
                return self.colour(*rgb, purpose, property.span);
            }
        };
        self.checked(spectrum, span)
    }

    fn bitmap(&mut self, params: &Params<'_>, role: Role) -> Option<Bitmap> {
        let raw = params.boolean_or("raw", false) || is_linear(params);
        let filter = filter(params);
        let wrap = wrap(params);
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
        let (pixels, notes) = match Pixels::decode(&bytes, raw, filename) {
            Ok(decoded) => decoded,
            Err(message) => {
                fail(message, None);
                return None;
            }
        };
        for note in notes {
            self.diagnostics.push(Diagnostic::note(property.span, note));
        }
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

/// `filter_type`. Those of other versions of Mitsuba that average over a pixel's footprint are left to the
/// samples of the pixel, with a note.
fn filter(params: &Params<'_>) -> Filter {
    let names = ["bilinear", "nearest", "trilinear", "ewa", "anisotropic"];
    match params.choice("filter_type", "bilinear", &names) {
        "nearest" => Filter::Nearest,
        "bilinear" => Filter::Bilinear,
        other => {
            let span = params.property("filter_type").map(|p| p.span);
            let message = format!(
                "`{other}` is read as `bilinear`: a pixel's samples average over the texels it sees"
            );
            let span = span.unwrap_or(params.node.plugin.span);
            params.diagnostics.push(Diagnostic::note(span, message));
            Filter::Bilinear
        }
    }
}

/// `wrap_mode`, or Mitsuba 0.6's `wrap_mode_u` and `wrap_mode_v`, which must agree.
fn wrap(params: &Params<'_>) -> Wrap {
    let read = |name, default| params.choice(name, default, &["repeat", "mirror", "clamp"]);
    let both = read("wrap_mode", "repeat");
    let [u, v] = ["wrap_mode_u", "wrap_mode_v"].map(|name| read(name, both));
    if u != v {
        let message = format!("one mode for both directions is built, not `{u}` and `{v}`");
        params.error_at("wrap_mode_v", message);
    }
    match u {
        "mirror" => Wrap::Mirror,
        "clamp" => Wrap::Clamp,
        _ => Wrap::Repeat,
    }
}

/// Whether Mitsuba 0.6's `gamma` says that the values are linear: 1 does; 0 and below leave it to
/// the file, and so does 2.2, which is close to what files of integers hold.
fn is_linear(params: &Params<'_>) -> bool {
    let accepted = "1 (linear), 2.2 or -1 (as the file's format says)";
    let gamma = params.float_where("gamma", -1.0, accepted, |gamma| {
        gamma <= 0.0 || gamma == 1.0 || gamma == 2.2
    });
    if gamma == 2.2 {
        params.diagnostics.push(Diagnostic::note(
            params
                .property("gamma")
                .map_or(params.node.plugin.span, |p| p.span),
            "a `gamma` of 2.2 is read as sRGB, which is close to it",
        ));
    }
    gamma == 1.0
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

/// `None`, after a diagnostic, if the wavelengths in a property cannot be meant in nanometres.
fn in_nanometres(params: &Params<'_>, name: &str, wavelengths: &[f64]) -> Option<()> {
    let checked = check_unit(wavelengths);
    checked
        .map_err(|message| params.error_at(name, message))
        .ok()
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
