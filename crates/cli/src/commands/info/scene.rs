//! What is in a scene.

use crate::commands::{BAD_INPUT, answer};
use crate::diagnose;
use etalon_params::Node;
use etalon_render::memory::film_bytes;
use etalon_render::pipeline::{self, LoadOptions, Loaded};
use etalon_scene::Contents;
use serde_json::{Value as Json, json};
use std::path::Path;
use std::process::ExitCode;

/// Says what is in a scene, to people or programs.
pub(super) fn run(path: &Path, json: bool) -> ExitCode {
    match pipeline::load(path, &LoadOptions::default()) {
        Ok(loaded) => {
            diagnose::print(&loaded.notes, &loaded.sources);
            let text = match json {
                true => format!("{:#}\n", as_json(&loaded)),
                false => in_words(&loaded),
            };
            answer(&text, ExitCode::SUCCESS)
        }
        Err(refusal) => {
            diagnose::print(&refusal.diagnostics, &refusal.sources);
            ExitCode::from(BAD_INPUT)
        }
    }
}

/// The scene's sensors in the order in which `--sensor` counts them, and whether each is the one that is rendered.
fn sensors(loaded: &Loaded) -> Vec<(&Node, bool)> {
    let rendered = &loaded.compiled.sensor;
    let placed = etalon_scene::sensors(&loaded.described.root).into_iter();
    placed
        .map(|sensor| {
            (
                &**sensor.node,
                std::sync::Arc::ptr_eq(sensor.node, rendered),
            )
        })
        .collect()
}

/// Sizes of the files that the scene is read from (bytes).
fn file_bytes(loaded: &Loaded) -> u64 {
    let sizes = loaded.inputs.iter().filter_map(|path| path.metadata().ok());
    sizes.map(|metadata| metadata.len()).sum()
}

fn mebibytes(bytes: u64) -> String {
    format!("{:.1} MiB", bytes as f64 / f64::from(1 << 20))
}

fn in_words(loaded: &Loaded) -> String {
    let compiled = &loaded.compiled;
    let film = &compiled.film;
    let mut text = format!("scene        {} ({})\n", loaded.path.display(), loaded.hash);
    for (index, (name, value)) in loaded.described.parameters.iter().enumerate() {
        let title = if index == 0 { "parameters" } else { "" };
        text += &format!("{title:<12} ${name} = {value}\n");
    }
    for (number, (sensor, rendered)) in sensors(loaded).into_iter().enumerate() {
        let title = if number == 0 { "sensors" } else { "" };
        let id = (sensor.id.as_ref()).map_or_else(String::new, |id| format!(" `{id}`"));
        let plugin = &sensor.plugin.value;
        let marked = if rendered { ", rendered" } else { "" };
        text += &format!("{title:<12} {number} {plugin}{id}{marked}\n");
    }
    text += &format!("film         {} × {} pixels", film.size.x, film.size.y);
    if film.crop_size != film.size {
        let (offset, size) = (film.crop_offset, film.crop_size);
        text += &format!(
            ", of which {} × {} from ({}, {})",
            size.x, size.y, offset.x, offset.y
        );
    }
    let Contents {
        geometry,
        materials,
        lights,
        textures,
        pictures,
        picture_bytes,
    } = compiled.scene.contents();
    text += &format!(
        "\nfilter       {}\nintegrator   {}\nsamples      {} per pixel, {}\n\
         shapes       {} ({} triangles)\ninstances    {} ({} triangles)\n\
         accelerator  {} nodes\nmaterials    {materials}\nlights       {lights}\n\
         textures     {textures}, {pictures} of them pictures\n",
        film.filter,
        loaded.integrator_name,
        compiled.sampler.spp,
        pipeline::sampler_name(compiled.sampler.kind),
        geometry.shapes,
        geometry.triangles,
        geometry.instances,
        geometry.instanced_triangles,
        geometry.nodes,
    );
    let files = loaded.inputs.len();
    text += &format!("files        {files}, {}\n", mebibytes(file_bytes(loaded)));
    text += &format!(
        "memory       geometry {}, pictures {}, film {}\n",
        mebibytes(geometry.bytes as u64),
        mebibytes(picture_bytes as u64),
        mebibytes(film_bytes(loaded)),
    );
    text
}

fn as_json(loaded: &Loaded) -> Json {
    let compiled = &loaded.compiled;
    let film = &compiled.film;
    let contents = compiled.scene.contents();
    let parameters: serde_json::Map<String, Json> = (loaded.described.parameters.iter())
        .map(|(name, value)| (name.clone(), json!(value)))
        .collect();
    let sensors: Vec<Json> = (sensors(loaded).into_iter())
        .map(|(sensor, rendered)| {
            json!({ "type": sensor.plugin.value, "id": sensor.id, "rendered": rendered })
        })
        .collect();
    json!({
        "scene": loaded.path.display().to_string(),
        "hash": loaded.hash,
        "parameters": parameters,
        "sensors": sensors,
        "film": {
            "width": film.size.x,
            "height": film.size.y,
            "crop_offset": film.crop_offset.to_array(),
            "crop_size": film.crop_size.to_array(),
            "filter": film.filter.to_string(),
        },
        "integrator": loaded.integrator_name,
        "samples": compiled.sampler.spp,
        "sampler": pipeline::sampler_name(compiled.sampler.kind),
        "shapes": contents.geometry.shapes,
        "triangles": contents.geometry.triangles,
        "instances": contents.geometry.instances,
        "instanced_triangles": contents.geometry.instanced_triangles,
        "materials": contents.materials,
        "lights": contents.lights,
        "textures": contents.textures,
        "files": loaded.inputs.iter().map(|path| path.display().to_string()).collect::<Vec<_>>(),
        "bytes": {
            "files": file_bytes(loaded),
            "geometry": contents.geometry.bytes,
            "pictures": contents.picture_bytes,
            "film": film_bytes(loaded),
        },
    })
}
