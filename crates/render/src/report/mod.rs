//! Self-contained HTML: one file with its style, its script and its pictures; nothing is fetched.
//!
//! [`page`] is the frame of every report. Pictures are numbers, not bytes for a screen ([`album`]),
//! so that [`viewer`] can expose them; [`plot`], [`running`] and [`tiles`] draw what was measured
//! as SVG, and [`tables`] says it. [`comparison`] puts them together for `etalon compare`. The look
//! is in `report.css`, what moves is in `report.js`; without a script all tables and plots are there
//! still.

pub mod album;
pub mod comparison;
pub mod exposed;
pub mod half;
pub mod interval;
pub mod plot;
pub mod running;
pub mod tables;
pub mod tiles;
pub mod viewer;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use etalon_images::png;
use etalon_statistics::Verdict;
use maud::{DOCTYPE, Markup, PreEscaped, html};

/// The look of all reports.
pub const STYLE: &str = include_str!("report.css");

/// How errors become colours.
pub const COLOURS: &str = include_str!("colours.js");

/// What all reports do.
pub const SCRIPT: &str = concat!(include_str!("colours.js"), include_str!("report.js"));

/// What a browser may load for a report: nothing.
const POLICY: &str = "default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'; base-uri 'none'; form-action 'none'";

/// A whole page.
pub fn page(title: &str, body: &Markup) -> String {
    styled_page(title, "", body)
}

/// A whole page with rules of its own besides the look of all.
pub fn styled_page(title: &str, style: &str, body: &Markup) -> String {
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                meta http-equiv="Content-Security-Policy" content=(POLICY);
                meta name="referrer" content="no-referrer";
                title { (title) " – Etalon" }
                style { (PreEscaped(STYLE)) (PreEscaped(style)) }
                // Before anything is drawn, so that nothing flashes or moves.
                script { (PreEscaped(
                    "document.documentElement.classList.add('scripted');try{var t=localStorage.getItem('etalon-theme');if(t)document.documentElement.dataset.theme=t}catch(e){}"
                )) }
            }
            body {
                a class="skip" href="#content" { "Skip to the content" }
                header class="top" {
                    span class="brand" { "Etalon" }
                    h1 { (title) }
                    button type="button" class="theme" { "Theme: as the system" }
                }
                main id="content" tabindex="-1" { (body) }
                script { (PreEscaped(SCRIPT)) }
            }
        }
    }
    .into_string()
}

/// RGB bytes as a PNG file in an address.
pub fn encode(bytes: &[u8], width: usize, height: usize) -> Option<String> {
    let png = png::encode_rgb(bytes, width, height).ok()?;
    Some(format!("data:image/png;base64,{}", STANDARD.encode(png)))
}

/// A verdict in its colour, with a sign of its own.
pub fn verdict(verdict: Verdict) -> Markup {
    let text = verdict.to_string();
    html! { span class=(text) { (sign(verdict)) " " (text) } }
}

/// A verdict as one character, for those who do not see its colour.
pub fn sign(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Agrees => "✓",
        Verdict::Differs => "✗",
        Verdict::Undecided => "?",
    }
}

/// A share in per cent.
pub fn percent(x: f64) -> String {
    format!("{:.3} %", 100.0 * x)
}

/// A share in per cent, with its sign.
pub fn signed(x: f64) -> String {
    format!("{:+.3} %", 100.0 * x)
}

/// A p-value in few characters.
pub fn probability(p: f64) -> String {
    if p >= 0.001 {
        format!("{p:.3}")
    } else if p > 0.0 {
        format!("{p:.0e}")
    } else {
        "0".to_owned()
    }
}
