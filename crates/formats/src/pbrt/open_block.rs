//! Blocks: `AttributeBegin`, `TransformBegin` and `ObjectBegin` with their ends.
//!
//! Each saves the whole graphics state. In pbrt-v4 that holds for `TransformBegin`, too, which in pbrt-v3 saved the transform only.

use super::reader::Reader;
use super::scene::Object;
use super::state::GraphicsState;
use super::statement::Statement;
use etalon_params::{Diagnostic, Span};

/// How deep blocks may nest.
const MOST_LEVELS: usize = 1024;

/// A block that is open.
#[derive(Debug)]
pub(crate) struct OpenBlock {
    kind: BlockKind,
    /// The directive that began it.
    begin: Span,
    /// The state before it.
    saved: GraphicsState,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum BlockKind {
    Attribute,
    Transform,
    Object,
}

impl BlockKind {
    fn begin(self) -> &'static str {
        match self {
            Self::Attribute => "AttributeBegin",
            Self::Transform => "TransformBegin",
            Self::Object => "ObjectBegin",
        }
    }

    fn end(self) -> &'static str {
        match self {
            Self::Attribute => "AttributeEnd",
            Self::Transform => "TransformEnd",
            Self::Object => "ObjectEnd",
        }
    }
}

pub(crate) fn attribute_begin(reader: &mut Reader<'_>, statement: Statement) {
    begin(reader, BlockKind::Attribute, statement.word);
}

pub(crate) fn attribute_end(reader: &mut Reader<'_>, statement: Statement) {
    end(reader, BlockKind::Attribute, statement.word);
}

pub(crate) fn transform_begin(reader: &mut Reader<'_>, statement: Statement) {
    if !reader.settings.said_transform_begin {
        let message = "in pbrt-v4, `TransformBegin` is the same as `AttributeBegin`";
        let note = Diagnostic::note(statement.word, message);
        reader.report(note.help("it saves the material and all other attributes, too"));
    }
    reader.settings.said_transform_begin = true;
    begin(reader, BlockKind::Transform, statement.word);
}

pub(crate) fn transform_end(reader: &mut Reader<'_>, statement: Statement) {
    end(reader, BlockKind::Transform, statement.word);
}

pub(crate) fn object_begin(reader: &mut Reader<'_>, statement: Statement) {
    let name = statement.name(0);
    begin(reader, BlockKind::Object, statement.word);
    match &reader.open_object {
        None => {
            reader.open_object = Some(Object {
                name,
                shapes: Vec::new(),
                instances: Vec::new(),
            });
        }
        Some(outer) => {
            let message = "an object cannot be defined inside of the definition of another one";
            let mistake = Diagnostic::error(statement.word, message)
                .related(outer.name.span, "this one is not finished")
                .help("define it before, and put an `ObjectInstance` of it here");
            reader.report(mistake);
        }
    }
}

pub(crate) fn object_end(reader: &mut Reader<'_>, statement: Statement) {
    end(reader, BlockKind::Object, statement.word);
}

fn begin(reader: &mut Reader<'_>, kind: BlockKind, begin: Span) {
    if reader.blocks.len() == MOST_LEVELS {
        let message = format!("blocks are nested more than {MOST_LEVELS} levels deep");
        reader.mistakes.give_up(Diagnostic::error(begin, message));
        return;
    }
    reader.blocks.push(OpenBlock {
        kind,
        begin,
        saved: reader.state.clone(),
    });
}

fn end(reader: &mut Reader<'_>, kind: BlockKind, end: Span) {
    if reader.blocks.len() <= reader.floor {
        let message = format!("`{}` without `{}`", kind.end(), kind.begin());
        let mistake = Diagnostic::error(end, message);
        let outside = reader.blocks.last().map(|outside| outside.begin);
        reader.report(match outside {
            None => mistake,
            Some(begin) => mistake
                .related(begin, "this block was opened outside of the imported file")
                .help("an imported file closes the blocks that it opens, and no others"),
        });
        return;
    }
    let Some(block) = reader.blocks.pop() else {
        return;
    };
    if block.kind != kind {
        let message = format!("`{}` where `{}` is due", kind.end(), block.kind.end());
        let open = format!("`{}` is open", block.kind.begin());
        reader.report(Diagnostic::error(end, message).related(block.begin, open));
    }
    close(reader, block);
}

/// Ends a block: the state is what it was, and an object is finished with its outermost `ObjectBegin`.
fn close(reader: &mut Reader<'_>, block: OpenBlock) {
    let is_object = |open: &OpenBlock| open.kind == BlockKind::Object;
    let ends_object = is_object(&block);
    reader.state = block.saved;
    if !ends_object || reader.blocks.iter().any(is_object) {
        return;
    }
    if let Some(object) = reader.open_object.take() {
        let name = object.name.clone();
        if let Err(mistake) = reader.objects.define(&name, object) {
            reader.report(mistake);
        }
    }
}

/// Reports and closes the blocks that are still open at the end of the scene, or of an imported file.
pub(crate) fn close_all(reader: &mut Reader<'_>) {
    while reader.blocks.len() > reader.floor
        && let Some(block) = reader.blocks.pop()
    {
        let message = format!("`{}` without `{}`", block.kind.begin(), block.kind.end());
        reader.report(Diagnostic::error(block.begin, message));
        close(reader, block);
    }
}
