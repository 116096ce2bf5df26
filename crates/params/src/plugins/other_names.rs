//! What other programs, and books, call the plugins of this one.

use crate::Class;

/// Class, a name in lower case without `_` and `-`, and the plugin.
const NAMES: &[(Class, &str, &str)] = &[
    (Class::Integrator, "pathtracer", "path"),
    (Class::Integrator, "pathtracing", "path"),
    (Class::Integrator, "pt", "path"),
    (Class::Integrator, "unidirectional", "path"),
    (Class::Integrator, "globalillumination", "path"),
    (Class::Integrator, "raytracer", "whitted"),
    (Class::Integrator, "raytracing", "whitted"),
    (Class::Integrator, "volumepath", "volpath"),
    (Class::Integrator, "volpathtracer", "volpath"),
    (Class::Integrator, "directlighting", "direct"),
    (Class::Integrator, "lighttracer", "ptracer"),
    (Class::Integrator, "particletracer", "ptracer"),
    (Class::Integrator, "lightpath", "ptracer"),
    (Class::Integrator, "bidirectional", "bdpt"),
    (Class::Integrator, "metropolis", "mmlt"),
    (Class::Integrator, "pathguiding", "guided"),
    (Class::Integrator, "ppg", "guided"),
    (Class::Integrator, "photonmapping", "photonmap"),
    (Class::Integrator, "ambientocclusion", "ao"),
    (Class::Integrator, "upbp", "vcm"),
    (Class::Bsdf, "lambertian", "diffuse"),
    (Class::Bsdf, "matte", "diffuse"),
    (Class::Bsdf, "lambert", "diffuse"),
    (Class::Bsdf, "glass", "dielectric"),
    (Class::Bsdf, "mirror", "conductor"),
    (Class::Bsdf, "metal", "roughconductor"),
    (Class::Bsdf, "disney", "principled"),
    (Class::Bsdf, "orennayar", "roughdiffuse"),
    (Class::Emitter, "environment", "envmap"),
    (Class::Emitter, "infinite", "constant"),
    (Class::Emitter, "sun", "directional"),
    (Class::Emitter, "distant", "directional"),
    (Class::Film, "film", "hdrfilm"),
    (Class::Film, "exrfilm", "hdrfilm"),
    (Class::Sampler, "random", "independent"),
    (Class::Sensor, "pinhole", "perspective"),
    (Class::Shape, "trianglemesh", "ply"),
    (Class::Shape, "mesh", "ply"),
    (Class::Shape, "quad", "rectangle"),
    (Class::Shape, "square", "rectangle"),
    (Class::Shape, "box", "cube"),
    (Class::Shape, "ball", "sphere"),
    (Class::Texture, "image", "bitmap"),
    (Class::Texture, "imagemap", "bitmap"),
    (Class::Texture, "constant", "uniform"),
    (Class::Volume, "constant", "constvolume"),
    (Class::Volume, "grid", "gridvolume"),
    (Class::Phase, "henyeygreenstein", "hg"),
];

/// The plugin that others call `name`.
pub(super) fn ours(class: Class, name: &str) -> Option<&'static str> {
    let bare: String = name.chars().filter(|c| !"_-".contains(*c)).collect();
    let found = NAMES
        .iter()
        .find(|(of, other, _)| *of == class && other.eq_ignore_ascii_case(&bare));
    found.map(|(.., ours)| *ours)
}
