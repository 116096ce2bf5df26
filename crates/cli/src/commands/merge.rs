//! `etalon merge`.

use super::{BAD_INPUT, fail};
use crate::args::MergeArgs;
use crate::say;
use etalon_film::{Metadata, Part, RenderedImage, ReplicateSet, disagreements};
use etalon_render::write_guard::{Destination, WriteGuard};
use std::path::PathBuf;
use std::process::ExitCode;

/// Puts parts together.
pub fn run(args: &MergeArgs) -> ExitCode {
    let args = &match with_folders(args) {
        Ok(args) => args,
        Err(message) => return fail(message),
    };
    let output = match WriteGuard::of(&args.parts).claim_exr(&args.output) {
        Ok(output) => output,
        Err(message) => return fail(message),
    };
    // Metadata are checked before any pixels are read.
    let problems = problems(args);
    if !problems.is_empty() {
        for problem in problems {
            say::remark(&format!("error: {problem}\n"));
        }
        return ExitCode::from(BAD_INPUT);
    }
    match merge(args, &output) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => fail(message),
    }
}

/// Replaces each folder by its images in the order of their names, without the output if it is among them.
fn with_folders(args: &MergeArgs) -> Result<MergeArgs, String> {
    let mut parts = Vec::new();
    for path in &args.parts {
        if !path.is_dir() {
            parts.push(path.clone());
            continue;
        }
        let unreadable = |error| format!("cannot read {}: {error}", path.display());
        let mut images = Vec::new();
        for entry in std::fs::read_dir(path).map_err(unreadable)? {
            let file = entry.map_err(unreadable)?.path();
            let is_image = file.extension().is_some_and(|extension| extension == "exr");
            let hidden = file
                .file_name()
                .is_some_and(|name| name.to_string_lossy().starts_with('.'));
            if is_image && !hidden && file != args.output {
                images.push(file);
            }
        }
        if images.is_empty() {
            return Err(format!("{} holds no .exr", path.display()));
        }
        images.sort();
        parts.extend(images);
    }
    Ok(MergeArgs {
        parts,
        ..args.clone()
    })
}

/// Everything that keeps the parts from being merged, one sentence each.
fn problems(args: &MergeArgs) -> Vec<String> {
    let mut problems = Vec::new();
    let mut known: Vec<(&PathBuf, Metadata)> = Vec::new();
    for path in &args.parts {
        match Part::read_metadata(path) {
            Ok(metadata) => known.push((path, metadata)),
            Err(error) => problems.push(error.to_string()),
        }
    }
    let Some(((first, reference), others)) = known.split_first() else {
        return problems;
    };
    let mut sound = problems.is_empty();
    for (path, metadata) in others {
        for differing in disagreements(reference, metadata) {
            sound = false;
            problems.push(format!(
                "{} and {} are parts of different renders: the {} is {} in the first, {} in the \
                 second",
                first.display(),
                path.display(),
                differing.what,
                differing.first,
                differing.second
            ));
        }
    }
    if !sound {
        // Which replicates there are says nothing then.
        return problems;
    }
    let replicates = |metadata: &Metadata| {
        let part = metadata.part.as_ref();
        part.map(|part| part.replicates.clone()).unwrap_or_default()
    };
    let mut all = ReplicateSet::default();
    for (index, (path, metadata)) in known.iter().enumerate() {
        let here = replicates(metadata);
        if here.is_empty() {
            problems.push(format!(
                "{} has no finished replicate: go on with its render (`--resume`), or leave it out",
                path.display()
            ));
        }
        for (earlier, of_earlier) in &known[..index] {
            let common = here.intersection(&replicates(of_earlier));
            if !common.is_empty() {
                problems.push(format!(
                    "{} and {} both have the replicates {common}; give every part once",
                    earlier.display(),
                    path.display()
                ));
            }
        }
        all = all.union(&here);
    }
    let of = reference.part.as_ref().map_or(0, |part| part.of);
    let missing = all.missing(of);
    if !missing.is_empty() && !args.partial {
        problems.push(format!(
            "of the {of} replicates 0 to {}, these are missing: {missing}; render them, or merge \
             what there is with `--partial`",
            of.saturating_sub(1)
        ));
    }
    problems
}

/// Reads the parts, one after the other, and writes the image.
fn merge(args: &MergeArgs, output: &Destination) -> Result<(), String> {
    let mut merged: Option<(Part, &PathBuf)> = None;
    for path in &args.parts {
        let part = Part::read(path).map_err(|error| error.to_string())?;
        match &mut merged {
            None => merged = Some((part, path)),
            Some((whole, first)) => whole.absorb(&part).map_err(|conflict| {
                let (first, path) = (first.display(), path.display());
                format!("{first} and {path} cannot be merged: {conflict}")
            })?,
        }
    }
    let (part, _) = merged.ok_or("there is nothing to merge")?;
    let picture = match part.whole() {
        Some(picture) => {
            output.write_with(|path| picture.write_exr(path))?;
            picture
        }
        None => {
            output.write_with(|path| part.write_exr(path))?;
            part.picture()
        }
    };
    report(args, &part, &picture);
    Ok(())
}

fn report(args: &MergeArgs, part: &Part, picture: &RenderedImage) {
    let faults = picture.metadata.as_ref().map_or(0, |m| m.faults.total());
    if faults > 0 {
        say::remark(&format!(
            "warning: {faults} contributions were not finite; see `etalon info`\n"
        ));
    }
    if args.quiet {
        return;
    }
    let missing = part.missing();
    let incomplete = if missing.is_empty() {
        String::new()
    } else {
        format!(", a part itself (missing: {missing})")
    };
    let error = match picture.mean_relative_standard_error() {
        Some(error) => format!("mean relative standard error {:.2} %", 100.0 * error),
        None => "no standard error (one replicate)".to_owned(),
    };
    let (files, replicates) = (args.parts.len(), part.replicates().count());
    say::remark(&format!(
        "{}: {replicates} replicates from {files} files{incomplete}, {error}\n",
        args.output.display()
    ));
}
