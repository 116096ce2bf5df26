//! What sensors that measure one number have in common.

use crate::{FilmWindow, Pose};
use etalon_math::Animated;
use etalon_params::{DMat4, DVec3, Diagnostic, Params};
use etalon_transport::Shutter;
use glam::{UVec2, Vec3};

/// Whether the film has one pixel; otherwise a mistake is recorded.
pub(crate) fn has_one_pixel(params: &Params<'_>, window: FilmWindow) -> bool {
    let is_one = window.size == UVec2::ONE;
    if !is_one {
        let plugin = &params.node.plugin;
        let UVec2 { x, y } = window.size;
        let message = format!(
            "`{}` measures one number, and its film has {x} × {y} pixels",
            plugin.value
        );
        let help = "give it a film of `width` and `height` 1, or a `batch` of n sensors one that is n pixels wide";
        (params.diagnostics).push(Diagnostic::error(plugin.span, message).help(help));
    }
    is_one
}

/// Reads where a sensor looks: `direction`, with `origin` if it has one, or `to_world`, whose +z is the direction.
pub(crate) fn aim(
    params: &Params<'_>,
    has_origin: bool,
    shutter: &Shutter,
) -> Option<Animated<Pose>> {
    let origin = has_origin.then(|| params.vector("origin")).flatten();
    let direction = params.vector("direction");
    let (given, missing) = match (origin, direction) {
        (None, None) => return Pose::from_params(params, false, shutter),
        (Some(_), None) => ("origin", Some(("direction", "where it looks"))),
        (_, Some(_)) if has_origin && origin.is_none() => {
            ("direction", Some(("origin", "where it is")))
        }
        _ => ("direction", None),
    };
    if params.has("to_world") {
        let message = format!("give either `{given}` or `to_world`, not both");
        params.error_at(given, message);
        return None;
    }
    if let Some((name, what)) = missing {
        params.missing(name, what);
        return None;
    }
    let (origin, direction) = (origin.unwrap_or_default(), direction?);
    let finite = origin.is_finite().then_some(origin);
    let unit = direction.try_normalize().filter(|unit| unit.is_finite());
    let pose = finite.zip(unit).and_then(|(origin, z)| {
        let (x, y) = z.any_orthonormal_pair();
        let [x, y, z] = [x, y, z].map(|axis| axis.extend(0.0));
        Pose::new(&DMat4::from_cols(x, y, z, origin.extend(1.0)))
    });
    if pose.is_none() {
        let (name, DVec3 { x, y, z }) = match finite {
            Some(_) => ("direction", direction),
            None => ("origin", origin),
        };
        let what = "finite numbers, for a direction not all 0";
        params.refuse(name, format!("({x}, {y}, {z})"), what);
    }
    pose.map(Animated::from)
}

/// The unit direction in which a sensor at this pose looks.
#[inline]
pub(crate) fn axis(pose: &Pose) -> Vec3 {
    pose.vector(Vec3::Z).normalize()
}

/// The parts of the contract of a [`Camera`](etalon_transport::Camera) that a sensor does not have which nothing can be connected with.
macro_rules! unconnected {
    () => {
        fn rays<F: Lane>(&self, raster: [F; 2], lens: [F; 2], time: F) -> CameraRays<F> {
            CameraRays::one_by_one(self, raster, lens, time)
        }

        fn connect(&self, _: Vec3, _: Vec2, _: f32, _: f32) -> Option<CameraSample> {
            None
        }

        fn can_connect(&self) -> bool {
            false
        }

        fn intersect_aperture(&self, _: &Ray, _: f32) -> Option<ApertureHit> {
            None
        }

        fn can_receive(&self) -> bool {
            false
        }
    };
}
pub(crate) use unconnected;
