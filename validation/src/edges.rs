//! Where two exact pictures may differ by rounding alone: pixels next to an edge.
//!
//! A picture made of one ray through each pixel's centre is continuous except at edges: where a ray
//! meets another object than its neighbour does, where a texture changes its colour, and where
//! a shadow begins. There the last bit of an intersection may decide which side a pixel shows. A pixel
//! is therefore described by three things, its *sight*:
//!
//! - the object, as the integrator `signature` tells objects apart (shape, or instance);
//! - the surface's albedo (of a classic material, all of its numbers) at four fixed wavelengths,
//!   bit by bit;
//! - which lights light it: those from which light arrives, through which objects, and for which
//!   the surface's scattering toward the camera is not zero;
//!
//! and by the same of everything seen by mirror reflection or transmission, if its weight is above a
//! thousandth.
//!
//! An edge pixel is one whose 3 × 3 neighbourhood has more than one sight. Neither the edges of a
//! box's faces nor those between triangles of a mesh are edges in this sense, unless rays are mirrored
//! or refracted by them, where the view jumps.

use etalon_integrators::whitted::onward;
use etalon_scene::Scene;
use etalon_spectrum::Wavelengths;
use etalon_transport::{
    Bsdf, Camera, Hit, LegacyPhong, LightId, LightSampleContext, Lights, Ray, Sensor,
    SurfaceInteraction, Surfaces, TransportMode, World,
};
use glam::{UVec2, Vec2, Vec3};
use rayon::prelude::*;

/// What counts for less than this is not looked at.
const LEAST: f32 = 1e-3;

/// How many surfaces a ray may meet.
const DEPTH: u32 = 16;

/// All that is seen through a pixel's centre, in the order in which it is met.
type PixelKey = Vec<Surface>;

#[derive(Clone, Debug, PartialEq, Eq)]
struct Surface {
    /// How the ray came here: at each surface the number of the way taken.
    way: u64,
    object: (u32, u32),
    albedo: Vec<u32>,
    lights: Vec<Lit>,
}

/// A light from which light arrives, and the objects that it passes on the way.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Lit {
    light: u32,
    through: Vec<(u32, u32)>,
}

/// Which pixels of a film of `size` pixels, row by row, are next to an edge.
pub fn edges(scene: &Scene, size: UVec2) -> Vec<bool> {
    let [width, height] = size.to_array();
    let sights: Vec<PixelKey> = (0..width * height)
        .into_par_iter()
        .map(|i| {
            let raster = Vec2::new((i % width) as f32, (i / width) as f32) + 0.5;
            let ray = scene.camera().ray(raster, Vec2::splat(0.5), 0.0).ray;
            let mut sight = Vec::new();
            look(scene, &ray, (1, 1.0, DEPTH), &mut sight);
            sight
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

/// Adds what a ray sees that came by `way`, counts `weight`, and may meet so many surfaces.
fn look(scene: &Scene, ray: &Ray, (way, weight, depth): (u64, f32, u32), sight: &mut PixelKey) {
    let Some(hit) = scene.surfaces().intersect(ray) else {
        return;
    };
    let vertex = scene.surfaces().vertex(ray, &hit);
    let wo = -ray.direction;
    let wavelengths = scene.sensor().wavelengths(0.5);
    sight.push(Surface {
        way,
        object: object(&hit),
        albedo: albedo(scene, &vertex, wo, &wavelengths),
        lights: lights(scene, &vertex, wo, &wavelengths),
    });
    if depth == 1 {
        return;
    }
    for index in 0.. {
        let Some(next) = onward(
            scene,
            &vertex,
            wo,
            (&wavelengths, TransportMode::Radiance),
            index,
        ) else {
            break;
        };
        let weight = weight * next.value.max_element();
        if weight > LEAST {
            let way = way * 4 + u64::from(index.min(3));
            look(
                scene,
                &vertex.spawn(next.wi),
                (way, weight, depth - 1),
                sight,
            );
        }
    }
}

fn albedo(
    scene: &Scene,
    vertex: &SurfaceInteraction,
    wo: Vec3,
    wavelengths: &Wavelengths,
) -> Vec<u32> {
    let numbers = match scene.surfaces().legacy_phong(vertex, wo, wavelengths) {
        None => vec![scene.surfaces().bsdf(vertex, wo, wavelengths).albedo(wo)],
        Some(LegacyPhong {
            ambient,
            diffuse,
            specular,
            global,
            ..
        }) => vec![ambient, diffuse, specular, global],
    };
    let numbers = numbers.into_iter().flat_map(|lanes| lanes.to_array());
    numbers.map(f32::to_bits).collect()
}

fn lights(
    scene: &Scene,
    vertex: &SurfaceInteraction,
    wo: Vec3,
    wavelengths: &Wavelengths,
) -> Vec<Lit> {
    // In space, so that no light is left out for shining from behind.
    let from = LightSampleContext::in_space(vertex.position);
    let lit = |light: u32| {
        let middle = Vec2::splat(0.5);
        let sample = scene
            .lights()
            .sample_one(LightId(light), &from, wavelengths, middle)?;
        let shows = if scene
            .surfaces()
            .legacy_phong(vertex, wo, wavelengths)
            .is_some()
        {
            vertex.shading.n.dot(sample.direction) * vertex.shading.n.dot(wo) > 0.0
        } else {
            let bsdf = scene.surfaces().bsdf(vertex, wo, wavelengths);
            bsdf.eval(wo, sample.direction, TransportMode::Radiance)
                .max_element()
                > 0.0
        };
        if !shows {
            return None;
        }
        let ray = vertex.shadow_ray(sample.direction, sample.target)?;
        let through = passed(scene, ray, wavelengths)?;
        Some(Lit { light, through })
    };
    (0..scene.lights().count()).filter_map(lit).collect()
}

/// The objects that light passes on a segment; `None` if it does not arrive.
fn passed(scene: &Scene, mut ray: Ray, wavelengths: &Wavelengths) -> Option<Vec<(u32, u32)>> {
    let mut objects = Vec::new();
    let end = ray.origin + ray.direction * ray.t_max;
    while let Some(hit) = scene.surfaces().intersect(&ray) {
        let vertex = scene.surfaces().vertex(&ray, &hit);
        let open = match scene
            .surfaces()
            .legacy_phong(&vertex, -ray.direction, wavelengths)
        {
            Some(material) => material.transparency > 0.0 || material.opacity < 1.0,
            None => {
                let bsdf = scene.surfaces().bsdf(&vertex, -ray.direction, wavelengths);
                bsdf.null_transmittance().max_element() > 0.0
            }
        };
        if !open {
            return None;
        }
        objects.push(object(&hit));
        ray = vertex.shadow_ray(ray.direction, ray.t_max.is_finite().then_some(end))?;
    }
    Some(objects)
}

/// An instance is one object, with all of its shapes.
fn object(hit: &Hit) -> (u32, u32) {
    if hit.instance.is_some() {
        (u32::MAX, hit.instance.0)
    } else {
        (hit.shape.0, u32::MAX)
    }
}
