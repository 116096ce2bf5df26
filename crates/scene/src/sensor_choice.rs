//! Which of a scene's sensors is rendered: those of the scene and those of its shapes, in the order of the file.

use etalon_params::{Class, Diagnostic, Node, Params, Property, Value};
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

/// A sensor of a scene.
#[derive(Clone, Copy, Debug)]
pub struct PlacedSensor<'a> {
    /// Where it stands.
    pub property: &'a Property,
    /// Its description.
    pub node: &'a Arc<Node>,
    /// The shape that it is a child of, if it measures on one.
    pub carrier: Option<&'a Arc<Node>>,
}

/// A scene's sensors, in the order of the file.
pub fn sensors(scene: &Node) -> Vec<PlacedSensor<'_>> {
    let mut sensors = Vec::new();
    for property in &scene.properties {
        let Value::Object(node) = &property.value else {
            continue;
        };
        match node.class {
            Class::Sensor => sensors.push(PlacedSensor {
                property,
                node,
                carrier: None,
            }),
            Class::Shape => {
                let inside = node
                    .properties
                    .iter()
                    .filter_map(|property| match &property.value {
                        Value::Object(sensor) if sensor.class == Class::Sensor => {
                            Some(PlacedSensor {
                                property,
                                node: sensor,
                                carrier: Some(node),
                            })
                        }
                        _ => None,
                    });
                sensors.extend(inside);
            }
            _ => {}
        }
    }
    sensors
}

/// The sensor that is rendered: the chosen one, or the first. `None` after a mistake, which has been recorded.
pub(crate) fn chosen<'a>(
    params: &Params<'a>,
    choice: Option<&SensorChoice>,
) -> Option<PlacedSensor<'a>> {
    let sensors = sensors(params.node);
    sensors
        .iter()
        .for_each(|sensor| sensor.property.mark_used());
    let Some(choice) = choice else {
        let Some(first) = sensors.first() else {
            params.diagnostics.push(
                Diagnostic::error(params.node.span, "the scene has no sensor")
                    .help("add a <sensor type=\"perspective\">"),
            );
            return None;
        };
        for other in &sensors[1..] {
            let message = "only the scene's first sensor is rendered";
            let note = Diagnostic::note(other.property.name_span, message).label("not rendered");
            params
                .diagnostics
                .push(note.help("`--sensor` chooses another"));
        }
        return Some(*first);
    };
    let found = (0..)
        .zip(&sensors)
        .find(|(index, sensor)| choice.is(*index, sensor.node));
    if found.is_none() {
        let message = match choice {
            SensorChoice::Number(number) => format!("the scene has no sensor number {number}"),
            SensorChoice::Id(id) => format!("the scene has no sensor called `{id}`"),
        };
        let names = (0..)
            .zip(&sensors)
            .map(
                |(index, sensor): (usize, &PlacedSensor<'_>)| match &sensor.node.id {
                    Some(id) => format!("{index} (`{id}`)"),
                    None => index.to_string(),
                },
            );
        let names: Vec<String> = names.collect();
        let help = match names.is_empty() {
            true => "it has none at all".to_owned(),
            false => format!("it has {}", names.join(", ")),
        };
        (params.diagnostics).push(Diagnostic::error_nowhere(message).help(help));
    }
    found.map(|(_, sensor)| *sensor)
}
