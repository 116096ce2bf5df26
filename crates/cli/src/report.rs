//! Self-contained HTML: pictures as data URIs, no scripts, nothing fetched.

use crate::judge::{Judgement, TileRow};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use etalon_film::Developed;
use etalon_images::{Image, png};
use etalon_statistics::Verdict;
use maud::{DOCTYPE, Markup, PreEscaped, html};

/// The look of all reports.
pub const STYLE: &str = "\
:root{color-scheme:light dark;--text:#222;--quiet:#555;--line:#ddd;--rule:#999;--page:#fff;--good:#176d2c;--bad:#b3261e;--open:#8a5a00}\
@media(prefers-color-scheme:dark){:root{--text:#e4e4e4;--quiet:#aaa;--line:#3a3a3a;--rule:#777;--page:#161616;--good:#7bd68f;--bad:#ff9a90;--open:#f0c060}}\
body{font:15px/1.5 system-ui,sans-serif;max-width:70rem;margin:2rem auto;padding:0 1rem;color:var(--text);background:var(--page);overflow-wrap:break-word}\
table{border-collapse:collapse;margin:1rem 0;display:block;overflow-x:auto}td,th{padding:.25rem .7rem;border-bottom:1px solid var(--line);text-align:right;vertical-align:top}\
th{font-weight:600;border-bottom:2px solid var(--rule)}td:first-child,th:first-child{text-align:left;position:sticky;left:0;background:var(--page)}\
figure{display:inline-block;margin:.5rem .5rem .5rem 0;max-width:100%}img{image-rendering:pixelated;min-width:min(256px,calc(100vw - 3rem));max-width:min(30rem,calc(100vw - 3rem))}\
figcaption,small{color:var(--quiet);font-size:.9em}pre{overflow-x:auto}td,th{overflow-wrap:normal}small{white-space:nowrap}\
.agrees{color:var(--good)}.differs{color:var(--bad);font-weight:600}.undecided{color:var(--open)}";

/// A whole page.
pub fn page(title: &str, body: &Markup) -> String {
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (title) }
                style { (PreEscaped(STYLE)) }
            }
            body { h1 { (title) } (body) }
        }
    }
    .into_string()
}

/// An image as an HTML figure.
pub fn figure(image: &Image, exposure: f32, caption: &str) -> Markup {
    let picture = png::develop(image, exposure)
        .and_then(|(bytes, _)| encode(&opaque(&bytes, image), image.width(), image.height()));
    shown(picture, caption)
}

/// Drops alpha, if the picture has it.
fn opaque(bytes: &[u8], image: &Image) -> Vec<u8> {
    let pixels = image.width() * image.height();
    if bytes.len() == 4 * pixels {
        bytes
            .chunks_exact(4)
            .flat_map(|p| [p[0], p[1], p[2]])
            .collect()
    } else {
        bytes.to_vec()
    }
}

/// RGB bytes as an HTML figure.
pub fn bytes_figure(bytes: &[u8], width: usize, height: usize, caption: &str) -> Markup {
    shown(encode(bytes, width, height), caption)
}

fn encode(bytes: &[u8], width: usize, height: usize) -> Option<String> {
    let png = png::encode_rgb(bytes, width, height).ok()?;
    Some(format!("data:image/png;base64,{}", STANDARD.encode(png)))
}

fn shown(source: Option<String>, caption: &str) -> Markup {
    html! {
        figure {
            @if let Some(source) = source { img src=(source) alt=(caption); }
            figcaption { (caption) }
        }
    }
}

/// A verdict in its colour.
pub fn verdict(verdict: Verdict) -> Markup {
    let text = verdict.to_string();
    html! { span class=(text) { (text) } }
}

/// The report of `etalon compare`.
pub fn comparison(
    judgement: &Judgement,
    first: &Developed,
    second: &Developed,
    names: &[String; 2],
) -> String {
    let body = html! {
        p { "Verdict: " (verdict(judgement.verdict)) ". A bias matters beyond "
            (percent(judgement.rules.image_bound)) " of an image's mean, or "
            (percent(judgement.rules.tile_bound)) " of a tile's; α = " (judgement.rules.alpha)
            " over all questions." }
        (pictures(first, second, names))
        (tables(judgement))
    };
    page("Comparison of two images", &body)
}

/// The report of `etalon compare` on images that hold the same numbers.
pub fn identical([first, second]: [String; 2]) -> String {
    let body = html! {
        p { "Verdict: " (verdict(Verdict::Agrees)) ". " (first) " and " (second)
            " hold the same numbers in every channel." }
    };
    page("Comparison of two images", &body)
}

/// The report of `etalon compare` on images that cannot be judged, for this reason.
pub fn inconclusive(
    reason: &str,
    first: &Developed,
    second: &Developed,
    names: &[String; 2],
) -> String {
    let body = html! {
        p { "Verdict: " (verdict(Verdict::Undecided)) ", inconclusive: " (reason) "." }
        (pictures(first, second, names))
    };
    page("Comparison of two images", &body)
}

/// Both images and their difference.
pub fn pictures(first: &Developed, second: &Developed, names: &[String; 2]) -> Markup {
    html! {
        div {
            (figure(&first.image, 0.0, &names[0]))
            (figure(&second.image, 0.0, &names[1]))
            @if let Some(map) = difference(first, second) { (map) }
        }
    }
}

/// The statistics of a comparison.
pub fn tables(judgement: &Judgement) -> Markup {
    html! {
        table {
            tr { th { "channel" } th { "mean" } th { "other" } th { "bias" } th { "interval" }
                 th { "could see" } th { "verdict" } }
            @for row in &judgement.images {
                tr {
                    td { (row.channel) }
                    td { (format!("{:.5}", row.mean)) }
                    td { (format!("{:.5}", row.other_mean)) }
                    td { (signed(row.bias)) }
                    td { (signed(row.interval[0])) " … " (signed(row.interval[1])) }
                    td { (percent(row.smallest_detectable)) }
                    td { (verdict(row.verdict)) }
                }
            }
        }
        table {
            tr { th { "tiles" } th { "count" } th { "worst" } th { "at" } th { "p, corrected" }
                 th { "off" } th { "verdict" } }
            @for row in &judgement.tiles {
                tr {
                    td { (row.channel) ", " (row.side) "²" }
                    td { (row.tiles) }
                    td { (signed(row.worst_bias)) }
                    td { (row.worst[0]) ", " (row.worst[1]) }
                    td { (format!("{:.1e}", row.p_exact)) }
                    td { (row.differing) }
                    td { (verdict(row.verdict)) }
                }
            }
        }
        @for row in judgement.tiles.iter().filter(|row| row.side == 16) { (p_map(row)) }
    }
}

/// p-values of tiles as a picture: dark where equality is hard to believe.
fn p_map(row: &TileRow) -> Markup {
    let width = row.columns as usize;
    let bytes: Vec<u8> = row
        .p_map
        .iter()
        .flat_map(|p| {
            let shade = (255.0 * p.sqrt()) as u8;
            [255, shade, shade]
        })
        .collect();
    let caption = format!(
        "p-values of the tiles of 16², {} (for the eye)",
        row.channel
    );
    bytes_figure(&bytes, width, row.p_map.len() / width, &caption)
}

/// Relative difference per pixel of the luminance-like mean: blue less, red more.
fn difference(first: &Developed, second: &Developed) -> Option<Markup> {
    let a = first.image.colour()?;
    let b = second.image.colour()?;
    let (width, height) = (second.image.width(), second.image.height());
    if (first.image.width(), first.image.height()) != (width, height) {
        return None;
    }
    let bytes: Vec<u8> = (0..width * height)
        .flat_map(|i| {
            let sum = |c: [&[f32]; 3]| c[0][i] + c[1][i] + c[2][i];
            let (x, y) = (sum(a), sum(b));
            let relative = (x - y) / (y.abs() + 0.03);
            let strength = (relative.abs() * 10.0).min(1.0);
            let fade = (255.0 * (1.0 - strength)) as u8;
            if relative > 0.0 {
                [255, fade, fade]
            } else {
                [fade, fade, 255]
            }
        })
        .collect();
    Some(bytes_figure(
        &bytes,
        width,
        height,
        "relative difference (full colour: 10 %)",
    ))
}

fn percent(x: f64) -> String {
    format!("{:.3} %", 100.0 * x)
}

fn signed(x: f64) -> String {
    format!("{:+.3} %", 100.0 * x)
}
