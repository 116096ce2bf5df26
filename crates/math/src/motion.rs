//! Motion: an affine map that changes with time, given by keyframes.
//!
//! Every key M = T·R·S is taken apart into a translation T, a rotation R and a symmetric stretch S (polar
//! decomposition; a reflection goes into S). Between two keys T and S are interpolated linearly and R along the
//! great arc of unit quaternions (K. Shoemake, Animating rotation with quaternion curves, 1985; K. Shoemake and
//! T. Duff, Matrix animation and polar decomposition, 1992). Before the first and after the last key nothing moves.

use glam::{DAffine3, DMat3, DMat4, DQuat, DVec3};
use std::sync::Arc;

/// An affine map at a moment.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Keyframe {
    time: f64,
    translation: DVec3,
    rotation: DQuat,
    stretch: DMat3,
}

/// Why keyframes make no motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MotionError {
    /// There is none.
    Empty,
    /// The time of the key of this number, from 0, is not finite or not after that of the key before it.
    Order(usize),
    /// The map of the key of this number is projective, singular or not finite.
    Singular(usize),
    /// The key of this number mirrors and the one before it does not, or the other way round: somewhere
    /// between them space would be flat.
    Mirrors(usize),
}

/// An affine map that changes with time.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    keys: Vec<Keyframe>,
}

/// M = R·S with a rotation R and a symmetric S, by Higham's iteration R ← (R + R⁻ᵀ)/2.
fn polar(linear: DMat3) -> (DQuat, DMat3) {
    let sign = linear.determinant().signum();
    let mut r = linear * sign;
    for _ in 0..64 {
        let next = (r + r.inverse().transpose()) * 0.5;
        let change = (next - r)
            .to_cols_array()
            .into_iter()
            .map(f64::abs)
            .sum::<f64>();
        r = next;
        if change < 1e-14 {
            break;
        }
    }
    (DQuat::from_mat3(&r).normalize(), r.transpose() * linear)
}

impl Motion {
    /// The motion through maps at moments, in ascending order of time.
    pub fn new(keys: &[(f64, DMat4)]) -> Result<Self, MotionError> {
        let mut found: Vec<Keyframe> = Vec::with_capacity(keys.len());
        for (index, (time, matrix)) in keys.iter().enumerate() {
            let linear = DMat3::from_mat4(*matrix);
            let determinant = linear.determinant();
            let affine = matrix.row(3) == glam::DVec4::W && matrix.is_finite();
            if !affine || determinant == 0.0 || !linear.inverse().is_finite() {
                return Err(MotionError::Singular(index));
            }
            let (mut rotation, stretch) = polar(linear);
            if let Some(last) = found.last() {
                if last.stretch.determinant() * determinant < 0.0 {
                    return Err(MotionError::Mirrors(index));
                }
                // Of the two quaternions of a rotation, the nearer one.
                if last.rotation.dot(rotation) < 0.0 {
                    rotation = -rotation;
                }
            }
            let ordered = found.last().is_none_or(|last| *time > last.time);
            if !(ordered && time.is_finite()) {
                return Err(MotionError::Order(index));
            }
            let translation = matrix.w_axis.truncate();
            found.push(Keyframe {
                time: *time,
                translation,
                rotation,
                stretch,
            });
        }
        if found.is_empty() {
            return Err(MotionError::Empty);
        }
        Ok(Self { keys: found })
    }

    /// The map at a moment.
    pub fn at(&self, time: f64) -> DAffine3 {
        let after = self.keys.partition_point(|key| key.time <= time);
        let Keyframe {
            translation,
            rotation,
            stretch,
            ..
        } = match (after.checked_sub(1), self.keys.get(after)) {
            (None, _) => self.keys[0],
            (Some(last), None) => self.keys[last],
            (Some(before), Some(b)) => {
                let a = &self.keys[before];
                let s = (time - a.time) / (b.time - a.time);
                Keyframe {
                    time,
                    translation: a.translation.lerp(b.translation, s),
                    rotation: slerp(a.rotation, b.rotation, s),
                    stretch: a.stretch * (1.0 - s) + b.stretch * s,
                }
            }
        };
        DAffine3 {
            matrix3: DMat3::from_quat(rotation) * stretch,
            translation,
        }
    }

    /// The same motion in units of an interval: 0 is `open`, 1 is `close`. If the interval has no length, what
    /// stands still as it is at `open`.
    #[must_use]
    pub fn within(&self, open: f64, close: f64) -> Self {
        if !(close > open) {
            let still = self.at(open);
            return Self::new(&[(0.0, still.into())]).unwrap_or_else(|_| self.clone());
        }
        let keys = self.keys.iter().map(|key| Keyframe {
            time: (key.time - open) / (close - open),
            ..*key
        });
        Self {
            keys: keys.collect(),
        }
    }

    /// Whether anything changes from time 0 to 1.
    pub fn moves(&self) -> bool {
        let start = self.at(0.0);
        let inside = (self.keys.iter()).filter(|key| key.time > 0.0 && key.time < 1.0);
        self.at(1.0) != start || inside.into_iter().any(|key| self.at(key.time) != start)
    }

    /// Corners of a box that holds the box from `low` to `high` at every time from 0 to 1.
    ///
    /// Over a step in which R turns by ω, a point's way deviates from the straight line between its ends by at
    /// most max|x″|/8, and |x″| ≤ ω²|S c| + 2ω|ΔS c| since T and S are linear in time.
    pub fn swept(&self, low: DVec3, high: DVec3) -> [DVec3; 2] {
        /// A step turns no farther (rad), so that the deviation is below half a percent of the size.
        const TURN: f64 = 0.2;
        let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let corners = || {
            (0..8).map(move |i: u32| {
                let side = |axis: usize| {
                    if i >> axis & 1 == 0 {
                        low[axis]
                    } else {
                        high[axis]
                    }
                };
                DVec3::new(side(0), side(1), side(2))
            })
        };
        let mut include = |map: &DAffine3, slack: f64| {
            for corner in corners() {
                let point = map.transform_point3(corner);
                min = min.min(point - slack);
                max = max.max(point + slack);
            }
        };
        let inside =
            (self.keys.iter().map(|key| key.time)).filter(|&time| time > 0.0 && time < 1.0);
        let mut times: Vec<f64> = inside.collect();
        times.insert(0, 0.0);
        times.push(1.0);
        for span in times.windows(2) {
            let [from, to] = [span[0], span[1]].map(|time| self.at(time));
            let turn = |map: &DAffine3| polar(map.matrix3);
            let ((r0, _), (r1, _)) = (turn(&from), turn(&to));
            let angle = 2.0 * crate::float64::acos(r0.dot(r1).abs().min(1.0));
            let steps = (angle / TURN).ceil().clamp(1.0, 64.0) as u32;
            for step in 0..steps {
                let time = |i: u32| span[0] + (span[1] - span[0]) * f64::from(i) / f64::from(steps);
                let [a, b] = [step, step + 1].map(|i| self.at(time(i)));
                let ((_, s0), (_, s1)) = (polar(a.matrix3), polar(b.matrix3));
                let omega = angle / f64::from(steps);
                let slack = corners()
                    .map(|c| {
                        let size = (s0 * c).length().max((s1 * c).length());
                        (omega * omega * size + 2.0 * omega * ((s1 - s0) * c).length()) / 8.0
                    })
                    .fold(0.0, f64::max);
                include(&a, slack);
                include(&b, slack);
            }
        }
        [min, max]
    }
}

/// Along the great arc from `a` to `b`, which are not opposite.
fn slerp(a: DQuat, b: DQuat, s: f64) -> DQuat {
    let cos = a.dot(b).clamp(-1.0, 1.0);
    if cos > 1.0 - 1e-9 {
        return (a * (1.0 - s) + b * s).normalize();
    }
    let angle = crate::float64::acos(cos);
    let sin = crate::float64::sin;
    ((a * sin((1.0 - s) * angle) + b * sin(s * angle)) / sin(angle)).normalize()
}

/// What a map is turned into where it is used: a placement, a pose.
pub trait FromAffine {
    /// That of this invertible map.
    fn from_affine(map: &DAffine3) -> Self;
}

/// Something that stands still or moves while the shutter is open.
#[derive(Clone, Debug, PartialEq)]
pub struct Animated<T> {
    still: T,
    motion: Option<Arc<Motion>>,
}

impl<T> From<T> for Animated<T> {
    fn from(still: T) -> Self {
        Self {
            still,
            motion: None,
        }
    }
}

impl<T: FromAffine> Animated<T> {
    /// What `motion` makes of it, in units of the shutter interval, see [`Motion::within`].
    pub fn new(motion: Motion) -> Self {
        let still = T::from_affine(&motion.at(0.0));
        Self {
            motion: motion.moves().then(|| Arc::new(motion)),
            still,
        }
    }

    /// Gives what it is at `time`, from 0 (the shutter opens) to 1, to `ask`.
    #[inline]
    pub fn at<R>(&self, time: f32, ask: impl FnOnce(&T) -> R) -> R {
        match &self.motion {
            None => ask(&self.still),
            Some(motion) => ask(&T::from_affine(&motion.at(time.into()))),
        }
    }

    /// What it is when the shutter opens.
    #[inline]
    pub fn start(&self) -> &T {
        &self.still
    }

    /// How it moves, if it does.
    pub fn motion(&self) -> Option<&Motion> {
        self.motion.as_deref()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3Swizzles;
    use proptest::prelude::*;

    fn placed(at: DVec3, turn: f64, scale: DVec3) -> DMat4 {
        let axis = DVec3::new(1.0, 2.0, -0.5).normalize();
        DMat4::from_translation(at) * DMat4::from_axis_angle(axis, turn) * DMat4::from_scale(scale)
    }

    #[test]
    fn passes_through_its_keys_and_stands_still_outside() {
        let keys = [
            (1.0, placed(DVec3::X, 0.3, DVec3::new(1.0, 2.0, -0.5))),
            (3.0, placed(DVec3::Y, 2.9, DVec3::new(2.0, 1.0, -0.7))),
        ];
        let motion = Motion::new(&keys).expect("a motion");
        for (time, key) in [(0.0, 0), (1.0, 0), (3.0, 1), (9.0, 1)] {
            let map = DMat4::from(motion.at(time));
            assert!(map.abs_diff_eq(keys[key].1, 1e-12), "at {time}: {map}");
        }
    }

    #[test]
    fn turns_at_constant_speed() {
        let quarter = DMat4::from_rotation_z(core::f64::consts::FRAC_PI_2);
        let motion = Motion::new(&[(0.0, DMat4::IDENTITY), (1.0, quarter)]).expect("a motion");
        for step in 0..=8 {
            let s = f64::from(step) / 8.0;
            let expected = DMat4::from_rotation_z(core::f64::consts::FRAC_PI_2 * s);
            assert!(DMat4::from(motion.at(s)).abs_diff_eq(expected, 1e-14));
        }
    }

    #[test]
    fn mistakes() {
        let one = DMat4::IDENTITY;
        let mirror = DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0));
        let flat = DMat4::from_scale(DVec3::new(0.0, 1.0, 1.0));
        assert_eq!(Motion::new(&[]), Err(MotionError::Empty));
        let unordered = Motion::new(&[(1.0, one), (1.0, one)]);
        assert_eq!(unordered, Err(MotionError::Order(1)));
        assert_eq!(Motion::new(&[(f64::NAN, one)]), Err(MotionError::Order(0)));
        let mirrored = Motion::new(&[(0.0, one), (1.0, mirror)]);
        assert_eq!(mirrored, Err(MotionError::Mirrors(1)));
        assert_eq!(Motion::new(&[(0.0, flat)]), Err(MotionError::Singular(0)));
    }

    proptest! {
        /// The box of a moving box holds all its points at all times.
        #[test]
        fn swept_boxes_hold_everything(
            at in prop::array::uniform3(-5.0..5.0f64), turns in prop::array::uniform3(-3.1..3.1f64),
            scale in prop::array::uniform3(0.2..4.0f64), inside in prop::array::uniform3(0.0..1.0f64),
        ) {
            let keys = [
                (-0.2, placed(DVec3::ZERO, turns[0], DVec3::ONE)),
                (0.6, placed(DVec3::from(at), turns[1], DVec3::from(scale))),
                (1.1, placed(-DVec3::from(at), turns[2], DVec3::from(scale).yzx())),
            ];
            let motion = Motion::new(&keys).expect("a motion");
            let (low, high) = (DVec3::new(1.0, -2.0, 0.5), DVec3::new(3.0, 2.0, 4.0));
            let [min, max] = motion.swept(low, high);
            let point = low + (high - low) * DVec3::from(inside);
            for i in 0..=100 {
                let seen = motion.at(f64::from(i) / 100.0).transform_point3(point);
                prop_assert!(seen.cmpge(min).all() && seen.cmple(max).all());
            }
        }
    }
}
