//! Whether the memory holds a film: better refused than ended by the system.

use crate::loaded::Loaded;
use crate::resources;
use etalon_params::Diagnostic;

/// What a pixel takes in one channel while it is rendered, developed and written (bytes): the
/// film's sums, the mean and its standard error, and both again on their way to the file.
const PIXEL_BYTES: u64 = 64 + 8 + 8;

/// What the sums of splats take besides.
const SPLAT_BYTES: u64 = 16;

/// What the planes of exact sums take besides, in the file of a part or a checkpoint.
const PART_BYTES: u64 = 48;

/// What the film of a scene takes while it is rendered and written (bytes).
pub fn film_bytes(loaded: &Loaded) -> u64 {
    let film = &loaded.compiled.film;
    let alpha = usize::from(film.pixel_format.has_alpha());
    let planes = film.colours().len() + alpha + loaded.integrator.channels().len();
    needed(loaded, planes, false)
}

/// What a film of so many channels takes (bytes); `exact` if its exact sums are to be written.
fn needed(loaded: &Loaded, channels: usize, exact: bool) -> u64 {
    let splats = match loaded.integrator.splats() {
        true => SPLAT_BYTES,
        false => 0,
    };
    let part = if exact { PART_BYTES } else { 0 };
    let bytes = PIXEL_BYTES + splats + part;
    let [width, height] = loaded.compiled.film.crop_size.to_array().map(u64::from);
    (width * height).saturating_mul(channels as u64 * bytes)
}

/// Refuses a film that the memory cannot hold; `exact` if its exact sums are to be written.
pub(crate) fn check(loaded: &Loaded, channels: usize, exact: bool) -> Result<(), Diagnostic> {
    let [width, height] = loaded.compiled.film.crop_size.to_array();
    let needed = needed(loaded, channels, exact);
    match resources::available_memory_bytes() {
        Some(available) if needed > available => {
            let gib = |bytes: u64| bytes as f64 / f64::from(1 << 30);
            let message = format!(
                "a film of {width} × {height} pixels with {channels} channels takes {:.1} GiB of \
                 memory, and {:.1} GiB are free",
                gib(needed),
                gib(available)
            );
            Err(Diagnostic::error(loaded.film_place, message)
                .help("render a smaller film, or crop it (`crop_width`, `crop_offset_x`, …)"))
        }
        _ => Ok(()),
    }
}
