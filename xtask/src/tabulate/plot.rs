//! A material in its plane of incidence, as a polar plot in SVG.

use super::direction;
use super::model::Model;
use etalon_math::float;
use maud::html;
use std::f32::consts::{FRAC_PI_2, PI};
use std::fmt::Write as _;

/// Elevations of the known direction, degrees, and the colour of each curve (Okabe and Ito's palette).
const SEEN_FROM: [(f32, &str); 4] = [
    (0.0, "#0072b2"),
    (30.0, "#009e73"),
    (60.0, "#e69f00"),
    (80.0, "#d55e00"),
];

/// Wavelength shown, nm.
const WAVELENGTH: f32 = 550.0;

const WIDTH: f32 = 760.0;
const RADIUS: f32 = 340.0;
const CENTRE: [f32; 2] = [380.0, 425.0];

/// Values of f cos θi at 1024 elevations from one horizon to the other, in the plane of `wo`.
fn section(model: &Model, theta_o: f32) -> Vec<(f32, f32)> {
    let wo = direction(theta_o.to_radians(), PI);
    (0..=1024)
        .map(|i| {
            let angle = PI * (i as f32 / 1024.0 - 0.5) * 0.9999;
            let wi = direction(angle.abs(), if angle < 0.0 { PI } else { 0.0 });
            (angle, model.value(wo, wi, &[WAVELENGTH])[0])
        })
        .collect()
}

/// Where a value lies in the picture: the radius grows with its cube root, so that lobe and base can both be seen.
fn place(angle: f32, value: f32, greatest: f32) -> [f32; 2] {
    let radius = RADIUS * float::cbrt(value / greatest);
    let (s, c) = float::sin_cos(angle);
    [CENTRE[0] + radius * s, CENTRE[1] - radius * c]
}

/// The plot.
pub(super) fn polar(model: &Model, title: &str) -> String {
    let sections = SEEN_FROM.map(|(theta, _)| section(model, theta));
    let greatest = (sections.iter().flatten()).fold(f32::MIN_POSITIVE, |top, (_, v)| top.max(*v));
    let lines: Vec<String> = (sections.iter())
        .map(|section| {
            let mut line = String::new();
            for &(angle, value) in section {
                let [x, y] = place(angle, value, greatest);
                let _ = write!(line, "{x:.2},{y:.2} ");
            }
            line
        })
        .collect();
    let rings = [0.01, 0.1, 1.0].map(|share: f32| (RADIUS * float::cbrt(share), share * greatest));
    let spokes = (-3..=3).map(|i| {
        (
            30 * i,
            place(FRAC_PI_2 * i as f32 / 3.0, greatest, greatest),
        )
    });
    let subtitle = format!(
        "f cos θi in the plane of incidence at {WAVELENGTH} nm (sr⁻¹); seen from the left; radius by the cube root"
    );
    let drawn = html! {
        svg xmlns="http://www.w3.org/2000/svg" viewBox={ "0 0 " (WIDTH) " 500" } font-family="sans-serif" font-size="13" {
            rect width=(WIDTH) height="500" fill="white" {}
            text x="20" y="26" font-size="16" { (title) }
            text x="20" y="46" fill="#555" { (subtitle) }
            @for (radius, value) in rings {
                path fill="none" stroke="#ccc" d={ "M" (CENTRE[0] - radius) " " (CENTRE[1]) "A" (radius) " " (radius) " 0 0 1 " (CENTRE[0] + radius) " " (CENTRE[1]) } {}
                text x=(CENTRE[0] + radius) y=(CENTRE[1] + 16.0) text-anchor="middle" fill="#777" font-size="11" { (format!("{value:.3}")) }
            }
            @for (degrees, [x, y]) in spokes {
                line x1=(CENTRE[0]) y1=(CENTRE[1]) x2=(x) y2=(y) stroke="#ddd" {}
                text x=(CENTRE[0] + (x - CENTRE[0]) * 1.05) y=(CENTRE[1] + (y - CENTRE[1]) * 1.04) text-anchor="middle" fill="#777" font-size="11" { (degrees) "°" }
            }
            @for (line, (_, colour)) in lines.iter().zip(SEEN_FROM) {
                polyline fill="none" stroke=(colour) stroke-width="2" points=(line) {}
            }
            @for (i, (theta, colour)) in SEEN_FROM.iter().enumerate() {
                line x1=(20 + 110 * i) x2=(44 + 110 * i) y1="474" y2="474" stroke=(colour) stroke-width="3" {}
                text x=(50 + 110 * i) y="479" { "θo = " (theta) "°" }
            }
        }
    };
    drawn.into_string()
}
