//! What is said of mistakes: all of them in one run, each where it stands.

use crate::reading::{document, read, read_with};

const OBJECTS: [(&str, &str); 10] = [
    ("bsdf", "<bsdf type=\"diffuse\"/>"),
    ("emitter", "<emitter type=\"constant\"/>"),
    ("film", "<film type=\"hdrfilm\"/>"),
    ("integrator", "<integrator type=\"path\"/>"),
    ("rfilter", "<rfilter type=\"box\"/>"),
    ("sampler", "<sampler type=\"independent\"/>"),
    ("sensor", "<sensor type=\"perspective\"/>"),
    ("shape", "<shape type=\"sphere\"/>"),
    ("texture", "<texture type=\"checkerboard\"/>"),
    ("phase", "<phase type=\"isotropic\"/>"),
];

/// For every kind of object, what it may hold without a name.
const HOSTS: [(&str, &str, &[&str]); 10] = [
    ("<shape type=\"sphere\">", "</shape>", &["bsdf"]),
    ("<shape type=\"shapegroup\">", "</shape>", &["shape"]),
    ("<shape type=\"merge\">", "</shape>", &["shape"]),
    ("<bsdf type=\"diffuse\">", "</bsdf>", &[]),
    ("<bsdf type=\"roughconductor\">", "</bsdf>", &[]),
    ("<emitter type=\"point\">", "</emitter>", &[]),
    ("<emitter type=\"constant\">", "</emitter>", &[]),
    ("<texture type=\"checkerboard\">", "</texture>", &[]),
    (
        "<sensor type=\"perspective\">",
        "</sensor>",
        &["film", "sampler", "rfilter"],
    ),
    (
        "<sensor type=\"perspective\"><film type=\"hdrfilm\">",
        "</film></sensor>",
        &["rfilter"],
    ),
];

#[test]
fn no_object_is_swallowed_where_it_has_no_meaning() {
    for (open, close, accepted) in HOSTS {
        for (class, object) in OBJECTS {
            // A sensor in the first place: it is the one that is read.
            let text = format!("<scene version=\"3.0.0\">\n{open}\n{object}{close}\n");
            let rest = if open.starts_with("<sensor") {
                "</scene>"
            } else {
                "<sensor type=\"perspective\"/></scene>"
            };
            let read = read_with(&(text + rest), &[]);
            let refused = !read.errors.is_empty();
            let meant = accepted.contains(&class);
            assert_eq!(refused, !meant, "{class} in {open}: {:?}", read.errors);
            // The object itself is pointed at, or what holds it.
            let place = |e: &String| e.starts_with("3:") || e.starts_with("2:");
            assert!(
                read.errors.iter().all(place),
                "{class} in {open}: {:?}",
                read.errors
            );
        }
    }
}

#[test]
fn every_mistake_is_found_in_one_run() {
    let read = read_with(
        "<scene version=\"3.0.0\">\n\
         <sensor type=\"perspective\">\n\
         <float name=\"fof\" value=\"3\"/>\n\
         <sampler type=\"independent\"><integer name=\"sample_count\" value=\"0\"/></sampler>\n\
         <film type=\"hdrfim\"/></sensor>\n\
         <bsdf type=\"diffuse\" id=\"unused\">\n<float name=\"alpha\" value=\"1\"/></bsdf>\n\
         <shape type=\"sphere\">\n<bsdf type=\"mirror\"/></shape>\n\
         <shape type=\"disk\">\n<float name=\"radius\" value=\"1\"/></shape>\n\
         <emitter type=\"point\">\n<float name=\"sampling_weight\" value=\"-1\"/></emitter>\n\
         <medium type=\"plasma\"/>\n\
         <float name=\"gamma\" value=\"2.2\"/>\n\
         </scene>",
        &[],
    );
    assert!(read.compiled.is_none());
    let lines: Vec<&str> = read
        .errors
        .iter()
        .filter_map(|e| e.split(':').next())
        .collect();
    for line in ["3", "4", "5", "7", "9", "11", "13", "14", "15"] {
        assert!(lines.contains(&line), "line {line}: {:#?}", read.errors);
    }
    assert_eq!(lines.len(), 9, "{:#?}", read.errors);
}

#[test]
fn what_cannot_affect_pixels_is_accepted() {
    let read = read(
        "<integer name=\"kd_max_depth\" value=\"4\"/>\n\
         <boolean name=\"embree_use_robust_intersections\" value=\"true\"/>",
    );
    assert_eq!(read.errors, Vec::<String>::new());
}

/// A triangle whose corners have colours.
const COLOURED: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n\
    property float y\nproperty float z\nproperty float r\nproperty float g\nproperty float b\n\
    element face 1\nproperty list uchar int vertex_indices\nend_header\n\
    0 0 0 1 0 0\n1 0 0 0 1 0\n0 1 0 0 0 1\n3 0 1 2\n";

#[test]
fn mesh_attributes_must_exist() {
    let texture = |name: &str, parameter: &str| {
        format!(
            "<texture type=\"mesh_attribute\" name=\"{parameter}\">\
             <string name=\"name\" value=\"{name}\"/></texture>"
        )
    };
    let diffuse = |name: &str| {
        format!(
            "<bsdf type=\"diffuse\">{}</bsdf>",
            texture(name, "reflectance")
        )
    };
    let shape = |head: &str, content: &str| format!("<shape type={head}\n{content}\n</shape>\n");
    let mesh = "\"ply\"><string name=\"filename\" value=\"t.ply\"/>";
    let found = |content: String| {
        let read = read_with(&document(&content), &[("t.ply", COLOURED)]);
        read.errors
    };
    assert_eq!(
        found(shape(mesh, &diffuse("vertex_color"))),
        Vec::<String>::new()
    );

    let wrong = found(shape(mesh, &diffuse("vertex_colour")));
    assert_eq!(wrong.len(), 1, "{wrong:?}");
    assert!(
        wrong[0].starts_with("3:") && wrong[0].contains("vertex_colour"),
        "{wrong:?}"
    );

    // Other shapes have none; a light asks as a material does; deep inside others is found too.
    let sphere = "\"sphere\">";
    assert_eq!(found(shape(sphere, &diffuse("vertex_color"))).len(), 1);
    let light = format!(
        "<emitter type=\"area\">{}</emitter>",
        texture("face_glow", "radiance")
    );
    assert_eq!(found(shape(mesh, &light)).len(), 1);
    let deep = format!("<bsdf type=\"twosided\">{}</bsdf>", diffuse("vertex_none"));
    assert_eq!(found(shape(mesh, &deep)).len(), 1);

    // A shared material is asked about for each of its shapes.
    let shared = diffuse("vertex_color").replacen("<bsdf ", "<bsdf id=\"m\" ", 1) + "\n";
    let reference = "<ref id=\"m\"/>";
    assert_eq!(
        found(shared.clone() + &shape(mesh, reference)),
        Vec::<String>::new()
    );
    assert_eq!(
        found(shared + &shape(mesh, reference) + &shape(sphere, reference)).len(),
        1
    );
    let group = format!(
        "<shape type=\"shapegroup\" id=\"g\">{}</shape>",
        shape(sphere, &diffuse("vertex_color"))
    );
    assert_eq!(found(group).len(), 1);
}

/// The only mistake of a scene with a sensor and `body`.
fn only_mistake(body: &str) -> String {
    let scene = format!(
        "<scene version=\"3.0.0\"><sensor type=\"perspective\">\
         <float name=\"shutter_close\" value=\"1\"/></sensor>{body}</scene>"
    );
    let read = read_with(&scene, &[]);
    assert_eq!(read.errors.len(), 1, "{body}: {:?}", read.errors);
    read.errors[0].clone()
}

#[test]
fn solids_that_are_none() {
    let shape = |plugin: &str, inside: &str| format!("<shape type=\"{plugin}\">{inside}</shape>");
    let sphere = "<shape type=\"sphere\"/>";
    for (body, words) in [
        (shape("union", ""), "solids to make it of"),
        (
            shape("difference", &format!("{sphere}{}", shape("disk", ""))),
            "a `disk` bounds no volume",
        ),
        (
            shape("union", &shape("sphere", "<emitter type=\"area\"/>")),
            "an operand cannot emit light",
        ),
        (
            shape(
                "intersection",
                &format!("{sphere}{}", shape("shapegroup", "")),
            ),
            "solids that stand still",
        ),
        (
            shape("quadric", "<emitter type=\"area\"/>"),
            "a `quadric` cannot emit light here",
        ),
        (shape("unoin", sphere), "unknown shape plugin"),
    ] {
        let mistake = only_mistake(&body);
        assert!(mistake.contains(words), "{mistake}");
    }
}

#[test]
fn what_a_displaced_shape_is_made_of_stands_beside_it() {
    let displacement = |inside: &str| {
        format!(
            "<shape type=\"displacement\"><float name=\"height\" value=\"0\"/>\
             <float name=\"edge_length\" value=\"1\"/>\
             <shape type=\"rectangle\">{inside}</shape></shape>"
        )
    };
    let errors = read_with(&document(&displacement("")), &[]).errors;
    assert_eq!(errors, Vec::<String>::new());
    for (inside, class) in [
        ("<bsdf type=\"diffuse\"/>", "bsdf"),
        ("<emitter type=\"area\"/>", "emitter"),
        ("<medium type=\"homogeneous\" name=\"interior\"/>", "medium"),
        ("<subsurface type=\"dipole\"/>", "subsurface"),
    ] {
        let mistake = only_mistake(&displacement(inside));
        let words = format!(
            "the {class} of a shape that is moved by a texture belongs to the `displacement`"
        );
        assert!(mistake.contains(&words), "{mistake}");
    }
}

#[test]
fn motions_that_are_none() {
    let sphere = |inside: &str| {
        format!("<shape type=\"sphere\"><animation name=\"to_world\">{inside}</animation></shape>")
    };
    let key = |time: &str, inside: &str| format!("<transform time=\"{time}\">{inside}</transform>");
    let still = "<translate x=\"1\"/>";
    for (body, words) in [
        (sphere(""), "needs a key at least"),
        (
            sphere(&(key("1", still) + &key("0", still))),
            "must be after that before it",
        ),
        (
            sphere(&(key("0", still) + &key("1", "<scale x=\"-1\"/>"))),
            "one of two keys mirrors space",
        ),
        (
            sphere(&(key("0", still) + &key("1", "<scale x=\"0\"/>"))),
            "the transform of a key cannot be undone",
        ),
        (
            sphere(still),
            "`<translate>` cannot stand in an `<animation>`",
        ),
        (
            sphere(&key("0", "<scale x=\"2\"/>"))
                .replace("</shape>", "<emitter type=\"area\"/></shape>"),
            "a light that moves must keep its angles",
        ),
        (
            "<emitter type=\"envmap\"><animation name=\"to_world\"/><string name=\"filename\" \
             value=\"none.exr\"/></emitter>"
                .to_owned(),
            "needs a key at least",
        ),
    ] {
        let read = read_with(
            &format!("<scene version=\"3.0.0\"><sensor type=\"perspective\"/>{body}</scene>"),
            &[],
        );
        assert!(
            read.errors.iter().any(|error| error.contains(words)),
            "{body}: {:?}",
            read.errors
        );
    }
}

#[test]
fn media_and_bumps_that_are_none() {
    let sphere = |inside: &str| format!("<shape type=\"sphere\">{inside}</shape>");
    let bsdf = |inside: &str| sphere(&format!("<bsdf type=\"{inside}</bsdf>"));
    for (body, words) in [
        (
            sphere("<medium type=\"homogeneous\"/>"),
            "a medium on which side",
        ),
        (
            sphere("<medium name=\"interior\" type=\"plasma\"/>"),
            "unknown medium plugin `plasma`",
        ),
        (
            sphere(
                "<medium name=\"interior\" type=\"homogeneous\"><float name=\"scale\" value=\"-1\"/></medium>",
            ),
            "`scale` of `homogeneous` cannot be -1",
        ),
        (
            sphere(
                "<medium name=\"interior\" type=\"homogeneous\"><phase type=\"hg\"><float name=\"g\" \
                 value=\"1\"/></phase></medium>",
            ),
            "`g` of `hg` cannot be 1",
        ),
        (
            bsdf("bumpmap\"><bsdf type=\"diffuse\"/>"),
            "a texture of heights",
        ),
        (
            bsdf(
                "bumpmap\"><texture type=\"checkerboard\"/><bsdf type=\"bumpmap\"><texture \
                 type=\"checkerboard\"/><bsdf type=\"diffuse\"/></bsdf>",
            ),
            "cannot hold another material that tilts normals",
        ),
    ] {
        let mistake = only_mistake(&body);
        assert!(mistake.contains(words), "{mistake}");
    }
}
