//! Media: which are one, what their parameters may be, where a camera or a light in them is, and what is said of the light that they hide.

use crate::reading::{LANES, Read, down, meet, read, read_with, scene};
use etalon_scene::Scene;
use etalon_transport::{
    Bsdf, LightSearch, Media, Medium, MediumId, Ray, Surfaces, TransportMode, World,
};
use glam::{UVec2, Vec3, Vec4};

/// A medium, as a child of a given name.
fn fog(name: &str, further: &str) -> String {
    format!(
        "<medium type=\"homogeneous\" {name}><float name=\"sigma_t\" value=\"2\"/>\
         <phase type=\"hg\"><float name=\"g\" value=\"0.5\"/></phase>{further}</medium>"
    )
}

/// A ball of radius ½ at x.
fn ball(x: f32, content: &str) -> String {
    format!(
        "<shape type=\"sphere\"><float name=\"radius\" value=\"0.5\"/>\
         <point name=\"center\" x=\"{x}\" y=\"0\" z=\"0\"/>{content}</shape>\n"
    )
}

/// The medium in the shape that is met at x.
fn inside(scene: &Scene, x: f32) -> MediumId {
    let (_, vertex) = meet(scene, &down(x, 0.0)).expect("a surface");
    vertex.media.inside
}

/// By what they are: what is there by default may be written, or stand elsewhere and be referred to.
#[test]
fn media_that_are_the_same_are_one() {
    let within = |further: &str| fog("name=\"interior\"", further);
    let alike = [
        within(""),
        within("<float name=\"scale\" value=\"1\"/><float name=\"albedo\" value=\"0.75\"/>"),
        within(
            "<volume type=\"constvolume\" name=\"albedo\"><float name=\"value\" value=\"0.75\"/></volume>",
        ),
        "<ref name=\"interior\" id=\"fog\"/>".to_owned(),
    ];
    let varying = |scale: &str| {
        within(&format!(
            "<texture type=\"noise\" name=\"albedo\"><transform name=\"to_world\"><scale value=\"{scale}\"/></transform></texture>"
        ))
    };
    let others = [
        within("<float name=\"scale\" value=\"2\"/>"),
        varying("2"),
        varying("3"),
        varying("2"),
    ];
    let balls = alike.iter().chain(&others).zip(0_u8..);
    let balls: String = balls
        .map(|(medium, index)| ball(f32::from(2 * index), medium))
        .collect();
    let world = scene(&(fog("id=\"fog\"", "") + "\n" + &balls));
    let ids: Vec<u32> = (0..8)
        .map(|index| inside(&world, 2.0 * index as f32).0)
        .collect();
    let first = ids[0];
    assert_eq!(ids[..4], [first; 4]);
    assert_eq!(ids[5], ids[7]);
    let mut different = vec![first, ids[4], ids[5], ids[6]];
    different.sort_unstable();
    different.dedup();
    assert_eq!(different.len(), 4, "{ids:?}");
}

/// A camera in a body names the medium of the body, or none; beyond the body it is in that around all bodies, here none.
#[test]
fn a_camera_in_a_body_may_name_its_medium() {
    let scene_with = |named: &str| {
        format!(
            "<scene version=\"3.0.0\">{}<shape type=\"sphere\"><bsdf type=\"null\"/>\
             <integer name=\"priority\" value=\"1\"/><ref name=\"interior\" id=\"fog\"/></shape>\
             <sensor type=\"perspective\">{named}</sensor></scene>",
            fog("id=\"fog\"", "")
        )
    };
    for named in ["", "<ref id=\"fog\"/>", &fog("", "")] {
        let read = read_with(&scene_with(named), &[]);
        assert_eq!(read.errors, Vec::<String>::new());
        let world = read.compiled.expect("a scene without mistakes").scene;
        let inside = Ray {
            medium: world.media().around_camera(),
            ..Ray::new(Vec3::ZERO, Vec3::Z, 0.0)
        };
        assert!(
            world.media().enter(inside.medium, None, &LANES).is_some(),
            "{named}"
        );
        let (_, boundary) = meet(&world, &inside).expect("a surface");
        let beyond = boundary.spawn(Vec3::Z).medium;
        assert!(
            world.media().enter(beyond, None, &LANES).is_none(),
            "{named}"
        );
    }
}

/// α(x) = x between 0 and 1, of a medium whose extinction is the same everywhere, also as what is scaled.
#[test]
fn the_albedo_of_a_homogeneous_medium_may_vary_in_space() {
    let ramp = |name: &str| {
        format!(
            "<texture type=\"gradient\" {name}><string name=\"space\" value=\"world\"/></texture>"
        )
    };
    let half = format!(
        "<texture type=\"scale\" name=\"albedo\">{}<float name=\"scale\" value=\"0.5\"/></texture>",
        ramp("")
    );
    for (albedo, factor) in [(ramp("name=\"albedo\""), 1.0), (half, 0.5)] {
        let world = scene(&ball(0.5, &fog("name=\"interior\"", &albedo)));
        let medium = world
            .media()
            .enter(inside(&world, 0.5), None, &LANES)
            .expect("a medium");
        for x in [0.125, 0.5, 0.875] {
            let at = medium.coefficients(Vec3::new(x, 0.1, 0.2), Vec3::X);
            let scattering = Vec4::splat(2.0 * factor * x);
            assert!(at.scattering.abs_diff_eq(scattering, 1e-6), "{at:?}");
            assert!(
                at.extinction().abs_diff_eq(Vec4::splat(2.0), 1e-6),
                "{at:?}"
            );
        }
    }
}

/// Of every input of media and phase functions, however deep what looks at a surface stands.
#[test]
fn what_has_values_on_surfaces_only_is_no_input_of_a_medium() {
    let by_uv = [
        "type=\"gradient\" NAME>",
        "type=\"bricks\" NAME>",
        "type=\"checkerboard\" NAME>",
        "type=\"noise\" NAME><string name=\"space\" value=\"uv\"/>",
        "type=\"bitmap\" NAME><string name=\"filename\" value=\"a.ppm\"/>",
        "type=\"mesh_attribute\" NAME><string name=\"name\" value=\"vertex_a\"/>",
    ];
    let texture = |index: usize, name: &str| {
        let plugin = by_uv[index].replace("NAME", &format!("name=\"{name}\""));
        format!("<texture {plugin}</texture>")
    };
    let nested = |name: &str| {
        format!(
            "<texture type=\"multiply\" name=\"{name}\"><texture type=\"scale\" name=\"a\">{}</texture>\
             <texture type=\"noise\" name=\"b\"/></texture>",
            texture(0, "")
        )
    };
    let medium = |plugin: &str, content: &str| {
        let medium = format!("<medium type=\"{plugin}\" name=\"interior\">{content}</medium>");
        let read = read_with(
            &crate::reading::document(&ball(0.0, &medium)),
            &[("a.ppm", "P6 1 1 255\nABC")],
        );
        read.errors
    };
    let phase = |plugin: &str, content: &str| {
        format!(
            "<phase type=\"{plugin}\">{content}<phase type=\"hg\"/><phase type=\"isotropic\"/></phase>"
        )
    };
    let one = |errors: Vec<String>, what: &str| {
        let [error] = errors.as_slice() else {
            panic!("{what}: {errors:?}");
        };
        assert!(
            error.contains("points in a medium are on none"),
            "{what}: {error}"
        );
    };
    for (index, plugin) in by_uv.iter().enumerate() {
        one(medium("heterogeneous", &texture(index, "sigma_t")), plugin);
    }
    for name in ["sigma_t", "albedo", "emission"] {
        one(medium("heterogeneous", &texture(0, name)), name);
        one(medium("heterogeneous", &nested(name)), name);
    }
    for name in ["albedo", "emission"] {
        one(medium("homogeneous", &texture(0, name)), name);
        one(medium("homogeneous", &nested(name)), name);
    }
    for plugin in ["homogeneous", "heterogeneous"] {
        one(
            medium(plugin, &phase("blendphase", &texture(0, "weight"))),
            "weight",
        );
    }
    let flakes = format!("<phase type=\"sggx\">{}</phase>", texture(0, "S"));
    one(medium("heterogeneous", &flakes), "S");
    assert_eq!(
        medium(
            "heterogeneous",
            "<texture type=\"noise\" name=\"sigma_t\"/>"
        ),
        Vec::<String>::new()
    );
}

/// Phase functions, volumes and what is below surfaces, used by reference or not at all; mistakes in those that are not are found.
#[test]
fn objects_at_the_top_of_a_scene_can_be_referred_to() {
    let defined = "<phase type=\"hg\" id=\"p\"><float name=\"g\" value=\"0.5\"/></phase>\
                   <volume type=\"constvolume\" id=\"v\"><float name=\"value\" value=\"0.25\"/>\
                   <transform name=\"to_world\"><scale value=\"3\"/></transform></volume>\
                   <subsurface type=\"randomwalk\" id=\"s\"/>";
    let used = "<medium type=\"homogeneous\" name=\"interior\"><ref id=\"p\"/><ref name=\"albedo\" id=\"v\"/></medium>";
    let written = "<medium type=\"homogeneous\" name=\"interior\"><phase type=\"hg\"><float name=\"g\" value=\"0.5\"/></phase>\
                   <float name=\"albedo\" value=\"0.25\"/></medium>";
    let world = scene(&format!(
        "{defined}{}{}{}",
        ball(0.0, used),
        ball(2.0, written),
        ball(4.0, "<ref id=\"s\"/>")
    ));
    assert_eq!(inside(&world, 0.0), inside(&world, 2.0));
    assert!(inside(&world, 4.0).is_some());
    assert_eq!(messages(&read(defined)), Vec::<String>::new());
    for mistaken in [
        "<phase type=\"hg\"><float name=\"g\" value=\"5\"/></phase>",
        "<phase type=\"mi\"/>",
        "<volume type=\"constvolume\"><float name=\"valeu\" value=\"1\"/></volume>",
        "<subsurface type=\"randomwalk\"><float name=\"albedi\" value=\"1\"/></subsurface>",
    ] {
        assert_eq!(read(mistaken).errors.len(), 1, "{mistaken}");
    }
}

fn messages(read: &Read) -> Vec<String> {
    read.errors.iter().chain(&read.notes).cloned().collect()
}

/// What a path tracer would be told of a scene.
fn remarks(content: &str) -> Vec<String> {
    let capabilities = scene(content).capabilities(UVec2::ZERO, UVec2::splat(64));
    let remarks = capabilities.incompatibilities(LightSearch::FromCamera);
    remarks.into_iter().map(|remark| remark.message).collect()
}

/// Light that goes on on the other side of a surface is light that it scatters.
#[test]
fn what_lets_light_through_diffusely_is_not_called_black() {
    let sky = "<emitter type=\"constant\"/>";
    for below in [
        "<bsdf type=\"difftrans\"/>",
        "<subsurface type=\"randomwalk\"/>",
        "<subsurface type=\"dipole\"/>",
        "<bsdf type=\"roughdielectric\"/>",
        "<bsdf type=\"hair\"/>",
    ] {
        assert_eq!(
            remarks(&(ball(0.0, below) + sky)),
            Vec::<String>::new(),
            "{below}"
        );
    }
    // What is black is.
    let wall = |reflectance: &str| {
        format!(
            "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"99\"/></transform><bsdf type=\"diffuse\">\
             <rgb name=\"reflectance\" value=\"{reflectance}\"/></bsdf></shape>{sky}"
        )
    };
    assert_eq!(remarks(&wall("0.1")), Vec::<String>::new());
    let black = remarks(&wall("0"));
    assert!(
        black
            .iter()
            .any(|remark| remark.starts_with("the camera sees no light")),
        "{black:?}"
    );
}

/// Fog without end lets nothing through of what comes from infinity; in a shape it ends.
#[test]
fn endless_fog_before_a_sky_is_told() {
    let scene_with = |sensor: &str, shape: &str, light: &str| {
        let text = format!(
            "<scene version=\"3.0.0\">{}{light}<shape type=\"sphere\">{shape}</shape>\
             <sensor type=\"perspective\"><transform name=\"to_world\"><translate z=\"-5\"/></transform>{sensor}</sensor></scene>",
            fog("id=\"fog\"", "")
        );
        let read = read_with(&text, &[]);
        assert_eq!(read.errors, Vec::<String>::new());
        let world = read.compiled.expect("a scene without mistakes").scene;
        world.capabilities(UVec2::ZERO, UVec2::splat(64)).swallowed
    };
    let (fog, sky) = ("<ref id=\"fog\"/>", "<emitter type=\"constant\"/>");
    assert!(scene_with(fog, "", sky));
    assert!(scene_with(fog, "", "<emitter type=\"directional\"/>"));
    assert!(!scene_with("", "", sky));
    assert!(!scene_with(fog, "", "<emitter type=\"point\"/>"));
    let in_a_shape = "<float name=\"radius\" value=\"9\"/><bsdf type=\"null\"/><ref id=\"fog\" name=\"interior\"/>";
    assert!(!scene_with(fog, in_a_shape, sky));
}

/// Below a solid of solids as below any other closed shape; its operands have nothing in them of their own.
#[test]
fn light_walks_about_in_solids_of_solids() {
    let operands = "<shape type=\"sphere\"/><shape type=\"cube\"/>";
    let walk =
        "<subsurface type=\"randomwalk\"><float name=\"albedo\" value=\"0.5\"/></subsurface>";
    let sphere = scene(&format!("<shape type=\"sphere\">{walk}</shape>"));
    for solid in ["union", "intersection"] {
        let world = scene(&format!("<shape type=\"{solid}\">{operands}{walk}</shape>"));
        let medium = |world: &Scene| {
            let medium = world
                .media()
                .enter(inside(world, 0.0), None, &LANES)
                .expect("a medium");
            let at = medium.coefficients(Vec3::ZERO, Vec3::X);
            (at.scattering, at.absorption)
        };
        assert_eq!(medium(&world), medium(&sphere), "{solid}");
        let (_, vertex) = meet(&world, &down(0.0, 0.0)).expect("a surface");
        let through = world.surfaces().bsdf(&vertex, Vec3::Z, &LANES);
        let down = Vec3::new(0.0, 0.6, -0.8);
        let passes = through.eval(Vec3::Z, down, TransportMode::Radiance);
        assert!(passes.min_element() > 0.2, "{solid}: {passes}");
    }
    for inner in [walk, "<medium type=\"homogeneous\" name=\"interior\"/>"] {
        let mistaken = format!(
            "<shape type=\"union\"><shape type=\"sphere\">{inner}</shape><shape type=\"cube\"/></shape>"
        );
        let errors = read(&mistaken).errors;
        assert!(
            errors.len() == 1 && errors[0].contains("the whole's"),
            "{errors:?}"
        );
    }
}

/// What light does in flights that rounding hides is what it does in somewhat longer ones; absorbing matter stays as it is.
#[test]
fn mean_free_paths_are_long_against_rounding() {
    let ball_at = |x: f32, content: &str| {
        format!(
            "<shape type=\"sphere\"><point name=\"center\" x=\"{x}\" y=\"0\" z=\"0\"/>{content}</shape>"
        )
    };
    let walk = |length: &str| {
        format!(
            "<subsurface type=\"randomwalk\"><float name=\"albedo\" value=\"0.5\"/><float name=\"mean_free_path\" value=\"{length}\"/></subsurface>"
        )
    };
    let thick = |albedo: &str| {
        format!(
            "<medium type=\"homogeneous\" name=\"interior\"><float name=\"sigma_t\" value=\"1e5\"/>\
             <float name=\"albedo\" value=\"{albedo}\"/></medium>"
        )
    };
    // 256 ulps of coordinates up to 1 m, and .003 of a radius of 1 m.
    let [near, far] = [256.0 * f32::EPSILON, 3e-3];
    for (x, content, length, told) in [
        (0.0, walk("1e-4"), 1e-4, 0),
        (0.0, walk("1e-8"), near, 1),
        (0.0, walk("0"), near, 1),
        (1000.0, walk("1e-3"), far, 1),
        (1000.0, walk("0.1"), 0.1, 0),
        (1000.0, thick("0.9"), far, 1),
        (1000.0, thick("0"), 1e-5, 0),
    ] {
        let read = read(&ball_at(x, &content));
        assert_eq!(read.errors, Vec::<String>::new());
        let said = read.notes.iter().filter(|note| note.contains("counts as"));
        assert_eq!(said.count(), told, "{content}: {:?}", read.notes);
        let world = read.compiled.expect("a scene without mistakes").scene;
        let medium = world
            .media()
            .enter(inside(&world, x), None, &LANES)
            .expect("a medium");
        let extinction = medium.coefficients(Vec3::ZERO, Vec3::X).extinction().x;
        assert!(
            (extinction * length - 1.0).abs() < 1e-5,
            "{content}: {extinction}"
        );
    }
}
