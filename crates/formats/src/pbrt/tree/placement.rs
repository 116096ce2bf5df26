//! Where things stand: pbrt's CTM as `to_world`.
//!
//! pbrt's CTM takes an object into the world as Mitsuba's `to_world` does, so a matrix stands as it is. Of a motion pbrt takes the two
//! transforms apart into a translation, a rotation and a stretch, and interpolates the translation and the stretch along straight
//! lines and the rotation along the great arc of quaternions (`util/transform.cpp`, `AnimatedTransform`), as [`Motion`] does. Before the
//! first and after the second of the times nothing moves, in both.

use super::super::placement::Placement;
use super::Mapper;
use super::node::{Draft, Given, given};
use etalon_math::{Interpolation, Motion, MotionError, MotionKey};
use etalon_params::{DMat4, Diagnostic, Span, Value};
use std::sync::Arc;

impl Mapper<'_> {
    /// The value of `to_world` for what stands at `span`; `local` is applied first.
    pub(crate) fn to_world(
        &self,
        placement: &Placement,
        local: DMat4,
        span: Span,
    ) -> Option<Given> {
        let [start, end] = [placement.start * local, placement.end * local];
        if !placement.is_animated() {
            return Some(given(Value::Transform(start), span));
        }
        let keys = [
            MotionKey::from((placement.times[0], start)),
            MotionKey::from((placement.times[1], end)),
        ];
        match Motion::new(Interpolation::Linear, &keys) {
            Ok(motion) => {
                let value = Value::Animation {
                    middle: motion.at(self.middle).into(),
                    motion: Arc::new(motion.earlier(self.time)),
                };
                Some(given(value, span))
            }
            Err(why) => {
                let message = match why {
                    MotionError::Mirrors(_) => {
                        "one of the two transforms of this motion mirrors, and the other does not"
                    }
                    _ => "a transform of this motion flattens space, or is projective",
                };
                self.diagnostics.push(Diagnostic::error(span, message));
                None
            }
        }
    }

    /// The same for what pbrt does not move: it takes the start of a motion, which is worth a note.
    pub(crate) fn still(&self, placement: &Placement, what: &str, span: Span) -> DMat4 {
        if placement.is_animated() {
            let message = format!("pbrt moves no {what}: it stands where the motion begins");
            self.diagnostics.push(Diagnostic::note(span, message));
        }
        placement.start
    }
}

/// Whether a placement exchanges left and right.
pub(crate) fn mirrors(placement: &Placement) -> bool {
    placement.start.determinant() < 0.0
}

/// A node with its `to_world`, left out where it is the identity.
pub(crate) fn placed(draft: Draft, to_world: Given) -> Draft {
    match to_world.value {
        Value::Transform(matrix) if matrix == DMat4::IDENTITY => draft,
        _ => draft.given("to_world", to_world),
    }
}
