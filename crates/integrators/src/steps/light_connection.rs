//! Next-event estimation: a vertex of a path connected to a point of a light, weighted by multiple importance sampling.

use crate::steps::path_throughput::PathThroughput;
use etalon_math::lane::{Lane, Spectral};
use etalon_math::{Density, SolidAngle};
use etalon_spectrum::Wavelengths;
use etalon_transport::{Bsdf, LightSample, SurfaceInteraction, Transmission, TransportMode, World};
use glam::{Vec3, Vec4};

/// A light sample before its shadow ray is traced.
#[derive(Clone, Copy)]
pub(crate) struct LightConnection {
    /// Unit direction to the light.
    pub(crate) direction: Vec3,
    /// Where on the light, if it is not at infinity.
    pub(crate) target: Option<Vec3>,
    pub(crate) path: UnoccludedPath,
}

/// A path that ends at a light sample, before its shadow ray is traced.
#[derive(Clone, Copy, Debug)]
pub(crate) struct UnoccludedPath<F: Lane = f32> {
    /// The throughput of the whole path, emission included; the transmittance of the shadow ray is not.
    pub(crate) throughput: PathThroughput<F>,
    /// pₜ,ₖ / p₀ of finding the same path by scattering, without the probability of passing null surfaces on the way.
    pdf_by_scattering: F::Spectrum,
}

impl<F: Lane> UnoccludedPath<F> {
    /// The path `before` to a vertex, extended to a light sample with this probability, or density if it is not `is_delta`.
    /// `contribution` is the BSDF's value times the light's radiance, and `scattered` the density of scattering toward the light
    /// times pₖ / p₀ of a path that is scattered here. `lights` samples of lights compete with `scattering` samples of the BSDF.
    #[inline]
    pub(crate) fn new(
        before: &PathThroughput<F>,
        contribution: F::Spectrum,
        (chance, is_delta): (F::Spectrum, F::Mask),
        scattered: F::Spectrum,
        [lights, scattering]: [f32; 2],
    ) -> Self {
        let mut throughput = *before;
        throughput.scatter(contribution, chance);
        throughput.r_u = throughput.r_u * F::splat(lights);
        // Scattering never finds a discrete light.
        let never = F::Spectrum::uniform(F::ZERO);
        let found = scattered * (F::splat(scattering) / chance.hero());
        Self {
            throughput,
            pdf_by_scattering: F::Spectrum::choose(is_delta, never, found),
        }
    }

    /// The contribution of the path if nothing is in the way.
    #[inline]
    pub(crate) fn unoccluded(&self) -> F::Spectrum {
        (self.throughput).contribution(F::Spectrum::uniform(F::ONE), self.pdf_by_scattering)
    }

    /// `yes` in the lanes where `mask` says yes, `no` in the others.
    #[inline(always)]
    pub(crate) fn choose(mask: F::Mask, yes: Self, no: Self) -> Self {
        let choose = |yes, no| F::Spectrum::choose(mask, yes, no);
        Self {
            throughput: PathThroughput {
                beta: choose(yes.throughput.beta, no.throughput.beta),
                r_u: choose(yes.throughput.r_u, no.throughput.r_u),
            },
            pdf_by_scattering: choose(yes.pdf_by_scattering, no.pdf_by_scattering),
        }
    }

    /// The path in any lane.
    #[inline(always)]
    pub(crate) fn lanes(self) -> impl Fn(usize) -> UnoccludedPath {
        let throughput = self.throughput.lanes();
        let by_scattering = F::Spectrum::pairs([self.pdf_by_scattering; 2]);
        move |i| {
            let [pdf_by_scattering, _] = by_scattering(i);
            UnoccludedPath {
                throughput: throughput(i),
                pdf_by_scattering,
            }
        }
    }
}

impl UnoccludedPath {
    /// The contribution of the path where the shadow ray has this transmittance.
    #[inline]
    pub(crate) fn estimate(&self, transmission: &Transmission) -> Vec4 {
        let by_scattering = self.pdf_by_scattering * transmission.probability;
        (self.throughput).contribution(transmission.transmittance, by_scattering)
    }
}

impl LightConnection {
    /// The path `before` to a vertex, extended to `light`; `None` if it brings nothing. `lights` samples of
    /// lights compete with `scattering` samples of `bsdf`.
    #[inline]
    pub(crate) fn new(
        light: &LightSample,
        before: &PathThroughput,
        bsdf: &impl Bsdf,
        wo: Vec3,
        [lights, scattering]: [f32; 2],
    ) -> Option<Self> {
        let (value, density) = bsdf.eval_and_density(wo, light.direction, TransportMode::Radiance);
        let contribution = value * light.radiance;
        if contribution == Vec4::ZERO {
            return None;
        }
        Some(Self::of(
            light,
            before,
            before.r_u,
            contribution,
            density,
            [lights, scattering],
        ))
    }

    /// The same where the BSDF's value times the light's radiance (`contribution`) and its density are known; `scattered` is
    /// pₖ / p₀ of a path that is scattered here.
    #[inline]
    pub(crate) fn of(
        light: &LightSample,
        before: &PathThroughput,
        scattered: Vec4,
        contribution: Vec4,
        density: Density<SolidAngle>,
        competing: [f32; 2],
    ) -> Self {
        Self {
            direction: light.direction,
            target: light.target,
            path: UnoccludedPath::new(
                before,
                contribution,
                (light.chance.lanes(), light.chance.is_delta()),
                scattered * density.lanes() * light.extinction,
                competing,
            ),
        }
    }

    /// Traces the shadow ray from `vertex`, past at most `crossings` null surfaces: the contribution of the path.
    #[inline]
    pub(crate) fn traced<W: World>(
        &self,
        world: &W,
        vertex: &SurfaceInteraction,
        wavelengths: &Wavelengths,
        crossings: u32,
    ) -> Vec4 {
        (vertex.shadow_ray(self.direction, self.target))
            .and_then(|ray| world.transmittance(&ray, wavelengths, crossings))
            .map_or(Vec4::ZERO, |transmission| self.path.estimate(&transmission))
    }
}
