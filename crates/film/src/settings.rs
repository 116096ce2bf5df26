//! The film of a scene: `hdrfilm`.

use crate::{Filter, FilterMethod, PixelFormat};
use etalon_params::{Class, Diagnostic, Params};
use glam::UVec2;

/// The kind of file a scene asks for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum FileFormat {
    /// OpenEXR.
    #[default]
    OpenExr,
    /// Radiance's RGBE (`.hdr`).
    Rgbe,
    /// Portable float map.
    Pfm,
}

impl FileFormat {
    /// The extension of its files, without a dot.
    pub fn extension(self) -> &'static str {
        match self {
            Self::OpenExr => "exr",
            Self::Rgbe => "hdr",
            Self::Pfm => "pfm",
        }
    }
}

/// Size, crop, format and filter of a film.
#[derive(Clone, Debug, PartialEq)]
pub struct FilmSettings {
    /// Width and height of the whole film (pixels).
    pub size: UVec2,
    /// The first pixel of the part that is rendered.
    pub crop_offset: UVec2,
    /// Width and height of the part that is rendered.
    pub crop_size: UVec2,
    /// The stored components of a colour.
    pub pixel_format: PixelFormat,
    /// The names of the bands of a spectral film ([`PixelFormat::Bands`]), one channel each.
    pub bands: Vec<String>,
    /// The kind of file, if the command line does not decide it.
    pub file_format: FileFormat,
    /// The reconstruction filter.
    pub filter: Filter,
    /// The method of reconstruction.
    pub filter_method: FilterMethod,
}

impl FilmSettings {
    /// The widest and highest film: beyond, a position in single precision no longer resolves
    /// 1/128 of a pixel.
    pub const LARGEST: u32 = 1 << 16;

    /// An uncropped RGB film.
    pub fn new(width: u32, height: u32, filter: Filter) -> Self {
        let size = UVec2::new(width, height);
        Self {
            size,
            crop_offset: UVec2::ZERO,
            crop_size: size,
            pixel_format: PixelFormat::default(),
            bands: Vec::new(),
            file_format: FileFormat::default(),
            filter,
            filter_method: FilterMethod::default(),
        }
    }

    /// The names of the colour channels.
    pub fn colours(&self) -> Vec<String> {
        match self.pixel_format {
            PixelFormat::Bands => self.bands.clone(),
            format => format.colours().iter().map(|&c| c.to_owned()).collect(),
        }
    }

    /// Whether the crop has pixels, lies within the film, and the film within
    /// [`FilmSettings::LARGEST`].
    pub fn is_valid(&self) -> bool {
        let [offset, crop, whole] = [self.crop_offset, self.crop_size, self.size];
        whole.cmple(UVec2::splat(Self::LARGEST)).all()
            && crop.cmpge(UVec2::ONE).all()
            && offset.cmple(whole).all()
            && crop.cmple(whole - offset).all()
    }

    /// The films that a scene can ask for.
    pub const PLUGINS: [&str; 2] = ["hdrfilm", "specfilm"];

    /// Films of Mitsuba 0.6 that store the same picture in other ways, read as an `hdrfilm`.
    pub const OTHER_PLUGINS: [&str; 3] = ["ldrfilm", "mfilm", "tiledhdrfilm"];

    /// Reads an `hdrfilm` with Mitsuba's names and defaults; mistakes go to
    /// `params.diagnostics`. Calling `finish` on `params` is left to the caller.
    ///
    /// `sample_border` is accepted, but all films behave as if it were true: where pixels share samples, so do
    /// those beyond the border.
    /// Numbers are always stored as 32-bit floats.
    pub fn from_params(params: &Params<'_>) -> Self {
        params.boolean_or("sample_border", false);
        let side = |name, default| extent(params, name, default, 1);
        let size = UVec2::new(side("width", 768), side("height", 576));
        let offset = |name| extent(params, name, 0, 0);
        let crop_offset = UVec2::new(offset("crop_offset_x"), offset("crop_offset_y"));
        let crop_size = UVec2::new(side("crop_width", size.x), side("crop_height", size.y));
        let end = crop_offset + crop_size;
        check_end(params, ["crop_width", "crop_offset_x"], "x", end.x, size.x);
        check_end(params, ["crop_height", "crop_offset_y"], "y", end.y, size.y);
        let whole = Self::uncropped(params, size);
        if end.cmple(size).all() {
            Self {
                crop_offset,
                crop_size,
                ..whole
            }
        } else {
            whole
        }
    }

    /// All but the crop.
    fn uncropped(params: &Params<'_>, size: UVec2) -> Self {
        let (pixel_format, file_format) = match params.node.plugin.value.as_str() {
            // It has bands, which its caller knows, and these are kept in OpenEXR files only.
            "specfilm" => Default::default(),
            _ => formats(params),
        };
        let components = ["float16", "float32", "uint32"];
        let component = params.choice("component_format", "float32", &components);
        if component != "float32" {
            let message = format!("`{component}` is not used: files hold 32-bit floats");
            note(params, "component_format", message);
        }
        let filter = params
            .child(Class::ReconstructionFilter)
            .map(|node| {
                let child = Params::new(node, params.diagnostics);
                let filter = Filter::from_params(&child);
                child.finish();
                filter
            })
            .unwrap_or_default();
        let filter_method = filter_method(params, &filter);
        Self {
            size,
            crop_offset: UVec2::ZERO,
            crop_size: size,
            pixel_format,
            bands: Vec::new(),
            file_format,
            filter,
            filter_method,
        }
    }
}

/// Reads the stored components of a colour, and the kind of file.
fn formats(params: &Params<'_>) -> (PixelFormat, FileFormat) {
    let mut names: Vec<_> = PixelFormat::ALL.iter().map(|(name, _)| *name).collect();
    // As Mitsuba 0.6 spells it.
    names.push("luminanceAlpha");
    // … which has two more: what a build of three numbers per spectrum keeps, and one for each part of `multichannel`.
    names.push("spectrum");
    let list = params.string("pixel_format").unwrap_or_default();
    let name = match list.split_once(',') {
        Some((first, _)) => {
            let first = names
                .iter()
                .find(|name| name.eq_ignore_ascii_case(first.trim()));
            let message = "of a list of formats the first counts: it is that of the picture, beside which further ones keep all their channels";
            note(params, "pixel_format", message);
            first.copied().unwrap_or_else(|| {
                params.refuse("pixel_format", list, &names.join(", "));
                PixelFormat::default().name()
            })
        }
        None => params.choice("pixel_format", PixelFormat::default().name(), &names),
    };
    let name = match name {
        "luminanceAlpha" => "luminance_alpha",
        "spectrum" => {
            let message =
                "`spectrum` is read as `rgb`: the film `specfilm` keeps bands of the spectrum";
            note(params, "pixel_format", message);
            "rgb"
        }
        name => name,
    };
    let pixel_format = PixelFormat::ALL
        .into_iter()
        .find(|(known, _)| *known == name);
    let files: &[_] = match params.node.plugin.value.as_str() {
        "ldrfilm" => &["openexr", "png", "jpeg"],
        "mfilm" => &["openexr", "matlab", "mathematica", "numpy"],
        _ => &["openexr", "exr", "rgbe", "pfm"],
    };
    let file_format = match params.choice("file_format", "openexr", files) {
        "rgbe" => FileFormat::Rgbe,
        "pfm" => FileFormat::Pfm,
        _ => FileFormat::OpenExr,
    };
    let pixel_format = pixel_format.map_or_else(PixelFormat::default, |(_, format)| format);
    (pixel_format, file_format)
}

/// Makes a note at a parameter.
fn note(params: &Params<'_>, name: &str, message: impl Into<String>) {
    let property = params.property(name);
    let span = property.map_or(params.node.plugin.span, |p| p.span);
    params.diagnostics.push(Diagnostic::note(span, message));
}

/// Reads `filter_method`; says so where the filter is too wide for what was asked.
fn filter_method(params: &Params<'_>, filter: &Filter) -> FilterMethod {
    let names = FilterMethod::ALL.map(|(name, _)| name);
    let name = params.choice("filter_method", FilterMethod::default().name(), &names);
    let named = FilterMethod::ALL
        .into_iter()
        .find(|(known, _)| *known == name);
    let method = named.map_or_else(FilterMethod::default, |(_, method)| method);
    if filter.radius() > FilterMethod::WIDEST && method != FilterMethod::ImportanceSampling {
        let message = format!(
            "the filter reaches {:.1} pixels far: it is importance-sampled, since pixels share samples up to {} pixels",
            filter.radius(),
            FilterMethod::WIDEST
        );
        note(params, "filter_method", message);
    }
    method
}

/// Reports a crop that ends beyond the film, at the first of these parameters that is given.
fn check_end(params: &Params<'_>, names: [&str; 2], axis: &str, end: u32, whole: u32) {
    if end > whole {
        let given = if params.has(names[0]) {
            names[0]
        } else {
            names[1]
        };
        let message = format!("the crop ends at {axis} = {end}, but the film at {axis} = {whole}");
        params.error_at(given, message);
    }
}

/// A number of pixels of at least `least`.
fn extent(params: &Params<'_>, name: &str, default: u32, least: u32) -> u32 {
    let Some(value) = params.integer(name) else {
        return default;
    };
    match u32::try_from(value) {
        Ok(value) if (least..=FilmSettings::LARGEST).contains(&value) => value,
        _ => {
            let accepted = format!("a whole number from {least} to {}", FilmSettings::LARGEST);
            params.refuse(name, value, &accepted);
            default
        }
    }
}
