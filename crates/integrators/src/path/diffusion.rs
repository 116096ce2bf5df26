//! A path below a surface with a diffusion profile: it leaves elsewhere.
//!
//! The point where it leaves is looked for along a line through a disk about the point where it came in. Distances on the disk are chosen
//! by the profile, and the disk faces the normal or either of two tangents, so that what a bent surface hides from one is seen from
//! another; all three are combined by multiple importance sampling, over the four wavelengths too (A. King, C. Kulla, A. Conty,
//! M. Fajardo, BSSRDF importance sampling, 2013).

use crate::path::hooks::PathHooks;
use crate::path::state::{PathState, ScatteringPoint, Step};
use crate::steps::settings::PathConfig;
use core::f32::consts::TAU;
use etalon_math::{Density, Frame, SolidAngle, float};
use etalon_sampling::Sampler;
use etalon_sampling::warps::square_to_cosine_hemisphere;
use etalon_transport::{
    Bsdf, BsdfSample, DiffusionProfile, Exit, Medium, MediumId, Ray, SamplePdf, SurfaceInteraction,
    Surfaces, TransportMode, World,
};
use glam::{Vec2, Vec3, Vec4};

/// The probabilities of the disk that faces the normal, and of either other.
const FACING: [f32; 3] = [0.5, 0.25, 0.25];

/// The most surfaces along a line.
const MOST_CROSSINGS: u32 = 64;

/// The surface where light leaves: diffuse, but for what the boundary reflects.
struct Leaving<'a, P> {
    profile: &'a P,
    /// Outside.
    frame: Frame,
    /// Geometric, outside.
    normal: Vec3,
}

impl<P: DiffusionProfile> Bsdf for Leaving<'_, P> {
    fn eval(&self, _: Vec3, wi: Vec3, _: TransportMode) -> Vec4 {
        let cos = self.frame.n.dot(wi);
        if !(cos > 0.0 && self.normal.dot(wi) > 0.0) {
            return Vec4::ZERO;
        }
        Vec4::splat(self.profile.leaving(cos) * cos)
    }

    fn density(&self, _: Vec3, wi: Vec3) -> Density<SolidAngle> {
        Density::uniform(self.frame.n.dot(wi).max(0.0) / core::f32::consts::PI)
    }

    fn sample(&self, wo: Vec3, _: f32, u: Vec2, mode: TransportMode) -> Option<BsdfSample> {
        let wi = self.frame.to_world(square_to_cosine_hemisphere(u));
        let value = self.eval(wo, wi, mode);
        (value != Vec4::ZERO).then(|| BsdfSample {
            wi,
            value,
            chance: SamplePdf::Continuous(self.density(wo, wi)),
            eta: 1.0,
            is_null: false,
        })
    }

    fn has_continuous(&self) -> bool {
        true
    }

    fn hemisphere(&self) -> Option<Frame> {
        Some(self.frame)
    }

    fn null_transmittance(&self) -> Vec4 {
        Vec4::ZERO
    }

    fn null_probability(&self) -> Vec4 {
        Vec4::ZERO
    }

    fn albedo(&self, _: Vec3) -> Vec4 {
        Vec4::ONE
    }

    fn eval_and_density(
        &self,
        wo: Vec3,
        wi: Vec3,
        mode: TransportMode,
    ) -> (Vec4, Density<SolidAngle>) {
        (self.eval(wo, wi, mode), self.density(wo, wi))
    }

    fn discrete(&self, _: Vec3, _: u32, _: TransportMode) -> Option<BsdfSample> {
        None
    }

    fn has_discrete(&self) -> bool {
        false
    }

    fn projected_area(&self, _: Vec3) -> f32 {
        1.0
    }
}

/// A point on the surface of `medium` that `line` crosses, each alike, and how many there are.
fn crossed<W: World>(
    world: &W,
    line: Ray,
    medium: MediumId,
    stream: &mut impl Sampler,
) -> Option<(SurfaceInteraction, u32)> {
    let (mut ray, mut chosen, mut count) = (line, None, 0);
    for _ in 0..MOST_CROSSINGS {
        let Some(hit) = world.surfaces().intersect(&ray) else {
            break;
        };
        let vertex = world.surfaces().vertex(&ray, &hit);
        if vertex.media.inside == medium {
            count += 1;
            if stream.next_1d() * (count as f32) < 1.0 {
                chosen = Some(vertex);
            }
        }
        let Some(rest) = vertex.rest_of(&line) else {
            break;
        };
        ray = Ray {
            medium: line.medium,
            ..rest
        };
    }
    chosen.map(|vertex| (vertex, count))
}

impl<'w, W: World, S: Sampler, C: PathHooks> PathState<'w, W, S, C> {
    /// The step of a path that enters `medium`, which it keeps, at the surface point `entered`: `step`, or from elsewhere on the
    /// surface if a diffusion profile says where it leaves.
    #[cold]
    #[inline(never)]
    pub(crate) fn diffuse(
        &mut self,
        world: &'w W,
        config: &PathConfig,
        entered: &SurfaceInteraction,
        medium: MediumId,
        step: Step,
    ) -> Step {
        let Some(profile) = (self.medium.as_ref()).and_then(|medium| medium.diffusion(entered))
        else {
            return step;
        };
        // What the boundary reflects.
        self.trace_shadow(world, step.shadow);
        let Some(vertex) = self.leave(world, &profile, entered, medium) else {
            return Step::END;
        };
        // Radiance was compressed when it came in, and is as it was now.
        let eta = profile.relative_index();
        self.throughput.beta *= eta * eta;
        self.eta /= eta;
        if self.is_last(config) || self.throughput.beta == Vec4::ZERO {
            return Step::END;
        }
        let normal = vertex.normal;
        let shading = vertex.shading.n;
        let frame = Frame::from_normal(if shading.dot(normal) < 0.0 {
            -shading
        } else {
            shading
        });
        let leaving = Leaving {
            profile: &profile,
            frame,
            normal,
        };
        let at = ScatteringPoint::new(&vertex, &leaving, frame.n, self.draw_event());
        let shadow = self.sample_light(world, config, &at);
        let ray = self.scatter(config, &at);
        if let Some(next) = ray {
            self.enter(world, &vertex, [medium, next.medium]);
        }
        Step { shadow, ray }
    }

    /// Where the path leaves.
    fn leave(
        &mut self,
        world: &'w W,
        profile: &impl DiffusionProfile,
        entered: &SurfaceInteraction,
        medium: MediumId,
    ) -> Option<SurfaceInteraction> {
        let event = self.draw_event();
        let frame = Frame::from_normal_and_tangent(entered.normal, entered.dp_du);
        let axes = [frame.n, frame.s, frame.t];
        let axis = match event.lobe {
            u if u < FACING[0] => 0,
            u if u < FACING[0] + FACING[1] => 1,
            _ => 2,
        };
        let [n, s, t] = [0, 1, 2].map(|i| axes[(axis + i) % 3]);
        let (r, reach) = (profile.sample(event.direction.x)?, profile.reach());
        let half = float::safe_sqrt(reach * reach - r * r);
        if !(half > 0.0) {
            return None;
        }
        let (sin, cos) = float::sin_cos(TAU * event.direction.y);
        let middle = entered.position + r * (cos * s + sin * t);
        let line = Ray {
            t_max: 2.0 * half,
            ..Ray::new(middle + half * n, -n, entered.time)
        };
        let mut stream = line.stream(event.roulette);
        let (vertex, count) = crossed(world, line, medium, &mut stream)?;
        let way = vertex.position - entered.position;
        let least = 1e-6 * reach;
        if !(way.length() > least) {
            return None;
        }
        let mut density = Vec4::ZERO;
        for (axis, probability) in axes.into_iter().zip(FACING) {
            let along = way.dot(axis);
            let r = float::safe_sqrt(way.length_squared() - along * along).max(least);
            density += profile.density(r) * (probability * vertex.normal.dot(axis).abs());
        }
        let value = profile.value(&Exit {
            offset: frame.to_local(way),
            normal: frame.to_local(vertex.normal),
        });
        if !(density.x > 0.0) {
            return None;
        }
        self.throughput.scatter(value * count as f32, density);
        Some(vertex)
    }
}
