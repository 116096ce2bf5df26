//! Clouds of ellipsoids from PLY files, as those of Gaussians that are splatted (Kerbl, Kopanas, Leimkühler & Drettakis
//! 2023, *3D Gaussian splatting for real-time radiance field rendering*): the common part of `ellipsoids` and `ellipsoidsmesh`.
//!
//! A vertex is an ellipsoid: its centre c (`x y z`), the logarithms s of its radii (`scale_0` to `scale_2`), its rotation
//! q, a quaternion with its real part first (`rot_0` to `rot_3`), and attributes.
//!
//! ```text
//! p(n) = to_world(c + e f R(q) diag(max(exp s, 10⁻⁶)) n),   |n| = 1
//! ```
//!
//! f is `scale_factor`, e is `extent`: how many standard deviations of a Gaussian it goes out to. With
//! `extent_adaptive_clamping` it is e/3 √(2 ln(α/0.01)): for e = 3 to where a Gaussian of opacity α has fallen to 0.01.

use crate::placement::Placement;
use crate::shapes::curves::control_points::fits;
use crate::shapes::mesh::file_mesh;
use etalon_math::float64::{exp, ln};
use etalon_params::{Diagnostic, Params};
use etalon_transport::file::span_of_filename;
use etalon_transport::{Attribute, Build, MeshData, MeshFormat};
use glam::{DMat3, DQuat, DVec3, DVec4, Vec3};

/// The least radius, before it is scaled.
const LEAST_RADIUS: f64 = 1e-6;

/// What a Gaussian has fallen to where it is cut off.
const LEAST_RESPONSE: f64 = 0.01;

/// The attribute that says how opaque each is.
const OPACITIES: &str = "vertex_opacities";

/// c + A n, |n| = 1.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ellipsoid {
    /// c.
    pub(crate) center: DVec3,
    /// A: the images of the axes.
    pub(crate) axes: DMat3,
}

/// Ellipsoids, and what is known of each besides.
pub(crate) struct Cloud {
    pub(crate) ellipsoids: Vec<Ellipsoid>,
    pub(crate) attributes: Vec<Attribute>,
}

/// How the ellipsoids of a file are changed.
struct Options {
    placement: Placement,
    scale_factor: f64,
    extent: f64,
    adaptive: bool,
}

impl Cloud {
    /// Reads `filename`, `scale_factor` (1), `extent` (3), `extent_adaptive_clamping` (false) and `to_world`.
    pub(crate) fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let placement = Placement::from_params(params);
        let positive = |name, default| {
            let what = "a finite number above 0";
            params.float_where(name, default, what, |x| x > 0.0 && fits(x))
        };
        let (scale_factor, extent) = (positive("scale_factor", 1.0), positive("extent", 3.0));
        let adaptive = params.boolean_or("extent_adaptive_clamping", false);
        let what = "the PLY file of ellipsoids";
        let (name, data) = file_mesh::contents(params, build, Some(MeshFormat::PlyPoints), what)?;
        let options = Options {
            placement: placement?,
            scale_factor,
            extent,
            adaptive,
        };
        let span = span_of_filename(params);
        match Self::new(data, &options) {
            Ok((cloud, note)) => {
                if let Some(note) = note {
                    let message = format!("`{name}`: {note}");
                    params.diagnostics.push(Diagnostic::note(span, message));
                }
                Some(cloud)
            }
            Err(reason) => {
                let message = format!("`{name}` cannot be used: {reason}");
                params.diagnostics.push(Diagnostic::error(span, message));
                None
            }
        }
    }

    /// The ellipsoids of a file, and what is odd about it.
    fn new(data: MeshData, options: &Options) -> Result<(Self, Option<String>), String> {
        let mut attributes = data.attributes;
        let scales = take(&mut attributes, "scale", 3)?;
        let rotations = take(&mut attributes, "rot", 4)?;
        attributes.iter_mut().for_each(rename);
        read_splats(&mut attributes);
        let opacities = attributes.iter().find(|a| is(a, OPACITIES, 1));
        let mut note = None;
        let extents: Vec<Option<f64>> = match opacities.filter(|_| options.adaptive) {
            Some(opacities) => {
                let adapted = |alpha: &f32| adaptive_extent(options.extent, f64::from(*alpha));
                opacities.values.iter().map(adapted).collect()
            }
            None => {
                note = options.adaptive.then(|| {
                    "there are no `opacities`, so that `extent_adaptive_clamping` does nothing"
                        .into()
                });
                vec![Some(options.extent); data.positions.len()]
            }
        };
        let mut ellipsoids = Vec::with_capacity(extents.len());
        let numbers = scales.chunks_exact(3).zip(rotations.chunks_exact(4));
        let all = data.positions.iter().zip(numbers).zip(&extents);
        for (index, ((center, (scale, rotation)), extent)) in all.enumerate() {
            if let Some(extent) = extent {
                let factor = options.scale_factor * extent;
                let ellipsoid = ellipsoid(*center, scale, rotation, factor, &options.placement);
                let place = |reason| format!("ellipsoid {index}, counted from 0: {reason}");
                ellipsoids.push(ellipsoid.map_err(place)?);
            }
        }
        let left_out = extents.len() - ellipsoids.len();
        if left_out > 0 {
            attributes.iter_mut().for_each(|a| keep(a, &extents));
            note = Some(format!(
                "{left_out} of its {} ellipsoids have an opacity of {LEAST_RESPONSE} or less, and are left out",
                extents.len()
            ));
        }
        Ok((
            Self {
                ellipsoids,
                attributes,
            },
            note,
        ))
    }
}

/// How far a Gaussian of opacity α goes out, if anywhere.
fn adaptive_extent(extent: f64, alpha: f64) -> Option<f64> {
    (alpha > LEAST_RESPONSE).then(|| extent / 3.0 * (2.0 * ln(alpha / LEAST_RESPONSE)).sqrt())
}

/// An ellipsoid of the file where it belongs.
fn ellipsoid(
    center: Vec3,
    scale: &[f32],
    rotation: &[f32],
    factor: f64,
    placement: &Placement,
) -> Result<Ellipsoid, String> {
    let scale = Vec3::from_slice(scale).as_dvec3();
    let [w, x, y, z] = [0, 1, 2, 3].map(|i| f64::from(rotation[i]));
    let Some(rotation) = DVec4::new(x, y, z, w).try_normalize() else {
        return Err(format!("its rotation {w} {x} {y} {z} is no quaternion"));
    };
    let radii = scale.to_array().map(|s| exp(s).max(LEAST_RADIUS) * factor);
    let turned = DMat3::from_quat(DQuat::from_vec4(rotation));
    let axes = *placement.linear() * turned * DMat3::from_diagonal(DVec3::from(radii));
    let center = placement.point(center.as_dvec3());
    let exists = scale.is_finite()
        && axes.to_cols_array().into_iter().all(fits)
        && axes.inverse().is_finite();
    if !exists {
        return Err(format!(
            "its scale {} {} {} gives no radii that 32-bit floats can hold",
            scale.x, scale.y, scale.z
        ));
    }
    if !center.to_array().into_iter().all(fits) {
        return Err("it lies too far away".into());
    }
    Ok(Ellipsoid { center, axes })
}

fn is(attribute: &Attribute, name: &str, channels: usize) -> bool {
    attribute.name == name && attribute.channels == channels
}

/// The values of the properties `name_0 …`, which are needed.
fn take(attributes: &mut Vec<Attribute>, name: &str, channels: usize) -> Result<Vec<f32>, String> {
    let full = format!("vertex_{name}");
    let place = attributes.iter().position(|a| is(a, &full, channels));
    let place = place.ok_or_else(|| {
        format!(
            "its vertices need the properties `{name}_0` to `{name}_{}`",
            channels - 1
        )
    })?;
    Ok(attributes.remove(place).values)
}

/// A property may have the name already that Mitsuba's `mesh_attribute` asks for.
fn rename(attribute: &mut Attribute) {
    if let Some(inner) = attribute.name.strip_prefix("vertex_vertex_") {
        attribute.name = format!("vertex_{inner}");
    }
}

/// A file of splats, known by `f_dc_0`, has one logit of opacity for each: `opacity` becomes the opacity, `opacities`.
fn read_splats(attributes: &mut [Attribute]) {
    if !attributes.iter().any(|a| is(a, "vertex_f_dc", 3)) {
        return;
    }
    if let Some(opacity) = attributes.iter_mut().find(|a| is(a, "vertex_opacity", 1)) {
        opacity.name = OPACITIES.to_owned();
        let logistic = |x: f32| (1.0 / (1.0 + exp(-f64::from(x)))) as f32;
        opacity.values.iter_mut().for_each(|x| *x = logistic(*x));
    }
}

/// Keeps the values of those that have an extent.
fn keep(attribute: &mut Attribute, extents: &[Option<f64>]) {
    let rows = attribute.values.chunks_exact(attribute.channels);
    let kept = rows.zip(extents).filter(|(_, extent)| extent.is_some());
    attribute.values = kept.flat_map(|(row, _)| row).copied().collect();
}
