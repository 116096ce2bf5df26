//! An interval against what is accepted, as a small drawing: a table of them is a forest plot.

use maud::{Markup, html};

/// Half the width of the accepted range, and the ends of the drawing (its units).
const HALF: f64 = 36.0;
const MIDDLE: f64 = 60.0;
const ENDS: [f64; 2] = [4.0, 116.0];

/// `interval` about `value`, with the band that is accepted in the middle. `class` colours it; an
/// end beyond the drawing is an arrow.
pub fn bar(value: f64, interval: [f64; 2], [least, most]: [f64; 2], class: &str) -> Markup {
    let half = 0.5 * (most - least);
    if !(half > 0.0) || interval.iter().any(|x| x.is_nan()) {
        return html! {};
    }
    let place = |x: f64| MIDDLE + HALF * (x - 0.5 * (least + most)) / half;
    let clamped = |x: f64| (10.0 * place(x).clamp(ENDS[0], ENDS[1])).round() / 10.0;
    let [low, high] = interval.map(clamped);
    let beyond = [place(interval[0]) < ENDS[0], place(interval[1]) > ENDS[1]];
    // An end of the drawing that an arrow takes the place of.
    let arrow = |at: f64, way: f64| {
        let back = at - way;
        html! { polyline class="end" points=(format!("{back},3.5 {at},8 {back},12.5")) {} }
    };
    let away = place(interval[0]) > ENDS[1] || place(interval[1]) < ENDS[0];
    html! {
        svg class={ "interval " (class) } viewBox="0 0 120 16" aria-hidden="true" {
            rect class="accepted" x=(MIDDLE - HALF) y="1" width=(2.0 * HALF) height="14" {}
            line class="zero" x1=(MIDDLE) x2=(MIDDLE) y1="1" y2="15" {}
            @if away {
                @let way = if low > MIDDLE { 1.0 } else { -1.0 };
                line class="reach" x1=(low - 12.0 * way) x2=(low) y1="8" y2="8" {}
                (arrow(low, 5.0 * way))
            } @else {
                line class="reach" x1=(low) x2=(high.max(low + 0.6)) y1="8" y2="8" {}
                @for (at, beyond, way) in [(low, beyond[0], -5.0), (high, beyond[1], 5.0)] {
                    @if beyond { (arrow(at, way)) }
                    @else { line class="end" x1=(at) x2=(at) y1="4.5" y2="11.5" {} }
                }
                circle cx=(clamped(value)) cy="8" r="2.4" {}
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_accepted_is_in_the_middle() {
        let html = bar(0.0, [-0.005, 0.02], [-0.005, 0.005], "agrees").into_string();
        assert!(html.contains("x1=\"24\""), "{html}");
        // The upper end is an arrow, the lower one is not.
        assert_eq!(html.matches("<polyline").count(), 1);
        assert!(
            bar(1.0, [1.0, 1.0], [0.0, 0.0], "")
                .into_string()
                .is_empty()
        );
        let endless = bar(0.0, [f64::NEG_INFINITY, f64::INFINITY], [-1.0, 1.0], "");
        assert_eq!(endless.into_string().matches("<polyline").count(), 2);
        // Far from what is accepted, only where to is told.
        let far = bar(9.0, [8.0, 10.0], [-1.0, 1.0], "").into_string();
        assert_eq!(
            (
                far.matches("<polyline").count(),
                far.matches("<circle").count()
            ),
            (1, 0)
        );
    }
}
