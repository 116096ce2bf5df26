//! `to_uv`: the affine map from a surface's texture coordinates to those of an image.

use etalon_params::{DMat4, Params};
use glam::{Affine2, Mat2, Vec2};

/// An affine map of the plane: the xy part of a transform of space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UvTransform(Affine2);

impl UvTransform {
    /// The map that changes nothing.
    pub const IDENTITY: Self = Self(Affine2::IDENTITY);

    /// The xy part of a matrix; its other rows and columns have no meaning here. `None` if it is
    /// not finite.
    pub fn from_matrix(matrix: &DMat4) -> Option<Self> {
        let column = |c: glam::DVec4| c.truncate().truncate().as_vec2();
        let map = Affine2::from_mat2_translation(
            Mat2::from_cols(column(matrix.x_axis), column(matrix.y_axis)),
            column(matrix.w_axis),
        );
        map.is_finite().then_some(Self(map))
    }

    /// Reads `to_uv`.
    pub fn from_params(params: &Params<'_>) -> Self {
        Self::from_matrix(&params.transform("to_uv")).unwrap_or_else(|| {
            params.error_at("to_uv", "`to_uv` must be finite");
            Self::IDENTITY
        })
    }

    /// The gradient by the surface's texture coordinates, from the gradient `image` by the image's.
    pub fn gradient(&self, image: Vec2) -> Vec2 {
        self.0.matrix2.transpose() * image
    }

    /// The image of texture coordinates.
    #[inline]
    pub fn apply(&self, uv: Vec2) -> Vec2 {
        self.0.transform_point2(uv)
    }
}
