//! One weighted lobe with its own frame.

use crate::tilt::Tilt;
use crate::{AnyBxdf, Bxdf};
use etalon_math::{DeltaProbability, Density, Frame};
use etalon_transport::{BsdfSample, SamplePdf, TransportMode};
use glam::{Vec2, Vec3, Vec4};

/// A model in its frame, with its share of the light.
#[derive(Clone, Copy, Debug)]
pub struct Lobe<'a> {
    /// The model.
    pub scatter: AnyBxdf<'a>,
    /// The frame of the model's local directions; `n` is the shading normal.
    pub frame: Frame,
    /// Factor of the model's value.
    pub weight: f32,
    /// The probability with which this lobe is chosen for sampling; the same for all lanes.
    pub probability: f32,
    /// The normal that the model has in this frame, if it is not that of the frame.
    pub tilt: Option<Tilt>,
}

impl Lobe<'_> {
    /// Whether all its continuous directions are on the side of its frame's normal that `wo` is on.
    #[inline]
    pub(crate) fn is_one_sided(&self) -> bool {
        !self.scatter.transmits() && self.tilt.is_none()
    }

    /// Weighted value, and density times the probability of this lobe, for world directions.
    #[inline]
    pub fn eval_and_density(
        &self,
        normal: Vec3,
        wo: Vec3,
        wi: Vec3,
        mode: TransportMode,
    ) -> (Vec4, Vec4) {
        if let Some(tilt) = &self.tilt {
            return self.eval_tilted(tilt, normal, wo, wi, mode);
        }
        let (value, density) =
            self.scatter
                .eval_and_density(self.frame.to_local(wo), self.frame.to_local(wi), mode);
        let factor = match mode {
            TransportMode::Radiance => self.weight,
            TransportMode::Importance => self.weight * adjoint(self.frame.n, normal, wo, wi),
        };
        (value * factor, density * self.probability)
    }

    /// A sampled world direction, as if this lobe were alone but weighted.
    #[inline]
    pub fn sample(
        &self,
        normal: Vec3,
        wo: Vec3,
        u_lobe: f32,
        u: Vec2,
        mode: TransportMode,
    ) -> Option<BsdfSample> {
        if let Some(tilt) = &self.tilt {
            let sample = |wo| self.scatter.sample_by_density(wo, u_lobe, u, mode);
            return self.sample_tilted(tilt, normal, wo, (mode, u.x), sample);
        }
        let mut sample = (self.scatter).sample(self.frame.to_local(wo), u_lobe, u, mode);
        if let Some(sample) = &mut sample {
            self.in_world(normal, wo, mode, sample);
        }
        sample
    }

    /// The same where the direction must follow the density (see [`Bxdf::sample_by_density`]).
    #[inline]
    pub(crate) fn sample_by_density(
        &self,
        normal: Vec3,
        wo: Vec3,
        u_lobe: f32,
        u: Vec2,
        mode: TransportMode,
    ) -> Option<BsdfSample> {
        if !self.scatter.samples_by_walk() || self.tilt.is_some() {
            return self.sample(normal, wo, u_lobe, u, mode);
        }
        let local = self.frame.to_local(wo);
        let mut sample = self.scatter.sample_by_density(local, u_lobe, u, mode)?;
        self.in_world(normal, wo, mode, &mut sample);
        Some(sample)
    }

    /// The discrete direction number `index` of this lobe, weighted.
    pub fn discrete(
        &self,
        normal: Vec3,
        wo: Vec3,
        index: u32,
        mode: TransportMode,
    ) -> Option<BsdfSample> {
        if let Some(tilt) = &self.tilt {
            let discrete = |wo| self.scatter.discrete(wo, index, mode);
            return self.sample_tilted(tilt, normal, wo, (mode, 0.0), discrete);
        }
        let mut sample = (self.scatter).discrete(self.frame.to_local(wo), index, mode);
        if let Some(sample) = &mut sample {
            self.in_world(normal, wo, mode, sample);
        }
        sample
    }

    /// Takes a sample of the model to the world, with this lobe's weight and probability; in place, so that it is not copied.
    #[inline]
    fn in_world(&self, normal: Vec3, wo: Vec3, mode: TransportMode, sample: &mut BsdfSample) {
        sample.wi = self.frame.to_world(sample.wi);
        let factor = match mode {
            TransportMode::Radiance => self.weight,
            TransportMode::Importance => self.weight * adjoint(self.frame.n, normal, wo, sample.wi),
        };
        sample.value *= factor;
        sample.chance = sample.chance.scaled(self.probability);
    }

    /// [`Lobe::eval_and_density`] with a tilted normal. The viewer decides the model's frame; sampling, which knows
    /// `wo` alone, takes that for the viewer.
    #[cold]
    fn eval_tilted(
        &self,
        tilt: &Tilt,
        normal: Vec3,
        wo: Vec3,
        wi: Vec3,
        mode: TransportMode,
    ) -> (Vec4, Vec4) {
        let [o, i] = [wo, wi].map(|w| self.frame.to_local(w));
        let in_frame = |frame: &Frame| {
            (self.scatter).eval_and_density(frame.to_local(o), frame.to_local(i), mode)
        };
        let (view, light) = match mode {
            TransportMode::Radiance => (o, i),
            TransportMode::Importance => (i, o),
        };
        let (seen, sampled) = (tilt.frame(view), tilt.frame(o));
        let (value, mut density) = in_frame(&seen);
        if sampled != seen {
            density = in_frame(&sampled).1;
        }
        let mut factor = self.weight * tilt.shadowing(&seen, light);
        if mode == TransportMode::Importance {
            factor *= adjoint(self.frame.to_world(seen.n), normal, wo, wi);
        }
        (value * factor, density * self.probability)
    }

    /// A direction that `sample` finds for `wo` in the model's frame, with a tilted normal.
    #[cold]
    fn sample_tilted(
        &self,
        tilt: &Tilt,
        normal: Vec3,
        wo: Vec3,
        (mode, coin): (TransportMode, f32),
        sample: impl Fn(Vec3) -> Option<BsdfSample>,
    ) -> Option<BsdfSample> {
        let o = self.frame.to_local(wo);
        let mut sampled = tilt.frame(o);
        let mut local = sample(sampled.to_local(o));
        let mut share = 1.0;
        let is_delta = |sample: &BsdfSample| sample.chance.is_delta();
        if mode == TransportMode::Importance && tilt.flips && local.as_ref().is_none_or(is_delta) {
            // The frame depends on the viewer `wi`: keep the discrete samples that are consistent with their own frame.
            let found = tilt.both().map(|frame| {
                let sample = sample(frame.to_local(o))?;
                let viewer = frame.to_world(sample.wi);
                (is_delta(&sample) && tilt.frame(viewer) == frame).then_some((frame, sample))
            });
            let [first, second] = found;
            share = if first.is_some() && second.is_some() {
                0.5
            } else {
                1.0
            };
            let chosen = if coin < 0.5 {
                first.or(second)
            } else {
                second.or(first)
            };
            (sampled, local) = chosen.map(|(frame, sample)| (frame, Some(sample)))?;
        }
        let local = local?;
        let i = sampled.to_world(local.wi);
        let wi = self.frame.to_world(i);
        Some(match local.chance {
            SamplePdf::Continuous(_) => {
                let (value, density) = self.eval_tilted(tilt, normal, wo, wi, mode);
                BsdfSample {
                    wi,
                    value,
                    chance: SamplePdf::Continuous(Density::per_lane(density)),
                    ..local
                }
            }
            SamplePdf::Discrete(atom) => {
                let light = match mode {
                    TransportMode::Radiance => i,
                    TransportMode::Importance => o,
                };
                let mut factor = self.weight * tilt.shadowing(&sampled, light);
                if mode == TransportMode::Importance {
                    factor *= adjoint(self.frame.to_world(sampled.n), normal, wo, wi);
                }
                BsdfSample {
                    wi,
                    value: local.value * factor,
                    chance: SamplePdf::Discrete(DeltaProbability(
                        atom.0 * (self.probability * share),
                    )),
                    ..local
                }
            }
        })
    }
}

/// The factor by which the shading normal `shading` makes importance scatter differently from radiance,
/// |wo·nₛ| |wi·n_g| / (|wo·n_g| |wi·nₛ|) (Veach 1997, section 5.3, eq. 5.19): exactly 1
/// where the two normals agree, zero where `wo` or `wi` is edge-on to within rounding.
#[inline]
fn adjoint(shading: Vec3, normal: Vec3, wo: Vec3, wi: Vec3) -> f32 {
    let (cos_o, cos_i) = (wo.dot(normal).abs(), wi.dot(shading).abs());
    if cos_o.min(cos_i) > f32::EPSILON {
        (wo.dot(shading) * wi.dot(normal)).abs() / (cos_o * cos_i)
    } else {
        0.0
    }
}
