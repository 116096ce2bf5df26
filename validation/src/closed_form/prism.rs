//! The prism: where a ray of each wavelength leaves it, and how much of it passes.
//!
//! Snell's law at both faces, sin θ = n(λ) sin θ′ with Cauchy's n = A + B/λ² + C/λ⁴ or Sellmeier's
//! n² = 1 + Σ Bλ²/(λ² − C), λ in µm, and Fresnel's transmittance for unpolarised light at both. A camera's ray that starts at x crosses
//! the plane of the lamp at X = x·m(λ) + c(λ): faces are planes, so X is affine in x, and the part
//! of a pixel that sees the lamp at a wavelength is an interval.

use super::light::known;
use crate::claim::Claim;
use etalon_math::float64::{cos, sin};
use etalon_render::judge::ExactImage;
use etalon_spectrum::{cie, colour_space};

/// Half the width of the camera's view (m).
const HALF_WIDTH: f64 = 0.75;
/// Tilt of each face against the camera's film: half the prism's angle (degrees).
const TILT: f64 = 20.0;
/// Height of the front face over the origin; the back face lies as far below.
const FACE: f64 = 0.909_925_586;
/// Height of the lamp.
const LAMP: f64 = -5.0;
/// Step of the integral over wavelengths (nm).
const STEP: f64 = 0.05;

/// The picture of the spectrum.
pub fn picture(claim: &Claim, size: [u32; 2]) -> Result<ExactImage, String> {
    let index = match claim.text("glass") {
        Ok(glass) => index(glass)?,
        Err(_) => index(&samples(claim.text("wavelengths")?, claim.text("indices")?))?,
    };
    let radiance = claim.number("radiance")?;
    let (centre, half_width) = (claim.number("slit")?, claim.number("half_width")?);
    let columns = size[0] as usize;
    let mut xyz = vec![[0.0; 3]; columns];
    let steps = (470.0 / STEP).round() as usize;
    for step in 0..steps {
        let lambda = 360.0 + (step as f64 + 0.5) * STEP;
        let index = index(lambda * lambda * 1e-6);
        let (at_zero, transmittance) = trace(0.0, index);
        let (at_one, _) = trace(1.0, index);
        let slope = at_one - at_zero;
        let ends = [centre - half_width, centre + half_width].map(|x| (x - at_zero) / slope);
        let matching = cie::colour_matching(lambda);
        let weight = radiance * transmittance * STEP / cie::NORMALISATION;
        for (column, sum) in xyz.iter_mut().enumerate() {
            let edge = |i: usize| HALF_WIDTH * (2.0 * i as f64 / columns as f64 - 1.0);
            let (left, right) = (edge(column), edge(column + 1));
            let seen = (right.min(ends[1]) - left.max(ends[0])).max(0.0) / (right - left);
            for (sum, matching) in sum.iter_mut().zip(matching) {
                *sum += weight * seen * matching;
            }
        }
    }
    let colours: Vec<[f64; 3]> = xyz.into_iter().map(colour_space::xyz_to_rgb).collect();
    Ok(known(size, |column, _| colours[column as usize]))
}

/// Sellmeier's coefficients B₁ to B₃ and C₁ to C₃ (µm²) of materials that scenes may call by name, from
/// SCHOTT's data sheets (*Optical Glass*, 2023), and of fused quartz by Malitson (1965).
const GLASSES: [(&str, [f64; 6]); 5] = [
    (
        "bk7",
        [
            1.039_612_12,
            0.231_792_344,
            1.010_469_45,
            0.006_000_698_67,
            0.020_017_914_4,
            103.560_653,
        ],
    ),
    (
        "f2",
        [
            1.345_333_59,
            0.209_073_176,
            0.937_357_162,
            0.009_977_438_71,
            0.047_045_076_7,
            111.886_764,
        ],
    ),
    (
        "n-sf10",
        [
            1.621_539_02,
            0.256_287_842,
            1.644_475_52,
            0.012_224_145_7,
            0.059_573_677_5,
            147.468_793,
        ],
    ),
    (
        "n-sf11",
        [
            1.737_596_95,
            0.313_747_346,
            1.898_781_01,
            0.013_188_707,
            0.062_306_814_2,
            155.236_29,
        ],
    ),
    (
        "fused quartz",
        [
            0.696_166_3,
            0.407_942_6,
            0.897_479_4,
            0.004_679_148_25,
            0.013_512_063,
            97.934_002_5,
        ],
    ),
];

/// The index as a function of λ² (µm²).
type Index = Box<dyn Fn(f64) -> f64>;

/// The index of `cauchy: A B C`, where C may be missing, of `sellmeier: B₁ B₂ B₃ C₁ C₂ C₃`, of
/// `sellmeier: NAME`, or of a table, `λ:n, λ:n, …` (nm).
fn index(glass: &str) -> Result<Index, String> {
    match table(glass) {
        Some(samples) => Ok(Box::new(move |squared| {
            interpolated(&samples, 1e3 * squared.sqrt())
        })),
        None => dispersion_formula(glass),
    }
}

/// A table as text, from its wavelengths and indices.
fn samples(wavelengths: &str, indices: &str) -> String {
    let pairs = wavelengths.split(',').zip(indices.split(','));
    let pairs: Vec<String> = pairs.map(|(l, n)| format!("{l}:{n}")).collect();
    pairs.join(",")
}

/// Pairs of a wavelength (nm) and an index.
fn table(text: &str) -> Option<Vec<[f64; 2]>> {
    let samples = text.split(',').map(|sample| {
        let (lambda, value) = sample.split_once(':')?;
        Some([lambda.trim().parse().ok()?, value.trim().parse().ok()?])
    });
    samples.collect()
}

/// Linear between samples, constant beyond the first and the last.
fn interpolated(samples: &[[f64; 2]], lambda: f64) -> f64 {
    let after = samples.partition_point(|sample| sample[0] <= lambda);
    let [Some(low), Some(high)] = [after.checked_sub(1), Some(after)].map(|i| samples.get(i?))
    else {
        return samples[after.min(samples.len() - 1)][1];
    };
    low[1] + (high[1] - low[1]) * (lambda - low[0]) / (high[0] - low[0])
}

fn dispersion_formula(glass: &str) -> Result<Index, String> {
    let unknown = || format!("`{glass}` is no glass of Cauchy's or Sellmeier's");
    let (law, numbers) = glass.split_once(':').ok_or_else(unknown)?;
    let named = GLASSES.iter().find(|(name, _)| *name == numbers.trim());
    let numbers: Vec<f64> = match named {
        Some((_, coefficients)) => coefficients.to_vec(),
        None => (numbers.split_whitespace())
            .map(|word| word.parse().map_err(|_| unknown()))
            .collect::<Result<_, _>>()?,
    };
    let sellmeier = match (law, numbers.len()) {
        ("sellmeier", 6) => true,
        ("cauchy", 2 | 3) => false,
        _ => return Err(unknown()),
    };
    Ok(Box::new(move |squared: f64| {
        if sellmeier {
            let term = |i: usize| numbers[i] * squared / (squared - numbers[i + 3]);
            return (1.0 + (0..3).map(term).sum::<f64>()).sqrt();
        }
        numbers.iter().rev().fold(0.0, |sum, c| sum / squared + c)
    }))
}

/// Where the ray that starts at `x` and goes straight down crosses the lamp's plane, and how much
/// of it passes both faces.
fn trace(x: f64, index: f64) -> (f64, f64) {
    let tilt = TILT.to_radians();
    let front = [sin(tilt), cos(tilt)];
    let back = [sin(tilt), -cos(tilt)];
    let start = [x, 10.0];
    let (entered, inside, first) = cross(start, [0.0, -1.0], front, FACE, 1.0 / index);
    let (left, outside, second) = cross(entered, inside, back, -FACE, index);
    let t = (LAMP - left[1]) / outside[1];
    (left[0] + t * outside[0], first * second)
}

/// Crosses the plane through (0, `height`) with the outward normal `normal`: the point, the
/// direction behind it, and the transmittance. `ratio` is the index before over the one behind.
fn cross(
    from: [f64; 2],
    direction: [f64; 2],
    normal: [f64; 2],
    height: f64,
    ratio: f64,
) -> ([f64; 2], [f64; 2], f64) {
    let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
    let across = dot(direction, normal);
    let t = dot([-from[0], height - from[1]], normal) / across;
    let point = [from[0] + t * direction[0], from[1] + t * direction[1]];
    // The normal against the ray.
    let facing = if across < 0.0 {
        normal
    } else {
        normal.map(|c| -c)
    };
    let cosine = across.abs();
    let behind = (1.0 - ratio * ratio * (1.0 - cosine * cosine)).sqrt();
    let turn = ratio * cosine - behind;
    let refracted = [
        ratio * direction[0] + turn * facing[0],
        ratio * direction[1] + turn * facing[1],
    ];
    let s = (ratio * cosine - behind) / (ratio * cosine + behind);
    let p = (cosine - ratio * behind) / (cosine + ratio * behind);
    (point, refracted, 1.0 - 0.5 * (s * s + p * p))
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_math::float64::{asin, atan2};

    #[test]
    fn glass_like_air_changes_nothing() {
        let (x, transmittance) = trace(0.3, 1.0);
        assert!((x - 0.3).abs() < 1e-12 && (transmittance - 1.0).abs() < 1e-12);
    }

    #[test]
    fn deviation_is_the_textbooks() {
        // δ = θ + asin(sin A √(n² − sin² θ) − cos A sin θ) − A for the angle of incidence θ and the
        // prism's angle A (Born and Wolf, *Principles of Optics*, section 4.7.2).
        let (theta, apex) = (TILT.to_radians(), 2.0 * TILT.to_radians());
        for index in [1.3, 1.5, 1.7] {
            let turned = sin(apex) * (index * index - sin(theta) * sin(theta)).sqrt();
            let expected = theta + asin(turned - cos(apex) * sin(theta)) - apex;
            let front = [sin(theta), cos(theta)];
            let back = [sin(theta), -cos(theta)];
            let (at, inside, _) = cross([0.0, 9.0], [0.0, -1.0], front, FACE, 1.0 / index);
            let (_, outside, _) = cross(at, inside, back, -FACE, index);
            let deviation = atan2(-outside[0], -outside[1]);
            assert!(
                (deviation - expected).abs() < 1e-12,
                "{deviation} {expected}"
            );
        }
    }

    #[test]
    fn the_flint_has_its_index() {
        // N-SF11 at the yellow line of helium, by its data sheet: 1.78472.
        let glass =
            "sellmeier: 1.73759695 0.313747346 1.89878101 0.013188707 0.0623068142 155.23629";
        let found = index(glass).expect("a glass")(0.587_561_8 * 0.587_561_8);
        assert!((found - 1.784_72).abs() < 1e-5, "{found}");
        let cauchy = index("cauchy: 1.5 0.1 0.01").expect("a glass");
        assert!((cauchy(0.25) - 2.06).abs() < 1e-12);
        assert!(index("cauchy: 1").is_err() && index("bk7").is_err());
    }

    #[test]
    fn tables_are_linear_between_their_samples() {
        let index = index("400:1.7, 500:1.6, 700:1.5").expect("a table");
        let at = |nm: f64| index(nm * nm * 1e-6);
        for (nm, expected) in [(380.0, 1.7), (450.0, 1.65), (600.0, 1.55), (800.0, 1.5)] {
            assert!((at(nm) - expected).abs() < 1e-12, "{nm}");
        }
    }

    #[test]
    fn named_materials_have_their_indices() {
        // At the yellow line of helium, by the data sheets and by Malitson.
        let expected = [1.516_80, 1.620_04, 1.728_28, 1.784_72, 1.458_46];
        for ((name, _), expected) in GLASSES.iter().zip(expected) {
            let found = index(&format!("sellmeier: {name}")).expect("a name");
            let found = found(0.587_561_8 * 0.587_561_8);
            assert!((found - expected).abs() < 1e-5, "{name}: {found}");
        }
    }

    #[test]
    fn at_normal_incidence_fresnel_is_known() {
        let (_, _, transmittance) = cross([0.0, 9.0], [0.0, -1.0], [0.0, 1.0], 0.0, 1.0 / 1.5);
        assert!((transmittance - 0.96).abs() < 1e-12);
    }
}
