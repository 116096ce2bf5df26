//! The list of textures, and how each is found by its plugin's name.
//!
//! To add a texture, write its file and add one line to the list.

use crate::reader::Use;
use crate::times_d65;
use crate::{
    Arithmetic, Bitmap, Checkerboard, Computed, Constant, Extinction, Grid, Incandescence,
    MeshAttribute, Procedural, Projected, Ramp, TextureReader, TextureTable, TimesD65,
};
use crate::{
    arithmetic, bitmap, checkerboard, computed, constant, extinction, grid, incandescence,
    mesh_attribute, procedural, projected, ramp, spectra,
};
use etalon_params::{Class, Params, plugins};
use etalon_transport::{Shapes, TextureId, TexturePoint, gradient_by_differences};
use glam::{Vec2, Vec3, Vec4};

/// What a texture is asked at a point. `set` holds the textures that it refers to.
pub(crate) trait TextureModel {
    /// Whether it varies in space, whatever the textures that it refers to do.
    const VARIES: bool;

    /// The spectrum, for the wavelengths `lambda` (nm).
    fn spectrum(
        &self,
        set: &TextureTable,
        shapes: &impl Shapes,
        at: &TexturePoint,
        lambda: Vec4,
    ) -> Vec4;

    /// The number.
    fn number(&self, set: &TextureTable, shapes: &impl Shapes, at: &TexturePoint) -> f32;

    /// (∂/∂u, ∂/∂v) of the number, `moved` being ∂p/∂u and ∂p/∂v; by default from differences.
    fn gradient(
        &self,
        set: &TextureTable,
        shapes: &impl Shapes,
        at: &TexturePoint,
        moved: [Vec3; 2],
    ) -> Vec2 {
        gradient_by_differences(at, moved, |at| self.number(set, shapes, at))
    }

    /// Three raw channels.
    fn colour(&self, set: &TextureTable, shapes: &impl Shapes, at: &TexturePoint) -> Vec3;

    /// The mean over the texture and the wavelengths, for choosing among lobes and lights only:
    /// images are averaged over their texels as if `to_uv` showed all of them alike, and a mesh
    /// attribute, whose values are not known here, counts as ½.
    fn mean(&self, set: &TextureTable) -> f32;

    /// Whether the texture is the same everywhere.
    fn is_constant(&self, _: &TextureTable) -> bool {
        false
    }

    /// The textures that it refers to.
    fn nested(&self) -> &[TextureId] {
        &[]
    }

    /// What helps where it is asked at a point of space: `None` if it has a value there, as far as what it refers to has, and
    /// not on surfaces only.
    fn instead_in_space(&self) -> Option<&'static str>;

    /// Not less than its value at any wavelength and anywhere in the world's box from `low` to `high`; infinite if nothing
    /// is known.
    fn most_within(&self, _: &TextureTable, _low: Vec3, _high: Vec3) -> f32 {
        f32::INFINITY
    }

    /// Not more than its value at any wavelength and anywhere in that box, as far as is known.
    fn least_within(&self, _: &TextureTable, _low: Vec3, _high: Vec3) -> f32 {
        0.0
    }

    /// The corners of the world's box beyond which a medium of this density ends; `None` if it has no end.
    fn extent(&self, _: &TextureTable) -> Option<[Vec3; 2]> {
        None
    }

    /// How many parts of its extent, along the longest side, may differ; 1 if nothing is known.
    fn cells(&self, set: &TextureTable) -> u32 {
        let nested = self.nested().iter().map(|&id| set.get(id).cells(set));
        nested.max().unwrap_or(1)
    }
}

/// One that scenes call a texture or a volume, as they like.
const EITHER: &str = "expression";

/// Those that scenes call volumes.
const VOLUMES: [&str; 2] = ["constvolume", "gridvolume"];

macro_rules! textures {
    ($($(#[doc = $doc:literal])* $model:ident { $($plugin:literal => $read:expr,)* })*) => {
        /// Any texture.
        #[derive(Clone, Debug, PartialEq)]
        pub enum Texture {
            $($(#[doc = $doc])* $model($model),)*
        }

        /// Names of the textures and spectra that are built.
        pub const BUILT: &[&str] = &[$($($plugin,)*)*];

        /// Whether textures of this plugin vary in space, whatever those do that they refer to.
        pub fn varies(plugin: &str) -> bool {
            match plugin {
                $($($plugin => <$model as TextureModel>::VARIES,)*)*
                _ => false,
            }
        }

        $(impl From<$model> for Texture {
            fn from(texture: $model) -> Self {
                Self::$model(texture)
            }
        })*

        impl TextureReader<'_> {
            /// Reads a nested object; `None` after a mistake.
            pub(crate) fn plugin(&mut self, params: &Params<'_>, purpose: Use) -> Option<Texture> {
                type Read =
                    fn(&mut TextureReader<'_>, &Params<'_>, Use) -> Option<Texture>;
                let read: Read = match params.node.plugin.value.as_str() {
                    $($($plugin => $read,)*)*
                    _ => {
                        let is_volume = params.node.class == Class::Volume;
                        let of_class = |name: &&str| *name == EITHER || VOLUMES.contains(name) == is_volume;
                        let built = BUILT.iter().copied().filter(of_class);
                        self.diagnostics.push(plugins::not_built(params.node, built));
                        return None;
                    }
                };
                let texture = read(self, params, purpose);
                params.finish_after(texture.is_some());
                texture
            }
        }

        /// Asks the texture, whichever it is.
        macro_rules! ask {
            ($texture:expr, $it:ident => $answer:expr) => {
                match $texture {
                    $(Texture::$model($it) => $answer,)*
                }
            };
        }
    };
}

// The list: each texture with the plugins that make it.
textures! {
    /// The same everywhere.
    Constant {
        "blackbody" => spectra::read,
        "constvolume" => constant::read_volume,
        "illuminant" => spectra::read,
        "irregular" => spectra::read,
        "rawconstant" => constant::read,
        "regular" => spectra::read,
        "srgb" => spectra::read,
        "uniform" => spectra::read,
    }
    /// An image.
    Bitmap { "bitmap" => bitmap::read, }
    /// Two textures in squares.
    Checkerboard { "checkerboard" => checkerboard::read, }
    /// A quantity stored on a mesh.
    MeshAttribute { "mesh_attribute" => mesh_attribute::read, }
    /// Two textures in a computed pattern.
    Procedural {
        "bricks" => procedural::read,
        "cubes" => procedural::read,
        "dots" => procedural::read,
        "fbm" => procedural::read,
        "gradient" => procedural::read,
        "marble" => procedural::read,
        "noise" => procedural::read,
        "turbulence" => procedural::read,
        "voronoi" => procedural::read,
        "wood" => procedural::read,
    }
    /// Another by coordinates that follow from the place.
    Projected { "projected" => projected::read, }
    /// k of a reflectance.
    Extinction { "extinction" => extinction::read, }
    /// Light by temperature.
    Incandescence { "incandescence" => incandescence::read, }
    /// Colours along a line.
    Ramp { "ramp" => ramp::read, }
    /// Computed from others.
    Arithmetic {
        "add" => arithmetic::read,
        "mix" => arithmetic::read,
        "multiply" => arithmetic::read,
        "scale" => arithmetic::read,
    }
    /// By a formula.
    Computed { "expression" => computed::read, }
    /// Values on a grid in space.
    Grid {
        "gridvolume" => grid::read,
        "volume" => grid::read_on_surface,
    }
    /// Another texture times D65.
    TimesD65 { "d65" => times_d65::read, }
}

impl Texture {
    /// Pixels of an image, width and height; 1 × 1 of anything else.
    pub fn resolution(&self) -> [u32; 2] {
        match self {
            Self::Bitmap(bitmap) => bitmap.resolution(),
            _ => [1; 2],
        }
    }

    /// The spectrum at a point, for the wavelengths `lambda` (nm). `set` holds the textures that
    /// this one refers to.
    #[inline]
    pub fn spectrum(
        &self,
        set: &TextureTable,
        shapes: &impl Shapes,
        at: &TexturePoint,
        lambda: Vec4,
    ) -> Vec4 {
        ask!(self, texture => TextureModel::spectrum(texture, set, shapes, at, lambda))
    }

    /// The number at a point.
    #[inline]
    pub fn number(&self, set: &TextureTable, shapes: &impl Shapes, at: &TexturePoint) -> f32 {
        ask!(self, texture => TextureModel::number(texture, set, shapes, at))
    }

    /// (∂/∂u, ∂/∂v) of the number at a point, which moves by `moved` with u and v.
    pub fn gradient(
        &self,
        set: &TextureTable,
        shapes: &impl Shapes,
        at: &TexturePoint,
        moved: [Vec3; 2],
    ) -> Vec2 {
        ask!(self, texture => TextureModel::gradient(texture, set, shapes, at, moved))
    }

    /// Three raw channels at a point.
    #[inline]
    pub fn colour(&self, set: &TextureTable, shapes: &impl Shapes, at: &TexturePoint) -> Vec3 {
        ask!(self, texture => TextureModel::colour(texture, set, shapes, at))
    }

    /// The mean over the texture and the wavelengths, for choosing among lobes and lights only:
    /// images are averaged over their texels as if `to_uv` showed all of them alike, and a mesh
    /// attribute, whose values are not known here, counts as ½.
    pub fn mean(&self, set: &TextureTable) -> f32 {
        ask!(self, texture => texture.mean(set))
    }

    /// Whether the texture is the same everywhere.
    pub fn is_constant(&self, set: &TextureTable) -> bool {
        ask!(self, texture => texture.is_constant(set))
    }

    /// Not less than its value at any wavelength and anywhere in the world's box from `low` to `high`; infinite if nothing
    /// is known.
    pub fn most_within(&self, set: &TextureTable, low: Vec3, high: Vec3) -> f32 {
        ask!(self, texture => texture.most_within(set, low, high))
    }

    /// Not more than its value at any wavelength and anywhere in the world's box from `low` to `high`, as far as is known.
    pub fn least_within(&self, set: &TextureTable, low: Vec3, high: Vec3) -> f32 {
        ask!(self, texture => texture.least_within(set, low, high))
    }

    /// The corners of the world's box beyond which a medium of this density ends; `None` if it has no end.
    pub fn extent(&self, set: &TextureTable) -> Option<[Vec3; 2]> {
        ask!(self, texture => texture.extent(set))
    }

    /// How many parts of its extent, along the longest side, may differ; 1 if nothing is known.
    pub fn cells(&self, set: &TextureTable) -> u32 {
        ask!(self, texture => texture.cells(set))
    }

    /// What helps where it is asked at a point of space, if it has a value on surfaces only.
    pub fn instead_in_space(&self) -> Option<&'static str> {
        ask!(self, texture => texture.instead_in_space())
    }

    /// The textures that it refers to.
    pub(crate) fn nested(&self) -> &[TextureId] {
        ask!(self, texture => texture.nested())
    }
}
