//! Rays per second through 1.3 million triangles, by every accelerator, and through the Cornell box, and the time and
//! memory it takes to build them.
//!
//! ```text
//! cargo bench -p etalon-benches --bench traversal [-- LEVEL]
//! ```
//!
//! The mesh is an icosphere displaced by a sum of waves, subdivided LEVEL times (default 8: 20·4⁸ =
//! 1,310,720 triangles). Each kind of ray is timed several times on one thread and on all, and
//! the best time counts, for the machine may be shared. Bounce rays leave the primary hits in
//! cosine-distributed directions; "shuffled" are the same in random order; "random" connect random
//! points around the mesh; "shadow" ask only whether anything is hit.

use etalon_geometry::shapes::mesh::{Mesh, MeshOptions};
use etalon_geometry::{AcceleratorKind, Geometry, GeometryBuilder, Placement, Shape};
use etalon_math::{DMat4, DVec3, Frame, Vec2, Vec3, float};
use etalon_sampling::warps::square_to_cosine_hemisphere;
use etalon_transport::{LightId, MaterialId, MeshData, Ray};
use rayon::prelude::*;
use std::collections::HashMap;
use std::time::Instant;

const REPEATS: usize = 5;
const SIDE: usize = 1024;

/// Uniform numbers from a counter.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f32 {
        // SplitMix64 (Steele, Lea & Flood 2014).
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 40) as f32 / (1u64 << 24) as f32
    }

    fn square(&mut self) -> Vec2 {
        Vec2::new(self.next(), self.next())
    }

    fn point(&mut self, reach: f32) -> Vec3 {
        (Vec3::new(self.next(), self.next(), self.next()) * 2.0 - 1.0) * reach
    }
}

/// A unit icosphere, subdivided, pushed in and out by waves of several lengths.
fn displaced_sphere(level: u32) -> MeshData {
    let golden = 0.5 * (1.0 + 5f32.sqrt());
    let mut positions: Vec<Vec3> = Vec::new();
    for (a, b) in [
        (-1.0, golden),
        (1.0, golden),
        (-1.0, -golden),
        (1.0, -golden),
    ] {
        positions.push(Vec3::new(a, b, 0.0).normalize());
    }
    for (a, b) in [
        (-1.0, golden),
        (1.0, golden),
        (-1.0, -golden),
        (1.0, -golden),
    ] {
        positions.push(Vec3::new(0.0, a, b).normalize());
    }
    for (a, b) in [
        (-1.0, golden),
        (1.0, golden),
        (-1.0, -golden),
        (1.0, -golden),
    ] {
        positions.push(Vec3::new(b, 0.0, a).normalize());
    }
    let mut triangles: Vec<[u32; 3]> = vec![
        [0, 11, 5],
        [0, 5, 1],
        [0, 1, 7],
        [0, 7, 10],
        [0, 10, 11],
        [1, 5, 9],
        [5, 11, 4],
        [11, 10, 2],
        [10, 7, 6],
        [7, 1, 8],
        [3, 9, 4],
        [3, 4, 2],
        [3, 2, 6],
        [3, 6, 8],
        [3, 8, 9],
        [4, 9, 5],
        [2, 4, 11],
        [6, 2, 10],
        [8, 6, 7],
        [9, 8, 1],
    ];
    for _ in 0..level {
        let mut middles: HashMap<(u32, u32), u32> = HashMap::new();
        let mut middle = |a: u32, b: u32, positions: &mut Vec<Vec3>| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                let p = (positions[a as usize] + positions[b as usize]).normalize();
                positions.push(p);
                positions.len() as u32 - 1
            })
        };
        let mut finer = Vec::with_capacity(4 * triangles.len());
        for [a, b, c] in triangles {
            let (ab, bc, ca) = (
                middle(a, b, &mut positions),
                middle(b, c, &mut positions),
                middle(c, a, &mut positions),
            );
            finer.extend([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]);
        }
        triangles = finer;
    }
    for p in &mut positions {
        let mut height = 0.0;
        let (mut frequency, mut amplitude) = (3.0, 0.12);
        for _ in 0..6 {
            height += amplitude
                * float::sin(frequency * p.x + 1.3)
                * float::sin(frequency * p.y + 0.7)
                * float::sin(frequency * p.z + 2.1);
            frequency *= 2.1;
            amplitude *= 0.5;
        }
        *p *= 1.0 + height;
    }
    MeshData {
        positions,
        triangles,
        ..MeshData::default()
    }
}

/// Walls and two boxes: 36 triangles, like Mitsuba's Cornell box.
fn cornell_box() -> Geometry {
    let mut builder = GeometryBuilder::new();
    let place = |m: DMat4| Placement::from_matrix(&m).expect("invertible");
    let mut wall = |m: DMat4| {
        let rectangle = etalon_geometry::shapes::rectangle::Rectangle::new(&place(m), false);
        let rectangle = Shape::Rectangle(rectangle.expect("finite"));
        builder.add_shape(rectangle, MaterialId(0), LightId::NONE);
    };
    let quarter = core::f64::consts::FRAC_PI_2;
    let shift = |x: f64, y: f64, z: f64| DMat4::from_translation(DVec3::new(x, y, z));
    wall(
        shift(0.0, 0.99, 0.0)
            * DMat4::from_rotation_x(quarter)
            * DMat4::from_scale(DVec3::new(0.23, 0.19, 0.19)),
    );
    wall(shift(0.0, -1.0, 0.0) * DMat4::from_rotation_x(-quarter));
    wall(shift(0.0, 1.0, 0.0) * DMat4::from_rotation_x(quarter));
    wall(shift(0.0, 0.0, -1.0));
    wall(shift(1.0, 0.0, 0.0) * DMat4::from_rotation_y(-quarter));
    wall(shift(-1.0, 0.0, 0.0) * DMat4::from_rotation_y(quarter));
    for m in [
        shift(0.335, -0.7, 0.38)
            * DMat4::from_rotation_y(-0.3)
            * DMat4::from_scale(DVec3::splat(0.3)),
        shift(-0.33, -0.4, -0.28)
            * DMat4::from_rotation_y(0.32)
            * DMat4::from_scale(DVec3::new(0.3, 0.61, 0.3)),
    ] {
        let cube = etalon_geometry::shapes::cube::cube(&place(m), false).expect("finite");
        builder.add_shape(Shape::Mesh(cube), MaterialId(0), LightId::NONE);
    }
    builder.build()
}

fn primary(eye: Vec3, width: f32) -> Vec<Ray> {
    // In tiles of 32², as a renderer would.
    let tiles = SIDE / 32;
    let mut rays = Vec::with_capacity(SIDE * SIDE);
    for tile in 0..tiles * tiles {
        for pixel in 0..1024 {
            let x = (tile % tiles) * 32 + pixel % 32;
            let y = (tile / tiles) * 32 + pixel / 32;
            let at = Vec2::new(x as f32 + 0.5, y as f32 + 0.5) / SIDE as f32 * 2.0 - 1.0;
            let direction = Vec3::new(at.x * width, at.y * width, -1.0).normalize();
            rays.push(Ray::new(eye, direction, 0.0));
        }
    }
    rays
}

fn bounce(geometry: &Geometry, rays: &[Ray], random: &mut Random) -> Vec<Ray> {
    rays.iter()
        .filter_map(|ray| {
            let vertex = geometry.vertex(ray, &geometry.intersect(ray)?);
            let normal = if vertex.normal.dot(ray.direction) > 0.0 {
                -vertex.normal
            } else {
                vertex.normal
            };
            let local = square_to_cosine_hemisphere(random.square());
            Some(vertex.spawn(Frame::from_normal(normal).to_world(local)))
        })
        .collect()
}

fn shuffled(rays: &[Ray], random: &mut Random) -> Vec<Ray> {
    let mut rays = rays.to_vec();
    for i in (1..rays.len()).rev() {
        rays.swap(i, (random.next() * (i + 1) as f32) as usize);
    }
    rays
}

/// Processor time of this thread (s): on one thread, what a busy machine takes away is not counted.
fn processor_seconds() -> f64 {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    let nanoseconds = text
        .split_whitespace()
        .next()
        .and_then(|n| n.parse::<f64>().ok());
    nanoseconds.expect("Linux counts processor time") * 1e-9
}

/// Processor time of the whole process (s), in steps of a hundredth.
fn all_processor_seconds() -> f64 {
    let text = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let ticks = text.split_whitespace().skip(13).take(2);
    ticks.filter_map(|n| n.parse::<f64>().ok()).sum::<f64>() * 0.01
}

/// Best rays per second in millions, on one thread and on all.
fn rate(rays: &[Ray], work: impl Fn(&Ray) -> bool + Sync) -> (f64, f64) {
    let mut best = (f64::INFINITY, f64::INFINITY);
    let mut counts = Vec::new();
    for _ in 0..REPEATS {
        let start = processor_seconds();
        counts.push(rays.iter().filter(|ray| work(ray)).count());
        best.0 = best.0.min(processor_seconds() - start);
        let start = Instant::now();
        counts.push(
            rays.par_chunks(4096)
                .map(|c| c.iter().filter(|ray| work(ray)).count())
                .sum(),
        );
        best.1 = best.1.min(start.elapsed().as_secs_f64());
    }
    assert!(counts.iter().all(|&c| c == counts[0]), "{counts:?}");
    let millions = rays.len() as f64 / 1e6;
    (millions / best.0, millions / best.1)
}

fn report(name: &str, geometry: &Geometry, rays: &[Ray]) {
    let near = rate(rays, |ray| geometry.intersect(ray).is_some());
    let full = rate(rays, |ray| {
        let hit = geometry.intersect(ray);
        hit.is_some_and(|hit| geometry.vertex(ray, &hit).position.is_finite())
    });
    let any = rate(rays, |ray| geometry.occluded(ray));
    println!(
        "{name:<10} closest {:6.2} ({:6.2})   with vertex {:6.2} ({:6.2})   shadow {:6.2} ({:6.2})",
        near.0, near.1, full.0, full.1, any.0, any.1
    );
}

fn peak_mebibytes() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find(|line| line.starts_with("VmHWM"));
    let word = line.and_then(|line| line.split_whitespace().nth(1));
    word.and_then(|kib| kib.parse::<u64>().ok()).unwrap_or(0) / 1024
}

fn main() {
    let level = std::env::args().find_map(|a| a.parse().ok()).unwrap_or(8);
    println!(
        "M rays/s on one thread (on {} threads)",
        rayon::current_num_threads()
    );
    let mut random = Random(1);

    let geometry = cornell_box();
    println!("Cornell box: {:?}", geometry.statistics());
    let rays = primary(Vec3::new(0.0, 0.0, 3.9), 0.35);
    report("primary", &geometry, &rays);
    let bounced = bounce(&geometry, &rays, &mut random);
    report("bounce", &geometry, &bounced);

    let data = displaced_sphere(level);
    println!("peak {} MiB before building", peak_mebibytes());
    // The linear scan would take days.
    for kind in AcceleratorKind::ALL.into_iter().skip(1) {
        displaced(kind, &data);
    }
}

/// Builds one accelerator over the sphere, and traces every kind of ray through it.
fn displaced(kind: AcceleratorKind, data: &MeshData) {
    let options = MeshOptions {
        face_normals: true,
        ..MeshOptions::default()
    };
    let mut random = Random(2);
    let mut seconds = Vec::new();
    let mut built = None;
    for _ in 0..REPEATS {
        drop(built.take());
        let data = data.clone();
        let (start, processor) = (Instant::now(), all_processor_seconds());
        let mesh = Mesh::new(data, &options).expect("valid");
        let mut builder = GeometryBuilder::new();
        builder.add_shape(Shape::Mesh(mesh), MaterialId(0), LightId::NONE);
        built = Some(builder.build_with(kind));
        seconds.push((
            start.elapsed().as_secs_f64(),
            all_processor_seconds() - processor,
        ));
    }
    seconds.sort_by(|a, b| a.0.total_cmp(&b.0));
    let geometry = built.expect("built");
    println!(
        "displaced sphere, {}: {:?}",
        kind.name(),
        geometry.statistics()
    );
    println!(
        "build {:.3} s (best; {:.2} s of processor time), {:.3} s (median); peak {} MiB",
        seconds[0].0,
        seconds[0].1,
        seconds[REPEATS / 2].0,
        peak_mebibytes()
    );
    let rays = primary(Vec3::new(0.0, 0.0, 3.2), 0.45);
    report("primary", &geometry, &rays);
    let bounced = bounce(&geometry, &rays, &mut random);
    report("bounce", &geometry, &bounced);
    let mixed = shuffled(&bounced, &mut random);
    report("shuffled", &geometry, &mixed);
    let between: Vec<Ray> = (0..SIDE * SIDE)
        .filter_map(|_| {
            let (from, to) = (random.point(1.3), random.point(1.3));
            Some(Ray::new(from, (to - from).try_normalize()?, 0.0))
        })
        .collect();
    report("random", &geometry, &between);
}
