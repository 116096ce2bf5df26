//! Denoising by a filter that knows its error.
//!
//! A picture of independent replicates is two independent pictures, A and B, the means of either half. For any filter f of A
//! alone, B estimates the error without bias, pixel by pixel, as the noise of B is independent of f(A):
//!
//! ```text
//! E (f(A) − B)² = E (f(A) − t)² + Var B                    t: the truth
//! E (f(A) − f(B))² = 2 Var f(A)
//! ```
//!
//! so that the error of the picture that is shown, (f(A) + f(B)) / 2, is
//!
//! ```text
//! e = ½ [(f(A) − B)² + (f(B) − A)²] − ½ (Var A + Var B) − ¼ (f(A) − f(B))²
//! ```
//!
//! in expectation (cross-validation on dual buffers: Rousselle, Knaus, Zwicker 2012, "Adaptive Rendering with Non-Local Means
//! Filtering"). Several filters are tried (`regression.rs`), and where its smoothed error is least, each is taken; the picture
//! itself is one of them, and its error is the square of its standard error. The stated error of the result is the same e,
//! not a property of the filter.
//!
//! The filters are regressions of first order on albedo, normal and depth of the first surface, weighted by patches of colour that
//! are equal up to noise (Bitterli et al. 2016, "Nonlinearly Weighted First-order Regression for Denoising Monte Carlo
//! Renderings").
//!
//! A denoised picture is biased, has no replicates, and is marked: no verdict is made of it.

mod choice;
mod halves;
mod open_image_denoise;
mod regression;
mod smooth;

pub use open_image_denoise::OpenImageDenoise;

use crate::VERSION;
use etalon_film::{OutlierLog, RenderedImage, STANDARD_ERROR};
use etalon_images::Image;
use halves::Halves;

/// Denoises a picture that was rendered with features: by regressions, or by Intel's network in their place. Either's error is
/// estimated in the same way, and where it is larger than the noise was, the picture stays as it was.
///
/// # Errors
/// If the picture lacks what a filter needs, or the library fails.
pub fn denoise(
    picture: &RenderedImage,
    network: Option<&OpenImageDenoise>,
) -> Result<RenderedImage, String> {
    let halves = Halves::of(picture)?;
    let (filtered, method) = match network {
        None => (
            regression::filter(&halves),
            "first-order regression".to_owned(),
        ),
        Some(network) => (
            vec![network.filter(&halves)?],
            format!("Open Image Denoise {} by halves", network.version()),
        ),
    };
    let denoised = choice::least_error(&halves, &filtered);
    let method = format!("{method}, Etalon {VERSION}");
    Ok(marked(picture, &halves, &denoised, method))
}

/// A colour for each pixel, row after row.
type Plane = Vec<[f32; 3]>;

/// A denoised picture.
struct Denoised {
    colour: Plane,
    /// The estimated root mean square error of each colour.
    error: Plane,
}

/// The denoised colours with their errors, and all other channels but those that speak of replicates.
fn marked(
    picture: &RenderedImage,
    halves: &Halves,
    denoised: &Denoised,
    method: String,
) -> RenderedImage {
    let old = &picture.image;
    let mut image = Image::new(old.width(), old.height());
    let plane = |plane: &Plane, c: usize| plane.iter().map(|pixel| pixel[c]).collect();
    for (c, name) in halves.colours.iter().enumerate() {
        image.push(name.as_str(), plane(&denoised.colour, c));
    }
    if let Some(alpha) = old.channel("A") {
        image.push("A", alpha.to_vec());
    }
    for (c, name) in halves.colours.iter().enumerate() {
        let error = plane(&denoised.error, c);
        image.push(format!("{STANDARD_ERROR}{name}"), error);
    }
    let mut metadata = picture.metadata.clone();
    if let Some(metadata) = &mut metadata {
        metadata
            .channels
            .retain(|name| image.channel(name).is_some());
        metadata.tile_means.clear();
        metadata.features = None;
        metadata.unlit_pixels = 0;
        metadata.outliers = OutlierLog::default();
        metadata.denoised = Some(method);
    }
    RenderedImage {
        image,
        frame: picture.frame,
        metadata,
    }
}
