//! `goniometric`: a light without extent whose intensity depends on the direction by a table: a luminaire's photometric file, or an image.
//!
//! ```text
//! I(ω, λ) = s T(ω) I(λ)        Φ = s I ∫ T dω
//! ```
//!
//! with s the `scale` and I(λ) the spectrum `intensity`, by default daylight of luminance 1.
//!
//! - **IES** (LM-63, see `ies_profile.rs`): T is the luminous intensity in candela, with all factors of the file, over 683 lm/W. With the default intensity
//!   the luminance of a picture, Y, is that of the real luminaire in cd/m² over 683; `scale` 683 has it in cd/m². T is bilinear in the angles. The nadir
//!   of the file, vertical angle 0, is +z of the light's space, as that of a `spot`; horizontal angle 0 is +x, and 90° is −y, so that
//!   a light that is turned about x to shine down has them counterclockwise, seen from above.
//! - **An image**: T is the mean of its channels, as it is. `equalarea` is pbrt-v4's: Clarberg's square about +z, each pixel the same all over.
//!   `equirectangular` has latitude and longitude as an `envmap`, and is bilinear in them.

use crate::angular_table::AngularTable;
use crate::ies_profile::{IesProfile, is_ies};
use crate::light::{anywhere, extent_of_cone};
use crate::light_model::LightModel;
use crate::pose::{Pose, emit_from_point, extent_of_way, sample_point};
use crate::{BoundingSphere, LightExtent};
use core::f64::consts::{PI, TAU};
use etalon_images::{Raster, raster_file};
use etalon_math::{Animated, equal_area};
use etalon_params::{Diagnostic, Params};
use etalon_sampling::discrete::PiecewiseConstant2d;
use etalon_spectrum::Wavelengths;
use etalon_transport::refuse_varying;
use etalon_transport::{
    Build, Emission, EmissionPdf, LightSample, LightSampleContext, Shapes, SpectrumKind, TextureId,
    Textures, file,
};
use glam::{Vec2, Vec3, Vec4};
use std::path::Path;
use std::sync::Arc;

/// Lumens per watt at 555 nm, which relate candela and W·sr⁻¹.
const LUMINOUS_EFFICACY: f64 = 683.0;

/// T, by directions of the light's space.
#[derive(Clone, Debug)]
enum Table {
    /// Of a luminaire: about z, clockwise.
    Luminaire(AngularTable),
    /// Of an image in latitude and longitude, about y.
    Globe(AngularTable),
    /// Of a square image.
    Square(PiecewiseConstant2d),
}

/// A light with a table.
#[derive(Clone, Debug)]
pub struct Goniometric {
    pose: Animated<Pose>,
    intensity: TextureId,
    scale: f32,
    table: Arc<Table>,
}

/// What a file holds.
enum File {
    Luminaire(IesProfile),
    Image(Raster),
}

impl Goniometric {
    /// Reads `filename`, `mapping` (of an image), `intensity` (1), `scale` (1) and `to_world`.
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        refuse_varying(params, "intensity", build);
        let intensity = build.texture(params, "intensity", Some(1.0), SpectrumKind::Emission);
        let what = "a finite number not below 0";
        let scale = params.float_where("scale", 1.0, what, |s| s >= 0.0 && s.is_finite());
        let pose = Pose::animated(params, build);
        let filename = params.string("filename").unwrap_or_default();
        let what = "the name of an IES file or of an image";
        let read = file::read(params, build, what, |bytes| decode(bytes, filename))?;
        let table = match read {
            File::Luminaire(profile) => {
                if params.has("mapping") {
                    let message = "`mapping` is that of an image: an IES file has angles";
                    params.error_at("mapping", message);
                    params.ignore(&["mapping"]);
                }
                for note in &profile.notes {
                    let message = format!("`{filename}`: {note}");
                    let span = file::span_of_filename(params);
                    params.diagnostics.push(Diagnostic::note(span, message));
                }
                Table::of_luminaire(&profile)
            }
            File::Image(image) => {
                let names = ["equalarea", "equirectangular"];
                let square = params.choice("mapping", "equalarea", &names) == "equalarea";
                Table::of_image(&image, square)
            }
        };
        let table = table.map_err(|why| {
            let message = format!("`{filename}` cannot be used: {why}");
            let span = file::span_of_filename(params);
            params.diagnostics.push(Diagnostic::error(span, message));
        });
        Some(Self {
            pose: pose?,
            intensity,
            scale: scale as f32,
            table: Arc::new(table.ok()?),
        })
    }

    /// The spectrum, scaled (W·sr⁻¹·nm⁻¹ for T = 1).
    #[inline]
    fn spectrum(&self, textures: &impl Textures, wavelengths: &Wavelengths) -> Vec4 {
        textures.spectrum(self.intensity, &anywhere(), wavelengths.lambda) * self.scale
    }
}

/// Reads a file of either kind.
fn decode(bytes: &[u8], filename: &str) -> Result<File, String> {
    let path = Path::new(filename);
    let named = path
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("ies"));
    if named || is_ies(bytes) {
        return IesProfile::parse(bytes).map(File::Luminaire);
    }
    let image = raster_file::decode(bytes, path).map_err(|error| error.to_string())?;
    Ok(File::Image(image))
}

impl Table {
    const DARK: &str = "it is black";

    fn of_luminaire(profile: &IesProfile) -> Result<Self, String> {
        let radians = |degrees: &[f64]| degrees.iter().map(|a| a.to_radians()).collect::<Vec<_>>();
        let (theta, phi) = (radians(&profile.vertical), radians(&profile.horizontal));
        let rows = theta.len();
        let mut values = Vec::with_capacity(profile.candela.len());
        for row in 0..rows {
            let across = profile.candela.iter().skip(row).step_by(rows);
            values.extend(across.map(|candela| candela / LUMINOUS_EFFICACY));
        }
        let table = AngularTable::new(&theta, &phi, &values);
        table
            .map(Self::Luminaire)
            .ok_or_else(|| Self::DARK.to_owned())
    }

    fn of_image(image: &Raster, square: bool) -> Result<Self, String> {
        let (width, height) = (image.width(), image.height());
        let channels = image.channels();
        let colours = channels.min(3);
        let mut values = Vec::with_capacity(width * height);
        for (i, pixel) in image.to_linear().chunks_exact(channels).enumerate() {
            // An alpha or a second channel is no colour.
            let colours = if colours < 3 {
                &pixel[..1]
            } else {
                &pixel[..3]
            };
            let mean = colours.iter().map(|&c| f64::from(c)).sum::<f64>() / colours.len() as f64;
            if !(mean >= 0.0 && mean.is_finite()) {
                let (x, y) = (i % width, i / width);
                return Err(format!(
                    "the pixel in column {x} of row {y} is {mean} (both counted from 0)"
                ));
            }
            values.push(mean);
        }
        let dark = |_| Self::DARK.to_owned();
        if square {
            if width != height {
                return Err(format!(
                    "a map of equal areas is square, and it has {width} × {height} pixels"
                ));
            }
            return PiecewiseConstant2d::new(&values, width)
                .map(Self::Square)
                .map_err(dark);
        }
        // Nodes in the middles of the pixels, and where the image is closed.
        let nodes = |count: usize, whole: f64| -> Vec<f64> {
            let middles = (0..count).map(|i| (i as f64 + 0.5) / count as f64 * whole);
            [0.0].into_iter().chain(middles).chain([whole]).collect()
        };
        let mut padded = Vec::with_capacity((width + 2) * (height + 2));
        for row in 0..height + 2 {
            let row = row.clamp(1, height) - 1;
            let pixels = &values[row * width..(row + 1) * width];
            let seam = 0.5 * (pixels[0] + pixels[width - 1]);
            padded.extend([seam].iter().chain(pixels).chain(&[seam]));
        }
        let table = AngularTable::new(&nodes(height, PI), &nodes(width, TAU), &padded);
        table.map(Self::Globe).ok_or_else(|| Self::DARK.to_owned())
    }

    /// T in a unit direction of the light's space.
    fn at(&self, local: Vec3) -> f32 {
        match self {
            Self::Luminaire(table) => table.at(about_nadir(local)),
            Self::Globe(table) => table.at(about_up(local)),
            Self::Square(cells) => {
                let mean = cells.integral() as f32;
                cells.density(Vec2::from(equal_area::to_square::<f32>(local))) * mean
            }
        }
    }

    /// ∫ T dω.
    fn integral(&self) -> f64 {
        match self {
            Self::Luminaire(table) | Self::Globe(table) => table.integral(),
            Self::Square(cells) => cells.integral() * 2.0 * TAU,
        }
    }

    /// The density of [`Table::sample`] (sr⁻¹).
    fn density(&self, local: Vec3) -> f32 {
        match self {
            Self::Luminaire(table) => table.density(about_nadir(local)),
            Self::Globe(table) => table.density(about_up(local)),
            Self::Square(cells) => {
                cells.density(Vec2::from(equal_area::to_square::<f32>(local)))
                    / (2.0 * core::f32::consts::TAU)
            }
        }
    }

    /// A unit direction of the light's space about in proportion to T, and its density (sr⁻¹).
    fn sample(&self, u: Vec2) -> (Vec3, f32) {
        match self {
            Self::Luminaire(table) => {
                let (direction, density) = table.sample(u);
                // It is its own inverse.
                (about_nadir(direction), density)
            }
            Self::Globe(table) => {
                let (Vec3 { x, y, z }, density) = table.sample(u);
                (Vec3::new(y, z, -x), density)
            }
            Self::Square(cells) => {
                let place = cells.sample(u);
                let density = cells.density(place) / (2.0 * core::f32::consts::TAU);
                (equal_area::to_direction::<f32>(place.to_array()), density)
            }
        }
    }

    /// The cosine of the angle from z beyond which T is 0.
    fn cos_edge(&self) -> f32 {
        match self {
            Self::Luminaire(table) => table.cos_edge(),
            Self::Globe(_) | Self::Square(_) => -1.0,
        }
    }
}

/// A direction as a luminaire's file has it.
#[inline]
fn about_nadir(local: Vec3) -> Vec3 {
    Vec3::new(local.x, -local.y, local.z)
}

/// A direction as `etalon_sampling::latitude_longitude` has it, with the pole at z.
#[inline]
fn about_up(local: Vec3) -> Vec3 {
    Vec3::new(-local.z, local.x, local.y)
}

impl LightModel for Goniometric {
    #[inline]
    fn is_even(&self, _: &LightSampleContext) -> bool {
        true
    }

    #[inline]
    fn emission_density(
        &self,
        _: &impl Shapes,
        _: &BoundingSphere,
        direction: Vec3,
        _cos: f32,
        time: f32,
    ) -> EmissionPdf {
        let local = self.pose.at(time, |pose| pose.to_local(direction));
        EmissionPdf {
            origin: 1.0,
            ray: self.table.density(local),
        }
    }

    #[inline]
    fn sample(
        &self,
        textures: &(impl Textures + Shapes),
        from: &LightSampleContext,
        wavelengths: &Wavelengths,
        _: Vec2,
    ) -> Option<LightSample> {
        sample_point(&self.pose, from, |local| {
            self.spectrum(textures, wavelengths) * self.table.at(local)
        })
    }

    #[inline]
    fn emit(
        &self,
        textures: &(impl Textures + Shapes),
        _: &BoundingSphere,
        wavelengths: &Wavelengths,
        _: Vec2,
        u: Vec2,
        time: f32,
    ) -> Option<Emission> {
        let (local, density) = self.table.sample(u);
        let intensity = self.spectrum(textures, wavelengths) * self.table.at(local);
        (density > 0.0).then(|| emit_from_point(&self.pose, local, intensity, density, time))
    }

    fn power(&self, textures: &(impl Textures + Shapes), _: &BoundingSphere) -> f64 {
        self.table.integral() * f64::from(textures.mean(self.intensity) * self.scale)
    }

    fn extent(&self, _: &impl Shapes) -> Option<LightExtent> {
        let still = extent_of_cone(self.pose.start(), self.table.cos_edge());
        Some(extent_of_way(&self.pose, still))
    }
}
