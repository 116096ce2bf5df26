//! Where two exact pictures may differ by rounding alone: pixels next to an edge.
//!
//! A picture made of one ray through each pixel's centre is continuous but for edges: where a ray
//! meets another object than its neighbour does, where a texture changes its colour, and where
//! a shadow begins. There the last bit of an intersection may decide which side a pixel shows. What
//! a pixel shows is therefore told by three things, its *sight*:
//!
//! - the object, as the integrator `signature` tells objects apart (shape, or instance);
//! - the surface's albedo at four fixed wavelengths, bit by bit;
//! - which lights light it: those to which the way is free and for which the surface's scattering
//!   toward the camera is not zero.
//!
//! An edge pixel is one whose 3 × 3 neighbourhood has more than one sight. Neither the edges of a
//! box's faces nor those between triangles of a mesh are edges in this sense.

use etalon_scene::Scene;
use etalon_transport::{Bsdf, Camera, Hit, Mode, Ray, Receiver, Vertex, World};
use glam::{UVec2, Vec2, Vec3};
use rayon::prelude::*;

/// How often each point asks for a light. Lights are chosen by what they give; with as many
/// equally spaced draws every one is found that is chosen with a probability above 1/16.
const DRAWS: u32 = 16;

/// What is seen through a pixel's centre; `None` if nothing is.
type Sight = Option<Surface>;

#[derive(Clone, Debug, PartialEq, Eq)]
struct Surface {
    object: (u32, u32),
    albedo: [u32; 4],
    lights: Vec<u32>,
}

/// Which pixels of a film of `size` pixels, row by row, are next to an edge.
pub fn edges(scene: &Scene, size: UVec2) -> Vec<bool> {
    let [width, height] = size.to_array();
    let sights: Vec<Sight> = (0..width * height)
        .into_par_iter()
        .map(|i| {
            sight(
                scene,
                Vec2::new((i % width) as f32, (i / width) as f32) + 0.5,
            )
        })
        .collect();
    let at = |x: u32, y: u32| &sights[(y * width + x) as usize];
    let next_to_edge = |x: u32, y: u32| {
        let rows = y.saturating_sub(1)..(y + 2).min(height);
        let mut around = rows.flat_map(|v| {
            let columns = x.saturating_sub(1)..(x + 2).min(width);
            columns.map(move |u| (u, v))
        });
        around.any(|(u, v)| at(u, v) != at(x, y))
    };
    (0..width * height)
        .map(|i| next_to_edge(i % width, i / width))
        .collect()
}

fn sight(scene: &Scene, raster: Vec2) -> Sight {
    let ray = scene.camera().ray(raster, Vec2::splat(0.5), 0.0).ray;
    let hit = scene.intersect(&ray)?;
    let vertex = scene.vertex(&ray, &hit);
    let wo = -ray.direction;
    let wavelengths = scene.wavelengths(0.5);
    let bsdf = scene.bsdf(&vertex, wo, &wavelengths);
    // In space, so that no light is left out for shining from behind.
    let from = Receiver::in_space(vertex.position);
    let mut lights = Vec::new();
    for draw in 0..DRAWS {
        let u = (draw as f32 + 0.5) / DRAWS as f32;
        let Some(light) = scene.sample_light(&from, &wavelengths, u, Vec2::splat(0.5)) else {
            continue;
        };
        if lights.contains(&light.light.0)
            || bsdf.eval(wo, light.direction, Mode::Radiance).max_element() <= 0.0
        {
            continue;
        }
        let free = toward(&vertex, light.direction, light.target)
            .and_then(|ray| scene.passage(&ray, &wavelengths, 0));
        if free.is_some() {
            lights.push(light.light.0);
        }
    }
    lights.sort_unstable();
    Some(Surface {
        object: object(&hit),
        albedo: bsdf.albedo(wo).to_array().map(f32::to_bits),
        lights,
    })
}

/// An instance is one object, whatever shapes it has.
fn object(hit: &Hit) -> (u32, u32) {
    if hit.instance.is_some() {
        (u32::MAX, hit.instance.0)
    } else {
        (hit.shape.0, u32::MAX)
    }
}

/// The way from a vertex to a light's point, or to infinity.
fn toward(vertex: &Vertex, direction: Vec3, target: Option<Vec3>) -> Option<Ray> {
    match target {
        None => Some(vertex.spawn(direction)),
        Some(target) => Ray::between(vertex.origin_toward(target), target, vertex.time),
    }
}
