//! The film (`film.cpp`). `rgb` is an `hdrfilm`, as `gbuffer` is, and `spectral` a `specfilm`: both count rows from the top, and show light of luminance 1 as 1 if the exposure is 1.
//!
//! A window is given in pixels, or in parts of the film, which are rounded up to pixels and then count more. pbrt multiplies the picture by the
//! exposure time, which is the time that the shutter is open, and by iso / 100; a factor other than 1 becomes a sensor response `srf`
//! that is the same at all wavelengths.

use super::super::parameter::ColorSpace;
use super::super::parameters::Parameters;
use super::Mapper;
use super::node::Draft;
use etalon_params::{Class, Diagnostic, Node, SpectrumText, Value};
use etalon_spectrum::{LAMBDA_MAX, LAMBDA_MIN};
use std::sync::Arc;

/// What a film is for those who build the sensor.
pub(crate) struct MappedFilm {
    /// Its node.
    pub(crate) node: Arc<Node>,
    /// Width and height in pixels.
    pub(crate) size: [i32; 2],
    /// iso / 100.
    pub(crate) gain: f64,
}

impl Mapper<'_> {
    /// The film with its filter; `None` after a mistake.
    pub(crate) fn film(&self) -> Option<MappedFilm> {
        let params = self.read(&self.scene.film);
        let filter = self.filter();
        let kind = params.entity.kind;
        if kind == "gbuffer" {
            params.ignore(&["coordinatesystem"]);
            let message = "the film `gbuffer` is one of colours: its other channels are those of the integrator `aov`";
            let help =
                "`etalon render --features` writes albedos, normals and depths beside the picture";
            self.note(params.entity.span, message, help);
        }
        if kind == "spectral" {
            return self.spectral_film(&params, filter);
        }
        // The name of the picture and its precision are the command line's; the diagonal matters to `realistic` only.
        params.ignore(&["filename", "savefp16", "diagonal"]);
        let (size, mut draft) = self.pixels(&params, "hdrfilm");
        let balance = params.float("whitebalance", 0.0);
        if balance != 0.0 {
            draft = draft.from(
                &params,
                "whitebalance",
                "white_balance",
                Value::Float(balance),
            );
        }
        let gain = self.sensor_gain(&params);
        self.note_colours(&params);
        params.finish();
        let node = draft.child(filter?).node();
        Some(MappedFilm { node, size, gain })
    }

    /// A film of the plugin `plugin` with its size and window.
    fn pixels(&self, params: &Parameters<'_>, plugin: &str) -> ([i32; 2], Draft) {
        let size = [("xresolution", 1280), ("yresolution", 720)]
            .map(|(name, default)| params.integer_from(name, default, 1));
        let [width, height] = size.map(|side| Value::Integer(i64::from(side)));
        let draft = Draft::of(params, Class::Film, plugin)
            .from(params, "xresolution", "width", width)
            .from(params, "yresolution", "height", height);
        (size, self.window(params, size, draft))
    }

    /// `spectral`: bands of equal width from `lambdamin` to `lambdamax`, each the mean radiance within it.
    fn spectral_film(
        &self,
        params: &Parameters<'_>,
        filter: Option<Arc<Node>>,
    ) -> Option<MappedFilm> {
        params.ignore(&["filename", "savefp16", "diagonal"]);
        let accepted = "a wavelength in nanometres, 360 to 830";
        let within = |nm: f64| (LAMBDA_MIN..=LAMBDA_MAX).contains(&nm);
        let low = params.float_where("lambdamin", LAMBDA_MIN, accepted, within);
        let high = params.float_where("lambdamax", LAMBDA_MAX, accepted, within);
        let count = params.integer_from("nbuckets", 16, 1);
        let (size, mut draft) = self.pixels(params, "specfilm");
        let gain = self.sensor_gain(params);
        if high <= low {
            params.error_at("lambdamax", "`lambdamax` must be above `lambdamin`");
            return None;
        }
        let width = (high - low) / f64::from(count);
        for band in 0..count {
            let [from, to] = [band, band + 1].map(|i| low + width * f64::from(i));
            // Steep ends: they lie within a hundredth of a nanometre.
            let end = 0.005_f64.min(0.25 * width);
            let mean = 1.0 / width;
            let samples = vec![
                (from - end, 0.0),
                (from + end, mean),
                (to - end, mean),
                (to + end, 0.0),
            ];
            let name = format!("S0.{:.3}nm", 0.5 * (from + to))
                .replace('.', ",")
                .replacen(',', ".", 1);
            draft = draft.plain(&name, Value::Spectrum(SpectrumText::Samples(samples)));
        }
        params.finish();
        Some(MappedFilm {
            node: draft.child(filter?).node(),
            size,
            gain,
        })
    }

    /// Adds the window that is rendered.
    fn window(&self, params: &Parameters<'_>, size: [i32; 2], draft: Draft) -> Draft {
        let pixels = params.integers_of::<4>("pixelbounds");
        let parts = params.floats_of::<4>("cropwindow");
        let (source, bounds) = match (parts, pixels) {
            (Some(&[x0, x1, y0, y1]), _) => {
                let within = |axis: usize, a: f64, b: f64| {
                    let side = f64::from(size[axis]);
                    [a.min(b), a.max(b)].map(|part| (side * part.clamp(0.0, 1.0)).ceil() as i32)
                };
                ("cropwindow", [within(0, x0, x1), within(1, y0, y1)])
            }
            (None, Some(&[x0, x1, y0, y1])) => {
                let within = |axis: usize, a: i32, b: i32| {
                    [a.min(b), a.max(b)].map(|pixel| pixel.clamp(0, size[axis]))
                };
                ("pixelbounds", [within(0, x0, x1), within(1, y0, y1)])
            }
            (None, None) => return draft,
        };
        if bounds.iter().any(|[first, end]| first >= end) {
            params.error_at(source, "no pixel is within this window");
            return draft;
        }
        let names = [
            ["crop_offset_x", "crop_width"],
            ["crop_offset_y", "crop_height"],
        ];
        names
            .into_iter()
            .zip(bounds)
            .fold(draft, |draft, (names, [first, end])| {
                let [offset, extent] = [first, end - first].map(|n| Value::Integer(i64::from(n)));
                let draft = draft.from(params, source, names[0], offset);
                draft.from(params, source, names[1], extent)
            })
    }

    /// The factor by which the sensor's sensitivity multiplies the picture.
    fn sensor_gain(&self, params: &Parameters<'_>) -> f64 {
        let iso = params.float_where("iso", 100.0, "a finite number above 0", |iso| {
            iso > 0.0 && iso.is_finite()
        });
        let sensor = params.string("sensor").unwrap_or("cie1931");
        if sensor != "cie1931" {
            let message = format!("the standard observer stands in for the sensor `{sensor}`");
            let help =
                "its sensitivity is kept, its colours are not: Etalon has no curves of cameras";
            self.note(params.span("sensor"), message, help);
        }
        let most = params.float("maxcomponentvalue", f64::INFINITY);
        if most.is_finite() {
            let message = "samples are not clamped: `maxcomponentvalue` has no effect";
            let help = "outliers stay in the picture";
            let span = params.span("maxcomponentvalue");
            self.note(span, message, help);
        }
        iso / 100.0
    }

    /// pbrt writes the picture in the colour space at the film's place, which only its parameters know.
    fn note_colours(&self, params: &Parameters<'_>) {
        let own = params.entity.params.own.first();
        if own.is_some_and(|parameter| parameter.color_space != ColorSpace::Srgb) {
            let message = "the picture is written in linear Rec. 709, not in the colour space here";
            let note = Diagnostic::note(params.entity.span, message);
            self.diagnostics.push(note);
        }
    }
}
