//! Filters: values against Mitsuba's, integrals against closed forms, sampling against both.

use etalon_film::{
    BoxFilter, CatmullRom, Filter, Gaussian, Lanczos, Mitchell, PixelFilter, Tent, WideBox,
};
use glam::Vec2;

fn tent(radius: f64) -> Filter {
    Filter::Tent(Tent::new(radius).expect("valid"))
}

fn gaussian(deviation: f64) -> Filter {
    Filter::Gaussian(Gaussian::new(deviation).expect("valid"))
}

fn mitchell(b: f64, c: f64) -> Filter {
    Filter::Mitchell(Mitchell::new(b, c).expect("valid"))
}

fn lanczos(lobes: u32) -> Filter {
    Filter::Lanczos(Lanczos::new(lobes).expect("valid"))
}

/// pbrt's `mitchell` of another radius.
fn stretched(radius: f64) -> Filter {
    let plain = Mitchell::new(0.2, 0.5).expect("valid");
    Filter::Mitchell(plain.stretched(radius).expect("valid"))
}

/// pbrt's `sinc` with tau = 3.
fn cut(radius: f64) -> Filter {
    let whole = Lanczos::new(3).expect("valid");
    Filter::Lanczos(whole.cut_at(radius).expect("valid"))
}

fn all() -> Vec<Filter> {
    vec![
        Filter::Box(BoxFilter),
        tent(1.0),
        tent(2.25),
        gaussian(0.5),
        gaussian(1.7),
        mitchell(1.0 / 3.0, 1.0 / 3.0),
        mitchell(0.2, 0.9),
        mitchell(1.0, 0.0),
        mitchell(0.0, 3.0),
        mitchell(-1.0, -0.5),
        Filter::CatmullRom(CatmullRom),
        lanczos(1),
        lanczos(2),
        lanczos(3),
        lanczos(6),
        Filter::WideBox(WideBox::new(1.25).expect("valid")),
        stretched(3.0),
        cut(4.0),
        cut(2.5),
    ]
}

/// ∫ g over [a, b] by Simpson's rule.
fn integral(g: impl Fn(f64) -> f64, a: f64, b: f64, steps: u32) -> f64 {
    let h = (b - a) / f64::from(steps);
    (0..steps)
        .map(|i| {
            let x = a + h * f64::from(i);
            h / 6.0 * (g(x) + 4.0 * g(x + 0.5 * h) + g(x + h))
        })
        .sum()
}

/// Values printed by Mitsuba 3.9.1, `mi.load_dict({'type': …}).eval(x)`; its Gaussian is a
/// polynomial that stays within 5·10⁻⁴ of ours, everything else is rounded to single precision.
#[test]
fn values_are_mitsubas() {
    let xs = [0.0, 0.25, 0.5, 0.75, 1.0, 1.3, 1.75, 1.99, 2.5];
    let check = |filter: Filter, tolerance: f64, expected: [f64; 9]| {
        for (x, expected) in xs.into_iter().zip(expected) {
            for x in [x, -x] {
                let found = filter.eval(x);
                // The box is half open; Mitsuba's value at its edge is 0 on both sides.
                if matches!(filter, Filter::Box(_)) && x == -0.5 {
                    continue;
                }
                assert!(
                    (found - expected).abs() < tolerance,
                    "{filter} at {x}: {found}"
                );
            }
        }
    };
    check(
        Filter::Box(BoxFilter),
        1e-9,
        [1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    );
    check(
        tent(2.0),
        1e-6,
        [1.0, 0.875, 0.75, 0.625, 0.5, 0.35, 0.125, 0.005, 0.0],
    );
    check(
        gaussian(0.5),
        5e-4,
        [
            0.999_247, 0.882_167, 0.606_423, 0.324_243, 0.134_960, 0.033_705, 0.001_843, 0.000_03,
            0.0,
        ],
    );
    check(
        mitchell(1.0 / 3.0, 1.0 / 3.0),
        1e-6,
        [
            0.888_889, 0.782_118, 0.534_722, 0.256_076, 0.055_556, -0.029_944, -0.014_757,
            -0.000_033, 0.0,
        ],
    );
    check(
        mitchell(0.2, 0.5),
        1e-6,
        [
            0.933_333, 0.820_833, 0.558_333, 0.258_333, 0.033_334, -0.062_066, -0.022_916,
            -0.000_049, 0.0,
        ],
    );
    check(
        Filter::CatmullRom(CatmullRom),
        1e-6,
        [
            1.0, 0.867_188, 0.5625, 0.226_563, 0.0, -0.073_500, -0.023_438, -0.000_049, 0.0,
        ],
    );
    check(
        lanczos(3),
        1e-6,
        [
            1.0, 0.890_067, 0.607_927, 0.270_190, 0.0, -0.142_330, -0.067_791, -0.002_100,
            0.024_317,
        ],
    );
    let radii = all().iter().map(Filter::radius).collect::<Vec<_>>();
    let expected = [
        0.5, 1.0, 2.25, 2.0, 6.8, 2.0, 2.0, 2.0, 2.0, 2.0, 2.0, 1.0, 2.0, 3.0, 6.0, 1.25, 3.0, 4.0,
        2.5,
    ];
    assert_eq!(radii, expected);
}

#[test]
fn densities_integrate_to_one() {
    for filter in all() {
        let ready = PixelFilter::new(filter);
        // Open at the ends: the box's interval is.
        let (from, to) = (-filter.radius() + 1e-12, filter.radius() - 1e-12);
        let total = integral(|x| ready.density(x), from, to, 20_000);
        assert!((total - 1.0).abs() < 1e-8, "{filter}: {total}");
    }
}

/// The distribution of positions, signs included, against quadrature of the filter itself: for
/// every a, Σ weight over samples with offset below a is ∫ f up to a. Deterministic: the unit
/// square is walked on a regular grid, and the grid's own error is 1/N per axis and cut.
/// Rejects: a filter sampled as a box of the same width; a forgotten sign (Σ weight ≠ 1).
#[test]
fn positions_follow_the_filter() {
    const N: u32 = 1024;
    for filter in all() {
        let ready = PixelFilter::new(filter);
        let bins = 64usize;
        let radius = filter.radius();
        let mut x_mass = vec![0.0f64; bins + 1];
        let mut y_mass = vec![0.0f64; bins + 1];
        let weight = f64::from(ready.sample(Vec2::new(0.99, 0.5)).1.abs());
        let bin = |offset: f32| {
            let t = (f64::from(offset) / radius + 1.0) * 0.5;
            assert!((0.0..=1.0).contains(&t), "{filter}: offset {offset}");
            (t * bins as f64) as usize
        };
        for i in 0..N {
            for j in 0..N {
                let u = Vec2::new(i as f32 + 0.5, j as f32 + 0.5) / N as f32;
                let (offset, weight) = ready.sample(u);
                x_mass[bin(offset.x)] += f64::from(weight);
                y_mass[bin(offset.y)] += f64::from(weight);
            }
        }
        let (mut x_sum, mut y_sum) = (0.0, 0.0);
        for k in 0..bins {
            x_sum += x_mass[k] / f64::from(N).powi(2);
            y_sum += y_mass[k] / f64::from(N).powi(2);
            let end = radius * (2.0 * (k as f64 + 1.0) / bins as f64 - 1.0) - 1e-12;
            let expected = integral(|x| ready.density(x), -radius + 1e-12, end, 4000);
            // Eight cuts at most (four intervals, two halves each), half a step each.
            let tolerance = 4.0 * weight / f64::from(N);
            assert!(
                (x_sum - expected).abs() < tolerance,
                "{filter} x {end}: {x_sum} {expected}"
            );
            assert!(
                (y_sum - expected).abs() < tolerance,
                "{filter} y {end}: {y_sum} {expected}"
            );
        }
    }
}

/// All that counts negatively is one interval [0, s) of the first number; the second number
/// does not matter for the sign.
#[test]
fn the_sign_is_one_interval_of_the_first_number() {
    for filter in all() {
        let ready = PixelFilter::new(filter);
        let signs: Vec<bool> = (0..4096)
            .map(|i| {
                let sign = |y| ready.sample(Vec2::new(i as f32 / 4096.0, y)).1 < 0.0;
                assert_eq!(sign(0.0), sign(0.99));
                sign(0.3)
            })
            .collect();
        let negative = signs.iter().filter(|s| **s).count();
        assert!(signs[..negative].iter().all(|s| *s), "{filter}");
        // Σ weight = 1 fixes how many there are.
        let weight = f64::from(ready.sample(Vec2::new(0.999, 0.5)).1.abs());
        let expected = 0.5 * (1.0 - 1.0 / weight) * 4096.0;
        assert!(
            (negative as f64 - expected).abs() <= 1.0,
            "{filter}: {negative} {expected}"
        );
    }
}

/// The tabulated distributions are as near to the true ones as the documentation says: for the
/// whole range of the second number (which never carries a sign cut for these filters), the
/// offset's true cumulative distribution returns the number within single precision's steps.
#[test]
fn tables_invert_the_distribution() {
    for filter in [gaussian(0.5), gaussian(3.0), mitchell(1.0, 0.0), lanczos(1)] {
        let ready = PixelFilter::new(filter);
        let mut sum = 0.0;
        let mut last = -filter.radius();
        for i in 0..=2048 {
            let u = (i as f32 / 2048.0).min(1.0 - f32::EPSILON);
            let x = f64::from(ready.sample(Vec2::new(0.5, u)).0.y);
            assert!(x >= last, "{filter} is not monotone at {u}");
            sum += integral(|x| ready.density(x), last, x, 16);
            last = x;
            assert!((sum - f64::from(u)).abs() < 5e-7, "{filter}: {u} {sum}");
        }
    }
}

#[test]
fn constructors_refuse_what_is_no_filter() {
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(Tent::new(bad).is_none(), "{bad}");
        assert!(Gaussian::new(bad).is_none(), "{bad}");
    }
    assert!(Mitchell::new(f64::NAN, 0.0).is_none());
    assert!(Mitchell::new(0.0, f64::INFINITY).is_none());
    assert!(Lanczos::new(0).is_none());
    assert!(Lanczos::new(65).is_none());
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(WideBox::new(bad).is_none(), "{bad}");
        let mitchell = Mitchell::new(0.3, 0.3).expect("valid");
        assert!(mitchell.stretched(bad).is_none(), "{bad}");
        assert!(
            Lanczos::new(3).expect("valid").cut_at(bad).is_none(),
            "{bad}"
        );
    }
}

/// A stretched cubic is the same at as much of its radius; a windowed sinc goes on beyond its window, and stops.
#[test]
fn radii_of_their_own() {
    for x in [0.0, 0.3, 0.9, 1.4, 2.1] {
        let plain = mitchell(0.2, 0.5).eval(x / 1.5);
        assert!((stretched(3.0).eval(x) - plain).abs() < 1e-12, "{x}");
    }
    let sinc =
        |x: f64| etalon_math::float64::sin(std::f64::consts::PI * x) / (std::f64::consts::PI * x);
    for x in [0.4, 2.2, 3.5] {
        let found = cut(4.0).eval(x);
        assert!((found - sinc(x) * sinc(x / 3.0)).abs() < 1e-12, "{x}");
    }
    assert!(cut(4.0).eval(3.5) > 0.01 && cut(2.5).eval(2.6) == 0.0);
    let wide = Filter::WideBox(WideBox::new(1.25).expect("valid"));
    assert_eq!([wide.eval(1.2), wide.eval(1.3)], [1.0, 0.0]);
    assert_eq!(wide.to_string(), "box radius=1.25");
    assert_eq!(stretched(3.0).to_string(), "mitchell B=0.2 C=0.5 radius=3");
    assert_eq!(cut(4.0).to_string(), "lanczos lobes=3 radius=4");
}
