//! Densities of sampled points: they integrate to one, they are the densities that sampling has,
//! and areas are right.

use crate::things::{Random, convex_shapes, geometry_of, mesh_of, moved};
use core::f64::consts::PI;
use etalon_geometry::shapes::{disk::Disk, rectangle::Rectangle};
use etalon_geometry::{Geometry, Placement, Shape};
use etalon_math::Frame;
use etalon_sampling::warps::{square_to_uniform_cone, uniform_cone_to_square};
use etalon_transport::{LightSampleContext, Ray, ShapeId, Shapes, SurfacePoint};
use glam::{DVec3, Vec2, Vec3};

const ID: ShapeId = ShapeId(0);

/// An open bowl of a few triangles of different sizes, so that they hide nothing of each other.
fn bowl() -> Shape {
    let rim = [
        (1.0, 0.0),
        (0.3, 0.8),
        (-0.9, 0.5),
        (-0.5, -0.7),
        (0.4, -0.6),
    ];
    let mut positions = vec![Vec3::ZERO];
    positions.extend(rim.map(|(x, y)| Vec3::new(x, y, 0.4)));
    let triangles = (0..5).map(|i| [0, 1 + i, 1 + (i + 1) % 5]).collect();
    mesh_of(positions, triangles)
}

/// Shapes and receivers that see all that can be chosen of them. Where the choice depends on the
/// receiver's surface, the first is on none, the second faces some of the shape and turns away
/// from the rest, the third faces all of it.
fn views() -> Vec<(String, Geometry, LightSampleContext)> {
    let mut views = Vec::new();
    let observers = [
        (Vec3::new(0.3, 0.2, 2.0), Vec3::ZERO),
        (Vec3::new(-1.5, 2.5, 4.0), Vec3::new(0.86, 0.51, 0.0)),
        (Vec3::new(0.1, -0.2, 0.9), Vec3::new(0.3, -0.2, -0.9)),
    ];
    for (i, (position, normal)) in observers.into_iter().enumerate() {
        let from = LightSampleContext::on_surface(position, normal.normalize_or_zero());
        let mut add = |name: &str, shape: Shape| {
            let name = format!("{name} from {position}");
            views.push((name, geometry_of([shape]), from));
        };
        add("bowl", bowl());
        let flat = |scale: Vec3| moved(Vec3::new(0.1, 0.0, -0.1), 0.4, scale);
        add(
            "rectangle",
            Shape::Rectangle(
                Rectangle::new(&flat(Vec3::new(0.7, 0.4, 1.0)), false).expect("finite"),
            ),
        );
        add(
            "disk",
            Shape::Disk(Disk::new(&flat(Vec3::new(0.6, 0.5, 1.0)), false).expect("finite")),
        );
        let mut sheared = etalon_params::DMat4::IDENTITY;
        sheared.y_axis.x = 0.6;
        let sheared = Placement::from_matrix(&sheared).expect("invertible");
        add(
            "parallelogram",
            Shape::Rectangle(Rectangle::new(&sheared, false).expect("finite")),
        );
        let sphere = convex_shapes(Vec3::new(0.0, 0.0, -0.4), 0.3, 0.9)
            .swap_remove(0)
            .1;
        add("sphere", sphere);
        if i == 2 {
            let around = convex_shapes(Vec3::new(0.2, 0.0, 0.3), 0.3, 1.5)
                .swap_remove(0)
                .1;
            add("sphere from inside", around);
        }
    }
    views
}

/// A cone of directions that holds the shape, or all directions from within its bounding sphere.
struct Region {
    frame: Frame,
    one_minus_cos: f32,
}

impl Region {
    fn of(geometry: &Geometry, from: Vec3) -> Self {
        let center = geometry.bounds().center();
        let radius = 1.001 * (geometry.bounds().max - center).length();
        let to = center - from;
        let distance = to.length();
        // Off centre, lest a round outline run along the rows of cells; and wider by as much.
        let radius = radius + 0.2 * distance;
        let tilted = to / distance + Vec3::new(0.05, 0.08, -0.07);
        let one_minus_cos = if distance > radius {
            1.0 - (1.0 - (radius / distance).powi(2)).sqrt()
        } else {
            2.0
        };
        Self {
            frame: Frame::from_normal(tilted.normalize()),
            one_minus_cos,
        }
    }

    /// The density of chosen points over the midpoints of n² equal cells of directions, times
    /// the solid angle of a cell.
    fn for_each(
        &self,
        geometry: &Geometry,
        from: &LightSampleContext,
        n: u32,
        mut each: impl FnMut(Vec2, f64),
    ) {
        let share = 2.0 * PI * f64::from(self.one_minus_cos) / f64::from(n * n);
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let u = (Vec2::new(i as f32, j as f32) + 0.5) / n as f32;
            let direction = square_to_uniform_cone(u, self.one_minus_cos);
            let ray = Ray::new(from.position, self.frame.to_world(direction), 0.0);
            if let Some(hit) = geometry.intersect(&ray) {
                let vertex = geometry.vertex(&ray, &hit);
                let density = geometry.density_toward(ID, from, &SurfacePoint::from(&vertex));
                each(u, f64::from(density) * share);
            }
        }
    }

    fn square(&self, direction: Vec3) -> Vec2 {
        uniform_cone_to_square(self.frame.to_local(direction), self.one_minus_cos)
    }
}

/// ∫ p(ω) dω over all directions is one: by 700² stratified directions. The
/// error is that of the strata on the shape's outline, below 0.5 %; a density off by the usual
/// factors (2, π, a cosine) is refused.
#[test]
fn densities_integrate_to_one() {
    for (name, geometry, from) in views() {
        let mut integral = 0.0;
        let region = Region::of(&geometry, from.position);
        region.for_each(&geometry, &from, 700, |_, share| integral += share);
        assert!((integral - 1.0).abs() < 0.005, "{name}: {integral}");
    }
}

/// What is sampled has the density it says: `density_toward` at the sampled point is the density
/// returned, and a χ² test of directions against the density integrated over cells.
///
/// α = 10⁻⁴ for each of 16 views (5 shapes from 3 places and one from inside), so a false alarm
/// in one of 600 runs of another seed; the seed is fixed. Mutant refused: sampling a rectangle
/// by area with the density of the solid angle.
#[test]
fn samples_follow_their_density() {
    for (name, geometry, from) in views() {
        let mut random = Random(41);
        let cells = 24;
        let samples = 40_000;
        let mut counts = vec![0u32; cells * cells];
        let region = Region::of(&geometry, from.position);
        let cell = |u: Vec2| {
            let at = |x: f32| ((x * cells as f32) as usize).min(cells - 1);
            at(u.x) * cells + at(u.y)
        };
        for _ in 0..samples {
            let point = geometry
                .sample_toward(ID, &from, random.square())
                .expect("seen");
            let again = geometry.density_toward(ID, &from, &point.point);
            assert!(
                (again - point.density).abs() <= 2e-3 * point.density
                    || near_outline(&name, from.position, &point.point),
                "{name}: {again} {}",
                point.density
            );
            let direction = (point.point.position - from.position).normalize();
            counts[cell(region.square(direction))] += 1;
        }
        // The expected counts, by 50² directions per cell.
        let mut expected = vec![0.0f64; cells * cells];
        region.for_each(&geometry, &from, 50 * cells as u32, |u, share| {
            expected[cell(u)] += share * f64::from(samples);
        });
        let (mut statistic, mut degrees) = (0.0, 0i32);
        let (mut rest, mut rest_expected) = (0.0, 0.0);
        for (&count, &expected) in counts.iter().zip(&expected) {
            if expected < 40.0 {
                rest += f64::from(count);
                rest_expected += expected;
            } else {
                statistic += (f64::from(count) - expected).powi(2) / expected;
                degrees += 1;
            }
        }
        if rest_expected > 5.0 {
            statistic += (rest - rest_expected).powi(2) / rest_expected;
            degrees += 1;
        }
        let degrees = f64::from(degrees - 1).max(1.0);
        // Wilson & Hilferty's normal approximation of χ²; 3.72 is the 1 − 10⁻⁴ quantile.
        let third = 2.0 / (9.0 * degrees);
        let z = (etalon_math::float64::cbrt(statistic / degrees) - (1.0 - third)) / third.sqrt();
        assert!(
            z < 3.72,
            "{name}: χ² = {statistic} with {degrees} degrees of freedom"
        );
    }
}

/// A sphere's outline as seen from outside: rounding decides which side a point is on.
fn near_outline(name: &str, from: Vec3, at: &SurfacePoint) -> bool {
    name.starts_with("sphere from (")
        || name.starts_with("sphere from [")
            && at.normal.dot((from - at.position).normalize()).abs() < 1e-3
}

#[test]
fn areas_are_right() {
    let sizes = Vec3::new(2.0, 0.5, 1.5);
    let p = moved(Vec3::new(5.0, 6.0, 7.0), 0.8, sizes);
    let close = |a: f32, b: f64| assert!((f64::from(a) / b - 1.0).abs() < 1e-6, "{a} {b}");
    let area = |shape: Shape| geometry_of([shape]).area(ID, 0.0);
    close(
        area(Shape::Rectangle(Rectangle::new(&p, false).expect("finite"))),
        4.0,
    );
    close(area(Shape::Disk(Disk::new(&p, false).expect("finite"))), PI);
    let cube = etalon_geometry::shapes::cube::cube(&p, false).expect("finite");
    close(
        area(Shape::Mesh(cube)),
        8.0 * (2.0 * 0.5 + 0.5 * 1.5 + 1.5 * 2.0),
    );
    let mut round = convex_shapes(Vec3::ONE, 0.4, 3.0);
    close(area(round.swap_remove(0).1), 36.0 * PI);
    let length = DVec3::new(0.2, 0.1, 1.5).length() * 3.0;
    // swap_remove put the last shape first; the cylinder is still second.
    close(area(round.swap_remove(1).1), 2.0 * PI * 1.8 * length);
}

#[test]
fn points_are_uniform_by_area() {
    // Means of position over each shape against its centroid: four standard errors of 10⁵ points
    // (α = 6·10⁻⁵ each, 18 coordinates). Mutant refused: corners of triangles weighted alike
    // (square-root warp left out).
    let mut random = Random(43);
    for (name, shape) in convex_shapes(Vec3::new(1.0, 2.0, 3.0), 0.4, 0.5) {
        let geometry = geometry_of([shape]);
        let count = 100_000;
        let (mut sum, mut squares) = (DVec3::ZERO, DVec3::ZERO);
        for _ in 0..count {
            let point = geometry.sample_area(ID, random.square(), 0.0);
            let density = f64::from(point.density) * f64::from(geometry.area(ID, 0.0));
            assert!((density - 1.0).abs() < 1e-6, "{name}");
            let p = point.point.position.as_dvec3() - DVec3::new(1.0, 2.0, 3.0);
            sum += p;
            squares += p * p;
        }
        let mean = sum / f64::from(count);
        let variance = squares / f64::from(count) - mean * mean;
        let centroid = if name == "cylinder" {
            let turn = moved(Vec3::ZERO, 0.4, Vec3::splat(0.5));
            turn.point(DVec3::new(0.2, 0.1, 1.5) * 0.5)
        } else {
            DVec3::ZERO
        };
        for axis in 0..3 {
            let error = (variance[axis] / f64::from(count)).sqrt();
            let off = (mean[axis] - centroid[axis]).abs();
            assert!(off < 4.0 * error + 1e-6, "{name}: {mean} {centroid}");
        }
    }
}
