//! Cameras (glTF 2.0, §3.10): all that stand in the scene, the first of which is rendered. Without any, one that sees everything.
//!
//! glTF's cameras look along −z with +x on the right, Etalon's along +z with +x on the left: half a turn about y. Scale does not count.

use super::bounds::Bounds;
use super::film::ASPECT;
use super::nodes::Held;
use super::pose::{rigid, turned};
use super::reader::Reader;
use crate::draft::{Draft, word};
use ::gltf::json::camera::{Camera, Orthographic, Perspective};
use etalon_math::float64;
use etalon_params::{Class, DMat4, DVec3, Node, Value};
use std::sync::Arc;

/// Farther than anything is seen.
const FAR: f64 = 1e12;

/// Of the camera where there is none: its vertical field of view (°), how far above the horizon it stands (tangent of the
/// angle), and how much room it leaves around things.
const FIELD: f64 = 40.0;
const ABOVE: f64 = 0.3;
const ROOM: f64 = 1.05;

impl Reader<'_> {
    /// The sensors; those of which something is wrong are left out.
    pub(crate) fn sensors(&mut self, cameras: &[Held], bounds: Option<Bounds>) -> Vec<Arc<Node>> {
        if cameras.is_empty() {
            return self.camera_in_front(bounds).into_iter().collect();
        }
        let cameras = cameras.iter();
        cameras.filter_map(|held| self.camera(held)).collect()
    }

    fn camera(&self, held: &Held) -> Option<Arc<Node>> {
        let camera = self.root.cameras.get(held.number)?;
        let path = format!("cameras[{}]", held.number);
        let Some(pose) = rigid(&held.world) else {
            let message = "the place of this camera in the world is flat";
            self.error(&format!("nodes[{}]", held.node), message);
            return None;
        };
        let name = |plugin| {
            let draft = Draft::new(Class::Sensor, plugin, self.span(&path));
            match self.name_of(held, camera) {
                Some(name) => draft.named(name),
                None => draft,
            }
        };
        let draft = match (&camera.perspective, &camera.orthographic) {
            (Some(view), _) => self.perspective(&path, view, name("perspective"), pose),
            (None, Some(view)) => self.orthographic(&path, view, name("orthographic"), pose),
            (None, None) => self.refuse(&path, "it has no view", "`perspective`, `orthographic`"),
        };
        draft.map(Draft::node)
    }

    fn name_of(&self, held: &Held, camera: &Camera) -> Option<String> {
        let node = self.root.nodes.get(held.node)?;
        node.name.clone().or_else(|| camera.name.clone())
    }

    fn perspective(
        &self,
        path: &str,
        view: &Perspective,
        draft: Draft,
        pose: DMat4,
    ) -> Option<Draft> {
        let path = format!("{path}.perspective");
        let field = f64::from(view.yfov).to_degrees();
        if !(field > 0.0 && field < 180.0) {
            let help = "radians above 0 and below π";
            return self.refuse(&format!("{path}.yfov"), "this is no field of view", help);
        }
        let draft = draft
            .plain("to_world", Value::Transform(turned(pose)))
            .with(
                "fov",
                Value::Float(field),
                self.span(&format!("{path}.yfov")),
            )
            .plain("fov_axis", word("y"));
        let far = view.zfar.map_or(FAR, f64::from);
        let draft = self.clipped(&path, draft, [f64::from(view.znear), far])?;
        let aspect = view.aspect_ratio.map_or(ASPECT, f64::from);
        self.filmed(draft, aspect, &format!("{path}.aspectRatio"))
    }

    fn orthographic(
        &self,
        path: &str,
        view: &Orthographic,
        draft: Draft,
        pose: DMat4,
    ) -> Option<Draft> {
        let path = format!("{path}.orthographic");
        // Blender writes what it sees by either sign.
        let [x, y] = [view.xmag, view.ymag].map(|half| f64::from(half).abs());
        if !(x > 0.0 && y > 0.0 && x.is_finite() && y.is_finite()) {
            let help = "finite numbers other than 0";
            return self.refuse(&path, "its magnifications show nothing", help);
        }
        // Etalon's sees x from −1 to 1.
        let size = DMat4::from_scale(DVec3::new(x, x, 1.0));
        let to_world = Value::Transform(turned(pose) * size);
        let draft = draft.plain("to_world", to_world);
        let clip = [view.znear, view.zfar].map(f64::from);
        let draft = self.clipped(&path, draft, clip)?;
        self.filmed(draft, x / y, &path)
    }

    /// Adds the nearest and the farthest distance seen.
    fn clipped(&self, path: &str, draft: Draft, [near, far]: [f64; 2]) -> Option<Draft> {
        if !(near >= 0.0 && near < far && far.is_finite()) {
            let message = format!("nothing is between {near} and {far}");
            let help = "`znear` from 0 on, below `zfar`";
            return self.refuse(path, message, help);
        }
        let near = near.max(far * 1e-12);
        let place = |name| self.span(&format!("{path}.{name}"));
        let draft = draft.with("near_clip", Value::Float(near), place("znear"));
        Some(draft.with("far_clip", Value::Float(far), place("zfar")))
    }

    /// A camera that sees everything from the front, from slightly above.
    fn camera_in_front(&self, bounds: Option<Bounds>) -> Option<Arc<Node>> {
        let path = "scene";
        self.note(path, "the scene has no camera: it is seen from the front");
        let (centre, radius) = match bounds {
            Some(Bounds { low, high }) => (0.5 * (low + high), 0.5 * (high - low).length()),
            None => (DVec3::ZERO, 1.0),
        };
        if !(centre.is_finite() && radius.is_finite()) {
            return self.refuse(path, "its size is not finite", "a scene with a camera");
        }
        let radius = if radius > 0.0 { radius } else { 1.0 };
        let distance = ROOM * radius / float64::sin(0.5 * FIELD.to_radians());
        let back = DVec3::new(0.0, ABOVE, 1.0).normalize();
        let position = centre + distance * back;
        let facing = DMat4::from_cols(
            DVec3::X.extend(0.0),
            DVec3::Y.extend(0.0),
            back.extend(0.0),
            position.extend(1.0),
        );
        let pose = rigid(&facing)?;
        let draft = Draft::new(Class::Sensor, "perspective", self.span(path))
            .plain("to_world", Value::Transform(turned(pose)))
            .plain("fov", Value::Float(FIELD))
            .plain("fov_axis", word("y"))
            .plain("near_clip", Value::Float(1e-3 * distance))
            .plain("far_clip", Value::Float(1e3 * distance));
        self.filmed(draft, ASPECT, path).map(Draft::node)
    }
}
