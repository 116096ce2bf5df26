//! Options of `etalon render`, written as somebody would type them.

use crate::args::RenderArgs;
use crate::quoting;
use etalon_scene::SensorChoice;

/// The options that decide the picture, except scene, seed, frames and number of samples.
pub(super) fn of_the_picture(args: &RenderArgs) -> Vec<String> {
    let mut words = Vec::new();
    if let Some(integrator) = &args.integrator {
        words.push(format!("--integrator {}", quoting::shell(integrator)));
    }
    if let Some(chooser) = args.light_chooser {
        words.push(format!("--light-chooser {}", chooser.name()));
    }
    let framing = args.framing.framing().to_string();
    words.extend(Some(framing).filter(|words| !words.is_empty()));
    words.extend((args.framing.sensor.as_ref()).map(|sensor| match sensor {
        SensorChoice::Number(number) => format!("--sensor {number}"),
        SensorChoice::Id(id) => format!("--sensor {}", quoting::shell(id)),
    }));
    words
}

/// Values of scene parameters, folders with data, and the surroundings.
pub(super) fn of_the_scene(args: &RenderArgs) -> Vec<String> {
    let defines = args.define.iter();
    let defines =
        defines.map(|(key, value)| format!("-D {}", quoting::shell(&format!("{key}={value}"))));
    let data = args.data.iter();
    let data =
        data.map(|folder| format!("--data {}", quoting::shell(&folder.display().to_string())));
    let around = args.environment.iter();
    let around = around.map(|file| {
        format!(
            "--environment {}",
            quoting::shell(&file.display().to_string())
        )
    });
    defines.chain(data).chain(around).collect()
}

/// All but the scene, the output, frames, and what only one machine can have.
pub(super) fn of(args: &RenderArgs) -> Vec<String> {
    let mut words = of_the_picture(args);
    words.extend(of_the_scene(args));
    let numbers = [
        ("--spp", args.spp.map(|n| n.to_string())),
        ("--seed", args.seed.map(|n| n.to_string())),
        ("--replicates", args.replicates.map(|n| n.to_string())),
        ("--threads", args.threads.map(|n| n.to_string())),
        ("--error", args.error.map(|x| x.to_string())),
        ("--time", args.time.map(|x| x.to_string())),
        ("--pilot", args.pilot.map(|n| n.to_string())),
        (
            "--accelerator",
            args.accelerator.map(|kind| kind.name().to_owned()),
        ),
    ];
    words.extend(
        numbers
            .into_iter()
            .filter_map(|(name, value)| Some(format!("{name} {}", value?))),
    );
    let flags = [
        ("--adaptive", args.adaptive),
        ("--independent-replicates", args.independent_replicates),
        ("--features", args.features),
    ];
    words.extend(
        flags
            .iter()
            .filter(|(_, given)| *given)
            .map(|(name, _)| (*name).to_owned()),
    );
    words
}
