//! Extensions: which are read, and what is said of the others.

use super::reader::Reader;

/// Those that are read, in whole or with notes where they are used.
const READ: &[&str] = &[
    "KHR_lights_punctual",
    "KHR_materials_clearcoat",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
];

/// Reports required extensions that are not read as mistakes, others with a note.
pub(crate) fn judge(reader: &Reader<'_>) {
    let root = reader.root;
    let unknown = |names: &[String]| {
        let names = names.iter().cloned().enumerate();
        let unknown = names.filter(|(_, name)| !READ.contains(&name.as_str()));
        unknown.collect::<Vec<_>>()
    };
    for (i, name) in unknown(&root.extensions_required) {
        let message = format!("the scene requires {name}, which is not read");
        let accepted = format!("read are {}", READ.join(", "));
        reader.refuse::<()>(&format!("extensionsRequired[{i}]"), message, accepted);
    }
    for (i, name) in unknown(&root.extensions_used) {
        if !root.extensions_required.contains(&name) {
            let message =
                format!("the extension {name} is not read: the scene is the one without it");
            reader.note(&format!("extensionsUsed[{i}]"), message);
        }
    }
}
