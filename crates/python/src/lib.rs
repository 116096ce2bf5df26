//! The Python module `etalon`: a thin layer around `etalon_render`, which gives the same bits as the binary.
//!
//! A `Scene` is read from a file, a text or a `dict`, rendered by `render` to an `Image`, and images are judged by `compare`.
//! The types that Python's tools see are in `etalon.pyi`.

mod array_values;
mod comparison;
mod conform;
mod denoise;
mod dict;
mod errors;
mod estimator;
mod estimators;
mod image;
mod listing;
mod merge;
mod origin;
mod planes;
mod progress_report;
mod render;
mod scene;
mod transform;
mod watched;

/// Etalon renders scenes with their statistical errors, and decides whether pictures agree.
#[pyo3::pymodule]
mod etalon {
    use pyo3::prelude::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", etalon_render::VERSION)
    }

    #[pymodule_export]
    use crate::comparison::{Comparison, compare};
    #[pymodule_export]
    use crate::conform::{Conformance, conform};
    #[pymodule_export]
    use crate::denoise::denoise;
    #[pymodule_export]
    use crate::errors::SceneError;
    #[pymodule_export]
    use crate::estimator::Estimator;
    #[pymodule_export]
    use crate::estimators::{EstimatorComparison, estimators};
    #[pymodule_export]
    use crate::image::{Image, read};
    #[pymodule_export]
    use crate::merge::merge;
    #[pymodule_export]
    use crate::render::render;
    #[pymodule_export]
    use crate::scene::{Scene, dict_to_xml, load_dict, load_file, load_string};
    #[pymodule_export]
    use crate::transform::Transform;
}
