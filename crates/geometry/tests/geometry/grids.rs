//! Functions on a grid: how they are shaded. Where they are met: [`crate::solids`].

use crate::files::volume_function;
use crate::solids::built;
use crate::things::{Random, geometry_of};
use etalon_params::{DVec3, Value};
use etalon_transport::Ray;
use glam::Vec3;

/// A grid's smooth normals are those of the function that it samples, nearly; for shading only.
#[test]
fn a_grid_is_smooth() {
    let grid = |normals: &str| {
        let file = ("filename", Value::String("volume".into()));
        let normals = ("normals", Value::String(normals.into()));
        geometry_of([built("sdfgrid", vec![file, normals])])
    };
    let (smooth, flat) = (grid("smooth"), grid("analytic"));
    let mut random = Random(4);
    let mut off = [0.0; 2];
    for _ in 0..2000 {
        let origin = random.point() * 2.0;
        let target = Vec3::splat(0.5) + random.point() * 0.2;
        let ray = Ray::new(origin, (target - origin).normalize(), 0.0);
        let (Some(a), Some(b)) = (smooth.intersect(&ray), flat.intersect(&ray)) else {
            continue;
        };
        assert_eq!(a.t, b.t);
        let (a, b) = (smooth.vertex(&ray, &a), flat.vertex(&ray, &b));
        assert_eq!(a.normal, b.normal);
        assert!(b.shading.n.dot(b.normal) > 0.9999);
        let p = a.position.as_dvec3();
        let slope =
            |axis: DVec3| volume_function(p + axis * 1e-4) - volume_function(p - axis * 1e-4);
        let true_normal = DVec3::from(DVec3::AXES.map(slope)).normalize();
        for (sum, normal) in off.iter_mut().zip([a.shading.n, b.shading.n]) {
            *sum += true_normal.angle_between(normal.as_dvec3());
        }
    }
    assert!(off[0] < 0.7 * off[1], "{off:?}");
}
