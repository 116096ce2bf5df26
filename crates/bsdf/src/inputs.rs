//! Parameters of a model that may all be textured: a line each.

use etalon_params::{Params, Value};
use etalon_transport::{Build, SpectrumKind, TextureId};

/// A texture of numbers, or a number that must not be below 0; `accepted` says so.
pub(crate) fn non_negative(
    params: &Params<'_>,
    build: &mut dyn Build,
    (name, default): (&str, Option<f64>),
    accepted: &str,
) -> Option<TextureId> {
    if let Some(property) = params.property(name) {
        let number = match &property.value {
            Value::Float(value) => *value,
            Value::Integer(value) => *value as f64,
            _ => 0.0,
        };
        if !(number >= 0.0 && number.is_finite()) {
            params.refuse(name, number, accepted);
            return None;
        }
    }
    Some(build.texture(params, name, default, SpectrumKind::Unbounded))
}

/// Declares a model's textured parameters and their values at a point.
///
/// ```ignore
/// inputs! {
///     /// The textures.
///     Inputs;
///     /// Their values at a point.
///     Values {
///         /// The colour.
///         colour: spectrum = 0.5,
///         /// How much of it.
///         amount: share = 1.0,
///     }
/// }
/// ```
///
/// makes `Inputs`, with a texture for each, `Inputs::from_params`, and `Inputs::at`, which gives `Values`. A
/// `spectrum` is a reflectance for each lane; a `share` is clamped to [0, 1]; an `amount` is clamped to ≥ 0.
macro_rules! inputs {
    (
        $(#[doc = $inputs_doc:literal])* $inputs:ident;
        $(#[doc = $values_doc:literal])* $values:ident {
            $($(#[doc = $doc:literal])* $name:ident: $kind:ident = $default:literal,)*
        }
    ) => {
        $(#[doc = $inputs_doc])*
        #[derive(Clone, Debug)]
        pub struct $inputs {
            $($(#[doc = $doc])* pub $name: etalon_transport::TextureId,)*
        }

        $(#[doc = $values_doc])*
        #[derive(Clone, Copy, Debug)]
        pub struct $values {
            $($(#[doc = $doc])* pub $name: $crate::inputs::kind!($kind type),)*
        }

        impl $inputs {
            /// Reads the parameters of these names.
            pub fn from_params(
                params: &etalon_params::Params<'_>,
                build: &mut dyn etalon_transport::Build,
            ) -> Self {
                Self {
                    $($name: build.texture(
                        params,
                        stringify!($name),
                        Some($default),
                        $crate::inputs::kind!($kind role),
                    ),)*
                }
            }

            /// Their values at a point.
            #[inline]
            pub fn at<T: etalon_transport::Textures>(
                &self,
                site: &$crate::TextureSite<'_, T>,
            ) -> $values {
                $values {
                    $($name: $crate::inputs::kind!($kind at site, self.$name),)*
                }
            }
        }
    };
}

/// The type of a kind of parameter.
macro_rules! kind {
    (spectrum type) => {
        glam::Vec4
    };
    (spectrum role) => {
        etalon_transport::SpectrumKind::Reflectance
    };
    (spectrum at $site:expr, $texture:expr) => {
        $site.spectrum($texture)
    };
    (share type) => {
        f32
    };
    (share role) => {
        etalon_transport::SpectrumKind::Reflectance
    };
    (share at $site:expr, $texture:expr) => {
        $site.share($texture)
    };
    (amount type) => {
        f32
    };
    (amount role) => {
        etalon_transport::SpectrumKind::Unbounded
    };
    (amount at $site:expr, $texture:expr) => {
        $site.number($texture).max(0.0)
    };
}

pub(crate) use {inputs, kind};
