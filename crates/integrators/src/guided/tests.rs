//! The parts of `guided`, one by one.

use super::guided_bsdf::GuidedBsdf;
use super::sd_tree::{self, FACES, Lobes, RegionUpdate, SdTree};
use etalon_math::{DeltaProbability, Density, Frame, SolidAngle};
use etalon_sampling::discrete::{Quadtree, Refinement};
use etalon_sampling::{Independent, Sampler};
use etalon_transport::{Bsdf, BsdfSample, SamplePdf, TransportMode};
use glam::{Vec2, Vec3, Vec4};
use std::f32::consts::PI;

fn updates(field: &SdTree, records: u64) -> Vec<RegionUpdate> {
    let update = |_: &sd_tree::SpatialLeaf| RegionUpdate {
        lobes: Lobes::default(),
        irradiance: [0.0; FACES],
        own: [0.5; FACES],
        records,
    };
    field.regions().iter().map(update).collect()
}

#[test]
fn regions_are_halved_until_their_share_is_small() {
    let mut field = SdTree::new(Vec3::ZERO, Vec3::new(2.0, 1.0, 0.5), 0.5);
    assert_eq!(field.find(Vec3::splat(0.3)), 0);
    // Of 1000 records at most 130 in each: eight parts; then four times as many.
    for (records, parts) in [(1000, 8), (400, 32)] {
        let updates = updates(&field, records);
        field = field.learned(updates, 130);
        assert_eq!(field.regions().len(), parts);
    }
    let volume: f32 = (field.regions().iter())
        .map(|region| region.size.element_product())
        .sum();
    assert!((volume / (2.0_f32 * 1.001).powi(3) - 1.0).abs() < 1e-4);
    // Every point lies in the region of its own eighth of the cube; far away points in the nearest.
    let mut seen = vec![0; field.regions().len()];
    let mut numbers = Independent::from_key(4);
    for _ in 0..4000 {
        let point = Vec3::new(numbers.next_1d(), numbers.next_1d(), numbers.next_1d()) * 2.0;
        let point = point - Vec3::new(0.0, 0.5, 0.75);
        let region = field.find(point);
        seen[region] += 1;
        let near = point + 0.01 * (Vec3::new(1.0, 0.5, 0.25) - point);
        let size = field.regions()[region].size;
        assert!(region == field.find(near) || size.max_element() < 1.5);
    }
    assert!(seen.iter().all(|count| *count > 50), "{seen:?}");
    let corner = field.find(Vec3::new(0.0, -0.5, -0.75));
    assert_eq!(field.find(Vec3::splat(-100.0)), corner);
    assert_eq!(field.find(Vec3::splat(f32::NAN)), corner);
}

#[test]
fn faces_are_the_six_sides() {
    let sides = [Vec3::X, -Vec3::X, Vec3::Y, -Vec3::Y, Vec3::Z, -Vec3::Z];
    assert_eq!(sides.map(sd_tree::face), [0, 1, 2, 3, 4, 5]);
    assert_eq!(sides.len(), FACES);
    assert_eq!(sd_tree::face(Vec3::new(0.5, -0.7, 0.5)), 3);
}

/// A lobe that prefers one corner of the square of directions, and leaves another out.
fn lobe() -> Quadtree {
    let fine = Refinement {
        share: 0.05,
        depth: 4,
    };
    let mut tree = Quadtree::uniform();
    for _ in 0..3 {
        let mass = |slot: usize| {
            if slot % 4 == 2 {
                0.0
            } else {
                (1 + slot % 7) as f64
            }
        };
        tree = tree.learned(mass, fine).expect("mass");
    }
    tree
}

#[test]
fn directions_follow_the_density_of_their_lobe() {
    let lobe = lobe();
    let mut numbers = Independent::from_key(9);
    for _ in 0..10_000 {
        let (direction, chance) = sd_tree::sample(&lobe, numbers.next_2d());
        let again = sd_tree::density(&lobe, direction);
        // Directions within rounding of a leaf's border may come back as its neighbour's.
        let place = sd_tree::place_of(direction) * 16.0;
        let border = (place - place.round()).abs().min_element() < 1e-3;
        assert!(
            border || chance == again,
            "{direction}: {chance:?}, {again:?}"
        );
    }
    // ∫ p dω = 1, by the mean of 4π·p over uniform directions: the midpoints of leaves and more.
    let n = 256;
    let total: f32 = (0..n * n)
        .map(|i| (Vec2::new((i % n) as f32, (i / n) as f32) + 0.5) / n as f32)
        .map(etalon_sampling::warps::square_to_uniform_sphere)
        .map(|direction| sd_tree::density(&lobe, direction).hero())
        .sum();
    let integral = 4.0 * PI * total / (n * n) as f32;
    assert!((integral - 1.0).abs() < 1e-3, "{integral}");
}

/// A fifth to two fifths passes, by wavelength; half of the rest is a mirror along x, half diffuse on +z.
#[derive(Clone, Copy)]
struct Model;

const PASSING: Vec4 = Vec4::new(0.2, 0.3, 0.35, 0.4);

impl Bsdf for Model {
    fn eval(&self, _: Vec3, wi: Vec3, _: TransportMode) -> Vec4 {
        (Vec4::ONE - PASSING) * (0.5 * wi.z.max(0.0) / PI)
    }
    fn density(&self, wo: Vec3, wi: Vec3) -> Density<SolidAngle> {
        Density::per_lane(self.eval(wo, wi, TransportMode::Radiance))
    }
    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2, mode: TransportMode) -> Option<BsdfSample> {
        let discrete = |wi, energy: Vec4, passes| BsdfSample {
            wi,
            value: energy,
            chance: SamplePdf::Discrete(DeltaProbability(energy)),
            eta: 1.0,
            is_null: passes,
        };
        let rest = (u_lobe - PASSING.x) / (1.0 - PASSING.x);
        if u_lobe < PASSING.x {
            return Some(discrete(-wo, PASSING, true));
        }
        if rest < 0.5 {
            return Some(discrete(Vec3::X, (Vec4::ONE - PASSING) * 0.5, false));
        }
        let wi = etalon_sampling::warps::square_to_cosine_hemisphere(u);
        let density = self.density(wo, wi);
        (density.hero() > 0.0).then(|| BsdfSample {
            chance: SamplePdf::Continuous(density),
            is_null: false,
            ..discrete(wi, self.eval(wo, wi, mode), false)
        })
    }
    fn has_continuous(&self) -> bool {
        true
    }
    fn null_transmittance(&self) -> Vec4 {
        PASSING
    }
    fn null_probability(&self) -> Vec4 {
        PASSING
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
        true
    }
    fn hemisphere(&self) -> Option<Frame> {
        None
    }
    fn projected_area(&self, _: Vec3) -> f32 {
        1.0
    }
}

/// The mean of what a model brings from a sky of brightness 1 + z, of the mirror's light and of the
/// passing light; with the balance over what each of four lanes would have chosen left out: lane 0.
fn brings(model: &impl Bsdf) -> [f64; 3] {
    let mut numbers = Independent::from_key(3);
    let n = 400_000;
    let mut sums = [0.0; 3];
    for _ in 0..n {
        let (u_lobe, u) = (numbers.next_1d(), numbers.next_2d());
        let Some(sample) = model.sample(Vec3::Z, u_lobe, u, TransportMode::Radiance) else {
            continue;
        };
        let weight = f64::from(sample.value.x / sample.chance.lanes().x);
        match (sample.is_null, sample.chance) {
            (true, _) => sums[2] += weight,
            (false, SamplePdf::Discrete(_)) => sums[1] += weight,
            (false, SamplePdf::Continuous(density)) => {
                // Only what the sample says of its density in the end is believed.
                assert_eq!(sample.wi.is_normalized(), density.hero() > 0.0);
                sums[0] += weight * f64::from(1.0 + sample.wi.z);
            }
        }
    }
    sums.map(|sum| sum / f64::from(n))
}

#[test]
fn a_steered_model_scatters_the_same_light() {
    let lobe = lobe();
    // Diffuse light: 0.8/2·(1 + 2/3); the mirror's 0.4; passing 0.2.
    let exact = [0.4 * (1.0 + 2.0 / 3.0), 0.4, 0.2];
    for own in [0.1, 0.5, 1.0] {
        let steered = GuidedBsdf {
            bsdf: Model,
            lobe: Some((&lobe, own)),
        };
        let found = brings(&steered);
        // Standard errors are below 0.003 (weights at most 1/own, n = 400 000): z < 5.
        for (found, exact) in found.into_iter().zip(exact) {
            assert!(
                (found - exact).abs() < 0.015 * exact,
                "{own}: {found}, {exact}"
            );
        }
        // The density of the sample is what `density` says, lane by lane.
        let mut numbers = Independent::from_key(6);
        for _ in 0..1000 {
            let (u_lobe, u) = (numbers.next_1d(), numbers.next_2d());
            let Some(sample) = steered.sample(Vec3::Z, u_lobe, u, TransportMode::Radiance) else {
                continue;
            };
            if let SamplePdf::Continuous(stated) = sample.chance {
                let (value, density) =
                    steered.eval_and_density(Vec3::Z, sample.wi, TransportMode::Radiance);
                assert_eq!(value, sample.value);
                assert_eq!(density, steered.density(Vec3::Z, sample.wi));
                let off = (density.lanes() / stated.lanes() - 1.0).abs().max_element();
                let place = sd_tree::place_of(sample.wi) * 16.0;
                let border = (place - place.round()).abs().min_element() < 1e-3;
                assert!(border || off < 1e-5, "{stated:?}, {density:?}");
            }
        }
    }
    // Mutant: a mixture that forgets that passing light leaves less for the learned lobe. Its density of
    // learned directions is larger by 1/(1 − p₀) = 1.25, and the diffuse light too dark by far.
    let wrong = exact[0] * (1.0 - 0.9 * 0.2);
    assert!((wrong - exact[0]).abs() > 0.1 * exact[0]);
}

/// A model whose every answer differs from what the contract says by default, and from all others.
#[derive(Clone, Copy)]
struct Odd<'a>(&'a std::cell::Cell<u32>);

const ODD_FRAME: Frame = Frame {
    s: Vec3::Y,
    t: Vec3::Z,
    n: Vec3::X,
};

impl Bsdf for Odd<'_> {
    fn eval(&self, _: Vec3, wi: Vec3, _: TransportMode) -> Vec4 {
        Vec4::splat(0.25) * wi.x.abs()
    }
    fn density(&self, _: Vec3, wi: Vec3) -> Density<SolidAngle> {
        Density::per_lane(Vec4::new(0.1, 0.2, 0.3, 0.4) * wi.y.abs())
    }
    fn eval_and_density(
        &self,
        wo: Vec3,
        wi: Vec3,
        mode: TransportMode,
    ) -> (Vec4, Density<SolidAngle>) {
        // As by itself, and told apart.
        self.0.set(self.0.get() + 1);
        (self.eval(wo, wi, mode), self.density(wo, wi))
    }
    fn sample(&self, wo: Vec3, _: f32, _: Vec2, mode: TransportMode) -> Option<BsdfSample> {
        self.discrete(wo, 1, mode)
    }
    fn discrete(&self, wo: Vec3, index: u32, _: TransportMode) -> Option<BsdfSample> {
        (index < 2).then(|| BsdfSample {
            wi: [-wo, Vec3::X][index as usize],
            value: Vec4::new(0.4, 0.3, 0.2, 0.1),
            chance: SamplePdf::Discrete(DeltaProbability(Vec4::splat(0.5))),
            eta: 1.5,
            is_null: index == 0,
        })
    }
    fn has_continuous(&self) -> bool {
        false
    }
    fn has_discrete(&self) -> bool {
        false
    }
    fn hemisphere(&self) -> Option<Frame> {
        Some(ODD_FRAME)
    }
    fn null_transmittance(&self) -> Vec4 {
        Vec4::new(0.1, 0.2, 0.3, 0.4)
    }
    fn null_probability(&self) -> Vec4 {
        PASSING
    }
    fn albedo(&self, wo: Vec3) -> Vec4 {
        wo.extend(0.5)
    }
    fn projected_area(&self, direction: Vec3) -> f32 {
        2.0 + direction.z
    }
}

/// Everything that a model can be asked, as text. `eval_and_density` counts.
fn answers(model: &impl Bsdf, asked: &std::cell::Cell<u32>) -> Vec<String> {
    let (wo, wi) = (Vec3::new(0.0, 0.6, 0.8), Vec3::new(0.48, 0.64, 0.6));
    let mode = TransportMode::Importance;
    asked.set(0);
    let mut all = vec![
        format!("eval {}", model.eval(wo, wi, mode)),
        format!(
            "null {} {}",
            model.null_transmittance(),
            model.null_probability()
        ),
        format!("has {} {}", model.has_continuous(), model.has_discrete()),
        format!("hemisphere {:?}", model.hemisphere()),
        format!(
            "albedo {}, area {}",
            model.albedo(wo),
            model.projected_area(wi)
        ),
        format!("passes {:?}", model.discrete(wo, 0, mode)),
        format!("end {:?}", model.discrete(wo, 2, mode)),
        format!("value {:?}", model.eval_and_density(wo, wi, mode).0),
    ];
    all.push(format!("at once {}", asked.get() % 100));
    all
}

/// Every question of the contract reaches the model within: what is steered differs in how directions are
/// found, and in nothing else. Mutant: any answer that is the contract's default.
#[test]
fn a_steered_model_answers_as_the_model_within() {
    let lobe = lobe();
    let asked = std::cell::Cell::new(0);
    let model = Odd(&asked);
    for steering in [None, Some((&lobe, 0.25))] {
        let steered = GuidedBsdf {
            bsdf: model,
            lobe: steering,
        };
        assert_eq!(answers(&steered, &asked), answers(&model, &asked));
        let probability = |model: &dyn Fn() -> Option<BsdfSample>| {
            let sample = model().expect("a mirror");
            sample.chance.lanes()
        };
        let own = probability(&|| model.discrete(Vec3::Z, 1, TransportMode::Radiance));
        let found = probability(&|| steered.discrete(Vec3::Z, 1, TransportMode::Radiance));
        let share = steering.map_or(1.0, |(_, share)| share);
        assert_eq!(found, own * share);
        if steering.is_none() {
            let ask =
                |model: &dyn Fn(Vec3) -> Density<SolidAngle>| model(Vec3::new(0.48, 0.64, 0.6));
            let plain = ask(&|wi| model.density(Vec3::Z, wi));
            assert_eq!(ask(&|wi| steered.density(Vec3::Z, wi)), plain);
        }
    }
}

#[test]
fn what_nothing_is_known_of_is_left_alone() {
    let plain = brings(&Model);
    let steered = GuidedBsdf {
        bsdf: Model,
        lobe: None,
    };
    assert_eq!(brings(&steered), plain);
}
