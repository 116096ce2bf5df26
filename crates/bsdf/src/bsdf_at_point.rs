//! A material at one point: at most [`MAX_LOBES`] lobes, and light that passes straight on.

use crate::{AnyBxdf, Bxdf, Lobe};
use etalon_math::float::ONE_MINUS_EPSILON;
use etalon_math::{DeltaProbability, Density, Frame, SolidAngle};
use etalon_transport::{Bsdf, BsdfSample, SamplePdf, TransportMode};
use glam::{Vec2, Vec3, Vec4};

/// The most lobes a material may flatten into; a scene that needs more is refused when it loads.
pub const MAX_LOBES: usize = 4;

/// A material resolved at a point, for a known `wo` and four wavelengths.
#[derive(Clone, Copy, Debug)]
pub struct BsdfAtPoint<'a> {
    /// Unit geometric normal, for the adjoint of shading normals.
    normal: Vec3,
    /// The fraction of light that goes straight on.
    null: Vec4,
    /// The probability with which sampling goes straight on.
    null_probability: f32,
    lobes: Lobes<'a>,
}

/// The lobes; nearly every material has one.
#[derive(Clone, Copy, Debug)]
#[allow(clippy::large_enum_variant)] // Copied by value in the hot path: a box would allocate.
enum Lobes<'a> {
    None,
    One(Lobe<'a>),
    Many {
        list: [Lobe<'a>; MAX_LOBES],
        count: usize,
    },
}

impl<'a> BsdfAtPoint<'a> {
    /// A single lobe that has all the light.
    #[inline]
    pub(crate) fn one(normal: Vec3, lobe: Lobe<'a>) -> Self {
        Self {
            normal,
            null: Vec4::ZERO,
            null_probability: 0.0,
            lobes: Lobes::One(lobe),
        }
    }

    /// Several weighted lobes and passing light.
    pub(crate) fn several(
        normal: Vec3,
        null_transmittance: Vec4,
        null_probability: f32,
        lobes: &[Lobe<'a>],
    ) -> Self {
        let lobes = match *lobes {
            [] => Lobes::None,
            [one] => Lobes::One(one),
            [first, ..] => {
                let count = lobes.len().min(MAX_LOBES);
                let mut list = [first; MAX_LOBES];
                list[..count].copy_from_slice(&lobes[..count]);
                Lobes::Many { list, count }
            }
        };
        Self {
            normal,
            null: null_transmittance,
            null_probability,
            lobes,
        }
    }

    /// Light passes as if nothing were there.
    pub fn passing(normal: Vec3) -> Self {
        Self::several(normal, Vec4::ONE, 1.0, &[])
    }

    /// The index inside over that outside, per lane, if this is nothing but an interface of dielectrics.
    pub fn relative_index(&self) -> Option<Vec4> {
        match &self.lobes {
            Lobes::One(lobe) => match &lobe.scatter {
                AnyBxdf::Dielectric(smooth) => Some(smooth.eta),
                AnyBxdf::RoughDielectric(rough) => Some(rough.eta),
                _ => None,
            },
            _ => None,
        }
    }

    /// The same between other dielectrics, if it is such an interface.
    pub fn with_relative_index(mut self, eta: Vec4) -> Self {
        if let Lobes::One(lobe) = &mut self.lobes {
            match &mut lobe.scatter {
                // Nothing is mirrored, and light goes straight on.
                AnyBxdf::Dielectric(smooth) if eta == Vec4::ONE && smooth.mirrored == 0.0 => {
                    return Self::several(self.normal, smooth.transmittance, 1.0, &[]);
                }
                AnyBxdf::Dielectric(smooth) => smooth.eta = eta,
                AnyBxdf::RoughDielectric(rough) => rough.eta = eta,
                _ => {}
            }
        }
        self
    }

    /// The lobes.
    #[inline]
    pub fn lobes(&self) -> &[Lobe<'a>] {
        match &self.lobes {
            Lobes::None => &[],
            Lobes::One(lobe) => core::slice::from_ref(lobe),
            Lobes::Many { list, count } => &list[..*count],
        }
    }

    /// [`Bsdf::hemisphere`] of several lobes.
    #[inline(never)]
    fn hemisphere_of_many(&self) -> Option<Frame> {
        let mut continuous = self.lobes().iter().filter(|l| l.scatter.has_continuous());
        let first = continuous.next()?;
        let same = |lobe: &Lobe<'_>| {
            let turned = lobe.frame.n != first.frame.n && lobe.frame.n != -first.frame.n;
            !turned && lobe.is_one_sided()
        };
        (same(first) && continuous.all(same)).then_some(first.frame)
    }

    fn pass(&self, wo: Vec3) -> BsdfSample {
        BsdfSample {
            wi: -wo,
            value: self.null,
            chance: SamplePdf::Discrete(DeltaProbability::uniform(self.null_probability)),
            eta: 1.0,
            is_null: true,
        }
    }

    /// Chooses among several lobes. A continuous direction gets the value and density of all
    /// of them together.
    #[inline(never)]
    fn sample_many(
        &self,
        wo: Vec3,
        mut u_lobe: f32,
        u: Vec2,
        mode: TransportMode,
    ) -> Option<BsdfSample> {
        let lobes = self.lobes();
        let mut chosen = None;
        for (index, lobe) in lobes
            .iter()
            .enumerate()
            .filter(|(_, l)| l.probability > 0.0)
        {
            chosen = Some((index, (u_lobe / lobe.probability).min(ONE_MINUS_EPSILON)));
            if u_lobe < lobe.probability {
                break;
            }
            u_lobe -= lobe.probability;
        }
        let (index, u_inner) = chosen?;
        let mut sample = lobes[index].sample_by_density(self.normal, wo, u_inner, u, mode)?;
        if let SamplePdf::Continuous(density) = sample.chance {
            let mut lanes = density.lanes();
            for (_, other) in lobes.iter().enumerate().filter(|(i, _)| *i != index) {
                let (value, density) = other.eval_and_density(self.normal, wo, sample.wi, mode);
                sample.value += value;
                lanes += density;
            }
            sample.chance = SamplePdf::Continuous(Density::per_lane(lanes));
        }
        Some(sample)
    }
}

impl Bsdf for BsdfAtPoint<'_> {
    #[inline]
    fn eval(&self, wo: Vec3, wi: Vec3, mode: TransportMode) -> Vec4 {
        self.eval_and_density(wo, wi, mode).0
    }

    #[inline]
    fn density(&self, wo: Vec3, wi: Vec3) -> Density<SolidAngle> {
        self.eval_and_density(wo, wi, TransportMode::Radiance).1
    }

    #[inline]
    fn eval_and_density(
        &self,
        wo: Vec3,
        wi: Vec3,
        mode: TransportMode,
    ) -> (Vec4, Density<SolidAngle>) {
        let (value, density) = match &self.lobes {
            Lobes::One(lobe) => lobe.eval_and_density(self.normal, wo, wi, mode),
            Lobes::None => (Vec4::ZERO, Vec4::ZERO),
            Lobes::Many { list, count } => {
                list[..*count]
                    .iter()
                    .fold((Vec4::ZERO, Vec4::ZERO), |(value, density), lobe| {
                        let (v, d) = lobe.eval_and_density(self.normal, wo, wi, mode);
                        (value + v, density + d)
                    })
            }
        };
        (value, Density::per_lane(density))
    }

    #[inline]
    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2, mode: TransportMode) -> Option<BsdfSample> {
        let mut u_lobe = u_lobe;
        if self.null_probability > 0.0 {
            if u_lobe < self.null_probability {
                return Some(self.pass(wo));
            }
            u_lobe -= self.null_probability;
        }
        match &self.lobes {
            Lobes::One(lobe) => {
                let u_inner = if lobe.probability == 1.0 {
                    u_lobe
                } else {
                    (u_lobe / lobe.probability).min(ONE_MINUS_EPSILON)
                };
                lobe.sample(self.normal, wo, u_inner, u, mode)
            }
            Lobes::None => None,
            Lobes::Many { .. } => self.sample_many(wo, u_lobe, u, mode),
        }
    }

    fn discrete(&self, wo: Vec3, index: u32, mode: TransportMode) -> Option<BsdfSample> {
        let mut index = index;
        if self.null_probability > 0.0 {
            if index == 0 {
                return Some(self.pass(wo));
            }
            index -= 1;
        }
        for lobe in self.lobes() {
            let mut of_lobe = 0;
            while let Some(found) = lobe.discrete(self.normal, wo, of_lobe, mode) {
                if index == 0 {
                    return Some(found);
                }
                index -= 1;
                of_lobe += 1;
            }
        }
        None
    }

    #[inline]
    fn has_continuous(&self) -> bool {
        self.lobes().iter().any(|l| l.scatter.has_continuous())
    }

    fn has_discrete(&self) -> bool {
        self.lobes().iter().any(|l| l.scatter.has_discrete())
    }

    #[inline(always)] // Small without the rare case, and its answer is large.
    fn hemisphere(&self) -> Option<Frame> {
        match &self.lobes {
            Lobes::One(lobe) => {
                (lobe.scatter.has_continuous() && lobe.is_one_sided()).then_some(lobe.frame)
            }
            Lobes::None => None,
            Lobes::Many { .. } => self.hemisphere_of_many(),
        }
    }

    #[inline]
    fn null_transmittance(&self) -> Vec4 {
        self.null
    }

    #[inline]
    fn null_probability(&self) -> Vec4 {
        Vec4::splat(self.null_probability)
    }

    /// The mean over the lobes; what passes does not count.
    fn albedo(&self, wo: Vec3) -> Vec4 {
        let (sum, weight) = self
            .lobes()
            .iter()
            .fold((Vec4::ZERO, 0.0), |(sum, weight), lobe| {
                let albedo = lobe.scatter.albedo(lobe.frame.to_local(wo));
                (sum + albedo * lobe.weight, weight + lobe.weight)
            });
        if weight > 0.0 { sum / weight } else { sum }
    }

    #[inline]
    fn projected_area(&self, _: Vec3) -> f32 {
        1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The size that a path copies at every vertex. Larger models keep their tables in their descriptions.
    #[test]
    fn a_material_at_a_point_stays_within_its_budget() {
        let sizes = [
            size_of::<crate::AnyBxdf>(),
            size_of::<Lobe>(),
            size_of::<BsdfAtPoint>(),
        ];
        let budget = [112, 176, 752];
        assert!(
            sizes.iter().zip(budget).all(|(size, most)| *size <= most),
            "{sizes:?}"
        );
    }
}
