//! Two pictures to be held against each other: a slider between them, a flip, their exposure, and a
//! map of their difference.
//!
//! The markup is complete and keeps its place before anything is drawn; `report.js` draws it when it
//! comes into sight.

use super::album::{Album, FLOOR, exposure};
use etalon_film::RenderedImage;
use maud::{Markup, html};

/// What the colours of the map mean.
const COLOURS: &str = "Blue: darker than it ought to be; orange: brighter.";

/// Two pictures and their difference; nothing if either has no colour.
pub fn viewer(
    album: &mut Album,
    first: &RenderedImage,
    second: &RenderedImage,
    names: &[String; 2],
) -> Markup {
    let (Some(a), Some(b)) = (album.add(&first.image), album.add(&second.image)) else {
        return html! { p { "There is no colour to show." } };
    };
    let relative = album.add_difference(&first.image, &second.image);
    let deviation = album.add_deviation(first, second);
    let (width, height) = (first.image.width(), first.image.height());
    if relative.is_none() {
        return html! { p { "The pictures differ in size." } };
    }
    let automatic = exposure(&second.image);
    let [one, other] = names;
    let floor = 100.0 * FLOOR;
    let about = format!("Luminance: ({one} − {other}) / ({other} + {floor:.0} % of its mean)");
    let in_errors = format!("Green: ({one} − {other}) / its standard error");
    html! {
        div class="viewer" data-first=(a) data-second=(b) data-relative=[relative]
            data-deviation=[deviation.as_deref()] data-exposure=(automatic) {
            div class="tools" role="group" aria-label="Exposure and map" {
                label class="exposure" {
                    "Exposure "
                    input type="range" min=(automatic.min(0.0) - 8.0) max=(automatic.max(0.0) + 8.0) step="0.1" value=(automatic);
                    output { (format!("{automatic:+.1} EV")) }
                }
                button type="button" data-do="auto" { "Auto" }
                button type="button" data-do="zero" { "0 EV" }
                button type="button" data-do="flip" aria-keyshortcuts="F" { "Flip " kbd { "F" } }
                label { "Map "
                    select data-do="map" {
                        option value="relative" { "relative" }
                        @if deviation.is_some() {
                            option value="deviation" { "in standard errors" }
                        }
                    }
                }
                label { "Full colour "
                    select data-do="scale" { option { "10 %" } }
                }
            }
            div class="panes" {
                figure {
                    div class="frame" style=(format!("--w:{width};--h:{height}")) {
                        canvas class="pair" width=(width) height=(height) role="img"
                            aria-label=(format!("{} left of the slider, {} right of it", names[0], names[1])) {}
                        span class="name left" { (names[0]) }
                        span class="name right" { (names[1]) }
                        div class="divider" role="slider" tabindex="0" aria-orientation="horizontal"
                            aria-label="Where the first picture ends" aria-valuemin="0" aria-valuemax="100"
                            aria-valuenow="50" aria-valuetext=(format!("{} left of 50 %", names[0]))
                            aria-keyshortcuts="F" { span {} }
                    }
                    figcaption {
                        "Drag, or use the arrow keys on the slider; " kbd { "F" }
                        " flips. " (width) " × " (height) " pixels."
                    }
                }
                figure {
                    div class="frame" style=(format!("--w:{width};--h:{height}")) {
                        canvas class="map" width=(width) height=(height) role="img" tabindex="0"
                            aria-label="Signed difference of each pixel; arrow keys go from pixel to pixel" {}
                    }
                    figcaption {
                        span class="scale" {
                            span class="low" { "−10 %" } span class="ramp" aria-hidden="true" {}
                            span class="high" { "+10 %" }
                        }
                        span class="about" data-relative=(about) data-deviation=(in_errors) { (about) ". " (COLOURS) }
                    }
                }
            }
            p class="readout" role="status" { "Point at a pixel, or use the arrow keys on the map, to read its numbers." }
        }
        noscript { p { "Pictures are drawn by a script, which your browser does not run." } }
    }
}
