//! `heterogeneous`: a medium whose density and albedo vary in space,
//!
//! ```text
//! σs(x) = α(x) σt(x),   σa(x) = (1 − α(x)) σt(x)        (m⁻¹, times `scale`)
//! ```
//!
//! and emits σa Lₑ(x) per metre (`emission`). `sigma_t`, `albedo` and `emission` are textures that have values in space: a
//! grid, a pattern, a product of such. A medium ends where the grid of its `sigma_t` ends, even inside its shape. A
//! `homogeneous` medium whose albedo or emission varies is one of these with a constant `sigma_t`.

use crate::ProfileAt;
use crate::majorants::{MajorantGrid, Segments};
use crate::phases::{PhaseAt, PhaseFunction};
use crate::tracking::{Tracked, Tracking};
use crate::volume;
use etalon_params::Params;
use etalon_transport::{
    Build, Coefficients, Phase, Ray, SpectrumKind, SurfaceInteraction, TextureId, TexturePoint,
    Textures, is_varying, refuse_varying,
};
use glam::{Vec3, Vec4};

/// A medium that varies in space.
#[derive(Clone, Debug, PartialEq)]
pub struct Heterogeneous {
    albedo: TextureId,
    sigma_t: TextureId,
    scale: f32,
    phase: PhaseFunction,
    emission: Option<TextureId>,
    tracking: Tracking,
    /// Bounds and majorants, once the scene is built.
    majorants: Option<Box<MajorantGrid>>,
    /// The largest extinction where there is no grid (m⁻¹).
    most: f32,
    /// Whether no light enters it through null surfaces.
    pub(crate) is_dark: bool,
}

/// The same at the wavelengths of a path.
#[derive(Debug)]
pub struct HeterogeneousAt<'a, T> {
    medium: &'a Heterogeneous,
    textures: &'a T,
    lambda: Vec4,
}

impl<T> Clone for HeterogeneousAt<'_, T> {
    #[inline]
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for HeterogeneousAt<'_, T> {}

impl Heterogeneous {
    /// Reads `albedo`, `sigma_t`, `scale` and the phase function.
    pub(crate) fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let what = "a finite number not below 0";
        let scale = params.float_where("scale", 1.0, what, |s| s >= 0.0 && s.is_finite());
        Some(Self {
            albedo: build.volume(params, "albedo", Some(0.75), SpectrumKind::Reflectance),
            sigma_t: build.volume(params, "sigma_t", Some(1.0), SpectrumKind::Unbounded),
            scale: scale as f32,
            phase: PhaseFunction::of_medium(params, build)?,
            emission: volume::emission(params, build),
            tracking: volume::tracking(params, Tracking::Ratio),
            majorants: None,
            most: 0.0,
            is_dark: false,
        })
    }

    /// Reads a `homogeneous` medium whose `albedo` or `emission` varies in space; `None` if this is none.
    pub(crate) fn of_even_extinction(
        params: &Params<'_>,
        build: &mut dyn Build,
    ) -> Option<Option<Self>> {
        let varies = ["albedo", "emission"]
            .iter()
            .any(|name| is_varying(params, name, build));
        let by_others = ["material", "sigma_a", "sigma_s"]
            .iter()
            .any(|name| params.has(name));
        if params.node.plugin.value != "homogeneous" || !varies || by_others {
            return None;
        }
        refuse_varying(params, "sigma_t", build);
        Some(Self::from_params(params, build))
    }

    /// Whether it emits light.
    pub fn emits(&self) -> bool {
        self.emission.is_some()
    }

    /// The corners of the box that holds all of it, once it is ready.
    pub fn bounds(&self) -> Option<[Vec3; 2]> {
        self.majorants.as_ref().map(|grid| grid.bounds())
    }

    /// The most that a flake shows, of a phase function of flakes; `most` knows the largest number of a texture. 1 of any other.
    pub fn largest_area(&self, most: impl Fn(TextureId) -> f32) -> f32 {
        match &self.phase {
            PhaseFunction::Sggx(flakes) => flakes.largest_area(most),
            _ => 1.0,
        }
    }

    /// The texture of its density, in units of `scale`.
    pub fn density(&self) -> TextureId {
        self.sigma_t
    }

    /// Makes it ready: `bounds` are the corners of the box that holds all of it, if it has an end, `along` cells along its
    /// longest side may differ, and `most` and `least` know bounds of the density in a box;
    /// `largest_area` is that of [`Heterogeneous::largest_area`]. Whether there is a finite bound.
    pub fn prepare(
        &mut self,
        bounds: Option<[Vec3; 2]>,
        along: u32,
        largest_area: f32,
        most: impl Fn(Vec3, Vec3) -> f32,
        least: impl Fn(Vec3, Vec3) -> f32,
    ) -> bool {
        // A little more, so that rounding does not matter.
        let densest = self.scale * largest_area * 1.0001;
        let most = |low: Vec3, high: Vec3| {
            let bound = most(low, high) * densest;
            // Below zero there is nothing.
            if bound < 0.0 { 0.0 } else { bound }
        };
        // Flakes may show nothing of themselves.
        let is_even = !matches!(self.phase, PhaseFunction::Sggx(_));
        let least = |low: Vec3, high: Vec3| if is_even { least(low, high) } else { 0.0 };
        self.majorants = match bounds {
            // Nothing is where the box is empty.
            Some([low, high]) if !low.cmplt(high).all() => {
                let tiny = Vec3::splat(f32::MIN_POSITIVE);
                Some(Box::new(MajorantGrid::new(low, low + tiny, 1, |_, _| 0.0)))
            }
            Some([low, high]) => {
                let grid = MajorantGrid::new(low, high, along, most);
                Some(Box::new(match self.tracking {
                    Tracking::Residual => {
                        grid.with_controls(|low, high| least(low, high) * self.scale * 0.9999)
                    }
                    _ => grid,
                }))
            }
            None => {
                self.most = most(Vec3::NEG_INFINITY, Vec3::INFINITY);
                None
            }
        };
        let largest = self
            .majorants
            .as_ref()
            .map_or(self.most, |grid| grid.largest());
        largest.is_finite()
    }

    /// The medium at four wavelengths (nm). It does not vary over its surface.
    #[inline]
    pub fn enter<'a, T: Textures>(
        &'a self,
        _: Option<TexturePoint>,
        textures: &'a T,
        lambda: Vec4,
    ) -> HeterogeneousAt<'a, T> {
        HeterogeneousAt {
            medium: self,
            textures,
            lambda,
        }
    }
}

impl<'a, T> HeterogeneousAt<'a, T> {
    #[inline]
    pub(crate) fn is_dark(&self) -> bool {
        self.medium.is_dark
    }

    /// None: profiles are those of homogeneous media.
    pub(crate) fn diffusion(&self, _: &SurfaceInteraction) -> Option<ProfileAt<'a>> {
        None
    }
}

impl<'a, T: Textures> Tracked for HeterogeneousAt<'a, T> {
    type Phase = PhaseAt<'a, T>;

    #[inline]
    fn coefficients(&self, at: Vec3, direction: Vec3) -> Coefficients {
        let place = TexturePoint::in_space(at);
        let density = self
            .textures
            .spectrum(self.medium.sigma_t, &place, self.lambda);
        let area = self.phase(at).projected_area(direction);
        let extinction = density.max(Vec4::ZERO) * (self.medium.scale * area);
        let albedo = self
            .textures
            .spectrum(self.medium.albedo, &place, self.lambda);
        let scattering = extinction * albedo;
        Coefficients {
            absorption: (extinction - scattering).max(Vec4::ZERO),
            scattering,
        }
    }

    #[inline]
    fn emission(&self, at: Vec3, direction: Vec3) -> Vec4 {
        let Some(emission) = self.medium.emission else {
            return Vec4::ZERO;
        };
        let place = TexturePoint::in_space(at);
        let radiance = self.textures.spectrum(emission, &place, self.lambda);
        self.coefficients(at, direction).absorption * radiance
    }

    #[inline]
    fn phase(&self, at: Vec3) -> PhaseAt<'a, T> {
        self.medium.phase.at(self.textures, at, self.lambda)
    }

    #[inline]
    fn majorants(&self, ray: &Ray, t_max: f32) -> Segments<'_> {
        match &self.medium.majorants {
            Some(grid) => Segments::through(grid, ray, t_max),
            None => Segments::constant(self.medium.most, 0.0),
        }
    }

    #[inline]
    fn tracking(&self) -> Tracking {
        self.medium.tracking
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Isotropic;
    use crate::tracking;
    use etalon_math::float;
    use etalon_math::lane::{Lane, Spectral};
    use etalon_sampling::{Independent, Sampler};

    /// A density that grows along x, up to `top` of each lane at x = 1.
    struct Ramp {
        top: Vec4,
    }

    impl Textures for Ramp {
        fn spectrum(&self, texture: TextureId, at: &TexturePoint, _: Vec4) -> Vec4 {
            match texture {
                TextureId(0) => self.top * at.position.x.clamp(0.0, 1.0),
                _ => Vec4::splat(0.5),
            }
        }

        fn spectra<F: Lane>(
            &self,
            texture: impl Fn(usize) -> TextureId,
            at: impl Fn(usize) -> TexturePoint,
            lambda: impl Fn(usize) -> Vec4,
        ) -> F::Spectrum {
            F::Spectrum::of_lanes(|i| self.spectrum(texture(i), &at(i), lambda(i)))
        }

        fn number(&self, _: TextureId, _: &TexturePoint) -> f32 {
            0.5
        }

        fn colour(&self, _: TextureId, _: &TexturePoint) -> Vec3 {
            Vec3::splat(0.5)
        }

        fn mean(&self, _: TextureId) -> f32 {
            0.5
        }

        fn is_constant(&self, _: TextureId) -> bool {
            false
        }
    }

    fn ramp(ramp: &Ramp, along: u32, tracking: Tracking) -> Heterogeneous {
        let mut medium = Heterogeneous {
            albedo: TextureId(1),
            sigma_t: TextureId(0),
            scale: 2.0,
            phase: PhaseFunction::Isotropic(Isotropic),
            emission: None,
            tracking,
            is_dark: false,
            majorants: None,
            most: 0.0,
        };
        let top = ramp.top.max_element();
        let most = |_: Vec3, high: Vec3| top * high.x;
        // Any control will do, not only one below the density of every lane.
        let least = |low: Vec3, _: Vec3| 0.5 * ramp.top.x * low.x;
        assert!(medium.prepare(Some([Vec3::ZERO, Vec3::ONE]), along, 1.0, most, least));
        medium
    }

    /// Flights and estimates of transmittance through the ramp have the means of the Beer–Lambert law in every lane, for any
    /// choosing lane, majorant grid and tracking (|z| < 4.5, α = 10⁻⁵ each; ray marching is exact on a ramp). A mutant with half
    /// the majorant is off by 20 standard errors, one without the control's closed form by more.
    #[test]
    fn light_is_attenuated_by_the_optical_depth() {
        let world = Ramp {
            top: Vec4::new(1.5, 0.5, 2.5, 0.0),
        };
        // From x = 0.2 to 1 and out of the box: ∫ 2 σ dx = σ (1 − 0.04), along a ray at an angle.
        let direction = Vec3::new(0.8, 0.6, 0.0);
        let depth = world.top * 0.96 / 0.8;
        let expected = depth.to_array().map(|depth| float::exp(-depth));
        let trackings = [
            Tracking::Ratio,
            Tracking::Delta,
            Tracking::Residual,
            Tracking::RayMarching(0.3),
        ];
        for (along, tracking) in trackings.into_iter().flat_map(|t| [(1, t), (40, t)]) {
            let medium = ramp(&world, along, tracking);
            let medium = medium.enter(None, &world, Vec4::ZERO);
            let ray = Ray::new(Vec3::new(0.2, 0.1, 0.5), direction, 0.0);
            let mut stream = Independent::from_key(u64::from(along));
            let count = 40_000;
            let mut sums = [[0.0_f64; 2]; 8];
            for _ in 0..count {
                let u = stream.next_1d();
                let flight = tracking::free_flight(&medium, &ray, 5.0, u, &mut stream);
                let passed = match flight.scattering {
                    None => flight.factor / flight.passed.x,
                    Some(collision) => {
                        assert!(collision.t > 0.0 && collision.t < 1.0 / 0.8 + 1e-4);
                        Vec4::ZERO
                    }
                };
                let estimate =
                    tracking::transmittance(&medium, &ray, 5.0, &mut stream).transmittance;
                let both = passed.to_array().into_iter().chain(estimate.to_array());
                for (sum, value) in sums.iter_mut().zip(both) {
                    sum[0] += f64::from(value);
                    sum[1] += f64::from(value).powi(2);
                }
            }
            for (index, [sum, squares]) in sums.into_iter().enumerate() {
                let mean = sum / f64::from(count);
                let variance = squares / f64::from(count) - mean * mean;
                let error = (variance / f64::from(count)).sqrt();
                let off = (mean - f64::from(expected[index % 4])).abs();
                assert!(
                    off <= 4.5 * error + 1e-6,
                    "{tracking:?}, {along}, {index}: {mean} ± {error}"
                );
            }
        }
    }
}
