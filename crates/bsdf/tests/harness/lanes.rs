//! Materials that are shaded in vector lanes: lane i has the bits of the same material alone.

use crate::directions::Uniform;
use crate::scene::{Scene, WAVELENGTHS, vertex};
use etalon_bsdf::{BsdfAtPoint, LaneBsdfAtPoint, Material};
use etalon_math::float::ONE_MINUS_EPSILON;
use etalon_math::lane::{F32x8, F32x16, Lane, Mask, Spectral, Vector};
use etalon_math::{DeltaProbability, Density, Frame};
use etalon_spectrum::Wavelengths;
use etalon_transport::{
    Bsdf, BsdfSample, LaneBsdf, LaneBsdfSample, LaneKind, LaneSurface, LaneVertices, SamplePdf,
    SurfaceInteraction, TexturePoint, TransportMode,
};
use glam::{Vec2, Vec3, Vec4};

/// Numbers to compare by their bits.
fn bits(numbers: impl IntoIterator<Item = f32>) -> Vec<u32> {
    // The sign of zero is no matter of light.
    numbers.into_iter().map(|x| (x + 0.0).to_bits()).collect()
}

fn of_sample(sample: &BsdfSample) -> Vec<u32> {
    let (is_delta, chance) = (sample.chance.is_delta(), sample.chance.lanes());
    let numbers = (sample.wi.to_array().into_iter())
        .chain(sample.value.to_array())
        .chain(chance.to_array())
        .chain([sample.eta, f32::from(is_delta)]);
    bits(numbers)
}

/// The sample in one lane.
fn at_lane<F: Lane>(sample: &LaneBsdfSample<F>, i: usize) -> BsdfSample {
    let chance = sample.chance.at_lane(i);
    BsdfSample {
        wi: sample.wi.at_lane(i),
        value: sample.value.at_lane(i),
        chance: match sample.is_delta.lane(i) {
            true => SamplePdf::Discrete(DeltaProbability(chance)),
            false => SamplePdf::Continuous(Density::per_lane(chance)),
        },
        eta: sample.eta.lane(i),
        is_null: false,
    }
}

/// One of `count`.
fn one_of(random: &mut Uniform, count: usize) -> usize {
    (random.next() * count as f32) as usize
}

/// A direction in the frame of a surface, often in it or nearly so, or along its normal.
fn direction(random: &mut Uniform) -> Vec3 {
    let any = random.direction();
    match one_of(random, 8) {
        0 => Vec3::new(any.x, any.y, 0.0).normalize(),
        1 => {
            let exponent = (random.next() * 24.0) as i32;
            Vec3::new(any.x, any.y, any.z * 0.5f32.powi(exponent)).normalize()
        }
        2 => Vec3::Z.copysign(any),
        _ => any,
    }
}

/// One lane: a material at a vertex, two directions there, and random numbers.
struct Case<'m> {
    text: &'m str,
    material: &'m Material,
    vertex: SurfaceInteraction,
    waves: Wavelengths,
    wo: Vec3,
    wi: Vec3,
    lobe: f32,
    pair: Vec2,
}

impl<'m> Case<'m> {
    fn draw((text, material): &'m (&str, Material), scene: &Scene, random: &mut Uniform) -> Self {
        let frame = match one_of(random, 2) {
            0 => Frame::IDENTITY,
            _ => Frame::from_normal((random.direction() + 2.0 * Vec3::Z).normalize()),
        };
        let o = direction(random);
        let i = match one_of(random, 8) {
            0 => Vec3::new(-o.x, -o.y, o.z),
            1 => -o,
            2 => Vec3::new(o.x, o.y, -o.z),
            3 => o,
            _ => direction(random),
        };
        let ends = [0.0, ONE_MINUS_EPSILON];
        let pair = match one_of(random, 8) {
            0 => Vec2::new(ends[one_of(random, 2)], ends[one_of(random, 2)]),
            _ => random.pair(),
        };
        let mut case = Self {
            text,
            material,
            vertex: vertex(frame),
            waves: WAVELENGTHS.rotated(one_of(random, 4)),
            wo: frame.to_world(o),
            wi: frame.to_world(i),
            lobe: random.next(),
            pair,
        };
        if one_of(random, 2) == 0 {
            case.lobe = case.choice(scene)[one_of(random, 2)];
        }
        case
    }

    fn alone(&self, scene: &Scene) -> BsdfAtPoint<'m> {
        (self.material).resolve(scene, &self.vertex, self.wo, &self.waves)
    }

    /// The numbers on either side of a choice between lobes; 0 and nearly 1 if there is none.
    fn choice(&self, scene: &Scene) -> [f32; 2] {
        let bsdf = self.alone(scene);
        let sampled = |lobe| {
            let sample = bsdf.sample(self.wo, lobe, self.pair, TransportMode::Radiance);
            sample.map(|sample| of_sample(&sample))
        };
        let mut between = [0.0, ONE_MINUS_EPSILON];
        let [first, last] = between.map(sampled);
        if first == last {
            return between;
        }
        while between[0].next_up() < between[1] {
            let middle = 0.5 * (between[0] + between[1]);
            between[usize::from(sampled(middle) != first)] = middle;
        }
        between
    }
}

/// Compares a group of lanes with each material alone.
fn compare<F: Lane>(kind: LaneKind, scene: &Scene, cases: &[Case<'_>]) {
    let waves: Vec<_> = cases.iter().map(|case| case.waves).collect();
    let vertices = LaneVertices {
        surface: &LaneSurface::of_lanes(|i| (&cases[i].vertex).into()),
        texture_point: &|i| TexturePoint::from(&cases[i].vertex),
        wavelengths: &waves,
    };
    let wo = F::Vector::of_lanes(|i| cases[i].wo);
    let wi = F::Vector::of_lanes(|i| cases[i].wi);
    let u = [0, 1].map(|axis| F::from_fn(|i| cases[i].pair[axis]));
    let together = LaneBsdfAtPoint::<F>::new(kind, |i| cases[i].material, scene, vertices, wo);
    let (value, density) = together.eval_and_density(wo, wi);
    let sampled = together.sample(wo, F::from_fn(|i| cases[i].lobe), u);
    let hemisphere = together.hemisphere(wo);
    let albedo = together.albedo(wo);

    for (i, case) in cases.iter().enumerate() {
        let (alone, text) = (case.alone(scene), case.text);
        let (v, d) = alone.eval_and_density(case.wo, case.wi, TransportMode::Radiance);
        let of = |v: Vec4, d: Vec4| bits(v.to_array().into_iter().chain(d.to_array()));
        assert_eq!(
            of(value.at_lane(i), density.at_lane(i)),
            of(v, d.lanes()),
            "{text}: value"
        );
        if alone.lobes().is_empty() {
            assert!(d.lanes() == Vec4::ZERO && !sampled.found.lane(i), "{text}");
            continue;
        }
        assert_eq!(together.has_continuous(), alone.has_continuous(), "{text}");
        let facing = |n: Vec3| if n.dot(case.wo) < 0.0 { -n } else { n };
        assert_eq!(
            hemisphere.map(|n| n.at_lane(i)),
            alone.hemisphere().map(|frame| facing(frame.n)),
            "{text}: hemisphere"
        );
        assert_eq!(
            bits(albedo.at_lane(i).to_array()),
            bits(alone.albedo(case.wo).to_array()),
            "{text}: albedo"
        );
        // A kind promises that nothing passes straight on.
        assert_eq!(alone.null_probability(), Vec4::ZERO, "{text}");
        let alone = alone.sample(case.wo, case.lobe, case.pair, TransportMode::Radiance);
        assert_eq!(sampled.found.lane(i), alone.is_some(), "{text}: found");
        let Some(alone) = alone else { continue };
        assert_eq!(
            of_sample(&at_lane(&sampled, i)),
            of_sample(&alone),
            "{text}: sample"
        );
    }
}

/// Beside the exemplars of all models: what only their transmitting ones have, and two sides of other kinds.
const OTHERS: [&str; 4] = [
    "principled base_color=t:400:0.1,700:0.8 metallic=f:0.4 spec_tint=f:0.4 anisotropic=f:0.5 sheen=f:0.3 \
     sheen_tint=f:0.2 clearcoat=f:0.6 clearcoat_gloss=f:0.1 flatness=f:0.3",
    "twosided ( plastic ) ( plastic nonlinear=b:true )",
    "twosided ( conductor )",
    "twosided ( roughplastic alpha=f:0.2 ) ( roughplastic distribution=s:ggx )",
];

/// Mutants rejected: the frame of the front on the back of `twosided`; a sample that is found behind a surface; the parameters of
/// one lane in all of them.
#[test]
fn lanes_have_the_bits_of_a_material_alone() {
    let mut random = Uniform::new(1);
    let mut scene = Scene::default();
    let materials: Vec<(&str, Material)> = (etalon_bsdf::test_materials())
        .chain(OTHERS)
        .map(|text| (text, scene.read(text).0.expect("a material")))
        .collect();
    let mut groups = std::collections::BTreeMap::<u8, Vec<_>>::new();
    for material in &materials {
        if let Some(kind) = material.1.lane_kind() {
            groups.entry(kind.0).or_default().push(material);
        }
    }
    assert!(!groups.is_empty());
    for (kind, group) in groups {
        let kind = LaneKind(kind);
        for round in 0..192 * group.len() {
            let mut cases = |width: usize| -> Vec<Case<'_>> {
                let mut case = |lane| {
                    // All lanes alike, and each of its own.
                    let material = match round % 2 {
                        0 => round / 2 % group.len(),
                        _ => (lane + one_of(&mut random, 2)) % group.len(),
                    };
                    Case::draw(group[material], &scene, &mut random)
                };
                (0..width).map(&mut case).collect()
            };
            compare::<f32>(kind, &scene, &cases(1));
            compare::<F32x8>(kind, &scene, &cases(8));
            compare::<F32x16>(kind, &scene, &cases(16));
        }
    }
}
