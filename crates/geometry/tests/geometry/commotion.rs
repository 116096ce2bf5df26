//! Every accelerator against the linear scan where things move: the same hits, to the last bit.

use crate::accelerators::{agree, every};
use crate::things::{Random, convex_shapes, icosphere, mesh_of};
use etalon_geometry::{GeometryBuilder, Placement};
use etalon_math::{Animated, Interpolation, Motion, MotionKey};
use etalon_transport::{MaterialId, Ray};
use glam::{DMat4, DQuat, Vec3};

/// Instances that swing and tumble while the shutter is open, among some that do not.
fn commotion(builder: &mut GeometryBuilder) {
    let mut random = Random(21);
    let (positions, triangles) = icosphere(2);
    let group = builder.add_group(
        convex_shapes(Vec3::ZERO, 0.2, 0.6)
            .into_iter()
            .map(|(_, shape)| (shape, MaterialId(1)))
            .chain([(mesh_of(positions, triangles), MaterialId(2))]),
    );
    for i in 0..40 {
        let mut matrix = |turned: f64| {
            let scale = Vec3::splat(0.3) + random.point().abs() * 0.5;
            DMat4::from_scale_rotation_translation(
                scale.as_dvec3(),
                DQuat::from_rotation_y(turned) * DQuat::from_rotation_x(f64::from(i)),
                (random.point() * 4.0).as_dvec3(),
            )
        };
        let kinds = [
            Interpolation::Linear,
            Interpolation::CatmullRom,
            Interpolation::Step,
        ];
        let keys = [0.0, 0.4, 1.0].map(|time| MotionKey::from((time, matrix(2.0 * time))));
        match kinds.get(i as usize % 4) {
            Some(&kind) => {
                let motion = Motion::new(kind, &keys).expect("invertible");
                builder.add_instance(group, Animated::<Placement>::new(motion));
            }
            None => {
                let still = Placement::from_matrix(&matrix(0.0)).expect("invertible");
                builder.add_instance(group, still);
            }
        }
    }
}

#[test]
fn what_moves_is_hit_alike() {
    let pair = every(commotion);
    let mut random = Random(6);
    let mut hits = 0;
    for _ in 0..3000 {
        let ray = Ray::new(random.point() * 6.0, random.direction(), random.number());
        hits += u32::from(agree(&pair, &ray));
    }
    assert!(hits > 300, "{hits}");
}
