//! A single technique of bidirectional path tracing.

use etalon_params::Params;

/// One technique.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Technique {
    /// s: vertices made from the light.
    pub light: usize,
    /// t: vertices made from the camera, which is one of them.
    pub camera: usize,
    /// Whether it has its MIS weight; if not, it estimates all paths of its length that it can
    /// generate.
    pub weighted: bool,
}

/// The single technique of the description, if it names one.
pub(super) fn from_params(params: &Params<'_>) -> Option<Technique> {
    let count = |name: &str, least: i64| {
        let given = params.integer_or(name, least);
        if given < least {
            params.refuse(name, given, "a number of vertices");
        }
        usize::try_from(given).unwrap_or(0)
    };
    let asked = params.has("s") || params.has("t") || params.has("weighted");
    let (light, camera) = (count("s", 0), count("t", 1));
    let weighted = params.boolean_or("weighted", true);
    if !asked {
        return None;
    }
    if !(params.has("s") && params.has("t")) {
        params.error("a single technique has both `s` and `t`: vertices made from the light and from the camera");
    } else if light + camera < 2 || (light == 1 && camera == 1) {
        let message = "there is no such technique: lights seen directly are found by s = 0, t = 2";
        params.error_at("s", message);
    }
    Some(Technique {
        light,
        camera,
        weighted,
    })
}
