//! Where animated nodes stand at a moment (glTF 2.0, §3.11 and appendix C).
//!
//! glTF has no shutter: a picture is of one moment, at which translation, rotation and scale are evaluated: in steps, along
//! lines (rotations along the great arc of quaternions), or along cubic splines with the tangents of the file. All animations of a
//! file play at once.

use super::accessors::WantedAccessor;
use super::pose::Pose;
use super::reader::Reader;
use ::gltf::animation::{Interpolation, Property};
use ::gltf::json::accessor::{ComponentType, Type};
use ::gltf::json::animation::{Animation, Channel};
use ::gltf::json::validation::Checked;
use etalon_math::{Motion, MotionKey};
use glam::{DMat4, DQuat, DVec4};
use std::collections::{HashMap, HashSet};

const TIMES: WantedAccessor = WantedAccessor {
    types: &[Type::Scalar],
    components: &[(ComponentType::F32, false)],
    words: "SCALAR of floats",
};

const VALUES: WantedAccessor = WantedAccessor {
    types: &[Type::Vec3, Type::Vec4],
    components: &[
        (ComponentType::F32, false),
        (ComponentType::I8, true),
        (ComponentType::U8, true),
        (ComponentType::I16, true),
        (ComponentType::U16, true),
    ],
    words: "VEC3 or VEC4 of floats, or of normalised integers of 8 or 16 bits",
};

impl Reader<'_> {
    /// The poses at a moment of all nodes that move.
    pub(crate) fn poses(&mut self, time: f64) -> HashMap<usize, Pose> {
        let root = self.root;
        let mut poses = HashMap::new();
        let mut moved = HashSet::new();
        for (i, animation) in root.animations.iter().enumerate() {
            for (j, channel) in animation.channels.iter().enumerate() {
                let path = format!("animations[{i}].channels[{j}]");
                let Checked::Valid(property) = channel.target.path else {
                    continue;
                };
                if property == Property::MorphTargetWeights {
                    self.note(&path, "weights of morph targets are not read");
                    continue;
                }
                let node = channel.target.node.value();
                if !moved.insert((node, property as u8)) {
                    let message = "another animation moves the same: the first one counts";
                    self.note(&path, message);
                    continue;
                }
                let (Some(start), Some(value)) = (
                    root.nodes.get(node),
                    self.channel(animation, i, channel, time),
                ) else {
                    continue;
                };
                let pose = poses.entry(node).or_insert_with(|| Pose::of(start));
                match property {
                    Property::Translation => pose.translation = value.truncate(),
                    Property::Rotation => pose.rotation = DQuat::from_vec4(value),
                    Property::Scale => pose.scale = value.truncate(),
                    Property::MorphTargetWeights => {}
                }
            }
        }
        poses
    }

    /// The value of a channel at a moment; `None` after a mistake.
    fn channel(
        &mut self,
        animation: &Animation,
        number: usize,
        channel: &Channel,
        time: f64,
    ) -> Option<DVec4> {
        let index = channel.sampler.value();
        let path = format!("animations[{number}].samplers[{index}]");
        let sampler = animation.samplers.get(index)?;
        let Checked::Valid(interpolation) = sampler.interpolation else {
            return None;
        };
        let times: Vec<[f32; 1]> = self.vectors(sampler.input, &TIMES)?;
        let times: Vec<f64> = times.into_iter().map(|[time]| f64::from(time)).collect();
        if let Some(i) = times.windows(2).position(|pair| pair[1] <= pair[0]) {
            let message = format!(
                "the time of key {} is not after that of the key before",
                i + 1
            );
            self.error(&format!("{path}.input"), message);
            return None;
        }
        let values: Vec<[f32; 4]> = self.vectors(sampler.output, &VALUES)?;
        let each = match interpolation {
            Interpolation::CubicSpline => 3,
            Interpolation::Linear | Interpolation::Step => 1,
        };
        if values.len() != each * times.len() {
            let message = format!(
                "there are {} values for {} keys of {each} each",
                values.len(),
                times.len()
            );
            self.error(&format!("{path}.output"), message);
            return None;
        }
        let rotates = channel.target.path == Checked::Valid(Property::Rotation);
        let value = |key: usize, part: usize| {
            let value = values.get(each * key + part).copied().unwrap_or_default();
            DVec4::from(value.map(f64::from))
        };
        // The value itself is between its two tangents.
        let middle = each / 2;
        let after = times.partition_point(|key| *key <= time);
        if after == 0 || after == times.len() {
            return Some(value(after.min(times.len() - 1), middle));
        }
        let key = after - 1;
        let length = times[after] - times[key];
        let s = (time - times[key]) / length;
        let [a, b] = [key, after].map(|key| value(key, middle));
        Some(match interpolation {
            Interpolation::Step => a,
            Interpolation::Linear if rotates => {
                let [a, b] = [a, b].map(|q| DQuat::from_vec4(q.normalize_or(DVec4::W)));
                DVec4::from(along_the_arc(a, b, s))
            }
            Interpolation::Linear => a.lerp(b, s),
            Interpolation::CubicSpline => {
                let [leaving, arriving] = [value(key, 2), value(after, 0)];
                hermite([a, leaving * length, b, arriving * length], s)
            }
        })
    }
}

/// The rotation at s on the great arc from a to b, the shorter one.
fn along_the_arc(a: DQuat, b: DQuat, s: f64) -> DQuat {
    let keys = [(0.0, a), (1.0, b)];
    let keys = keys.map(|(time, turn)| MotionKey::from((time, DMat4::from_quat(turn))));
    // Rotations can always be interpolated.
    let motion = Motion::new(etalon_math::Interpolation::Linear, &keys);
    motion.map_or(a, |motion| DQuat::from_mat3(&motion.at(s).matrix3))
}

/// The cubic from a with the slope `leaving` to b with the slope `arriving`.
fn hermite([a, leaving, b, arriving]: [DVec4; 4], s: f64) -> DVec4 {
    let (square, cube) = (s * s, s * s * s);
    a * (2.0 * cube - 3.0 * square + 1.0)
        + leaving * (cube - 2.0 * square + s)
        + b * (3.0 * square - 2.0 * cube)
        + arriving * (cube - square)
}
