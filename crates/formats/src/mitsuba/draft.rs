//! The objects of a scene while its files are still being read: references are names, and
//! objects are numbers in one list.

use super::animation::{Animation, Moments};
use etalon_params::{Class, Span, Spanned, Value};
use std::collections::HashMap;

/// An object by its place in [`Draft::objects`].
pub(crate) type ObjectId = usize;

/// What a property holds.
#[derive(Clone, Debug)]
pub(crate) enum DraftValue {
    /// A finished value.
    Plain(Value),
    /// Values at moments.
    Animation(Animation),
    /// A nested object.
    Object(ObjectId),
    /// A reference that is not resolved yet.
    Reference(String),
}

/// A property of an object.
#[derive(Clone, Debug)]
pub(crate) struct DraftProperty {
    pub(crate) name: String,
    pub(crate) name_span: Span,
    pub(crate) value: DraftValue,
    pub(crate) span: Span,
    /// Counts as used from the start, so that no plugin complains about it.
    pub(crate) excused: bool,
}

/// An object.
#[derive(Debug)]
pub(crate) struct DraftObject {
    pub(crate) class: Class,
    pub(crate) plugin: Spanned<String>,
    pub(crate) id: Option<String>,
    pub(crate) span: Span,
    pub(crate) properties: Vec<DraftProperty>,
}

/// Everything read so far.
#[derive(Debug, Default)]
pub(crate) struct Draft {
    pub(crate) objects: Vec<DraftObject>,
    /// The object of each `id`, and where the `id` stands.
    pub(crate) ids: HashMap<String, (ObjectId, Span)>,
    /// `<alias>`es: the new name and the name of its source, each with its position.
    pub(crate) aliases: Vec<(Spanned<String>, Spanned<String>)>,
}

impl Draft {
    /// The moments of a frame that is seen by the first sensor.
    pub(crate) fn moments(&self, frame: f64) -> Moments {
        let sensor = self.objects.iter().find(|o| o.class == Class::Sensor);
        let number = |name: &str| {
            let property = sensor?.properties.iter().find(|p| p.name == name)?;
            match property.value {
                DraftValue::Plain(Value::Float(x)) => Some(x),
                DraftValue::Plain(Value::Integer(i)) => Some(i as f64),
                _ => None,
            }
        };
        let open = number("shutter_open").unwrap_or(0.0);
        let close = number("shutter_close").unwrap_or(0.0).max(open);
        Moments {
            frame,
            middle: frame + 0.5 * (open + close),
        }
    }
}
