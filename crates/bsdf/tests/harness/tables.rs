//! Tables of BRDFs, made from other models, for the tests to read.

use crate::scene::Sample;
use etalon_bsdf::BsdfAtPoint;
use etalon_math::Frame;
use etalon_spectrum::Wavelengths;
use etalon_tables::spectral::{self, Grid};
use etalon_tables::write_rgl::{Resolution, write_rgl};
use etalon_tables::{BrdfTable, merl};
use etalon_transport::{Bsdf, TransportMode};
use glam::{Vec3, Vec4};
use std::fs;
use std::path::Path;
use std::sync::{Arc, LazyLock};

/// The isotropic material of the tables.
pub(crate) const GLOSS: &str = "ward alpha_u=f:0.3 alpha_v=f:0.3 diffuse_reflectance=t:400:0.1,700:0.4 specular_reflectance=u:0.3";

/// The anisotropic one.
const BRUSHED: &str = "ward alpha_u=f:0.25 alpha_v=f:0.5 diffuse_reflectance=t:400:0.4,700:0.1";

/// f cos θi of a material at wavelengths.
pub(crate) fn spectrum(sample: &Sample, wo: Vec3, wi: Vec3, wavelengths: &[f32]) -> Vec<f32> {
    let mut out = Vec::with_capacity(wavelengths.len());
    for four in wavelengths.chunks(4) {
        let lanes = std::array::from_fn(|i| four[i.min(four.len() - 1)]);
        let wavelengths = Wavelengths {
            lambda: Vec4::from_array(lanes),
            density: Vec4::ONE,
        };
        let bsdf: BsdfAtPoint<'_> = sample.resolve(wo, &wavelengths, Frame::IDENTITY);
        let value = bsdf.eval(wo, wi, TransportMode::Radiance).to_array();
        out.extend_from_slice(&value[..four.len()]);
    }
    out
}

/// The wavelengths of RGL tables here, nm.
pub(crate) fn wavelengths() -> Vec<f32> {
    (0..8).map(|i| 360.0 + 60.0 * i as f32).collect()
}

fn rgl(material: &str, phi: usize) -> Vec<u8> {
    let sample = Sample::new(material);
    let resolution = Resolution {
        phi,
        theta: 16,
        normals: 32,
        square: 32,
        wavelengths: wavelengths(),
    };
    let f = |wo: Vec3, wi: Vec3| spectrum(&sample, wo, wi, &resolution.wavelengths);
    write_rgl(&resolution, f, material).expect("it reflects something")
}

/// A file by its name.
type Named = (&'static str, Arc<Vec<u8>>);

static FILES: LazyLock<[Named; 4]> = LazyLock::new(|| {
    let gloss = Sample::new(GLOSS);
    let grid = Grid::new(31, 61, 8);
    let brdf = |wo: Vec3, wi: Vec3| -> Vec<f32> {
        let values = spectrum(&gloss, wo, wi, &grid.wavelengths);
        values.iter().map(|value| value / wi.z).collect()
    };
    let rgb = |wo: Vec3, wi: Vec3| [0.9, 0.7, 0.5].map(|c| c * f64::from(brdf(wo, wi)[4]));
    [
        ("gloss.bsdf", Arc::new(rgl(GLOSS, 1))),
        ("brushed.bsdf", Arc::new(rgl(BRUSHED, 9))),
        (
            "gloss.brdf",
            Arc::new(spectral::write(&grid, brdf, GLOSS, None)),
        ),
        ("gloss.binary", Arc::new(merl::write([45, 45, 45], rgb))),
    ]
});

/// The file of this name: one of the above, or in the folder of scenes.
pub(crate) fn file(name: &str) -> Option<Arc<Vec<u8>>> {
    if name.contains('/') {
        let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
        return fs::read(scenes.join(name)).ok().map(Arc::new);
    }
    // Materials that are read while the files are made name none of them.
    let known = ["gloss.bsdf", "brushed.bsdf", "gloss.brdf", "gloss.binary"].contains(&name);
    let found = || FILES.iter().find(|(file, _)| *file == name);
    known.then(found).flatten().map(|(_, bytes)| bytes.clone())
}

#[test]
fn tables_have_the_values_of_their_model() {
    // What each table's resolution leaves, in units of the reflectance.
    for (name, tolerance) in [("gloss.bsdf", 0.01), ("gloss.brdf", 0.004)] {
        let model = Sample::new(GLOSS);
        let table = BrdfTable::parse(&file(name).expect("it is here")).expect("it is well-formed");
        let lambda = [450.0, 500.0, 555.0, 613.0];
        let at = table.at(Vec4::from_array(lambda));
        let mut uniform = crate::directions::Uniform::new(8);
        for _ in 0..20 {
            let wo = uniform.direction();
            // Near the horizon every table is coarse.
            let wo = Vec3::new(wo.x, wo.y, wo.z.abs().max(0.25)).normalize();
            // ∫ |table − model| cos θi dωi by uniform directions.
            let (mut difference, count) = (0.0, 4000);
            for _ in 0..count {
                let wi = uniform.direction();
                let wi = Vec3::new(wi.x, wi.y, wi.z.abs());
                let expected = spectrum(&model, wo, wi, &lambda);
                let (value, _) = at.eval_and_density(wo, wi);
                difference += f64::from((value - Vec4::from_slice(&expected)).abs().max_element());
            }
            let error = difference / f64::from(count) * core::f64::consts::TAU;
            assert!(error < tolerance, "{name} from {wo}: {error}");
        }
    }
}
