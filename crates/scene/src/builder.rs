//! Services for plugins while a scene is compiled.

use etalon_params::{Diagnostics, Node, Params};
use etalon_spectrum::Spectrum;
use etalon_textures::{TextureReader, TextureTable};
use etalon_transport::{Assets, Build, Shutter, SpectrumKind, TextureId};
use std::sync::Arc;

/// The scene under construction, as plugins see it.
pub struct Builder<'a> {
    /// The files of the scene.
    pub assets: &'a dyn Assets,
    /// The diagnostics.
    pub diagnostics: &'a Diagnostics,
    /// The textures read so far.
    pub textures: TextureTable,
    /// The interval during which things move.
    pub shutter: Shutter,
}

impl<'a> Builder<'a> {
    /// A scene without anything.
    pub fn new(assets: &'a dyn Assets, diagnostics: &'a Diagnostics) -> Self {
        Self {
            assets,
            diagnostics,
            textures: TextureTable::new(),
            shutter: Shutter::default(),
        }
    }

    fn reader(&mut self) -> TextureReader<'_> {
        TextureReader {
            set: &mut self.textures,
            assets: self.assets,
            diagnostics: self.diagnostics,
        }
    }
}

impl Build for Builder<'_> {
    fn assets(&self) -> &dyn Assets {
        self.assets
    }

    fn shutter(&self) -> Shutter {
        self.shutter
    }

    fn texture(
        &mut self,
        params: &Params<'_>,
        name: &str,
        default: Option<f64>,
        role: SpectrumKind,
    ) -> TextureId {
        self.reader().parameter(params, name, default, role)
    }

    fn volume(
        &mut self,
        params: &Params<'_>,
        name: &str,
        default: Option<f64>,
        role: SpectrumKind,
    ) -> TextureId {
        self.reader()
            .parameter_in_space(params, name, default, role)
    }

    fn nested_texture(&mut self, node: &Arc<Node>, role: SpectrumKind) -> TextureId {
        self.reader().node(node, role)
    }

    fn varies(&self, plugin: &str) -> bool {
        etalon_textures::texture::varies(plugin)
    }

    fn resolution(&self, texture: TextureId) -> [u32; 2] {
        self.textures.get(texture).resolution()
    }

    fn spectrum(&mut self, spectrum: Spectrum) -> TextureId {
        self.textures.add_spectrum(spectrum)
    }
}
