//! The truth and the mean of a program's pictures side by side, and their difference.

use crate::truth::Picture;
use etalon_images::{Image, png};
use etalon_render::report::album::FLOOR;
use etalon_render::report::encode;
use maud::{Markup, html};

/// The ends that the scale of differences may have.
const SCALES: [f64; 5] = [0.01, 0.03, 0.1, 0.3, 1.0];

/// From darker over equal to brighter than the truth: the ramp of the style of all reports.
const DIVERGING: [[f64; 3]; 7] = [
    [10.0, 47.0, 107.0],
    [47.0, 111.0, 181.0],
    [147.0, 191.0, 230.0],
    [245.0, 245.0, 245.0],
    [242.0, 181.0, 130.0],
    [207.0, 106.0, 28.0],
    [124.0, 47.0, 0.0],
];

/// Three pictures: the truth, the mean of so many pictures, and how they differ.
pub(super) fn pictures(truth: &Picture, mean: &Picture, count: usize, program: &str) -> Markup {
    if truth.pixels != mean.pixels || truth.means.len() != mean.means.len() {
        return html! {};
    }
    let white = (truth.means.iter().chain(&mean.means)).fold(0.0, |white: f64, x| white.max(*x));
    let differences = differences(truth, mean);
    let full = scale(&differences);
    let end = format!("{} %", 100.0 * full);
    let colours: Vec<u8> = differences.iter().flat_map(|x| colour(x / full)).collect();
    let counted = format!("Mean of {count} pictures");
    html! {
        div class="pictures" {
            (figure(grey(truth, white), truth.pixels, "Truth", html! { "truth" }))
            (figure(grey(mean, white), mean.pixels, &format!("{counted} of {program}"), html! { (counted) }))
            (figure(address(&colours, truth.pixels), truth.pixels, &format!("Difference of {program} from the truth"), html! {
                "relative difference"
                span class="scale" { "−" (end) span class="ramp" {} "+" (end) }
            }))
        }
        p class="quiet" { "Truth and mean have the same scale: white is " (super::number(white))
            ". Blue is darker than the truth, orange brighter, relative to the truth and " (100.0 * FLOOR) " % of its mean." }
    }
}

fn figure(address: Option<String>, pixels: u32, text: &str, caption: Markup) -> Markup {
    html! {
        figure class="picture" {
            @if let Some(address) = address { img src=(address) alt=(text) width=(pixels) height=(pixels); }
            figcaption { (caption) }
        }
    }
}

/// Relative differences; where the truth is nearly black, relative to a share of its mean.
fn differences(truth: &Picture, mean: &Picture) -> Vec<f64> {
    let floor = match FLOOR * truth.mean().abs() {
        floor if floor > 0.0 => floor,
        _ => 1.0,
    };
    let pairs = mean.means.iter().zip(&truth.means);
    pairs
        .map(|(found, known)| (found - known) / (known.abs() + floor))
        .collect()
}

/// The least of the scales that all but a twentieth of the differences stay within.
fn scale(differences: &[f64]) -> f64 {
    let mut sizes: Vec<f64> = differences.iter().map(|x| x.abs()).collect();
    sizes.sort_by(f64::total_cmp);
    let most = sizes.get(sizes.len() * 19 / 20).copied().unwrap_or(0.0);
    let fitting = SCALES.into_iter().find(|scale| *scale >= most);
    fitting.unwrap_or(1.0)
}

/// The colour of a share of the scale, from −1 to 1.
fn colour(share: f64) -> [u8; 3] {
    let at = 0.5 * (share.clamp(-1.0, 1.0) + 1.0) * (DIVERGING.len() - 1) as f64;
    let low = (at as usize).min(DIVERGING.len() - 2);
    let [from, to] = [DIVERGING[low], DIVERGING[low + 1]];
    let part = at - low as f64;
    [0, 1, 2].map(|c| (from[c] + part * (to[c] - from[c])).round() as u8)
}

fn grey(picture: &Picture, white: f64) -> Option<String> {
    let gain = if white > 0.0 { 1.0 / white } else { 1.0 };
    let values: Vec<f32> = (picture.means.iter())
        .map(|value| (value * gain) as f32)
        .collect();
    let side = picture.pixels as usize;
    let mut image = Image::new(side, side);
    for name in ["R", "G", "B"] {
        image = image.with(name, values.clone());
    }
    let (bytes, _) = png::develop(&image, 0.0)?;
    address(&bytes, picture.pixels)
}

fn address(bytes: &[u8], pixels: u32) -> Option<String> {
    encode(bytes, pixels as usize, pixels as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_is_white_and_ends_are_the_ramps() {
        assert_eq!(colour(0.0), [245; 3]);
        assert_eq!(colour(-7.0), [10, 47, 107]);
        assert_eq!(colour(1.0), [124, 47, 0]);
    }

    #[test]
    fn scales_hold_most_differences() {
        assert_eq!(scale(&[0.0; 256]), 0.01);
        assert_eq!(scale(&[-0.02; 256]), 0.03);
        assert_eq!(scale(&[2.0; 256]), 1.0);
        let black = Picture::even(16, 0.0);
        assert_eq!(differences(&black, &black), [0.0; 256]);
    }

    #[test]
    fn black_pictures_are_shown_and_unlike_sizes_are_not() {
        let black = Picture::even(16, 0.0);
        let html = pictures(&black, &black, 3, "p").into_string();
        assert_eq!(html.matches("data:image/png;base64,").count(), 3);
        let small = Picture::even(8, 0.0);
        assert!(pictures(&black, &small, 3, "p").into_string().is_empty());
    }
}
