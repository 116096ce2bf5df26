//! The bias of an image's mean, with its interval, as replicates are added: does it settle where it
//! ought to?
//!
//! After the first k replicates of ours, for growing k, the interval of Student's t (Welch's, against
//! all replicates of the other picture) at the level of the decision. The numbers of one curve are
//! nested and so depend on each other: it is for the eye, and only its last point is the decision's.

use super::plot::Axis;
use crate::judge::{self, ImageComparison};
use etalon_film::RenderedImage;
use etalon_statistics::{Estimate, Summary};
use maud::{Markup, html};

/// A bias and its interval after this many samples per pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Samples per pixel.
    pub samples: f64,
    /// The relative bias.
    pub bias: f64,
    /// Its interval.
    pub interval: [f64; 2],
}

/// A running bias.
#[derive(Clone, Debug, PartialEq)]
pub struct Running {
    /// The channel.
    pub channel: String,
    /// The bias that matters.
    pub bound: f64,
    /// After more and more replicates.
    pub points: Vec<Point>,
}

/// The running bias of the channel whose interval reaches farthest; `None` where there are fewer than
/// four replicates.
pub fn of(
    judgement: &ImageComparison,
    first: &RenderedImage,
    second: &RenderedImage,
) -> Option<Running> {
    let row = judgement.widest()?;
    let metadata = first.metadata.as_ref()?;
    let (own, _) = judge::replicates(metadata, &row.channel, None).ok()?;
    let other = second.metadata.as_ref().and_then(|metadata| {
        let (means, _) = judge::replicates(metadata, &row.channel, None).ok()?;
        Summary::of(&means)
    });
    let difference = row.mean - row.other_mean;
    let scale = match difference / row.bias {
        scale if scale > 0.0 && scale.is_finite() => scale,
        _ => row.other_mean.abs(),
    };
    if own.len() < 4 || !(scale > 0.0) {
        return None;
    }
    let questions = (judgement.images.len() + judgement.tiles.len()) as f64;
    let confidence = 1.0 - judgement.rules.alpha / questions;
    let each = metadata.spp as f64 / own.len() as f64;
    let point = |k: usize| {
        let summary = Summary::of(&own[..k])?;
        let estimate = match &other {
            Some(other) => Estimate::welch(&summary, other),
            None => Estimate::excess(&summary, row.other_mean),
        };
        let interval = estimate.interval(confidence);
        Some(Point {
            samples: each * k as f64,
            bias: estimate.value() / scale,
            interval: [interval.low / scale, interval.high / scale],
        })
    };
    Some(Running {
        channel: row.channel.clone(),
        bound: judgement.rules.image_bound,
        points: counts(own.len()).into_iter().filter_map(point).collect(),
    })
}

/// Numbers of replicates from three to all, about eight to an octave at the end.
fn counts(all: usize) -> Vec<usize> {
    let mut counts = vec![3];
    while let Some(last) = counts.last().copied().filter(|k| *k < all) {
        counts.push((last + 1).max(last * 9 / 8).min(all));
    }
    counts
}

/// Where the plot lies in its drawing.
const LEFT: f64 = 74.0;
const RIGHT: f64 = 625.0;
const TOP: f64 = 12.0;
const BOTTOM: f64 = 250.0;

impl Running {
    /// The curve over a logarithmic axis of samples, with the looks that were taken.
    pub fn drawn(&self, looks: &[Point]) -> Markup {
        let all = || self.points.iter().chain(looks);
        let Some(across) = Axis::new(all().map(|p| p.samples), [LEFT, RIGHT]) else {
            return html! {};
        };
        let reach = self.reach();
        let up = |y: f64| {
            let share = (y.clamp(-reach, reach) + reach) / (2.0 * reach);
            round(BOTTOM - share * (BOTTOM - TOP))
        };
        let at = |p: &Point, y: f64| format!("{},{}", round(across.place(p.samples)), up(y));
        let high = self.points.iter().map(|p| at(p, p.interval[1]));
        let low = self.points.iter().rev().map(|p| at(p, p.interval[0]));
        let band: Vec<String> = high.chain(low).collect();
        let line: Vec<String> = self.points.iter().map(|p| at(p, p.bias)).collect();
        html! {
            div class="plot" { svg class="plot running" role="img" viewBox="0 0 640 300"
                aria-label=(format!("Bias of {} and its interval against samples per pixel", self.channel)) {
                rect class="accepted" x=(LEFT) width=(RIGHT - LEFT) y=(up(self.bound))
                    height=(round(up(-self.bound) - up(self.bound))) {}
                @for tick in across.ticks() {
                    @let x = round(across.place(tick));
                    line class="grid" x1=(x) x2=(x) y1=(TOP) y2=(BOTTOM) {}
                    text x=(x) y=(BOTTOM + 18.0) text-anchor="middle" { (super::plot::label(tick)) }
                }
                line class="zero" x1=(LEFT) x2=(RIGHT) y1=(up(0.0)) y2=(up(0.0)) {}
                @for y in [-reach, -self.bound, 0.0, self.bound, reach] {
                    // Ends that would be written over the bounds are left out.
                    @if y.abs() != reach || reach > 1.25 * self.bound {
                        text x=(LEFT - 6.0) y=(up(y) + 4.0) text-anchor="end" { (tick_percent(y)) }
                    }
                }
                polygon class="band s0" points=(band.join(" ")) {}
                polyline class="curve s0" style="fill:none" points=(line.join(" ")) {}
                @for look in looks {
                    @let x = round(across.place(look.samples));
                    line class="whisker" x1=(x) x2=(x) y1=(up(look.interval[1])) y2=(up(look.interval[0])) {}
                    circle class="look" cx=(x) cy=(up(look.bias)) r="4" {}
                }
                text x=(0.5 * (LEFT + RIGHT)) y="292" text-anchor="middle" { "samples per pixel" }
                text transform=(format!("translate(13 {}) rotate(-90)", 0.5 * (TOP + BOTTOM)))
                    text-anchor="middle" { "bias of " (self.channel) }
            } }
            p class="quiet" { "Line and band: the bias as replicates are added, with its interval at the level of the decision. "
                @if !looks.is_empty() { "Dots and bars: the looks. " }
                "Shaded across: the bias that is accepted, ±" (super::percent(self.bound)) "." }
        }
    }

    /// How far the vertical axis reaches: twice the bound, or what the second half needs.
    fn reach(&self) -> f64 {
        let late = &self.points[self.points.len() / 3..];
        let far = late
            .iter()
            .map(|p| p.interval[0].abs().max(p.interval[1].abs()));
        far.filter(|x| x.is_finite())
            .fold(1.6 * self.bound, f64::max)
    }
}

fn tick_percent(x: f64) -> String {
    if x == 0.0 {
        return "0".to_owned();
    }
    format!("{:+} %", (1e5 * x).round() / 1e3)
}

fn round(x: f64) -> f64 {
    (10.0 * x).round() / 10.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_end_with_all_replicates() {
        assert_eq!(counts(3), [3]);
        assert_eq!(counts(6), [3, 4, 5, 6]);
        let many = counts(2048);
        assert_eq!(many.last(), Some(&2048));
        assert!(many.len() < 80 && many.windows(2).all(|pair| pair[0] < pair[1]));
    }

    #[test]
    fn what_reaches_beyond_the_axis_stays_inside_the_drawing() {
        let point = |samples: f64, reach: f64| Point {
            samples,
            bias: 0.0,
            interval: [-reach, reach],
        };
        let running = Running {
            channel: "G".to_owned(),
            bound: 0.005,
            points: vec![
                point(8.0, f64::INFINITY),
                point(16.0, 0.02),
                point(32.0, 0.004),
            ],
        };
        let html = running.drawn(&[point(32.0, 0.004)]).into_string();
        assert!(!html.contains("inf") && !html.contains("NaN"), "{html}");
        assert_eq!(html.matches("<circle").count(), 1);
    }
}
