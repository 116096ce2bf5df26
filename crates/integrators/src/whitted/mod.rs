//! `whitted`: recursive ray tracing (Whitted 1980), deterministic by default.
//!
//! ```text
//! L(x, ω) = Lₑ + Σ_lights Σ_points V f |cos θ| E + Σ_directions w · L(next surface)
//! ```
//!
//! Of the integral over all directions two parts are evaluated: direct light, from N points of every
//! light ([`PointSet`]), and light from the discrete directions of smooth surfaces (mirrors, refraction,
//! total reflection), each of which is followed. All other light is missing, so this is not an
//! estimator of the rendering equation; without such light it is exact, with hard shadows.
//!
//! Classic Phong materials ([`LegacyPhong`]) fill the gap with an ambient term:
//!
//! ```text
//! L = (1 − α) (kₐ Lₐ + Σ V E (k_d cos θ + kₛ max(0, cos ρ)ⁿ) + k_g L_mirror + k_d E_caustic) + α L_refracted
//! ```
//!
//! θ is the angle between the light and the normal on the viewer's side, ρ that between the light and the
//! mirrored view (Phong 1975); lights behind the surface do not contribute. E is the irradiance of a lamp of
//! intensity I: I/r², or I without fall-off. Under total reflection L_refracted is L_mirror. Shadow rays pass
//! transparent classic surfaces unrefracted, attenuated by α at each; other surfaces cast black shadows unless
//! they have a null interaction (`mask`, …). With `photons`, a photon map (`caustics.rs`) gives E_caustic, the light by way
//! of mirrors and glass, and transparent surfaces cast black shadows too. θ, ρ and secondary rays use the normal after
//! `normalmap` and `bumpmap`.
//!
//! Wavelengths are nodes of a quadrature ([`QuadratureNode`]) in strata of equal probability, so pictures have no noise as
//! long as no point is random. Smooth dispersion refracts each wavelength separately. A pixel is the mean over a grid of
//! points, refined where neighbours differ. Random points are drawn for each sample of a pixel, photons for each
//! replicate.
//!
//! [`LegacyPhong`]: etalon_transport::LegacyPhong
//! [`QuadratureNode`]: etalon_spectrum::QuadratureNode

mod caustics;
mod continuation;
mod light;
mod onward;
mod packet;
mod phong;
mod pixel;
mod points;
mod surface;
mod tree;

use crate::photons::{radius, read_count, read_nearest};
pub use caustics::CausticSettings;
use caustics::Caustics;
pub use continuation::Continuation;
use etalon_params::Params;
use etalon_sampling::{ReplicateKind, Sampler};
use etalon_transport::{
    Channel, Incompatibility, Integrator, Pass, PixelSample, Placing, Preparation, SampleJob,
    SceneCapabilities, Sink, Subject, TileSink, World,
};
use glam::{UVec2, Vec4};
pub use onward::onward;
use packet::Packet;
pub use pixel::Grid;
pub use points::{Placement, PointSet};
use std::cell::RefCell;
use std::sync::OnceLock;
use std::vec::Drain;
use tree::Tree;

/// The fall-off of lights without extent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Falloff {
    /// Not at all.
    None,
    /// With the square of the distance, as light does.
    InverseSquare,
}

/// The recursive ray tracer.
#[derive(Clone, Debug)]
pub struct Whitted {
    /// Longest path in segments, as in `path`.
    pub max_depth: u32,
    /// Whether lights are invisible to the camera.
    pub hide_emitters: bool,
    /// The fall-off of lights.
    pub falloff: Falloff,
    /// The strength of ambient light, which is white.
    pub ambient: f32,
    /// The points at which lights with an extent are sampled.
    pub light_points: PointSet,
    /// The points of a lens that are looked through.
    pub lens_points: PointSet,
    /// The settings of caustics.
    pub caustics: CausticSettings,
    /// Number of wavelengths, a multiple of four.
    pub wavelengths: u32,
    /// The points of a pixel.
    pub grid: Grid,
}

/// The most wavelengths.
const MOST_WAVELENGTHS: u32 = 64;

impl Whitted {
    /// Reads `max_depth` (8), `hide_emitters`, `falloff` (`inverse_square`), `ambient` (1),
    /// `light_samples` (1), `light_sampling` (`grid`), `lens_samples` (1), `lens_sampling` (`grid`), `photons` (none), `radius`, `nearest`
    /// (0), `wavelengths` (36), `supersampling` (2), `adaptive` (0) and `contrast` (0.05).
    pub fn from_params(params: &Params<'_>) -> Self {
        let count = |name: &str, default: u32, range: core::ops::RangeInclusive<u32>| {
            let value = params.integer_or(name, i64::from(default));
            let good = u32::try_from(value).ok().filter(|n| range.contains(n));
            good.unwrap_or_else(|| {
                let what = format!("{}, … {}", range.start(), range.end());
                params.refuse(name, value, &what);
                default
            })
        };
        let max_depth = params.integer_or("max_depth", 8);
        if !(0..=64).contains(&max_depth) {
            params.refuse(
                "max_depth",
                max_depth,
                "0, 1, … 64: `whitted` follows every branch and needs an end",
            );
        }
        let wavelengths = count("wavelengths", 36, 4..=MOST_WAVELENGTHS);
        if wavelengths % 4 != 0 {
            params.refuse("wavelengths", wavelengths, "a multiple of 4");
        }
        let falloff = [
            ("inverse_square", Falloff::InverseSquare),
            ("none", Falloff::None),
        ];
        let names = falloff.map(|(name, _)| name);
        let chosen = params.choice("falloff", "inverse_square", &names);
        let falloff = falloff.into_iter().find(|(name, _)| *name == chosen);
        for name in ["radius", "nearest"] {
            if params.has(name) && !params.has("photons") {
                params.error_at(name, format!("`{name}` has no effect without `photons`"));
            }
        }
        let positive = |x: f64| x >= 0.0 && x.is_finite();
        let number = |name, default| {
            params.float_where(name, default, "a finite number not below 0", positive) as f32
        };
        let points =
            |placement, side| PointSet::from_params(params, placement, count(side, 1, 1..=64));
        let grid = Grid {
            side: count("supersampling", 2, 1..=pixel::MOST),
            levels: count("adaptive", 0, 0..=8),
            contrast: number("contrast", 0.05),
        };
        Self {
            max_depth: u32::try_from(max_depth).unwrap_or(0),
            hide_emitters: params.boolean_or("hide_emitters", false),
            falloff: falloff.map_or(Falloff::InverseSquare, |(_, falloff)| falloff),
            ambient: number("ambient", 1.0),
            light_points: points("light_sampling", "light_samples"),
            lens_points: points("lens_sampling", "lens_samples"),
            caustics: CausticSettings {
                photons: read_count(params).unwrap_or(0),
                radius: radius::read(params, "radius"),
                nearest: read_nearest(params, "nearest"),
            },
            wavelengths,
            grid,
        }
    }

    /// Whether every sample of a pixel differs from the others.
    fn is_random(&self) -> bool {
        self.light_points.is_random() || self.lens_points.is_random()
    }

    /// A pixel's colour and alpha.
    fn pixel<W: World>(
        &self,
        world: &W,
        picture: &Picture,
        pixel: UVec2,
        sampler: &mut impl Sampler,
    ) -> Vec4 {
        let corner = pixel.as_vec2();
        let neighbours = RefCell::default();
        let tree = Tree {
            world,
            caustics: picture.caustics.as_ref(),
            neighbours: &neighbours,
        };
        let look = |raster| self.through(&tree, &picture.packets, raster, sampler);
        self.grid.mean(corner, look)
    }
}

/// The finished pixels of a pass, and its photons. If nothing is random, each pixel is evaluated once for all its
/// samples; without photons, once for all replicates.
pub struct Picture {
    origin: UVec2,
    width: u32,
    pixels: Vec<OnceLock<Vec4>>,
    packets: Vec<Packet>,
    caustics: Option<Caustics>,
}

impl Picture {
    fn blank(pass: &Pass, packets: Vec<Packet>, caustics: Option<Caustics>) -> Self {
        let count = pass.size.x as usize * pass.size.y as usize;
        Self {
            origin: pass.origin,
            width: pass.size.x,
            pixels: core::iter::repeat_with(OnceLock::new).take(count).collect(),
            packets,
            caustics,
        }
    }

    /// Whether it has a pixel, which may lie around the film.
    fn has(&self, pixel: UVec2) -> bool {
        let place = pixel.wrapping_sub(self.origin);
        let height = self.pixels.len() / self.width as usize;
        place.x < self.width && (place.y as usize) < height
    }

    fn pixel(&self, pixel: UVec2, look: impl FnOnce() -> Vec4) -> Vec4 {
        if !self.has(pixel) {
            return look();
        }
        let place = pixel - self.origin;
        let index = place.y as usize * self.width as usize + place.x as usize;
        *self.pixels[index].get_or_init(look)
    }
}

impl Preparation for Picture {
    fn remarks(&self) -> Vec<String> {
        Vec::new()
    }
}

impl Integrator for Whitted {
    const UNBIASED: bool = false;
    const MEDIA: bool = false;
    const DIFFUSION: bool = false;
    const FOLLOWS_LIGHT: bool = false;

    type State = Picture;

    fn channels(&self) -> Vec<Channel> {
        Vec::new()
    }

    fn splats(&self) -> bool {
        false
    }

    /// It samples all lights and renders classic materials; a sky has no points to sample.
    fn incompatibilities(&self, capabilities: &SceneCapabilities) -> Vec<Incompatibility> {
        let message = "`whitted` asks every light at fixed points, and this scene has a sky, which \
                       shines from everywhere";
        let sky = capabilities
            .sky
            .then(|| Incompatibility::fatal(Subject::Integrator, message));
        let ambient = capabilities.classic && self.ambient > 0.0;
        let unlit = capabilities.unlit().filter(|_| !ambient);
        let lens = match (capabilities.aperture, self.lens_points.side) {
            (true, 1) if !self.lens_points.is_random() => Some((
                "`whitted` looks through the middle of the lens alone, so that all is in focus",
                "`lens_samples` 8 looks through 8 × 8 points of it",
            )),
            (false, 2..) => Some((
                "`lens_samples` has no effect: the camera has no lens, and what it sees is in focus",
                "the sensor `thinlens` has one",
            )),
            _ => None,
        };
        let lens = lens.map(|(message, help)| {
            Incompatibility::remark(Subject::Integrator, message).help(help)
        });
        sky.into_iter().chain(unlit).chain(lens).collect()
    }

    fn replicate_kind(&self) -> ReplicateKind {
        ReplicateKind::Independent
    }

    fn samples_per_pass(&self) -> Option<u32> {
        None
    }

    fn prepare<W: World>(
        &self,
        world: &W,
        placing: &impl Placing,
        pass: &Pass,
        before: Option<Picture>,
    ) -> Picture {
        if let Some(before) = before.filter(|_| self.caustics.photons == 0) {
            return before;
        }
        let packets = packet::packets(world, self.wavelengths / 4);
        let settings = (self.caustics, self.max_depth);
        let caustics = Caustics::shoot(world, placing, pass, &packets, settings);
        Picture::blank(pass, packets, caustics)
    }

    fn sample<W: World, S: Sampler, K: Sink>(
        &self,
        world: &W,
        picture: &Picture,
        site: &PixelSample,
        sampler: &mut S,
        sink: &mut K,
    ) {
        let mut look = || self.pixel(world, picture, site.pixel, sampler);
        let seen = match self.is_random() {
            true => look(),
            false => picture.pixel(site.pixel, look),
        };
        sink.radiance(seen.truncate().to_array(), seen.w);
    }

    /// The film's filter does not place its samples, so the filter's weights are ignored, too.
    fn sample_batch<W: World, S: Sampler, K: TileSink>(
        &self,
        world: &W,
        picture: &Picture,
        jobs: Drain<'_, SampleJob<S>>,
        sink: &mut K,
    ) {
        for mut job in jobs {
            // Pixels around the film are of no use to it.
            if !picture.has(job.site.pixel) {
                continue;
            }
            sink.begin_sample(job.site.pixel, 1.0);
            self.sample(world, picture, &job.site, &mut job.sampler, sink);
        }
    }
}
