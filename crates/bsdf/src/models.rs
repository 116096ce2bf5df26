//! The list of all materials, and their dispatch.
//!
//! To add a model, write its file and add one line to the list at the end of this one. The
//! scene keyword, the documentation table and the whole test harness follow from it.

pub mod blendbsdf;
pub mod bumpmap;
pub mod classicphong;
pub mod coat;
pub mod coatedconductor;
pub mod coateddiffuse;
pub mod coating;
pub mod conductor;
pub mod dielectric;
pub mod difftrans;
pub mod diffuse;
pub mod disney;
pub mod hair;
pub mod mask;
pub mod measured;
pub mod mirror;
pub mod mixture;
pub mod mixturebsdf;
pub mod normalmap;
pub mod null;
pub mod phong;
pub mod plastic;
pub mod pplastic;
pub mod principled;
pub mod principledthin;
pub mod roughcoating;
pub mod roughconductor;
pub mod roughdielectric;
pub mod roughdiffuse;
pub mod roughplastic;
pub mod thindielectric;
pub mod twosided;
pub mod ward;

use crate::{BsdfAtPoint, Bxdf, Lobe, LobeList, MAX_LOBES, MaterialFlags, ShadingContext};
use etalon_math::Frame;
use etalon_params::{Class, Diagnostic, Diagnostics, Node, Params, plugins};
use etalon_spectrum::Wavelengths;
use etalon_transport::{BsdfSample, Build, SurfaceInteraction, Textures, TransportMode};
use glam::{Vec2, Vec3, Vec4};
use std::sync::Arc;

macro_rules! models {
    (
        plain {
            $($plain_name:literal $plain:ident $plain_module:ident $flags:tt
                $(<$life:lifetime>)?,)*
        }
        composed { $($composed_name:literal $composed:ident $composed_module:ident,)* }
        lobes { $($lobe:ident $lobe_module:ident $(<$lobe_life:lifetime>)?,)* }
    ) => {
        /// A material as the scene describes it: a model's parameters with their textures.
        #[derive(Clone, Debug)]
        pub enum Material {
            $(#[doc = concat!("`", $plain_name, "`.")]
            $plain($plain_module::Description),)*
            $(#[doc = concat!("`", $composed_name, "`.")]
            $composed($composed_module::Description),)*
        }

        /// A model with plain parameters.
        #[derive(Clone, Copy, Debug)]
        pub enum AnyBxdf<'a> {
            $(#[doc = concat!("See [`", stringify!($plain_module), "`].")]
            $plain($plain_module::$plain $(<$life>)?),)*
            $(#[doc = concat!("See [`", stringify!($lobe_module), "`].")]
            $lobe($lobe_module::$lobe $(<$lobe_life>)?),)*
        }

        /// The names of all BSDF plugins.
        pub fn plugin_names() -> impl Iterator<Item = &'static str> {
            [$($plain_name,)* $($composed_name,)*].into_iter()
        }

        /// The materials that the tests of all models run on, in a one-line notation:
        /// `plugin key=kind:value … ( nested ) …`, with the kinds `f` number, `i` integer, `s` string, `b`
        /// boolean, `u` uniform and `t` tabulated spectrum.
        pub fn test_materials() -> impl Iterator<Item = &'static str> {
            [$($plain_module::EXEMPLARS,)* $($composed_module::EXEMPLARS,)*]
                .into_iter()
                .flatten()
                .copied()
        }

        impl Material {
            fn from_named(
                params: &Params<'_>,
                build: &mut dyn Build,
            ) -> Option<Option<Self>> {
                Some(match params.node.plugin.value.as_str() {
                    $($plain_name => $plain_module::Description::from_params(params, build)
                        .map(Self::$plain),)*
                    $($composed_name => $composed_module::Description::from_params(params, build)
                        .map(Self::$composed),)*
                    _ => return None,
                })
            }

            /// The material's flags.
            pub fn traits(&self) -> MaterialFlags {
                match self {
                    $(Self::$plain(description) => $flags(description),)*
                    $(Self::$composed(description) => description.traits(),)*
                }
            }

            /// The material at a point, for the known direction `wo` and the path's wavelengths.
            #[inline]
            pub fn resolve<T: Textures>(
                &self,
                textures: &T,
                vertex: &SurfaceInteraction,
                wo: Vec3,
                wavelengths: &Wavelengths,
            ) -> BsdfAtPoint<'_> {
                let site = ShadingContext::new(textures, vertex, wo, wavelengths);
                let scatter = match self {
                    $(Self::$plain(description) => AnyBxdf::$plain(description.resolve(&site)),)*
                    $(Self::$composed(_))|* => return self.resolve_composed(&site, vertex),
                };
                BsdfAtPoint::one(
                    vertex.normal,
                    Lobe {
                        scatter,
                        frame: vertex.shading,
                        weight: 1.0,
                        probability: 1.0,
                        tilt: None,
                    },
                )
            }

            /// Adds the material's lobes, together having the share `weight` of the light.
            pub fn flatten<'a, T: Textures>(
                &'a self,
                site: &ShadingContext<'_, T>,
                frame: Frame,
                weight: f32,
                into: &mut LobeList<'a>,
            ) {
                if !(weight > 0.0) {
                    return;
                }
                match self {
                    $(Self::$plain(description) => into.push(
                        AnyBxdf::$plain(description.resolve(site)),
                        frame,
                        weight,
                        weight,
                    ),)*
                    $(Self::$composed(description) => description.flatten(site, frame, weight, into),)*
                }
            }
        }

        impl Bxdf for AnyBxdf<'_> {
            #[inline]
            fn eval_and_density(&self, wo: Vec3, wi: Vec3, mode: TransportMode) -> (Vec4, Vec4) {
                match self {
                    $(Self::$plain(model) => model.eval_and_density(wo, wi, mode),)*
                    $(Self::$lobe(model) => model.eval_and_density(wo, wi, mode),)*
                }
            }

            #[inline]
            fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2, mode: TransportMode) -> Option<BsdfSample> {
                match self {
                    $(Self::$plain(model) => model.sample(wo, u_lobe, u, mode),)*
                    $(Self::$lobe(model) => model.sample(wo, u_lobe, u, mode),)*
                }
            }

            fn sample_by_density(
                &self,
                wo: Vec3,
                u_lobe: f32,
                u: Vec2,
                mode: TransportMode,
            ) -> Option<BsdfSample> {
                match self {
                    $(Self::$plain(model) => model.sample_by_density(wo, u_lobe, u, mode),)*
                    $(Self::$lobe(model) => model.sample_by_density(wo, u_lobe, u, mode),)*
                }
            }

            fn samples_by_walk(&self) -> bool {
                match self {
                    $(Self::$plain(model) => model.samples_by_walk(),)*
                    $(Self::$lobe(model) => model.samples_by_walk(),)*
                }
            }

            fn discrete(&self, wo: Vec3, index: u32, mode: TransportMode) -> Option<BsdfSample> {
                match self {
                    $(Self::$plain(model) => model.discrete(wo, index, mode),)*
                    $(Self::$lobe(model) => model.discrete(wo, index, mode),)*
                }
            }

            #[inline]
            fn has_continuous(&self) -> bool {
                match self {
                    $(Self::$plain(model) => model.has_continuous(),)*
                    $(Self::$lobe(model) => model.has_continuous(),)*
                }
            }

            fn has_discrete(&self) -> bool {
                match self {
                    $(Self::$plain(model) => model.has_discrete(),)*
                    $(Self::$lobe(model) => model.has_discrete(),)*
                }
            }

            #[inline]
            fn transmits(&self) -> bool {
                match self {
                    $(Self::$plain(model) => model.transmits(),)*
                    $(Self::$lobe(model) => model.transmits(),)*
                }
            }

            fn albedo(&self, wo: Vec3) -> Vec4 {
                match self {
                    $(Self::$plain(model) => model.albedo(wo),)*
                    $(Self::$lobe(model) => model.albedo(wo),)*
                }
            }
        }
    };
}

impl Material {
    /// The material that a node describes. After a mistake, which has been recorded, `None`.
    pub fn from_params(
        node: &Arc<Node>,
        build: &mut dyn Build,
        diagnostics: &Diagnostics,
    ) -> Option<Self> {
        let material = Self::from_node(node, build, diagnostics)?;
        let lobes = material.traits().lobes;
        if lobes > MAX_LOBES {
            diagnostics.push(
                Diagnostic::error(
                    node.plugin.span,
                    format!("this material mixes {lobes} models"),
                )
                .help(format!(
                    "at most {MAX_LOBES} models can be mixed at a point"
                )),
            );
            return None;
        }
        Some(material)
    }

    /// As [`Material::from_params`], for a material nested in another.
    pub(crate) fn from_node(
        node: &Arc<Node>,
        build: &mut dyn Build,
        diagnostics: &Diagnostics,
    ) -> Option<Self> {
        let params = Params::new(node, diagnostics);
        match Self::from_named(&params, build) {
            Some(material) => {
                params.finish_after(material.is_some());
                material
            }
            None => {
                diagnostics.push(plugins::not_built(node, plugin_names()));
                None
            }
        }
    }

    /// The `N` materials nested in a composed one, in the order of the file; a diagnostic if
    /// there are more or fewer.
    pub(crate) fn nested<const N: usize>(
        params: &Params<'_>,
        build: &mut dyn Build,
    ) -> Option<[Self; N]> {
        Self::scattering(params, Self::nested_or_classic::<N>(params, build)?)
    }

    /// The same where a classic Phong material may be nested, too.
    pub(crate) fn nested_or_classic<const N: usize>(
        params: &Params<'_>,
        build: &mut dyn Build,
    ) -> Option<[Self; N]> {
        let given = params.children(Class::Bsdf).len();
        let materials = Self::all(params, build);
        if given != N {
            params.error(format!(
                "`{}` needs {N} nested BSDF{}, not {given}",
                params.node.plugin.value,
                if N == 1 { "" } else { "s" },
            ));
            return None;
        }
        materials.try_into().ok()
    }

    /// The materials nested in a composed one that could be read, in the order of the file.
    pub(crate) fn all_nested(params: &Params<'_>, build: &mut dyn Build) -> Option<Vec<Self>> {
        Self::scattering(params, Self::all(params, build))
    }

    /// The nested materials, if none of them is a classic Phong material; otherwise that is said.
    fn scattering<M: AsRef<[Self]>>(params: &Params<'_>, materials: M) -> Option<M> {
        let Some(index) = materials.as_ref().iter().position(Self::is_classic) else {
            return Some(materials);
        };
        let message = format!(
            "`{}` takes BSDFs, and a classic Phong material is none",
            params.node.plugin.value
        );
        let children = params.children(Class::Bsdf);
        let own = params.node.plugin.span;
        let span = children
            .get(index)
            .map_or(own, |(_, node)| node.plugin.span);
        let help =
            "put it on a shape, by itself or in `twosided`, `mask`, `normalmap` or `bumpmap`";
        (params.diagnostics).push(Diagnostic::error(span, message).help(help));
        None
    }

    fn all(params: &Params<'_>, build: &mut dyn Build) -> Vec<Self> {
        (params.children(Class::Bsdf).into_iter())
            .filter_map(|(_, node)| Self::from_node(node, build, params.diagnostics))
            .collect()
    }

    /// Whether light may go straight on, so that shadow rays need a transmittance.
    pub fn has_null(&self) -> bool {
        self.traits().null
    }

    /// Whether light leaves elsewhere than it came, so that only paths from the camera can have it.
    pub fn is_one_way(&self) -> bool {
        self.traits().one_way
    }

    fn resolve_composed<T: Textures>(
        &self,
        site: &ShadingContext<'_, T>,
        vertex: &SurfaceInteraction,
    ) -> BsdfAtPoint<'_> {
        let mut lobes = LobeList::default();
        self.flatten(site, vertex.shading, 1.0, &mut lobes);
        lobes.resolved(vertex.normal)
    }
}

models! {
    plain {
        "diffuse" Diffuse diffuse (MaterialFlags::reflecting),
        "dielectric" Dielectric dielectric (MaterialFlags::refracting),
        "roughdielectric" RoughDielectric roughdielectric (MaterialFlags::refracting),
        "conductor" Conductor conductor (MaterialFlags::reflecting),
        "roughconductor" RoughConductor roughconductor (MaterialFlags::reflecting),
        "plastic" Plastic plastic (MaterialFlags::reflecting),
        "roughplastic" RoughPlastic roughplastic (MaterialFlags::reflecting) <'a>,
        "principled" Principled principled (principled::Description::flags),
        "principledthin" PrincipledThin principledthin (principledthin::Description::flags),
        "phong" Phong phong (MaterialFlags::reflecting),
        "pplastic" PolarizedPlastic pplastic (MaterialFlags::reflecting),
        "ward" Ward ward (MaterialFlags::reflecting),
        "roughdiffuse" RoughDiffuse roughdiffuse (MaterialFlags::reflecting),
        "measured" Measured measured (MaterialFlags::reflecting) <'a>,
        "hair" Hair hair (hair::Description::flags),
        "difftrans" DiffuseTransmission difftrans (difftrans::Description::flags),
        "coateddiffuse" CoatedDiffuse coateddiffuse (MaterialFlags::reflecting),
        "coatedconductor" CoatedConductor coatedconductor (MaterialFlags::reflecting),
    }
    composed {
        "thindielectric" ThinDielectric thindielectric,
        "mask" Mask mask,
        "twosided" TwoSided twosided,
        "blendbsdf" Blend blendbsdf,
        "mixturebsdf" Mixture mixturebsdf,
        "mixture" Die mixture,
        "coating" Coating coating,
        "roughcoating" RoughCoating roughcoating,
        "normalmap" NormalMap normalmap,
        "bumpmap" BumpMap bumpmap,
        "null" Null null,
        "classicphong" LegacyPhong classicphong,
    }
    lobes {
        Mirror mirror,
        Coated coating <'a>,
    }
}
