//! Getters of several values.
//!
//! Points, vectors and colours are borrowed as they were read, three numbers each. As in pbrt, an array without any value is a
//! mistake.

use super::parameter::{ColorSpace, Parameter, ParameterType, Values};
use super::parameters::{Parameters, integers, numbers};
use etalon_params::Spanned;

impl<'a> Parameters<'a> {
    /// Numbers, if given.
    pub fn floats(&self, name: &str) -> Option<&'a [f64]> {
        let parameter = self.typed(name, &[ParameterType::Float])?;
        self.some(parameter, numbers(parameter))
    }

    /// A fixed number of numbers, if given.
    pub fn floats_of<const N: usize>(&self, name: &str) -> Option<&'a [f64; N]> {
        let parameter = self.typed(name, &[ParameterType::Float])?;
        self.exactly(parameter, numbers(parameter))
    }

    /// Integers, if given.
    pub fn integers(&self, name: &str) -> Option<&'a [i32]> {
        let parameter = self.typed(name, &[ParameterType::Integer])?;
        self.some(parameter, integers(parameter))
    }

    /// A fixed number of integers, if given.
    pub fn integers_of<const N: usize>(&self, name: &str) -> Option<&'a [i32; N]> {
        let parameter = self.typed(name, &[ParameterType::Integer])?;
        self.exactly(parameter, integers(parameter))
    }

    /// Points of the plane, if given.
    pub fn points2(&self, name: &str) -> Option<&'a [[f64; 2]]> {
        let parameter = self.typed(name, &[ParameterType::Point2])?;
        self.some(parameter, numbers(parameter).as_chunks().0)
    }

    /// Points, if given.
    pub fn points3(&self, name: &str) -> Option<&'a [[f64; 3]]> {
        self.triples(name, ParameterType::Point3)
    }

    /// A fixed number of points, if given.
    pub fn points3_of<const N: usize>(&self, name: &str) -> Option<&'a [[f64; 3]; N]> {
        let parameter = self.typed(name, &[ParameterType::Point3])?;
        self.exactly(parameter, numbers(parameter).as_chunks().0)
    }

    /// Vectors, if given.
    pub fn vectors3(&self, name: &str) -> Option<&'a [[f64; 3]]> {
        self.triples(name, ParameterType::Vector3)
    }

    /// Normals, if given.
    pub fn normals(&self, name: &str) -> Option<&'a [[f64; 3]]> {
        self.triples(name, ParameterType::Normal)
    }

    /// Colours, if given, and the colour space that they are in.
    pub fn rgbs(&self, name: &str) -> Option<(&'a [[f64; 3]], ColorSpace)> {
        let colours = self.triples(name, ParameterType::Rgb)?;
        let space = self.parameter(name)?.color_space;
        Some((colours, space))
    }

    /// Strings, each with its place, if given.
    pub fn strings(&self, name: &str) -> Option<&'a [Spanned<String>]> {
        let parameter = self.typed(name, &[ParameterType::String])?;
        match &parameter.values {
            Values::Strings(list) => self.some(parameter, list),
            _ => None,
        }
    }

    fn triples(&self, name: &str, kind: ParameterType) -> Option<&'a [[f64; 3]]> {
        let parameter = self.typed(name, &[kind])?;
        self.some(parameter, numbers(parameter).as_chunks().0)
    }

    fn some<'v, T>(&self, parameter: &Parameter, values: &'v [T]) -> Option<&'v [T]> {
        if values.is_empty() {
            self.wrong_count(parameter, 0, "at least one");
            return None;
        }
        Some(values)
    }

    fn exactly<'v, T, const N: usize>(
        &self,
        parameter: &Parameter,
        values: &'v [T],
    ) -> Option<&'v [T; N]> {
        let exact = values.try_into().ok();
        if exact.is_none() {
            self.wrong_count(parameter, values.len(), &N.to_string());
        }
        exact
    }
}
