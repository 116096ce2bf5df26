//! The functions whose zeros are surfaces: expressions of a scene file, and some with a name.
//!
//! ```text
//! superellipsoid   (|x|^(2/e) + |y|^(2/e))^(e/n) + |z|^(2/n) − 1          (A. Barr 1981, Superquadrics)
//! blob             T − Σ sᵢ max(0, 1 − |p − cᵢ|²/rᵢ²)²                      (J. Blinn 1982; POV-Ray's density)
//! julia            |q|² − 4 after q ← q² + c of quaternions, n times,      (J. Hart and others 1989)
//!                  from q = x + y i + z j + w k
//! ```

use crate::shapes::analytic::clip_box::ClipBox;
use crate::shapes::profile::numbers;
use etalon_math::Expression;
use etalon_math::expression::Number;
use etalon_params::Params;
use glam::DVec3;

/// A function of a point.
#[derive(Clone, Debug)]
pub(crate) enum Field {
    /// A function of x, y and z.
    Space(Expression),
    /// A function of x and y, constant in z.
    Extrusion(Expression),
    /// A function of the distance from the z axis, called x, and z, called y.
    Revolution(Expression),
    /// With the exponents e and n.
    Superellipsoid(f64, f64),
    /// A threshold, and balls.
    Blob(f64, Vec<Ball>),
    /// c, w and n.
    Julia([f64; 4], f64, u32),
}

/// A part of a blob.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ball {
    centre: DVec3,
    radius: f64,
    strength: f64,
}

/// max(0, x).
fn positive<N: Number>(x: N) -> N {
    let zero = N::constant(0.0);
    N::max_with(x, zero, zero, zero).0
}

/// x^exponent of an x that is not negative.
fn power<N: Number>(x: N, exponent: f64) -> N {
    x.ln().scale(exponent).exp()
}

impl Field {
    /// Its value, negative inside.
    #[inline]
    pub(crate) fn eval<N: Number>(&self, p: [N; 3]) -> N {
        let constant = N::constant;
        let [x, y, z] = p;
        match self {
            Self::Space(function) | Self::Extrusion(function) => function.eval(&p),
            Self::Revolution(function) => {
                let square = positive(x.powi(2).add(y.powi(2)));
                function.eval(&[square.sqrt(), z])
            }
            Self::Superellipsoid(e, n) => {
                let of = |x: N| power(positive(x.powi(2)), 1.0 / e);
                let around = power(positive(of(x).add(of(y))), e / n);
                let up = power(positive(z.powi(2)), 1.0 / n);
                around.add(up).shift(-1.0)
            }
            Self::Blob(threshold, balls) => {
                let mut sum = constant(*threshold);
                for ball in balls {
                    let off = |i: usize| p[i].shift(-ball.centre[i]).powi(2);
                    let squares = off(0).add(off(1)).add(off(2));
                    let scale = -1.0 / (ball.radius * ball.radius);
                    let near = positive(squares.scale(scale).shift(1.0));
                    sum = sum.add(near.powi(2).scale(-ball.strength));
                }
                sum
            }
            Self::Julia(c, w, count) => {
                let (mut a, mut v) = (x, [y, z, constant(*w)]);
                for _ in 0..*count {
                    let squares = v[0].powi(2).add(v[1].powi(2)).add(v[2].powi(2));
                    let double = a.scale(2.0);
                    v = [0, 1, 2].map(|i| v[i].mul(double).shift(c[i + 1]));
                    a = a.powi(2).add(squares.neg()).shift(c[0]);
                }
                let squares = v[0].powi(2).add(v[1].powi(2)).add(v[2].powi(2));
                a.powi(2).add(squares).shift(-4.0)
            }
        }
    }

    /// Reads the `function` of an `implicit`, and its variables: `profile` (`none`, `revolution` or `extrusion`).
    pub(crate) fn expression(params: &Params<'_>) -> Option<Self> {
        if !params.has("function") {
            params.missing("function", "an expression of x, y and z");
        }
        let read = |variables: &[&str]| params.expression("function", variables);
        let kinds = ["none", "revolution", "extrusion"];
        match params.choice("profile", "none", &kinds) {
            "revolution" => read(&["x", "y"]).map(Self::Revolution),
            "extrusion" => read(&["x", "y"]).map(Self::Extrusion),
            _ => read(&["x", "y", "z"]).map(Self::Space),
        }
    }

    /// Reads `e` and `n` (1) of a `superellipsoid`.
    pub(crate) fn superellipsoid(params: &Params<'_>) -> (Option<Self>, Option<ClipBox>) {
        let what = "a number from 0.05 to 20";
        let [e, n] = ["e", "n"]
            .map(|name| params.float_where(name, 1.0, what, |x| (0.05..=20.0).contains(&x)));
        let (low, high) = (-DVec3::ONE, DVec3::ONE);
        (
            Some(Self::Superellipsoid(e, n)),
            Some(ClipBox { low, high }),
        )
    }

    /// Reads the `balls` (x y z radius strength, …) and the `threshold` (0.5) of a `blob`.
    pub(crate) fn blob(params: &Params<'_>) -> (Option<Self>, Option<ClipBox>) {
        let threshold = params.float_where("threshold", 0.5, "a positive number", |x| x > 0.0);
        let what = "five numbers for each: x, y, z, radius and strength";
        let balls = numbers(params, "balls", what).and_then(|numbers| {
            let balls: Vec<Ball> = (numbers.chunks_exact(5))
                .map(|n| Ball {
                    centre: DVec3::new(n[0], n[1], n[2]),
                    radius: n[3],
                    strength: n[4],
                })
                .collect();
            let fits = numbers.len().is_multiple_of(5)
                && balls.iter().all(|ball| ball.radius > 0.0)
                && balls.iter().any(|ball| ball.strength > 0.0);
            if !fits {
                let count = numbers.len();
                params.error_at(
                    "balls",
                    format!(
                        "`balls` has {count} numbers; it takes {what}, all radii above 0, and one \
                         strength at least"
                    ),
                );
            }
            fits.then_some(balls)
        });
        let clip = balls.as_ref().map(|balls| {
            let grown = balls.iter().filter(|ball| ball.strength > 0.0);
            let boxes = grown.map(|ball| [ball.centre - ball.radius, ball.centre + ball.radius]);
            let [low, high] = boxes
                .fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[l, h], [a, b]| {
                    [l.min(a), h.max(b)]
                });
            ClipBox { low, high }
        });
        (balls.map(|balls| Self::Blob(threshold, balls)), clip)
    }

    /// Reads `c` (−0.08 0 −0.83 −0.025), `w` (0) and `iterations` (6) of a `julia`, and its box.
    pub(crate) fn julia(params: &Params<'_>) -> (Option<Self>, Option<ClipBox>) {
        let c = match params.has("c") {
            true => numbers(params, "c", "four numbers"),
            false => Some(vec![-0.08, 0.0, -0.83, -0.025]),
        };
        let c = c.and_then(|numbers| {
            let four = <[f64; 4]>::try_from(numbers).ok();
            if four.is_none() {
                params.error_at("c", "`c` is a quaternion: four numbers".to_owned());
            }
            four
        });
        let w = params.float_or("w", 0.0);
        let asked = params.integer_or("iterations", 6);
        let count = u32::try_from(asked).ok().filter(|n| (1..=20).contains(n));
        if count.is_none() {
            params.refuse("iterations", asked, "a whole number from 1 to 20");
        }
        let clip = ClipBox::from_params_or(params, 1.5);
        let field = c.zip(count).map(|(c, count)| Self::Julia(c, w, count));
        (field, clip)
    }
}
