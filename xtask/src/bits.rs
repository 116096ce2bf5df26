//! `cargo xtask bits`: the same scene gives the same bits, for any number of threads and for the
//! `fast`, the `proof` and the `release` build.
//!
//! All binaries are built, each renders some scenes with 1, 2 and 16 threads, and the files are
//! compared byte for byte (`SOURCE_DATE_EPOCH` leaves the render time out of them).

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Scene, and what else to say on the command line: every kind of estimator, and scenes that use
/// as much of the house as possible.
const RENDERS: &[(&str, &[&str])] = &[
    ("scenes/cornell-box/scene.xml", &["--integrator", "path"]),
    (
        "scenes/cornell-box/scene.xml",
        &["--integrator", "path", "--adaptive"],
    ),
    ("scenes/cornell-box/scene.xml", &["--integrator", "ptracer"]),
    ("scenes/cornell-box/scene.xml", &["--integrator", "bdpt"]),
    ("scenes/cornell-box/scene.xml", &["--integrator", "direct"]),
    ("scenes/cornell-box/scene.xml", &["--integrator", "pssmlt"]),
    ("scenes/cornell-box/scene.xml", &["--integrator", "mmlt"]),
    ("scenes/cornell-box/scene.xml", &["--integrator", "guided"]),
    ("scenes/luminaire/scene.xml", &["--integrator", "guided"]),
    ("scenes/spheres/scene.xml", &[]),
    ("scenes/spheres/scene.xml", &["--integrator", "naive"]),
    (
        "scenes/camera-obscura/scene.xml",
        &["--integrator", "forward"],
    ),
    ("scenes/ambient-corner/scene.xml", &["--integrator", "ao"]),
    ("scenes/foliage/scene.xml", &[]),
    ("scenes/prism/scene.xml", &[]),
    ("scenes/povray/refraction/scene.xml", &[]),
    (
        "scenes/veach-mis/scene.xml",
        &["--integrator", "distribution"],
    ),
    (
        "scenes/caustic-sphere/scene.xml",
        &["--integrator", "photonmap"],
    ),
    ("scenes/caustic-ring/scene.xml", &["--integrator", "sppm"]),
    ("scenes/sds/scene.xml", &["--integrator", "vcm"]),
];

const THREADS: [&str; 3] = ["1", "2", "16"];

/// Profiles of `Cargo.toml`, which differ in how far the optimiser sees.
const PROFILES: [&str; 3] = ["fast", "proof", "release"];

/// Builds, renders and compares. `Err` names the first files that differ.
pub(crate) fn run() -> Result<(), String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .ok_or("xtask lies in no workspace")?;
    let out = root.join("target/bits");
    fs::create_dir_all(&out).map_err(|error| format!("{}: {error}", out.display()))?;
    let mut binaries = Vec::new();
    for profile in PROFILES {
        let mut build = Command::new("cargo");
        build.args([
            "build",
            "--quiet",
            "--package",
            "etalon",
            "--profile",
            profile,
        ]);
        succeed(build.current_dir(root))?;
        binaries.push((profile, root.join("target").join(profile).join("etalon")));
    }
    for (number, (scene, arguments)) in RENDERS.iter().enumerate() {
        let mut first: Option<(PathBuf, Vec<u8>)> = None;
        for (profile, binary) in &binaries {
            for threads in THREADS {
                let file = out.join(format!("{number}-{profile}-{threads}.exr"));
                let mut render = Command::new(binary);
                render
                    .args([
                        "render",
                        scene,
                        "--quiet",
                        "--spp",
                        "16",
                        "--threads",
                        threads,
                    ])
                    .args(["-D", "resx=48", "-D", "resy=32"])
                    .args(*arguments)
                    .arg("-o")
                    .arg(&file)
                    .env("SOURCE_DATE_EPOCH", "0");
                succeed(render.current_dir(root))?;
                let bytes =
                    fs::read(&file).map_err(|error| format!("{}: {error}", file.display()))?;
                match &first {
                    None => first = Some((file, bytes)),
                    Some((_, expected)) if *expected == bytes => {}
                    Some((other, _)) => {
                        return Err(format!("{} and {} differ", other.display(), file.display()));
                    }
                }
            }
        }
        println!(
            "{scene} {}: equal bits in {} renders",
            arguments.join(" "),
            PROFILES.len() * THREADS.len()
        );
    }
    Ok(())
}

/// Runs a command that must succeed.
pub(crate) fn succeed(command: &mut Command) -> Result<(), String> {
    let status = command
        .status()
        .map_err(|error| format!("cannot run {command:?}: {error}"))?;
    if status.success() {
        Ok(())
    } else {
        Err(format!("{command:?} failed"))
    }
}
