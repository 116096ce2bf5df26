//! Film and sampler, of which glTF has none.

use super::reader::Reader;
use crate::draft::Draft;
use etalon_params::{Class, Span, Value};

/// The height of a picture (pixels), and its width unless a camera has an aspect.
const HEIGHT: f64 = 720.0;
pub(crate) const ASPECT: f64 = 16.0 / 9.0;

/// The widest and the narrowest picture.
const ASPECTS: [f64; 2] = [1.0 / 16.0, 16.0];

/// How many samples a pixel has.
const SAMPLES: i64 = 64;

impl Reader<'_> {
    /// Adds film and sampler to a camera; the aspect is width over height. `None` after a mistake.
    pub(crate) fn filmed(&self, draft: Draft, aspect: f64, path: &str) -> Option<Draft> {
        if !(ASPECTS[0]..=ASPECTS[1]).contains(&aspect) {
            let help = "a width over height from 1/16 to 16";
            return self.refuse(path, format!("no picture has the aspect {aspect}"), help);
        }
        let span: Span = draft.span();
        let sides = [("width", HEIGHT * aspect), ("height", HEIGHT)];
        let film = Draft::new(Class::Film, "hdrfilm", span);
        let film = sides.into_iter().fold(film, |film, (name, side)| {
            film.plain(name, Value::Integer(side.round() as i64))
        });
        let sampler = Draft::new(Class::Sampler, "sobol", span);
        let sampler = sampler.plain("sample_count", Value::Integer(SAMPLES));
        Some(draft.child(film.node()).child(sampler.node()))
    }
}
