//! The CIE's standard illuminants by name, each scaled to luminance Y = 1 (see [`crate::illuminants`]).
//!
//! A daylight of the correlated colour temperature T is S₀ + M₁ S₁ + M₂ S₂, with M₁ and M₂ such that its chromaticity is
//!
//! ```text
//! x = −4.6070·10⁹/T³ + 2.9678·10⁶/T² + 0.09911·10³/T + 0.244063        4000 K ≤ T ≤ 7000 K
//! x = −2.0064·10⁹/T³ + 1.9018·10⁶/T² + 0.24748·10³/T + 0.237040        7000 K < T ≤ 25000 K
//! y = −3.000 x² + 2.870 x − 0.275
//! ```
//!
//! (CIE 015:2018, equations 4.6 to 4.11). `D50` means 5003 K, as the radiation constant has changed since.

use crate::illuminants::{self, FLUORESCENT_RANGE, tabulated};
use crate::tables::lamps::{DAYLIGHT, LEDS, OLD_DAYLIGHT};
use crate::{LAMBDA_MAX, LAMBDA_MIN, Regular};

/// Ratio of the second radiation constant today to that when the daylights were named.
const RENAMED: f64 = 1.4388 / 1.4380;

/// The names, for messages.
pub const NAMES: &str = "`A`, `B`, `C`, `D50`, `D65` and so on, `D` and a temperature from 4000 to 25000, `E`, `F1` to `F12`, \
                         `LED-B1` to `LED-B5`, `LED-BH1`, `LED-RGB1`, `LED-V1`, `LED-V2`";

/// The illuminant of a name ([`NAMES`]), upper or lower case; `None` if there is none.
pub fn named(name: &str) -> Option<Regular> {
    let name = name.to_ascii_uppercase();
    match name.as_str() {
        "A" => return sampled(illuminants::a),
        "B" => return tabulated(FLUORESCENT_RANGE, &OLD_DAYLIGHT[0]).ok(),
        "C" => return tabulated(FLUORESCENT_RANGE, &OLD_DAYLIGHT[1]).ok(),
        "D65" => return Some(illuminants::d65_spectrum()),
        "E" => return sampled(|_| 1.0),
        _ => {}
    }
    if let Some((_, values)) = LEDS.iter().find(|(led, _)| *led == name) {
        return tabulated(FLUORESCENT_RANGE, values).ok();
    }
    if let Some(number) = name.strip_prefix('F') {
        return illuminants::fluorescent(number.parse().ok()?);
    }
    let number = name.strip_prefix('D')?;
    let temperature: f64 = number.parse().ok()?;
    match number.len() {
        2 => daylight(100.0 * temperature * RENAMED),
        4 | 5 => daylight(temperature),
        _ => None,
    }
}

/// A function of the wavelength, every 5 nm.
fn sampled(power: impl Fn(f64) -> f64) -> Option<Regular> {
    let values: Vec<f64> = (0..95)
        .map(|i| power(LAMBDA_MIN + 5.0 * f64::from(i)))
        .collect();
    tabulated([LAMBDA_MIN, LAMBDA_MAX], &values).ok()
}

/// The daylight of a correlated colour temperature in kelvin; `None` unless it is 4000 to 25000.
pub fn daylight(temperature: f64) -> Option<Regular> {
    if !(4000.0..=25000.0).contains(&temperature) {
        return None;
    }
    let k = 1e3 / temperature;
    let x = if temperature <= 7000.0 {
        ((-4.6070 * k + 2.9678) * k + 0.09911) * k + 0.244063
    } else {
        ((-2.0064 * k + 1.9018) * k + 0.24748) * k + 0.237040
    };
    let y = (-3.0 * x + 2.870) * x - 0.275;
    let m = 0.0241 + 0.2562 * x - 0.7341 * y;
    let m1 = (-1.3515 - 1.7703 * x + 5.9114 * y) / m;
    let m2 = (0.0300 - 31.4424 * x + 30.0717 * y) / m;
    let [s0, s1, s2] = &DAYLIGHT;
    let power = |lambda: f64| {
        let place = (lambda - LAMBDA_MIN) / 10.0;
        let i = (place as usize).min(s0.len() - 2);
        let t = place - i as f64;
        let at = |i: usize| s0[i] + m1 * s1[i] + m2 * s2[i];
        at(i) + (at(i + 1) - at(i)) * t
    };
    sampled(power)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cie;
    use glam::Vec4;

    /// Chromaticities that the CIE publishes (CIE 015:2018, tables 3, 10.1 and 12.1).
    #[test]
    fn chromaticities_are_the_published_ones() {
        for (name, x, y) in [
            ("A", 0.44758, 0.40745),
            ("B", 0.34842, 0.35161),
            ("c", 0.31006, 0.31616),
            ("D50", 0.34567, 0.35850),
            ("D55", 0.33243, 0.34744),
            ("D65", 0.31272, 0.32903),
            ("D6504", 0.31272, 0.32903),
            ("D75", 0.29903, 0.31488),
            ("E", 0.33333, 0.33333),
            ("F11", 0.38052, 0.37713),
            ("LED-B3", 0.3756, 0.3723),
            ("LED-RGB1", 0.4557, 0.4211),
            ("LED-V2", 0.3781, 0.3775),
        ] {
            let spectrum = named(name).expect(name);
            let xyz = cie::xyz(|lambda| f64::from(spectrum.eval(Vec4::splat(lambda as f32)).x));
            let sum: f64 = xyz.iter().sum();
            let off = [xyz[0] / sum - x, xyz[1] / sum - y];
            assert!(off.iter().all(|d| d.abs() < 3e-4), "{name}: {off:?}");
            assert!((xyz[1] - 1.0).abs() < 1e-4, "{name}: Y = {}", xyz[1]);
        }
        for name in [
            "", "F0", "F13", "D", "D3000", "D30", "LED", "G", "D99999", "Dx",
        ] {
            assert!(named(name).is_none(), "{name}");
        }
    }
}
