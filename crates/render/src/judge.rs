//! Do two images agree? The decision behind `etalon compare` and `cargo xtask validate`.
//!
//! Images are compared by the means of their replicates, never pixel by pixel: per channel the
//! mean of the whole image, and the means of tiles of 16² and 64² pixels (Jung, Hanika,
//! Dachsbacher 2020, with tiles for pixels). Two questions are asked.
//!
//! - *Is the image's mean the same within ±δ?* Equivalence: the confidence interval of the bias
//!   lies inside ±δ (agrees), outside (differs), or neither (undecided, never a pass).
//! - *Is any tile off by more than its tolerance?* Welch's t with Holm's correction over tiles.
//!
//! The error level α is shared equally (Bonferroni) by all of these questions.

use crate::tolerance::Tolerance;
pub use crate::tolerance::Tolerances;
use etalon_film::{Metadata, RenderedImage, TileMeans};
use etalon_statistics::{Replicates, TileDifferences, TilesError, Verdict};
use serde::Serialize;

pub use crate::exact_image::ExactImage;

/// What was found about one channel's mean.
#[derive(Clone, Debug, Serialize)]
pub struct ImageRow {
    /// The channel.
    pub channel: String,
    /// Its mean in the first image.
    pub mean: f64,
    /// Its mean in the second.
    pub other_mean: f64,
    /// Relative bias of the first against the second.
    pub bias: f64,
    /// Its confidence interval.
    pub interval: [f64; 2],
    /// The smallest relative bias that this comparison would have found with 95 % power.
    pub smallest_detectable: f64,
    /// The p-value of "no bias at all".
    pub p_exact: f64,
    /// Whether the bias is within the bound.
    #[serde(serialize_with = "as_text")]
    pub verdict: Verdict,
}

/// What was found about one channel's tiles of one size.
#[derive(Clone, Debug, Serialize)]
pub struct TileRow {
    /// The channel.
    pub channel: String,
    /// Side of the tiles (pixels).
    pub side: u32,
    /// Number of tiles.
    pub tiles: usize,
    /// The p-value of "every tile is within its tolerance", corrected over the tiles.
    pub p_differs: f64,
    /// The p-value of "every tile is equal", corrected over the tiles.
    pub p_exact: f64,
    /// Tiles in a row.
    pub columns: u32,
    /// Column and row of the tile with the smallest p-value.
    pub worst: [u32; 2],
    /// Its relative bias.
    pub worst_bias: f64,
    /// Tiles that are shown to be off.
    pub differing: usize,
    /// The p-value of equality of each tile, not corrected, row after row: for the eye.
    pub p_map: Vec<f32>,
    /// *Differs* if any tile is shown to be off by more than its tolerance.
    #[serde(serialize_with = "as_text")]
    pub verdict: Verdict,
}

fn as_text<S: serde::Serializer>(verdict: &Verdict, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(verdict)
}

/// The whole comparison.
#[derive(Clone, Debug, Serialize)]
pub struct ImageComparison {
    /// The rules that were applied.
    pub rules: Tolerances,
    /// Means of the image.
    pub images: Vec<ImageRow>,
    /// Means of tiles.
    pub tiles: Vec<TileRow>,
    /// *Agrees* if every mean agrees and no tile differs.
    #[serde(serialize_with = "as_text")]
    pub verdict: Verdict,
    /// The p-value of "the images are estimates of the very same picture", corrected over
    /// everything (Bonferroni): for exact null hypotheses.
    pub p_exact: f64,
}

impl ImageComparison {
    /// The interval that shows most bias, and the smallest bias that could have been found.
    pub fn widest(&self) -> Option<&ImageRow> {
        let reach = |row: &&ImageRow| row.interval[0].abs().max(row.interval[1].abs());
        self.images
            .iter()
            .max_by(|a, b| reach(a).total_cmp(&reach(b)))
    }
}

/// Compares two images that both carry tile means of at least two replicates.
///
/// # Errors
/// One sentence, if they cannot be compared.
pub fn judge(
    first: &RenderedImage,
    second: &RenderedImage,
    rules: Tolerances,
) -> Result<ImageComparison, String> {
    let a = metadata(first, "the first image")?;
    let b = metadata(second, "the second image")?;
    same_size(a.film.crop_size, b.film.crop_size)?;
    let channels = shared_channels(a, |name| b.channel_index(name).is_some())?;
    let mut comparisons = Vec::new();
    for channel in &channels {
        for side in sides(a).filter(|side| b.tiles(*side).is_some()) {
            let (means, tiles) = replicates(b, channel, side)?;
            let second = Replicates::new(&means, tiles).map_err(|e| e.to_string())?;
            let oracle = (0..tiles).map(|tile| Ok(second.summary(tile)?.mean()));
            let oracle = oracle
                .collect::<Result<_, TilesError>>()
                .map_err(|e| e.to_string())?;
            comparisons.push(Comparison::new(a, channel, side, oracle, |first| {
                TileDifferences::between(first, &second)
            })?);
        }
    }
    decide(&comparisons, rules)
}

/// Compares an image that carries tile means of at least two replicates with a known picture.
///
/// # Errors
/// One sentence, if they cannot be compared.
pub fn judge_known(
    image: &RenderedImage,
    known: &ExactImage,
    rules: Tolerances,
) -> Result<ImageComparison, String> {
    let a = metadata(image, "the image")?;
    same_size(a.film.crop_size, known.size)?;
    let pixels = |name: &str| known.channels.iter().find(|(channel, _)| channel == name);
    let mut comparisons = Vec::new();
    for channel in shared_channels(a, |name| pixels(name).is_some())? {
        let Some((_, pixels)) = pixels(&channel) else {
            continue;
        };
        for side in sides(a) {
            let oracle = known.tile_means(pixels, side);
            let means = oracle.clone();
            comparisons.push(Comparison::new(a, &channel, side, oracle, |first| {
                TileDifferences::from_known(first, &means)
            })?);
        }
    }
    decide(&comparisons, rules)
}

/// One channel's tiles of one size, compared.
struct Comparison {
    channel: String,
    /// Side of the tiles; `None` for the whole image.
    side: Option<u32>,
    columns: u32,
    differences: TileDifferences,
    /// What the tiles ought to be.
    oracle: Vec<f64>,
}

impl Comparison {
    fn new(
        image: &Metadata,
        channel: &str,
        side: Option<u32>,
        oracle: Vec<f64>,
        compare: impl FnOnce(&Replicates<'_>) -> Result<TileDifferences, TilesError>,
    ) -> Result<Self, String> {
        let (means, tiles) = replicates(image, channel, side)?;
        let first = Replicates::new(&means, tiles).map_err(|e| e.to_string())?;
        Ok(Self {
            channel: channel.to_owned(),
            side,
            columns: image.tiles(side).map_or(1, TileMeans::columns),
            differences: compare(&first).map_err(|e| e.to_string())?,
            oracle,
        })
    }
}

fn same_size([a, b]: [u32; 2], [c, d]: [u32; 2]) -> Result<(), String> {
    if [a, b] == [c, d] {
        return Ok(());
    }
    Err(format!(
        "the images differ in size: {a} × {b} and {c} × {d} pixels"
    ))
}

fn shared_channels(a: &Metadata, other: impl Fn(&str) -> bool) -> Result<Vec<String>, String> {
    let mut channels = colours(a);
    channels.retain(|name| other(name));
    if channels.is_empty() {
        return Err("the images have no colour channel in common".to_owned());
    }
    Ok(channels)
}

/// The sizes of tiles an image has means of, the whole image first.
fn sides(a: &Metadata) -> impl Iterator<Item = Option<u32>> {
    let sides = a.tile_means.iter().filter_map(TileMeans::side).map(Some);
    std::iter::once(None).chain(sides)
}

/// Decides all comparisons together.
fn decide(comparisons: &[Comparison], rules: Tolerances) -> Result<ImageComparison, String> {
    let alpha = rules.alpha / comparisons.len() as f64;
    let means: Vec<(&str, f64)> = comparisons
        .iter()
        .filter(|c| c.side.is_none())
        .map(|c| (c.channel.as_str(), c.oracle[0]))
        .collect();
    if means.is_empty() {
        return Err("there are no means of the whole image to compare".to_owned());
    }
    let luminance = luminance(&means);
    let mut images = Vec::new();
    let mut tiles = Vec::new();
    for comparison in comparisons {
        let mean = means
            .iter()
            .find(|(name, _)| *name == comparison.channel)
            .map_or(0.0, |(_, mean)| *mean);
        let scale = scale(mean, luminance);
        match comparison.side {
            None => images.push(image_row(comparison, mean, scale, rules, alpha)),
            Some(side) => tiles.push(tile_row(comparison, side, scale, rules, alpha)),
        }
    }
    let images_agree = images
        .iter()
        .fold(Verdict::Agrees, |all, row| all.and(row.verdict));
    let verdict = match tiles.iter().any(|row| row.verdict == Verdict::Differs) {
        true => Verdict::Differs,
        false => images_agree,
    };
    let smallest = images
        .iter()
        .map(|row| row.p_exact)
        .chain(tiles.iter().map(|row| row.p_exact))
        .fold(1.0, f64::min);
    Ok(ImageComparison {
        rules,
        p_exact: (smallest * comparisons.len() as f64).min(1.0),
        images,
        tiles,
        verdict,
    })
}

/// A bias is relative to the channel's mean, but to no less than 5 % of the luminance's: a
/// channel that is nearly black does not decide.
fn scale(mean: f64, luminance: f64) -> f64 {
    let scale = mean.abs().max(0.05 * luminance.abs());
    if scale > 0.0 { scale } else { 1.0 }
}

fn image_row(
    comparison: &Comparison,
    mean: f64,
    scale: f64,
    rules: Tolerances,
    alpha: f64,
) -> ImageRow {
    let estimate = &comparison.differences.estimates()[0];
    let interval = estimate.interval(1.0 - alpha);
    ImageRow {
        channel: comparison.channel.clone(),
        mean: mean + estimate.value(),
        other_mean: mean,
        bias: estimate.value() / scale,
        interval: [interval.low / scale, interval.high / scale],
        smallest_detectable: estimate.smallest_detectable(alpha, 0.95) / scale,
        p_exact: estimate.p_differs(rules.rounding * scale),
        verdict: interval.verdict(rules.image_bound * scale),
    }
}

fn tile_row(
    comparison: &Comparison,
    side: u32,
    image_scale: f64,
    rules: Tolerances,
    alpha: f64,
) -> TileRow {
    let oracle = &comparison.oracle;
    let tolerances = |tolerance: Tolerance| -> Vec<f64> {
        oracle.iter().map(|mean| tolerance.at(*mean)).collect()
    };
    let differences = &comparison.differences;
    let bounded = tolerances(Tolerance::bounded(rules, image_scale));
    let decision = differences.decide(&bounded, alpha);
    let exact = tolerances(Tolerance::exact(rules, image_scale));
    let exact = differences.decide(&exact, alpha);
    let worst = exact.worst;
    let estimates = differences.estimates();
    TileRow {
        channel: comparison.channel.clone(),
        side,
        tiles: oracle.len(),
        p_differs: decision.p_differs,
        p_exact: exact.p_differs,
        columns: comparison.columns,
        worst: [
            worst as u32 % comparison.columns,
            worst as u32 / comparison.columns,
        ],
        worst_bias: estimates[worst].value() / scale(oracle[worst], image_scale),
        differing: decision.differing(alpha).count(),
        p_map: estimates.iter().map(|e| e.p_differs(0.0) as f32).collect(),
        verdict: match decision.verdict {
            Verdict::Differs => Verdict::Differs,
            _ if decision.differing(alpha).count() == 0 => Verdict::Agrees,
            _ => Verdict::Undecided,
        },
    }
}

fn metadata<'a>(image: &'a RenderedImage, which: &str) -> Result<&'a Metadata, String> {
    let metadata = image.metadata.as_ref().ok_or_else(|| {
        format!("{which} was not written by Etalon: it has no replicates to judge by")
    })?;
    if metadata.replicates < 2 {
        return Err(format!(
            "{which} has a single replicate and so no standard error: render it with --replicates"
        ));
    }
    Ok(metadata)
}

/// The colour channels of an image of any pixel format.
fn colours(metadata: &Metadata) -> Vec<String> {
    let names = metadata.colours().into_iter();
    names.map(str::to_owned).collect()
}

/// The tile means of one channel, one replicate after the other, and the number of tiles.
pub fn replicates(
    metadata: &Metadata,
    channel: &str,
    side: Option<u32>,
) -> Result<(Vec<f64>, usize), String> {
    let (Some(means), Some(index)) = (metadata.tiles(side), metadata.channel_index(channel)) else {
        return Err(format!("there are no tile means of channel `{channel}`"));
    };
    let values = (0..means.replicates())
        .flat_map(|replicate| means.plane(replicate, index).iter().map(|v| f64::from(*v)))
        .collect();
    Ok((values, (means.columns() * means.rows()) as usize))
}

/// The luminance of channels' means, the mean of the green or only channel, or that of all bands.
fn luminance(means: &[(&str, f64)]) -> f64 {
    let of = |wanted: &str| means.iter().find(|(name, _)| *name == wanted).map(|m| m.1);
    match (of("R"), of("G"), of("B")) {
        (Some(r), Some(g), Some(b)) => etalon_spectrum::colour_space::luminance([r, g, b]),
        _ => of("Y").or(of("G")).unwrap_or_else(|| {
            let sum: f64 = means.iter().map(|(_, mean)| mean).sum();
            sum / means.len().max(1) as f64
        }),
    }
}
