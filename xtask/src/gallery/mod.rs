//! `cargo xtask gallery`: the pictures of the book, `docs/gallery/`.
//!
//! There is one for the scene on each page of the course, `course-NAME.jpg`, one for each scene of `scenes/gallery`, which is denoised,
//! and one for each plugin ([`stages`]). `rendered.txt` beside them says which scene, by its hash, each is of, so that only what changed is rendered
//! again.

pub(crate) mod stages;

use etalon_images::{Image, jpeg};
use etalon_render::denoise::denoise;
use etalon_render::pipeline::{self, LoadOptions, Loaded, RenderControls, RenderOptions};
use etalon_validation::folders;
use stages::Stages;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Samples per pixel of a page's picture; scenes of the gallery have their own.
const SAMPLES: u32 = 128;

/// Quality of the files, of 100.
const QUALITY: u8 = 90;

/// The options of the command.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Only pictures whose names contain this.
    #[arg(long, value_name = "NAME")]
    only: Option<String>,
}

/// A picture of the gallery.
struct Picture {
    name: String,
    scene: PathBuf,
    /// Samples per pixel, if not the scene's.
    spp: Option<u32>,
    /// How much brighter it is shown (stops).
    exposure: f32,
    /// Whether it is denoised.
    denoised: bool,
}

fn folder() -> PathBuf {
    folders::root().join("docs/gallery")
}

/// Which picture is of which scene.
fn rendered() -> BTreeMap<String, String> {
    let text = fs::read_to_string(folder().join("rendered.txt")).unwrap_or_default();
    let lines = text.lines().filter_map(|line| line.split_once(' '));
    lines
        .map(|(name, hash)| (name.to_owned(), hash.to_owned()))
        .collect()
}

fn failed(path: &Path, error: &dyn std::fmt::Display) -> String {
    format!("{}: {error}", path.display())
}

/// Files of a kind in a folder, in order.
fn files(folder: &Path, kind: &str) -> Result<Vec<PathBuf>, String> {
    let entries = fs::read_dir(folder).map_err(|e| failed(folder, &e))?;
    let paths = entries.filter_map(|entry| Some(entry.ok()?.path()));
    let mut paths: Vec<PathBuf> = paths
        .filter(|path| path.extension().is_some_and(|k| k == kind))
        .collect();
    paths.sort();
    Ok(paths)
}

fn stem(path: &Path) -> String {
    path.file_stem()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned()
}

/// All pictures; scenes of pages are written to files below `target`.
fn pictures() -> Result<Vec<Picture>, String> {
    let root = folders::root();
    let place = root.join("target/gallery");
    fs::create_dir_all(&place).map_err(|e| failed(&place, &e))?;
    let mut pictures = Vec::new();
    for page in files(&root.join("docs/course"), "md")? {
        let text = fs::read_to_string(&page).map_err(|e| failed(&page, &e))?;
        let blocks = text
            .split("```xml\n")
            .skip(1)
            .filter_map(|block| block.split("```").next());
        let Some(scene) = blocks.into_iter().find(|block| block.starts_with("<scene")) else {
            continue;
        };
        let name = format!("course-{}", stem(&page));
        let path = place.join(format!("{name}.xml"));
        fs::write(&path, scene).map_err(|e| failed(&path, &e))?;
        pictures.push(Picture {
            name,
            scene: path,
            spp: Some(SAMPLES),
            exposure: 0.0,
            denoised: false,
        });
    }
    fs::create_dir_all(place.join("plugins")).map_err(|e| failed(&place, &e))?;
    for shown in Stages::read()?.scenes()? {
        let path = place.join(format!("{}.xml", shown.name));
        fs::write(&path, &shown.scene).map_err(|e| failed(&path, &e))?;
        pictures.push(Picture {
            name: shown.name,
            scene: path,
            spp: Some(shown.samples),
            exposure: shown.exposure,
            denoised: false,
        });
    }
    for scene in files(&root.join("scenes/gallery"), "xml")? {
        pictures.push(Picture {
            name: stem(&scene),
            scene,
            spp: None,
            exposure: 0.0,
            denoised: true,
        });
    }
    Ok(pictures)
}

fn load(picture: &Picture) -> Result<Loaded, String> {
    let options = LoadOptions {
        data: vec![folders::scenes()],
        ..LoadOptions::default()
    };
    pipeline::load(&picture.scene, &options).map_err(|refusal| {
        let first = refusal.diagnostics.first();
        let reason = first.map_or_else(String::new, |d| d.one_line(&refusal.sources));
        format!("{}: {reason}", picture.name)
    })
}

/// A picture, rendered.
fn image(picture: &Picture, loaded: &Loaded) -> Result<Image, String> {
    let options = RenderOptions {
        spp: picture.spp,
        independent_replicates: picture.denoised,
        ..RenderOptions::default()
    };
    let plan = pipeline::plan(loaded, &options);
    let controls = RenderControls {
        features: picture.denoised,
        ..RenderControls::default()
    };
    let rendered = pipeline::render_as(loaded, &plan, controls, &());
    let rendered = rendered.map_err(|e| failed(&picture.scene, &e.message))?;
    if !picture.denoised {
        return Ok(rendered.developed.image);
    }
    let denoised = denoise(&rendered.developed, None).map_err(|e| failed(&picture.scene, &e))?;
    Ok(denoised.image)
}

/// Renders what changed.
///
/// # Errors
/// If a scene cannot be rendered or a file not be written.
pub(crate) fn run(arguments: &Arguments) -> Result<(), String> {
    let folder = folder();
    fs::create_dir_all(folder.join("plugins")).map_err(|e| failed(&folder, &e))?;
    let mut known = rendered();
    let all = pictures()?;
    known.retain(|name, _| all.iter().any(|picture| picture.name == *name));
    for picture in &all {
        let path = folder.join(format!("{}.jpg", picture.name));
        let wanted = arguments
            .only
            .as_ref()
            .is_none_or(|only| picture.name.contains(only));
        let loaded = load(picture)?;
        if !wanted || path.exists() && known.get(&picture.name) == Some(&loaded.hash) {
            continue;
        }
        let begin = Instant::now();
        let image = image(picture, &loaded)?;
        jpeg::write(&path, &image, picture.exposure, QUALITY).map_err(|e| e.to_string())?;
        println!("{}: {:.0} s", path.display(), begin.elapsed().as_secs_f64());
        known.insert(picture.name.clone(), loaded.hash.clone());
        let lines: String = known
            .iter()
            .map(|(name, hash)| format!("{name} {hash}\n"))
            .collect();
        let list = folder.join("rendered.txt");
        fs::write(&list, lines).map_err(|e| failed(&list, &e))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every scene has its picture, every picture is of the scene as it is, and all together are small.
    #[test]
    fn pictures_are_of_the_scenes() {
        let known = rendered();
        let mut bytes = 0;
        let all = pictures().expect("pages and scenes are there");
        assert!(all.len() > 10);
        for picture in &all {
            let hash = load(picture).expect("it is sound").hash;
            assert_eq!(
                known.get(&picture.name),
                Some(&hash),
                "{}: cargo xtask gallery",
                picture.name
            );
            let path = folder().join(format!("{}.jpg", picture.name));
            bytes += fs::metadata(&path).expect("it is there").len();
        }
        assert_eq!(known.len(), all.len());
        let files = |folder: &Path| files(folder, "jpg").expect("the folder is there").len();
        let files = files(&folder()) + files(&folder().join("plugins"));
        assert_eq!(files, all.len(), "a picture is of no scene");
        assert!(bytes <= 8 << 20, "{bytes} bytes");
    }
}
