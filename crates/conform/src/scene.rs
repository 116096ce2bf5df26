//! A scene that any renderer can be asked to render: resolved, in metres and watts, without transforms or defaults.
//!
//! All is grey: a number stands for every wavelength, or for red, green and blue alike. Axes are right-handed. The picture is
//! square; its first row is the top one. Radiance is in any unit that goes through the whole scene; so are intensity (that
//! unit times m²) and irradiance (times sr).

use glam::DVec3;
use serde::{Deserialize, Serialize};

/// The version of the format.
pub const VERSION: u32 = 1;

/// A point or a direction as JSON has it.
pub type Triple = [f64; 3];

/// A scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// [`VERSION`].
    pub version: u32,
    /// The question that it poses.
    pub question: String,
    /// Rows and columns of the picture.
    pub pixels: u32,
    /// The camera.
    pub camera: Camera,
    /// What has a surface.
    pub objects: Vec<Object>,
    /// Lights without extent.
    pub lights: Vec<Light>,
    /// What surrounds all, if anything.
    pub sky: Option<Sky>,
}

/// A camera. Each pixel is the mean of its square of the film (a box filter).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Camera {
    /// Where it stands.
    pub origin_m: Triple,
    /// What it looks at.
    pub target_m: Triple,
    /// A direction that points up in the picture.
    pub up: Triple,
    /// How it projects.
    pub projection: Projection,
}

/// How a camera projects.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, tag = "kind", rename_all = "snake_case")]
pub enum Projection {
    /// Parallel rays.
    Orthographic {
        /// Width and height of what is seen.
        width_m: f64,
    },
    /// Rays through a point; the radiance that arrives is shown, without a factor for the angle.
    Pinhole {
        /// The angle from the left to the right edge.
        field_of_view_degrees: f64,
    },
    /// Rays through a round lens, evenly over it.
    ThinLens {
        /// The angle from the left to the right edge, seen from the middle of the lens.
        field_of_view_degrees: f64,
        /// Radius of the lens.
        lens_radius_m: f64,
        /// Distance of the plane that is sharp.
        focus_distance_m: f64,
    },
}

/// A surface, or a body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Object {
    /// Its form.
    pub shape: Shape,
    /// How it scatters light.
    pub material: Material,
    /// Radiance that it emits from its outer side, evenly in all directions; 0 for none.
    pub emitted_radiance: f64,
    /// What is inside.
    pub interior: Option<Medium>,
}

/// A form.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, tag = "kind", rename_all = "snake_case")]
pub enum Shape {
    /// A sphere.
    Sphere {
        /// Its centre.
        center_m: Triple,
        /// Its radius.
        radius_m: f64,
        /// Whether its outer side, which emits, is the one toward the centre.
        inward: bool,
    },
    /// A parallelogram; its outer side is that of the normal u × v.
    Quad {
        /// Its centre.
        center_m: Triple,
        /// From its centre to the middle of a side.
        half_u_m: Triple,
        /// From its centre to the middle of the next side.
        half_v_m: Triple,
    },
    /// A box of three orthogonal half axes, right-handed.
    Box {
        /// Its centre.
        center_m: Triple,
        /// From its centre to the middles of three faces.
        half_axes_m: [Triple; 3],
    },
    /// Flat triangles; the outer side of each is the one from which its corners turn to the left.
    Mesh {
        /// The corners.
        positions_m: Vec<Triple>,
        /// Three indices of corners for each triangle.
        triangles: Vec<[u32; 3]>,
    },
}

/// How a surface scatters light.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, tag = "kind", rename_all = "snake_case")]
pub enum Material {
    /// Lambert's: the fraction of light that is reflected, from either side.
    Diffuse {
        /// The fraction.
        reflectance: f64,
    },
    /// Reflects a fraction that does not depend on the angle.
    Mirror {
        /// The fraction.
        reflectance: f64,
    },
    /// A smooth metal in air.
    Conductor {
        /// Real part of the index of refraction.
        n: f64,
        /// Imaginary part.
        k: f64,
    },
    /// A rough metal in air: microfacets of Trowbridge and Reitz's distribution (GGX), which reflect once.
    RoughConductor {
        /// Real part of the index of refraction.
        n: f64,
        /// Imaginary part.
        k: f64,
        /// The width of the distribution of slopes.
        alpha: f64,
        /// How facets hide each other.
        masking: Masking,
    },
    /// Smooth clear glass in air, without polarisation.
    Glass {
        /// Its index of refraction.
        n: f64,
    },
    /// No surface at all: the border of a medium.
    Nothing,
}

/// How microfacets hide each other from the light and from the eye, by Smith's Λ of either direction. Programs have different
/// rules, each with a truth of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Masking {
    /// Independently: 1/((1 + Λ(o)) (1 + Λ(i))).
    Separable,
    /// Facets that lie deep are hidden from both: 1/(1 + Λ(o) + Λ(i)).
    HeightCorrelated,
}

/// What scatters and absorbs within a body, evenly in all directions.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Medium {
    /// Absorption coefficient.
    pub absorption_per_m: f64,
    /// Scattering coefficient.
    pub scattering_per_m: f64,
}

/// A light without extent.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, tag = "kind", rename_all = "snake_case")]
pub enum Light {
    /// Shines from a point, evenly in all directions.
    Point {
        /// The point.
        position_m: Triple,
        /// Its intensity.
        intensity: f64,
    },
    /// Shines from a point into a cone: evenly up to one angle, not at all beyond another.
    Spot {
        /// The point.
        position_m: Triple,
        /// A point on the axis.
        target_m: Triple,
        /// Its intensity within the first angle.
        intensity: f64,
        /// The first angle, from the axis.
        even_to_degrees: f64,
        /// The second.
        dark_from_degrees: f64,
        /// What is between the two; null where nothing is asked of that.
        falloff: Option<Falloff>,
    },
    /// Parallel light.
    Sun {
        /// Where the light goes.
        direction: Triple,
        /// Irradiance across it.
        irradiance: f64,
    },
}

/// How the light of a spot falls off between its two angles. Programs have different rules, each with a truth of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Falloff {
    /// As the angle from the axis grows: t = (dark − θ)/(dark − even).
    LinearInAngle,
    /// t² (3 − 2t), t = (cos θ − cos dark)/(cos even − cos dark).
    SmoothInCosine,
    /// t⁴ of the same t.
    QuarticInCosine,
}

/// What surrounds all.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, tag = "kind", rename_all = "snake_case")]
pub enum Sky {
    /// The same radiance in all directions.
    Even {
        /// That radiance.
        radiance: f64,
    },
    /// A radiance for each cell of a net of meridians and parallels. Azimuths are counted from the meridian toward
    /// zenith × meridian; column j has those from j 2π/columns to (j + 1) 2π/columns.
    Map {
        /// Where the radiances stand, and what is between.
        interpolation: Interpolation,
        /// The direction of the first row's upper edge.
        zenith: Triple,
        /// The direction, at a right angle to the zenith, of the first column's edge.
        meridian: Triple,
        /// Cells from the zenith to its opposite.
        rows: u32,
        /// Cells all around.
        columns: u32,
        /// Radiance toward the scene from each cell, row by row.
        radiance: Vec<f64>,
    },
}

/// How a sky is between the radiances that are given. Programs have different rules, each with a truth of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Interpolation {
    /// Not interpolated: row i has the angles from the zenith from iπ/rows to (i + 1)π/rows, and all of a cell is even.
    None,
    /// Bilinear in the two angles between the middles of the same cells.
    Linear,
    /// Bilinear, but row i stands at the angle iπ/(rows − 1) from the zenith: the first and the last at the poles.
    RowsToPoles,
}

impl Scene {
    /// The greatest radiance that anything with an extent emits.
    pub fn brightest_emission(&self) -> f64 {
        let objects = self.objects.iter().map(|object| object.emitted_radiance);
        let sky = match &self.sky {
            None => &[][..],
            Some(Sky::Even { radiance }) => std::slice::from_ref(radiance),
            Some(Sky::Map { radiance, .. }) => radiance,
        };
        objects.chain(sky.iter().copied()).fold(0.0, f64::max)
    }

    /// The scene as JSON.
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).expect("numbers and names")
    }
}

/// The unit normal of a quad.
pub fn quad_normal(half_u: Triple, half_v: Triple) -> DVec3 {
    DVec3::from(half_u).cross(half_v.into()).normalize()
}
