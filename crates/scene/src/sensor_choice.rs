//! Which of a scene's sensors is rendered.

use etalon_params::{Class, Diagnostic, Node, Params};
use std::sync::Arc;

/// A sensor by its place in the file or by its `id`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SensorChoice {
    /// Counted from 0, as Mitsuba does.
    Number(usize),
    /// Its `id`.
    Id(String),
}

impl SensorChoice {
    fn is(&self, index: usize, node: &Node) -> bool {
        match self {
            Self::Number(number) => *number == index,
            Self::Id(id) => node.id.as_ref() == Some(id),
        }
    }
}

/// The sensor that is rendered: the chosen one, or the first. `None` after a mistake, which has been recorded.
pub(crate) fn chosen<'a>(
    params: &Params<'a>,
    choice: Option<&SensorChoice>,
) -> Option<&'a Arc<Node>> {
    let sensors = params.children(Class::Sensor);
    let Some(choice) = choice else {
        let Some((_, first)) = sensors.first() else {
            params.diagnostics.push(
                Diagnostic::error(params.node.span, "the scene has no sensor")
                    .help("add a <sensor type=\"perspective\">"),
            );
            return None;
        };
        for (property, _) in &sensors[1..] {
            let message = "only the scene's first sensor is rendered";
            let note = Diagnostic::note(property.name_span, message).label("not rendered");
            params
                .diagnostics
                .push(note.help("`--sensor` chooses another"));
        }
        return Some(first);
    };
    let found = (0..)
        .zip(&sensors)
        .find(|(index, (_, node))| choice.is(*index, node));
    if found.is_none() {
        let message = match choice {
            SensorChoice::Number(number) => format!("the scene has no sensor number {number}"),
            SensorChoice::Id(id) => format!("the scene has no sensor called `{id}`"),
        };
        let names = (0..)
            .zip(&sensors)
            .map(|(index, (_, node)): (usize, _)| match &node.id {
                Some(id) => format!("{index} (`{id}`)"),
                None => index.to_string(),
            });
        let names: Vec<String> = names.collect();
        let help = match names.is_empty() {
            true => "it has none at all".to_owned(),
            false => format!("it has {}", names.join(", ")),
        };
        (params.diagnostics).push(Diagnostic::error_nowhere(message).help(help));
    }
    found.map(|(_, (_, node))| *node)
}
