//! The list of cameras a scene can ask for.

use crate::{FilmWindow, Orthographic, Perspective, ThinLens};
use etalon_math::lane::Lane;
use etalon_params::{Class, Params, plugins};
use etalon_transport::{ApertureHit, Camera, CameraRay, CameraRays, CameraSample, Ray, Shutter};
use glam::{Vec2, Vec3};

macro_rules! cameras {
    ($($(#[$doc:meta])* $plugin:literal => $variant:ident,)*) => {
        /// Any camera.
        #[derive(Clone, Debug, PartialEq)]
        pub enum AnyCamera {
            $($(#[$doc])* $variant($variant),)*
        }

        /// Names of the cameras that are built.
        pub const BUILT: &[&str] = &[$($plugin),*];

        impl AnyCamera {
            fn by_plugin(
                params: &Params<'_>,
                window: FilmWindow,
                shutter: &Shutter,
            ) -> Option<Option<Self>> {
                match params.node.plugin.value.as_str() {
                    $($plugin => {
                        Some($variant::from_params(params, window, shutter).map(Self::$variant))
                    })*
                    _ => None,
                }
            }
        }

        impl Camera for AnyCamera {
            #[inline]
            fn ray(&self, raster: Vec2, lens: Vec2, time: f32) -> CameraRay {
                match self { $(Self::$variant(camera) => camera.ray(raster, lens, time),)* }
            }

            #[inline(always)]
            fn rays<F: Lane>(&self, raster: [F; 2], lens: [F; 2], time: F) -> CameraRays<F> {
                match self { $(Self::$variant(camera) => camera.rays(raster, lens, time),)* }
            }

            #[inline]
            fn connect(&self, point: Vec3, lens: Vec2, time: f32, margin: f32) -> Option<CameraSample> {
                match self { $(Self::$variant(camera) => camera.connect(point, lens, time, margin),)* }
            }

            #[inline]
            fn intersect_aperture(&self, ray: &Ray, margin: f32) -> Option<ApertureHit> {
                match self { $(Self::$variant(camera) => camera.intersect_aperture(ray, margin),)* }
            }

            fn can_receive(&self) -> bool {
                match self { $(Self::$variant(camera) => camera.can_receive(),)* }
            }

            fn has_lens(&self) -> bool {
                match self { $(Self::$variant(camera) => camera.has_lens(),)* }
            }
        }
    };
}

cameras! {
    /// A pinhole camera.
    "perspective" => Perspective,
    /// A perspective camera with an ideal lens.
    "thinlens" => ThinLens,
    /// Parallel rays.
    "orthographic" => Orthographic,
}

impl AnyCamera {
    /// Reads a sensor node for a film of `window`. The children `film`, `rfilter`, `sampler` and `medium`, and `srf`, belong to
    /// the scene, which reads them itself; they are marked as used here. Reports every mistake,
    /// unknown properties included; `None` if no camera can be made of it.
    pub fn from_params(params: &Params<'_>, window: FilmWindow) -> Option<(Self, Shutter)> {
        let shutter = Shutter::from_params(params);
        let Some(camera) = Self::by_plugin(params, window, &shutter) else {
            let built = BUILT.iter().copied();
            params
                .diagnostics
                .push(plugins::not_built(params.node, built));
            return None;
        };
        params.children(Class::Medium);
        params.children(Class::Film);
        params.children(Class::Sampler);
        params.children(Class::ReconstructionFilter);
        params.finish_after(camera.is_some());
        Some((camera?, shutter))
    }
}
