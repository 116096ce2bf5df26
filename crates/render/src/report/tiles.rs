//! The p-values of a picture's tiles: where they are, and how they are distributed.
//!
//! Of equal pictures every p-value is uniform on (0, 1), so the bars of the histogram stand about
//! one line; the band about it holds 95 % of independent counts (normal approximation). Tiles are
//! independent of each other only where a filter does not reach across their edges: all this is for
//! the eye, and the decision is made elsewhere.

use super::{encode, probability};
use crate::judge::{ImageComparison, TileRow};
use maud::{Markup, html};

/// Bars of a histogram, at most.
const BARS: usize = 10;

/// The most tiles whose numbers are written into the map.
const WRITTEN: usize = 64;

/// Maps and histograms of the tiles of 16² pixels, for each channel.
pub fn maps(judgement: &ImageComparison) -> Markup {
    let rows = judgement.tiles.iter().filter(|row| row.side == 16);
    html! {
        div class="tiles" { @for row in rows { (map(row)) } }
        p class="legend-of-p" aria-hidden="true" { "p: 1" i {} "10⁻⁵" }
        p class="quiet" { "Map: dark where equality is hard to believe; the outlined tile has the least p. "
            "Histogram: equal pictures give bars about the dashed line, 95 % of them within the band." }
    }
}

fn map(row: &TileRow) -> Markup {
    let columns = row.columns.max(1) as usize;
    let lines = row.p_map.len().div_ceil(columns);
    let smallest = row.p_map.iter().copied().fold(1.0_f32, f32::min);
    html! {
        figure {
            figcaption { strong { (row.channel) } ": " (row.p_map.len()) " tiles of 16² pixels, least p "
                (least(smallest)) " at (" (row.worst[0]) ", " (row.worst[1]) ")" }
            div class="pair-of" {
                (p_map(row, columns, lines))
                (histogram(&row.p_map))
            }
        }
    }
}

/// Dark where equality is hard to believe: −log₁₀ p from 0 to 5.
fn p_map(row: &TileRow, columns: usize, lines: usize) -> Markup {
    let mut bytes: Vec<u8> = row
        .p_map
        .iter()
        .flat_map(|p| shade(f64::from(*p)))
        .collect();
    bytes.resize(3 * columns * lines, 255);
    let source = encode(&bytes, columns, lines);
    let label = format!("Map of the p-values of the tiles of {}", row.channel);
    let unit = 40.0;
    let (width, height) = (unit * columns as f64, unit * lines as f64);
    html! {
        svg class="p-map" role="img" aria-label=(label) viewBox=(format!("0 0 {width} {height}")) {
            @if let Some(source) = source {
                image href=(source) width=(width) height=(height) preserveAspectRatio="none" {}
            }
            @if row.p_map.len() <= WRITTEN {
                @for (index, p) in row.p_map.iter().enumerate() {
                    @let (x, y) = (index % columns, index / columns);
                    text x=(unit * (x as f64 + 0.5)) y=(unit * (y as f64 + 0.5) + 3.5)
                        class=[(strength(f64::from(*p)) > 0.45).then_some("on-dark")] { (short(*p)) }
                }
            }
            rect class="worst" x=(unit * f64::from(row.worst[0]) + 1.0) y=(unit * f64::from(row.worst[1]) + 1.0)
                width=(unit - 2.0) height=(unit - 2.0) {}
        }
    }
}

/// The smallest p-value; a single-precision number ends at 10⁻⁴⁵.
fn least(p: f32) -> String {
    match p > 0.0 {
        true => format!("= {}", probability(f64::from(p))),
        false => "< 1e-45".to_owned(),
    }
}

fn short(p: f32) -> String {
    if p >= 0.01 {
        format!("{p:.2}").trim_start_matches('0').to_owned()
    } else if p > 0.0 {
        format!("{p:.0e}")
    } else {
        "0".to_owned()
    }
}

/// 0 for p = 1, 1 for 10⁻⁵ and less.
fn strength(p: f64) -> f64 {
    if p <= 1e-5 {
        return 1.0;
    }
    -etalon_math::float64::log2(p) / std::f64::consts::LOG2_10 / 5.0
}

/// From nearly white to dark violet; its lightness falls all the way.
fn shade(p: f64) -> [u8; 3] {
    const STOPS: [[f64; 3]; 4] = [
        [247.0, 247.0, 250.0],
        [188.0, 189.0, 220.0],
        [117.0, 107.0, 177.0],
        [55.0, 10.0, 105.0],
    ];
    let at = strength(p).clamp(0.0, 1.0) * (STOPS.len() - 1) as f64;
    let index = (at as usize).min(STOPS.len() - 2);
    let share = at - index as f64;
    let mix = |c: usize| STOPS[index][c] + share * (STOPS[index + 1][c] - STOPS[index][c]);
    [0, 1, 2].map(|c| mix(c) as u8)
}

/// How many p-values lie in each tenth (fifth, if they are few), against the uniform line.
fn histogram(p: &[f32]) -> Markup {
    let bars = if p.len() < 30 { BARS / 2 } else { BARS };
    let mut counts = vec![0_usize; bars];
    for p in p {
        counts[((p * bars as f32) as usize).min(bars - 1)] += 1;
    }
    let expected = p.len() as f64 / bars as f64;
    let spread = 1.96 * (expected * (1.0 - 1.0 / bars as f64)).sqrt();
    let most = counts.iter().copied().max().unwrap_or(0) as f64;
    let top = most.max(expected + spread).max(1.0) * 1.08;
    let (left, right, bottom, height) = (26.0, 254.0, 118.0, 108.0);
    let place = |count: f64| round(bottom - height * (count / top).clamp(0.0, 1.0));
    let width = (right - left) / bars as f64;
    html! {
        svg class="histogram" role="img" viewBox="0 0 260 150"
            aria-label=(format!("Histogram of the p-values: {} in {bars} equal bins, {expected:.1} expected in each",
                p.len())) {
            rect class="band" x=(left) width=(right - left) y=(place(expected + spread))
                height=(round(place((expected - spread).max(0.0)) - place(expected + spread))) {}
            @for (index, count) in counts.iter().enumerate() {
                rect class="bar" x=(round(left + width * index as f64 + 1.0)) width=(round(width - 2.0))
                    y=(place(*count as f64)) height=(round(bottom - place(*count as f64))) {}
            }
            line class="expected" x1=(left) x2=(right) y1=(place(expected)) y2=(place(expected)) {}
            line class="axis" x1=(left) x2=(right) y1=(bottom) y2=(bottom) {}
            @for (x, name) in [(left, "0"), (0.5 * (left + right), "0.5"), (right, "1")] {
                text x=(x) y=(bottom + 14.0) text-anchor="middle" { (name) }
            }
            text x=(0.5 * (left + right)) y=(bottom + 28.0) text-anchor="middle" { "p of a tile" }
            text x=(left - 4.0) y=(place(0.0)) text-anchor="end" { "0" }
            @if most > 0.0 {
                text x=(left - 4.0) y=(place(most) + 4.0) text-anchor="end" { (most) }
            }
        }
    }
}

fn round(x: f64) -> f64 {
    (10.0 * x).round() / 10.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bars_count_every_tile() {
        let p: Vec<f32> = (0..100).map(|i| (i as f32 + 0.5) / 100.0).collect();
        let html = histogram(&p).into_string();
        assert_eq!(html.matches("class=\"bar\"").count(), BARS);
        // Ten in each: all bars end at the line of the expected count.
        let line = html.split("class=\"expected\"").nth(1).expect("a line");
        let y = line.split("y1=\"").nth(1).expect("y").split('"').next();
        let tops = format!("y=\"{}\"", y.expect("a number"));
        assert_eq!(html.matches(&tops).count(), BARS);
        assert!(!histogram(&[0.0, 1.0]).into_string().contains("NaN"));
    }

    #[test]
    fn shades_darken() {
        let light = |p: f64| shade(p).map(i32::from).iter().sum::<i32>();
        let steps = [1.0, 0.5, 0.1, 1e-2, 1e-3, 1e-4, 1e-5];
        assert!(steps.windows(2).all(|pair| light(pair[0]) > light(pair[1])));
        assert_eq!(shade(0.0), shade(1e-5));
    }
}
