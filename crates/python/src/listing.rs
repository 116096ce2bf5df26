//! The values of a scene's plugins by their paths of keys: what they are, and trees with others in their place.

use etalon_params::{Node, Property, SpectrumText, Value};
use etalon_transport::MeshData;
use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use std::collections::{HashMap, HashSet, VecDeque};
use std::sync::Arc;

/// A change of a scene.
#[derive(Clone)]
pub(crate) struct Change {
    /// The path of keys of a value.
    pub(crate) path: String,
    /// What is there.
    pub(crate) value: Value,
    /// What is in the file of this name, which is none.
    pub(crate) contents: Option<Contents>,
}

/// What stands for a file.
#[derive(Clone)]
pub(crate) enum Contents {
    Bytes(Arc<Vec<u8>>),
    Mesh(Arc<MeshData>),
}

/// The objects of a scene, each under its shortest path.
pub(crate) struct Listing<'a> {
    objects: Vec<(String, &'a Arc<Node>)>,
    by_path: HashMap<String, &'a Arc<Node>>,
}

impl<'a> Listing<'a> {
    /// Of a scene's tree. An object's key is its name, or else its id, or else its type with a number from the second on.
    pub(crate) fn of(root: &'a Arc<Node>) -> Self {
        let mut objects = Vec::new();
        let mut met = HashSet::new();
        let mut open = VecDeque::from([(String::new(), root)]);
        while let Some((path, node)) = open.pop_front() {
            let mut taken: HashSet<String> = HashSet::new();
            for property in &node.properties {
                let Value::Object(child) = &property.value else {
                    continue;
                };
                let key = match (property.name.as_str(), &child.id) {
                    ("", Some(id)) => id,
                    ("", None) => &child.plugin.value,
                    (name, _) => name,
                };
                let numbers = 2..;
                let numbered = numbers.map(|number| format!("{key}_{number}"));
                let mut keys = std::iter::once(key.to_owned()).chain(numbered);
                let key = keys.find(|key| taken.insert(key.clone()));
                if met.insert(Arc::as_ptr(child)) {
                    open.push_back((join(&path, &key.unwrap_or_default()), child));
                }
            }
            objects.push((path, node));
        }
        Self {
            by_path: objects.iter().cloned().collect(),
            objects,
        }
    }

    /// The object at a path.
    pub(crate) fn object(&self, path: &str) -> Option<&'a Arc<Node>> {
        self.by_path.get(path).copied()
    }

    /// All objects with their paths.
    pub(crate) fn objects(&self) -> impl Iterator<Item = (&str, &'a Arc<Node>)> {
        self.objects
            .iter()
            .map(|(path, node)| (path.as_str(), *node))
    }

    /// The paths of all objects but the scene.
    pub(crate) fn paths(&self) -> impl Iterator<Item = &str> {
        let paths = self.objects.iter().map(|(path, _)| path.as_str());
        paths.filter(|path| !path.is_empty())
    }

    /// All values that can be changed, with their paths.
    pub(crate) fn values(&self) -> impl Iterator<Item = (String, &'a Value)> {
        self.objects.iter().flat_map(|(path, node)| {
            let properties = node.properties.iter().filter(|p| is_settable(p));
            properties.map(move |p| (join(path, &p.name), &p.value))
        })
    }
}

/// Whether a property is a value that can be another: not an object, and not the name of a file, which has been read.
fn is_settable(property: &Property) -> bool {
    let is_value = !matches!(property.value, Value::Object(_) | Value::Animation { .. });
    is_value && !property.name.is_empty() && property.name != FILE
}

/// The parameter that names a file.
pub(crate) const FILE: &str = "filename";

/// The name of an object's file.
pub(crate) fn file_name(node: &Node) -> Option<&str> {
    match &node.property(FILE)?.value {
        Value::String(name) => Some(name),
        _ => None,
    }
}

/// A path of keys with another.
pub(crate) fn join(path: &str, key: &str) -> String {
    match path {
        "" => key.to_owned(),
        path => format!("{path}.{key}"),
    }
}

/// Path of the object and name of the property.
pub(crate) fn split(path: &str) -> Option<(&str, &str)> {
    path.rsplit_once('.')
}

/// The tree with other values; objects that several others share stay shared. The paths that lead to no object are told.
pub(crate) fn changed(root: &Arc<Node>, changes: &[Change]) -> Result<Arc<Node>, Vec<String>> {
    let listing = Listing::of(root);
    let mut of_nodes: HashMap<*const Node, Vec<(&str, &Value)>> = HashMap::new();
    let mut lost = Vec::new();
    for Change { path, value, .. } in changes {
        let found = split(path).and_then(|(object, key)| Some((listing.object(object)?, key)));
        match found {
            Some((node, key)) => {
                let changes = of_nodes.entry(Arc::as_ptr(node)).or_default();
                changes.push((key, value));
            }
            None => lost.push(path.clone()),
        }
    }
    if !lost.is_empty() {
        return Err(lost);
    }
    Ok(rebuilt(root, &of_nodes, &mut HashMap::new()))
}

/// A node with the changes in it and below.
fn rebuilt(
    node: &Arc<Node>,
    changes: &HashMap<*const Node, Vec<(&str, &Value)>>,
    done: &mut HashMap<*const Node, Arc<Node>>,
) -> Arc<Node> {
    if let Some(done) = done.get(&Arc::as_ptr(node)) {
        return Arc::clone(done);
    }
    let copied = |property: &Property| {
        let value = match &property.value {
            Value::Object(child) => Value::Object(rebuilt(child, changes, done)),
            value => value.clone(),
        };
        let (name, name_span) = (&property.name, property.name_span);
        let copy = Property::new(name, name_span, value, property.span);
        if property.is_used() {
            copy.mark_used();
        }
        copy
    };
    let mut other = node.with_properties(node.properties.iter().map(copied).collect());
    for (key, value) in changes.get(&Arc::as_ptr(node)).into_iter().flatten() {
        other = other.with(key, (*value).clone());
    }
    let other = Arc::new(other);
    done.insert(Arc::as_ptr(node), Arc::clone(&other));
    other
}

/// A value as Python has it: a number, a text, or an array of 3, 4 × 4 or, of wavelengths (nm) and values, n × 2.
pub(crate) fn to_python<'py>(py: Python<'py>, value: &Value) -> PyResult<Bound<'py, PyAny>> {
    let array = |numbers: &[f64], shape: [usize; 2]| {
        let array = PyArray1::from_slice(py, numbers).reshape(shape)?;
        Ok(array.into_any())
    };
    match value {
        Value::Float(x) | Value::Spectrum(SpectrumText::Uniform(x)) => {
            Ok(x.into_pyobject(py)?.into_any())
        }
        Value::Integer(i) => Ok(i.into_pyobject(py)?.into_any()),
        Value::Boolean(b) => Ok(b.into_pyobject(py)?.to_owned().into_any()),
        Value::String(text) => Ok(text.into_pyobject(py)?.into_any()),
        Value::Vector(v) | Value::Rgb(v) => Ok(PyArray1::from_slice(py, &v.to_array()).into_any()),
        Value::Spectrum(SpectrumText::Samples(pairs)) => {
            let numbers: Vec<f64> = pairs.iter().flat_map(|(nm, x)| [*nm, *x]).collect();
            array(&numbers, [pairs.len(), 2])
        }
        Value::Transform(matrix) => array(&matrix.transpose().to_cols_array(), [4, 4]),
        Value::Animation { .. } | Value::Object(_) => Ok(py.None().into_bound(py)),
    }
}
