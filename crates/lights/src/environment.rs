//! `envmap`: radiance from infinity, given by an image.
//!
//! The image is in latitude and longitude with texels at u = (i + ½)/w and v = j/(h − 1): the first and last rows lie on the
//! poles; a single row reaches from pole to pole. With `mapping` `equalarea` it is the square of pbrt-v4's maps, with texels at
//! (i + ½)/n. The radiances of the four texels around a
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

mod mapping;
mod pixels;

use self::mapping::Mapping;
use self::pixels::Pixels;
use crate::light_model::LightModel;
use crate::pose::Pose;
use crate::sky_image::SkyImage;
use crate::{BoundingSphere, sky};
use etalon_math::lane::{Lane, Mask};
use etalon_math::{Density, SolidAngle};
use etalon_params::{Diagnostic, Params};
use etalon_sampling::discrete::Bilinear;
use etalon_spectrum::{Spectrum, Wavelengths};
use etalon_transport::{
    Build, Emission, EmissionPdf, LaneLightSample, LaneReceiver, LightSample, LightSampleContext,
    Shapes, Textures, file,
};
use glam::{Vec2, Vec3, Vec4};
use std::sync::Arc;

/// An image at infinity.
#[derive(Clone, Debug)]
pub struct EnvironmentMap {
    pose: Pose,
    scale: f32,
    mapping: Mapping,
    image: Arc<SkyImage>,
    tables: Tables,
    /// Mean radiance over directions and wavelengths.
    mean: f64,
}

/// Distributions of directions over the square of places; `None` if the image is black.
#[derive(Clone, Debug)]
struct Tables {
    /// MIS-compensated, for estimators that combine it with BSDF sampling.
    combined: Option<Arc<Bilinear>>,
    /// Without compensation, for particles and for estimators that have no other technique: every
    /// direction must have a density.
    alone: Option<Arc<Bilinear>>,
}

impl EnvironmentMap {
    /// Reads `filename`, `mapping`, `scale`, `to_world`, `mis_compensation`, and `gamma` as `bitmap` has it.
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let scale = params.float_where("scale", 1.0, "a finite number not below 0", |x| {
            x >= 0.0 && x.is_finite()
        });
        let compensated = params.boolean_or("mis_compensation", true);
        let pose = Pose::from_params(params);
        let raw = file::is_linear(params);
        let filename = params.string("filename").unwrap_or_default();
        let what = "the name of an image file";
        let choices = ["equirectangular", "equalarea"];
        let poles = params.choice("mapping", choices[0], &choices) == choices[0];
        let read = |bytes: &[u8]| pixels::decode(bytes, (raw, poles), filename);
        let pixels = file::read(params, build, what, read)?;
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
        let size = pixels.size;
        if !poles && size.x != size.y {
            let message = format!(
                "`{filename}` has {} × {} pixels: an image in the equal-area `mapping` is a square",
                size.x, size.y
            );
            params.error_at("filename", message);
            return None;
        }
        let mapping = match poles {
            true => Mapping::LatitudeLongitude {
                half_texel: 0.5 / size.x as f32,
            },
            false => Mapping::EqualArea {
                side: size.x as f32,
            },
        };
        Some(Self::new(
            pose?,
            scale as f32,
            mapping,
            &pixels,
            compensated,
        ))
    }

    fn new(pose: Pose, scale: f32, mapping: Mapping, pixels: &Pixels, compensated: bool) -> Self {
        let (width, height) = (pixels.size.x as usize, pixels.size.y as usize);
        let brightness = |rgb: &[f32; 3]| rgb.iter().map(|&c| f64::from(c)).sum::<f64>() / 3.0;
        let solid_angle = mapping.solid_angles(height);
        let mut sums = [0.0; 3];
        let mut least = f64::INFINITY;
        for (row, texels) in pixels.rgb.chunks_exact(width).enumerate() {
            let share = solid_angle(row);
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
        let (size, nodes) = mapping.nodes(pixels.size, &pixels.rgb);
        let columns = size.x as usize;
        let weight = mapping.row_weights(height);
        let table = |offset: f64| {
            let density = |(row, nodes): (usize, &[[f32; 3]])| {
                let weight = weight(row);
                let of_node = |rgb| ((brightness(rgb) - offset).max(0.0) * weight) as f32;
                nodes.iter().map(of_node).collect::<Vec<_>>()
            };
            let rows = nodes.chunks_exact(columns).enumerate();
            let densities: Vec<f32> = rows.flat_map(density).collect();
            Bilinear::new(&densities, columns).ok().map(Arc::new)
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
            mapping,
            image: Arc::new(SkyImage::new(size, &nodes)),
            tables: Tables { combined, alone },
            mean: sums[1] / sums[2] * white * f64::from(scale),
        }
    }

    /// Radiance at places, at the wavelengths `lambda(i)` in lane i.
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
        self.density_at::<f32>(directions, local, self.mapping.place(local))
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
        let per_area = F::from_fn(|i| directions.density(Vec2::new(u.lane(i), v.lane(i))));
        self.mapping.per_solid_angle(per_area, local, [u, v])
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
        let chosen = [0, 1].map(|k| F::from_fn(|i| places[i][k]));
        let (local, place) = self.mapping.direction(chosen);
        let per_area = F::from_fn(|i| directions.density(places[i]));
        let density = self.mapping.per_solid_angle(per_area, local, place);
        (self.pose.to_world_lanes::<F>(local), place, density)
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
    fn background(
        &self,
        _: &impl Textures,
        direction: Vec3,
        _time: f32,
        wavelengths: &Wavelengths,
    ) -> Vec4 {
        let place = self.mapping.place(self.pose.to_local(direction));
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
        let place = self.mapping.place(local);
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
