//! Where a node stands in its parent: a matrix, or translation, rotation and scale (glTF 2.0, §3.5.3).

use ::gltf::json::scene::Node;
use etalon_params::{DMat4, DVec3};
use glam::{DMat3, DQuat};

/// Translation, rotation and scale, applied in the opposite order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pose {
    /// T.
    pub(crate) translation: DVec3,
    /// R, of any length.
    pub(crate) rotation: DQuat,
    /// S.
    pub(crate) scale: DVec3,
}

impl Pose {
    /// The pose of a node without a matrix.
    pub(crate) fn of(node: &Node) -> Self {
        let vector =
            |v: Option<[f32; 3]>, default| v.map_or(default, |v| DVec3::from(v.map(f64::from)));
        let rotation = node.rotation.map(|r| DQuat::from_array(r.0.map(f64::from)));
        Self {
            translation: vector(node.translation, DVec3::ZERO),
            rotation: rotation.unwrap_or_default(),
            scale: vector(node.scale, DVec3::ONE),
        }
    }

    /// The map from the node to its parent.
    pub(crate) fn matrix(&self) -> DMat4 {
        let length = self.rotation.length();
        let rotation = match length > 0.0 && length.is_finite() {
            true => self.rotation * length.recip(),
            false => DQuat::IDENTITY,
        };
        DMat4::from_scale_rotation_translation(self.scale, rotation, self.translation)
    }
}

/// The map from a node to its parent; `pose` is in place of its own.
pub(crate) fn local(node: &Node, pose: Option<&Pose>) -> DMat4 {
    match (pose, &node.matrix) {
        (Some(pose), _) => pose.matrix(),
        (None, Some(matrix)) => DMat4::from_cols_array(&matrix.map(f64::from)),
        (None, None) => Pose::of(node).matrix(),
    }
}

/// A placement without scale and shear, as cameras and lights have it: −z stays where it goes to, and y is up.
pub(crate) fn rigid(world: &DMat4) -> Option<DMat4> {
    let linear = DMat3::from_mat4(*world);
    let z = linear.z_axis.try_normalize()?;
    let x = linear.y_axis.cross(z).try_normalize()?;
    let position = world.w_axis.truncate();
    let whole = DMat4::from_cols(
        x.extend(0.0),
        z.cross(x).extend(0.0),
        z.extend(0.0),
        position.extend(1.0),
    );
    whole.is_finite().then_some(whole)
}

/// Half a turn about y: what looks along −z in glTF looks along +z here, with +x on the left.
pub(crate) fn turned(rigid: DMat4) -> DMat4 {
    rigid * DMat4::from_scale(DVec3::new(-1.0, 1.0, -1.0))
}
