//! Writes a BRDF as the RGL material database does (see [`crate::rgl`]).
//!
//! The density of normals is estimated from what goes back to where it came from: in a microfacet model
//! f(ω, ω) cos²θ ≈ F D(ω)/4. Any density would do: the spectra are the exact ratio to it, so that a poor estimate costs
//! resolution and nothing else. A tenth of it is uniform, so that it is zero nowhere.

use crate::BrdfTableError;
use crate::rgl::{jacobian_of_normals, unit_to_elevation};
use crate::tensor_file::{self, Array, Tensor};
use crate::warp::{Slices, Warp};
use core::f32::consts::{FRAC_1_PI, PI, TAU};
use etalon_math::float;
use etalon_math::reflection::reflect;
use glam::{Vec2, Vec3};

/// How finely to tabulate.
#[derive(Clone, Debug, PartialEq)]
pub struct Resolution {
    /// Azimuths of the known direction: 1 for an isotropic material.
    pub phi: usize,
    /// Its elevations.
    pub theta: usize,
    /// Nodes along either side of the square of normals.
    pub normals: usize,
    /// Nodes along either side of the square of spectra.
    pub square: usize,
    /// Wavelengths, nm.
    pub wavelengths: Vec<f32>,
}

/// Elevation of the last known direction, rad: short of the horizon, where nothing is visible.
const LAST_ELEVATION: f32 = 1.55;

/// Nodes along a side of the grids over which projected areas are integrated.
const QUADRATURE: usize = 256;

fn tensor(shape: &[usize], data: Vec<f32>) -> Tensor {
    Tensor {
        shape: shape.to_vec(),
        data,
    }
}

/// The node `i` of `count` on [0, 1].
fn node(i: usize, count: usize) -> f32 {
    i as f32 / (count.max(2) - 1) as f32
}

/// The direction at a point of the square, its azimuth counted from `phi`.
fn direction(u: Vec2, phi: f32) -> Vec3 {
    let (sin, cos) = float::sin_cos(unit_to_elevation(u.x));
    let (y, x) = float::sin_cos(u.y * TAU - PI + phi);
    Vec3::new(sin * x, sin * y, cos)
}

/// The points of a square's nodes, row by row.
fn nodes(width: usize, height: usize) -> impl Iterator<Item = Vec2> {
    (0..height)
        .flat_map(move |y| (0..width).map(move |x| Vec2::new(node(x, width), node(y, height))))
}

/// The bytes of a file for a material whose spectrum toward `wi` seen from `wo` (with the cosine of `wi`, at each of the
/// wavelengths) is `spectrum`.
///
/// # Errors
/// If the material reflects nothing.
pub fn write_rgl(
    resolution: &Resolution,
    spectrum: impl Fn(Vec3, Vec3) -> Vec<f32>,
    description: &str,
) -> Result<Vec<u8>, BrdfTableError> {
    let Resolution {
        phi,
        theta,
        normals,
        square,
        wavelengths,
    } = resolution;
    let (n_phi, n_theta, n, k) = (*phi, (*theta).max(2), *normals, *square);
    // One row of azimuths is enough where nothing depends on them, and two make a table.
    let rows = if n_phi > 1 { n } else { 2 };
    let mean = |values: &[f32]| values.iter().sum::<f32>() / values.len() as f32;

    let back = |u: Vec2| {
        let m = direction(u, 0.0);
        let m = Vec3::new(m.x, m.y, m.z.max(1e-3)).normalize();
        4.0 * m.z * mean(&spectrum(m, m))
    };
    let mut density: Vec<f32> = nodes(n, rows).map(back).collect();
    let raw = Warp::new([], tensor(&[rows, n], density.clone()))?;
    let projected = projected_area(&raw, Vec3::Z);
    for value in &mut density {
        let lobe = if projected > 0.0 {
            *value / projected
        } else {
            FRAC_1_PI
        };
        *value = 0.9 * lobe + 0.1 * FRAC_1_PI;
    }
    let ndf = Warp::new([], tensor(&[rows, n], density.clone()))?;
    let sigma: Vec<f32> = nodes(n, rows)
        .map(|u| projected_area(&ndf, direction(u, 0.0)))
        .collect();
    let area = Warp::new([], tensor(&[rows, n], sigma.clone()))?;

    let phi_i: Vec<f32> = match n_phi {
        0 | 1 => vec![0.0],
        _ => (0..n_phi).map(|i| TAU * node(i, n_phi) - PI).collect(),
    };
    let theta_i: Vec<f32> = (0..n_theta)
        .map(|i| LAST_ELEVATION * node(i, n_theta))
        .collect();
    let known: Vec<(f32, f32)> = (phi_i.iter())
        .flat_map(|&phi| theta_i.iter().map(move |&theta| (phi, theta)))
        .collect();
    let isotropic = phi_i.len() == 1;
    // Normals count their azimuth from the known direction's if the material is isotropic: that is 0 then.
    let mut vndf = Vec::new();
    for &(phi, theta) in &known {
        let wo = tilted(theta, phi);
        vndf.extend(nodes(n, n).map(|u| {
            let visible = direction(u, 0.0).dot(wo).max(0.0);
            ndf.eval(u, &Slices::ONLY) * visible * jacobian_of_normals(u.x)
        }));
    }
    let visible = Warp::new(
        [phi_i.clone(), theta_i.clone()],
        tensor(&[phi_i.len(), n_theta, n, n], vndf.clone()),
    )?
    .normalised();

    let bands = wavelengths.len();
    let mut spectra = Vec::with_capacity(known.len() * bands * k * k);
    let mut luminance = Vec::with_capacity(known.len() * k * k);
    for &(phi, theta) in &known {
        let wo = tilted(theta, phi);
        let slices = visible.slices([phi, theta]);
        let turn = if isotropic { 0.5 } else { (phi + PI) / TAU };
        let u_wo = Vec2::new(crate::rgl::elevation_to_unit(theta), turn);
        let sigma = area.eval(u_wo, &Slices::ONLY);
        let ratios: Vec<Vec<f32>> = nodes(k, k)
            .map(|u| {
                let (u_normal, _) = visible.sample(u.min(Vec2::splat(1.0 - 1e-6)), &slices);
                let wi = reflect(wo, direction(u_normal, 0.0));
                let scale = 4.0 * sigma / ndf.eval(u_normal, &Slices::ONLY);
                if wi.z > 0.0 {
                    spectrum(wo, wi).iter().map(|v| v * scale).collect()
                } else {
                    vec![0.0; bands]
                }
            })
            .collect();
        luminance.extend(ratios.iter().map(|values| mean(values)));
        for band in 0..bands {
            spectra.extend(ratios.iter().map(|values| values[band]));
        }
    }
    let (p, t) = (phi_i.len(), n_theta);
    Ok(tensor_file::write(&[
        ("description", Array::Bytes(description.as_bytes())),
        ("phi_i", Array::Floats(&phi_i, &[p])),
        ("theta_i", Array::Floats(&theta_i, &[t])),
        ("wavelengths", Array::Floats(wavelengths, &[bands])),
        ("ndf", Array::Floats(&density, &[rows, n])),
        ("sigma", Array::Floats(&sigma, &[rows, n])),
        ("vndf", Array::Floats(&vndf, &[p, t, n, n])),
        ("luminance", Array::Floats(&luminance, &[p, t, k, k])),
        ("spectra", Array::Floats(&spectra, &[p, t, bands, k, k])),
        ("jacobian", Array::Bytes(&[1])),
    ]))
}

/// The direction at an elevation and an azimuth.
fn tilted(theta: f32, phi: f32) -> Vec3 {
    let ((s, c), (y, x)) = (float::sin_cos(theta), float::sin_cos(phi));
    Vec3::new(s * x, s * y, c)
}

/// ∫ D(m) max(0, ω·m) dm, by the midpoint rule over the square.
fn projected_area(density: &Warp<0>, w: Vec3) -> f32 {
    let cells = QUADRATURE * QUADRATURE;
    let sum: f64 = (0..cells)
        .map(|i| {
            let cell = Vec2::new((i % QUADRATURE) as f32, (i / QUADRATURE) as f32);
            let u = (cell + 0.5) / QUADRATURE as f32;
            let visible = direction(u, 0.0).dot(w).max(0.0);
            f64::from(density.eval(u, &Slices::ONLY) * visible * jacobian_of_normals(u.x))
        })
        .sum();
    (sum / cells as f64) as f32
}
