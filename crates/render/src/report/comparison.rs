//! The report of `etalon compare`.

use super::album::Album;
use super::{page, percent, running, tables, tiles, verdict, viewer};
use crate::judge::ImageComparison;
use etalon_film::RenderedImage;
use etalon_statistics::Verdict;
use maud::{Markup, html};

const TITLE: &str = "Comparison of two images";

/// Of images that were judged.
pub fn judged(
    judgement: &ImageComparison,
    first: &RenderedImage,
    second: &RenderedImage,
    names: &[String; 2],
) -> String {
    let mut album = Album::new();
    let body = html! {
        p class="lead" { "Verdict: " (verdict(judgement.verdict)) ". A bias matters beyond "
            (percent(judgement.rules.image_bound)) " of an image's mean, or "
            (percent(judgement.rules.tile_bound)) " of a tile's; α = " (judgement.rules.alpha)
            " over all questions." }
        (viewer::viewer(&mut album, first, second, names))
        h2 { "Statistics" }
        (tables::tables(judgement))
        h2 { "Tiles" }
        (tiles::maps(judgement))
        (bias(judgement, first, second))
        (album.markup())
    };
    page(TITLE, &body)
}

/// The bias as replicates are added, if there are enough.
fn bias(judgement: &ImageComparison, first: &RenderedImage, second: &RenderedImage) -> Markup {
    let curve = running::of(judgement, first, second);
    html! {
        @if let Some(curve) = curve {
            h2 { "Convergence" }
            (curve.drawn(&[]))
        }
    }
}

/// Of images that hold the same numbers.
pub fn identical([first, second]: [String; 2]) -> String {
    let body = html! {
        p class="lead" { "Verdict: " (verdict(Verdict::Agrees)) ". " (first) " and " (second)
            " hold the same numbers in every channel." }
    };
    page(TITLE, &body)
}

/// Of images that cannot be judged, for this reason.
pub fn inconclusive(
    reason: &str,
    first: &RenderedImage,
    second: &RenderedImage,
    names: &[String; 2],
) -> String {
    let mut album = Album::new();
    let body = html! {
        p class="lead" { "Verdict: " (verdict(Verdict::Undecided)) ", inconclusive: " (reason) "." }
        (viewer::viewer(&mut album, first, second, names))
        (album.markup())
    };
    page(TITLE, &body)
}
