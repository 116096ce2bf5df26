//! The least scene that a material can be built and resolved in.

use crate::{notation, tables};
use etalon_bsdf::{BsdfAtPoint, Bxdf, Material};
use etalon_math::Frame;
use etalon_math::lane::{Lane, Spectral};
use etalon_params::{Diagnostic, Diagnostics, Node, Params, Severity, SpectrumText, Value};
use etalon_spectrum::{Spectrum, Wavelengths};
use etalon_transport::{
    AssetError, Assets, Build, InstanceId, LightId, MaterialId, MeshData, MeshFormat, OpenFile,
    ShapeId, Shutter, SpectrumKind, SurfaceInteraction, TextureId, TexturePoint, Textures,
    in_memory,
};
use glam::{Vec2, Vec3, Vec4};
use std::sync::Arc;

/// The wavelengths of every test that does not say otherwise (nm).
pub(crate) const WAVELENGTHS: Wavelengths = Wavelengths {
    lambda: Vec4::new(450.0, 500.0, 550.0, 600.0),
    density: Vec4::splat(1.0 / 470.0),
};

/// Spectra by id, and files by name.
#[derive(Default)]
pub(crate) struct Scene {
    spectra: Vec<Spectrum>,
    files: Files,
}

#[derive(Default)]
struct Files(Vec<(String, String)>);

impl Assets for Files {
    fn bytes(&self, path: &str) -> Result<Arc<Vec<u8>>, AssetError> {
        let found = self.0.iter().find(|(name, _)| name == path);
        found
            .map(|(_, text)| Arc::new(text.clone().into_bytes()))
            .or_else(|| tables::file(path))
            .ok_or_else(|| AssetError {
                message: format!("no file {path}"),
                help: None,
            })
    }

    fn open(&self, path: &str) -> Result<Box<dyn OpenFile>, AssetError> {
        self.bytes(path).map(in_memory)
    }

    fn mesh(&self, _: MeshFormat, path: &str) -> Result<MeshData, AssetError> {
        Err(AssetError {
            message: format!("no mesh {path}"),
            help: None,
        })
    }
}

impl Textures for Scene {
    fn spectrum(&self, texture: TextureId, _: &TexturePoint, lambda: Vec4) -> Vec4 {
        self.spectra[texture.0 as usize].eval(lambda)
    }

    fn spectra<F: Lane>(
        &self,
        texture: impl Fn(usize) -> TextureId,
        at: impl Fn(usize) -> TexturePoint,
        lambda: impl Fn(usize) -> Vec4,
    ) -> F::Spectrum {
        F::Spectrum::of_lanes(|i| self.spectrum(texture(i), &at(i), lambda(i)))
    }

    fn number(&self, texture: TextureId, _: &TexturePoint) -> f32 {
        self.spectra[texture.0 as usize].eval(Vec4::splat(550.0)).x
    }

    /// A table's values at 600, 550 and 450 nm.
    fn colour(&self, texture: TextureId, _: &TexturePoint) -> Vec3 {
        let at = Vec4::new(600.0, 550.0, 450.0, 550.0);
        self.spectra[texture.0 as usize].eval(at).truncate()
    }

    /// As heights, a table rises by its values at 600 and 550 nm along u and v.
    fn gradient(&self, texture: TextureId, at: &TexturePoint, _: [Vec3; 2]) -> Vec2 {
        self.colour(texture, at).truncate()
    }

    fn mean(&self, texture: TextureId) -> f32 {
        self.spectra[texture.0 as usize].mean() as f32
    }

    fn is_constant(&self, _: TextureId) -> bool {
        true
    }
}

impl Build for Scene {
    fn assets(&self) -> &dyn Assets {
        &self.files
    }

    fn shutter(&self) -> Shutter {
        Shutter::default()
    }

    fn texture(
        &mut self,
        params: &Params<'_>,
        name: &str,
        default: Option<f64>,
        _: SpectrumKind,
    ) -> TextureId {
        let spectrum = match (params.property(name).map(|p| &p.value), default) {
            (Some(Value::Float(value)), _) => Spectrum::uniform(*value),
            (None, Some(value)) => Spectrum::uniform(value),
            (Some(Value::Spectrum(SpectrumText::Uniform(value))), _) => Spectrum::uniform(*value),
            (Some(Value::Spectrum(SpectrumText::Samples(samples))), _) => {
                let (wavelengths, values): (Vec<f64>, Vec<f64>) = samples.iter().copied().unzip();
                Spectrum::irregular(&wavelengths, &values)
            }
            _ => {
                params.missing(name, "a number or spectrum");
                Spectrum::uniform(0.0)
            }
        };
        self.spectrum(spectrum.expect("a valid spectrum"))
    }

    fn volume(
        &mut self,
        params: &Params<'_>,
        name: &str,
        default: Option<f64>,
        role: SpectrumKind,
    ) -> TextureId {
        self.texture(params, name, default, role)
    }

    fn nested_texture(&mut self, node: &Arc<Node>, _: SpectrumKind) -> TextureId {
        match node.properties.first().map(|p| &p.value) {
            Some(Value::Spectrum(SpectrumText::Samples(samples))) => {
                let (wavelengths, values): (Vec<f64>, Vec<f64>) = samples.iter().copied().unzip();
                let spectrum = Spectrum::irregular(&wavelengths, &values);
                self.spectrum(spectrum.expect("a valid spectrum"))
            }
            _ => unreachable!("the notation nests tables only"),
        }
    }

    fn varies(&self, _: &str) -> bool {
        false
    }

    fn resolution(&self, _: TextureId) -> [u32; 2] {
        [1; 2]
    }

    fn spectrum(&mut self, spectrum: Spectrum) -> TextureId {
        self.spectra.push(spectrum);
        TextureId(self.spectra.len() as u32 - 1)
    }
}

impl Scene {
    /// Adds a file.
    pub(crate) fn with_file(mut self, name: &str, text: &str) -> Self {
        self.files.0.push((name.to_owned(), text.to_owned()));
        self
    }

    /// Reads a material, with what was said about it.
    pub(crate) fn read(&mut self, text: &str) -> (Option<Material>, Vec<Diagnostic>) {
        let diagnostics = Diagnostics::new();
        let material = Material::from_params(&notation::node(text), self, &diagnostics);
        (material, diagnostics.into_sorted())
    }
}

/// A material in a scene of its own.
pub(crate) struct Sample {
    /// The notation it was read from.
    pub(crate) text: String,
    material: Material,
    pub(crate) scene: Scene,
}

impl Sample {
    /// Reads a material that must be right.
    pub(crate) fn new(text: &str) -> Self {
        Self::in_scene(text, Scene::default())
    }

    /// The same in a scene that has files.
    pub(crate) fn in_scene(text: &str, mut scene: Scene) -> Self {
        let (material, said) = scene.read(text);
        let wrong = said.iter().any(|d| d.severity == Severity::Error);
        assert!(!wrong, "{text}: {said:?}");
        Self {
            text: text.to_owned(),
            material: material.expect("no diagnostic, so a material"),
            scene,
        }
    }

    /// All exemplars of all models.
    pub(crate) fn test_materials() -> Vec<Self> {
        etalon_bsdf::test_materials().map(Self::new).collect()
    }

    /// The same of the models that have an equation. The rest sample by a walk, and their values are right in the mean only: see
    /// `walks.rs`.
    pub(crate) fn with_equations() -> Vec<Self> {
        let mut all = Self::test_materials();
        all.retain(|sample| !sample.samples_by_walk());
        all
    }

    /// Whether samples are found by a walk: not in mixtures.
    pub(crate) fn samples_by_walk(&self) -> bool {
        match self.at(Vec3::Z).lobes() {
            [only] => only.tilt.is_none() && only.scatter.samples_by_walk(),
            _ => false,
        }
    }

    /// The material at a point whose shading and geometric normals are +z.
    pub(crate) fn at(&self, wo: Vec3) -> BsdfAtPoint<'_> {
        self.rotated(wo, 0)
    }

    /// The same when lane `turn` is the one that chooses.
    pub(crate) fn rotated(&self, wo: Vec3, turn: usize) -> BsdfAtPoint<'_> {
        self.resolve(wo, &WAVELENGTHS.rotated(turn), Frame::IDENTITY)
    }

    /// The material at a point with the geometric normal +z and another shading frame.
    pub(crate) fn resolve(
        &self,
        wo: Vec3,
        wavelengths: &Wavelengths,
        shading: Frame,
    ) -> BsdfAtPoint<'_> {
        self.material
            .resolve(&self.scene, &vertex(shading), wo, wavelengths)
    }

    /// The material's flags.
    pub(crate) fn material(&self) -> &Material {
        &self.material
    }
}

/// A point with the geometric normal +z.
pub(crate) fn vertex(shading: Frame) -> SurfaceInteraction {
    SurfaceInteraction {
        position: Vec3::ZERO,
        error: Vec3::ZERO,
        depth: f32::NAN,
        normal: Vec3::Z,
        shading,
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
