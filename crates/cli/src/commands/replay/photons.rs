//! The photons that were gathered around a surface: all, or the brightest.

use super::words::{lanes, line, vector};
use etalon_integrators::replay::Gathered;
use glam::Vec3;

/// How many photons are told one by one.
const TOLD: usize = 8;

/// Adds what is to be said of them.
pub(super) fn gathered(text: &mut String, radius: f32, among: usize, photons: &[Gathered]) {
    let around = format!("    photons that count within {radius} m, of {among} in the map: ");
    let count = photons.len();
    if count == 0 {
        line(text, around + "none");
        return;
    }
    let mut brightest: Vec<&Gathered> = photons.iter().collect();
    line(
        text,
        format!("{around}{count}, together {}", brought(&brightest)),
    );
    let brightness = |gathered: &Gathered| Vec3::from(gathered.rgb).abs().element_sum();
    // What is not a number comes first; equals stay in their order.
    brightest.sort_by(|a, b| brightness(b).total_cmp(&brightness(a)));
    for Gathered { photon, rgb } in brightest.iter().take(TOLD) {
        line(
            text,
            format!(
                "      {} m away at {}, from {}, after {}",
                photon.distance,
                vector(photon.position),
                vector(photon.from),
                segments(photon.segments),
            ),
        );
        line(
            text,
            format!(
                "        wavelengths {} nm, value {}, brings ({}, {}, {})",
                lanes(photon.wavelengths.lambda),
                lanes(photon.scattering),
                rgb[0],
                rgb[1],
                rgb[2]
            ),
        );
    }
    if let Some(rest) = brightest.get(TOLD..).filter(|rest| !rest.is_empty()) {
        let (count, bring) = (rest.len(), brought(rest));
        line(text, format!("      the rest, {count}, together {bring}"));
    }
}

/// What photons bring together.
fn brought(photons: &[&Gathered]) -> String {
    let each = photons.iter().map(|gathered| Vec3::from(gathered.rgb));
    vector(each.sum())
}

fn segments(count: u32) -> String {
    let noun = if count == 1 { "segment" } else { "segments" };
    format!("{count} {noun}")
}
