//! Twins: scenes that POV-Ray renders from a file of its own.
//!
//! Beside `scene.xml` lies `scene.pov`, written by hand, with the same geometry, camera and lights. The
//! reference is the half-float OpenEXR file as POV-Ray wrote it, one ray through the centre of
//! each pixel, and a JSON file that says how it was made: from which state of *both* twins, by which
//! version, and with which options. `cargo xtask references --only povray` writes both.

use crate::claim::Claim;
use crate::folders;
use crate::rendering;
use etalon_film::RenderedImage;
use etalon_images::{Frame, exr, write_atomically};
use serde::{Deserialize, Serialize};
use std::io::Write;
use std::path::{Path, PathBuf};

/// How a picture by POV-Ray was made.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Provenance {
    /// Our twin, below `scenes/`.
    pub scene: String,
    /// Its parameters.
    pub defines: Vec<(String, String)>,
    /// A hash over our twin's files and parameters.
    pub scene_hash: String,
    /// POV-Ray's twin, below `scenes/`.
    pub twin: String,
    /// A hash over POV-Ray's twin.
    pub twin_hash: String,
    /// POV-Ray's version.
    pub povray: String,
    /// Its command-line options, without the names of files.
    pub options: Vec<String>,
    /// Width and height of the picture (pixels).
    pub size: [u32; 2],
}

/// Both twins' present state.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ScenePair {
    /// A hash over ours.
    pub scene_hash: String,
    /// A hash over POV-Ray's.
    pub twin_hash: String,
    /// Width and height of our film (pixels).
    pub size: [u32; 2],
}

/// POV-Ray's twin of a scene below `scenes/`.
pub fn twin(scene: &Path) -> PathBuf {
    scene.with_extension("pov")
}

/// The options that make POV-Ray's picture comparable: half-float OpenEXR (`+FE`), no window
/// (`-D`), and no antialiasing (`-A`): one ray through each pixel's centre.
pub fn options([width, height]: [u32; 2]) -> Vec<String> {
    let fixed = ["+FE", "-A", "-D"].map(str::to_owned);
    let size = [format!("+W{width}"), format!("+H{height}")];
    fixed.into_iter().chain(size).collect()
}

/// The twins of a claim as they are now.
///
/// # Errors
/// If either cannot be read.
pub fn twins(claim: &Claim) -> Result<ScenePair, String> {
    let loaded = rendering::load(claim, &rendering::defines(claim, None), None)?;
    let path = folders::scenes().join(twin(&claim.scene));
    let text = std::fs::read(&path).map_err(|e| {
        format!(
            "{}: {e}; a scene's twin for POV-Ray lies beside it",
            path.display()
        )
    })?;
    Ok(ScenePair {
        scene_hash: loaded.hash,
        twin_hash: blake3::hash(&text).to_hex()[..16].to_owned(),
        size: loaded.compiled.film.crop_size.to_array(),
    })
}

/// How a reference was made.
///
/// # Errors
/// If its description cannot be read.
pub fn provenance(folder: &Path, name: &str) -> Result<Provenance, String> {
    let path = folder.join(format!("{name}.json"));
    let error = |e: String| format!("{}: {e}; {}", path.display(), again(name));
    let text = std::fs::read_to_string(&path).map_err(|e| error(e.to_string()))?;
    serde_json::from_str(&text).map_err(|e| error(e.to_string()))
}

fn again(name: &str) -> String {
    format!("make it with `cargo xtask references --only {name}`")
}

/// Reads POV-Ray's picture from `folder`.
///
/// # Errors
/// If there is none, it cannot be read, it belongs to another state of either twin, it has
/// another size, or numbers that are not finite.
pub fn read_in(folder: &Path, name: &str, twins: &ScenePair) -> Result<RenderedImage, String> {
    let again = again(name);
    let made = provenance(folder, name)?;
    for (of, found, expected) in [
        ("the scene", &made.scene_hash, &twins.scene_hash),
        ("POV-Ray's twin", &made.twin_hash, &twins.twin_hash),
    ] {
        if found != expected {
            return Err(format!(
                "the reference was made from another state of {of}; {again}"
            ));
        }
    }
    let path = folder.join(format!("{name}.exr"));
    let document = exr::read(&path).map_err(|e| format!("{e}; {again}"))?;
    let (image, _) = document.flatten();
    let error = |reason: String| format!("{}: {reason}; {again}", path.display());
    let size = [image.width(), image.height()];
    if size != twins.size.map(|n| n as usize) {
        let ([w, h], [width, height]) = (size, twins.size);
        return Err(error(format!(
            "it has {w} × {h} pixels, the film {width} × {height}"
        )));
    }
    if ["R", "G", "B"]
        .iter()
        .any(|name| image.channel(name).is_none())
    {
        return Err(error("it has no channels R, G and B".to_owned()));
    }
    let picture = RenderedImage {
        frame: Frame::whole(&image),
        image,
        metadata: None,
    };
    rendering::finite(picture).map_err(error)
}

/// Puts POV-Ray's picture among the references, with a description of how it was made.
///
/// # Errors
/// If the picture cannot be used or a file cannot be written.
pub fn write(claim: &Claim, picture: &Path, povray: &str) -> Result<(), String> {
    let twins = twins(claim)?;
    let provenance = Provenance {
        scene: claim.scene.display().to_string(),
        defines: rendering::defines(claim, None),
        scene_hash: twins.scene_hash.clone(),
        twin: twin(&claim.scene).display().to_string(),
        twin_hash: twins.twin_hash.clone(),
        povray: povray.to_owned(),
        options: options(twins.size),
        size: twins.size,
    };
    let folder = folders::references();
    let bytes = std::fs::read(picture).map_err(|e| format!("{}: {e}", picture.display()))?;
    let text = format!("{:#}\n", serde_json::json!(provenance));
    let files = [("exr", bytes), ("json", text.into_bytes())];
    for (extension, bytes) in files {
        let path = folder.join(format!("{}.{extension}", claim.name));
        write_atomically(&path, |file| file.write_all(&bytes)).map_err(|e| e.to_string())?;
    }
    read_in(&folder, &claim.name, &twins).map(|_| ())
}
