//! A training path of path guiding: remembers, for every vertex, what radiance came from the sampled direction.
//!
//! ```text
//! L(x, ω) ≈ Le(y) + L_lights(y) + ρ(y)·E(y)/π,        y the surface seen from x along ω
//! ```
//!
//! Le is what y emits toward x, weighted against light sampling as in the picture; L_lights the one light
//! sample taken at y; ρ its albedo; E the irradiance that scattering found there in the
//! round before: the mean record of y's region and face. Whatever the path finds behind y is a noisy
//! estimate of the last term, and replaced by it (expected SARSA: Dahm & Keller 2017, "Learning Light Transport
//! the Reinforced Way"). With indirect light only, few training paths reach a light; the irradiance cached at the
//! next diffuse surface gives every path a useful estimate.
//!
//! That term is true of diffuse surfaces. Where a surface scatters otherwise, the path itself tells what comes
//! from it, up to the next diffuse one.

use super::field;
use super::fraction::AlternativePdfs;
use super::guide::{GuidedHooks, toward};
use super::steering::GuidedBsdf;
use crate::path_hooks::PathHooks;
use crate::path_throughput::PathThroughput;
use etalon_transport::{Bsdf, BsdfSample, SurfaceInteraction};
use glam::{Vec3, Vec4};
use std::f32::consts::FRAC_1_PI;
use std::ops::RangeInclusive;

/// A corner of a path: the direction it took, and what it found that way.
struct PathVertex {
    position: Vec3,
    /// The shading normal on the side from which the path came.
    normal: Vec3,
    direction: Vec3,
    /// What the surface scatters there: f·|cos θ|, or the share of a discrete direction.
    value: Vec4,
    /// The density of the direction, the mean over the lanes (sr⁻¹), or the probability of a discrete one.
    density: f32,
    discrete: bool,
    /// How it might have been found, where something is known of where light comes from.
    rivals: Option<AlternativePdfs>,
    /// The path that leaves the corner.
    prefix: PathThroughput,
    found: Vec4,
}

/// A light that came from a direction.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Record {
    pub(crate) position: Vec3,
    /// The normal of the surface that it fell on.
    pub(crate) normal: Vec3,
    pub(crate) direction: Vec3,
    /// Its irradiance on the surface: radiance times cosine, over the density of the direction. `None` for a
    /// discrete direction, which no lobe can find.
    pub(crate) weight: Option<f32>,
    /// What the surface scatters of it, over the density of the direction, and how else that might have been
    /// found.
    pub(crate) scattered: Option<(f32, AlternativePdfs)>,
}

/// Steers a path in training and remembers what it finds at every corner.
pub(crate) struct TrainingPath<'f> {
    guide: GuidedHooks<'f>,
    corners: Vec<PathVertex>,
    /// The path as it left the last surface.
    path: PathThroughput,
    /// The first corner that still waits for what comes from its direction.
    open: usize,
    /// The corners that waited when the light sample was chosen.
    before_light: (usize, usize),
}

/// How much more light a surface may scatter into a direction than a diffuse one of its albedo, to pass for one.
const DIFFUSE: RangeInclusive<f32> = 0.7..=1.4;

impl<'f> TrainingPath<'f> {
    pub(crate) fn new(guide: GuidedHooks<'f>) -> Self {
        Self {
            guide,
            corners: Vec::new(),
            path: PathThroughput::START,
            open: 0,
            before_light: (0, 0),
        }
    }

    /// Begins another path.
    pub(crate) fn begin(&mut self) {
        self.corners.clear();
        self.path = PathThroughput::START;
        self.open = 0;
        self.before_light = (0, 0);
        self.guide.reflected = 1.0;
    }

    /// What was found, corner by corner.
    pub(crate) fn records(&self) -> impl Iterator<Item = Record> {
        self.corners.iter().map(|corner| {
            let cos = corner.normal.dot(corner.direction).abs();
            let weight = corner.incident(Vec4::ONE) * cos / corner.density;
            let scattered = |rivals| (corner.incident(corner.value) / corner.density, rivals);
            Record {
                position: corner.position,
                normal: corner.normal,
                direction: corner.direction,
                weight: (!corner.discrete).then_some(weight),
                scattered: corner.rivals.map(scattered),
            }
        })
    }

    /// Tells the corners that wait for it what a diffuse surface reflects; they wait no longer.
    fn reflect(&mut self, position: Vec3, normal: Vec3, albedo: Vec4) {
        let irradiance = self.guide.field.irradiance(position, normal);
        let radiance = albedo * (irradiance * FRAC_1_PI);
        let estimate = self.path.contribution(radiance, Vec4::ZERO);
        for corner in &mut self.corners[self.open..] {
            corner.found += estimate;
        }
        self.open = self.corners.len();
    }
}

impl PathVertex {
    /// An estimate of the radiance that comes from the corner's direction, times `factor`, the mean over the lanes,
    /// which are drawn as the eye sees. Exact in expectation where later densities are the same in all lanes; but
    /// for noise, nothing depends on it.
    fn incident(&self, factor: Vec4) -> f32 {
        let value = self.prefix.beta;
        let seen = value.cmpgt(Vec4::ZERO);
        let radiance = factor * self.found * self.prefix.r_u.element_sum() / value;
        0.25 * Vec4::select(seen, radiance, Vec4::ZERO).element_sum()
    }
}

impl<'f> PathHooks for TrainingPath<'f> {
    type GuidedBsdf<B: Bsdf + Copy> = GuidedBsdf<'f, B>;

    fn wrap_bsdf<B: Bsdf + Copy>(
        &self,
        vertex: &SurfaceInteraction,
        wo: Vec3,
        bsdf: B,
    ) -> GuidedBsdf<'f, B> {
        self.guide.wrap_bsdf(vertex, wo, bsdf)
    }

    fn on_scatter(
        &mut self,
        vertex: &SurfaceInteraction,
        bsdf: &impl Bsdf,
        wo: Vec3,
        sample: &BsdfSample,
        prefix: &PathThroughput,
    ) {
        self.guide.on_scatter(vertex, bsdf, wo, sample, prefix);
        let normal = toward(vertex, wo);
        let discrete = sample.chance.is_delta();
        if !discrete {
            let albedo = bsdf.albedo(wo);
            let diffuse = albedo.element_sum() * normal.dot(sample.wi).abs() * FRAC_1_PI;
            if DIFFUSE.contains(&(sample.value.element_sum() / diffuse)) {
                self.reflect(vertex.position, normal, albedo);
            }
        }
        let density = 0.25 * sample.chance.lanes().element_sum();
        let lobe = match bsdf.has_continuous() && !sample.is_null {
            true => self.guide.field.lobe(vertex.position, normal),
            false => None,
        };
        let rivals = lobe.map(|(lobe, share)| match discrete {
            true => AlternativePdfs {
                own: 1.0,
                learned: 0.0,
            },
            false => {
                let scattered = 1.0 - 0.25 * bsdf.null_probability().element_sum();
                let learned = scattered * field::density(lobe, sample.wi).hero();
                let own = (density - (1.0 - share) * learned) / share;
                AlternativePdfs {
                    own: own.max(0.0),
                    learned,
                }
            }
        });
        if !discrete || rivals.is_some() {
            self.corners.push(PathVertex {
                position: vertex.position,
                normal,
                direction: sample.wi,
                value: sample.value,
                density,
                discrete,
                rivals,
                prefix: *prefix,
                found: Vec4::ZERO,
            });
        }
        self.path = *prefix;
    }

    fn on_medium(&mut self, prefix: &PathThroughput) {
        self.path = *prefix;
    }

    fn on_roulette(&mut self, survival: f32) {
        self.path.roulette(survival);
    }

    fn on_emission(&mut self, estimate: Vec4) {
        for corner in &mut self.corners[self.open..] {
            corner.found += estimate;
        }
    }

    fn on_light_sample(&mut self) {
        self.before_light = (self.open, self.corners.len());
    }

    fn on_light_contribution(&mut self, estimate: Vec4) {
        let (open, end) = self.before_light;
        for corner in &mut self.corners[open..end] {
            corner.found += estimate;
        }
    }

    fn survival(&mut self, prefix: &PathThroughput, eta: f32) -> f32 {
        let survival = self.guide.survival(prefix, eta);
        self.path.roulette(survival);
        survival
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::guided::field::{FACES, Lobes, RegionUpdate, SdTree};
    use etalon_math::{DeltaProbability, Density, Frame, SolidAngle};
    use etalon_sampling::discrete::{Quadtree, Refinement};
    use etalon_transport::{
        InstanceId, LightId, MaterialId, Mixture, SamplePdf, ShapeId, TransportMode,
    };
    use glam::Vec2;

    const ALBEDO: f32 = 0.5;
    const IRRADIANCE: f32 = 3.0;
    const COS: f32 = 0.8;
    const DENSITY: f32 = 0.4;

    /// What `sample` is said to have come from.
    #[derive(Clone, Copy)]
    struct Grey;

    impl Bsdf for Grey {
        fn eval(&self, _: Vec3, wi: Vec3, _: TransportMode) -> Vec4 {
            Vec4::splat(ALBEDO * wi.z.max(0.0) * FRAC_1_PI)
        }
        fn density(&self, _: Vec3, _: Vec3) -> Density<SolidAngle> {
            Density::uniform(DENSITY)
        }
        fn sample(&self, _: Vec3, _: f32, _: Vec2, _: TransportMode) -> Option<BsdfSample> {
            None
        }
        fn has_continuous(&self) -> bool {
            true
        }
        fn null_transmittance(&self) -> Vec4 {
            Vec4::ZERO
        }
        fn null_probability(&self) -> Vec4 {
            Vec4::ZERO
        }
        fn albedo(&self, _: Vec3) -> Vec4 {
            Vec4::splat(ALBEDO)
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
        fn hemisphere(&self) -> Option<Frame> {
            None
        }
        fn projected_area(&self, _: Vec3) -> f32 {
            1.0
        }
        fn mixed(&self, _: impl FnOnce() -> Mixture) {}
    }

    fn vertex() -> SurfaceInteraction {
        SurfaceInteraction {
            position: Vec3::splat(0.5),
            error: Vec3::ZERO,
            depth: f32::NAN,
            normal: Vec3::Z,
            shading: Frame::from_normal(Vec3::Z),
            uv: Vec2::ZERO,
            dp_du: Vec3::X,
            dp_dv: Vec3::Y,
            t: 1.0,
            time: 0.0,
            parameters: Vec2::ZERO,
            shape: ShapeId(0),
            primitive: 0,
            instance: InstanceId::NONE,
            material: MaterialId(0),
            light: LightId::NONE,
            media: etalon_transport::MediumInterface::NONE,
        }
    }

    /// The record of the first corner of a path of three surfaces that emit radiance 2, 4, 8 and by light samples
    /// send back 16, 32, 64. The second scatters `gain` times the light of a diffuse one.
    fn first_record(gain: f32) -> f32 {
        let lesson = RegionUpdate {
            lobes: Lobes::default(),
            irradiance: [IRRADIANCE; FACES],
            own: [0.5; FACES],
            records: 1,
        };
        let field = SdTree::new(Vec3::ZERO, Vec3::ONE, 0.5).learned(vec![lesson], 10);
        let mut pupil = TrainingPath::new(GuidedHooks {
            field: &field,
            reflected: 1.0,
        });
        pupil.begin();
        let wi = Vec3::new(0.6, 0.0, COS);
        let mut path = PathThroughput::START;
        for (surface, gain) in [1.0, gain, 1.0].into_iter().enumerate() {
            let arriving = path;
            let radiance = |r: f32| arriving.contribution(Vec4::splat(r), Vec4::ZERO);
            pupil.on_emission(radiance((2 << surface) as f32));
            pupil.on_light_sample();
            let sample = BsdfSample {
                wi,
                value: Grey.eval(Vec3::Z, wi, TransportMode::Radiance) * gain,
                chance: SamplePdf::Continuous(Density::uniform(DENSITY)),
                eta: 1.0,
                is_null: false,
            };
            path.scatter(sample.value, sample.chance.lanes());
            pupil.on_scatter(&vertex(), &Grey, Vec3::Z, &sample, &path);
            // Roulette is no light: what survives counts for more, and here all does.
            let survival = pupil.survival(&path, 1.0);
            path.roulette(survival);
            pupil.on_light_contribution(radiance((16 << surface) as f32));
        }
        let first = pupil.records().next().expect("the first corner");
        first.weight.expect("not discrete") * DENSITY / COS
    }

    #[test]
    fn a_corner_is_told_of_the_next_diffuse_surface_and_of_what_that_is_known_to_reflect() {
        let reflected = ALBEDO * IRRADIANCE * FRAC_1_PI;
        let survival = 0.5;
        let expected = (4.0 + 32.0 + reflected) / survival;
        let found = first_record(1.0);
        assert!((found / expected - 1.0).abs() < 1e-5, "{found}, {expected}");
        // Mutant: the light sample of the third surface would count as well, if the corner still waited: 64
        // times what the second scatters. A surface that scatters otherwise makes it wait.
        let gain = 3.0;
        let scattered = gain * ALBEDO * COS * FRAC_1_PI / DENSITY;
        let otherwise = first_record(gain) * survival - (4.0 + 32.0);
        let beyond = scattered * (8.0 + 64.0 + reflected);
        assert!(otherwise > 0.9 * beyond, "{otherwise}, {beyond}");
    }

    #[test]
    fn a_corner_tells_what_it_scattered_and_how_else_that_might_have_been_found() {
        const SHARE: f32 = 0.6;
        let even = Quadtree::uniform().learned(
            |_| 1.0,
            Refinement {
                share: 1.0,
                depth: 1,
            },
        );
        let lesson = RegionUpdate {
            lobes: core::array::from_fn(|_| even.clone()),
            irradiance: [0.0; FACES],
            own: [SHARE; FACES],
            records: 1,
        };
        let field = SdTree::new(Vec3::ZERO, Vec3::ONE, 0.3).learned(vec![lesson], 10);
        let wi = Vec3::new(0.6, 0.0, COS);
        let scattered = |chance: SamplePdf| {
            let mut pupil = TrainingPath::new(GuidedHooks {
                field: &field,
                reflected: 1.0,
            });
            pupil.begin();
            let sample = BsdfSample {
                wi,
                value: Vec4::splat(ALBEDO),
                chance,
                eta: 1.0,
                is_null: false,
            };
            let mut path = PathThroughput::START;
            path.scatter(sample.value, sample.chance.lanes());
            pupil.on_scatter(&vertex(), &Grey, Vec3::Z, &sample, &path);
            pupil.on_emission(path.contribution(Vec4::splat(2.0), Vec4::ZERO));
            let record = pupil.records().next().expect("a corner");
            let (light, rivals) = record.scattered.expect("rivals");
            (record.weight.is_some(), light, rivals)
        };
        let learned = 0.25 * FRAC_1_PI;
        let mixed = SHARE * DENSITY + (1.0 - SHARE) * learned;
        let (continuous, light, rivals) = scattered(SamplePdf::Continuous(Density::uniform(mixed)));
        assert!(
            continuous && (light / (2.0 * ALBEDO / mixed) - 1.0).abs() < 1e-5,
            "{light}"
        );
        assert!((rivals.own / DENSITY - 1.0).abs() < 1e-4, "{rivals:?}");
        assert!((rivals.learned / learned - 1.0).abs() < 1e-5, "{rivals:?}");
        // Discrete directions are found by the model alone.
        let (continuous, light, rivals) =
            scattered(SamplePdf::Discrete(DeltaProbability(Vec4::splat(0.25))));
        assert!(
            !continuous && (light / (2.0 * ALBEDO / 0.25) - 1.0).abs() < 1e-5,
            "{light}"
        );
        assert_eq!((rivals.own, rivals.learned), (1.0, 0.0));
    }
}
