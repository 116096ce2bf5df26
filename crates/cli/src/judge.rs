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

use etalon_film::{Developed, Metadata, TileMeans};
use etalon_statistics::{Estimate, Replicates, TileDifferences, Verdict};
use serde::Serialize;

/// How large a bias matters, and how sure the verdict must be.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Rules {
    /// Bias of an image's mean that matters, relative to the channel's mean.
    pub image_bound: f64,
    /// Bias of a tile that matters, relative to the tile's own mean; `image_bound` of the
    /// image's mean is added.
    pub tile_bound: f64,
    /// Probability of calling equal images different, over everything that is asked.
    pub alpha: f64,
}

impl Default for Rules {
    fn default() -> Self {
        Self {
            image_bound: 0.005,
            tile_bound: 0.03,
            alpha: 1e-3,
        }
    }
}

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
pub struct Judgement {
    /// The rules that were applied.
    pub rules: Rules,
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

impl Judgement {
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
pub fn judge(first: &Developed, second: &Developed, rules: Rules) -> Result<Judgement, String> {
    let a = metadata(first, "the first image")?;
    let b = metadata(second, "the second image")?;
    if a.film.crop_size != b.film.crop_size {
        return Err(format!(
            "the images differ in size: {} × {} and {} × {} pixels",
            a.film.crop_size[0], a.film.crop_size[1], b.film.crop_size[0], b.film.crop_size[1]
        ));
    }
    let channels: Vec<String> = colours(a)
        .into_iter()
        .filter(|name| b.channel_index(name).is_some())
        .collect();
    if channels.is_empty() {
        return Err("the images have no colour channel in common".to_owned());
    }
    let sides: Vec<u32> = a
        .tile_means
        .iter()
        .filter_map(TileMeans::side)
        .filter(|side| b.tiles(Some(*side)).is_some())
        .collect();
    let questions = channels.len() * (1 + sides.len());
    let alpha = rules.alpha / questions as f64;

    let luminance = luminance(b)?;
    let mut images = Vec::new();
    let mut tiles = Vec::new();
    for name in &channels {
        let whole = differences(a, b, name, None)?;
        let estimate = &whole.estimates()[0];
        let mean = mean_of(b, name)?;
        images.push(image_row(
            name,
            estimate,
            mean,
            scale(mean, luminance),
            rules,
            alpha,
        ));
        for &side in &sides {
            tiles.push(tile_row(a, b, name, side, mean.abs(), rules, alpha)?);
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
    Ok(Judgement {
        rules,
        images,
        tiles,
        verdict,
        p_exact: (smallest * questions as f64).min(1.0),
    })
}

/// A bias is relative to the channel's mean, but to no less than 5 % of the luminance's: a
/// channel that is nearly black does not decide.
fn scale(mean: f64, luminance: f64) -> f64 {
    let scale = mean.abs().max(0.05 * luminance.abs());
    if scale > 0.0 { scale } else { 1.0 }
}

fn image_row(
    name: &str,
    estimate: &Estimate,
    mean: f64,
    scale: f64,
    rules: Rules,
    alpha: f64,
) -> ImageRow {
    let interval = estimate.interval(1.0 - alpha);
    ImageRow {
        channel: name.to_owned(),
        mean: mean + estimate.value(),
        other_mean: mean,
        bias: estimate.value() / scale,
        interval: [interval.low / scale, interval.high / scale],
        smallest_detectable: estimate.smallest_detectable(alpha, 0.95) / scale,
        p_exact: estimate.p_differs(0.0),
        verdict: interval.verdict(rules.image_bound * scale),
    }
}

fn tile_row(
    a: &Metadata,
    b: &Metadata,
    name: &str,
    side: u32,
    image_mean: f64,
    rules: Rules,
    alpha: f64,
) -> Result<TileRow, String> {
    let differences = differences(a, b, name, Some(side))?;
    let (means, tiles) = replicates(b, name, Some(side))?;
    let known = Replicates::new(&means, tiles).map_err(|e| e.to_string())?;
    let mut own = Vec::with_capacity(tiles);
    for tile in 0..tiles {
        own.push(known.summary(tile).map_err(|e| e.to_string())?.mean().abs());
    }
    let tolerances: Vec<f64> = own
        .iter()
        .map(|mean| rules.tile_bound * mean + rules.image_bound * image_mean)
        .collect();
    let decision = differences.decide(&tolerances, alpha);
    let exact = differences.decide(&vec![0.0; tiles], alpha);
    let worst = exact.worst;
    let columns = a.tiles(Some(side)).map_or(1, TileMeans::columns);
    let estimates = differences.estimates();
    let whole_scale = scale(own[worst], image_mean);
    Ok(TileRow {
        channel: name.to_owned(),
        side,
        tiles,
        p_differs: decision.p_differs,
        p_exact: exact.p_differs,
        columns,
        worst: [worst as u32 % columns, worst as u32 / columns],
        worst_bias: estimates[worst].value() / whole_scale,
        differing: decision.differing(alpha).count(),
        p_map: estimates.iter().map(|e| e.p_differs(0.0) as f32).collect(),
        verdict: match decision.verdict {
            Verdict::Differs => Verdict::Differs,
            _ if decision.differing(alpha).count() == 0 => Verdict::Agrees,
            _ => Verdict::Undecided,
        },
    })
}

fn metadata<'a>(image: &'a Developed, which: &str) -> Result<&'a Metadata, String> {
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

/// The colour channels of an image, whatever its pixel format.
fn colours(metadata: &Metadata) -> Vec<String> {
    ["R", "G", "B", "X", "Y", "Z"]
        .into_iter()
        .filter(|name| metadata.channel_index(name).is_some())
        .map(str::to_owned)
        .collect()
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

fn differences(
    a: &Metadata,
    b: &Metadata,
    channel: &str,
    side: Option<u32>,
) -> Result<TileDifferences, String> {
    let (first, tiles) = replicates(a, channel, side)?;
    let (second, other_tiles) = replicates(b, channel, side)?;
    let first = Replicates::new(&first, tiles).map_err(|e| e.to_string())?;
    let second = Replicates::new(&second, other_tiles).map_err(|e| e.to_string())?;
    TileDifferences::between(&first, &second).map_err(|e| e.to_string())
}

fn mean_of(metadata: &Metadata, channel: &str) -> Result<f64, String> {
    let (values, _) = replicates(metadata, channel, None)?;
    Ok(values.iter().sum::<f64>() / values.len() as f64)
}

/// The mean luminance, or the mean of the green or only channel.
fn luminance(metadata: &Metadata) -> Result<f64, String> {
    let has = |name: &str| metadata.channel_index(name).is_some();
    if ["R", "G", "B"].into_iter().all(has) {
        let [r, g, b] = [
            mean_of(metadata, "R")?,
            mean_of(metadata, "G")?,
            mean_of(metadata, "B")?,
        ];
        return Ok(etalon_spectrum::colour_space::luminance([r, g, b]));
    }
    mean_of(metadata, "Y")
}
