//! Sensors that measure one number.

use super::*;
use core::f64::consts::PI;
use etalon_sampling::{Independent, Sampler};
use etalon_transport::Camera;

const ONE: FilmWindow = FilmWindow {
    size: UVec2::ONE,
    origin: UVec2::ZERO,
    crop: UVec2::ONE,
};

fn vector(name: &'static str, value: [f64; 3]) -> (&'static str, Value) {
    (name, Value::Vector(value.into()))
}

/// Mitsuba 3.9.1's `sensor.sample_ray`: the ray from `origin` along `direction`, without end.
#[test]
fn a_radiance_meter_has_one_ray() {
    let given = [
        vector("origin", [1.0, 2.0, 3.0]),
        vector("direction", [0.0, 0.0, -2.0]),
    ];
    let placed = [placed(look_at() * DMat4::from_scale(DVec3::splat(3.0)))];
    for (properties, origin, direction) in [
        (&given[..], Vec3::new(1.0, 2.0, 3.0), Vec3::NEG_Z),
        (
            &placed[..],
            Vec3::new(1.0, 2.0, 3.0),
            look_at().z_axis.truncate().as_vec3(),
        ),
        (&[], Vec3::ZERO, Vec3::Z),
    ] {
        let meter = camera("radiancemeter", properties, ONE);
        let start = meter.ray(Vec2::splat(0.3), Vec2::splat(0.9), 0.25);
        assert_eq!(
            (start.weight, start.ray.time, start.ray.t_max),
            (1.0, 0.25, f32::INFINITY)
        );
        assert!(start.ray.origin.distance(origin) < 1e-6);
        assert!(start.ray.direction.distance(direction) < 1e-6);
        assert!(!meter.has_lens() && !meter.can_connect() && meter.is_meter());
    }
}

/// ∫ cos² θ dω over the hemisphere is 2π/3: the mean of weight · cos θ, whose terms have a standard deviation of 0.74, within four standard errors
/// (α = 6·10⁻⁵); uniform directions would give π/2. Each of two pixels has its half of the square.
#[test]
fn an_irradiance_meter_weighs_by_the_cosine() {
    const COUNT: usize = 40_000;
    let window = FilmWindow::whole(UVec2::new(2, 1));
    let (meter, messages) = read_node(&node("irradiancemeter", &[]), window, Some(Square));
    assert!(messages.is_empty(), "{messages:?}");
    let meter = meter.expect("a meter");
    let mut random = Independent::from_key(3);
    let (mut sum, mut right) = (0.0, 0);
    for _ in 0..COUNT {
        let raster = Vec2::new(2.0, 1.0) * random.next_2d();
        let start = meter.ray(raster, random.next_2d(), 0.0);
        sum += f64::from(start.weight * start.ray.direction.z);
        let origin = start.ray.origin;
        assert_eq!(origin.x > 1.0, raster.x > 1.0);
        right += usize::from(origin.x > 1.0);
        assert!(start.ray.direction.z >= 0.0 && origin.z >= 1.0 && origin.y <= 2.0);
    }
    let error = 4.0 * 0.74 / (COUNT as f64).sqrt();
    assert!((sum / COUNT as f64 - 2.0 * PI / 3.0).abs() < error);
    assert!(right.abs_diff(COUNT / 2) < 400);
    // A filter that reaches beyond the film stays on the surface.
    let beyond = meter
        .ray(Vec2::new(-1.0, 9.0), Vec2::splat(0.5), 0.0)
        .ray
        .origin;
    assert!(beyond.truncate().abs_diff_eq(Vec2::new(0.0, 2.0), 1e-5));
}

/// Distances of rays from the axis of the bounding sphere are those of a uniform disk: the mean of their squares is R²/2, its standard
/// deviation R²/√12 (four standard errors, α = 6·10⁻⁵); all start outside of the box. Mitsuba weighs them with 1, too.
#[test]
fn a_distant_sensor_looks_at_all_or_at_its_target() {
    let bounds = [Vec3::new(-1.0, -2.0, 0.0), Vec3::new(3.0, 2.0, 2.0)];
    let (centre, squared) = (Vec3::new(1.0, 0.0, 1.0), 9.0);
    let direction = Vec3::new(1.0, -2.0, -2.0) / 3.0;
    let along = vector("direction", [1.0, -2.0, -2.0]);
    let sensor = |target: Option<(&'static str, Value)>| {
        let properties: Vec<_> = [along.clone()].into_iter().chain(target).collect();
        let mut sensor = camera("distant", &properties, ONE);
        sensor.surround(bounds);
        sensor
    };
    let all = sensor(None);
    let mut random = Independent::from_key(4);
    const COUNT: usize = 40_000;
    let mut sum = 0.0;
    for _ in 0..COUNT {
        let start = all.ray(Vec2::splat(0.5), random.next_2d(), 0.0);
        assert!(start.weight == 1.0 && start.ray.direction.distance(direction) < 1e-6);
        let from = start.ray.origin - centre;
        assert!(from.length_squared() > squared);
        sum += f64::from(from.cross(direction).length_squared());
    }
    let error = 4.0 * f64::from(squared) / (12.0 * COUNT as f64).sqrt();
    assert!((sum / COUNT as f64 - 4.5).abs() < error);
    let meets = |sensor: &AnyCamera, lens, point: Vec3| {
        let ray = sensor.ray(Vec2::splat(0.5), lens, 0.0).ray;
        let way = point - ray.origin;
        way.cross(ray.direction).length() < 1e-5 && way.dot(ray.direction) > 0.0
    };
    let point = sensor(Some(vector("target", [0.5, 1.0, 1.5])));
    assert!(meets(&point, Vec2::ZERO, Vec3::new(0.5, 1.0, 1.5)) && !point.has_lens());
    let shape = Node {
        class: Class::Shape,
        ..node("rectangle", &[])
    };
    let surface = sensor(Some(("target", Value::Object(Arc::new(shape)))));
    assert!(meets(&surface, Vec2::new(0.1, 0.7), Vec3::new(0.2, 1.4, 1.0)) && surface.has_lens());
}

#[test]
fn mistakes_of_meters_are_refused() {
    let origin = || vector("origin", [1.0, 0.0, 0.0]);
    let direction = || vector("direction", [1.0, 0.0, 0.0]);
    for (plugin, properties, expected) in [
        (
            "radiancemeter",
            vec![origin()],
            "needs the parameter `direction`",
        ),
        (
            "radiancemeter",
            vec![direction()],
            "needs the parameter `origin`",
        ),
        (
            "radiancemeter",
            vec![origin(), direction(), placed(look_at())],
            "not both",
        ),
        (
            "radiancemeter",
            vec![origin(), vector("direction", [0.0; 3])],
            "`direction` of `radiancemeter` cannot be (0, 0, 0)",
        ),
        ("distant", vec![direction(), placed(look_at())], "not both"),
        (
            "distant",
            vec![vector("target", [f64::NAN, 0.0, 0.0])],
            "must be finite",
        ),
        ("distant", vec![origin()], "no parameter `origin`"),
        (
            "distant",
            vec![number("near_clip", 1.0)],
            "no parameter `near_clip`",
        ),
    ] {
        let (_, messages) = read(plugin, &properties, ONE);
        assert!(
            matches!(&messages[..], [message] if message.contains(expected)),
            "{plugin} {expected}: {messages:?}"
        );
    }
    let (_, messages) = read_node(&node("perspective", &[]), ONE, Some(Square));
    assert!(
        messages[0].contains("stands in the scene, not in a shape"),
        "{messages:?}"
    );
}
