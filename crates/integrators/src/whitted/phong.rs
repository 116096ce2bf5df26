//! The classic Phong material: shading by a lamp, and secondary rays.

use super::Continuation;
use etalon_math::float;
use etalon_transport::{LegacyPhong, SurfaceInteraction};
use glam::{Vec3, Vec4};

/// The material's normal on the side of `wo`.
fn facing(material: &LegacyPhong, wo: Vec3) -> Vec3 {
    let n = material.normal;
    if n.dot(wo) < 0.0 { -n } else { n }
}

/// Whether two directions are on one side of the surface, by the shading normal before normal and bump maps.
fn on_one_side(vertex: &SurfaceInteraction, wo: Vec3, wi: Vec3) -> bool {
    vertex.shading.n.dot(wo) * vertex.shading.n.dot(wi) > 0.0
}

/// The cosine of a lamp's direction, and the normal; `None` for lamps behind the surface.
fn lit(
    material: &LegacyPhong,
    vertex: &SurfaceInteraction,
    wo: Vec3,
    wi: Vec3,
) -> Option<(f32, Vec3)> {
    let n = facing(material, wo);
    let cos = n.dot(wi);
    (cos > 0.0 && on_one_side(vertex, wo, wi)).then_some((cos, n))
}

/// The diffuse part of [`shade`].
pub(super) fn spread(
    material: &LegacyPhong,
    vertex: &SurfaceInteraction,
    wo: Vec3,
    wi: Vec3,
) -> Vec4 {
    let cos = lit(material, vertex, wo, wi).map_or(0.0, |(cos, _)| cos);
    material.diffuse * (cos * (1.0 - material.transparency) * material.opacity)
}

/// The surface's shading by a lamp in direction `wi`, per unit of irradiance.
pub(super) fn shade(
    material: &LegacyPhong,
    vertex: &SurfaceInteraction,
    wo: Vec3,
    wi: Vec3,
) -> Vec4 {
    let Some((cos, n)) = lit(material, vertex, wo, wi) else {
        return Vec4::ZERO;
    };
    let mirrored = mirror(n, wo).dot(wi).max(0.0);
    let highlight = float::pow(mirrored, material.exponent);
    let own = material.diffuse * cos + material.specular * highlight;
    own * ((1.0 - material.transparency) * material.opacity)
}

fn mirror(n: Vec3, wo: Vec3) -> Vec3 {
    n * (2.0 * n.dot(wo)) - wo
}

/// The ray number `index` that leaves the surface: the mirrored one, the refracted one, and what goes straight on where the
/// surface is not there; `None` beyond the last.
pub(super) fn onward(
    material: &LegacyPhong,
    vertex: &SurfaceInteraction,
    wo: Vec3,
    index: u32,
) -> Option<Continuation> {
    let n = facing(material, wo);
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
        0 => {
            let wi = mirror(n, wo);
            // A tilted normal may mirror into the surface.
            let is_outside = f32::from(on_one_side(vertex, wo, wi));
            let share = material.global * (1.0 - through) + through * (1.0 - refracts);
            Some(Continuation {
                wi,
                value: share * (material.opacity * is_outside),
                together: Vec4::ONE,
                is_straight: false,
            })
        }
        1 => {
            // The direction is that of lane 0; other lanes go with it only if theirs is the same.
            let same = Vec4::select(eta.cmpeq(Vec4::splat(eta.x)), Vec4::ONE, Vec4::ZERO);
            let together = same * refracts.x;
            let refracted = n * (cos / eta.x - cos2.x.max(0.0).sqrt()) - wo / eta.x;
            Some(Continuation {
                wi: refracted.normalize(),
                value: through * together * material.opacity,
                // Under total reflection lanes of the same index have no ray, either.
                together: same,
                is_straight: false,
            })
        }
        2 if material.opacity < 1.0 => Some(Continuation {
            wi: -wo,
            value: Vec4::splat(1.0 - material.opacity),
            together: Vec4::ONE,
            is_straight: true,
        }),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_math::Frame;
    use etalon_transport::{InstanceId, LightId, MaterialId, ShapeId};
    use glam::Vec2;

    const MATERIAL: LegacyPhong = LegacyPhong {
        ambient: Vec4::ZERO,
        diffuse: Vec4::splat(0.5),
        specular: Vec4::splat(0.25),
        global: Vec4::splat(0.3),
        exponent: 2.0,
        transparency: 0.4,
        eta: Vec4::splat(1.5),
        normal: Vec3::Z,
        opacity: 1.0,
    };

    fn vertex() -> SurfaceInteraction {
        SurfaceInteraction {
            position: Vec3::ZERO,
            error: Vec3::ZERO,
            depth: f32::NAN,
            normal: Vec3::Z,
            shading: Frame::from_normal(Vec3::Z),
            uv: Vec2::ZERO,
            dp_du: Vec3::X,
            dp_dv: Vec3::Y,
            t: 1.0,
            time: 0.0,
            parameters: Vec2::ZERO,
            shape: ShapeId(0),
            primitive: 0,
            instance: InstanceId::NONE,
            material: MaterialId(0),
            light: LightId::NONE,
            media: etalon_transport::MediumInterface::NONE,
        }
    }

    fn close(a: Vec4, b: f32) -> bool {
        (a - b).abs().max_element() < 1e-6
    }

    #[test]
    fn a_lamp_is_shown_by_both_sides_and_not_through_the_surface() {
        let wo = Vec3::new(0.6, 0.0, 0.8);
        let mirrored = Vec3::new(-0.6, 0.0, 0.8);
        for side in [1.0, -1.0] {
            let turn = |v: Vec3| Vec3::new(v.x, v.y, v.z * side);
            let seen = |wi: Vec3| shade(&MATERIAL, &vertex(), turn(wo), turn(wi));
            // 0.6·(0.5 cos θ + 0.25 cos² ρ)
            assert!(close(seen(mirrored), 0.6 * (0.4 + 0.25)));
            assert!(close(seen(Vec3::Z), 0.6 * (0.5 + 0.25 * 0.64)));
            assert!(close(seen(Vec3::new(0.6, 0.0, -0.8)), 0.0));
        }
    }

    /// Light and mirror images go by the normal that a map gives; a lamp, or a mirror image, on the other side of the surface itself does not
    /// count (mutants: the surface's normal for the map's; no test of the side).
    #[test]
    fn a_map_tilts_light_and_mirror_images() {
        let tilted = LegacyPhong {
            normal: Vec3::new(0.6, 0.0, 0.8),
            ..MATERIAL
        };
        let wo = Vec3::Z;
        // cos θ = 0.8, and the mirrored view is 2 (n·wo) n − wo = (0.96, 0, 0.28).
        assert!(close(
            shade(&tilted, &vertex(), wo, Vec3::Z),
            0.6 * (0.5 * 0.8 + 0.25 * 0.28 * 0.28)
        ));
        let mirrored = onward(&tilted, &vertex(), wo, 0).expect("there always is one");
        assert!((mirrored.wi - Vec3::new(0.96, 0.0, 0.28)).length() < 1e-6);
        let behind = Vec3::new(0.96, 0.0, -0.28);
        assert!(tilted.normal.dot(behind) > 0.0);
        assert!(close(shade(&tilted, &vertex(), wo, behind), 0.0));
        let grazing = Vec3::new(-0.8, 0.0, 0.6);
        let into = onward(&tilted, &vertex(), grazing, 0).expect("there always is one");
        assert!(into.wi.z < 0.0 && close(into.value, 0.0));
    }

    /// The transparent share of a mask lets light pass, and does not shade.
    #[test]
    fn a_mask_leaves_a_share() {
        let masked = LegacyPhong {
            opacity: 0.25,
            ..MATERIAL
        };
        let wo = Vec3::new(0.6, 0.0, 0.8);
        let whole = |material| shade(material, &vertex(), wo, Vec3::Z);
        assert!(close(whole(&masked), 0.25 * whole(&MATERIAL).x));
        assert!(onward(&MATERIAL, &vertex(), wo, 2).is_none());
        let straight = onward(&masked, &vertex(), wo, 2).expect("some of it passes");
        assert!(straight.is_straight && straight.wi == -wo && close(straight.value, 0.75));
        for index in [0, 1] {
            let [part, all] = [&masked, &MATERIAL].map(|m| onward(m, &vertex(), wo, index));
            let [part, all] = [part, all].map(|way| way.expect("there is one").value.x);
            assert!((part - 0.25 * all).abs() < 1e-6);
        }
    }

    #[test]
    fn refraction_obeys_snell_from_either_side() {
        let sin = 0.6_f32;
        let wo = Vec3::new(sin, 0.0, 0.8);
        let in_glass = onward(&MATERIAL, &vertex(), wo, 1).expect("it is transparent");
        assert!((in_glass.wi.x + sin / 1.5).abs() < 1e-6 && in_glass.wi.z < 0.0);
        assert!(close(in_glass.value, 0.4));
        let back = onward(&MATERIAL, &vertex(), in_glass.wi, 1).expect("it is transparent");
        assert!((back.wi - wo).length() < 1e-6, "{}", back.wi);
    }

    #[test]
    fn total_reflection_takes_the_place_of_refraction() {
        let wo = Vec3::new(0.8, 0.0, -0.6);
        let mirrored = onward(&MATERIAL, &vertex(), wo, 0).expect("there always is one");
        assert_eq!(mirrored.wi, Vec3::new(-0.8, 0.0, -0.6));
        assert!(close(mirrored.value, 0.3 * 0.6 + 0.4));
        let refracted = onward(&MATERIAL, &vertex(), wo, 1).expect("other lanes may refract");
        assert!(close(refracted.value, 0.0));
        assert!(onward(&MATERIAL, &vertex(), wo, 2).is_none());
    }

    #[test]
    fn each_wavelength_is_refracted_by_its_own_index() {
        let material = LegacyPhong {
            eta: Vec4::new(1.5, 1.5, 1.6, 1.7),
            ..MATERIAL
        };
        let wo = Vec3::new(0.6, 0.0, 0.8);
        let whole = onward(&material, &vertex(), wo, 1).expect("it is transparent");
        assert_eq!(whole.together, Vec4::new(1.0, 1.0, 0.0, 0.0));
        assert_eq!(whole.value, whole.together * 0.4);
    }
}
