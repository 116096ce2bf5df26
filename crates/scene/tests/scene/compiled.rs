//! What a scene becomes.

use crate::reading::{LANES, document, down, meet, read_with, scene};
use etalon_sampling::SamplerKind;
use etalon_scene::Scene;
use etalon_transport::{
    Bsdf, LightId, LightSampleContext, Lights, SurfaceInteraction, Surfaces, World,
};
use glam::{Vec3, Vec4};

fn vertex(scene: &Scene, x: f32) -> SurfaceInteraction {
    meet(scene, &down(x, 0.0)).expect("a surface").1
}

fn albedo(scene: &Scene, x: f32) -> Vec4 {
    scene
        .surfaces()
        .bsdf(&vertex(scene, x), Vec3::Z, &LANES)
        .albedo(Vec3::Z)
}

/// A sphere of radius ½ at x.
fn sphere(x: f32, content: &str) -> String {
    format!(
        "<shape type=\"sphere\"><point name=\"center\" x=\"{x}\" y=\"0\" z=\"0\"/>\
         <float name=\"radius\" value=\"0.5\"/>{content}</shape>\n"
    )
}

fn grey(reflectance: f32) -> String {
    format!(
        "<bsdf type=\"diffuse\"><spectrum name=\"reflectance\" value=\"{reflectance}\"/></bsdf>"
    )
}

fn glow(radiance: f32) -> String {
    format!("<emitter type=\"area\"><spectrum name=\"radiance\" value=\"{radiance}\"/></emitter>")
}

#[test]
fn shapes_without_material_are_grey_and_lights_black() {
    let lit = glow(1.0);
    let both = glow(1.0) + &grey(0.25);
    let world = scene(&(sphere(0.0, "") + &sphere(2.0, &lit) + &sphere(4.0, &both)));
    assert_eq!(albedo(&world, 0.0), Vec4::splat(0.5));
    assert_eq!(albedo(&world, 2.0), Vec4::ZERO);
    assert_eq!(albedo(&world, 4.0), Vec4::splat(0.25));
}

/// Lights of every make: what they are made of does not matter.
#[test]
fn lights_of_every_make_are_black_without_material() {
    let half = "<float name=\"radius\" value=\"0.5\"/>";
    let operands = "<shape type=\"sphere\"/><shape type=\"cube\"/>";
    let nested = format!("<shape type=\"union\">{operands}</shape><shape type=\"cube\"/>");
    let shapes = [
        ("sphere", half),
        ("cube", ""),
        ("disk", ""),
        ("rectangle", ""),
        ("union", operands),
        ("intersection", operands),
        (
            "difference",
            "<shape type=\"cube\"/><shape type=\"sphere\"><point name=\"center\" x=\"0\" y=\"0\" z=\"-3\"/></shape>",
        ),
        ("union", &nested),
    ];
    for (plugin, content) in shapes {
        let shape =
            |further: &str| format!("<shape type=\"{plugin}\">{content}{further}</shape>\n");
        let lit = scene(&shape(&glow(1.0)));
        assert_eq!(albedo(&lit, 0.1), Vec4::ZERO, "{plugin}");
        assert_eq!(
            albedo(&scene(&shape("")), 0.1),
            Vec4::splat(0.5),
            "{plugin}"
        );
        let painted = scene(&shape(&(glow(1.0) + &grey(0.25))));
        assert_eq!(albedo(&painted, 0.1), Vec4::splat(0.25), "{plugin}");
    }
}

#[test]
fn a_shared_material_is_compiled_once() {
    let shared = "<bsdf type=\"plastic\" id=\"m\"/>\n".to_owned();
    let own = "<bsdf type=\"plastic\"/>";
    let reference = "<ref id=\"m\"/>";
    let world = scene(
        &(shared
            + &sphere(0.0, reference)
            + &sphere(2.0, own)
            + &sphere(4.0, reference)
            + &sphere(6.0, "")
            + &sphere(8.0, "")),
    );
    let material = |x| vertex(&world, x).material;
    assert_eq!(material(0.0), material(4.0));
    assert_ne!(material(0.0), material(2.0));
    assert_eq!(material(6.0), material(8.0));
    assert_eq!(world.contents().materials, 3);
}

#[test]
fn every_light_is_its_shapes_own() {
    let world = scene(
        &("<emitter type=\"point\"/>\n".to_owned()
            + &sphere(0.0, "")
            + &sphere(2.0, &glow(1.0))
            + &sphere(4.0, "")
            + &sphere(6.0, &glow(2.0))
            + "<emitter type=\"constant\"><spectrum name=\"radiance\" value=\"3\"/></emitter>\n"
            + &sphere(8.0, &glow(4.0))),
    );
    let mut seen = Vec::new();
    for (x, radiance) in [(2.0, 1.0), (6.0, 2.0), (8.0, 4.0)] {
        let (hit, at) = meet(&world, &down(x, 0.0)).expect("a light");
        assert!(world.lights().is_emitter(&hit));
        assert_eq!(
            world.lights().emitted(&at, Vec3::Z, &LANES),
            Vec4::splat(radiance)
        );
        assert_eq!(world.lights().emitted(&at, -Vec3::Z, &LANES), Vec4::ZERO);
        assert!(!seen.contains(&at.light));
        seen.push(at.light);
        // From above the light is among what light sampling finds.
        assert!(
            world
                .light_density(&LightSampleContext::in_space(Vec3::Z * 5.0), &at, -Vec3::Z)
                .hero()
                > 0.0
        );
    }
    for x in [0.0, 4.0] {
        let (hit, at) = meet(&world, &down(x, 0.0)).expect("a surface");
        assert!(!world.lights().is_emitter(&hit));
        assert_eq!(at.light, LightId::NONE);
        assert_eq!(world.lights().emitted(&at, Vec3::Z, &LANES), Vec4::ZERO);
    }
    assert!(world.lights().has_background());
    assert_eq!(
        world.lights().background(Vec3::X, 0.0, &LANES),
        Vec4::splat(3.0)
    );
}

#[test]
fn instances_place_a_group_and_keep_its_materials() {
    let group = "<shape type=\"shapegroup\" id=\"g\">".to_owned()
        + &sphere(0.0, &grey(0.125))
        + &sphere(1.5, &grey(0.75))
        + "</shape>\n";
    let place = |x: f32| {
        format!(
            "<shape type=\"instance\"><ref id=\"g\"/><transform name=\"to_world\">\
             <translate x=\"{x}\"/></transform></shape>\n"
        )
    };
    let world = scene(&(group + &place(0.0) + &place(10.0)));
    for x in [0.0, 10.0] {
        assert_eq!(albedo(&world, x), Vec4::splat(0.125));
        assert_eq!(albedo(&world, x + 1.5), Vec4::splat(0.75));
    }
    assert_eq!(vertex(&world, 0.0).material, vertex(&world, 10.0).material);
    assert_ne!(vertex(&world, 0.0).instance, vertex(&world, 10.0).instance);
    // The group itself is nowhere.
    assert!(meet(&world, &down(5.0, 0.0)).is_none());
}

#[test]
fn merged_shapes_stand_in_their_own_right() {
    let inner = "<shape type=\"merge\">".to_owned() + &sphere(2.0, &grey(0.75)) + "</shape>\n";
    let merged = "<shape type=\"merge\">".to_owned()
        + &sphere(0.0, &grey(0.125))
        + &inner
        + &sphere(4.0, &glow(2.0))
        + "</shape>\n";
    let group = "<shape type=\"shapegroup\" id=\"g\">".to_owned() + &inner + "</shape>\n";
    let place = "<shape type=\"instance\"><ref id=\"g\"/><transform name=\"to_world\">\
                 <translate x=\"6\"/></transform></shape>\n";
    let world = scene(&(merged + &group + place));
    assert_eq!(albedo(&world, 0.0), Vec4::splat(0.125));
    assert_eq!(albedo(&world, 2.0), Vec4::splat(0.75));
    assert_eq!(albedo(&world, 8.0), Vec4::splat(0.75));
    let (hit, at) = meet(&world, &down(4.0, 0.0)).expect("a light");
    assert!(world.lights().is_emitter(&hit));
    assert_eq!(
        world.lights().emitted(&at, Vec3::Z, &LANES),
        Vec4::splat(2.0)
    );
}

#[test]
fn the_calling_threads_rays_are_counted() {
    let world = scene(&sphere(0.0, ""));
    world.surfaces().take_ray_count();
    for i in 0..5 {
        world.surfaces().intersect(&down(i as f32, 0.0));
        world.transmittance(&down(i as f32, 0.0), &LANES, 0);
    }
    assert_eq!(world.surfaces().take_ray_count(), 10);
    assert_eq!(world.surfaces().take_ray_count(), 0);
}

#[test]
fn samplers_are_honoured_or_replaced_with_a_note() {
    let with = |sampler: &str| {
        let scene = document("").replace("</sensor>", &format!("{sampler}</sensor>"));
        read_with(&scene, &[])
    };
    let count = "<integer name=\"sample_count\" value=\"9\"/><integer name=\"seed\" value=\"3\"/>";
    let tag = |name: &str, more: &str| format!("<sampler type=\"{name}\">{count}{more}</sampler>");
    for (name, kind) in [
        ("independent", SamplerKind::Independent),
        ("sobol", SamplerKind::Sobol),
        ("stratified", SamplerKind::Stratified { jitter: true }),
    ] {
        let read = with(&tag(name, ""));
        let sampler = read.compiled.expect("no mistake").sampler;
        assert_eq!((sampler.kind, sampler.spp, sampler.seed), (kind, 9, 3));
        assert!(read.notes.is_empty(), "{:?}", read.notes);
    }
    let jitter = "<boolean name=\"jitter\" value=\"false\"/>";
    let read = with(&tag("stratified", jitter));
    let kind = read.compiled.expect("no mistake").sampler.kind;
    assert_eq!(kind, SamplerKind::Stratified { jitter: false });
    for name in ["multijitter", "orthogonal", "ldsampler"] {
        let read = with(&tag(name, jitter));
        let sampler = read.compiled.expect("no mistake").sampler;
        assert_eq!((sampler.kind, sampler.spp), (SamplerKind::Sobol, 9));
        assert_eq!(read.notes.len(), 1, "{:?}", read.notes);
    }
    let default = with("").compiled.expect("no mistake").sampler;
    assert_eq!(
        (default.kind, default.spp, default.seed),
        (SamplerKind::Sobol, 4, 0)
    );
}
