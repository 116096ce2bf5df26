//! What a training path tells: the record of a vertex, and what it scattered.

use super::*;
use crate::guided::sd_tree::{FACES, Lobes, RegionUpdate, SdTree};
use etalon_math::{DeltaProbability, Density, Frame, SolidAngle};
use etalon_sampling::discrete::{Quadtree, Refinement};
use etalon_transport::{InstanceId, LightId, MaterialId, SamplePdf, ShapeId, TransportMode};
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

/// The record of the first vertex of a path of three surfaces that emit radiance 2, 4, 8 and by light samples
/// send back 16, 32, 64. The second scatters `gain` times the light of a diffuse one.
fn first_record(gain: f32) -> f32 {
    let update = RegionUpdate {
        lobes: Lobes::default(),
        irradiance: [IRRADIANCE; FACES],
        own: [0.5; FACES],
        records: 1,
    };
    let field = SdTree::new(Vec3::ZERO, Vec3::ONE, 0.5).learned(vec![update], 10);
    let mut training_path = TrainingPath::new(GuidedHooks {
        field: &field,
        reflected: 1.0,
    });
    training_path.begin();
    let wi = Vec3::new(0.6, 0.0, COS);
    let mut path = PathThroughput::START;
    for (surface, gain) in [1.0, gain, 1.0].into_iter().enumerate() {
        let arriving = path;
        let radiance = |r: f32| arriving.contribution(Vec4::splat(r), Vec4::ZERO);
        training_path.on_emission(radiance((2 << surface) as f32));
        training_path.on_light_sample();
        let sample = BsdfSample {
            wi,
            value: Grey.eval(Vec3::Z, wi, TransportMode::Radiance) * gain,
            chance: SamplePdf::Continuous(Density::uniform(DENSITY)),
            eta: 1.0,
            is_null: false,
        };
        path.scatter(sample.value, sample.chance.lanes());
        training_path.on_scatter(&vertex(), &Grey, Vec3::Z, &sample, &path);
        // Roulette is no light: what survives counts for more, and here all does.
        let survival = training_path.survival(&path, 1.0);
        path.roulette(survival);
        training_path.on_light_contribution(radiance((16 << surface) as f32));
    }
    let first = training_path.records().next().expect("the first vertex");
    first.weight.expect("not discrete") * DENSITY / COS
}

#[test]
fn a_vertex_is_told_of_the_next_diffuse_surface_and_of_what_that_is_known_to_reflect() {
    let reflected = ALBEDO * IRRADIANCE * FRAC_1_PI;
    let survival = 0.5;
    let expected = (4.0 + 32.0 + reflected) / survival;
    let found = first_record(1.0);
    assert!((found / expected - 1.0).abs() < 1e-5, "{found}, {expected}");
    // Mutant: the light sample of the third surface would count as well, if the vertex still waited: 64
    // times what the second scatters. A surface that scatters otherwise makes it wait.
    let gain = 3.0;
    let scattered = gain * ALBEDO * COS * FRAC_1_PI / DENSITY;
    let otherwise = first_record(gain) * survival - (4.0 + 32.0);
    let beyond = scattered * (8.0 + 64.0 + reflected);
    assert!(otherwise > 0.9 * beyond, "{otherwise}, {beyond}");
}

#[test]
fn a_vertex_tells_what_it_scattered_and_how_else_that_might_have_been_found() {
    const SHARE: f32 = 0.6;
    let even = Quadtree::uniform().learned(
        |_| 1.0,
        Refinement {
            share: 1.0,
            depth: 1,
        },
    );
    let update = RegionUpdate {
        lobes: core::array::from_fn(|_| even.clone()),
        irradiance: [0.0; FACES],
        own: [SHARE; FACES],
        records: 1,
    };
    let field = SdTree::new(Vec3::ZERO, Vec3::ONE, 0.3).learned(vec![update], 10);
    let wi = Vec3::new(0.6, 0.0, COS);
    let scattered = |chance: SamplePdf| {
        let mut training_path = TrainingPath::new(GuidedHooks {
            field: &field,
            reflected: 1.0,
        });
        training_path.begin();
        let sample = BsdfSample {
            wi,
            value: Vec4::splat(ALBEDO),
            chance,
            eta: 1.0,
            is_null: false,
        };
        let mut path = PathThroughput::START;
        path.scatter(sample.value, sample.chance.lanes());
        training_path.on_scatter(&vertex(), &Grey, Vec3::Z, &sample, &path);
        training_path.on_emission(path.contribution(Vec4::splat(2.0), Vec4::ZERO));
        let record = training_path.records().next().expect("a vertex");
        let (light, alternatives) = record.scattered.expect("alternatives");
        (record.weight.is_some(), light, alternatives)
    };
    let learned = 0.25 * FRAC_1_PI;
    let mixed = SHARE * DENSITY + (1.0 - SHARE) * learned;
    let (continuous, light, alternatives) =
        scattered(SamplePdf::Continuous(Density::uniform(mixed)));
    assert!(
        continuous && (light / (2.0 * ALBEDO / mixed) - 1.0).abs() < 1e-5,
        "{light}"
    );
    assert!(
        (alternatives.own / DENSITY - 1.0).abs() < 1e-4,
        "{alternatives:?}"
    );
    assert!(
        (alternatives.learned / learned - 1.0).abs() < 1e-5,
        "{alternatives:?}"
    );
    // Discrete directions are found by the model alone.
    let (continuous, light, alternatives) =
        scattered(SamplePdf::Discrete(DeltaProbability(Vec4::splat(0.25))));
    assert!(
        !continuous && (light / (2.0 * ALBEDO / 0.25) - 1.0).abs() < 1e-5,
        "{light}"
    );
    assert_eq!((alternatives.own, alternatives.learned), (1.0, 0.0));
}
