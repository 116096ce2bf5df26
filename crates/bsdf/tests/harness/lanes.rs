//! Materials that are shaded in vector lanes: lane i has the bits of the same material alone.

use crate::directions::Uniform;
use crate::scene::{Sample, WAVELENGTHS};
use etalon_bsdf::LaneBsdfAtPoint;
use etalon_math::Frame;
use etalon_math::lane::{F32x8, F32x16, Lane, Mask, Spectral, Vector};
use etalon_transport::{Bsdf, BsdfSample, LaneBsdf, LaneVertices, SamplePdf, TransportMode};
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

/// Compares one group of lanes of a material with the material alone.
fn compare<F: Lane>(sample: &Sample, random: &mut Uniform) {
    let Some(kind) = sample.material().lane_kind() else {
        return;
    };
    let lanes = 0..F::WIDTH;
    let frames: Vec<Frame> = (lanes.clone())
        .map(|_| Frame::from_normal((random.direction() + 2.0 * Vec3::Z).normalize()))
        .collect();
    let vertices: Vec<_> = frames.iter().map(|f| crate::scene::vertex(*f)).collect();
    let vertices: Vec<_> = vertices.iter().collect();
    let waves = vec![WAVELENGTHS; F::WIDTH];
    let directions: [Vec<Vec3>; 2] =
        [(); 2].map(|()| lanes.clone().map(|_| random.direction()).collect());
    let [wo, wi] = &directions;
    let lobes: Vec<f32> = lanes.clone().map(|_| random.next()).collect();
    let pairs: Vec<Vec2> = lanes.clone().map(|_| random.pair()).collect();

    let together = LaneBsdfAtPoint::<F>::new(
        kind,
        |_| sample.material(),
        sample.textures(),
        LaneVertices {
            vertices: &vertices,
            wavelengths: &waves,
        },
        F::Vector::of_lanes(|i| wo[i]),
    );
    let out = F::Vector::of_lanes(|i| wo[i]);
    let (value, density) = together.eval_and_density(out, F::Vector::of_lanes(|i| wi[i]));
    let u = [0, 1].map(|axis| F::from_fn(|i| pairs[i][axis]));
    let sampled = together.sample(out, F::load(&lobes), u);
    let hemisphere = together.hemisphere(out);

    for i in lanes {
        let alone = sample.resolve(wo[i], &WAVELENGTHS, frames[i]);
        let text = &sample.text;
        let (v, d) = alone.eval_and_density(wo[i], wi[i], TransportMode::Radiance);
        let of = |v: Vec4, d: Vec4| bits(v.to_array().into_iter().chain(d.to_array()));
        assert_eq!(
            of(value.at_lane(i), density.at_lane(i)),
            of(v, d.lanes()),
            "{text}: value"
        );
        assert_eq!(together.has_continuous(), alone.has_continuous(), "{text}");
        let facing = |n: Vec3| if n.dot(wo[i]) < 0.0 { -n } else { n };
        assert_eq!(
            hemisphere.map(|n| n.at_lane(i)),
            alone.hemisphere().map(|frame| facing(frame.n)),
            "{text}: hemisphere"
        );
        let alone = alone.sample(wo[i], lobes[i], pairs[i], TransportMode::Radiance);
        assert_eq!(sampled.found.lane(i), alone.is_some(), "{text}: found");
        let Some(alone) = alone else { continue };
        let chance = sampled.chance.at_lane(i);
        let of_lane = BsdfSample {
            wi: sampled.wi.at_lane(i),
            value: sampled.value.at_lane(i),
            chance: match sampled.is_delta.lane(i) {
                true => SamplePdf::Discrete(etalon_math::DeltaProbability(chance)),
                false => SamplePdf::Continuous(etalon_math::Density::per_lane(chance)),
            },
            eta: sampled.eta.lane(i),
            is_null: false,
        };
        assert_eq!(of_sample(&of_lane), of_sample(&alone), "{text}: sample");
        assert!(!alone.is_null && alone_is_opaque(sample, wo[i], frames[i]));
    }
}

/// A kind promises that nothing passes straight on.
fn alone_is_opaque(sample: &Sample, wo: Vec3, frame: Frame) -> bool {
    sample.resolve(wo, &WAVELENGTHS, frame).null_probability() == Vec4::ZERO
}

/// Mutants rejected: the frame of the front on the back of `twosided`; a sample that is found behind a surface.
#[test]
fn lanes_have_the_bits_of_a_material_alone() {
    let mut random = Uniform::new(1);
    let materials = Sample::test_materials();
    let kinds: std::collections::HashSet<_> = (materials.iter())
        .filter_map(|sample| sample.material().lane_kind())
        .collect();
    assert!(!kinds.is_empty());
    for sample in &materials {
        for _ in 0..64 {
            compare::<f32>(sample, &mut random);
            compare::<F32x8>(sample, &mut random);
            compare::<F32x16>(sample, &mut random);
        }
    }
}
