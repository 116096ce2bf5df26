//! Motion: an affine map that changes with time, given by keyframes.
//!
//! Every key M = T·R·S is taken apart into a translation T, a rotation R and a symmetric stretch S (polar
//! decomposition; a reflection goes into S), which are interpolated apart ([`crate::keyframes`]). Straight from key to
//! key, R follows the great arc of unit quaternions (K. Shoemake, Animating rotation with quaternion curves, 1985;
//! K. Shoemake and T. Duff, Matrix animation and polar decomposition, 1992); along curves, the quaternion's components
//! are interpolated and normalised. Before the first and after the last key nothing moves.

use crate::Transform;
use crate::bernstein;
use crate::keyframes::{Interpolation, Key, Keyframes, Piece, catmull_rom};
use crate::parts::Parts;
use core::ops::ControlFlow;
use glam::{DAffine3, DMat3, DMat4, DQuat, DVec3};

/// A map at a moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionKey {
    /// The moment.
    pub time: f64,
    /// The map then.
    pub matrix: DMat4,
    /// How fast it carries the origin, for [`Interpolation::Hermite`]; as Catmull–Rom would, if not given.
    pub velocity: Option<DVec3>,
}

impl From<(f64, DMat4)> for MotionKey {
    fn from((time, matrix): (f64, DMat4)) -> Self {
        Self {
            time,
            matrix,
            velocity: None,
        }
    }
}

/// Why keyframes make no motion. Keys are numbered from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MotionError {
    /// There is none, or not as many as the interpolation takes.
    Count,
    /// The time of this key is not finite or not after that of the key before it.
    Order(usize),
    /// The map of this key is projective, singular or not finite.
    Singular(usize),
    /// This key mirrors and the one before it does not, or the other way round: somewhere between them space
    /// would be flat.
    Mirrors(usize),
    /// On the curve between this key and the next, the stretch swings so far that space is flat somewhere.
    Flattens(usize),
}

/// An affine map that changes with time.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    parts: Keyframes<Parts>,
    keys: Vec<DMat4>,
}

impl Motion {
    /// The motion through maps at moments, in ascending order of time.
    pub fn new(interpolation: Interpolation, keys: &[MotionKey]) -> Result<Self, MotionError> {
        let mut found: Vec<Key<Parts>> = Vec::with_capacity(keys.len());
        for (index, key) in keys.iter().enumerate() {
            let linear = DMat3::from_mat4(key.matrix);
            let determinant = linear.determinant();
            let affine = key.matrix.row(3) == glam::DVec4::W && key.matrix.is_finite();
            if !affine || determinant == 0.0 || !linear.inverse().is_finite() {
                return Err(MotionError::Singular(index));
            }
            let mut value = Parts::of(&key.matrix);
            if let Some(last) = found.last() {
                if last.value.stretch.determinant() * determinant < 0.0 {
                    return Err(MotionError::Mirrors(index));
                }
                // Of the two quaternions of a rotation, the nearer one.
                if last.value.rotation.dot(value.rotation) < 0.0 {
                    value.rotation = -value.rotation;
                }
            }
            let ordered = found.last().is_none_or(|last| key.time > last.time);
            if !(ordered && key.time.is_finite()) {
                return Err(MotionError::Order(index));
            }
            found.push(Key {
                time: key.time,
                value,
                tangent: None,
            });
        }
        // A known velocity is the tangent of the translation; the rest goes as Catmull–Rom would.
        let slopes = (0..found.len()).map(|i| catmull_rom(&found, i));
        let tangents = keys.iter().zip(slopes.collect::<Vec<_>>());
        for (key, (given, slope)) in found.iter_mut().zip(tangents) {
            key.tangent = given.velocity.map(|translation| Parts {
                translation,
                ..slope
            });
        }
        let parts = Keyframes::new(interpolation, &found).ok_or(MotionError::Count)?;
        if let Some(piece) = parts.pieces.iter().position(flattens) {
            return Err(MotionError::Flattens(
                piece * (keys.len() - 1) / parts.pieces.len(),
            ));
        }
        Ok(Self {
            parts,
            keys: keys.iter().map(|key| key.matrix).collect(),
        })
    }

    /// No motion.
    ///
    /// # Errors
    /// If the map is projective, singular or not finite.
    pub fn still(matrix: DMat4) -> Result<Self, MotionError> {
        Self::new(Interpolation::Step, &[(0.0, matrix).into()])
    }

    /// The map at a moment.
    pub fn at(&self, time: f64) -> DAffine3 {
        self.parts_at(time).map()
    }

    fn parts_at(&self, time: f64) -> Parts {
        let (piece, s) = self.parts.piece(time);
        parts_on(&piece, s)
    }

    /// The same motion in units of an interval: 0 is `open`, 1 is `close`. If the interval has no length, what
    /// stands still as it is at `open`.
    #[must_use]
    pub fn within(&self, open: f64, close: f64) -> Self {
        let mut parts = self.parts.clone();
        if close > open {
            for time in &mut parts.times {
                *time = (*time - open) / (close - open);
            }
        } else {
            parts = Keyframes {
                times: vec![0.0],
                pieces: Vec::new(),
                last: self.parts_at(open),
            };
        }
        Self {
            parts,
            keys: self.keys.clone(),
        }
    }

    /// The same motion, with time counted from `moment`.
    #[must_use]
    pub fn earlier(&self, moment: f64) -> Self {
        let mut earlier = self.clone();
        earlier
            .parts
            .times
            .iter_mut()
            .for_each(|time| *time -= moment);
        earlier
    }

    /// The motion composed with `first`, which is applied before it.
    #[must_use]
    pub fn after(&self, first: DMat3) -> Self {
        let mut after = self.clone();
        let map = |parts: Parts| Parts {
            stretch: parts.stretch * first,
            ..parts
        };
        after.parts.last = map(after.parts.last);
        for piece in &mut after.parts.pieces {
            *piece = match *piece {
                Piece::Constant(parts) => Piece::Constant(map(parts)),
                Piece::Line(parts) => Piece::Line(parts.map(map)),
                Piece::Cubic(parts) => Piece::Cubic(parts.map(map)),
            };
        }
        for key in &mut after.keys {
            *key *= DMat4::from_mat3(first);
        }
        after
    }

    /// Moments and maps between which straight interpolation gives this motion: exactly where it is straight, within the square of 1/`pieces` of
    /// the way where it is a curve. A leap is one within 10⁻⁹ of the time between its keys.
    pub fn straight_keys(&self, pieces: usize) -> Vec<(f64, DMat4)> {
        let mut keys = Vec::new();
        for (piece, span) in self.parts.pieces.iter().zip(self.parts.times.windows(2)) {
            let [start, end] = [span[0], span[1]];
            let shares: Vec<f64> = match piece {
                Piece::Line(_) => vec![0.0],
                Piece::Constant(_) => vec![0.0, 1.0 - 1e-9],
                Piece::Cubic(_) => (0..pieces).map(|i| i as f64 / pieces as f64).collect(),
            };
            let key = |share: f64| {
                (
                    start + (end - start) * share,
                    parts_on(piece, share).map().into(),
                )
            };
            keys.extend(shares.into_iter().map(key));
        }
        let last = self.parts.times.last().copied().unwrap_or(0.0);
        keys.push((last, self.parts.last.map().into()));
        keys
    }

    /// The maps of the keys.
    pub fn keys(&self) -> &[DMat4] {
        &self.keys
    }

    /// Whether every key turns, mirrors, shifts and scales uniformly at most.
    pub fn keeps_angles(&self) -> bool {
        let keeps = |key: &DMat4| {
            Transform::from_matrix(key).is_some_and(|map| map.uniform_scale().is_some())
        };
        self.keys.iter().all(keeps)
    }

    /// Whether anything changes from time 0 to 1.
    pub fn moves(&self) -> bool {
        let start = self.at(0.0);
        let still = |(piece, [from, to]): (Piece<Parts>, [f64; 2])| {
            let stays = |s| parts_on(&piece, s).map() == start;
            let bends = match piece {
                Piece::Cubic([a, b, c, d]) => a != b || b != c || c != d,
                _ => false,
            };
            stays(from) && stays(to) && !bends
        };
        self.at(1.0) != start || !self.spans().all(still)
    }

    /// The pieces that take place in the interval from time 0 to 1, with the share of each that does.
    pub(crate) fn spans(&self) -> impl Iterator<Item = (Piece<Parts>, [f64; 2])> + '_ {
        let times = self.parts.times.windows(2);
        times.zip(&self.parts.pieces).filter_map(|(span, piece)| {
            let share = |time: f64| ((time - span[0]) / (span[1] - span[0])).clamp(0.0, 1.0);
            let takes_place = span[1] > 0.0 && span[0] < 1.0;
            takes_place.then(|| (*piece, [share(0.0), share(1.0)]))
        })
    }
}

/// The parts on a piece, with a rotation that is one.
pub(crate) fn parts_on(piece: &Piece<Parts>, s: f64) -> Parts {
    match piece {
        Piece::Constant(parts) => *parts,
        Piece::Line([a, b]) => Parts {
            translation: a.translation.lerp(b.translation, s),
            rotation: slerp(a.rotation, b.rotation, s),
            stretch: a.stretch * (1.0 - s) + b.stretch * s,
        },
        Piece::Cubic(_) => {
            let parts = piece.at(s);
            Parts {
                rotation: parts.rotation.normalize(),
                ..parts
            }
        }
    }
}

/// Whether the determinant of the stretch changes its sign on a piece. It cannot on a line: S is definite, with the
/// same sign at both ends.
fn flattens(piece: &Piece<Parts>) -> bool {
    let Piece::Cubic(values) = piece else {
        return false;
    };
    let entry = |i: usize, j: usize| values.map(|parts| parts.stretch.col(j)[i]);
    let minor = |[i, j]: [usize; 2], [k, l]: [usize; 2]| {
        let a: [f64; 7] = bernstein::product(&entry(i, k), &entry(j, l));
        let b: [f64; 7] = bernstein::product(&entry(i, l), &entry(j, k));
        core::array::from_fn::<f64, 7, _>(|n| a[n] - b[n])
    };
    let columns = [([1, 2], 1.0), ([0, 2], -1.0), ([0, 1], 1.0)];
    let mut determinant = [0.0; 10];
    for (k, (others, sign)) in columns.into_iter().enumerate() {
        let term: [f64; 10] = bernstein::product(&entry(0, k), &minor([1, 2], others));
        for (sum, term) in determinant.iter_mut().zip(term) {
            *sum += sign * term;
        }
    }
    bernstein::sign_changes(&determinant, 1e-9, |_, _| ControlFlow::Break(())).is_some()
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

#[cfg(test)]
mod tests {
    use super::*;

    fn placed(at: DVec3, turn: f64, scale: DVec3) -> DMat4 {
        let axis = DVec3::new(1.0, 2.0, -0.5).normalize();
        DMat4::from_translation(at) * DMat4::from_axis_angle(axis, turn) * DMat4::from_scale(scale)
    }

    fn motion(
        interpolation: Interpolation,
        keys: impl IntoIterator<Item = (f64, DMat4)>,
    ) -> Result<Motion, MotionError> {
        let keys: Vec<MotionKey> = keys.into_iter().map(MotionKey::from).collect();
        Motion::new(interpolation, &keys)
    }

    #[test]
    fn passes_through_its_keys_and_stands_still_outside() {
        let keys = [
            (1.0, placed(DVec3::X, 0.3, DVec3::new(1.0, 2.0, -0.5))),
            (2.0, placed(DVec3::Z, 1.3, DVec3::new(1.2, 1.8, -0.6))),
            (2.5, placed(DVec3::X, 2.3, DVec3::new(1.4, 1.5, -0.6))),
            (3.0, placed(DVec3::Y, 2.9, DVec3::new(2.0, 1.0, -0.7))),
        ];
        for kind in Interpolation::ALL {
            let motion = motion(kind, keys).expect("a motion");
            for (time, key) in [(0.0, 0), (1.0, 0), (2.0, 1), (2.5, 2), (3.0, 3), (9.0, 3)] {
                let map = DMat4::from(motion.at(time));
                assert!(
                    map.abs_diff_eq(keys[key].1, 1e-12),
                    "{kind:?} at {time}: {map}"
                );
            }
        }
    }

    #[test]
    fn turns_at_constant_speed() {
        let quarter = DMat4::from_rotation_z(core::f64::consts::FRAC_PI_2);
        let motion = motion(
            Interpolation::Linear,
            [(0.0, DMat4::IDENTITY), (1.0, quarter)],
        );
        let motion = motion.expect("a motion");
        for step in 0..=8 {
            let s = f64::from(step) / 8.0;
            let expected = DMat4::from_rotation_z(core::f64::consts::FRAC_PI_2 * s);
            assert!(DMat4::from(motion.at(s)).abs_diff_eq(expected, 1e-14));
        }
    }

    /// With velocities the origin follows Hermite's curve: a parabola's, exactly.
    #[test]
    fn follows_velocities() {
        let place = |t: f64| DVec3::new(t, t * t, 0.0);
        let keys = [0.0, 0.5, 2.0].map(|time| MotionKey {
            time,
            matrix: placed(place(time), time, DVec3::ONE),
            velocity: Some(DVec3::new(1.0, 2.0 * time, 0.0)),
        });
        let motion = Motion::new(Interpolation::Hermite, &keys).expect("a motion");
        for step in 0..=20 {
            let time = f64::from(step) / 10.0;
            assert!((motion.at(time).translation - place(time)).length() < 1e-12);
        }
    }

    #[test]
    fn mistakes() {
        let one = DMat4::IDENTITY;
        let mirror = DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0));
        let flat = DMat4::from_scale(DVec3::new(0.0, 1.0, 1.0));
        let linear = Interpolation::Linear;
        assert_eq!(motion(linear, []), Err(MotionError::Count));
        let three = [(0.0, one), (1.0, one), (2.0, one)];
        assert_eq!(motion(Interpolation::Cubic, three), Err(MotionError::Count));
        let unordered = [(1.0, one), (1.0, one)];
        assert_eq!(motion(linear, unordered), Err(MotionError::Order(1)));
        let nowhere = [(f64::NAN, one)];
        assert_eq!(motion(linear, nowhere), Err(MotionError::Order(0)));
        let mirrored = [(0.0, one), (1.0, mirror)];
        assert_eq!(motion(linear, mirrored), Err(MotionError::Mirrors(1)));
        assert_eq!(motion(linear, [(0.0, flat)]), Err(MotionError::Singular(0)));
        let scale = |x: f64| DMat4::from_scale(DVec3::new(x, 1.0, 1.0));
        let swinging = [0.1, 10.0, 0.1, 0.1].map(scale);
        let swinging = [0, 1, 2, 3].map(|i| (f64::from(i), swinging[i as usize]));
        let swinging = motion(Interpolation::CatmullRom, swinging);
        assert_eq!(swinging, Err(MotionError::Flattens(2)));
    }
}
