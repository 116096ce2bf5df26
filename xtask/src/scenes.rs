//! `cargo xtask scenes`: regenerates files of `scenes/`: a sky, leaves, trees and their places, a
//! thousand lamps, bumps, water, smoke, a gem.
//!
//! Nothing here is random: irregular things follow [`sequence`], so that the files are the same on
//! every machine.

mod brilliant;
mod forest;
mod lamps;
mod leaf;
pub(crate) mod ply;
mod pool;
mod relief;
mod sequence;
mod sky;
mod smoke;

use etalon_validation::folders;
use std::fs;
use std::path::Path;

/// Writes the files, and says on standard output what it wrote.
pub(crate) fn run() -> Result<(), String> {
    let scenes = folders::scenes();
    let sky = scenes.join("spheres/sky.exr");
    sky::write(&sky)?;
    println!("{}", sky.display());
    for (name, bytes) in leaf::pictures()? {
        put(&scenes.join("foliage").join(name), &bytes)?;
    }
    for (name, bytes) in forest::files() {
        put(&scenes.join("forest").join(name), &bytes)?;
    }
    for (name, bytes) in relief::pictures()? {
        put(&scenes.join("relief").join(name), &bytes)?;
    }
    for (name, bytes) in smoke::files() {
        put(&scenes.join(name), &bytes)?;
    }
    put(&scenes.join("pool/water.obj"), pool::water().as_bytes())?;
    put(
        &scenes.join("gallery/parts/brilliant.obj"),
        brilliant::gem().as_bytes(),
    )?;
    put(
        &scenes.join("many-lights/lamps.xml"),
        lamps::fragment().as_bytes(),
    )
}

fn put(path: &Path, bytes: &[u8]) -> Result<(), String> {
    fs::write(path, bytes).map_err(|e| format!("{}: {e}", path.display()))?;
    println!("{}: {} bytes", path.display(), bytes.len());
    Ok(())
}
