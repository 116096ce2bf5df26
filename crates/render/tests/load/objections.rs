//! An estimator that cannot see a scene's light says so: no picture is black without a word.

use crate::Said;

const POINT: &str =
    "<emitter type=\"point\"><point name=\"position\" value=\"0, 2, 0\"/></emitter>";
const LAMP: &str = "<shape type=\"sphere\"><emitter type=\"area\"/></shape>";
const UNCHOSEN: &str =
    "<emitter type=\"point\"><float name=\"sampling_weight\" value=\"0\"/></emitter>";
const PINHOLE: &str = "<sensor type=\"perspective\">";
const LENS: &str = "<sensor type=\"thinlens\"><float name=\"aperture_radius\" value=\"1\"/>";

/// A wall before the camera.
const WALL: &str = "<shape type=\"rectangle\"><transform name=\"to_world\"><rotate y=\"1\" angle=\"180\"/>\
                    <translate z=\"3\"/></transform></shape>";

/// Loads a wall and lights with an integrator, which stands in line 2, the camera in line 3.
fn load(integrator: &str, sensor: &str, lights: &str) -> Said {
    load_shapes(integrator, sensor, &format!("{WALL}{lights}"))
}

/// The same with these shapes and lights only.
fn load_shapes(integrator: &str, sensor: &str, shapes: &str) -> Said {
    let scene = format!(
        "<scene version=\"3.0.0\">
{integrator}
{sensor}<film type=\"hdrfilm\"><integer name=\"width\" value=\"4\"/><integer name=\"height\" value=\"4\"/></film></sensor>
{shapes}</scene>"
    );
    Said::of(&scene, &[])
}

fn named(integrator: &str) -> String {
    format!("<integrator type=\"{integrator}\"/>")
}

/// It can be rendered, with this remark.
#[track_caller]
fn remarks(said: Said, place: &str, words: &str) -> Said {
    let heading = format!("a.xml:{place}: note: ");
    let as_expected = !said.refused && said.text.contains(&heading) && said.text.contains(words);
    assert!(as_expected, "{}", said.text);
    said
}

/// It is refused, with this error.
#[track_caller]
fn refuses(said: &Said, place: &str, words: &str) {
    let heading = format!("a.xml:{place}: error: ");
    let as_expected = said.refused && said.text.contains(&heading) && said.text.contains(words);
    assert!(as_expected, "{}", said.text);
}

#[track_caller]
fn says_nothing(said: Said) {
    assert!(!said.refused && said.text.is_empty(), "{}", said.text);
}

#[test]
fn a_scene_without_light_is_remarked_upon() {
    let black = "<shape type=\"sphere\"><emitter type=\"area\"><rgb name=\"radiance\" value=\"0, 0, 0\"/></emitter></shape>";
    for integrator in ["path", "direct", "naive", "ptracer", "bdpt"] {
        for lights in ["", black] {
            let said = load(&named(integrator), PINHOLE, lights);
            remarks(said, "1:1", "nothing in this scene emits light");
        }
    }
    let nested = "<integrator type=\"moment\"><integrator type=\"path\"/></integrator>";
    remarks(load(nested, PINHOLE, ""), "1:1", "emits light");
    // What needs no light says nothing.
    for integrator in ["depth", "signature", "ao"] {
        says_nothing(load(&named(integrator), PINHOLE, ""));
    }
    let aov = "<integrator type=\"aov\"><string name=\"aovs\" value=\"d:depth\"/></integrator>";
    says_nothing(load(aov, PINHOLE, ""));
}

#[test]
fn lights_that_are_seen_give_no_reason_to_speak() {
    for integrator in ["path", "direct", "ptracer", "bdpt"] {
        let lights = format!("{POINT}{LAMP}<emitter type=\"constant\"/>");
        says_nothing(load(&named(integrator), PINHOLE, &lights));
    }
}

#[test]
fn point_lights_are_invisible_to_what_must_hit_them() {
    let direct =
        "<integrator type=\"direct\"><integer name=\"emitter_samples\" value=\"0\"/></integrator>";
    refuses(
        &load(direct, PINHOLE, POINT),
        "2:19",
        "cannot see any light",
    );
    let both = format!("{POINT}{LAMP}");
    remarks(
        load(direct, PINHOLE, &both),
        "2:19",
        "1 of the scene's 2 lights",
    );
}

#[test]
fn lights_that_are_never_chosen_are_invisible_to_what_chooses() {
    refuses(
        &load(&named("path"), PINHOLE, UNCHOSEN),
        "2:19",
        "sampling_weight",
    );
    let both = format!("{UNCHOSEN}{LAMP}");
    remarks(
        load(&named("path"), PINHOLE, &both),
        "2:19",
        "1 of the scene's 2 lights",
    );
    let lamp = LAMP.replace(
        "area\"/>",
        "area\"><float name=\"sampling_weight\" value=\"0\"/></emitter>",
    );
    // Photons leave lights that were chosen, too. Mutant rejected: half of the light is gone without a word.
    for choosing in ["ptracer", "sppm", "photonmap"] {
        refuses(
            &load(&named(choosing), PINHOLE, &lamp),
            "2:19",
            "sampling_weight",
        );
    }
    says_nothing(load(&named("path"), PINHOLE, &lamp));
}

#[test]
fn techniques_longer_than_the_longest_path_are_refused() {
    let bdpt = |max_depth: u32| {
        format!(
            "<integrator type=\"bdpt\"><integer name=\"s\" value=\"2\"/><integer name=\"t\" value=\"3\"/>\
             <integer name=\"max_depth\" value=\"{max_depth}\"/></integrator>"
        )
    };
    refuses(&load(&bdpt(3), PINHOLE, POINT), "2:50", "4 segments");
    says_nothing(load(&bdpt(4), PINHOLE, POINT));
    let hitting = "<integrator type=\"bdpt\"><integer name=\"s\" value=\"0\"/><integer name=\"t\" value=\"3\"/></integrator>";
    refuses(&load(hitting, PINHOLE, POINT), "2:19", "running into them");
}

#[test]
fn paths_without_segments_are_remarked_upon() {
    let path = "<integrator type=\"path\"><integer name=\"max_depth\" value=\"0\"/></integrator>";
    remarks(load(path, PINHOLE, POINT), "2:58", "0 segments");
}

#[test]
fn numbers_of_light_candidates_are_checked() {
    for (name, place) in [("path", "2:65"), ("direct", "2:67")] {
        let with = |count: &str| {
            let count = format!("<integer name=\"light_candidates\" value=\"{count}\"/>");
            let integrator = format!("<integrator type=\"{name}\">{count}</integrator>");
            load(&integrator, PINHOLE, POINT)
        };
        for wrong in ["0", "-1", "65"] {
            refuses(&with(wrong), place, "1, 2, … 64");
        }
        says_nothing(with("1"));
        says_nothing(with("64"));
    }
    // Those that draw one know no such parameter.
    let bdpt =
        "<integrator type=\"bdpt\"><integer name=\"light_candidates\" value=\"2\"/></integrator>";
    let said = load(bdpt, PINHOLE, POINT);
    assert!(said.text.contains("light_candidates"), "{}", said.text);
}

#[test]
fn forward_needs_an_aperture() {
    for lights in [LAMP, "", POINT] {
        let said = load(&named("forward"), PINHOLE, lights);
        assert!(said.text.contains("thinlens"), "{}", said.text);
        refuses(&said, "3:15", "this camera has none");
    }
    let closed = LENS.replace("value=\"1\"", "value=\"0\"");
    refuses(
        &load(&named("forward"), &closed, LAMP),
        "3:15",
        "this camera has none",
    );
    says_nothing(load(&named("forward"), LENS, LAMP));
    says_nothing(load(&named("forward"), LENS, POINT));
    remarks(load(&named("forward"), LENS, ""), "1:1", "emits light");
}

#[test]
fn naive_needs_lights_with_extent() {
    refuses(
        &load(&named("naive"), PINHOLE, POINT),
        "2:19",
        "running into them",
    );
    let sky = format!("{POINT}<emitter type=\"constant\"/>");
    remarks(
        load(&named("naive"), PINHOLE, &sky),
        "2:19",
        "1 of the scene's 2 lights",
    );
    says_nothing(load(&named("naive"), PINHOLE, LAMP));
    let nested = "<integrator type=\"aov\"><string name=\"aovs\" value=\"d:depth\"/><integrator type=\"naive\"/></integrator>";
    refuses(&load(nested, PINHOLE, POINT), "2:19", "running into them");
}

#[test]
fn a_lens_changes_nothing_for_what_connects() {
    says_nothing(load(&named("ptracer"), LENS, LAMP));
}

/// Loads, before a lamp that it does not see itself, what fills the picture.
fn before(integrator: &str, bsdf: &str) -> Said {
    let surface = |bsdf: &str, z: f32| {
        format!(
            "<shape type=\"rectangle\"><transform name=\"to_world\"><rotate y=\"1\" angle=\"180\"/>\
             <translate z=\"{z}\"/></transform><bsdf type=\"{bsdf}\"/></shape>"
        )
    };
    let lights =
        "<emitter type=\"point\"><point name=\"position\" x=\"0\" y=\"3\" z=\"0\"/></emitter>";
    // Mirrors show what is behind the camera.
    let behind = "<shape type=\"rectangle\"><transform name=\"to_world\"><translate z=\"-1\"/>\
                  </transform></shape>";
    let lights = format!(
        "{}{}{behind}{lights}",
        surface(bsdf, 1.0),
        surface("diffuse", 1.1)
    );
    load(integrator, PINHOLE, &lights)
}

#[test]
fn what_connects_with_the_camera_sees_nothing_in_mirrors() {
    let ptracer = named("ptracer");
    let connects = "<integrator type=\"bdpt\"><integer name=\"s\" value=\"2\"/><integer name=\"t\" value=\"1\"/></integrator>";
    for integrator in [ptracer.as_str(), connects] {
        for smooth in ["conductor", "dielectric"] {
            let said = before(integrator, smooth);
            refuses(&said, "2:19", "cannot see anything that the camera sees");
        }
        // Beneath its varnish a plastic scatters; so does what is behind a thin pane.
        for both in ["plastic", "thindielectric"] {
            remarks(before(integrator, both), "2:19", "in 100 % of the picture");
        }
        for rough in [
            "diffuse",
            "roughconductor",
            "roughdielectric",
            "roughplastic",
        ] {
            says_nothing(before(integrator, rough));
        }
    }
    // What follows light from the camera sees what is in mirrors.
    for integrator in ["path", "bdpt", "vcm", "sppm"] {
        for bsdf in ["conductor", "plastic"] {
            says_nothing(before(&named(integrator), bsdf));
        }
    }
}

#[test]
fn a_camera_that_sees_nothing_to_light_is_told() {
    // Within a ball of mirrors a point light can be neither hit nor connected with; a lamp is found.
    let room = |bsdf: &str| {
        format!(
            "<shape type=\"sphere\"><float name=\"radius\" value=\"9\"/>\
             <boolean name=\"flip_normals\" value=\"true\"/><bsdf type=\"{bsdf}\"/></shape>"
        )
    };
    let lamp = "<shape type=\"sphere\"><point name=\"center\" value=\"0, 0, -5\"/><emitter type=\"area\"/></shape>";
    for integrator in ["path", "bdpt", "guided", "direct"] {
        let behind = format!("<shape type=\"rectangle\"/>{POINT}");
        let past = load_shapes(&named(integrator), PINHOLE, &behind);
        remarks(past, "1:1", "the camera sees no light");
        let inside = |bsdf, light: &str| {
            let shapes = format!("{}{light}", room(bsdf));
            load_shapes(&named(integrator), PINHOLE, &shapes)
        };
        remarks(
            inside("conductor", POINT),
            "1:1",
            "the camera sees no light",
        );
        says_nothing(inside("roughconductor", POINT));
        says_nothing(inside("conductor", lamp));
    }
}

#[test]
fn light_that_glass_bends_is_missed_by_paths_from_the_camera_alone() {
    // Between the light and the wall stands a pane that covers all of the picture, or half of it, or none.
    let scene = |integrator: &str, left: f32, right: f32, bsdf: &str, light: &str| {
        let (middle, half) = (f32::midpoint(left, right), (right - left) / 2.0);
        let shapes = format!(
            "<shape type=\"rectangle\"><transform name=\"to_world\"><scale x=\"8\" y=\"8\"/>\
             <rotate y=\"1\" angle=\"180\"/><translate z=\"2\"/></transform></shape>\
             <shape type=\"rectangle\"><transform name=\"to_world\"><scale x=\"{half}\" y=\"9\"/>\
             <translate x=\"{middle}\" z=\"-1\"/></transform><bsdf type=\"{bsdf}\"/></shape>{light}"
        );
        load_shapes(&named(integrator), PINHOLE, &shapes)
    };
    let point =
        "<emitter type=\"point\"><point name=\"position\" x=\"0\" y=\"0\" z=\"-2\"/></emitter>";
    let sun = "<emitter type=\"directional\"><vector name=\"direction\" x=\"0\" y=\"0\" z=\"1\"/></emitter>";
    let lamp = "<shape type=\"sphere\"><point name=\"center\" value=\"0, 0, -2\"/><float name=\"radius\" value=\"0.1\"/>\
                <emitter type=\"area\"/></shape>";
    let missed = "cannot see light that comes through smooth glass to";
    for light in [point, sun] {
        for integrator in ["path", "guided", "distribution", "pssmlt"] {
            // Mutant rejected: nobody looks past the first surface in the way.
            let said = remarks(
                scene(integrator, -9.0, 9.0, "dielectric", light),
                "2:19",
                missed,
            );
            assert!(said.text.contains("100 %"), "{}", said.text);
        }
        let half = remarks(scene("path", 0.0, 9.0, "dielectric", light), "2:19", missed);
        let share = half.text.split("smooth glass to ").nth(1).expect("a share");
        let share: f64 = share
            .split(' ')
            .next()
            .expect("a number")
            .parse()
            .expect("a number");
        assert!((40.0..=60.0).contains(&share), "{share} %");
        for sees in ["bdpt", "vcm", "sppm"] {
            says_nothing(scene(sees, -9.0, 9.0, "dielectric", light));
        }
        // Past it, or straight through, or not at all.
        says_nothing(scene("path", 30.0, 40.0, "dielectric", light));
        for bsdf in ["thindielectric", "conductor", "roughdielectric", "diffuse"] {
            says_nothing(scene("path", -9.0, 9.0, bsdf, light));
        }
    }
    says_nothing(scene("path", -9.0, 9.0, "dielectric", lamp));
}

#[test]
fn what_splats_needs_a_filter_that_catches_them() {
    let narrow = "<film type=\"hdrfilm\"><rfilter type=\"tent\"><float name=\"radius\" value=\"1e-9\"/></rfilter></film>";
    for integrator in ["ptracer", "pssmlt", "mmlt"] {
        let scene = format!(
            "<scene version=\"3.0.0\">{}<sensor type=\"perspective\">{narrow}</sensor>{WALL}{LAMP}</scene>",
            named(integrator)
        );
        let said = Said::of(&scene, &[]);
        let narrow = said.text.contains("filter is so narrow");
        assert!(said.refused && narrow, "{}", said.text);
    }
}
