//! From names to objects: `<ref>` and `<alias>`, and the tree of shared nodes they make.

use super::animation::Moments;
use super::draft::{DraftProperty, DraftValue, ObjectId};
use super::number::excerpt;
use super::reader::{MOST_LEVELS, Reader};
use etalon_params::{Diagnostic, Node, Property, Span, Value};
use std::sync::Arc;

/// How many names are compared for "did you mean".
const MOST_CANDIDATES: usize = 4096;

/// How many objects there may be when every shared one is counted at each of its uses.
const MOST_USES: u64 = 1 << 32;

/// Replaces every reference by its object; references that lead nowhere are reported and
/// dropped.
pub(crate) fn resolve(reader: &mut Reader<'_>) {
    resolve_aliases(reader);
    for object in 0..reader.draft.objects.len() {
        if reader.is_full() {
            return;
        }
        let mut next = 0;
        while let Some(property) = reader.draft.objects[object].properties.get_mut(next) {
            next += 1;
            let DraftValue::Reference(id) = &mut property.value else {
                continue;
            };
            let (id, span) = (std::mem::take(id), property.span);
            // An object without a type has been reported where it stands.
            let found = look_up(reader, &id, span)
                .filter(|&found| !reader.draft.objects[found].plugin.value.is_empty());
            let properties = &mut reader.draft.objects[object].properties;
            match found {
                Some(object) => properties[next - 1].value = DraftValue::Object(object),
                None => {
                    next -= 1;
                    properties.remove(next);
                    excuse(reader, object);
                }
            }
        }
    }
}

/// Nothing more is said about an object that lost a child: it cannot be blamed for lacking it.
fn excuse(reader: &mut Reader<'_>, object: ObjectId) {
    let span = reader.draft.objects[object].plugin.span;
    reader.stand_ins.push(span);
}

fn look_up(reader: &mut Reader<'_>, id: &str, span: Span) -> Option<ObjectId> {
    if let Some(&(object, _)) = reader.draft.ids.get(id) {
        return Some(object);
    }
    let mut known: Vec<&str> = reader.draft.ids.keys().map(String::as_str).collect();
    known.sort_unstable();
    known.truncate(MOST_CANDIDATES);
    let diagnostic = Diagnostic::error(
        span,
        format!("there is no object with the id `{}`", excerpt(id)),
    )
    .suggest(id, known);
    reader.report(diagnostic);
    None
}

/// Gives each alias the object of its source. An alias may precede its source, and its source may be
/// another alias.
fn resolve_aliases(reader: &mut Reader<'_>) {
    let mut open = std::mem::take(&mut reader.draft.aliases);
    loop {
        let before = open.len();
        let mut waiting = Vec::new();
        for (name, source) in open {
            let Some(&(object, _)) = reader.draft.ids.get(&source.value) else {
                waiting.push((name, source));
                continue;
            };
            if let Some(&(_, first)) = reader.draft.ids.get(&name.value) {
                reader.report(
                    Diagnostic::error(
                        name.span,
                        format!("the id `{}` is given twice", excerpt(&name.value)),
                    )
                    .related(first, "first given here"),
                );
                continue;
            }
            reader.draft.ids.insert(name.value, (object, name.span));
        }
        open = waiting;
        if open.len() == before || open.is_empty() {
            break;
        }
    }
    for (_, source) in open {
        look_up(reader, &source.value, source.span);
    }
}

/// The objects under `root` (and those that hang from nothing) in an order in which each comes
/// after everything it contains. References that close a circle are reported and cut.
pub(crate) fn order(reader: &mut Reader<'_>, root: ObjectId) -> Option<Vec<ObjectId>> {
    #[derive(Clone, Copy, PartialEq)]
    enum Mark {
        New,
        Open,
        Done,
    }
    let count = reader.draft.objects.len();
    let mut marks = vec![Mark::New; count];
    let mut order = Vec::with_capacity(count);
    // Objects being visited, each with the number of its properties already looked at.
    let mut stack: Vec<(ObjectId, usize)> = vec![(root, 0)];
    marks[root] = Mark::Open;
    while let Some((object, next)) = stack.last_mut() {
        let properties = &reader.draft.objects[*object].properties;
        let Some(property) = properties.get(*next) else {
            marks[*object] = Mark::Done;
            order.push(*object);
            stack.pop();
            continue;
        };
        *next += 1;
        let DraftValue::Object(child) = property.value else {
            continue;
        };
        match marks[child] {
            Mark::Done => {}
            Mark::New => {
                marks[child] = Mark::Open;
                stack.push((child, 0));
            }
            Mark::Open => {
                let span = property.span;
                let (object, position) = (*object, *next - 1);
                report_circle(reader, &stack, child, span);
                reader.draft.objects[object].properties.remove(position);
                excuse(reader, object);
                if let Some((_, next)) = stack.last_mut() {
                    *next -= 1;
                }
            }
        }
    }
    check_size(reader, &order).then_some(order)
}

fn report_circle(
    reader: &mut Reader<'_>,
    stack: &[(ObjectId, usize)],
    closing: ObjectId,
    span: Span,
) {
    let start = stack.iter().position(|(o, _)| *o == closing).unwrap_or(0);
    let name = |object: ObjectId| {
        let object = &reader.draft.objects[object];
        let plugin = &object.plugin.value;
        object.id.as_deref().map_or_else(|| plugin.clone(), excerpt)
    };
    let mut names: Vec<String> = stack[start..].iter().map(|(o, _)| name(*o)).collect();
    names.push(name(closing));
    if names.len() > 12 {
        names.splice(6..names.len() - 5, ["…".to_owned()]);
    }
    let diagnostic = Diagnostic::error(
        span,
        format!("objects contain each other: {}", names.join(" → ")),
    );
    reader.report(diagnostic);
}

/// Refuses trees that are too deep to traverse or, with sharing undone, too large.
fn check_size(reader: &mut Reader<'_>, order: &[ObjectId]) -> bool {
    let mut depth = vec![0usize; reader.draft.objects.len()];
    let mut uses = vec![1u64; reader.draft.objects.len()];
    for &object in order {
        for property in &reader.draft.objects[object].properties {
            if let DraftValue::Object(child) = property.value {
                depth[object] = depth[object].max(depth[child] + 1);
                uses[object] = uses[object].saturating_add(uses[child]);
            }
        }
        let message = if depth[object] > MOST_LEVELS {
            format!("objects are nested more than {MOST_LEVELS} levels deep, references included")
        } else if uses[object] > MOST_USES {
            "references to references make more objects than can be counted".to_owned()
        } else {
            continue;
        };
        let span = reader.draft.objects[object].plugin.span;
        reader.report(Diagnostic::error(span, message));
        return false;
    }
    true
}

/// Makes the shared nodes, in the order given; the last one is the root.
pub(crate) fn build(reader: &mut Reader<'_>, order: &[ObjectId]) -> Option<Arc<Node>> {
    let moments = reader.draft.moments(reader.options.time);
    let mut built: Vec<Option<Arc<Node>>> = vec![None; reader.draft.objects.len()];
    let mut root = None;
    for &id in order {
        let object = &mut reader.draft.objects[id];
        let properties = std::mem::take(&mut object.properties);
        let node = Arc::new(Node {
            class: object.class,
            plugin: object.plugin.clone(),
            id: object.id.take(),
            span: object.span,
            properties: properties
                .into_iter()
                .filter_map(|property| finished(property, &built, moments))
                .collect(),
        });
        built[id] = Some(node.clone());
        root = Some(node);
    }
    root
}

fn finished(
    property: DraftProperty,
    built: &[Option<Arc<Node>>],
    moments: Moments,
) -> Option<Property> {
    let value = match property.value {
        DraftValue::Plain(value) => value,
        DraftValue::Animation(animation) => animation.at(moments),
        DraftValue::Object(child) => Value::Object(built[child].clone()?),
        DraftValue::Reference(_) => return None,
    };
    let finished = Property::new(property.name, property.name_span, value, property.span);
    if property.excused {
        finished.mark_used();
    }
    Some(finished)
}
