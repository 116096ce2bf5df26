//! The means of single pictures as dots over the bound, by pose, with the intervals of their mean.

use crate::judge::Finding;
use etalon_render::report::signed;
use maud::{Markup, html};

/// Where the axis begins and ends, and how high a lane is.
const LEFT: f64 = 78.0;
const RIGHT: f64 = 410.0;
const TOP: f64 = 6.0;
const LANE: f64 = 28.0;
const INTERVAL: f64 = 18.0;

/// More poses than these share one lane, one above the other.
const LANES: usize = 4;

/// The drawing; nothing if there are no pictures.
pub(super) fn dots(finding: &Finding, bound: f64, program: &str) -> Markup {
    let biases = (finding.replicates.iter()).map(|(pose, ratio)| (*pose, ratio - 1.0));
    let biases: Vec<(u32, f64)> = biases.filter(|(_, bias)| bias.is_finite()).collect();
    if biases.is_empty() || !(bound > 0.0) {
        return html! {};
    }
    let intervals = [
        ("95 %", finding.interval),
        ("of the run", finding.run_interval),
    ];
    let intervals = intervals.map(|(name, interval)| (name, interval.filter(are_finite)));
    let ends = intervals
        .iter()
        .flat_map(|(_, interval)| interval.iter().flatten());
    let values = biases.iter().map(|(_, bias)| bias).chain(ends);
    let reach = 1.08 * values.fold(1.5 * bound, |reach: f64, x| reach.max(x.abs()));
    let place = |x: f64| round(0.5 * (LEFT + RIGHT) + 0.5 * (RIGHT - LEFT) * x / reach);
    let lanes = lanes(&biases);
    let bottom_of_dots = TOP + lanes.iter().map(|lane| lane.height).sum::<f64>();
    let bottom = bottom_of_dots + INTERVAL * intervals.len() as f64 + 4.0;
    let label = format!(
        "Means of {} pictures of {program}, less the truth's, by pose, with intervals of their mean; the bound is ± {} %",
        biases.len(),
        100.0 * bound
    );
    html! {
        svg class="plot running dots" role="img" aria-label=(label) viewBox=(format!("0 0 420 {}", bottom + 22.0)) {
            rect class="accepted" x=(place(-bound)) y=(TOP) width=(round(place(bound) - place(-bound))) height=(bottom - TOP) {}
            line class="zero" x1=(place(0.0)) x2=(place(0.0)) y1=(TOP) y2=(bottom) {}
            @for lane in &lanes {
                text x=(LEFT - 8.0) y=(lane.top + 0.5 * lane.height + 4.0) text-anchor="end" { (lane.name) }
                @for (x, y) in &lane.dots { circle class="s0" cx=(place(*x)) cy=(round(*y)) r="2.6" {} }
            }
            @for (index, (name, interval)) in intervals.iter().enumerate() {
                @let y = bottom_of_dots + INTERVAL * (index as f64 + 0.5);
                text x=(LEFT - 8.0) y=(y + 4.0) text-anchor="end" { (name) }
                @if let Some([low, high]) = *interval {
                    line class="whisker" x1=(place(low)) x2=(place(high)) y1=(y) y2=(y) {}
                    @for end in [low, high] { line class="whisker" x1=(place(end)) x2=(place(end)) y1=(y - 4.0) y2=(y + 4.0) {} }
                    @if let Some(bias) = finding.bias { circle class="look" cx=(place(bias)) cy=(y) r="3" {} }
                } @else { text x=(place(0.0)) y=(y + 4.0) text-anchor="middle" { "none can be given" } }
            }
            line class="zero" x1=(LEFT) x2=(RIGHT) y1=(bottom) y2=(bottom) {}
            @for (x, anchor) in [(-reach, "start"), (reach, "end")] {
                text x=(place(x)) y=(bottom + 16.0) text-anchor=(anchor) { (signed(x)) }
            }
            text x=(place(0.0)) y=(bottom + 16.0) text-anchor="middle" { "truth" }
        }
    }
}

fn are_finite(interval: &[f64; 2]) -> bool {
    interval.iter().all(|x| x.is_finite())
}

/// Dots beside a name.
struct Lane {
    name: String,
    top: f64,
    height: f64,
    dots: Vec<(f64, f64)>,
}

fn lanes(biases: &[(u32, f64)]) -> Vec<Lane> {
    let mut poses: Vec<u32> = biases.iter().map(|(pose, _)| *pose).collect();
    poses.sort_unstable();
    poses.dedup();
    let (Some(first), Some(last)) = (poses.first(), poses.last()) else {
        return Vec::new();
    };
    if poses.len() > LANES {
        let height = LANE * LANES as f64;
        let step = (height - 12.0) / (poses.len() - 1) as f64;
        let rank = |pose: &u32| poses.binary_search(pose).unwrap_or(0) as f64;
        return vec![Lane {
            name: format!("pose {first}–{last}"),
            top: TOP,
            height,
            dots: (biases.iter())
                .map(|(pose, x)| (*x, TOP + 6.0 + step * rank(pose)))
                .collect(),
        }];
    }
    let lane = |(index, pose): (usize, &u32)| {
        let top = TOP + LANE * index as f64;
        let of_pose = biases.iter().filter(|(of, _)| of == pose);
        // Neighbours in time stand apart, so that equal means can be told from one.
        let dot = |(place, (_, x)): (usize, &(u32, f64))| {
            (*x, top + 0.5 * LANE + 4.0 * ((place % 5) as f64 - 2.0))
        };
        Lane {
            name: format!("pose {pose}"),
            top,
            height: LANE,
            dots: of_pose.enumerate().map(dot).collect(),
        }
    };
    poses.iter().enumerate().map(lane).collect()
}

fn round(x: f64) -> f64 {
    (10.0 * x).round() / 10.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::judge::Verdict;

    fn html(replicates: Vec<(u32, f64)>) -> String {
        let finding = Finding {
            replicates,
            bias: Some(0.0),
            interval: Some([-0.001, 0.001]),
            ..Finding::of(Verdict::Agrees)
        };
        dots(&finding, 0.005, "p").into_string()
    }

    #[test]
    fn every_picture_has_a_dot() {
        let two = html((0..8).map(|i| (i % 2, 1.0 + 1e-4 * f64::from(i))).collect());
        assert_eq!(two.matches("class=\"s0\"").count(), 8);
        assert!(two.contains("pose 0") && two.contains("pose 1"), "{two}");
        assert!(two.contains("none can be given"), "{two}");
        let each = html((0..8).map(|i| (i, 1.0)).collect());
        assert_eq!(each.matches("class=\"s0\"").count(), 8);
        assert!(each.contains("pose 0–7"), "{each}");
    }

    #[test]
    fn what_is_not_finite_is_left_out() {
        assert!(html(Vec::new()).is_empty());
        assert!(html(vec![(0, f64::NAN)]).is_empty());
        let one = html(vec![(0, f64::INFINITY), (0, 3.0)]);
        assert_eq!(one.matches("class=\"s0\"").count(), 1);
        assert!(!one.contains("NaN") && !one.contains("inf"), "{one}");
    }
}
