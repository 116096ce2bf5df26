//! What Mitsuba 0.6 has, is accepted, and changes nothing here.

use super::{Ignored, Only, is_not_positive, is_true};
use crate::{Class, Value};

/// An entry without conditions.
const fn of(
    class: Class,
    plugins: &'static [&'static str],
    names: &'static [&'static str],
    reason: &'static str,
) -> Ignored {
    Ignored {
        class,
        plugins,
        names,
        only: None,
        said: false,
        reason,
    }
}

impl Ignored {
    /// The same with a note.
    const fn said(mut self) -> Self {
        self.said = true;
        self
    }

    /// The same, for some values only.
    const fn only(mut self, words: &'static str, holds: fn(&Value) -> bool) -> Self {
        self.only = Some(Only { words, holds });
        self
    }
}

const SAME_MEAN: &str = "They choose how paths are found, not what the picture converges to.";

/// The list.
pub(super) const LIST: &[Ignored] = &[
    of(
        Class::Scene,
        &[],
        &[
            "kd_max_bad_refines",
            "kd_parallel_build",
            "kd_retract",
            "test_type",
            "test_thresh",
        ],
        "They tune acceleration structures and tests of Mitsuba itself.",
    ),
    of(
        Class::Film,
        &[],
        &["high_quality_edges"],
        "It asked Mitsuba 0.6 for what `sample_border` asks for today.",
    ),
    of(
        Class::Film,
        &[],
        &["attach_log", "metadata["],
        "They asked Mitsuba 0.6 to keep its log and further words in the file. Files here say how they were made.",
    ),
    of(
        Class::Film,
        &["ldrfilm"],
        &["gamma", "exposure", "tonemap_method", "key", "burn"],
        "An `ldrfilm` is read as an `hdrfilm`, which is said: the picture stays linear.",
    ),
    of(
        Class::Film,
        &["mfilm"],
        &["digits", "variable"],
        "An `mfilm` is read as an `hdrfilm`, which is said.",
    ),
    of(
        Class::Film,
        &[],
        &["channel_names"],
        "They name the pictures of the integrator `multichannel`, and of no other.",
    )
    .said(),
    of(
        Class::Integrator,
        &[],
        &["strict_normals"],
        "Shading normals are treated as in Mitsuba 3, which has no such parameter.",
    )
    .said(),
    of(
        Class::Integrator,
        &["ptracer", "photonmapper", "ppm", "sppm"],
        &["granularity", "auto_cancel_gathering", "brute_force"],
        "They cut the work of particle tracing into parts, and choose how it finds the camera.",
    ),
    of(
        Class::Integrator,
        &["ppm", "sppm"],
        &["max_passes"],
        "The samples per pixel are the passes.",
    )
    .only("-1: the samples per pixel are the passes", is_not_positive),
    of(
        Class::Integrator,
        &["photonmapper"],
        &[
            "direct_samples",
            "glossy_samples",
            "global_photons",
            "caustic_photons",
            "volume_photons",
            "global_lookup_radius",
            "caustic_lookup_radius",
            "lookup_size",
            "global_lookup_size",
            "caustic_lookup_size",
            "volume_lookup_size",
            "gather_locally",
            "max_specular_depth",
        ],
        "`photonmap`, which stands in, has parameters of its own for its bias.",
    )
    .said(),
    of(
        Class::Integrator,
        &["bdpt"],
        &["light_image", "sample_direct"],
        SAME_MEAN,
    ),
    of(
        Class::Integrator,
        &["pssmlt", "mlt", "erpt"],
        &[
            "bidirectional",
            "two_stage",
            "first_stage",
            "first_stage_size_reduction",
            "kelemen_style_weights",
            "direct_sampling",
            "work_units",
            "bidirectional_mutation",
            "lens_perturbation",
            "caustic_perturbation",
            "multi_chain_perturbation",
            "manifold_perturbation",
            "lambda",
            "prob_factor",
        ],
        SAME_MEAN,
    ),
    of(
        Class::Integrator,
        &["mlt", "erpt"],
        &[
            "luminance_samples",
            "num_chains",
            "max_chains",
            "chain_length",
        ],
        SAME_MEAN,
    ),
    of(
        Class::Integrator,
        &["pssmlt", "mlt", "erpt"],
        &["direct_samples"],
        "Direct light is left to ordinary samples.",
    )
    .only("not 0, which leaves direct light out of the picture", is_not_zero),
    of(
        Class::Integrator,
        &["adaptive"],
        &[
            "max_error",
            "p_value",
            "max_sample_factor",
            "average_luminance",
            "verbose",
        ],
        "The integrator inside of it stands in, with the same number of samples in every pixel.",
    ),
    of(
        Class::Integrator,
        &["irrcache"],
        &[
            "resolution",
            "quality",
            "quality_adjustment",
            "gradients",
            "clamp_neighbor",
            "clamp_screen",
            "clamp_influence",
            "influence_min",
            "influence_max",
            "overture",
        ],
        "The integrator inside of it stands in, without a cache.",
    ),
    of(
        Class::Integrator,
        &["irrcache"],
        &["indirect_only", "debug"],
        "What only a cache shows is not built.",
    )
    .only("false", is_false),
    of(
        Class::Sampler,
        &[],
        &["dimension", "scramble"],
        "They choose how many dimensions are well distributed, and how they are scrambled. Here all are, with a scramble \
         of their own in every pixel.",
    ),
    of(
        Class::Shape,
        &["obj", "ply", "serialized"],
        &["max_smooth_angle"],
        "Vertex normals are those of the file or of all faces around a vertex, as in Mitsuba 3.",
    )
    .said(),
    of(
        Class::Shape,
        &["obj"],
        &["collapse"],
        "All of a file is one shape.",
    ),
    of(
        Class::Shape,
        &["obj"],
        &["load_materials"],
        "Files of materials (`.mtl`) are not read: a shape's material stands in the scene.",
    )
    .said(),
    of(
        Class::Shape,
        &["obj"],
        &["shape_index"],
        "It is one part of the file that Mitsuba 0.6 loads; here all of a file is one shape: cut it into several.",
    )
    .only("negative, which means all parts", is_negative),
    of(
        Class::Shape,
        &["ply"],
        &["srgb"],
        "It says how the texture `vertexcolors` reads colours, which is not built.",
    ),
    of(
        Class::Bsdf,
        &[],
        &["ensure_energy_conservation"],
        "Nothing reflects more light than it receives.",
    )
    .only("true", is_true),
    of(
        Class::Emitter,
        &["envmap"],
        &["cache"],
        "Images are kept as they are.",
    ),
    of(
        Class::Emitter,
        &["sunsky"],
        &["resolution"],
        "The sky is not made into an image.",
    ),
    of(
        Class::Emitter,
        &["sunsky"],
        &["stretch"],
        "The sky ends at the horizon.",
    )
    .only("1", is_one),
    of(
        Class::Texture,
        &["bitmap"],
        &["coordinates"],
        "Images lie where the texture coordinates are.",
    )
    .only("`uv`", is_uv),
    of(
        Class::Medium,
        &["homogeneous"],
        &["strategy", "medium_sampling_weight", "monochromatic", "channel"],
        SAME_MEAN,
    ),
    of(
        Class::Medium,
        &["heterogeneous"],
        &["method", "step_size"],
        "They choose how free paths are found, which is without error here: `tracking` chooses among ways of that.",
    ),
    of(
        Class::Volume,
        &["gridvolume"],
        &["send_data"],
        "It asked for the file to be sent to other machines.",
    ),
    of(
        Class::Subsurface,
        &["dipole", "multidipole", "adipole"],
        &["irr_samples", "quality", "sample_multiplier"],
        "They choose how finely Mitsuba 0.6 spread points over the surface; here nothing is interpolated.",
    ),
];

fn number(value: &Value) -> f64 {
    match value {
        Value::Float(x) => *x,
        Value::Integer(i) => *i as f64,
        _ => f64::NAN,
    }
}

fn is_negative(value: &Value) -> bool {
    number(value) < 0.0
}

fn is_not_zero(value: &Value) -> bool {
    number(value).abs() > 0.0
}

fn is_one(value: &Value) -> bool {
    number(value) == 1.0
}

fn is_false(value: &Value) -> bool {
    matches!(value, Value::Boolean(false))
}

fn is_uv(value: &Value) -> bool {
    matches!(value, Value::String(text) if text.eq_ignore_ascii_case("uv"))
}
