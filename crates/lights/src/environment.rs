//! `envmap`: radiance from infinity, given by a latitude-longitude image.
//!
//! The image has texels at u = (i + ½)/w and v = j/(h − 1): the first and last rows lie on the
//! poles; a single row reaches from pole to pole. The radiances of the four texels around a
//! direction are interpolated bilinearly,
//!
//! ```text
//! L(ω, λ) = scale · D65(λ) · Σ wᵢ mᵢ sᵢ(λ)
//! ```
//!
//! where mᵢ is twice the largest component of texel i and sᵢ the smooth spectrum of rgbᵢ/mᵢ.
//! Directions are chosen with a density bilinear in (u, v) through the nodes (r + g + b)/3 · sⱼ,
//! where sⱼ is the mean of sin θ over the row's hat function (`row_weights`): positive at the
//! poles, too, so that the density vanishes nowhere where the radiance does not. For receivers that
//! combine light sampling with scattering the brightness counts less its mean (Karlík, Šik, Vévoda,
//! Skřivan, Křivánek 2019, "MIS Compensation"), which leaves dark regions to scattering. All
//! others, such as `direct` with `bsdf_samples` zero, and particles have the whole brightness.

use crate::light_model::LightModel;
use crate::pose::Pose;
use crate::sky_image::SkyImage;
use crate::{BoundingSphere, sky};
use etalon_images::raster_file;
use etalon_math::lane::{Lane, Mask, Select, Vector};
use etalon_math::{Density, SolidAngle, float64};
use etalon_params::{Diagnostic, Params};
use etalon_sampling::discrete::Bilinear;
use etalon_sampling::latitude_longitude as map;
use etalon_spectrum::{Spectrum, Wavelengths};
use etalon_transport::{
    Build, Emission, EmissionPdf, LaneLightSample, LaneReceiver, LightSample, LightSampleContext,
    Shapes, Textures, file,
};
use glam::{UVec2, Vec2, Vec3, Vec4};
use std::path::Path;
use std::sync::Arc;

/// The mean of sin πv over the hat function of each of `height` ≥ 2 rows at v = j/(h − 1), with
/// k = π/(h − 1):
///
/// ```text
/// sⱼ = sin(jk) · 2(1 − cos k)/k²,     s₀ = s₍ₕ₋₁₎ = (1 − sin k / k) · 2/k
/// ```
fn row_weights(height: usize) -> impl Fn(usize) -> f64 {
    let k = core::f64::consts::PI / (height - 1) as f64;
    // sin²(k/2) for (1 − cos k)/2, and a series for 1 − sin k / k where it would cancel.
    let half = float64::sin(0.5 * k) / (0.5 * k);
    let pole = if k < 1e-2 {
        k / 3.0 * (1.0 - k * k / 20.0)
    } else {
        (1.0 - float64::sin(k) / k) * 2.0 / k
    };
    move |row| {
        if row == 0 || row + 1 == height {
            pole
        } else {
            float64::sin(row as f64 * k) * half * half
        }
    }
}

/// An image at infinity.
#[derive(Clone, Debug)]
pub struct EnvironmentMap {
    pose: Pose,
    scale: f32,
    image: Arc<SkyImage>,
    tables: Tables,
    /// Mean radiance over directions and wavelengths.
    mean: f64,
}

/// Distributions of directions over the moved unit square; `None` if the image is black.
#[derive(Clone, Debug)]
struct Tables {
    /// MIS-compensated, for estimators that combine it with BSDF sampling.
    combined: Option<Arc<Bilinear>>,
    /// Without compensation, for particles and for estimators that have no other technique: every
    /// direction must have a density.
    alone: Option<Arc<Bilinear>>,
}

impl EnvironmentMap {
    /// Reads `filename`, `scale`, `to_world`, `mis_compensation`, and `gamma` as `bitmap` has it.
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let scale = params.float_where("scale", 1.0, "a finite number not below 0", |x| {
            x >= 0.0 && x.is_finite()
        });
        let compensated = params.boolean_or("mis_compensation", true);
        let pose = Pose::from_params(params);
        let raw = file::is_linear(params);
        let filename = params.string("filename").unwrap_or_default();
        let what = "the name of an image file";
        let pixels = file::read(params, build, what, |bytes| decode(bytes, raw, filename))?;
        let span = file::span_of_filename(params);
        for note in &pixels.notes {
            let message = format!("`{filename}`: {note}");
            params.diagnostics.push(Diagnostic::note(span, message));
        }
        if pixels.negative > 0 {
            let message = format!(
                "{} pixels of `{filename}` have negative components, which count as zero",
                pixels.negative
            );
            params.diagnostics.push(Diagnostic::note(span, message));
        }
        Some(Self::new(pose?, scale as f32, &pixels, compensated))
    }

    fn new(pose: Pose, scale: f32, pixels: &Pixels, compensated: bool) -> Self {
        let (width, height) = (pixels.size.x as usize, pixels.size.y as usize);
        let sine = row_weights(height);
        let brightness = |rgb: &[f32; 3]| rgb.iter().map(|&c| f64::from(c)).sum::<f64>() / 3.0;
        let mut sums = [0.0; 3];
        let mut least = f64::INFINITY;
        for (row, texels) in pixels.rgb.chunks_exact(width).enumerate() {
            // Half of the hat function of a row at a pole lies beyond it.
            let at_pole = row == 0 || row + 1 == height;
            let share = sine(row) * if at_pole { 0.5 } else { 1.0 };
            for rgb in texels {
                let value = brightness(rgb);
                least = least.min(value);
                sums[0] += value;
                sums[1] += value * share;
                sums[2] += share;
            }
        }
        let average = sums[0] / pixels.rgb.len() as f64;
        // Nothing would be left of an (almost) uniform image.
        let offset = if compensated && average - least > 0.01 * average {
            average
        } else {
            0.0
        };
        let table = |offset: f64| {
            let mut nodes = Vec::with_capacity((width + 1) * height);
            for (row, texels) in pixels.rgb.chunks_exact(width).enumerate() {
                let node =
                    |rgb: &[f32; 3]| ((brightness(rgb) - offset).max(0.0) * sine(row)) as f32;
                nodes.extend(texels.iter().map(node));
                // The image is periodic.
                nodes.push(node(&texels[0]));
            }
            Bilinear::new(&nodes, width + 1).ok().map(Arc::new)
        };
        let alone = table(0.0);
        let combined = if offset > 0.0 {
            table(offset)
        } else {
            alone.clone()
        };
        let white = Spectrum::D65(etalon_spectrum::RgbSpectrum::WHITE).mean();
        Self {
            pose,
            scale,
            image: Arc::new(SkyImage::new(pixels.size, &pixels.rgb)),
            tables: Tables { combined, alone },
            mean: sums[1] / sums[2] * white * f64::from(scale),
        }
    }

    /// The unit square of `map`, moved so that u begins at the centre of the first column.
    #[inline(always)]
    fn place<F: Lane>(&self, local: F::Vector) -> [F; 2] {
        let [u, v] = map::to_square::<F>(local);
        let u = u - self.half_texel();
        [u.lt(F::ZERO).select(u + 1.0, u), v]
    }

    #[inline]
    fn half_texel(&self) -> f32 {
        0.5 / self.image.size().x as f32
    }

    /// Radiance at moved places, at the wavelengths `lambda(i)` in lane i.
    #[inline(always)]
    fn radiance<F: Lane>(&self, place: [F; 2], lambda: impl Fn(usize) -> Vec4) -> F::Spectrum {
        self.image.radiance(place, lambda) * F::splat(self.scale)
    }

    /// The distribution of directions for the receiver `from`.
    #[inline]
    fn toward(&self, from: &LightSampleContext) -> Option<&Bilinear> {
        let Tables { combined, alone } = &self.tables;
        if from.combined { combined } else { alone }.as_deref()
    }

    #[inline]
    fn density_of(&self, directions: Option<&Bilinear>, direction: Vec3) -> f32 {
        let local = self.pose.to_local(direction);
        self.density_at::<f32>(directions, local, self.place::<f32>(local))
    }

    /// The densities (sr⁻¹) of directions in the map's space and their places.
    #[inline(always)]
    fn density_at<F: Lane>(
        &self,
        directions: Option<&Bilinear>,
        local: F::Vector,
        [u, v]: [F; 2],
    ) -> F {
        let Some(directions) = directions else {
            return F::ZERO;
        };
        let [x, _, z] = local.xyz();
        let sin_theta = (x * x + z * z).sqrt();
        let per_area = F::from_fn(|i| directions.density(Vec2::new(u.lane(i), v.lane(i))));
        let density = per_area / map::stretch(sin_theta);
        sin_theta.gt(F::ZERO).select(density, F::ZERO)
    }

    /// Directions, of lanes where they are `wanted`, with their places and densities (sr⁻¹); 0 where there is none.
    #[inline(always)]
    fn choose<F: Lane>(
        &self,
        directions: &Bilinear,
        wanted: F::Mask,
        [u, v]: [F; 2],
    ) -> (F::Vector, [F; 2], F) {
        let places = F::array(|i| match wanted.lane(i) {
            true => directions.sample(Vec2::new(u.lane(i), v.lane(i))),
            false => Vec2::ZERO,
        });
        let places = places.as_ref();
        let [x, y] = [0, 1].map(|k| F::from_fn(|i| places[i][k]));
        let (local, sin_theta) = map::to_direction([x + self.half_texel(), y]);
        let per_area = F::from_fn(|i| directions.density(places[i]));
        let density = per_area / map::stretch(sin_theta);
        let exists = sin_theta.gt(F::ZERO) & density.gt(F::ZERO);
        (
            self.pose.to_world_lanes::<F>(local),
            [x, y],
            exists.select(density, F::ZERO),
        )
    }

    /// One direction; `None` where there is none.
    #[inline]
    fn choose_one(&self, directions: &Bilinear, u: Vec2) -> Option<(Vec3, [f32; 2], f32)> {
        let (direction, place, density) = self.choose::<f32>(directions, true, u.to_array());
        (density > 0.0).then_some((direction, place, density))
    }
}

impl LightModel for EnvironmentMap {
    fn is_infinite(&self) -> bool {
        true
    }

    fn is_background(&self) -> bool {
        true
    }

    #[inline]
    fn emission_density(
        &self,
        _: &impl Shapes,
        bounds: &BoundingSphere,
        direction: Vec3,
        _cos: f32,
        _time: f32,
    ) -> EmissionPdf {
        EmissionPdf {
            origin: self.density_of(self.tables.alone.as_deref(), -direction),
            ray: bounds.ray_density(),
        }
    }

    #[inline]
    fn background(&self, _: &impl Textures, direction: Vec3, wavelengths: &Wavelengths) -> Vec4 {
        let place = self.place::<f32>(self.pose.to_local(direction));
        self.radiance::<f32>(place, |_| wavelengths.lambda)
    }

    #[inline]
    fn background_lanes<F: Lane>(
        &self,
        _: &impl Textures,
        _: &LaneReceiver<F>,
        direction: F::Vector,
        wavelengths: &[Wavelengths],
    ) -> (F::Spectrum, F) {
        let local = self.pose.to_local_lanes::<F>(direction);
        let place = self.place(local);
        // Receivers in lanes combine it with scattering.
        let directions = self.tables.combined.as_deref();
        (
            self.radiance(place, |i| wavelengths[i].lambda),
            self.density_at(directions, local, place),
        )
    }

    #[inline]
    fn background_density(
        &self,
        from: &LightSampleContext,
        direction: Vec3,
    ) -> Density<SolidAngle> {
        Density::uniform(self.density_of(self.toward(from), direction))
    }

    #[inline]
    fn sample(
        &self,
        _: &(impl Textures + Shapes),
        from: &LightSampleContext,
        wavelengths: &Wavelengths,
        u: Vec2,
    ) -> Option<LightSample> {
        let (direction, place, density) = self.choose_one(self.toward(from)?, u)?;
        let radiance = self.radiance::<f32>(place, |_| wavelengths.lambda);
        Some(sky::sample(direction, radiance, Density::uniform(density)))
    }

    fn is_alike(&self, other: &Self, _: &impl Shapes) -> bool {
        core::ptr::eq(self, other)
    }

    #[inline]
    fn sample_lanes<'l, F: Lane>(
        light: impl Fn(usize) -> &'l Self,
        _: &(impl Textures + Shapes),
        (_, wavelengths): (&LaneReceiver<F>, &[Wavelengths]),
        wanted: F::Mask,
        u: [F; 2],
    ) -> LaneLightSample<F> {
        let map = light(0);
        // Receivers in lanes combine it with scattering.
        let Some(directions) = map.tables.combined.as_deref() else {
            return LaneLightSample::none();
        };
        let (direction, place, density) = map.choose(directions, wanted, u);
        LaneLightSample {
            found: density.gt(F::ZERO),
            direction,
            radiance: map.radiance(place, |i| wavelengths[i].lambda),
            chance: density,
            ..LaneLightSample::none()
        }
    }

    #[inline]
    fn emit(
        &self,
        _: &(impl Textures + Shapes),
        bounds: &BoundingSphere,
        wavelengths: &Wavelengths,
        u_position: Vec2,
        u_direction: Vec2,
        _time: f32,
    ) -> Option<Emission> {
        let directions = self.tables.alone.as_deref()?;
        let (toward, place, density) = self.choose_one(directions, u_direction)?;
        let radiance = self.radiance::<f32>(place, |_| wavelengths.lambda);
        Some(sky::emit(bounds, toward, u_position, radiance, density))
    }

    fn power(&self, _: &(impl Textures + Shapes), bounds: &BoundingSphere) -> f64 {
        4.0 * core::f64::consts::PI * bounds.cross_section() * self.mean
    }
}

/// Linear Rec.709 pixels, row after row from the top; at least two rows.
struct Pixels {
    size: UVec2,
    rgb: Vec<[f32; 3]>,
    /// Number of texels with negative components, which became zero.
    negative: usize,
    /// Remarks about the file.
    notes: Vec<String>,
}

fn decode(bytes: &[u8], raw: bool, filename: &str) -> Result<Pixels, String> {
    let raster =
        raster_file::decode(bytes, Path::new(filename)).map_err(|error| error.to_string())?;
    let (width, height) = (raster.width(), raster.height());
    let channels = raster.channels();
    let values = match raw {
        true => raster.to_floats(),
        false => raster.to_linear(),
    };
    let mut negative = 0;
    let mut rgb = Vec::with_capacity(width * height);
    for (i, pixel) in values.chunks_exact(channels).enumerate() {
        let colour = if channels < 3 {
            [pixel[0]; 3]
        } else {
            [pixel[0], pixel[1], pixel[2]]
        };
        if colour.iter().any(|c| !c.is_finite()) {
            let (x, y) = (i % width, i / width);
            return Err(format!(
                "the pixel in column {x} of row {y} of `{filename}` is not finite (both counted from 0)"
            ));
        }
        negative += usize::from(colour.iter().any(|&c| c < 0.0));
        rgb.push(colour.map(|c| c.max(0.0)));
    }
    if height == 1 {
        // The same from pole to pole.
        rgb.extend_from_within(..);
    }
    Ok(Pixels {
        size: UVec2::new(width as u32, height.max(2) as u32),
        rgb,
        negative,
        notes: raster.notes(false).map(str::to_owned).collect(),
    })
}
