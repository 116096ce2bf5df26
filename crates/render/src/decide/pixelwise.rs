//! Pixel by pixel: a picture without noise against another program's of the same scene.
//!
//! Both see through pixels' centres, and both light by point lights alone, so the two must agree in
//! every pixel and channel within
//!
//! ```text
//! |ours − theirs| ≤ max(0.002, 2⁻¹⁰ · |theirs|)
//! ```
//!
//! (their half floats are within 2⁻¹¹), except for pixels next to an edge (the caller's mask), where
//! rounding may show either side. This exception is bounded twice: the share of
//! edge pixels, by the picture's design; and the share of pixels that differ at edges, by what
//! rounding can do: an edge is on the wrong side of a pixel's centre only if it passes within rounding
//! of it. The second bound finds what the first would let pass: in a picture shifted by a pixel,
//! every wrong pixel may be an edge pixel, but a quarter of those are wrong.
//!
//! Ours is without noise if wavelengths are drawn by the midpoint rule: the sampler `midpoints`
//! visits the same n points in another order in each replicate, and sums are exact. Its error, for
//! white light 0.07 % of the blue channel with 36 points, is part of the difference and is not
//! forgiven. Nothing presumes this, though: every pixel is judged by its interval, from its own
//! replicates' standard error at the comparison's level over all pixels and channels (Bonferroni).
//! A pixel whose interval reaches beyond the tolerance *may* differ, and one that may differ leaves
//! the claim undecided.

use super::measure::Measure;
use etalon_film::RenderedImage;
use etalon_statistics::Estimate;

/// The tolerance that does not shrink with the value.
pub const ABSOLUTE: f64 = 0.002;

/// The tolerance relative to the value.
pub const RELATIVE: f64 = 1.0 / 1024.0;

/// The channels that are compared.
pub const CHANNELS: [&str; 3] = ["R", "G", "B"];

/// What is accepted of edges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelwiseLimits {
    /// The greatest share of pixels next to an edge.
    pub edges: f64,
    /// The greatest share of pixels (of all) that are next to an edge and differ.
    pub excused: f64,
}

/// How many pixels do for certain, and how many may.
#[derive(Clone, Copy, Debug, Default)]
struct Count {
    certain: usize,
    likely: usize,
    possible: usize,
}

impl Count {
    fn add(&mut self, pixel: &Pixel) {
        self.certain += usize::from(pixel.least > 1.0);
        self.likely += usize::from(pixel.value > 1.0);
        self.possible += usize::from(pixel.most > 1.0);
    }

    /// As a share of `of`, or a number if that is one.
    fn measure(self, name: &str, of: f64, accepted: f64, p: f64) -> Measure {
        let share = |count: usize| count as f64 / of;
        let interval = [share(self.certain), share(self.possible)];
        Measure::bounded(name, share(self.likely), interval, [0.0, accepted], p)
    }
}

/// The greatest difference of a pixel's channels in units of the tolerance.
struct Pixel {
    value: f64,
    least: f64,
    most: f64,
    /// The p-value of "no channel differs by more than the tolerance", before Bonferroni's correction.
    p: f64,
}

/// What is counted of two pictures of the same size.
///
/// # Errors
/// If one of them lacks a colour, ours its standard errors, or they differ in size.
pub fn measure(
    picture: &RenderedImage,
    oracle: &RenderedImage,
    edges: &[bool],
    limits: PixelwiseLimits,
    alpha: f64,
) -> Result<Vec<Measure>, String> {
    let pixels = pixels(picture, oracle, alpha)?;
    if pixels.len() != edges.len() {
        return Err("the pictures differ in size".to_owned());
    }
    let all = pixels.len() as f64;
    let (mut off, mut at) = (Count::default(), Count::default());
    let (mut worst, mut p) = ([0.0_f64; 3], 1.0_f64);
    let mut edge_pixels = 0;
    for (pixel, edge) in pixels.iter().zip(edges) {
        if *edge {
            edge_pixels += 1;
            at.add(pixel);
            continue;
        }
        off.add(pixel);
        p = p.min(pixel.p);
        let found = [pixel.least, pixel.value, pixel.most];
        worst = std::array::from_fn(|i| worst[i].max(found[i]));
    }
    let p = (p * all * CHANNELS.len() as f64).min(1.0);
    let edge_share = Count {
        certain: edge_pixels,
        likely: edge_pixels,
        possible: edge_pixels,
    };
    let [least, value, most] = worst;
    // Shares without noise are certain: they are within their bound or not.
    let sure = |beyond: bool| if beyond { 0.0 } else { 1.0 };
    let too_many = edge_pixels as f64 > limits.edges * all;
    let too_wrong = at.certain as f64 > limits.excused * all;
    Ok(vec![
        off.measure("pixels that differ, edges aside", 1.0, 0.0, p),
        Measure::bounded(
            "greatest difference, edges aside, over the tolerance",
            value,
            [least, most],
            [0.0, 1.0],
            p,
        ),
        edge_share.measure("share of edge pixels", all, limits.edges, sure(too_many)),
        at.measure(
            "share of pixels that differ at edges",
            all,
            limits.excused,
            sure(too_wrong),
        ),
    ])
}

fn pixels(
    picture: &RenderedImage,
    oracle: &RenderedImage,
    alpha: f64,
) -> Result<Vec<Pixel>, String> {
    let missing = |what: &str| format!("the picture has no {what}");
    let metadata = (picture.metadata.as_ref()).ok_or_else(|| missing("standard errors"))?;
    let freedom = f64::from(metadata.replicates) - 1.0;
    let count = picture.image.width() * picture.image.height();
    let level = alpha / (count * CHANNELS.len()) as f64;
    let mut pixels: Vec<Pixel> = (0..count)
        .map(|_| Pixel {
            value: 0.0,
            least: 0.0,
            most: 0.0,
            p: 1.0,
        })
        .collect();
    for channel in CHANNELS {
        let means = (picture.image.channel(channel)).ok_or_else(|| missing(channel))?;
        let errors = picture.standard_error(channel);
        let errors = errors.ok_or_else(|| missing("standard errors"))?;
        let theirs = (oracle.image.channel(channel)).ok_or_else(|| missing(channel))?;
        if theirs.len() != means.len() {
            return Err("the pictures differ in size".to_owned());
        }
        for (((pixel, mean), error), theirs) in pixels.iter_mut().zip(means).zip(errors).zip(theirs)
        {
            let (mean, theirs) = (f64::from(*mean), f64::from(*theirs));
            let tolerance = ABSOLUTE.max(RELATIVE * theirs.abs());
            let difference = Estimate::new(mean - theirs, f64::from(*error), freedom)
                .ok_or("a pixel is not finite")?;
            let interval = difference.interval(1.0 - level);
            let reach = 0.5 * (interval.high - interval.low);
            let size = difference.value().abs();
            let least = (size - reach).max(0.0) / tolerance;
            pixel.value = pixel.value.max(size / tolerance);
            pixel.least = pixel.least.max(least);
            pixel.most = pixel.most.max((size + reach) / tolerance);
            pixel.p = pixel.p.min(difference.p_differs(tolerance));
        }
    }
    Ok(pixels)
}
