//! The corner of an evenly lit square, seen through a reconstruction filter.
//!
//! A pixel is ∬ f(x − cₓ) f(y − c_y) L(x, y) dx dy / (∫f)², with c its centre (all lengths in pixels). Where
//! L is constant on a square and nothing elsewhere, that is the product of what f has on either side,
//!
//! ```text
//! L F(cₓ) F(c_y),    F(c) = ∫_{e−s}^{e} f(x − c) dx / ∫f,
//! ```
//!
//! with the square's edge at e and its side s, both counted from the film's corner. A white square under
//! parallel light of irradiance E from straight above sends back L = ρ E / π.
//!
//! The filters are those that Mitsuba 3's documentation describes: box; tent; a Gaussian, cut at four
//! standard deviations and lowered to zero there; Mitchell and Netravali 1988, equation (8), written here
//! as their sum of three terms, with Catmull and Rom's at B = 0, C = ½; sinc(x) sinc(x/a) (Duchon 1979).

use super::light::{known, rgb};
use crate::claim::Claim;
use etalon_math::float64::{exp, sin};
use etalon_render::judge::ExactImage;
use std::f64::consts::PI;

/// Where the square ends (pixels from the film's corner), and its side: `scenes/filters/corner.xml`.
const EDGE: f64 = 0.25;
const SIDE: f64 = 3.0;
/// Cells of a pixel in which f is integrated; all filters' kinks are at their borders.
const CELLS: f64 = 64.0;

/// The picture of the corner.
///
/// # Errors
/// If the claim lacks a number or there is no such filter.
pub fn picture(claim: &Claim, size: [u32; 2]) -> Result<ExactImage, String> {
    let filter = Shape::of(claim)?;
    let whole = filter.integral(-filter.radius, filter.radius);
    let share = |index: u32| {
        let centre = f64::from(index) + 0.5;
        filter.integral(EDGE - SIDE - centre, EDGE - centre) / whole
    };
    let radiance = claim.number("reflectance")? * claim.number("irradiance")? / PI;
    let unit = rgb(|_| radiance);
    Ok(known(size, |column, row| {
        unit.map(|c| c * share(column) * share(row))
    }))
}

/// A filter of any scale.
struct Shape {
    f: Box<dyn Fn(f64) -> f64>,
    /// Beyond it f is zero.
    radius: f64,
}

impl Shape {
    fn new(radius: f64, f: impl Fn(f64) -> f64 + 'static) -> Self {
        Self {
            f: Box::new(f),
            radius,
        }
    }

    /// What the claim names.
    fn of(claim: &Claim) -> Result<Self, String> {
        Ok(match claim.text("filter")? {
            "box" => Self::new(0.5, |_| 1.0),
            "tent" => Self::tent(1.0),
            "tent-wide" => Self::tent(claim.number("radius")?),
            "gaussian" => Self::gaussian(0.5),
            "gaussian-wide" => Self::gaussian(claim.number("stddev")?),
            "mitchell" => Self::cubic(1.0 / 3.0, 1.0 / 3.0),
            "mitchell-soft" => Self::cubic(claim.number("blur")?, claim.number("ringing")?),
            "catmullrom" => Self::cubic(0.0, 0.5),
            "lanczos" => Self::lanczos(3.0),
            "lanczos-short" => Self::lanczos(claim.number("lobes")?),
            other => return Err(format!("there is no filter called `{other}`")),
        })
    }

    fn tent(radius: f64) -> Self {
        Self::new(radius, move |x| radius - x.abs())
    }

    fn gaussian(deviation: f64) -> Self {
        let variance = deviation * deviation;
        Self::new(4.0 * deviation, move |x| {
            exp(-x * x / (2.0 * variance)) - exp(-8.0)
        })
    }

    /// (1 − B − C) times the cubic that has neither, and B and C times the cubics of their own:
    /// the cubic B-spline and the cardinal splines are among them.
    fn cubic(b: f64, c: f64) -> Self {
        Self::new(2.0, move |x| {
            let x = x.abs();
            // Powers of 1 − x and 2 − x vanish where the pieces end.
            let (near, far) = (1.0 - x, 2.0 - x);
            if x < 1.0 {
                let hermite = near * near * (1.0 + 2.0 * x);
                let spline = (far * far * far - 4.0 * near * near * near) / 6.0;
                hermite + b * (spline - hermite) + c * x * x * near
            } else {
                b * far * far * far / 6.0 + c * near * far * far
            }
        })
    }

    fn lanczos(lobes: f64) -> Self {
        let sinc = |x: f64| {
            if x == 0.0 {
                1.0
            } else {
                sin(PI * x) / (PI * x)
            }
        };
        Self::new(lobes, move |x| sinc(x) * sinc(x / lobes))
    }

    /// ∫ f from `a` to `b`, by Simpson's rule on every cell.
    fn integral(&self, a: f64, b: f64) -> f64 {
        let (a, b) = (a.max(-self.radius), b.min(self.radius));
        if a >= b {
            return 0.0;
        }
        let cells = ((b - a) * CELLS).round();
        let width = (b - a) / cells;
        let cell = |i: u32| {
            let start = a + f64::from(i) * width;
            (self.f)(start) + 4.0 * (self.f)(start + 0.5 * width) + (self.f)(start + width)
        };
        (0..cells as u32).map(cell).sum::<f64>() * width / 6.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// F on the near side of `edge` pixels beyond a pixel's centre.
    fn share(shape: &Shape, edge: f64) -> f64 {
        shape.integral(-shape.radius, edge) / shape.integral(-shape.radius, shape.radius)
    }

    #[test]
    fn masses_beside_an_edge() {
        assert!((share(&Shape::new(0.5, |_| 1.0), -0.25) - 0.25).abs() < 1e-14);
        // A triangle: (3/4)² / 2.
        assert!((share(&Shape::tent(1.0), -0.25) - 0.281_25).abs() < 1e-14);
        // Φ(−½) = 0.30853754 without the lowering: (Φ(−½) − Φ(−4) − 3.5 φ₄)/(1 − 2 Φ(−4) − 8 φ₄) with
        // φ₄ = exp(−8)/√(2π).
        assert!((share(&Shape::gaussian(0.5), -0.25) - 0.308_387_168).abs() < 1e-8);
    }

    #[test]
    fn cubics_of_the_literature() {
        // The cubic B-spline: 2/3 at the centre, 1/6 a pixel away.
        let spline = Shape::cubic(1.0, 0.0);
        assert!(((spline.f)(0.0) - 2.0 / 3.0).abs() < 1e-15);
        assert!(((spline.f)(1.0) - 1.0 / 6.0).abs() < 1e-15);
        // Catmull and Rom's: 9/16 and −1/16 between four points.
        let cardinal = Shape::cubic(0.0, 0.5);
        assert!(((cardinal.f)(0.5) - 0.5625).abs() < 1e-15);
        assert!(((cardinal.f)(-1.5) + 0.0625).abs() < 1e-15);
        // The authors' own: 8/9 and 1/18.
        let authors = Shape::cubic(1.0 / 3.0, 1.0 / 3.0);
        assert!(((authors.f)(0.0) - 8.0 / 9.0).abs() < 1e-15);
        assert!(((authors.f)(1.0) - 1.0 / 18.0).abs() < 1e-15);
        for shape in [spline, cardinal, authors] {
            assert!((shape.integral(-2.0, 2.0) - 1.0).abs() < 1e-14);
        }
    }
}
