//! BRDFs of the RGL material database, in the adaptive parameterisation in which they were measured.
//!
//! ```text
//! f(ωi, ωo) cos θo = s(v⁻¹(u_m; θi, φi); θi, φi, λ) D(u_m) / (4 σ(u_i))         u = (√(2θ/π), (φ + π)/2π)
//! ```
//!
//! ωm is half-way between the directions; D, the density of normals, and σ, its projected area, are tables over the
//! square u; v is the warp from the unit square to the normals visible from ωi; s are the measured spectra over the
//! square *before* that warp, where a lobe that is sharp in angle is smooth. ωi is here the known direction. Dupuy and
//! Jakob (2018), *An Adaptive Parameterization for Efficient Material Acquisition and Rendering*, eqs. 8, 16 and 17.
//! Isotropic materials have φi at one or two places only, and φm counts from φi; some anisotropic ones were measured
//! over a half or a quarter of the circle, and the rest follows by mirror images.
//!
//! Sampled by a table of the spectra's brightness over the same square, then by the visible normals.

use crate::BrdfTableError;
use crate::tensor_file::TensorFile;
use crate::warp::{Slices, Warp};
use core::f32::consts::{FRAC_PI_2, PI, TAU};
use etalon_math::float;
use etalon_math::reflection::{half_way, reflect};
use glam::{Vec2, Vec3, Vec4};

/// A measured material.
#[derive(Clone, Debug)]
pub struct Rgl {
    normals: Warp<0>,
    area: Warp<0>,
    visible: Warp<2>,
    brightness: Warp<2>,
    spectra: Warp<3>,
    isotropic: bool,
    /// How often the measured part of the circle of φi fits into it: 1, 2 or 4.
    reduction: u32,
    /// A direction in the middle of that part.
    middle: Vec2,
    /// Whether the spectra leave out D / (4σ).
    has_jacobian: bool,
}

/// The square's coordinate of an elevation.
#[inline]
pub(crate) fn elevation_to_unit(theta: f32) -> f32 {
    (theta / FRAC_PI_2).max(0.0).sqrt()
}

/// The elevation at a coordinate of the square.
#[inline]
pub(crate) fn unit_to_elevation(u: f32) -> f32 {
    u * u * FRAC_PI_2
}

/// Angle to the z axis, exact where it is small.
#[inline]
fn elevation(v: Vec3) -> f32 {
    float::atan2(v.truncate().length(), v.z)
}

/// A pair of directions in the coordinates of the tables.
struct Place {
    /// Cosine to the normal half-way.
    cos: f32,
    u_wo: Vec2,
    u_normal: Vec2,
    /// The slices of tables with the parameters φi, θi.
    slices: Slices,
}

impl Rgl {
    /// A `.bsdf` file of the database.
    ///
    /// # Errors
    /// If a field is missing, has a wrong shape or a number that is not finite.
    pub fn parse(file: &TensorFile<'_>) -> Result<Self, BrdfTableError> {
        let phi = file.abscissae("phi_i")?;
        let theta = file.abscissae("theta_i")?;
        let wavelengths = file.abscissae("wavelengths")?;
        let isotropic = phi.len() <= 2;
        let reduction = if isotropic {
            1
        } else {
            (TAU / (phi[phi.len() - 1] - phi[0])).round() as u32
        };
        if !matches!(reduction, 1 | 2 | 4) {
            return Err(BrdfTableError::new(format!(
                "`phi_i` goes from {} to {}: neither a circle, nor a half or a quarter of one",
                phi[0],
                phi[phi.len() - 1]
            )));
        }
        let (y, x) = float::sin_cos(0.5 * (phi[0] + phi[phi.len() - 1]));
        let jacobian = file.bytes("jacobian")?.first().copied();
        Ok(Self {
            normals: Warp::new([], file.tensor("ndf", 2)?)?,
            area: Warp::new([], file.tensor("sigma", 2)?)?,
            visible: Warp::new([phi.clone(), theta.clone()], file.tensor("vndf", 4)?)?.normalised(),
            brightness: Warp::new([phi.clone(), theta.clone()], file.tensor("luminance", 4)?)?
                .normalised(),
            spectra: Warp::new([phi, theta, wavelengths], file.tensor("spectra", 5)?)?,
            isotropic,
            reduction,
            middle: Vec2::new(x, y),
            has_jacobian: jacobian.unwrap_or(1) != 0,
        })
    }

    /// `v` after the turn, or the mirror images, that bring `wo` into the part of the circle that was measured.
    #[inline]
    fn mirrored(&self, wo: Vec3, v: Vec3) -> Vec3 {
        let across = Vec2::select(
            (wo.truncate() * self.middle).cmplt(Vec2::ZERO),
            Vec2::NEG_ONE,
            Vec2::ONE,
        );
        let signs = match self.reduction {
            1 => Vec2::ONE,
            2 => Vec2::splat(across.y),
            _ => across,
        };
        (v.truncate() * signs).extend(v.z)
    }

    /// The slices for a direction, and its azimuth.
    #[inline]
    fn known(&self, wo: Vec3) -> (Slices, f32, f32) {
        let (theta, phi) = (elevation(wo), float::atan2(wo.y, wo.x));
        (self.visible.slices([phi, theta]), theta, phi)
    }

    fn place(&self, wo: Vec3, wi: Vec3) -> Option<Place> {
        if !(wo.z > 0.0 && wi.z > 0.0) {
            return None;
        }
        let wi = self.mirrored(wo, wi);
        let wo = self.mirrored(wo, wo);
        let (normal, cos) = half_way(wo, wi)?;
        let (slices, theta, phi) = self.known(wo);
        let mut azimuth = float::atan2(normal.y, normal.x);
        if self.isotropic {
            azimuth -= phi;
        }
        let turn = (azimuth + PI) / TAU;
        Some(Place {
            cos,
            u_wo: Vec2::new(elevation_to_unit(theta), (phi + PI) / TAU),
            u_normal: Vec2::new(elevation_to_unit(elevation(normal)), turn - turn.floor()),
            slices,
        })
    }

    /// Value (with the cosine of `wi`) at four wavelengths, and density of [`Rgl::sample`].
    pub fn eval_and_density(&self, wo: Vec3, wi: Vec3, lambda: Vec4) -> (Vec4, f32) {
        let Some(place) = self.place(wo, wi) else {
            return (Vec4::ZERO, 0.0);
        };
        let (square, visible) = self.visible.invert(place.u_normal, &place.slices);
        let lane = |lambda: f32| {
            let slices = self.spectra.with_last(&place.slices, lambda);
            self.spectra.eval(square, &slices)
        };
        let mut value = Vec4::from_array(lambda.to_array().map(lane)).max(Vec4::ZERO);
        if self.has_jacobian {
            let density = self.normals.eval(place.u_normal, &Slices::ONLY);
            let area = self.area.eval(place.u_wo, &Slices::ONLY);
            value *= (density / (4.0 * area)).max(0.0);
        }
        let brightness = self.brightness.eval(square, &place.slices);
        // A mirrored direction covers 4 (ωi · ωm) times the solid angle of its normal.
        let jacobian = jacobian_of_normals(place.u_normal.x).max(1e-6);
        let mirrored = 4.0 * place.cos;
        (value, visible * brightness / (jacobian * mirrored))
    }

    /// A direction for the known `wo`; `None` if it falls below the surface.
    pub fn sample(&self, wo: Vec3, u: Vec2) -> Option<Vec3> {
        if !(wo.z > 0.0) {
            return None;
        }
        let known = self.mirrored(wo, wo);
        let (slices, _, phi) = self.known(known);
        let (square, _) = self.brightness.sample(u, &slices);
        let (u_normal, _) = self.visible.sample(square, &slices);
        let mut azimuth = u_normal.y * TAU - PI;
        if self.isotropic {
            azimuth += phi;
        }
        let (sin, cos) = float::sin_cos(unit_to_elevation(u_normal.x));
        let (y, x) = float::sin_cos(azimuth);
        let normal = self.mirrored(wo, Vec3::new(sin * x, sin * y, cos));
        let wi = reflect(wo, normal);
        (wi.z > 0.0).then_some(wi)
    }
}

/// d ωm / d(square): with θ = u²π/2 a normal's solid angle is 2π² u sin θ per area.
#[inline]
pub(crate) fn jacobian_of_normals(u: f32) -> f32 {
    2.0 * PI * PI * u * float::sin(unit_to_elevation(u))
}
