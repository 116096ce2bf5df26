//! Values on the command line: numbers within bounds, names of a list.

use etalon_images::View;
use etalon_render::target;
use etalon_scene::{AcceleratorKind, LightSamplerKind, SensorChoice};
use glam::UVec2;

/// A whole number from `LOW` to `HIGH`.
pub(crate) fn whole<const LOW: u32, const HIGH: u32>(text: &str) -> Result<u32, String> {
    let number = text.parse().ok();
    number
        .filter(|number| (LOW..=HIGH).contains(number))
        .ok_or_else(|| format!("expected a whole number from {LOW} to {HIGH}"))
}

/// A seed.
pub(crate) fn parse_seed(text: &str) -> Result<u64, String> {
    (text.parse()).map_err(|_| format!("expected a whole number from 0 to {}", u64::MAX))
}

/// A number strictly between 0 and 1.
pub(crate) fn parse_probability(text: &str) -> Result<f64, String> {
    let number = text.parse().ok();
    number
        .filter(|number| *number > 0.0 && *number < 1.0)
        .ok_or_else(|| "expected a number between 0 and 1, such as 0.01".to_owned())
}

/// A relative error.
pub(crate) fn parse_error(text: &str) -> Result<f64, String> {
    let error = text.parse().ok();
    error
        .filter(|error| target::ERRORS.contains(error))
        .ok_or_else(|| "expected a number from 0.000001 to 1, such as 0.01 for 1 %".to_owned())
}

/// The name of a light chooser.
pub(crate) fn parse_light_chooser(text: &str) -> Result<LightSamplerKind, String> {
    LightSamplerKind::named(text).ok_or_else(|| {
        let names = LightSamplerKind::ALL.map(LightSamplerKind::name);
        format!("expected one of {}", names.join(", "))
    })
}

/// The name of an accelerator.
pub(crate) fn parse_accelerator(text: &str) -> Result<AcceleratorKind, String> {
    AcceleratorKind::named(text).ok_or_else(|| {
        let names = AcceleratorKind::ALL.map(AcceleratorKind::name);
        format!("expected one of {}", names.join(", "))
    })
}

/// A duration.
pub(crate) fn parse_seconds(text: &str) -> Result<f64, String> {
    let seconds = text.parse().ok();
    seconds
        .filter(|seconds| target::SECONDS.contains(seconds))
        .ok_or_else(|| {
            "expected a number of seconds from 0.001 to 100000000, such as 60".to_owned()
        })
}

/// Frames per unit of time.
pub(crate) fn parse_rate(text: &str) -> Result<f64, String> {
    let rate = text.parse().ok();
    rate.filter(|rate| (1e-6..=1e6).contains(rate))
        .ok_or_else(|| "expected frames per unit of scene time, such as 24".to_owned())
}

/// `key=value`.
pub(crate) fn parse_define(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((key, value)) if !key.is_empty() => Ok((key.to_owned(), value.to_owned())),
        _ => Err("expected key=value".to_owned()),
    }
}

/// `WxH`.
pub(crate) fn parse_size(text: &str) -> Result<UVec2, String> {
    let sides = text.split_once(['x', 'X', '×']);
    sides
        .and_then(|(w, h)| Some(UVec2::new(w.trim().parse().ok()?, h.trim().parse().ok()?)))
        .filter(|size| size.min_element() > 0)
        .ok_or_else(|| "expected width and height in pixels, such as 640x480".to_owned())
}

/// `25%` or `0.25`.
pub(crate) fn parse_scale(text: &str) -> Result<f64, String> {
    let (number, unit) = match text.strip_suffix('%') {
        Some(number) => (number, 0.01),
        None => (text, 1.0),
    };
    let share = number.trim().parse::<f64>().ok().map(|x| x * unit);
    share
        .filter(|share| *share > 0.0 && *share <= 1000.0)
        .ok_or_else(|| {
            "expected a share of the scene's size above 0, such as 25% or 0.25".to_owned()
        })
}

/// `X,Y,W,H`.
pub(crate) fn parse_crop(text: &str) -> Result<[UVec2; 2], String> {
    let numbers: Option<Vec<u32>> =
        (text.split(',').map(|word| word.trim().parse().ok())).collect();
    match numbers.as_deref() {
        Some([x, y, w, h]) if *w > 0 && *h > 0 => Ok([UVec2::new(*x, *y), UVec2::new(*w, *h)]),
        _ => Err(
            "expected four whole numbers, such as 100,50,64,64: column, row, width, height"
                .to_owned(),
        ),
    }
}

/// A number or an id.
pub(crate) fn parse_sensor(text: &str) -> Result<SensorChoice, String> {
    match text.parse() {
        Ok(number) => Ok(SensorChoice::Number(number)),
        Err(_) if text.is_empty() => Err("expected the number or the id of a sensor".to_owned()),
        Err(_) => Ok(SensorChoice::Id(text.to_owned())),
    }
}

/// The name of a view.
pub(crate) fn parse_view(text: &str) -> Result<View, String> {
    View::named(text).ok_or_else(|| {
        let names = View::ALL.map(View::name);
        format!("expected one of {}", names.join(", "))
    })
}

/// `HOST:PORT`.
pub(crate) fn parse_tev(text: &str) -> Result<String, String> {
    let ends = text.rsplit_once(':');
    ends.filter(|(host, port)| !host.is_empty() && port.parse::<u16>().is_ok_and(|port| port > 0))
        .map(|_| text.to_owned())
        .ok_or_else(|| {
            "expected a host and a port, such as 127.0.0.1:14158; other words go before the option"
                .to_owned()
        })
}

/// `A..B`.
pub(crate) fn parse_range(text: &str) -> Result<[f64; 2], String> {
    let ends = text.split_once("..");
    ends.and_then(|(a, b)| Some([a.trim().parse().ok()?, b.trim().parse().ok()?]))
        .filter(|[a, b]: &[f64; 2]| a != b && a.is_finite() && b.is_finite())
        .ok_or_else(|| "expected two different numbers, such as 0..10 or -1..1".to_owned())
}
