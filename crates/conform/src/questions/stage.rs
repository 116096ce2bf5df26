//! What many scenes have in common.

use crate::scene::{
    Camera, Light, Material, Medium, Object, Projection, Scene, Shape, Sky, Triple, VERSION,
};
use etalon_math::float64::{cos, sin};

/// Rows and columns of the pictures.
pub(super) const PIXELS: u32 = 16;

/// A surface that reflects nothing.
pub(super) const BLACK: Material = Material::Diffuse { reflectance: 0.0 };

/// Reflects half.
pub(super) const GREY: Material = Material::Diffuse { reflectance: 0.5 };

/// A scene of nothing but what is given; whoever poses it names the question.
pub(super) fn scene(camera: Camera) -> Scene {
    Scene {
        version: VERSION,
        question: String::new(),
        pixels: PIXELS,
        camera,
        objects: Vec::new(),
        lights: Vec::new(),
        sky: None,
    }
}

impl Scene {
    /// With a surface of this material, which emits nothing.
    pub(super) fn with(self, shape: Shape, material: Material) -> Self {
        self.glowing(shape, material, 0.0)
    }

    /// With a surface that emits this radiance.
    pub(super) fn glowing(mut self, shape: Shape, material: Material, radiance: f64) -> Self {
        self.objects.push(Object {
            shape,
            material,
            emitted_radiance: radiance,
            interior: None,
        });
        self
    }

    /// With matter in a form that has no surface.
    pub(super) fn filled(mut self, shape: Shape, medium: Medium) -> Self {
        self.objects.push(Object {
            shape,
            material: Material::Nothing,
            emitted_radiance: 0.0,
            interior: Some(medium),
        });
        self
    }

    /// With a light.
    pub(super) fn lit(mut self, light: Light) -> Self {
        self.lights.push(light);
        self
    }

    /// Under an even sky.
    pub(super) fn under(mut self, radiance: f64) -> Self {
        self.sky = Some(Sky::Even { radiance });
        self
    }
}

/// Parallel rays along +y, z up, over a square of this width about the origin.
pub(super) fn along_y(width: f64) -> Camera {
    Camera {
        origin_m: [0.0, -3.0, 0.0],
        target_m: [0.0; 3],
        up: [0.0, 0.0, 1.0],
        projection: Projection::Orthographic { width_m: width },
    }
}

/// Parallel rays straight down, +y up in the picture and +x to the right, over a square of this width about a point.
pub(super) fn down([x, y, z]: Triple, width: f64) -> Camera {
    Camera {
        origin_m: [x, y, z + 0.2],
        target_m: [x, y, z],
        up: [0.0, 1.0, 0.0],
        projection: Projection::Orthographic { width_m: width },
    }
}

/// Parallel rays at this angle from the vertical, coming down along −x, over a square of this width about the origin. Up in the
/// picture is −x, and to the right +y.
pub(super) fn leaning(degrees: f64, width: f64) -> Camera {
    let angle = degrees.to_radians();
    Camera {
        origin_m: [2.0 * sin(angle), 0.0, 2.0 * cos(angle)],
        target_m: [0.0; 3],
        up: [0.0, 0.0, 1.0],
        projection: Projection::Orthographic { width_m: width },
    }
}

/// A square floor that faces up, 20 m wide.
pub(super) fn floor(z: f64) -> Shape {
    Shape::Quad {
        center_m: [0.0, 0.0, z],
        half_u_m: [10.0, 0.0, 0.0],
        half_v_m: [0.0, 10.0, 0.0],
    }
}

/// A square wall at y that faces −y, 12 m wide.
pub(super) fn wall(y: f64) -> Shape {
    Shape::Quad {
        center_m: [0.0, y, 0.0],
        half_u_m: [6.0, 0.0, 0.0],
        half_v_m: [0.0, 0.0, 6.0],
    }
}

/// A sphere that faces out.
pub(super) fn sphere(center: Triple, radius: f64) -> Shape {
    Shape::Sphere {
        center_m: center,
        radius_m: radius,
        inward: false,
    }
}

/// A sphere about the origin that faces its middle.
pub(super) fn inward_sphere(radius: f64) -> Shape {
    Shape::Sphere {
        center_m: [0.0; 3],
        radius_m: radius,
        inward: true,
    }
}

/// A square about a point that faces along a direction in the plane x = 0, with this half width.
pub(super) fn facing(center: Triple, [_, y, z]: Triple, half: f64) -> Shape {
    Shape::Quad {
        center_m: center,
        half_u_m: [half, 0.0, 0.0],
        // x × v is the direction.
        half_v_m: [0.0, half * z, -half * y],
    }
}

/// The squares of a cube of 2 m about the origin, which face its middle, each with the number of its axis and its side of it.
pub(super) fn cube() -> impl Iterator<Item = (usize, f64, Shape)> {
    (0..3)
        .flat_map(|axis| [(axis, -1.0), (axis, 1.0)])
        .map(|(axis, side)| {
            let mut square = [[0.0; 3]; 3];
            square[0][axis] = side;
            // u × v is the axis, or its opposite.
            square[1][(axis + 1) % 3] = -side;
            square[2][(axis + 2) % 3] = 1.0;
            let [center_m, half_u_m, half_v_m] = square;
            let shape = Shape::Quad {
                center_m,
                half_u_m,
                half_v_m,
            };
            (axis, side, shape)
        })
}
