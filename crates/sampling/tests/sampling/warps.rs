//! Every map of the square against its inverse and its density.
//!
//! Two proofs: sample → invert gives the numbers back, so the map is one to one; and the density
//! is one over the Jacobian, by central differences. Together they say that uniform numbers
//! become points with the stated density.

use crate::evidence::Map;
use etalon_sampling::warps::*;
use glam::{DVec3, Vec2, Vec3};

/// The concentric map's derivative jumps at the square's diagonals and is undefined at its centre.
fn diagonals(u: Vec2) -> bool {
    let p = 2.0 * u - Vec2::ONE;
    (p.x.abs() - p.y.abs()).abs() < 0.03 || p.abs().max_element() < 0.03
}

fn nowhere(_: Vec2) -> bool {
    false
}

fn prove(map: &Map, seam: &dyn Fn(Vec2) -> bool) {
    let name = map.name;
    let error = map.round_trip_error();
    assert!(error < 2e-4, "{name}: round trip off by {error}");
    // Both the curvature of the map, as h², and the rounding of its results, as ε/h, stay below
    // 1 % at h = 1/500; the maps' singular corners and seams are left out by `seam`.
    let error = map.jacobian_error(0.002, seam);
    assert!(error < 0.01, "{name}: density off by {error}");
    // Mutants: a density 2 % too large, and an inverse with its axes exchanged.
    let mutant = Map {
        density: &|p| 1.02 * (map.density)(p),
        invert: &|p| {
            let u = (map.invert)(p);
            Vec2::new(u.y, u.x)
        },
        ..*map
    };
    assert!(mutant.jacobian_error(0.002, seam) > 0.01, "{name}");
    assert!(mutant.round_trip_error() > 2e-4, "{name}");
}

#[test]
fn disk() {
    let map = Map {
        name: "concentric disk",
        sample: &|u| square_to_concentric_disk(u).extend(0.0),
        invert: &|p| concentric_disk_to_square(p.truncate()),
        density: &|_| CONCENTRIC_DISK_DENSITY,
    };
    prove(&map, &diagonals);
}

#[test]
fn hemispheres_and_sphere() {
    let cosine = Map {
        name: "cosine hemisphere",
        sample: &square_to_cosine_hemisphere,
        invert: &cosine_hemisphere_to_square,
        density: &|w| cosine_hemisphere_density(w.z),
    };
    // At the rim the slope of the hemisphere over the disk is unbounded.
    let rim = |u: Vec2| (2.0 * u - Vec2::ONE).abs().max_element() > 0.95;
    prove(&cosine, &|u| diagonals(u) || rim(u));
    let hemisphere = Map {
        name: "uniform hemisphere",
        sample: &square_to_uniform_hemisphere,
        invert: &uniform_hemisphere_to_square,
        density: &|_| UNIFORM_HEMISPHERE_DENSITY,
    };
    prove(&hemisphere, &diagonals);
    let sphere = Map {
        name: "uniform sphere",
        sample: &square_to_uniform_sphere,
        invert: &uniform_sphere_to_square,
        density: &|_| UNIFORM_SPHERE_DENSITY,
    };
    prove(&sphere, &|u| diagonals(u) || rim(u));
}

#[test]
fn cones_of_any_width() {
    for one_minus_cos in [1e-4f32, 0.01, 0.3, 1.0, 1.7] {
        let map = Map {
            name: "uniform cone",
            sample: &|u| square_to_uniform_cone(u, one_minus_cos),
            invert: &|w| uniform_cone_to_square(w, one_minus_cos),
            density: &|_| uniform_cone_density(one_minus_cos),
        };
        prove(&map, &diagonals);
    }
}

#[test]
fn even_the_narrowest_cone_has_unit_directions_within() {
    for one_minus_cos in [1e-30f32, 1e-12, 1e-7, 1e-3, 2.0] {
        for i in 0..1000 {
            let u = Vec2::new(i as f32 / 1000.0, (i * 37 % 1000) as f32 / 1000.0);
            let w = square_to_uniform_cone(u, one_minus_cos);
            assert!((w.length() - 1.0).abs() < 3e-7);
            let sin_squared = w.truncate().length_squared();
            assert!(sin_squared <= one_minus_cos * (2.0 - one_minus_cos).max(1.0) * 1.000_001);
            assert!(w.z >= 1.0 - one_minus_cos - 1e-6);
        }
    }
}

#[test]
fn triangle() {
    let map = Map {
        name: "triangle",
        sample: &|u| square_to_triangle(u).extend(0.0),
        invert: &|p| triangle_to_square(p.truncate()),
        density: &|_| triangle_density(0.5),
    };
    prove(&map, &|u| (u.x - u.y).abs() < 0.02);
    for i in 0..10_000 {
        let u = Vec2::new((i % 100) as f32, (i / 100) as f32) / 100.0;
        let b = square_to_triangle(u);
        assert!(b.min_element() >= 0.0 && b.x + b.y <= 1.0);
    }
}

#[test]
fn sphere_seen_from_outside() {
    for (center, radius) in [
        (Vec3::new(1.0, 2.0, 3.0), 0.5),
        (Vec3::new(0.0, 0.0, -1.0), 0.999),
        (Vec3::new(30.0, -40.0, 0.0), 1.0),
    ] {
        let cone = SphereCone::<f32>::new(center, radius);
        assert!(cone.exists);
        let map = Map {
            name: "sphere cone",
            sample: &|u| cone.sample(u.to_array()),
            invert: &|w| cone.invert(w),
            density: &|_| cone.density(),
        };
        prove(&map, &diagonals);
        for i in 0..1000 {
            // The line in a sampled direction passes the centre at no more than the radius.
            let w = cone.sample([(i % 40) as f32 / 40.0, (i / 40) as f32 / 25.0]);
            assert!(center.cross(w).length() <= radius * 1.000_01);
            assert!(center.dot(w) > 0.0);
        }
    }
    assert!(!SphereCone::<f32>::new(Vec3::X, 1.0).exists);
    assert!(!SphereCone::<f32>::new(Vec3::X, 1.5).exists);
    assert!(!SphereCone::<f32>::new(Vec3::ZERO, 1.0).exists);
}

#[test]
fn directions_of_the_cosine_hemisphere_never_lie_on_the_horizon() {
    let last = 1.0 - 1.0 / (1 << 24) as f32;
    for u in [0.0, 0.25, 0.5, 0.75, last] {
        for u in [Vec2::new(0.0, u), Vec2::new(u, 0.0), Vec2::new(last, u)] {
            let w = square_to_cosine_hemisphere(u);
            assert!(cosine_hemisphere_density(w.z) > 0.0);
            assert!((w.length() - 1.0).abs() < 2e-7, "{u} {w}");
        }
    }
}

#[test]
fn line_maps_are_their_densities() {
    type Line = (&'static str, fn(f32) -> f32, fn(f32) -> f32, fn(f32) -> f32);
    let lines: [Line; 5] = [
        ("tent", interval_to_tent, tent_to_interval, tent_density),
        (
            "linear 1..3",
            |u| interval_to_linear(u, 1.0, 3.0),
            |x| linear_to_interval(x, 1.0, 3.0),
            |x| linear_density(x, 1.0, 3.0),
        ),
        (
            "linear 2..0",
            |u| interval_to_linear(u, 2.0, 0.0),
            |x| linear_to_interval(x, 2.0, 0.0),
            |x| linear_density(x, 2.0, 0.0),
        ),
        (
            "linear 0..1",
            |u| interval_to_linear(u, 0.0, 1.0),
            |x| linear_to_interval(x, 0.0, 1.0),
            |x| linear_density(x, 0.0, 1.0),
        ),
        (
            "constant",
            |u| interval_to_linear(u, 5.0, 5.0),
            |x| linear_to_interval(x, 5.0, 5.0),
            |x| linear_density(x, 5.0, 5.0),
        ),
    ];
    for (name, sample, invert, density) in lines {
        assert!(sample(0.0).is_finite());
        for i in 20..980 {
            let u = i as f32 / 1000.0 + 3e-4;
            let x = sample(u);
            assert!((invert(x) - u).abs() < 1e-6, "{name} at {u}");
            let slope = (sample(u + 1e-3) - sample(u - 1e-3)) / 2e-3;
            if (u - 0.5).abs() > 2e-3 {
                assert!((density(x) * slope - 1.0).abs() < 5e-3, "{name} at {u}");
            }
        }
    }
}

#[test]
fn the_normal_distribution() {
    // Φ and its inverse: published values (Abramowitz & Stegun 26.5) and each other.
    for (x, p) in [
        (0.0, 0.5),
        (1.0, 0.841_344_746_068_542_9),
        (1.959_963_984_540_054, 0.975),
        (-3.0, 0.001_349_898_031_630_094_5),
    ] {
        assert!((normal_cdf(x) - p).abs() < 1e-15);
        assert!((inverse_normal_cdf(p) - x).abs() < 1e-13);
    }
    for i in 1..400 {
        // Down to 10⁻¹⁰⁰, relative to the tail.
        let p = etalon_math::float64::exp(-f64::from(i) * 0.575);
        let back = normal_cdf(inverse_normal_cdf(p));
        assert!((back / p - 1.0).abs() < 1e-11, "{p}: {back}");
        assert_eq!(inverse_normal_cdf(1.0 - 0.25), -inverse_normal_cdf(0.25));
    }
    assert_eq!(inverse_normal_cdf(0.0), f64::NEG_INFINITY);
    assert_eq!(inverse_normal_cdf(1.0), f64::INFINITY);
    // Box and Muller: the density in the plane is the product of two.
    let map = Map {
        name: "normal",
        sample: &|u| square_to_normal(u).extend(0.0),
        invert: &|_| Vec2::ZERO,
        density: &|p| standard_normal_density(p.x) * standard_normal_density(p.y),
    };
    let edges = |u: Vec2| u.x < 0.05 || u.x > 0.95;
    assert!(map.jacobian_error(0.002, &edges) < 0.01);
    let shifted = normal_density(3.5, 1.5, 2.0);
    assert!((shifted - 0.5 * standard_normal_density(1.0)).abs() < 1e-8);
}

/// Triangles and rectangles of every kind, seen from the origin.
fn triangles() -> Vec<[Vec3; 3]> {
    vec![
        [Vec3::X, Vec3::Y, Vec3::Z],
        [Vec3::Z, Vec3::Y, Vec3::X],
        [
            Vec3::new(-0.5, -0.5, 2.0),
            Vec3::new(0.5, -0.5, 2.0),
            Vec3::new(0.1, 0.7, 2.5),
        ],
        // Large: the origin is close to its plane, and over its middle.
        [
            Vec3::new(-1.0, -1.0, 0.2),
            Vec3::new(2.0, -1.0, 0.2),
            Vec3::new(-1.0, 2.0, 0.2),
        ],
        // Small, and not near any axis.
        [
            Vec3::new(10.0, 20.0, 30.0),
            Vec3::new(10.1, 20.0, 30.0),
            Vec3::new(10.0, 20.1, 30.05),
        ],
        // Grazing.
        [
            Vec3::new(1.0, 0.0, 0.01),
            Vec3::new(3.0, 0.5, 0.01),
            Vec3::new(2.0, -1.0, 0.01),
        ],
    ]
}

#[test]
fn spherical_triangles() {
    for corners in triangles() {
        let triangle =
            SphericalTriangle::new(corners.map(Vec3::as_dvec3)).expect("well-conditioned");
        let name = format!("spherical triangle {corners:?}");
        let size = triangle.solid_angle().sqrt().min(1.0);
        let map = Map {
            name: &name,
            sample: &|u| triangle.sample(u),
            invert: &|w| triangle.invert(w),
            density: &|_| triangle.density(),
        };
        if size > 0.05 {
            // At the corner a distances go as √u.y.
            prove(&map, &|u| u.y < 0.02);
        } else {
            // Directions themselves are rounded to 6e-8, a part of the triangle's width.
            assert!(
                map.round_trip_error() < 1e-6 / size / size.min(0.1) + 1e-3,
                "{name}"
            );
        }
        for i in 0..400 {
            let u = Vec2::new((i % 20) as f32, (i / 20) as f32) / 19.0;
            let w = triangle.sample(u);
            assert!((w.length() - 1.0).abs() < 3e-7);
            let b = triangle.barycentric(w);
            let [p, q, r] = corners;
            let point = p * (1.0 - b.x - b.y) + q * b.x + r * b.y;
            assert!(b.min_element() >= 0.0 && b.x + b.y <= 1.000_001);
            assert!(
                point.normalize().distance(w) < 2e-6,
                "{name}, {u}: {point} is not at {w}"
            );
        }
    }
    // An octant is π/2; turning it over changes nothing.
    let octant = SphericalTriangle::new([DVec3::Y, DVec3::X, DVec3::Z]).expect("an octant");
    assert!((octant.solid_angle() - core::f32::consts::FRAC_PI_2).abs() < 1e-6);
    // In the triangle's plane, at a corner, and far away.
    let flat = [DVec3::X, DVec3::Y, DVec3::new(2.0, 3.0, 0.0)];
    assert!(SphericalTriangle::new(flat).is_none());
    assert!(SphericalTriangle::new([DVec3::ZERO, DVec3::X, DVec3::Y]).is_none());
    let far = [DVec3::X, DVec3::Y, DVec3::Z].map(|corner| corner + 1e4);
    assert!(SphericalTriangle::new(far).is_none());
}

#[test]
fn spherical_rectangles() {
    let turn = |v: Vec3| glam::Quat::from_xyzw(0.5, 0.1, -0.3, 0.8).normalize() * v;
    for (corner, size) in [
        (Vec3::new(-0.5, -0.5, -1.0), Vec2::ONE),
        (Vec3::new(-0.5, 0.3, 1.0), Vec2::new(2.0, 0.5)),
        (Vec3::new(1.0, 2.0, 0.5), Vec2::new(0.3, 3.0)),
        (Vec3::new(-3.0, -2.0, -0.1), Vec2::new(4.0, 5.0)),
        (Vec3::new(0.0, 0.0, 1.0), Vec2::ONE),
        (Vec3::new(-4.0, -6.0, 1.0), Vec2::new(2.0, 3.0)),
        (Vec3::new(10.0, 20.0, 30.0), Vec2::new(0.2, 0.1)),
        (Vec3::new(-2.0, 5.0, 0.05), Vec2::new(4.0, 9.0)),
    ] {
        let edges = [turn(Vec3::X * size.x), turn(Vec3::Y * size.y)];
        let rectangle = SphericalRectangle::new(turn(corner), edges).expect("well-conditioned");
        let name = format!("spherical rectangle {corner} {size}");
        let map = Map {
            name: &name,
            sample: &|u| rectangle.sample(u),
            invert: &|w| rectangle.invert(w),
            density: &|_| rectangle.density(),
        };
        if rectangle.solid_angle() > 0.002 {
            prove(&map, &nowhere);
        } else {
            assert!(map.round_trip_error() < 1e-2, "{name}");
        }
        for i in 0..400 {
            let u = Vec2::new((i % 20) as f32, (i / 20) as f32) / 19.0;
            let position = rectangle.sample_position(u);
            assert!(position.min_element() >= 0.0 && position.max_element() <= 1.0);
            let back = rectangle.invert_position(position);
            assert!(back.distance(u) < 3e-4, "{name}, {u}: {back}");
        }
    }
    let in_plane = SphericalRectangle::new(Vec3::X, [Vec3::X, Vec3::Y]);
    assert!(in_plane.is_none());
    let cube_face = SphericalRectangle::new(Vec3::splat(-0.5), [Vec3::X, Vec3::Y]);
    let sixth = 4.0 * core::f32::consts::PI / 6.0;
    assert!((cube_face.expect("a face").solid_angle() - sixth).abs() < 1e-6);
}
