//! The classic Phong material: what it shows of a lamp, and where it sends rays.

use super::tree::Onward;
use etalon_math::float;
use etalon_transport::{ClassicPhong, Vertex};
use glam::{Vec3, Vec4};

/// The shading normal on the side of `wo`.
fn facing(vertex: &Vertex, wo: Vec3) -> Vec3 {
    let n = vertex.shading.n;
    if n.dot(wo) < 0.0 { -n } else { n }
}

/// What the surface itself shows of a lamp in direction `wi`, per unit of irradiance.
pub(super) fn shade(material: &ClassicPhong, vertex: &Vertex, wo: Vec3, wi: Vec3) -> Vec4 {
    let n = facing(vertex, wo);
    let cos = n.dot(wi);
    if !(cos > 0.0) {
        return Vec4::ZERO;
    }
    let mirrored = mirror(n, wo).dot(wi).max(0.0);
    let highlight = float::pow(mirrored, material.exponent);
    let own = material.diffuse * cos + material.specular * highlight;
    own * (1.0 - material.transparency)
}

fn mirror(n: Vec3, wo: Vec3) -> Vec3 {
    n * (2.0 * n.dot(wo)) - wo
}

/// The ray number `index` that leaves the surface: the mirrored one, and the refracted one; `None`
/// beyond the last.
pub(super) fn onward(
    material: &ClassicPhong,
    vertex: &Vertex,
    wo: Vec3,
    index: u32,
) -> Option<Onward> {
    let n = facing(vertex, wo);
    let cos = n.dot(wo);
    // Index of the medium entered over that of the medium left.
    let eta = if vertex.shading.n.dot(wo) < 0.0 {
        material.eta.recip()
    } else {
        material.eta
    };
    // Snell's law; below zero there is no refracted ray, and all is reflected.
    let cos2 = 1.0 - (1.0 - cos * cos) / (eta * eta);
    let refracts = Vec4::select(cos2.cmpgt(Vec4::ZERO), Vec4::ONE, Vec4::ZERO);
    let through = Vec4::splat(material.transparency);
    match index {
        0 => Some(Onward {
            wi: mirror(n, wo),
            value: material.global * (1.0 - through) + through * (1.0 - refracts),
            together: Vec4::ONE,
        }),
        1 if material.transparency > 0.0 => {
            // The direction is that of lane 0; other lanes go with it only if theirs is the same.
            let same = Vec4::select(eta.cmpeq(Vec4::splat(eta.x)), Vec4::ONE, Vec4::ZERO);
            let together = same * refracts.x;
            let refracted = n * (cos / eta.x - cos2.x.max(0.0).sqrt()) - wo / eta.x;
            Some(Onward {
                wi: refracted.normalize(),
                value: through * together,
                // Under total reflection lanes of the same index have no ray, either.
                together: same,
            })
        }
        _ => None,
    }
}
