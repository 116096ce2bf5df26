//! Many pictures with one exposure: a slider above, figures below.
//!
//! Without a script each is a still at exposure 0; `report.js` draws them from their numbers.

use super::album::Album;
use super::encode;
use etalon_images::{Image, png};
use maud::{Markup, html};

/// The slider for all figures of the page.
pub fn slider() -> Markup {
    html! {
        div class="tools exposes" role="group" aria-label="Exposure" {
            label class="exposure" {
                "Exposure of all pictures "
                input type="range" min="-12" max="12" step="0.25" value="0";
                output { "+0.0 EV" }
            }
            button type="button" { "0 EV" }
        }
    }
}

/// A picture that follows the slider.
pub fn figure(album: &mut Album, image: &Image, caption: &str) -> Markup {
    let name = album.add(image);
    still(image, caption, name.as_deref())
}

/// An image at exposure 0; if the album has a picture of this name, the script can redraw it.
fn still(image: &Image, caption: &str, name: Option<&str>) -> Markup {
    let picture = png::develop(image, 0.0)
        .and_then(|(bytes, _)| encode(&opaque(&bytes, image), image.width(), image.height()));
    html! {
        figure class="still" data-picture=[name] {
            @if let Some(source) = picture {
                img src=(source) alt=(caption) width=(image.width()) height=(image.height());
            }
            figcaption { (caption) }
        }
    }
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
