//! A parameter's values at times of the scene.

use etalon_math::{Interpolation, Key, Keyframes, Motion};
use etalon_params::{DVec3, SpectrumText, Value};
use std::sync::Arc;

/// Values at moments.
#[derive(Clone, Debug)]
pub(crate) enum Animation {
    /// Of a transform.
    Moving(Arc<Motion>),
    /// Of anything else.
    Changing(Interpolation, Vec<(f64, Value, Option<DVec3>)>),
}

/// The moments that matter to a picture (units of scene time).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moments {
    /// That which the picture's shutter counts from.
    pub(crate) frame: f64,
    /// The middle of the shutter's interval.
    pub(crate) middle: f64,
}

impl Animation {
    /// The value for a picture.
    pub(crate) fn at(self, moments: Moments) -> Value {
        match self {
            Self::Moving(motion) => Value::Animation {
                middle: motion.at(moments.middle).into(),
                motion: Arc::new(motion.earlier(moments.frame)),
            },
            Self::Changing(interpolation, keys) => between(interpolation, &keys, moments.middle),
        }
    }
}

/// The value of keys with one kind at a moment.
fn between(interpolation: Interpolation, keys: &[(f64, Value, Option<DVec3>)], time: f64) -> Value {
    /// What `pick` finds in every key, between them.
    fn of<V: etalon_math::keyframes::Interpolated>(
        way: Interpolation,
        keys: &[(f64, Value, Option<DVec3>)],
        time: f64,
        pick: impl Fn(&Value) -> Option<V>,
        tangent: impl Fn(DVec3) -> Option<V>,
    ) -> Option<V> {
        let keys: Option<Vec<_>> = (keys.iter())
            .map(|(time, value, slope)| {
                Some(Key {
                    time: *time,
                    value: pick(value)?,
                    tangent: slope.and_then(&tangent),
                })
            })
            .collect();
        Some(Keyframes::new(way, &keys?)?.at(time))
    }
    let number = |pick: &dyn Fn(&Value) -> Option<f64>| {
        of(interpolation, keys, time, pick, |slope| Some(slope.x))
    };
    let found = match &keys[0].1 {
        Value::Float(_) => number(&|v| match v {
            Value::Float(x) => Some(*x),
            _ => None,
        })
        .map(Value::Float),
        Value::Vector(_) | Value::Rgb(_) => {
            let pick = |v: &Value| match v {
                Value::Vector(x) | Value::Rgb(x) => Some(*x),
                _ => None,
            };
            let found = of(interpolation, keys, time, pick, Some);
            match keys[0].1 {
                Value::Rgb(_) => found.map(Value::Rgb),
                _ => found.map(Value::Vector),
            }
        }
        Value::Spectrum(SpectrumText::Uniform(_)) => number(&|v| match v {
            Value::Spectrum(SpectrumText::Uniform(x)) => Some(*x),
            _ => None,
        })
        .map(|x| Value::Spectrum(SpectrumText::Uniform(x))),
        Value::Spectrum(SpectrumText::Samples(first)) => {
            let samples = first.iter().enumerate().map(|(i, (wavelength, _))| {
                let value = number(&|v| match v {
                    Value::Spectrum(SpectrumText::Samples(own)) if own.len() == first.len() => {
                        let (at, value) = own[i];
                        (at == *wavelength).then_some(value)
                    }
                    _ => None,
                });
                value.map(|value| (*wavelength, value))
            });
            let samples: Option<Vec<_>> = samples.collect();
            samples.map(|samples| Value::Spectrum(SpectrumText::Samples(samples)))
        }
        _ => {
            let last = keys.iter().rev().find(|(key, ..)| *key <= time);
            last.map(|(_, value, _)| value.clone())
        }
    };
    found.unwrap_or_else(|| keys[0].1.clone())
}
