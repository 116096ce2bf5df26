//! Plots as inline SVG, in the colours of the page: curves over two logarithmic axes, and bars.
//!
//! Colour is never the only mark: curves have shapes of their own, and bars stand beside names. Series `i`
//! has the class `s0` … `s5`.

use crate::estimators::findings::Uncertain;
use crate::estimators::table::number;
use etalon_math::float64;
use maud::{Markup, PreEscaped, html};

/// The number of colours.
const COLOURS: usize = 6;

/// A curve.
#[derive(Clone, Debug, Default)]
pub struct Curve {
    /// Its name in the legend.
    pub name: String,
    /// x, y and the standard error of y.
    pub points: Vec<[f64; 3]>,
    /// Ends of a straight line (on logarithmic axes) through them.
    pub fit: Option<[[f64; 2]; 2]>,
}

/// The size of a plot, and where its axes begin and end.
const SIZE: [f64; 2] = [640.0, 400.0];
const LEFT: f64 = 70.0;
const RIGHT: f64 = 625.0;
const TOP: f64 = 12.0;
const BOTTOM: f64 = 350.0;

/// One logarithmic axis.
pub(super) struct Axis {
    /// Logarithms to base 10 of the ends.
    ends: [f64; 2],
    /// Where they are in the picture.
    places: [f64; 2],
}

impl Axis {
    pub(super) fn new(values: impl Iterator<Item = f64>, places: [f64; 2]) -> Option<Self> {
        let logs: Vec<f64> = values.filter(|v| *v > 0.0).map(log10).collect();
        let low = logs.iter().copied().fold(f64::INFINITY, f64::min);
        let high = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        (low <= high).then_some(Self {
            ends: [low - 0.08, high + 0.08],
            places,
        })
    }

    pub(super) fn place(&self, value: f64) -> f64 {
        let [low, high] = self.ends;
        let share = (log10(value) - low) / (high - low);
        self.places[0] + share * (self.places[1] - self.places[0])
    }

    /// Round numbers within the axis: powers of ten, or 1, 2 and 5 times them if those are few.
    pub(super) fn ticks(&self) -> Vec<f64> {
        let [low, high] = self.ends;
        let within = |factors: &[f64]| -> Vec<f64> {
            let decades = (low.floor() as i32)..=(high.ceil() as i32);
            let all = decades.flat_map(|decade| {
                factors
                    .iter()
                    .map(move |f| f * float64::pow(10.0, decade.into()))
            });
            all.filter(|v| (low..=high).contains(&log10(*v))).collect()
        };
        let decades = within(&[1.0]);
        match decades.len() {
            0..=2 => within(&[1.0, 2.0, 5.0]),
            3..=7 => decades,
            many => decades.into_iter().step_by(many.div_ceil(7)).collect(),
        }
    }
}

/// Curves over logarithmic axes; nothing where there is nothing positive to draw.
pub fn curves(curves: &[Curve], x: &str, y: &str) -> Markup {
    let points = || curves.iter().flat_map(|curve| &curve.points);
    let across = Axis::new(points().map(|p| p[0]), [LEFT, RIGHT]);
    let up = Axis::new(points().map(|p| p[1]), [BOTTOM, TOP]);
    let (Some(across), Some(up)) = (across, up) else {
        return html! { p { "There is nothing positive to draw." } };
    };
    let (middle, centre) = (0.5 * (LEFT + RIGHT), 0.5 * (TOP + BOTTOM));
    html! {
        div class="plot" { svg class="plot" role="img" viewBox=(format!("0 0 {} {}", SIZE[0], SIZE[1]))
            aria-label=(format!("{y} against {x}")) {
            @for tick in across.ticks() {
                @let at = across.place(tick);
                line class="grid" x1=(round(at)) x2=(round(at)) y1=(TOP) y2=(BOTTOM) {}
                text x=(round(at)) y=(BOTTOM + 18.0) text-anchor="middle" { (label(tick)) }
            }
            @for tick in up.ticks() {
                @let at = up.place(tick);
                line class="grid" x1=(LEFT) x2=(RIGHT) y1=(round(at)) y2=(round(at)) {}
                text x=(LEFT - 6.0) y=(round(at + 4.0)) text-anchor="end" { (label(tick)) }
            }
            text x=(middle) y=(SIZE[1] - 8.0) text-anchor="middle" { (x) }
            text transform=(format!("translate(14 {centre}) rotate(-90)")) text-anchor="middle" { (y) }
            @for (index, curve) in curves.iter().enumerate() { (drawn(index, curve, &across, &up)) }
        } }
        (legend(curves))
    }
}

fn drawn(index: usize, curve: &Curve, across: &Axis, up: &Axis) -> Markup {
    let class = colour(index);
    let at = |x: f64, y: f64| [round(across.place(x)), round(up.place(y))];
    let shown = curve.points.iter().filter(|p| p[0] > 0.0 && p[1] > 0.0);
    let path: Vec<String> = (shown.clone())
        .map(|p| at(p[0], p[1]).map(|v| v.to_string()).join(","))
        .collect();
    html! {
        polyline class={ "curve " (class) } style="fill:none" points=(path.join(" ")) {}
        @if let Some([a, b]) = curve.fit {
            @let ([x1, y1], [x2, y2]) = (at(a[0], a[1]), at(b[0], b[1]));
            line class={ "fit " (class) } x1=(x1) y1=(y1) x2=(x2) y2=(y2) {}
        }
        @for [x, y, error] in shown {
            @let [left, top] = at(*x, *y);
            @if *error > 0.0 && y - error > 0.0 {
                @let ends = [y - error, y + error].map(|end| round(up.place(end)));
                line class=(class) x1=(left) x2=(left) y1=(ends[0]) y2=(ends[1]) {}
            }
            (mark(index, left, top))
        }
    }
}

/// A shape for every series.
fn mark(index: usize, x: f64, y: f64) -> Markup {
    let class = colour(index);
    let polygon = |corners: &[[f64; 2]]| {
        let corners: Vec<String> = (corners.iter())
            .map(|[dx, dy]| format!("{},{}", x + dx, y + dy))
            .collect();
        html! { polygon class=(class) points=(corners.join(" ")) {} }
    };
    match index % 4 {
        0 => html! { circle class=(class) cx=(x) cy=(y) r="4" {} },
        1 => polygon(&[[-4.0, -4.0], [4.0, -4.0], [4.0, 4.0], [-4.0, 4.0]]),
        2 => polygon(&[[0.0, -5.5], [5.0, 4.0], [-5.0, 4.0]]),
        _ => polygon(&[[0.0, -5.5], [5.5, 0.0], [0.0, 5.5], [-5.5, 0.0]]),
    }
}

fn legend(curves: &[Curve]) -> Markup {
    html! {
        p class="legend" {
            @for (index, curve) in curves.iter().enumerate() {
                span { svg width="14" height="14" aria-hidden="true" { (mark(index, 7.0, 7.0)) } " " (curve.name) }
                (PreEscaped(" "))
            }
        }
    }
}

/// Bars from zero with whiskers for their intervals; an arrow for a bound from below.
pub fn bars(bars: &[(String, Uncertain)], what: &str) -> Markup {
    let ends = |(_, bar): &(String, Uncertain)| {
        let high = bar.interval.map(|[_, high]| high);
        [bar.value, high, bar.at_least]
            .into_iter()
            .flatten()
            .fold(0.0, f64::max)
    };
    let longest = bars.iter().map(ends).fold(0.0, f64::max);
    if !(longest > 0.0) {
        return html! { p { "There is nothing positive to draw." } };
    }
    const ROW: f64 = 46.0;
    let place = |value: f64| round(8.0 + 540.0 * (value / longest).clamp(0.0, 1.0));
    html! {
        div class="plot" { svg class="plot" role="img" aria-label=(what)
            viewBox=(format!("0 0 {} {}", SIZE[0], ROW * bars.len() as f64)) {
            @for (index, (name, bar)) in bars.iter().enumerate() {
                @let top = ROW * index as f64;
                @let middle = top + 30.0;
                @let end = place(bar.value.unwrap_or(0.0));
                text x="8" y=(top + 16.0) { (name) ": " (number(bar.value)) }
                rect class=(colour(index)) x="8" width=(end - 8.0) y=(top + 21.0) height="18" {}
                @if let Some([low, high]) = bar.interval {
                    line class="whisker" x1=(place(low)) x2=(place(high)) y1=(middle) y2=(middle) {}
                    @for at in [low, high].map(place) {
                        line class="whisker" x1=(at) x2=(at) y1=(middle - 6.0) y2=(middle + 6.0) {}
                    }
                } @else if let Some(bound) = bar.at_least {
                    @let at = place(bound);
                    line class="whisker" x1=(at) x2=(at) y1=(middle - 6.0) y2=(middle + 6.0) {}
                    line class="whisker" x1=(at) x2=(at + 40.0) y1=(middle) y2=(middle) {}
                    polyline class="whisker" points=(format!("{},{} {},{} {},{}",
                        at + 33.0, middle - 5.0, at + 40.0, middle, at + 33.0, middle + 5.0)) {}
                }
            }
        } }
    }
}

/// A round number in few characters.
pub(super) fn label(tick: f64) -> String {
    if (1e-3..1e5).contains(&tick) {
        // 0.05, not 0.05000000000000001.
        return ((tick * 1e6).round() / 1e6).to_string();
    }
    format!("{tick:.0e}")
}

fn log10(x: f64) -> f64 {
    float64::log2(x) / std::f64::consts::LOG2_10
}

fn colour(index: usize) -> String {
    format!("s{}", index % COLOURS)
}

fn round(x: f64) -> f64 {
    (10.0 * x).round() / 10.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_few() {
        let ticks = |low: f64, high: f64| -> Vec<String> {
            let axis = Axis::new([low, high].into_iter(), [0.0, 100.0]).expect("positive");
            axis.ticks().into_iter().map(label).collect()
        };
        assert_eq!(ticks(1.0, 16.0), ["1", "2", "5", "10"]);
        assert_eq!(ticks(0.013, 0.21), ["0.02", "0.05", "0.1", "0.2"]);
        assert_eq!(ticks(2e-4, 3.0), ["0.001", "0.01", "0.1", "1"]);
        assert_eq!(ticks(1e-9, 1e3).len(), 7);
        assert!(Axis::new([0.0, -1.0].into_iter(), [0.0, 1.0]).is_none());
    }

    #[test]
    fn what_cannot_be_drawn_is_left_out() {
        let curve = |points: &[[f64; 3]]| Curve {
            name: "a <name>".to_owned(),
            points: points.to_vec(),
            fit: None,
        };
        let drawn = |points: &[[f64; 3]]| curves(&[curve(points)], "x", "y").into_string();
        // An error that was corrected below zero has no logarithm.
        let html = drawn(&[[1.0, 0.1, 0.01], [2.0, -0.01, 0.01], [4.0, 0.03, 0.05]]);
        assert_eq!(
            html.matches("<circle").count(),
            2 + 1,
            "two points, one in the legend"
        );
        assert!(!html.contains("NaN") && !html.contains("inf"), "{html}");
        assert!(html.contains("a &lt;name&gt;"));
        assert!(drawn(&[[1.0, -0.1, 0.01]]).contains("nothing positive"));
        let nothing = bars(&[("a".to_owned(), Uncertain::default())], "what");
        assert!(nothing.into_string().contains("nothing positive"));
    }
}
