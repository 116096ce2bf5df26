//! Radiance against importance.
//!
//! f*(wo, wi) = f(wi, wo): what importance scatters from wo to wi is what radiance scatters from wi
//! to wo, in projected solid angle about the *geometric* normal, whatever the shading normal
//! (Veach 1997, sections 5.2 and 5.3). For discrete lobes the same holds of the energy, but for
//! the η² by which refraction squeezes solid angles.

use crate::directions::Uniform;
use crate::scene::{Sample, WAVELENGTHS};
use etalon_math::Frame;
use etalon_transport::{Bsdf, TransportMode};
use glam::{Vec3, Vec4};

fn close(a: Vec4, b: Vec4, relative: f32) -> bool {
    (a - b)
        .abs()
        .cmple(relative * a.abs().max(b.abs()) + 1e-5)
        .all()
}

/// What is wrong between the two modes, for a model resolved for either direction with the
/// geometric normal +z.
pub(crate) fn asymmetry<B: Bsdf>(resolve: impl Fn(Vec3) -> B, seed: u64) -> Option<String> {
    let mut uniform = Uniform::new(seed);
    for _ in 0..400 {
        let wo = uniform.direction();
        let forward = resolve(wo);
        let sampled = forward.sample(
            wo,
            uniform.next(),
            uniform.pair(),
            TransportMode::Importance,
        );
        let anywhere = uniform.direction();
        let continuous = sampled.filter(|s| !s.chance.is_delta()).map(|s| s.wi);
        for wi in [anywhere].into_iter().chain(continuous) {
            let importance = forward.eval(wo, wi, TransportMode::Importance) / wi.z.abs();
            let radiance = resolve(wi).eval(wi, wo, TransportMode::Radiance) / wo.z.abs();
            // Half-vectors of nearly opposite directions lose digits.
            if wo.z.abs() > 0.02 && wi.z.abs() > 0.02 && !close(importance, radiance, 2e-3) {
                return Some(format!("{wo} {wi}: {importance} {radiance}"));
            }
        }
    }
    None
}

#[test]
fn importance_is_the_adjoint_of_radiance() {
    // Light paths cannot have materials that light leaves elsewhere than it came.
    let all = Sample::test_materials().into_iter();
    for sample in all.filter(|sample| !sample.material().is_one_way()) {
        for normal in [
            Vec3::Z,
            Vec3::new(0.2, -0.1, 1.0),
            Vec3::new(-0.5, 0.4, 1.0),
        ] {
            let shading = Frame::from_normal(normal.normalize());
            let wrong = asymmetry(|wo| sample.resolve(wo, &WAVELENGTHS, shading), 1);
            assert_eq!(wrong, None, "{} with {normal}", sample.text);
        }
    }
}

#[test]
fn smooth_refraction_squeezes_radiance_by_the_index_squared() {
    let mut uniform = Uniform::new(2);
    let mut refracted = 0;
    for sample in Sample::test_materials() {
        for _ in 0..100 {
            let wo = uniform.direction();
            let u = uniform.pair();
            let Some(s) = sample
                .at(wo)
                .sample(wo, uniform.next(), u, TransportMode::Radiance)
                .filter(|s| s.chance.is_delta() && s.wi.z.abs() > 0.02)
            else {
                continue;
            };
            // The way back, by whichever lobe leads there.
            let back = (0..200)
                .filter_map(|i| {
                    let u_lobe = (i as f32 + 0.5) / 200.0;
                    sample
                        .at(s.wi)
                        .sample(s.wi, u_lobe, u, TransportMode::Importance)
                })
                .find(|b| b.chance.is_delta() && (b.wi - wo).length() < 1e-3);
            let Some(back) = back else {
                assert!(s.chance.lanes().x < 0.01, "{} {s:?}", sample.text);
                continue;
            };
            refracted += usize::from(s.eta != 1.0);
            // Near the critical angle Fresnel's equations turn rounding into more.
            assert!(
                close(s.value * s.eta * s.eta, back.value, 1e-3)
                    || s.wi.z.abs().min(wo.z.abs()) < 0.1,
                "{} {wo} {s:?} {back:?}",
                sample.text
            );
            assert!((s.eta * back.eta - 1.0).abs() < 1e-6);
        }
    }
    assert!(refracted > 100, "{refracted}");
}
