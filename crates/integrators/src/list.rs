//! The list of integrators: one line each.

use crate::ao::AmbientOcclusion;
use crate::aov::Aov;
use crate::bdpt::Bidirectional;
use crate::depth::Depth;
use crate::direct::Direct;
use crate::distribution::Distribution;
use crate::field::Field;
use crate::forward::Forward;
use crate::guided::Guided;
use crate::metropolis::mmlt::Multiplexed;
use crate::metropolis::pssmlt::PrimarySpace;
use crate::moment::Moment;
use crate::naive::Naive;
use crate::path::Path;
use crate::photons::photonmap::PhotonMapper;
use crate::photons::sppm::Progressive;
use crate::ptracer::ParticleTracer;
use crate::render::RenderPlan;
use crate::render::signature::Signature;
use crate::render::{Progress, RenderStatistics, render};
use crate::replay::{Address, Describe, Replay, replay};
use crate::vcm::ConnectionMerging;
use crate::whitted::Whitted;
use core::any::Any;
use etalon_params::{Class, Diagnostics, Node, Params, plugins};
use etalon_sampling::{ReplicateKind, Sampler};
use etalon_transport::{
    Channel, Film, Incompatibility, Integrator, PixelSample, SceneCapabilities, Sink, World,
};
use glam::Vec2;

macro_rules! integrators {
    ($($name:literal $(| $alias:literal)* => $variant:ident: $read:expr;)*) => {
        /// Any integrator that a scene can ask for.
        #[derive(Clone, Debug)]
        #[allow(missing_docs)]
        pub enum AnyIntegrator {
            $($variant($variant),)*
        }

        /// The names under which scenes ask for integrators.
        pub fn names() -> &'static [&'static str] {
            &[$($name, $($alias,)*)*]
        }

        /// The names of those that estimate all radiance without bias.
        pub fn unbiased() -> Vec<&'static str> {
            let all = [$(($name, $variant::UNBIASED)),*];
            all.into_iter().filter_map(|(name, unbiased)| unbiased.then_some(name)).collect()
        }

        /// The names of those that see participating media.
        fn seeing_media() -> String {
            let all = [$(($name, $variant::MEDIA)),*];
            listed(all.into_iter())
        }

        /// The names of those that see diffusion profiles.
        fn seeing_diffusion() -> String {
            let all = [$(($name, $variant::DIFFUSION)),*];
            listed(all.into_iter())
        }

        impl AnyIntegrator {
            /// Reads an integrator from its description. `None` if there is no integrator of
            /// that name, or after a mistake, which has been recorded.
            pub fn from_node(node: &Node, diagnostics: &Diagnostics) -> Option<Self> {
                let params = Params::new(node, diagnostics);
                let read = match node.plugin.value.as_str() {
                    $($name $(| $alias)* => {
                        let read: fn(&Params<'_>) -> Option<$variant> = $read;
                        read(&params).map(Self::$variant)
                    })*
                    _ => {
                        diagnostics.push(plugins::not_built(node, names().iter().copied()));
                        return None;
                    }
                };
                params.finish_after(read.is_some());
                read
            }

            /// The channels it writes beside the colour.
            pub fn channels(&self) -> Vec<Channel> {
                match self {
                    $(Self::$variant(integrator) => integrator.channels(),)*
                }
            }

            /// Whether it splats to pixels other than the current one.
            pub fn splats(&self) -> bool {
                match self {
                    $(Self::$variant(integrator) => integrator.splats(),)*
                }
            }

            /// How its replicates are related.
            pub fn replicate_kind(&self) -> ReplicateKind {
                match self {
                    $(Self::$variant(integrator) => integrator.replicate_kind(),)*
                }
            }

            /// Samples per pixel after which it must prepare again; `None` if a replicate is one
            /// pass.
            pub fn samples_per_pass(&self) -> Option<u32> {
                match self {
                    $(Self::$variant(integrator) => integrator.samples_per_pass(),)*
                }
            }

            /// The reasons why it cannot render a scene, or not all of its light.
            pub fn incompatibilities(&self, capabilities: &SceneCapabilities) -> Vec<Incompatibility> {
                fn all<I: Integrator>(
                    integrator: &I,
                    capabilities: &SceneCapabilities,
                ) -> Vec<Incompatibility> {
                    let unseen = (!I::MEDIA).then(|| capabilities.media_unseen(&seeing_media()));
                    let diffusion = (I::MEDIA && !I::DIFFUSION)
                        .then(|| capabilities.diffusion_unseen(&seeing_diffusion()));
                    let endless = capabilities.endless_lit().filter(|_| I::FOLLOWS_LIGHT);
                    let one_way = capabilities.seen_one_way().filter(|_| I::FOLLOWS_LIGHT);
                    let unseen = unseen.into_iter().chain(diffusion).flatten().chain(endless).chain(one_way);
                    unseen.chain(integrator.incompatibilities(capabilities)).collect()
                }
                match self {
                    $(Self::$variant(integrator) => all(integrator, capabilities),)*
                }
            }

            /// Renders with it: see [`render`].
            pub fn render<W: World, F: Film>(
                &self,
                worlds: &[W],
                film: &mut F,
                plan: &RenderPlan,
                progress: &dyn Progress,
            ) -> RenderStatistics {
                match self {
                    $(Self::$variant(integrator) => render(worlds, integrator, film, plan, progress),)*
                }
            }

            /// Draws samples again: see [`replay`].
            pub fn replay<W: World, F: Film>(
                &self,
                world: &W,
                film: &F,
                plan: &RenderPlan,
                addresses: &[Address],
                describe: &Describe<'_>,
            ) -> Vec<Replay> {
                match self {
                    $(Self::$variant(integrator) => replay(world, integrator, film, plan, addresses, describe),)*
                }
            }

            /// Draws one sample for an integrator that contains this one. Nested integrators
            /// write to a sink behind a pointer, or their types would nest without end.
            pub(crate) fn sample_nested<W: World, S: Sampler>(
                &self,
                world: &W,
                site: &PixelSample,
                sampler: &mut S,
                sink: &mut dyn Sink,
            ) {
                let mut sink = DynSink(sink);
                match self {
                    $(Self::$variant(integrator) => {
                        if let Some(state) = unprepared(integrator) {
                            integrator.sample(world, state, site, sampler, &mut sink);
                        }
                    })*
                }
            }

            /// Whether it learns anything before it samples.
            pub fn prepares(&self) -> bool {
                match self {
                    $(Self::$variant(integrator) => unprepared(integrator).is_none(),)*
                }
            }
        }
    };
}

integrators! {
    "path" | "volpath" | "volpathmis" => Path: |p| Some(Path::from_params(p));
    "naive" => Naive: |p| Some(Naive::from_params(p));
    "direct" => Direct: |p| Some(Direct::from_params(p));
    "guided" => Guided: |p| Some(Guided::from_params(p));
    "depth" => Depth: |_| Some(Depth);
    "signature" => Signature: |_| Some(Signature);
    "bdpt" => Bidirectional: |p| Some(Bidirectional::from_params(p));
    "ptracer" => ParticleTracer: |p| Some(ParticleTracer::from_params(p));
    "pssmlt" => PrimarySpace: |p| Some(PrimarySpace::from_params(p));
    "mmlt" => Multiplexed: |p| Some(Multiplexed::from_params(p));
    "forward" => Forward: |p| Some(Forward::from_params(p));
    "ao" => AmbientOcclusion: |p| Some(AmbientOcclusion::from_params(p));
    "aov" => Aov: Aov::from_params;
    "field" => Field: Field::from_params;
    "photonmap" => PhotonMapper: |p| Some(PhotonMapper::from_params(p));
    "sppm" => Progressive: |p| Some(Progressive::from_params(p));
    "vcm" => ConnectionMerging: |p| Some(ConnectionMerging::from_params(p));
    "moment" => Moment: Moment::from_params;
    "distribution" => Distribution: |p| Some(Distribution::from_params(p));
    "whitted" => Whitted: |p| Some(Whitted::from_params(p));
}

/// Names of those that are so, for a message.
fn listed<'n>(all: impl Iterator<Item = (&'n str, bool)>) -> String {
    let able: Vec<String> = (all.filter(|(_, able)| *able))
        .map(|(name, _)| format!("`{name}`"))
        .collect();
    able.join(", ")
}

/// The state of an integrator that learns nothing, `()`; `None` for others.
fn unprepared<I: Integrator>(_: &I) -> Option<&'static I::State> {
    (&() as &dyn Any).downcast_ref()
}

/// An integrator inside another.
#[derive(Clone, Debug)]
pub(crate) struct Nested {
    /// Its name in the scene file, which begins its channels' names.
    pub(crate) name: String,
    /// The integrator.
    pub(crate) integrator: AnyIntegrator,
    /// Number of channels beside the colour.
    pub(crate) channels: usize,
}

impl Nested {
    /// The incompatibilities of nested integrators.
    pub(crate) fn incompatibilities(
        nested: &[Self],
        capabilities: &SceneCapabilities,
    ) -> Vec<Incompatibility> {
        let each = nested
            .iter()
            .map(|n| n.integrator.incompatibilities(capabilities));
        each.flatten().collect()
    }

    /// Blocks, if all nested integrators may have them.
    pub(crate) fn replicate_kind(nested: &[Self]) -> ReplicateKind {
        let mut kinds = nested.iter().map(|n| n.integrator.replicate_kind());
        match kinds.all(|kind| kind == ReplicateKind::Blocks) {
            true => ReplicateKind::Blocks,
            false => ReplicateKind::Independent,
        }
    }

    /// The integrators nested in a description, in its order. Integrators that splat are
    /// refused, as their contributions belong to no sample of the pixel; and so are those that prepare.
    pub(crate) fn all(params: &Params<'_>) -> Option<Vec<Self>> {
        let mut nested = Vec::new();
        for (position, (property, node)) in
            params.children(Class::Integrator).into_iter().enumerate()
        {
            let integrator = AnyIntegrator::from_node(node, params.diagnostics)?;
            let obstacle = if integrator.splats() {
                Some("its contributions land on any pixel")
            } else if integrator.prepares() {
                Some("it prepares for a whole picture, which is a render of its own")
            } else {
                None
            };
            if let Some(obstacle) = obstacle {
                params.diagnostics.push(etalon_params::Diagnostic::error(
                    node.plugin.span,
                    format!(
                        "`{}` cannot be nested in `{}`: {obstacle}",
                        node.plugin.value, params.node.plugin.value
                    ),
                ));
                return None;
            }
            let name = if property.name.is_empty() {
                node.id
                    .clone()
                    .unwrap_or_else(|| format!("integrator{position}"))
            } else {
                property.name.clone()
            };
            nested.push(Self {
                name,
                channels: integrator.channels().len(),
                integrator,
            });
        }
        Some(nested)
    }
}

/// A sink behind a pointer.
struct DynSink<'a>(&'a mut dyn Sink);

impl Sink for DynSink<'_> {
    fn radiance(&mut self, rgb: [f32; 3], alpha: f32) {
        self.0.radiance(rgb, alpha);
    }

    fn splat(&mut self, raster: Vec2, rgb: [f32; 3]) {
        self.0.splat(raster, rgb);
    }

    fn channel(&mut self, index: usize, value: f32) {
        self.0.channel(index, value);
    }
}
