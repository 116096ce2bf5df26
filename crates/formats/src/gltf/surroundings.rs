//! What is around the scene, of which glTF says nothing: a picture that the caller names, or else, if nothing shines, even light.

use super::reader::Reader;
use crate::draft::{Draft, word};
use etalon_params::{Class, Node, Sources, Span, Value};
use std::path::Path;
use std::sync::Arc;

impl Reader<'_> {
    /// The surroundings, if there are any.
    pub(crate) fn surroundings(
        &self,
        picture: Option<&Path>,
        shines: bool,
        sources: &mut Sources,
    ) -> Option<Arc<Node>> {
        if let Some(picture) = picture {
            let name = std::path::absolute(picture).unwrap_or_else(|_| picture.to_owned());
            let text = picture.display().to_string();
            let end = text.len() as u32;
            let file = sources.add("--environment", text);
            let span = Span {
                file,
                start: 0,
                end,
            };
            let draft = Draft::new(Class::Emitter, "envmap", span);
            let name = word(&name.to_string_lossy());
            return Some(draft.plain("filename", name).node());
        }
        if shines {
            return None;
        }
        let path = "scene";
        self.note(
            path,
            "nothing in the scene shines: it stands in even light of radiance 1",
        );
        let draft = Draft::new(Class::Emitter, "constant", self.span(path));
        Some(draft.plain("radiance", Value::Float(1.0)).node())
    }
}
