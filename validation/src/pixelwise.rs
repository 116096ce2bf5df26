//! Renders a claim's scene without noise and holds it pixel by pixel against POV-Ray's picture of its twin.

use crate::batch_cache::BatchCache;
use crate::batches;
use crate::claim::{Budget, Claim, Estimator};
use crate::edges;
use crate::fault::PlantedFault;
use crate::folders;
use crate::povray;
use crate::rendering;
use etalon_film::RenderedImage;
use etalon_images::Image;
use etalon_render::decide::measure::Measure;
use etalon_render::decide::pixelwise::{CHANNELS, PixelwiseLimits, measure};

/// Two pictures and what came of comparing them.
pub struct Compared {
    /// What was counted.
    pub measures: Vec<Measure>,
    /// Our picture.
    pub picture: RenderedImage,
    /// POV-Ray's.
    pub oracle: RenderedImage,
    /// Samples per pixel, all replicates together.
    pub spp: u64,
}

/// Renders a claim's scene, perhaps with a fault, and compares it with its reference.
///
/// # Errors
/// If the picture cannot be rendered or the reference cannot be used.
pub(crate) fn compare_pixelwise(
    claim: &Claim,
    limits: PixelwiseLimits,
    estimator: &Estimator,
    fault: Option<PlantedFault>,
    budget: Budget,
    (seed, alpha): (u64, f64),
    kept: &BatchCache<'_>,
) -> Result<Compared, String> {
    let twins = povray::twins(claim)?;
    let oracle = povray::read_in(&folders::references(), &claim.name, &twins)?;
    let loaded = rendering::load_for(claim, estimator)?;
    let plan = rendering::plan(&loaded, estimator, budget, seed);
    let physical = fault.filter(|fault| fault.is_physical());
    let render = || rendering::picture(&loaded, &plan, estimator, physical, None);
    let mut picture = match physical {
        Some(_) => render()?,
        None => {
            let print = batches::fingerprint(estimator);
            let name = format!("{print:08x}-{}", plan.replicates);
            kept.shared(&claim.name, &name, render)?
        }
    };
    if let Some(fault) = fault.filter(|fault| !fault.is_physical()) {
        spoil(&mut picture.image, fault)?;
    }
    let film = &loaded.compiled.film;
    if film.crop_size != film.size {
        return Err("a film is compared as a whole with POV-Ray's picture".to_owned());
    }
    let edges = edges::edges(&loaded.compiled.scene, film.size);
    let measures = measure(&picture, &oracle, &edges, limits, alpha)?;
    Ok(Compared {
        measures,
        spp: u64::from(plan.samples_per_replicate) * u64::from(plan.replicates),
        picture,
        oracle,
    })
}

/// Plants a fault into a finished picture.
fn spoil(image: &mut Image, fault: PlantedFault) -> Result<(), String> {
    let width = image.width();
    for channel in CHANNELS {
        let Some(plane) = image.channel_mut(channel) else {
            continue;
        };
        match fault {
            PlantedFault::ShiftedPixel => {
                for row in plane.chunks_mut(width) {
                    row.copy_within(..width - 1, 1);
                }
            }
            PlantedFault::Mirrored => plane.chunks_mut(width).for_each(<[f32]>::reverse),
            PlantedFault::SlightEnergy => plane.iter_mut().for_each(|value| *value *= 1.01),
            other => return Err(format!("`{other}` cannot be planted here")),
        }
    }
    Ok(())
}
