//! References: pictures by Mitsuba 3 with standard errors and tile means, one replicate per seed.
//!
//! A reference is an EXR file of our own format whose replicates are Mitsuba's seeds, and a JSON
//! file that says how it was made. `cargo xtask references` writes both.

use crate::claim::{Claim, Oracle};
use crate::folders;
use crate::rendering;
use etalon_film::{Metadata, RenderFacts, RenderedImage, read_developed};
use etalon_images::{Image, write_atomically};
use etalon_render::seeds::Seeds;
use serde::{Deserialize, Serialize};
use std::io::Write;
use std::path::{Path, PathBuf};

/// How a reference was made.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Provenance {
    /// The scene, below `scenes/`.
    pub scene: String,
    /// Its parameters.
    pub defines: Vec<(String, String)>,
    /// A hash over the scene's files and parameters.
    pub scene_hash: String,
    /// Mitsuba's version.
    pub mitsuba: String,
    /// Mitsuba's variant.
    pub variant: String,
    /// How many seeds: 1, 2, …, without those skipped.
    pub seeds: u32,
    /// Seeds left out because Mitsuba's picture had pixels that were not finite.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub skipped_seeds: Vec<u32>,
    /// Samples per pixel and seed.
    pub spp: u32,
    /// Mitsuba's integrator, if not the scene's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub integrator: Option<String>,
}

/// The picture's file.
pub fn picture_path(name: &str) -> PathBuf {
    folders::references().join(format!("{name}.exr"))
}

fn provenance_path(name: &str) -> PathBuf {
    folders::references().join(format!("{name}.json"))
}

/// How a reference was made.
///
/// # Errors
/// If its description cannot be read.
pub fn provenance(name: &str) -> Result<Provenance, String> {
    let path = provenance_path(name);
    let text = std::fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
    serde_json::from_str(&text).map_err(|e| format!("{}: {e}", path.display()))
}

/// What a claim expects of its reference.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Expected {
    /// A hash over the scene's files and parameters.
    pub scene_hash: String,
    /// Width and height of the film (pixels).
    pub size: [u32; 2],
    /// Samples per pixel and seed.
    pub spp: u32,
    /// How many seeds.
    pub seeds: u32,
    /// Mitsuba's integrator, if not the scene's.
    pub integrator: Option<String>,
}

/// What a claim expects of its reference, with its scene as it is now.
///
/// # Errors
/// If the claim has no reference by Mitsuba, or its scene cannot be read.
pub fn expected(claim: &Claim) -> Result<Expected, String> {
    let Oracle::Reference { spp, seeds, .. } = claim.oracle else {
        return Err("this kind of claim has no reference by Mitsuba".to_owned());
    };
    let loaded = rendering::load(claim, &rendering::defines(claim, None), None)?;
    Ok(Expected {
        scene_hash: loaded.hash,
        size: loaded.compiled.film.crop_size.to_array(),
        spp,
        seeds,
        integrator: claim.oracle.integrator().map(str::to_owned),
    })
}

/// Reads a claim's reference.
///
/// # Errors
/// If there is none, it cannot be read, it belongs to another state of the scene or was made with
/// other numbers than the claim states or by somebody else than its description names, it lacks a
/// channel or the means of a size of tiles, or it has numbers that are not finite.
pub fn read(claim: &Claim) -> Result<RenderedImage, String> {
    read_in(&folders::references(), &claim.name, &expected(claim)?)
}

/// As [`read`], from a certain folder.
///
/// # Errors
/// As [`read`].
pub fn read_in(folder: &Path, name: &str, expected: &Expected) -> Result<RenderedImage, String> {
    let again = format!("make it with `cargo xtask references --only {name}`");
    let path = folder.join(format!("{name}.json"));
    let text =
        std::fs::read_to_string(&path).map_err(|e| format!("{}: {e}; {again}", path.display()))?;
    let provenance: Provenance =
        serde_json::from_str(&text).map_err(|e| format!("{}: {e}; {again}", path.display()))?;
    if provenance.scene_hash != expected.scene_hash {
        return Err(format!(
            "the reference was made from another state of the scene; {again}"
        ));
    }
    let made = (provenance.spp, provenance.seeds);
    if made != (expected.spp, expected.seeds) {
        return Err(format!(
            "the reference was made with {} samples per pixel of {} seeds, the claim's `oracle` \
             states {} of {}: correct the claim, or {again}",
            made.0, made.1, expected.spp, expected.seeds
        ));
    }
    if provenance.integrator != expected.integrator {
        let name = |integrator: &Option<String>| match integrator {
            Some(name) => format!("Mitsuba's `{name}`"),
            None => "the scene's integrator".to_owned(),
        };
        return Err(format!(
            "the reference was made by {}, the claim's `oracle` states {}: correct the claim, or \
             {again}",
            name(&provenance.integrator),
            name(&expected.integrator)
        ));
    }
    let path = folder.join(format!("{name}.exr"));
    let picture = read_developed(&path).map_err(|e| format!("{e}; {again}"))?;
    let error = |reason: &str| format!("{}: {reason}; {again}", path.display());
    let metadata = (picture.metadata.as_ref())
        .ok_or_else(|| error("it has no replicates and so no standard errors"))?;
    if metadata.replicates != provenance.seeds {
        return Err(error("not as many replicates as seeds"));
    }
    if metadata.spp != u64::from(made.0) * u64::from(made.1) {
        return Err(error("not as many samples as its description names"));
    }
    if metadata.scene_hash != expected.scene_hash {
        return Err(error("its scene is not the one its description names"));
    }
    let maker = maker(&provenance.mitsuba, &provenance.variant);
    if metadata.version != maker {
        return Err(error(&format!(
            "it was made by `{}`, its description names `{maker}`",
            metadata.version
        )));
    }
    if let Some(missing) = missing(metadata) {
        return Err(error(&format!("it has no {missing}")));
    }
    let ([w, h], [width, height]) = (metadata.film.crop_size, expected.size);
    if [w, h] != [width, height] {
        return Err(error(&format!(
            "it has {w} × {h} pixels, the film {width} × {height}"
        )));
    }
    rendering::finite(picture).map_err(|reason| error(&reason))
}

/// What a reference says of who rendered it.
fn maker(mitsuba: &str, variant: &str) -> String {
    format!("Mitsuba {mitsuba} {variant}")
}

/// What a reference lacks, if anything: questions about what is not there would be left out of a
/// comparison without a word.
fn missing(metadata: &Metadata) -> Option<String> {
    let channel = |name: &&str| metadata.channel_index(name).is_none();
    let channel = ["R", "G", "B"].into_iter().find(channel);
    // Our films of all sizes have them.
    let means = [None, Some(16), Some(64)];
    let means = means
        .into_iter()
        .find(|side| metadata.tiles(*side).is_none());
    channel
        .map(|name| format!("channel `{name}`"))
        .or(means.map(|side| match side {
            None => "means of the whole image".to_owned(),
            Some(side) => format!("means of tiles of {side}² pixels"),
        }))
}

/// What Mitsuba rendered.
#[derive(Clone, Debug, Deserialize)]
pub struct Rendered {
    /// Its version.
    pub mitsuba: String,
    /// Its variant.
    pub variant: String,
    /// Width of the pictures (pixels).
    pub width: usize,
    /// Height of the pictures (pixels).
    pub height: usize,
    /// Seeds left out because the picture had pixels that were not finite.
    #[serde(default)]
    pub skipped_seeds: Vec<u32>,
}

/// Writes the reference of a claim from the RGB pixels of all seeds, seed after seed. Returns
/// the largest relative standard error of a channel's mean.
///
/// # Errors
/// If the scene cannot be read, the pixels do not fit it, or a file cannot be written.
pub fn write(claim: &Claim, rendered: &Rendered, spp: u32, pixels: &[f32]) -> Result<f64, String> {
    let defines = rendering::defines(claim, None);
    let loaded = rendering::load(claim, &defines, None)?;
    let mut together = Seeds::on(loaded.compiled.film.clone())?;
    let size = rendered.width * rendered.height;
    for picture in pixels.chunks(3 * size) {
        if picture.len() != 3 * size {
            return Err("Mitsuba's pictures are incomplete".to_owned());
        }
        let plane = |c: usize| picture.iter().copied().skip(c).step_by(3).collect();
        let image = Image::new(rendered.width, rendered.height)
            .with("R", plane(0))
            .with("G", plane(1))
            .with("B", plane(2));
        together.add(&image, u64::from(spp))?;
    }
    let seeds = together.count() as u32;
    let provenance = Provenance {
        scene: claim.scene.display().to_string(),
        defines,
        scene_hash: loaded.hash.clone(),
        mitsuba: rendered.mitsuba.clone(),
        variant: rendered.variant.clone(),
        seeds,
        skipped_seeds: rendered.skipped_seeds.clone(),
        spp,
        integrator: claim.oracle.integrator().map(str::to_owned),
    };
    let developed = together.develop(RenderFacts {
        version: maker(&rendered.mitsuba, &rendered.variant),
        scene: provenance.scene.clone(),
        scene_hash: loaded.hash,
        integrator: (provenance.integrator.clone()).unwrap_or(loaded.integrator_name),
        seed: 1,
        ..RenderFacts::default()
    });
    developed
        .write_exr(&picture_path(&claim.name))
        .map_err(|e| e.to_string())?;
    let path = provenance_path(&claim.name);
    let text = format!("{:#}\n", serde_json::json!(provenance));
    write_atomically(&path, |file| file.write_all(text.as_bytes())).map_err(|e| e.to_string())?;
    relative_error(&developed)
}

/// The largest relative standard error of a channel's mean.
fn relative_error(picture: &RenderedImage) -> Result<f64, String> {
    let metadata = picture.metadata.as_ref().ok_or("there are no statistics")?;
    let mut largest = 0.0_f64;
    for channel in ["R", "G", "B"] {
        let (means, _) = etalon_render::judge::replicates(metadata, channel, None)?;
        let summary = etalon_statistics::Summary::of(&means).ok_or("too few seeds")?;
        largest = largest.max(summary.standard_error() / summary.mean().abs());
    }
    Ok(largest)
}
