//! Tables of BRDFs: what is written is read, what is damaged is refused, warps are inverted by their inverses.

use etalon_math::float;
use etalon_tables::half_vector::{angles, directions};
use etalon_tables::spectral::{self, Grid};
use etalon_tables::tensor_file::Tensor;
use etalon_tables::warp::Warp;
use etalon_tables::write_rgl::{Resolution, write_rgl};
use etalon_tables::{BrdfTable, merl};
use glam::{Vec2, Vec3, Vec4};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use std::f32::consts::{FRAC_1_PI, FRAC_PI_2, PI};

/// A broad lobe about the mirror direction on a diffuse base, redder toward long waves; reciprocal.
fn brdf(wo: Vec3, wi: Vec3, lambda: f32) -> f32 {
    let half = (wo + wi).normalize();
    let lobe = half.z.powi(8);
    (0.3 + 0.2 * lobe) * FRAC_1_PI * (0.5 + lambda / 1660.0)
}

fn spectrum(wo: Vec3, wi: Vec3, wavelengths: &[f32]) -> Vec<f32> {
    wavelengths.iter().map(|&l| brdf(wo, wi, l)).collect()
}

fn rgl_file() -> Vec<u8> {
    let resolution = Resolution {
        phi: 1,
        theta: 12,
        normals: 24,
        square: 20,
        wavelengths: vec![360.0, 600.0, 830.0],
    };
    let value = |wo: Vec3, wi: Vec3| {
        let values = spectrum(wo, wi, &resolution.wavelengths);
        values.into_iter().map(|value| value * wi.z).collect()
    };
    write_rgl(&resolution, value, "a test").expect("it reflects something")
}

fn spectral_file() -> Vec<u8> {
    let grid = Grid::new(16, 16, 3);
    let value = |wo: Vec3, wi: Vec3| spectrum(wo, wi, &grid.wavelengths);
    spectral::write(&grid, value, "a test", Some(0.01))
}

fn merl_file() -> Vec<u8> {
    merl::write([24, 24, 24], |wo, wi| {
        [0.9, 0.5, 0.1].map(|c| c * f64::from(brdf(wo, wi, 830.0)))
    })
}

fn direction(theta: f32, phi: f32) -> Vec3 {
    let ((s, c), (y, x)) = (float::sin_cos(theta), float::sin_cos(phi));
    Vec3::new(s * x, s * y, c)
}

#[test]
fn what_is_written_is_read() {
    let lambda = Vec4::new(400.0, 500.0, 600.0, 700.0);
    for bytes in [rgl_file(), spectral_file()] {
        let table = BrdfTable::parse(&bytes).expect("it was just written");
        let (mut sum, mut greatest) = (0.0, 0.0f32);
        for i in 0..200 {
            let wo = direction(0.013 * (i % 90) as f32, 0.7 * i as f32);
            let wi = direction(0.011 * (i % 97) as f32, 1.1 * i as f32);
            let (value, _) = table.at(lambda).eval_and_density(wo, wi);
            for lane in 0..4 {
                let expected = brdf(wo, wi, lambda[lane]) * wi.z;
                let off = (value[lane] - expected).abs() / expected;
                sum += off / 800.0;
                greatest = greatest.max(off);
            }
        }
        // What the few nodes leave; a wrong axis or scale is off by tens of per cent.
        assert!(sum < 0.02 && greatest < 0.15, "{sum} {greatest}");
    }
}

#[test]
fn colours_of_merl_are_read() {
    let BrdfTable::Merl(table) = BrdfTable::parse(&merl_file()).expect("it was just written")
    else {
        panic!("the beginning says MERL");
    };
    for i in 0..200 {
        let wo = direction(0.013 * (i % 90) as f32, 0.7 * i as f32);
        let wi = direction(0.011 * (i % 97) as f32, 1.1 * i as f32);
        let expected = Vec3::new(0.9, 0.5, 0.1) * brdf(wo, wi, 830.0);
        let off = (table.brdf(wo, wi) - expected).abs();
        assert!(
            off.cmple(expected * 0.02).all(),
            "{wo} {wi}: {off} of {expected}"
        );
    }
}

#[test]
fn no_beginning_of_a_file_is_a_file() {
    for bytes in [rgl_file(), spectral_file(), merl_file()] {
        let step = (bytes.len() / 400).max(1);
        for end in (0..bytes.len()).step_by(step).chain([bytes.len() - 1]) {
            assert!(
                BrdfTable::parse(&bytes[..end]).is_err(),
                "{end} of {} bytes",
                bytes.len()
            );
        }
    }
}

#[test]
fn announced_sizes_allocate_nothing() {
    // MERL: three dimensions that multiply to terabytes.
    let mut merl: Vec<u8> = [4000i32, 4000, 4000]
        .iter()
        .flat_map(|n| n.to_le_bytes())
        .collect();
    merl.extend([0; 64]);
    assert!(BrdfTable::parse(&merl).is_err());
    // A field of 2⁶⁰ numbers.
    let mut bytes = rgl_file();
    let name = bytes
        .windows(5)
        .position(|w| w == b"phi_i")
        .expect("a field");
    bytes[name + 5 + 2 + 1 + 8 + 7] = 0x10;
    let said = BrdfTable::parse(&bytes).expect_err("too long").to_string();
    assert!(said.contains("`phi_i` ends at byte"), "{said}");
}

#[test]
fn numbers_that_are_none_are_refused() {
    // A spectral table ends with its stated error, RGL's with a byte after the spectra.
    for (bytes, after) in [(rgl_file(), 1), (spectral_file(), 0), (merl_file(), 0)] {
        let mut bytes = bytes;
        let end = bytes.len() - after;
        bytes[end - 4..end].fill(0xff);
        assert!(BrdfTable::parse(&bytes).is_err());
    }
}

#[test]
fn half_vectors_and_differences_give_their_directions_back() {
    for i in 0..500 {
        let theta_h = FRAC_PI_2 * ((i % 19) as f32 + 0.3) / 20.0;
        let theta_d = FRAC_PI_2 * ((i % 23) as f32 + 0.4) / 24.0;
        let phi_d = PI * ((i % 29) as f32 + 0.5) / 30.0;
        let [wo, wi] = directions(theta_h, theta_d, phi_d);
        let [h, d, p] = angles(wo, wi).expect("not opposite");
        let off = [(h - theta_h).abs(), (d - theta_d).abs(), (p - phi_d).abs()];
        assert!(off.iter().all(|&off| off < 1e-4), "{h} {d} {p}: {off:?}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 400,
        rng_seed: RngSeed::Fixed(7),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn warps_are_inverted(
        nodes in prop::collection::vec(0.05f32..4.0, 2 * 5 * 6),
        u in (0.001f32..0.999, 0.001f32..0.999),
        place in 0.0f32..1.0,
    ) {
        let tensor = Tensor { shape: vec![2, 5, 6], data: nodes };
        let warp = Warp::new([vec![0.0, 1.0]], tensor).expect("the shape is right").normalised();
        let slices = warp.slices([place]);
        let u = Vec2::from(u);
        let (point, density) = warp.sample(u, &slices);
        let (back, same) = warp.invert(point, &slices);
        prop_assert!((back - u).abs().max_element() < 2e-4, "{u} {point} {back}");
        prop_assert!((density - same).abs() < 2e-3 * density);
        // The density is the Jacobian of the inverse.
        let step = 1e-3;
        let moved = |d: Vec2| warp.invert(point + d, &slices).0 - warp.invert(point - d, &slices).0;
        let (x, y) = (moved(Vec2::new(step, 0.0)), moved(Vec2::new(0.0, step)));
        let jacobian = x.perp_dot(y).abs() / (4.0 * step * step);
        prop_assert!((jacobian - density).abs() < 0.05 * density + 0.02, "{jacobian} {density}");
    }

    #[test]
    fn noise_is_no_table(bytes in prop::collection::vec(any::<u8>(), 0..200), flips in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8)) {
        let _ = BrdfTable::parse(&bytes);
        let mut damaged = spectral_file();
        for (at, byte) in flips {
            let at = at.index(300);
            damaged[at] = byte;
        }
        // Whatever comes of it, it is an answer.
        let _ = BrdfTable::parse(&damaged);
    }
}
