//! `sggx`: matter of flakes that mirror, whose normals are distributed as on an ellipsoid: fibres, cloth, bark,
//!
//! ```text
//! σ(ω) = √(ωᵀ S ω)                         the area that a flake shows to ω
//! D(m) = 1 / (π √|S| (mᵀ S⁻¹ m)²)          the normals
//! p(ωo, ωi) = D(h) / (4 σ(ωo)),            h = (ωo + ωi)/|ωo + ωi|
//! ```
//!
//! (E. Heitz, J. Dupuy, C. Crassin, C. Dachsbacher, The SGGX microflake distribution, 2015, eqs. 5, 16 and 20; sampled exactly by
//! the visible normals, ibid., section 4.3.) A medium of them is as dense as they show area: its σt is times σ(ω), and so depends on
//! where light goes. `S` is given by its six numbers xx, yy, zz, xy, xz, yz, as a `.vol` of six channels, or is one
//! number times the identity.

use crate::phases::{PhaseModel, PhasePoint};
use etalon_math::{Density, Frame, SolidAngle, float};
use etalon_params::{Params, Value};
use etalon_transport::{Build, PhaseSample, SpectrumKind, TextureId, TexturePoint, Textures};
use glam::{Mat3, Vec2, Vec3, Vec4};
use std::f32::consts::{PI, TAU};

/// Added to the diagonal of S, so that its inverse exists.
const LEAST: f32 = 1e-6;

/// The phase function of flakes.
#[derive(Clone, Debug, PartialEq)]
pub enum Sggx {
    /// The same everywhere.
    Even(Mat3),
    /// A volume of six channels: xx, yy, zz, and xy, xz, yz.
    Varying([TextureId; 2]),
}

/// S of its diagonal and of xy, xz, yz.
fn symmetric(diagonal: Vec3, beside: Vec3) -> Mat3 {
    let d = diagonal + LEAST;
    Mat3::from_cols(
        Vec3::new(d.x, beside.x, beside.y),
        Vec3::new(beside.x, d.y, beside.z),
        Vec3::new(beside.y, beside.z, d.z),
    )
}

/// |S| S⁻¹, which exists even if |S| = 0.
fn adjugate(s: &Mat3) -> Mat3 {
    Mat3::from_cols(
        s.y_axis.cross(s.z_axis),
        s.z_axis.cross(s.x_axis),
        s.x_axis.cross(s.y_axis),
    )
}

/// σ(ω).
fn area(s: &Mat3, direction: Vec3) -> f32 {
    float::safe_sqrt(direction.dot(*s * direction))
}

/// D(h) / (4 σ(ωo)).
fn value(s: &Mat3, wo: Vec3, wi: Vec3) -> f32 {
    let Some(h) = (wo + wi).try_normalize() else {
        return 0.0;
    };
    let determinant = s.determinant().max(0.0);
    let squared = h.dot(adjugate(s) * h);
    let area = area(s, wo);
    if !(squared > 0.0 && area > 0.0) {
        return 0.0;
    }
    // √|S|³ / (π (mᵀ |S|S⁻¹ m)²), in an order that does not leave the range of numbers.
    let part = determinant / squared;
    part * part / (determinant.sqrt() * 4.0 * PI * area)
}

/// A normal that is seen from `wo`, of unit length.
fn visible_normal(s: &Mat3, wo: Vec3, u: Vec2) -> Option<Vec3> {
    let frame = Frame::from_normal(wo);
    let (k, j) = (frame.s, frame.t);
    let along = |a: Vec3, b: Vec3| a.dot(*s * b);
    let (s_jj, s_ii) = (along(j, j), along(wo, wo));
    let (s_kj, s_ki, s_ji) = (along(k, j), along(k, wo), along(j, wo));
    let determinant = s.determinant().max(0.0).sqrt();
    let minor = float::safe_sqrt(s_jj * s_ii - s_ji * s_ji);
    let inverse = 1.0 / s_ii.sqrt();
    // A point of the half of the unit sphere that faces `wo`, which becomes a normal of the ellipsoid.
    let (sin, cos) = float::sin_cos(TAU * u.y);
    let radius = u.x.sqrt();
    let (x, y) = (radius * cos, radius * sin);
    let z = float::safe_sqrt(1.0 - u.x);
    let m_k = x * determinant / minor - y * inverse * (s_ki * s_ji - s_kj * s_ii) / minor
        + z * inverse * s_ki;
    let m_j = y * inverse * minor + z * inverse * s_ji;
    let m_i = z * inverse * s_ii;
    (m_k * k + m_j * j + m_i * wo).try_normalize()
}

impl Sggx {
    /// Reads `S`.
    pub(crate) fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let accepted = "six numbers (xx, yy, zz, xy, xz, yz), or all nine, of a matrix without negative eigenvalues, or a volume of six channels";
        let Some(property) = params.property("S") else {
            params.missing("S", accepted);
            return None;
        };
        if let Value::String(text) = &property.value {
            let sound = symmetric_matrix(text);
            if sound.is_none() {
                params.refuse("S", text, accepted);
            }
            return sound.map(Self::Even);
        }
        let channels = |first| build.volume(params, "S", None, SpectrumKind::Raw(first));
        Some(Self::Varying([0, 3].map(channels)))
    }

    /// Whether it is the same everywhere.
    pub(crate) fn is_even(&self) -> bool {
        matches!(self, Self::Even(_))
    }

    /// Not less than σ(ω) of any direction.
    pub(crate) fn largest_area(&self, most: impl Fn(TextureId) -> f32) -> f32 {
        match self {
            Self::Even(s) => float::safe_sqrt(s.x_axis.x + s.y_axis.y + s.z_axis.z),
            // Three times the largest number of the diagonal is not less than the trace.
            Self::Varying([diagonal, _]) => float::safe_sqrt(3.0 * (most(*diagonal) + LEAST)),
        }
    }

    fn at(&self, point: &PhasePoint<'_, impl Textures>) -> Mat3 {
        match self {
            Self::Even(s) => *s,
            Self::Varying(parts) => {
                let place = TexturePoint::in_space(point.position);
                let [diagonal, beside] = parts.map(|part| point.textures.colour(part, &place));
                symmetric(diagonal, beside)
            }
        }
    }
}

/// A matrix without negative eigenvalues by the text of its six numbers xx, yy, zz, xy, xz, yz, or of all nine.
pub(crate) fn symmetric_matrix(text: &str) -> Option<Mat3> {
    let words = text.split([',', ' ']).filter(|word| !word.is_empty());
    let numbers: Option<Vec<f32>> = words.map(|word| word.parse().ok()).collect();
    let s = match numbers?[..] {
        [xx, yy, zz, xy, xz, yz] => symmetric(Vec3::new(xx, yy, zz), Vec3::new(xy, xz, yz)),
        [xx, xy, xz, yx, yy, yz, zx, zy, zz] if [xy, xz, yz] == [yx, zx, zy] => {
            symmetric(Vec3::new(xx, yy, zz), Vec3::new(xy, xz, yz))
        }
        _ => return None,
    };
    Some(s).filter(is_sound)
}

/// Whether a matrix is finite and has no negative eigenvalue.
fn is_sound(s: &Mat3) -> bool {
    let diagonal = Vec3::new(s.x_axis.x, s.y_axis.y, s.z_axis.z);
    let minors = adjugate(s);
    let minors = Vec3::new(minors.x_axis.x, minors.y_axis.y, minors.z_axis.z);
    s.is_finite()
        && diagonal.min_element() >= 0.0
        && minors.min_element() >= 0.0
        && s.determinant() >= 0.0
}

impl PhaseModel for Sggx {
    fn eval(&self, at: &PhasePoint<'_, impl Textures>, wo: Vec3, wi: Vec3) -> Vec4 {
        Vec4::splat(value(&self.at(at), wo, wi))
    }

    fn density(
        &self,
        at: &PhasePoint<'_, impl Textures>,
        wo: Vec3,
        wi: Vec3,
    ) -> Density<SolidAngle> {
        Density::uniform(value(&self.at(at), wo, wi))
    }

    fn sample(&self, at: &PhasePoint<'_, impl Textures>, wo: Vec3, u: Vec2) -> PhaseSample {
        let s = self.at(at);
        let normal = visible_normal(&s, wo, u).unwrap_or(wo);
        let wi = etalon_math::reflection::reflect(wo, normal);
        let value = value(&s, wo, wi);
        PhaseSample {
            wi,
            value: Vec4::splat(value),
            density: Density::uniform(value),
        }
    }

    fn projected_area(&self, at: &PhasePoint<'_, impl Textures>, direction: Vec3) -> f32 {
        area(&self.at(at), direction)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_sampling::warps::square_to_uniform_sphere;
    use proptest::prelude::*;

    /// Across a fibre along x, along it, and a ball, turned; not so narrow that a quadrature misses them.
    fn matrices() -> impl Strategy<Value = Mat3> {
        let shapes = [
            Vec3::new(0.3, 1.0, 1.0),
            Vec3::new(1.0, 0.4, 0.4),
            Vec3::splat(0.7),
        ];
        (
            prop::sample::select(shapes.to_vec()),
            -3.0_f32..3.0,
            -3.0_f32..3.0,
        )
            .prop_map(|(diagonal, a, b)| {
                let turn = Mat3::from_rotation_z(a) * Mat3::from_rotation_x(b);
                turn * Mat3::from_diagonal(diagonal * diagonal) * turn.transpose()
            })
    }

    fn direction(z: f32, turn: f32) -> Vec3 {
        square_to_uniform_sphere(Vec2::new(0.5 * (1.0 - z), turn))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]

        /// The phase function integrates to one, in both ways the same light is scattered, and samples have its density: the mean of a
        /// polynomial by samples is that by quadrature (to 3 %).
        #[test]
        fn flakes_scatter_all_light_and_as_much_either_way(
            s in matrices(),
            z in -1.0_f32..1.0,
            turn in 0.0_f32..1.0,
        ) {
            let wo = direction(z, turn);
            let (mut sum, mut moments, count) = (0.0_f64, [0.0_f64; 2], 300);
            let test = |wi: Vec3| f64::from(1.0 + wi.x + wi.y * wi.z + wi.z * wi.z);
            for i in 0..count {
                for j in 0..count {
                    let u = Vec2::new(i as f32 + 0.5, j as f32 + 0.5) / count as f32;
                    let wi = square_to_uniform_sphere(u);
                    let p = f64::from(value(&s, wo, wi)) * 4.0 * std::f64::consts::PI;
                    sum += p / f64::from(count * count);
                    moments[0] += p * test(wi) / f64::from(count * count);
                    let m = visible_normal(&s, wo, u).expect("some");
                    let wi = etalon_math::reflection::reflect(wo, m);
                    moments[1] += test(wi) / f64::from(count * count);
                }
            }
            prop_assert!((sum - 1.0).abs() < 0.03, "{sum}");
            prop_assert!((moments[0] - moments[1]).abs() < 0.03 * (1.0 + moments[1].abs()), "{moments:?}");
            let wi = direction(-0.3, 0.7);
            let both = [value(&s, wo, wi) * area(&s, wo), value(&s, wi, wo) * area(&s, wi)];
            prop_assert!((both[0] - both[1]).abs() <= 1e-3 * both[0], "{both:?}");
        }
    }

    #[test]
    fn a_ball_scatters_alike_in_all_directions() {
        let s = symmetric(Vec3::ONE, Vec3::ZERO);
        let p = value(&s, Vec3::Z, Vec3::new(0.6, 0.0, 0.8));
        assert!((p * 4.0 * PI - 1.0).abs() < 1e-4, "{p}");
        assert!((area(&s, Vec3::Y) - 1.0).abs() < 1e-5);
        assert!(!is_sound(&symmetric(Vec3::ONE, Vec3::splat(2.0))));
        assert!(!is_sound(&symmetric(Vec3::new(-1.0, 1.0, 1.0), Vec3::ZERO)));
    }
}
