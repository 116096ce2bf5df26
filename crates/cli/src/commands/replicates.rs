//! `etalon replicates`.

use super::convert::{of_colour, read};
use super::{fail, note};
use crate::args::ReplicatesArgs;
use crate::say;
use etalon_film::{Metadata, RenderFacts};
use etalon_images::Image;
use etalon_render::seeds::Seeds;
use etalon_render::write_guard::WriteGuard;
use std::path::Path;
use std::process::ExitCode;

/// Puts pictures of different seeds together.
pub fn run(args: &ReplicatesArgs) -> ExitCode {
    match together(args) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => fail(message),
    }
}

fn together(args: &ReplicatesArgs) -> Result<(), String> {
    let output = WriteGuard::of(&args.pictures).claim_exr(&args.output)?;
    let [first, _, ..] = &args.pictures[..] else {
        return Err(
            "one picture has no standard error: give two or more, of different seeds".to_owned(),
        );
    };
    let mut seeds: Option<Seeds> = None;
    for path in &args.pictures {
        let picture = colour(path, path == first)?;
        let size = [picture.width(), picture.height()].map(|n| n as u32);
        let seeds = match &mut seeds {
            Some(seeds) => seeds,
            none => none.insert(Seeds::new(size)?),
        };
        let added = seeds.add(&picture, args.spp.into());
        added.map_err(|reason| format!("{}: {reason}", path.display()))?;
    }
    let seeds = seeds.ok_or("there is no picture")?;
    let count = seeds.count();
    let image = seeds.develop(RenderFacts {
        version: args.program.clone(),
        scene: first.display().to_string(),
        integrator: args.program.clone(),
        ..RenderFacts::default()
    });
    output.write_with(|path| image.write_exr(path))?;
    if !args.quiet {
        let error = image.mean_relative_standard_error().unwrap_or(f64::NAN);
        say::remark(&format!(
            "{}: {count} replicates, mean relative standard error {:.2} %\n",
            args.output.display(),
            100.0 * error
        ));
    }
    Ok(())
}

/// A picture's colour in linear Rec. 709; what there is to know of it is said if it is the first.
fn colour(path: &Path, first: bool) -> Result<Image, String> {
    let (image, mut notes, text) = read(path)?;
    let ours = Metadata::from_json(&text, [image.width(), image.height()]).ok();
    if ours.as_ref().is_some_and(|facts| facts.denoised.is_some()) {
        let path = path.display();
        return Err(format!(
            "{path} was denoised: its error is none of chance alone"
        ));
    }
    let colour = image
        .needed_colour(path)
        .map_err(|error| error.to_string())?;
    notes.extend(colour.notes.iter().filter(|_| ours.is_none()).cloned());
    if first {
        let path = path.display();
        notes
            .iter()
            .for_each(|text| note(format!("`{path}`: {text}")));
    }
    Ok(of_colour(&image, &colour))
}
