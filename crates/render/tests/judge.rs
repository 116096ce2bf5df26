//! The judge on synthetic pictures, whose truth is known: error rates, not anecdotes.
//!
//! A picture has 40 × 24 pixels (tiles of 16² at the edges are smaller) and eight replicates with
//! independent, skewed noise in every pixel, as renders have.

use etalon_film::{ExactFilm, FilmSettings, Filter, RenderFacts, RenderedImage};
use etalon_images::Image;
use etalon_math::float64;
use etalon_render::judge::{ExactImage, ImageComparison, Tolerances, judge, judge_known};
use etalon_statistics::Verdict;

const SIZE: [u32; 2] = [40, 24];
const REPLICATES: u32 = 8;

/// Uniform numbers (Steele, Lea, Flood 2014, "Fast splittable pseudorandom number generators").
struct Noise(u64);

impl Noise {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 * f64::EPSILON / 2.0 + f64::EPSILON / 4.0
    }

    /// Mean 1, standard deviation `deviation`, skewed to the right.
    fn around_one(&mut self, deviation: f64) -> f64 {
        1.0 - deviation * (1.0 + float64::ln(self.uniform()))
    }
}

/// What a pixel ought to be.
fn truth(x: u32, y: u32, channel: usize) -> f64 {
    let ramp = f64::from(x + 2 * y) / f64::from(SIZE[0] + 2 * SIZE[1]);
    (0.2 + ramp) * [1.0, 0.7, 0.3][channel]
}

fn no_bias(_: u32, _: u32) -> f64 {
    1.0
}

/// An estimate of the truth times `bias`, with relative noise per pixel and replicate.
fn estimate(seed: u64, deviation: f64, bias: impl Fn(u32, u32) -> f64) -> RenderedImage {
    let mut noise = Noise(seed << 20);
    let settings = FilmSettings::new(SIZE[0], SIZE[1], Filter::default());
    let mut film = ExactFilm::new(settings, &[]).expect("a small film");
    for _ in 0..REPLICATES {
        let mut image = Image::new(SIZE[0] as usize, SIZE[1] as usize);
        for (channel, name) in ["R", "G", "B"].into_iter().enumerate() {
            let pixels = (0..SIZE[0] * SIZE[1]).map(|i| [i % SIZE[0], i / SIZE[0]]);
            let values = pixels.map(|[x, y]| {
                (truth(x, y, channel) * bias(x, y) * noise.around_one(deviation)) as f32
            });
            image.push(name, values.collect());
        }
        film.add_replicate(&image, 4).expect("it fits");
    }
    film.develop(RenderFacts::default())
}

fn judged(first: &RenderedImage, second: &RenderedImage, rules: Tolerances) -> ImageComparison {
    judge(first, second, rules).expect("comparable")
}

#[test]
fn equal_pictures_agree_once_the_noise_is_below_the_bound() {
    let quiet = [1, 2].map(|seed| estimate(seed, 0.02, no_bias));
    let verdict = judged(&quiet[0], &quiet[1], Tolerances::default());
    assert_eq!(verdict.verdict, Verdict::Agrees);
    assert_eq!((verdict.images.len(), verdict.tiles.len()), (3, 6));
    for row in &verdict.images {
        assert!(row.interval[0] <= row.bias && row.bias <= row.interval[1]);
        assert!(row.smallest_detectable > 0.0 && row.smallest_detectable < 0.005);
    }
    let loud = [1, 2].map(|seed| estimate(seed, 1.0, no_bias));
    let verdict = judged(&loud[0], &loud[1], Tolerances::default());
    assert_eq!(verdict.verdict, Verdict::Undecided);
    let widest = verdict.widest().expect("channels");
    assert!(widest.interval[1] - widest.interval[0] > 0.01);
}

#[test]
fn a_bias_beyond_the_bound_differs_and_is_measured() {
    let known = estimate(1, 0.02, no_bias);
    let biased = estimate(2, 0.02, |_, _| 1.02);
    let verdict = judged(&biased, &known, Tolerances::default());
    assert_eq!(verdict.verdict, Verdict::Differs);
    for row in &verdict.images {
        assert_eq!(row.verdict, Verdict::Differs);
        assert!(row.interval[0] < 0.02 && 0.02 < row.interval[1], "{row:?}");
        assert!((row.mean / row.other_mean - 1.0 - row.bias).abs() < 1e-9);
    }
    let swapped = judged(&known, &biased, Tolerances::default());
    assert!(swapped.images.iter().all(|row| row.bias < 0.0));
}

#[test]
fn a_bias_that_cancels_in_the_mean_is_found_in_its_tile() {
    let known = estimate(1, 0.05, no_bias);
    // The tile at column 1, row 0 is too bright by a tenth; what it gains, all others lose.
    let inside = |x: u32, y: u32| (16..32).contains(&x) && y < 16;
    let sum = |wanted: bool| -> f64 {
        let pixels = (0..SIZE[0] * SIZE[1]).map(|i| [i % SIZE[0], i / SIZE[0]]);
        let chosen = pixels.filter(|[x, y]| inside(*x, *y) == wanted);
        chosen.map(|[x, y]| truth(x, y, 0)).sum()
    };
    let loss = 1.0 - 0.1 * sum(true) / sum(false);
    let moved = estimate(2, 0.05, |x, y| if inside(x, y) { 1.1 } else { loss });
    let verdict = judged(&moved, &known, Tolerances::default());
    assert_eq!(verdict.verdict, Verdict::Differs);
    for row in &verdict.images {
        assert_eq!(row.verdict, Verdict::Agrees, "{row:?}");
    }
    for row in verdict.tiles.iter().filter(|row| row.side == 16) {
        assert_eq!((row.worst, row.differing), ([1, 0], 1));
        assert!((row.worst_bias - 0.1).abs() < 0.02, "{row:?}");
        assert_eq!((row.tiles, row.columns, row.p_map.len()), (6, 3, 6));
    }
}

/// α = 0.05 per comparison, over all its questions. Of 400 comparisons of equal pictures at most
/// 20 are expected to raise an alarm, more than 45 with a probability below 10⁻⁶ (binomial). The
/// mutant, a judge that forgets to correct for asking nine questions, raises more.
#[test]
fn equal_pictures_are_called_different_as_rarely_as_promised() {
    let (comparisons, allowed) = (400, 45);
    // Bounds of nothing: every alarm is a false one.
    let rules = Tolerances {
        image_bound: 1e-12,
        tile_bound: 1e-12,
        alpha: 0.05,
        ..Tolerances::default()
    };
    let (mut verdicts, mut exact, mut mutant) = (0, 0, 0);
    for seed in 0..comparisons {
        let first = estimate(2 * seed + 1000, 0.5, no_bias);
        let second = estimate(2 * seed + 1001, 0.5, no_bias);
        let found = judged(&first, &second, rules);
        verdicts += u32::from(found.verdict == Verdict::Differs);
        exact += u32::from(found.p_exact <= rules.alpha);
        let images = found.images.iter().map(|row| row.p_exact);
        let tiles = found.tiles.iter().map(|row| row.p_exact);
        mutant += u32::from(images.chain(tiles).any(|p| p <= rules.alpha));
    }
    assert!(verdicts <= allowed, "{verdicts} false alarms");
    assert!(exact <= allowed, "{exact} false alarms");
    assert!(mutant > allowed, "the mutant raises only {mutant}");
    // The promise is kept without being so cautious that it is worth nothing.
    assert!(exact >= 1, "no alarm at all");
}

/// α = 0.05. A channel whose bias is exactly the bound may be said to agree with a probability of
/// at most α: more than 30 of 200 have a probability below 10⁻⁶. The mutant, which looks at the
/// estimate without its interval, passes half of them.
#[test]
fn a_bias_at_the_bound_passes_as_rarely_as_promised() {
    let (comparisons, allowed) = (200, 30);
    let rules = Tolerances {
        image_bound: 0.02,
        tile_bound: 1.0,
        alpha: 0.05,
        ..Tolerances::default()
    };
    let (mut passed, mut mutant) = (0, 0);
    for seed in 0..comparisons {
        let biased = estimate(2 * seed + 5000, 0.3, |_, _| 1.0 + rules.image_bound);
        let known = estimate(2 * seed + 5001, 0.3, no_bias);
        let found = judged(&biased, &known, rules);
        let red = &found.images[0];
        passed += u32::from(red.verdict == Verdict::Agrees);
        mutant += u32::from(red.bias.abs() <= rules.image_bound);
    }
    assert!(passed <= allowed, "{passed} passed");
    assert!(mutant > allowed, "the mutant passes only {mutant}");
}

#[test]
fn a_known_picture_is_an_oracle_without_noise() {
    let channels = ["R", "G", "B"]
        .into_iter()
        .enumerate()
        .map(|(channel, name)| {
            let pixels = (0..SIZE[0] * SIZE[1]).map(|i| truth(i % SIZE[0], i / SIZE[0], channel));
            (name.to_owned(), pixels.collect())
        });
    let known = ExactImage {
        size: SIZE,
        channels: channels.collect(),
    };
    let verdict = |bias: f64| {
        let image = estimate(9, 0.02, |_, _| bias);
        let found = judge_known(&image, &known, Tolerances::default()).expect("comparable");
        (found.verdict, found.p_exact)
    };
    let (agrees, p) = verdict(1.0);
    assert_eq!(agrees, Verdict::Agrees);
    // The seed is fixed; by chance this would fail for one seed in a thousand.
    assert!(p > 1e-3, "{p}");
    let (differs, p) = verdict(0.98);
    assert_eq!(differs, Verdict::Differs);
    assert!(p < 1e-6, "{p}");
}

#[test]
fn what_cannot_be_judged_is_refused_with_a_reason() {
    let sound = estimate(1, 0.1, no_bias);
    let refused = |image: &RenderedImage| {
        let other = judge(&sound, image, Tolerances::default());
        other.expect_err("not comparable")
    };
    let foreign = RenderedImage {
        metadata: None,
        ..sound.clone()
    };
    assert!(refused(&foreign).contains("the second image was not written by Etalon"));
    let mut single = sound.clone();
    if let Some(metadata) = &mut single.metadata {
        metadata.replicates = 1;
    }
    assert!(refused(&single).contains("single replicate"));
    let mut other = sound.clone();
    if let Some(metadata) = &mut other.metadata {
        metadata.film.crop_size = [41, 24];
    }
    assert!(refused(&other).contains("40 × 24 and 41 × 24"));
    let mut grey = sound.clone();
    if let Some(metadata) = &mut grey.metadata {
        metadata.channels = ["Y", "U", "V"].map(str::to_owned).to_vec();
    }
    assert!(refused(&grey).contains("no colour channel in common"));
}
