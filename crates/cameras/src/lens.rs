//! An ideal thin lens by its own numbers: where it is focused, how wide it is, and how much it shows.
//!
//! ```text
//! 1/f = 1/z₀ + 1/z₁        R = f / (2 N)        tan(φ/2) = w / (2 z₁)
//! ```
//!
//! A lens of focal length f images an object at the distance z₀ before it at z₁ behind it (Gauss 1840, Dioptrische
//! Untersuchungen). The f-number N is the focal length over the diameter of the aperture. A film of width w at z₁ sees the
//! horizontal field of view φ. All lengths are metres.
//!
//! Quantities that are not given follow from the others; those that are given redundantly must agree.

use etalon_params::field_of_view::{half_width_from_params, half_width_of_fov};
use etalon_params::{ParameterKind, Params, Value};

/// The quantities of a lens that a camera needs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    /// R (m).
    pub aperture_radius: f64,
    /// z₀ (m).
    pub focus_distance: f64,
    /// tan(φ/2).
    pub half_width: f64,
}

/// Relative tolerance between redundant numbers.
const SAME: f64 = 1e-3;

/// The width of film where a focal length in metres is given, and neither `film_width` nor `fov` (m).
const FULL_FRAME: f64 = 0.036;

const LENGTH: &str = "a finite number of metres above 0";

/// A positive number, if it is given.
fn positive(params: &Params<'_>, name: &str, what: &str) -> Option<f64> {
    let value = params.float(name)?;
    if value > 0.0 && value.is_finite() {
        return Some(value);
    }
    params.refuse(name, value, what);
    None
}

/// Whether the focal length is one of metres; with a unit, as `50mm`, it is Mitsuba's, which says the field of view.
fn is_in_metres(params: &Params<'_>) -> bool {
    let given = params.node.property("focal_length");
    given.is_some_and(|p| matches!(p.value, Value::Float(_) | Value::Integer(_)))
}

fn agree(a: f64, b: f64) -> bool {
    (a - b).abs() <= SAME * b.abs()
}

/// Distances of the plane in focus and of its image by the lens equation; `far` is the default of the former.
fn distances(params: &Params<'_>, far: f64) -> Option<[Option<f64>; 3]> {
    let f = match is_in_metres(params) {
        true => Some(positive(params, "focal_length", LENGTH)?),
        false => None,
    };
    let given = |name| params.has(name).then(|| positive(params, name, LENGTH));
    let z0 = given("focus_distance");
    let z1 = given("image_distance");
    // A refused distance ends here.
    let z0 = z0.map_or(Some(None), |z| z.map(Some))?;
    let z1 = z1.map_or(Some(None), |z| z.map(Some))?;
    let other = |f: f64, z: f64| 1.0 / (1.0 / f - 1.0 / z);
    let beyond = |name: &str, z: f64, f: f64| {
        if z > f {
            return true;
        }
        params.refuse(
            name,
            z,
            &format!("a distance above the focal length, {f} m"),
        );
        false
    };
    match (f, z0, z1) {
        (Some(f), Some(z0), Some(z1)) => {
            if !beyond("focus_distance", z0, f) {
                return None;
            }
            let image = other(f, z0);
            if !agree(z1, image) {
                params.error_with_help(
                    "image_distance",
                    &format!("1/f = 1/z₀ + 1/z₁ does not hold for f = {f}, z₀ = {z0}, z₁ = {z1} m"),
                    &format!("leave one of the three out; with the other two z₁ is {image:.6} m"),
                );
                return None;
            }
            Some([Some(f), Some(z0), Some(image)])
        }
        (Some(f), None, Some(z1)) => {
            beyond("image_distance", z1, f).then(|| [Some(f), Some(other(f, z1)), Some(z1)])
        }
        (Some(f), z0, None) => {
            let z0 = z0.unwrap_or(far);
            beyond("focus_distance", z0, f).then(|| [Some(f), Some(z0), Some(other(f, z0))])
        }
        (None, Some(z0), Some(z1)) => Some([Some(1.0 / (1.0 / z0 + 1.0 / z1)), Some(z0), Some(z1)]),
        (None, None, Some(z1)) => {
            let message = format!("an image at {z1} m says nothing without the lens");
            let help = "give `focal_length` in metres, or `focus_distance`";
            params.error_with_help("image_distance", &message, help);
            None
        }
        (None, z0, None) => Some([None, z0, None]),
    }
}

impl Lens {
    /// Reads `focal_length`, `focus_distance` (`far` if nothing says where it is focused, as Mitsuba has it), `image_distance`,
    /// `aperture_radius` or `f_number`, and `fov` or `film_width`.
    pub fn from_params(params: &Params<'_>, aspect: f64, far: f64) -> Option<Self> {
        params.note_default("focus_distance", ParameterKind::Number, far);
        let [f, z0, z1] = distances(params, far)?;
        Some(Self {
            aperture_radius: Self::radius(params, f)?,
            focus_distance: z0.unwrap_or(far),
            half_width: Self::half_width(params, aspect, z1)?,
        })
    }

    fn radius(params: &Params<'_>, f: Option<f64>) -> Option<f64> {
        const RADIUS: &str = "a finite number not below 0";
        let radius = params.float_where("aperture_radius", 0.0, RADIUS, |r| {
            r >= 0.0 && r.is_finite()
        });
        let number = positive(
            params,
            "f_number",
            "the focal length over the diameter, above 0",
        );
        let Some(number) = number else {
            if !params.has("aperture_radius") && !params.has("f_number") {
                params.missing("aperture_radius", RADIUS);
            }
            return Some(radius);
        };
        let Some(f) = f else {
            params.error_with_help(
                "f_number",
                "an f-number says nothing without the focal length",
                "give `focal_length` in metres, such as 0.05; or both `focus_distance` and `image_distance`",
            );
            return None;
        };
        let of_number = f / (2.0 * number);
        if params.has("aperture_radius") && !agree(radius, of_number) {
            params.error_with_help(
                "f_number",
                &format!("f/{number} of f = {f} m has a radius of {of_number} m, and `aperture_radius` is {radius} m"),
                "leave one of them out",
            );
            return None;
        }
        Some(of_number)
    }

    fn half_width(params: &Params<'_>, aspect: f64, z1: Option<f64>) -> Option<f64> {
        let film = positive(params, "film_width", LENGTH);
        let by_film = film.zip(z1).map(|(width, z1)| width / (2.0 * z1));
        match (film, by_film) {
            (Some(width), None) => {
                params.error_with_help(
                    "film_width",
                    &format!(
                        "a film {width} m wide says nothing without its distance from the lens"
                    ),
                    "give `focal_length` in metres, or `image_distance`",
                );
                None
            }
            (_, Some(half)) if params.has("fov") => {
                let by_fov = half_width_of_fov(params, aspect);
                if !agree(half, by_fov) {
                    let message = format!(
                        "`fov` says 2 tan(φ/2) = {:.6}, and the film at its distance {:.6}",
                        2.0 * by_fov,
                        2.0 * half
                    );
                    params.error_with_help("fov", &message, "leave one of them out");
                    return None;
                }
                Some(half)
            }
            (_, Some(half)) => Some(half),
            (None, None) if params.has("fov") && is_in_metres(params) => {
                Some(half_width_of_fov(params, aspect))
            }
            (None, None) => match z1.filter(|_| is_in_metres(params)) {
                Some(z1) => Some(FULL_FRAME / (2.0 * z1)),
                None => Some(half_width_from_params(params, aspect)),
            },
        }
    }
}
