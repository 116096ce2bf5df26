//! `whitted`: recursive ray tracing (Whitted 1980), without random numbers.
//!
//! ```text
//! L(x, ω) = Lₑ + Σ_lights Σ_points V f |cos θ| E + Σ_directions w · L(next surface)
//! ```
//!
//! Of the integral over all directions two parts are kept: what arrives straight from the lights,
//! every light being asked at fixed points, and what arrives from the few directions that smooth
//! surfaces single out (mirrors, refraction, total reflection), each of which is followed. Light
//! that reaches a surface in any other way is missing, which is what makes this no estimator of the
//! rendering equation; but wherever there is no such light it is exact, with hard shadows.
//!
//! Classic Phong materials ([`LegacyPhong`]) fill the gap with an ambient term:
//!
//! ```text
//! L = (1 − α) (kₐ Lₐ + Σ V E (k_d cos θ + kₛ max(0, cos ρ)ⁿ) + k_g L_mirror) + α L_refracted
//! ```
//!
//! θ is the angle of the light with the normal on the viewer's side, ρ that with the mirrored
//! view (Phong 1975); lights behind the surface count nothing. E is the irradiance of a lamp of
//! intensity I, I/r² or, if light does not fall off, I. Under total reflection L_refracted is
//! L_mirror. Light passes transparent classic surfaces straight on its way from a lamp, dimmed by α
//! at each; other interfaces cast black shadows unless light passes them straight (`mask`, …).
//!
//! Wavelengths are those of a rule for integrals ([`QuadratureNode`]) in strata that paths draw theirs from with equal
//! probability, so every picture is without noise; smooth dispersion sends each its own way. Every pixel is the
//! mean of a grid of points over its square, refined where neighbours differ.
//!
//! [`LegacyPhong`]: etalon_transport::LegacyPhong
//! [`QuadratureNode`]: etalon_spectrum::QuadratureNode

mod light;
mod phong;
mod pixel;
mod tree;

use etalon_params::Params;
use etalon_sampling::Sampler;
use etalon_transport::{
    Incompatibility, Integrator, Pass, PixelSample, Placing, SampleJob, SceneCapabilities, Sink,
    Subject, TileSink, World,
};
use glam::{UVec2, Vec4};
pub use pixel::Grid;
use std::sync::OnceLock;
use tree::Packet;
pub use tree::{Continuation, onward};

/// How the light of lamps without extent fades with distance.
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
    /// How the light of lamps fades.
    pub falloff: Falloff,
    /// The strength of ambient light, which is white.
    pub ambient: f32,
    /// Lights with an extent are asked at the square of this many points.
    pub light_samples: u32,
    /// Number of wavelengths, a multiple of four.
    pub wavelengths: u32,
    /// The points of a pixel.
    pub grid: Grid,
}

/// The most wavelengths.
const MOST_WAVELENGTHS: u32 = 64;

impl Whitted {
    /// Reads `max_depth` (8), `hide_emitters`, `falloff` (`inverse_square`), `ambient` (1),
    /// `light_samples` (1), `wavelengths` (36), `supersampling` (2), `adaptive` (0) and `contrast`
    /// (0.05).
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
        let positive = |x: f64| x >= 0.0 && x.is_finite();
        let number = |name, default| {
            params.float_where(name, default, "a finite number not below 0", positive) as f32
        };
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
            light_samples: count("light_samples", 1, 1..=64),
            wavelengths,
            grid,
        }
    }

    /// A pixel's colour and alpha.
    fn pixel<W: World>(&self, world: &W, packets: &[Packet], pixel: UVec2) -> Vec4 {
        let corner = pixel.as_vec2();
        self.grid
            .mean(corner, |raster| self.through(world, packets, raster))
    }
}

/// The pixels seen so far. Since nothing is random each is looked at once, however many samples and
/// replicates are asked for.
pub struct Picture {
    origin: UVec2,
    width: u32,
    pixels: Vec<OnceLock<Vec4>>,
    packets: Vec<Packet>,
}

impl Picture {
    fn blank(pass: &Pass, packets: Vec<Packet>) -> Self {
        let count = pass.size.x as usize * pass.size.y as usize;
        Self {
            origin: pass.origin,
            width: pass.size.x,
            pixels: core::iter::repeat_with(OnceLock::new).take(count).collect(),
            packets,
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

impl Integrator for Whitted {
    type State = Picture;

    /// It asks all lights, and shows classic materials; a sky has no point to ask.
    fn incompatibilities(&self, sight: &SceneCapabilities) -> Vec<Incompatibility> {
        let message = "`whitted` asks every light at fixed points, and this scene has a sky, which \
                       shines from everywhere";
        let sky = sight
            .sky
            .then(|| Incompatibility::fatal(Subject::Integrator, message));
        let ambient = sight.classic && self.ambient > 0.0;
        let unlit = sight.unlit().filter(|_| !ambient);
        sky.into_iter().chain(unlit).collect()
    }

    fn prepare<W: World>(
        &self,
        world: &W,
        _: &impl Placing,
        pass: &Pass,
        before: Option<Picture>,
    ) -> Picture {
        before.unwrap_or_else(|| {
            let packets = tree::packets(world, self.wavelengths / 4);
            Picture::blank(pass, packets)
        })
    }

    fn sample<W: World, S: Sampler, K: Sink>(
        &self,
        world: &W,
        picture: &Picture,
        site: &PixelSample,
        _: &mut S,
        sink: &mut K,
    ) {
        let seen = picture.pixel(site.pixel, || {
            self.pixel(world, &picture.packets, site.pixel)
        });
        sink.radiance(seen.truncate().to_array(), seen.w);
    }

    /// The film's filter places no sample, so that what it makes them count is left aside, too.
    fn sample_batch<W: World, S: Sampler, K: TileSink>(
        &self,
        world: &W,
        picture: &Picture,
        drafts: &mut [SampleJob<S>],
        sink: &mut K,
    ) {
        for SampleJob { site, sampler, .. } in drafts {
            // Pixels around the film are of no use to it.
            if !picture.has(site.pixel) {
                continue;
            }
            sink.begin_sample(site.pixel, 1.0);
            self.sample(world, picture, site, sampler, sink);
        }
    }
}
