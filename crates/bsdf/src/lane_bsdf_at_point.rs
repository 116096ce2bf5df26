//! Materials of one kind at several points, in vector lanes.

use crate::texture_site::Place;
use crate::{LaneModel, Material, TextureSite};
use arrayvec::ArrayVec;
use core::f32::consts::PI;
use etalon_math::lane::{Lane, LaneFrame, MOST_LANES, Mask, Spectral, Vector};
use etalon_transport::{LaneBsdf, LaneBsdfSample, LaneKind, LaneVertices, TextureId, Textures};

/// A model of scattering in lanes, in its own frame: z is the normal. Light is followed from the camera.
pub(crate) trait LaneBxdf<F: Lane> {
    /// Whether it scatters into a continuum of directions.
    const CONTINUOUS: bool;
    /// Whether light may pass to the other side.
    const TRANSMITS: bool;

    /// f·|cos θi| and the density (sr⁻¹) of `wi`, per wavelength.
    fn eval_lanes(&self, wo: F::Vector, wi: F::Vector) -> (F::Spectrum, F::Spectrum);

    /// Samples a direction.
    fn sample_lanes(&self, wo: F::Vector, u_lobe: F, u: [F; 2]) -> LaneBsdfSample<F>;

    /// See [`Bxdf::albedo`](crate::bxdf::Bxdf::albedo).
    fn albedo_lanes(&self, wo: F::Vector) -> F::Spectrum;
}

/// π times the value toward the normal: what a diffuse surface that looks the same from there reflects.
#[inline(always)]
pub(crate) fn albedo_toward_normal<F: Lane>(
    model: &impl LaneBxdf<F>,
    wo: F::Vector,
) -> F::Spectrum {
    let normal = F::Vector::from_xyz(F::ZERO, F::ZERO, F::ONE);
    model.eval_lanes(wo, normal).0 * F::splat(PI)
}

/// The spectrum of a texture that each description names, at its point.
#[inline(always)]
pub(crate) fn spectra<'m, 's, F: Lane, D: 'm, T: Textures + 's>(
    at: &impl Fn(usize) -> (&'m D, &'s TextureSite<'s, T>),
    texture: impl Fn(&D) -> TextureId,
) -> F::Spectrum {
    let site = |i: usize| at(i).1;
    site(0)
        .textures
        .spectra::<F>(|i| texture(at(i).0), |i| site(i).at(), |i| site(i).lambda)
}

/// The value and the density of directions into which nothing is scattered.
#[inline(always)]
pub(crate) fn nothing<F: Lane>() -> (F::Spectrum, F::Spectrum) {
    let zero = F::Spectrum::uniform(F::ZERO);
    (zero, zero)
}

/// Materials of one kind, each at its point.
#[derive(Clone, Copy, Debug)]
pub struct LaneBsdfAtPoint<'a, F: Lane> {
    frame: LaneFrame<F>,
    model: LaneModel<'a, F>,
}

impl<'a, F: Lane> LaneBsdfAtPoint<'a, F> {
    /// The material `material(i)`, of this kind, at vertex i.
    #[inline]
    pub fn new<T: Textures>(
        kind: LaneKind,
        material: impl Fn(usize) -> &'a Material,
        textures: &T,
        LaneVertices {
            surface,
            texture_point,
            wavelengths,
        }: LaneVertices<'_, F>,
        wo: F::Vector,
    ) -> Self {
        let material = F::array(material);
        let material = material.as_ref();
        let mut frame = surface.shading;
        // The back of a surface with two sides has the mirror image of its frame. A direction in the surface itself is on either
        // side, where nothing is scattered.
        let back = F::Mask::from_fn(|i| material[i].has_two_sides())
            & !frame.n.dot_product(wo).gt(F::ZERO);
        frame.n = F::Vector::choose(back, -frame.n, frame.n);
        let sites: ArrayVec<_, MOST_LANES> = (0..F::WIDTH)
            .map(|i| TextureSite::new(textures, Place::Lane(texture_point, i), &wavelengths[i]))
            .collect();
        let model = LaneModel::new(kind, |i| (material[i].lane_side(back.lane(i)), &sites[i]));
        Self { frame, model }
    }
}

impl<F: Lane> LaneBsdf<F> for LaneBsdfAtPoint<'_, F> {
    #[inline]
    fn hemisphere(&self, wo: F::Vector) -> Option<F::Vector> {
        let n = self.frame.n;
        let below = n.dot_product(wo).lt(F::ZERO);
        let is_one_sided = self.model.has_continuous() && !self.model.transmits();
        is_one_sided.then(|| F::Vector::choose(below, -n, n))
    }

    #[inline]
    fn has_continuous(&self) -> bool {
        self.model.has_continuous()
    }

    #[inline]
    fn eval_and_density(&self, wo: F::Vector, wi: F::Vector) -> (F::Spectrum, F::Spectrum) {
        let [wo, wi] = [wo, wi].map(|w| self.frame.to_local(w));
        self.model.eval_and_density(wo, wi)
    }

    #[inline]
    fn sample(&self, wo: F::Vector, u_lobe: F, u: [F; 2]) -> LaneBsdfSample<F> {
        let mut sample = self.model.sample(self.frame.to_local(wo), u_lobe, u);
        sample.wi = self.frame.to_world(sample.wi);
        sample
    }

    #[inline]
    fn albedo(&self, wo: F::Vector) -> F::Spectrum {
        self.model.albedo(self.frame.to_local(wo))
    }
}
