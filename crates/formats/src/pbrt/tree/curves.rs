//! Curves (`shapes.cpp`, `Curve::Create`): cubic Bézier curves as `beziercurve`, ribbons as meshes.
//!
//! Curves of degree 2 are raised to 3, and B-splines become Bézier curves, both exactly. The width falls in proportion to the parameter from `width0`
//! to `width1` over all segments. A `cylinder` is a tube as Etalon has it. A `flat` curve turns its flat side to whoever looks at it; that a
//! `hair` cannot tell from a tube, since its own normal is not looked at, and other materials are noted. A `ribbon` is a strip of rectangles.
//!
//! Curves that stand one after another, and on which the same holds, are one shape: hair comes by the million.

use super::super::parameters::Parameters;
use super::super::scene::Shape;
use super::Mapper;
use super::node::{Draft, word};
use super::shapes::{Form, Wanted};
use crate::document::embedded_name;
use etalon_math::float64;
use etalon_params::{DMat4, DVec3};
use etalon_transport::MeshData;
use glam::Vec2;
use std::fmt::Write;
use std::sync::Arc;

/// Rectangles of a segment of a ribbon.
const STEPS: usize = 16;

/// A cubic Bézier curve with its widths at both ends.
struct Piece {
    points: [DVec3; 4],
    widths: [f64; 2],
}

/// One `Shape "curve"`.
struct Curve {
    pieces: Vec<Piece>,
    /// At the ends of the pieces of a ribbon.
    normals: Option<Vec<DVec3>>,
    is_flat: bool,
}

/// How many of the first shapes are curves that may become one shape.
pub(crate) fn run(shapes: &[Shape]) -> usize {
    let plain = |shape: &Shape| {
        let params = &shape.entity.params;
        shape.entity.kind == "curve"
            && shape.area_light.is_none()
            && params.find("alpha").is_none()
            && params.find("N").is_none()
    };
    let Some(first) = shapes.first().filter(|first| plain(first)) else {
        return 1;
    };
    let alike = |shape: &&Shape| {
        plain(shape)
            && shape.material == first.material
            && [shape.inside, shape.outside] == [first.inside, first.outside]
            && shape.reverse_orientation == first.reverse_orientation
            && (Arc::ptr_eq(&shape.placement, &first.placement)
                || shape.placement == first.placement)
    };
    shapes.iter().take_while(alike).count()
}

impl<'a> Mapper<'a> {
    /// A curve, and those that follow it; `None` after a mistake.
    pub(crate) fn curves(&mut self, params: &Parameters<'a>, wanted: &Wanted<'a>) -> Option<Form> {
        let material = self.scene.materials[wanted.shape.material].entity.kind;
        if wanted.by_uv && material == "hair" {
            let what = "texture coordinates of a `curve` of `hair`";
            let accepted = "other materials, and hair without images and patterns";
            self.refuse_value(params, "P", what, accepted);
            params.entity.params.iter().for_each(|p| p.mark_used());
            return None;
        }
        let first = read(params);
        let mut curves = vec![first];
        for shape in wanted.following {
            let params = self.read(&shape.entity);
            curves.push(read(&params));
            params.finish();
        }
        let curves: Option<Vec<Curve>> = curves.into_iter().collect();
        let curves = curves?;
        if let [
            Curve {
                pieces,
                normals: Some(normals),
                ..
            },
        ] = &curves[..]
        {
            let mesh = ribbon(pieces, normals);
            let draft = self.mesh_shape(params, wanted, mesh)?;
            return Some(Form {
                drafts: vec![draft],
                area: None,
            });
        }
        self.note_flat_curves(params, wanted, curves.iter().any(|curve| curve.is_flat));
        let draft = self.tubes(params, wanted, &curves)?;
        Some(Form {
            drafts: vec![draft],
            area: None,
        })
    }

    fn tubes(
        &mut self,
        params: &Parameters<'_>,
        wanted: &Wanted<'_>,
        curves: &[Curve],
    ) -> Option<Draft> {
        let name = embedded_name(self.embedded.len());
        let draft = self.placed_form(params, wanted, "beziercurve", DMat4::IDENTITY)?;
        // Etalon's radii are lengths in the world.
        let stretch = wanted.shape.placement.start.determinant().abs();
        let stretch = float64::cbrt(stretch);
        let mut text = String::new();
        for curve in curves {
            for (index, piece) in curve.pieces.iter().enumerate() {
                for k in usize::from(index > 0)..4 {
                    let [x, y, z] = piece.points[k].as_vec3().to_array();
                    let [from, to] = piece.widths;
                    let width = from + (to - from) * k as f64 / 3.0;
                    let radius = (0.5 * stretch * width.max(0.0)) as f32;
                    // Writing into a string does not fail.
                    let _ = writeln!(text, "{x} {y} {z} {radius}");
                }
            }
            text.push('\n');
        }
        self.embedded.push(Arc::new(text.into_bytes()));
        let draft = draft.plain("filename", word(&name));
        if !wanted.by_uv {
            return Some(draft);
        }
        let message =
            "v counts around this curve, where pbrt counts it across the width that is seen";
        let help = "u is the same: along each segment";
        self.note(params.entity.span, message, help);
        Some(draft.plain("coordinates", word("along")))
    }

    fn note_flat_curves(&self, params: &Parameters<'_>, wanted: &Wanted<'_>, any: bool) {
        let material = &self.scene.materials[wanted.shape.material];
        if any && material.entity.kind != "hair" {
            let message =
                "curves of the type `flat` are tubes: they do not turn to whoever looks at them";
            let help = "of hair the picture is the same";
            self.note(params.entity.span, message, help);
        }
    }
}

/// The curve of an entity; `None` after a mistake.
fn read(params: &Parameters<'_>) -> Option<Curve> {
    // How deep pbrt splits a curve to find rays that meet it.
    params.ignore(&["splitdepth"]);
    let bases = ["bezier", "bspline"];
    let is_spline = params.choice("basis", bases[0], &bases) == bases[1];
    let types = ["flat", "ribbon", "cylinder"];
    let form = params.choice("type", types[0], &types);
    let degree = params.integer("degree", 3);
    let width = params.float("width", 1.0);
    let accepted = "a finite number from 0 on";
    let widths = ["width0", "width1"]
        .map(|name| params.float_where(name, width, accepted, |w| w >= 0.0 && w.is_finite()));
    let normals = params.normals("N");
    let Some(points) = params.points3("P") else {
        params.missing("point3 P");
        return None;
    };
    let points: Vec<DVec3> = points.iter().copied().map(DVec3::from_array).collect();
    let degree = match degree {
        2 | 3 => degree as usize,
        other => {
            params.refuse("degree", other, "2, 3");
            return None;
        }
    };
    let fits = points.len() > degree && (is_spline || (points.len() - 1).is_multiple_of(degree));
    if !fits {
        let count = points.len();
        let rule = match is_spline {
            true => format!("at least {} for a B-spline", degree + 1),
            false => format!("{} and {degree} for each further segment", degree + 1),
        };
        let message =
            format!("a curve of degree {degree} cannot have {count} points `P`: it takes {rule}");
        params.error_at("P", message);
        return None;
    }
    let step = if is_spline { 1 } else { degree };
    let windows: Vec<&[DVec3]> = points.windows(degree + 1).step_by(step).collect();
    let count = windows.len() as f64;
    let width_at = |segment: usize| widths[0] + (widths[1] - widths[0]) * segment as f64 / count;
    let piece = |(segment, points): (usize, &&[DVec3])| Piece {
        points: cubic(points, is_spline),
        widths: [width_at(segment), width_at(segment + 1)],
    };
    let pieces: Vec<Piece> = windows.iter().enumerate().map(piece).collect();
    let normals = match (form, normals) {
        ("ribbon", Some(normals)) if normals.len() == pieces.len() + 1 => {
            let unit = |n: &[f64; 3]| DVec3::from_array(*n).normalize_or(DVec3::Z);
            Some(normals.iter().map(unit).collect())
        }
        ("ribbon", given) => {
            let given = given.map_or(0, <[_]>::len);
            let wanted = pieces.len() + 1;
            let place = if given > 0 { "N" } else { "P" };
            params.error_at(
                place,
                format!(
                    "a ribbon of {} segments takes {wanted} normals `N`, not {given}",
                    pieces.len()
                ),
            );
            return None;
        }
        (_, Some(_)) => {
            params.error_at(
                "N",
                format!("a curve of the type `{form}` has no normals `N`"),
            );
            return None;
        }
        _ => None,
    };
    Some(Curve {
        pieces,
        normals,
        is_flat: form == "flat",
    })
}

/// The cubic Bézier curve of a segment's control points.
fn cubic(points: &[DVec3], is_spline: bool) -> [DVec3; 4] {
    match (points, is_spline) {
        (&[a, b, c], false) => [a, a.lerp(b, 2.0 / 3.0), b.lerp(c, 1.0 / 3.0), c],
        (&[a, b, c], true) => cubic(&[0.5 * (a + b), b, 0.5 * (b + c)], false),
        (&[a, b, c, d], true) => {
            let (second, third) = (b.lerp(c, 1.0 / 3.0), b.lerp(c, 2.0 / 3.0));
            let first = 0.5 * (a.lerp(b, 2.0 / 3.0) + second);
            [first, second, third, 0.5 * (third + c.lerp(d, 1.0 / 3.0))]
        }
        (points, _) => core::array::from_fn(|i| points[i]),
    }
}

/// A strip of rectangles along the curve, across its normals, which turn along great arcs from one end to the other.
fn ribbon(pieces: &[Piece], normals: &[DVec3]) -> MeshData {
    let mut mesh = MeshData::default();
    for (piece, ends) in pieces.iter().zip(normals.windows(2)) {
        let start = mesh.positions.len() as u32;
        for step in 0..=STEPS {
            let u = step as f64 / STEPS as f64;
            let [a, b, c, d] = piece.points;
            let [ab, bc, cd] = [a.lerp(b, u), b.lerp(c, u), c.lerp(d, u)];
            let [abc, bcd] = [ab.lerp(bc, u), bc.lerp(cd, u)];
            let normal = slerp(ends[0], ends[1], u);
            let across = normal.cross(bcd - abc).normalize_or_zero();
            let width = piece.widths[0] + (piece.widths[1] - piece.widths[0]) * u;
            for v in [0.0, 1.0] {
                let at = abc.lerp(bcd, u) + across * (width * (v - 0.5));
                mesh.positions.push(at.as_vec3());
                mesh.normals.push(normal.as_vec3());
                mesh.uvs.push(Vec2::new(u as f32, v as f32));
            }
        }
        let rectangle = |step: u32| {
            let [a, b, c, d] = core::array::from_fn(|k| start + 2 * step + k as u32);
            [[a, c, d], [a, d, b]]
        };
        mesh.triangles.extend((0..STEPS as u32).flat_map(rectangle));
    }
    mesh
}

fn slerp(a: DVec3, b: DVec3, t: f64) -> DVec3 {
    let angle = a.angle_between(b);
    if angle < 1e-6 {
        return a;
    }
    let sin = float64::sin;
    (sin((1.0 - t) * angle) * a + sin(t * angle) * b) / sin(angle)
}
