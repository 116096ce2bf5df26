//! Reconstruction filters: how much a film position counts for a pixel.
//!
//! A pixel is ∬ f(x − cₓ) f(y − c_y) L(x, y) dx dy / (∫f)², with c its centre: all filters here
//! are even, have a bounded support and apply to each axis alone. [`Filter::eval`] gives f as
//! Mitsuba scales it (1, or nearly so, at the centre); [`crate::PixelFilter`] divides by ∫f.

mod box_filter;
mod catmull_rom;
mod gaussian;
mod lanczos;
mod mitchell;
mod tent;
mod wide_box;

pub use box_filter::BoxFilter;
pub use catmull_rom::CatmullRom;
pub use gaussian::Gaussian;
pub use lanczos::Lanczos;
pub use mitchell::Mitchell;
pub use tent::Tent;
pub use wide_box::WideBox;

use etalon_params::{Diagnostic, Params};

/// Any of the reconstruction filters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Filter {
    /// `box`.
    Box(BoxFilter),
    /// `box` of another radius.
    WideBox(WideBox),
    /// `tent`.
    Tent(Tent),
    /// `gaussian`.
    Gaussian(Gaussian),
    /// `mitchell`.
    Mitchell(Mitchell),
    /// `catmullrom`.
    CatmullRom(CatmullRom),
    /// `lanczos`.
    Lanczos(Lanczos),
}

impl Filter {
    /// The plugins of class `rfilter`.
    pub const NAMES: [&str; 6] = [
        "box",
        "tent",
        "gaussian",
        "mitchell",
        "catmullrom",
        "lanczos",
    ];

    /// Reads a filter; mistakes go to `params.diagnostics`. Calling `finish` is left to the
    /// caller, as everywhere.
    pub fn from_params(params: &Params<'_>) -> Self {
        let plugin = &params.node.plugin;
        match plugin.value.as_str() {
            "box" => match params.float_or("radius", BoxFilter::RADIUS) {
                BoxFilter::RADIUS => Self::Box(BoxFilter),
                radius => WideBox::new(radius).map_or_else(
                    || refused(params, "radius", radius, "a radius above 0 (pixels)"),
                    Self::WideBox,
                ),
            },
            "tent" => {
                let radius = params.float_or("radius", Tent::DEFAULT_RADIUS);
                Tent::new(radius).map_or_else(
                    || refused(params, "radius", radius, "a radius above 0 (pixels)"),
                    Self::Tent,
                )
            }
            "gaussian" => {
                let deviation = params.float_or("stddev", Gaussian::DEFAULT_DEVIATION);
                let Some(whole) = Gaussian::new(deviation) else {
                    let accepted = "a standard deviation above 0 (pixels)";
                    return refused(params, "stddev", deviation, accepted);
                };
                let radius = params.float_or("radius", whole.radius());
                let accepted = "a radius (pixels) of at least a hundredth of `stddev`";
                Gaussian::cut_at(deviation, radius).map_or_else(
                    || refused(params, "radius", radius, accepted),
                    Self::Gaussian,
                )
            }
            "mitchell" => {
                let b = params.float_or("B", Mitchell::DEFAULT);
                let c = params.float_or("C", Mitchell::DEFAULT);
                let radius = params.float_or("radius", Mitchell::DEFAULT_RADIUS);
                let Some(plain) = Mitchell::new(b, c) else {
                    let (name, value) = if Mitchell::new(b, 0.0).is_none() {
                        ("B", b)
                    } else {
                        ("C", c)
                    };
                    return refused(params, name, value, "a number from -100 to 100");
                };
                plain.stretched(radius).map_or_else(
                    || refused(params, "radius", radius, "a radius above 0 (pixels)"),
                    Self::Mitchell,
                )
            }
            "catmullrom" => Self::CatmullRom(CatmullRom),
            "lanczos" => {
                let lobes = params.integer_or("lobes", Lanczos::DEFAULT_LOBES.into());
                let Some(whole) = u32::try_from(lobes).ok().and_then(Lanczos::new) else {
                    let accepted = format!("a whole number from 1 to {}", Lanczos::MOST_LOBES);
                    return refused(params, "lobes", lobes, &accepted);
                };
                let radius = params.float_or("radius", whole.radius());
                let accepted = "a radius (pixels) above 0, at most twice `lobes`";
                whole.cut_at(radius).map_or_else(
                    || refused(params, "radius", radius, accepted),
                    Self::Lanczos,
                )
            }
            other => {
                params.diagnostics.push(
                    Diagnostic::error(plugin.span, format!("there is no rfilter called `{other}`"))
                        .suggest(other, Self::NAMES),
                );
                Self::default()
            }
        }
    }

    /// The name of its plugin.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Box(_) | Self::WideBox(_) => "box",
            Self::Tent(_) => "tent",
            Self::Gaussian(_) => "gaussian",
            Self::Mitchell(_) => "mitchell",
            Self::CatmullRom(_) => "catmullrom",
            Self::Lanczos(_) => "lanczos",
        }
    }

    /// The value at `x` pixels from the centre, on Mitsuba's scale.
    pub fn eval(&self, x: f64) -> f64 {
        match self {
            Self::Box(f) => f.eval(x),
            Self::WideBox(f) => f.eval(x),
            Self::Tent(f) => f.eval(x),
            Self::Gaussian(f) => f.eval(x),
            Self::Mitchell(f) => f.eval(x),
            Self::CatmullRom(f) => f.eval(x),
            Self::Lanczos(f) => f.eval(x),
        }
    }

    /// Beyond this many pixels from the centre the filter is zero.
    pub fn radius(&self) -> f64 {
        match self {
            Self::Box(_) => BoxFilter::RADIUS,
            Self::WideBox(f) => f.radius(),
            Self::Tent(f) => f.radius(),
            Self::Gaussian(f) => f.radius(),
            Self::Mitchell(f) => f.radius(),
            Self::CatmullRom(_) => CatmullRom::RADIUS,
            Self::Lanczos(f) => f.radius(),
        }
    }
}

/// The name and the parameters, as `tent radius=1`.
impl std::fmt::Display for Filter {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())?;
        match self {
            Self::Box(_) | Self::CatmullRom(_) => Ok(()),
            Self::WideBox(wide) => write!(f, " radius={}", wide.radius()),
            Self::Tent(tent) => write!(f, " radius={}", tent.radius()),
            Self::Gaussian(gaussian) => {
                write!(f, " stddev={}", gaussian.deviation())?;
                match gaussian.is_cut() {
                    true => write!(f, " radius={}", gaussian.radius()),
                    false => Ok(()),
                }
            }
            Self::Mitchell(mitchell) => {
                let [b, c] = mitchell.parameters();
                write!(f, " B={b} C={c}")?;
                match mitchell.radius() == Mitchell::DEFAULT_RADIUS {
                    true => Ok(()),
                    false => write!(f, " radius={}", mitchell.radius()),
                }
            }
            Self::Lanczos(lanczos) => {
                write!(f, " lobes={}", lanczos.lobes())?;
                match lanczos.is_cut() {
                    true => write!(f, " radius={}", lanczos.radius()),
                    false => Ok(()),
                }
            }
        }
    }
}

/// Mitsuba's default filter of a film.
impl Default for Filter {
    fn default() -> Self {
        Self::Gaussian(
            Gaussian::new(Gaussian::DEFAULT_DEVIATION).expect("the default deviation is valid"),
        )
    }
}

/// Reports a refused value and returns the default.
fn refused(params: &Params<'_>, name: &str, value: impl std::fmt::Display, what: &str) -> Filter {
    params.refuse(name, value, what);
    Filter::default()
}
