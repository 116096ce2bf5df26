//! The list of cameras a scene can ask for.

use crate::measured_surface::{MeasuredSurface, SensorShapes};
use crate::{
    Batch, Distant, FilmWindow, Fisheye, IrradianceMeter, Orthographic, Panoramic, Perspective,
    RadianceMeter, Spherical, ThinLens,
};
use etalon_math::lane::Lane;
use etalon_params::{Class, Params, plugins};
use etalon_transport::{ApertureHit, Camera, CameraRay, CameraRays, CameraSample, Ray, Shutter};
use glam::{Vec2, Vec3};

macro_rules! cameras {
    ($($(#[$doc:meta])* $variant:ident($camera:ty) { $plugin:literal => |$params:pat_param, $window:pat_param, $shutter:pat_param, $shapes:pat_param| $read:expr })*) => {
        /// Any camera; some measure on surfaces `S`.
        #[derive(Clone, Debug, PartialEq)]
        pub enum AnyCamera<S> {
            $($(#[$doc])* $variant($camera),)*
        }

        /// Names of the cameras that are built.
        pub const BUILT: &[&str] = &[$($plugin),*];

        impl<S: MeasuredSurface> AnyCamera<S> {
            fn by_plugin(
                params: &Params<'_>,
                window: FilmWindow,
                shutter: &Shutter,
                shapes: &mut SensorShapes<'_, S>,
            ) -> Option<Option<Self>> {
                match params.node.plugin.value.as_str() {
                    $($plugin => {
                        let ($params, $window, $shutter, $shapes) = (params, window, shutter, shapes);
                        Some($read.map(Self::$variant))
                    })*
                    _ => None,
                }
            }
        }

        impl<S: MeasuredSurface> Camera for AnyCamera<S> {
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

            fn can_connect(&self) -> bool {
                match self { $(Self::$variant(camera) => camera.can_connect(),)* }
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
    Perspective(Perspective) { "perspective" => |params, window, shutter, _| Perspective::from_params(params, window, shutter) }
    /// A perspective camera with an ideal lens.
    ThinLens(ThinLens) { "thinlens" => |params, window, shutter, _| ThinLens::from_params(params, window, shutter) }
    /// Parallel rays.
    Orthographic(Orthographic) { "orthographic" => |params, window, shutter, _| Orthographic::from_params(params, window, shutter) }
    /// All directions.
    Spherical(Panoramic<Spherical>) { "spherical" => |params, window, shutter, _| Panoramic::from_params(params, window, shutter, Spherical::from_params) }
    /// A cone of directions.
    Fisheye(Panoramic<Fisheye>) { "fisheye" => |params, window, shutter, _| Panoramic::from_params(params, window, shutter, Fisheye::from_params) }
    /// One ray.
    RadianceMeter(RadianceMeter) { "radiancemeter" => |params, window, shutter, _| RadianceMeter::from_params(params, window, shutter) }
    /// The irradiance on a shape.
    IrradianceMeter(IrradianceMeter<S>) { "irradiancemeter" => |params, window, _, shapes| IrradianceMeter::from_params(params, window, shapes.carrier.as_ref()) }
    /// Parallel rays from infinity.
    Distant(Distant<S>) { "distant" => |params, window, shutter, shapes| Distant::from_params(params, window, shutter, shapes) }
    /// Several sensors.
    Batch(Batch<S>) { "batch" => |params, window, shutter, shapes| Batch::from_params(params, window, shutter, shapes) }
}

impl<S: MeasuredSurface> AnyCamera<S> {
    /// Reads a sensor node for a film of `window`. The children `film`, `rfilter`, `sampler` and `medium`, and `srf`, belong to
    /// the scene, which reads them itself; they are marked as used here. Reports every mistake,
    /// unknown properties included; `None` if no camera can be made of it.
    pub fn from_params(
        params: &Params<'_>,
        window: FilmWindow,
        shapes: &mut SensorShapes<'_, S>,
    ) -> Option<(Self, Shutter)> {
        let shutter = Shutter::from_params(params, window.size.y);
        let camera = Self::read(params, window, &shutter, shapes);
        params.children(Class::Medium);
        params.children(Class::Film);
        params.children(Class::Sampler);
        params.children(Class::ReconstructionFilter);
        params.finish_after(camera.is_some());
        Some((camera?, shutter))
    }

    /// Reads what is a sensor's own.
    pub(crate) fn read(
        params: &Params<'_>,
        window: FilmWindow,
        shutter: &Shutter,
        shapes: &mut SensorShapes<'_, S>,
    ) -> Option<Self> {
        let is_of_shape = matches!(
            params.node.plugin.value.as_str(),
            "irradiancemeter" | "batch"
        );
        if shapes.carrier.is_some() && !is_of_shape {
            let message = format!(
                "{} stands in the scene, not in a shape",
                params.node.with_article()
            );
            params.error(message);
            return None;
        }
        let read = Self::by_plugin(params, window, shutter, shapes);
        read.unwrap_or_else(|| {
            let built = BUILT.iter().copied();
            let unknown = plugins::not_built(params.node, built);
            params.diagnostics.push(unknown);
            None
        })
    }

    /// Whether its film only gathers samples of a quantity that does not depend on places within a pixel, so that a filter wider than
    /// a pixel says nothing.
    pub fn is_meter(&self) -> bool {
        match self {
            Self::RadianceMeter(_) | Self::IrradianceMeter(_) | Self::Distant(_) => true,
            Self::Batch(batch) => batch.sensors().iter().any(Self::is_meter),
            _ => false,
        }
    }

    /// Tells cameras at infinity the bounds of the scene, which are finite unless there is nothing in it.
    pub fn surround(&mut self, bounds: [Vec3; 2]) {
        match self {
            Self::Distant(distant) => distant.surround(bounds),
            Self::Batch(batch) => {
                for sensor in batch.sensors_mut() {
                    sensor.surround(bounds);
                }
            }
            _ => {}
        }
    }
}
