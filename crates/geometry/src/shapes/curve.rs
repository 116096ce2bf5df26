//! `curve`: a line through points, by formulas, or where a function of the plane vanishes, drawn as a tube or as a flat
//! stroke.
//!
//! ```text
//! tube     p(u, φ) = c(u) + w(u)/2 (cos φ n(u) + sin φ t(u) × n(u))
//! stroke   p(u, s) = c(u) + w(u) s n(u),   −½ ≤ s ≤ ½,   n ⊥ t in the plane z = 0
//! ```
//!
//! with the unit tangent t, and in space the normal n that turns about t no more than it must (W. Wang, B. Jüttler,
//! D. Zheng, Y. Liu 2008, *Computation of rotation minimizing frames*). Where the tangent jumps, n turns about the
//! corner, so that corners are round.
//!
//! Both are meshes whose corners lie on the surface: of `sides` facets around, and along the curve so many that no chord is
//! farther from it than a facet is from its circle, w/2 (1 − cos(π/sides)), which is .001 w for 48.

mod contour;
mod joints;
mod lines;
mod stroke;
mod tube;
mod uncovered;

use crate::placement::Placement;
use crate::shapes::mesh::{Mesh, MeshOptions};
use crate::shapes::shape_model::read_flip;
use core::f64::consts::PI;
use etalon_math::float64::cos;
use etalon_params::Params;
use etalon_transport::MeshData;
use glam::{DVec2, DVec3};

/// The resolution of a curve.
#[derive(Clone, Copy, Debug)]
struct Fineness {
    /// Facets around.
    sides: usize,
}

impl Fineness {
    /// The largest distance of a chord from the curve, as a share of the width.
    fn off(self) -> f64 {
        0.5 * (1.0 - cos(PI / self.sides as f64))
    }

    /// The largest turn of the tangent from one joint to the next (radians).
    fn turn(self) -> f64 {
        2.0 * PI / self.sides as f64
    }
}

/// The caps of an open curve.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Ends {
    /// Flat caps at the end points.
    Flat,
    /// Half a ball, or half a disk, beyond.
    Round,
    /// A tube without lids.
    Open,
}

/// Corners, normals, texture coordinates and triangles under construction.
#[derive(Default)]
struct Net(MeshData);

impl Net {
    fn corner(&mut self, position: DVec3, normal: DVec3, uv: DVec2) -> u32 {
        self.0.positions.push(position.as_vec3());
        self.0.normals.push(normal.normalize_or_zero().as_vec3());
        self.0.uvs.push(uv.as_vec2());
        self.0.positions.len() as u32 - 1
    }

    /// Adds a triangle if it has three corners in different places.
    fn triangle(&mut self, corners: [u32; 3]) {
        let [a, b, c] = corners.map(|i| self.0.positions[i as usize]);
        if a != b && b != c && c != a {
            self.0.triangles.push(corners);
        }
    }
}

/// Reads the line, see `curve/lines.rs`, `style` (`tube` or `flat`), `ends` (`flat`, `round` or, of a tube, `open`), `sides`
/// (48), `face_normals`, `flip_normals` and `to_world`.
pub(crate) fn from_params(params: &Params<'_>) -> Option<Mesh> {
    let placement = Placement::from_params(params);
    let face_normals = params.boolean_or("face_normals", false);
    let flip_normals = read_flip(params);
    let asked = params.integer_or("sides", 48);
    let sides = (usize::try_from(asked).ok()).filter(|n| (3..=1024).contains(n));
    if sides.is_none() {
        params.refuse("sides", asked, "a whole number from 3 to 1024");
    }
    let flat = params.choice("style", "tube", &["tube", "flat"]) == "flat";
    let ends = match params.choice("ends", "flat", &["flat", "round", "open"]) {
        "round" => Ends::Round,
        "open" if flat => {
            let message = "a `flat` curve has no lids that it could leave open";
            params.error_with_help("ends", message, "accepted: `flat`, `round`");
            return None;
        }
        "open" => Ends::Open,
        _ => Ends::Flat,
    };
    let fineness = Fineness {
        sides: sides.unwrap_or(48),
    };
    let strands = lines::from_params(params, fineness)?;
    let is_plane = |p: DVec3| p.z == 0.0;
    let mut joints = strands.iter().flat_map(|strand| &strand.joints);
    if flat && !joints.all(|joint| is_plane(joint.position)) {
        let message = "a `flat` curve lies in the plane z = 0: this one leaves it";
        let help = "`to_world` takes the plane elsewhere; a `tube` may go anywhere";
        params.error_with_help("style", message, help);
        return None;
    }
    let mut net = Net::default();
    if flat {
        stroke::add(&strands, ends, fineness, &mut net);
    } else {
        for strand in &strands {
            tube::add(strand, ends, fineness, &mut net);
        }
    }
    sides?;
    if net.0.triangles.is_empty() {
        params.error_at("width", "nothing of this curve is seen: its width is 0");
        return None;
    }
    let options = MeshOptions {
        placement: placement?,
        face_normals,
        flip_normals,
        ..MeshOptions::default()
    };
    Mesh::new(net.0, &options)
        .map_err(|message| params.error_at("to_world", message))
        .ok()
}
