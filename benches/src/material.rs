//! A material by itself, on a plane whose normal is z.

use etalon_render::pipeline::{self, LoadOptions, Loaded};
use etalon_scene::Scene;
use etalon_spectrum::Wavelengths;
use etalon_transport::{Bsdf, BsdfOf, Ray, SurfaceInteraction, Surfaces, TransportMode, World};
use glam::{Vec3, Vec4};
use std::fs;
use std::path::PathBuf;

/// A material that a scene's element describes.
pub struct LoneMaterial {
    loaded: Loaded,
    vertex: SurfaceInteraction,
}

impl LoneMaterial {
    /// The material of a `<bsdf>` element; files are looked for in `data` and in the current folder.
    ///
    /// # Errors
    /// Everything that is wrong with it.
    pub fn read(element: &str, data: Vec<PathBuf>) -> Result<Self, String> {
        let scene = format!(
            "<scene version=\"3.0.0\">\n<sensor type=\"perspective\"/>\n<shape type=\"rectangle\">\n{element}\n\
             </shape>\n</scene>\n"
        );
        let name = format!("etalon-material-{}.xml", std::process::id());
        let path = std::env::temp_dir().join(name);
        let failure = |e: std::io::Error| format!("{}: {e}", path.display());
        fs::write(&path, &scene).map_err(failure)?;
        let options = LoadOptions {
            data,
            ..LoadOptions::default()
        };
        let loaded = pipeline::load(&path, &options);
        fs::remove_file(&path).map_err(failure)?;
        let loaded = loaded.map_err(|refusal| {
            let help = |help: Option<String>| help.map_or(String::new(), |h| format!(" ({h})"));
            let lines: Vec<String> = (refusal.diagnostics.into_iter())
                .map(|d| d.message + &help(d.help))
                .collect();
            lines.join("\n")
        })?;
        let ray = Ray::new(Vec3::new(0.0, 0.0, 1.0), Vec3::NEG_Z, 0.0);
        let scene = &loaded.compiled.scene;
        let hit = scene
            .surfaces()
            .intersect(&ray)
            .ok_or("the plane cannot be seen")?;
        let vertex = scene.surfaces().vertex(&ray, &hit);
        Ok(Self { loaded, vertex })
    }

    /// The material for the known direction `wo` of the local frame, and that frame's directions in the world.
    #[inline]
    pub fn at(&self, wo: Vec3, wavelengths: &Wavelengths) -> BsdfOf<'_, Scene> {
        let wo = self.to_world(wo);
        self.loaded
            .compiled
            .scene
            .surfaces()
            .bsdf(&self.vertex, wo, wavelengths)
    }

    /// A direction of the local frame in the world, where [`LoneMaterial::at`] has its directions.
    #[inline]
    pub fn to_world(&self, local: Vec3) -> Vec3 {
        self.vertex.shading.to_world(local)
    }

    /// f cos θi for the known `wo` and the sampled `wi` of the local frame, at wavelengths in nm.
    pub fn value(&self, wo: Vec3, wi: Vec3, wavelengths: &[f32]) -> Vec<f32> {
        let mut out = Vec::with_capacity(wavelengths.len());
        for four in wavelengths.chunks(4) {
            let lanes = std::array::from_fn(|i| four[i.min(four.len() - 1)]);
            let at = Wavelengths {
                lambda: Vec4::from_array(lanes),
                density: Vec4::ONE,
            };
            let [o, i] = [wo, wi].map(|v| self.to_world(v));
            let value = self.at(wo, &at).eval(o, i, TransportMode::Radiance);
            out.extend_from_slice(&value.to_array()[..four.len()]);
        }
        out
    }
}
