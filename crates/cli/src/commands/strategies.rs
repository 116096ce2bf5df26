//! `etalon render --strategies`: the techniques of `bdpt`, one picture each.
//!
//! The technique (s, t) makes s vertices of a path from the light and t from the camera. Weighted,
//! the pictures add up to that of all techniques together, for they are made of the same samples;
//! unweighted, those of equal s + t show the same light, as far as each can find it. A page shows
//! them in Veach's pyramid: path lengths from above, s from left to right.

use crate::args::RenderArgs;
use etalon_film::RenderedImage;
use etalon_integrators::AnyIntegrator;
use etalon_integrators::bdpt::{Bidirectional, Technique};
use etalon_params::Diagnostic;
use etalon_render::pipeline::Loaded;
use etalon_render::report::{self, album::Album, exposed};
use etalon_render::write_guard::WriteGuard;
use maud::html;
use std::path::Path;

/// The longest paths whose techniques are written, in segments: more would be hundreds of files.
const LONGEST: u32 = 16;

/// The integrator whose techniques are asked for.
///
/// # Errors
/// If it is not `bdpt`, or its paths are too long.
pub fn integrator(loaded: &Loaded) -> Result<Bidirectional, String> {
    let AnyIntegrator::Bidirectional(integrator) = &loaded.integrator else {
        return Err(format!(
            "`--strategies` shows the techniques of `bdpt`, not of `{}`: add `--integrator bdpt`",
            loaded.integrator_name
        ));
    };
    let depth = integrator.settings.max_depth;
    if depth > LONGEST {
        return Err(format!(
            "`--strategies` needs a `max_depth` of at most {LONGEST} in the scene, for each length of \
             paths has as many techniques as vertices"
        ));
    }
    if integrator.only.is_some() {
        return Err("`--strategies` needs all techniques, and the scene asks for one".to_owned());
    }
    Ok(integrator.clone())
}

/// A technique with its picture, weighted and not.
struct Shown {
    light: usize,
    camera: usize,
    pictures: [RenderedImage; 2],
}

/// Renders every technique with `render` and writes the pictures and the page, as far as that gives
/// pictures before it is interrupted.
///
/// # Errors
/// If a file cannot be written; a diagnostic if rendering is refused.
pub fn write(
    folder: &Path,
    args: &RenderArgs,
    guard: &mut WriteGuard,
    loaded: &mut Loaded,
    integrator: &Bidirectional,
    mut render: impl FnMut(&Loaded) -> Result<Option<RenderedImage>, Diagnostic>,
) -> Result<Result<(), Diagnostic>, String> {
    let error = |e: &dyn std::fmt::Display| format!("cannot write {}: {e}", folder.display());
    std::fs::create_dir_all(folder).map_err(|e| error(&e))?;
    let mut shown = Vec::new();
    'all: for vertices in 2..=integrator.settings.max_depth as usize + 1 {
        for light in 0..vertices {
            let camera = vertices - light;
            if (light, camera) == (1, 1) {
                continue;
            }
            let mut pictures = Vec::new();
            for weighted in [true, false] {
                loaded.integrator = AnyIntegrator::Bidirectional(Bidirectional {
                    only: Some(Technique {
                        light,
                        camera,
                        weighted,
                    }),
                    ..integrator.clone()
                });
                let picture = match render(loaded) {
                    Ok(Some(picture)) => picture,
                    Ok(None) => break 'all,
                    Err(diagnostic) => return Ok(Err(diagnostic)),
                };
                let suffix = if weighted { "" } else { "-unweighted" };
                let file = guard.claim(&folder.join(format!("s{light}-t{camera}{suffix}.exr")))?;
                file.write_with(|path| picture.write_exr(path))?;
                pictures.push(picture);
            }
            if let Ok(pictures) = <[RenderedImage; 2]>::try_from(pictures) {
                shown.push(Shown {
                    light,
                    camera,
                    pictures,
                });
            }
        }
    }
    loaded.integrator = AnyIntegrator::Bidirectional(integrator.clone());
    let file = guard.claim(&folder.join("strategies.html"))?;
    file.write_text(&page(args, &shown))?;
    Ok(Ok(()))
}

/// The pyramids: weighted, and not.
fn page(args: &RenderArgs, shown: &[Shown]) -> String {
    let longest = shown.iter().map(|s| s.light + s.camera).max().unwrap_or(0);
    let mut album = Album::new();
    let body = html! {
        p { "Scene " code { (args.scene.display()) } ". A technique (s, t) makes s vertices of a path from the light \
            and t from the camera. Weighted pictures add up to the whole; unweighted ones of a row show the same \
            light, as far as the technique can find it." }
        (exposed::slider())
        @for (index, what) in ["Weighted", "Unweighted"].iter().enumerate() {
            h2 { (what) }
            @for vertices in 2..=longest {
                h3 { (segments(vertices - 1)) }
                div style="display:flex;flex-wrap:wrap;gap:.5rem" {
                    @for technique in shown.iter().filter(|s| s.light + s.camera == vertices) {
                        (exposed::figure(&mut album, &technique.pictures[index].image,
                            &format!("s = {}, t = {}", technique.light, technique.camera)))
                    }
                }
            }
        }
        (album.markup())
    };
    report::page("Techniques of bidirectional path tracing", &body)
}

fn segments(count: usize) -> String {
    match count {
        1 => "1 segment".to_owned(),
        _ => format!("{count} segments"),
    }
}
