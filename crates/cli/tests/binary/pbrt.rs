//! Scenes of pbrt: the pictures of Mitsuba twins, and messages that speak of pbrt's text.

use crate::workshop::Workshop;

/// Pixels of both, a box filter, four bounces.
const PBRT: &str = r#"
Film "rgb" "integer xresolution" 32 "integer yresolution" 24
PixelFilter "box"
Sampler "independent" "integer pixelsamples" 16
Integrator "path" "integer maxdepth" 4
LookAt 0 -4 1.5  0 0 0.5  0 0 1
Camera "perspective" "float fov" 40
WorldBegin
AttributeBegin
  Material "diffuse" "rgb reflectance" [ 0.6 0.5 0.3 ]
  Shape "disk" "float radius" 5
AttributeEnd
AttributeBegin
  Material "dielectric" "float eta" 1.5
  Translate 0.7 0 0.5
  Shape "sphere" "float radius" 0.5
AttributeEnd
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [ 8 7 6 ]
  Translate -0.8 0.5 1.5
  Shape "sphere" "float radius" 0.25
AttributeEnd
LightSource "spot" "rgb I" [ 4 4 5 ] "point3 from" [ 1 -1 3 ] "point3 to" [ 0 0 0 ]
  "float coneangle" 20 "float conedeltaangle" 8
Shape "trianglemesh" "point3 P" [ -1.2 -0.4 0  -0.4 -0.6 0  -0.8 -0.5 0.9 ] "integer indices" [ 0 1 2 ]
"#;

/// pbrt's pictures have +x on the right where Mitsuba's have it on the left: the scale mirrors the twin's.
const TWIN: &str = r#"<scene version="3.0.0">
<integrator type="path"><integer name="max_depth" value="5"/></integrator>
<sensor type="perspective"><float name="fov" value="40"/><string name="fov_axis" value="smaller"/>
  <transform name="to_world"><scale x="-1"/><lookat origin="0,-4,1.5" target="0,0,0.5" up="0,0,1"/></transform>
  <film type="hdrfilm"><integer name="width" value="32"/><integer name="height" value="24"/><rfilter type="box"/></film>
  <sampler type="independent"><integer name="sample_count" value="16"/></sampler>
</sensor>
<shape type="disk"><transform name="to_world"><scale value="5"/></transform>
  <bsdf type="twosided"><bsdf type="diffuse"><rgb name="reflectance" value="0.6,0.5,0.3"/></bsdf></bsdf></shape>
<shape type="sphere"><point name="center" x="0.7" y="0" z="0.5"/><float name="radius" value="0.5"/>
  <bsdf type="dielectric"><float name="int_ior" value="1.5"/><float name="ext_ior" value="1"/></bsdf></shape>
<shape type="sphere"><point name="center" x="-0.8" y="0.5" z="1.5"/><float name="radius" value="0.25"/>
  <bsdf type="diffuse"><rgb name="reflectance" value="0.5"/></bsdf>
  <emitter type="area"><rgb name="radiance" value="8,7,6"/></emitter></shape>
<emitter type="spot"><rgb name="intensity" value="4,4,5"/><float name="cutoff_angle" value="20"/><float name="beam_width" value="12"/>
  <string name="falloff" value="smooth_in_cosine"/>
  <transform name="to_world"><lookat origin="1,-1,3" target="0,0,0" up="0,0,1"/></transform></emitter>
<shape type="obj"><string name="filename" value="triangle.obj"/><boolean name="face_normals" value="true"/>
  <bsdf type="twosided"><bsdf type="diffuse"><rgb name="reflectance" value="0.5"/></bsdf></bsdf></shape>
</scene>"#;

const TRIANGLE: &str = "v -1.2 -0.4 0\nv -0.4 -0.6 0\nv -0.8 -0.5 0.9\nf 1 2 3\n";

/// `compare` shows that means are within 4 % and tiles within 10 % (its α is 10⁻³). Mutant rejected: a light of a fifth less.
#[test]
fn twins_have_the_same_picture() {
    let workshop = Workshop::new();
    workshop.write("a.pbrt", PBRT);
    workshop.write("b.xml", TWIN);
    workshop.write("triangle.obj", TRIANGLE);
    workshop.write("dim.pbrt", PBRT.replace("[ 8 7 6 ]", "[ 6.4 5.6 4.8 ]"));
    for (scene, seed) in [("a.pbrt", "1"), ("b.xml", "2"), ("dim.pbrt", "3")] {
        let out = format!("{scene}.exr");
        let arguments = [
            "render", scene, "-q", "--spp", "4096", "--seed", seed, "-o", &out,
        ];
        workshop.run(&arguments).fine();
    }
    let same = workshop.run(&[
        "compare",
        "a.pbrt.exr",
        "b.xml.exr",
        "--bound",
        "0.02",
        "--tile-bound",
        "0.1",
    ]);
    assert_eq!(same.code, Some(0), "{}{}", same.stdout, same.stderr);
    let other = workshop.run(&[
        "compare",
        "dim.pbrt.exr",
        "b.xml.exr",
        "--bound",
        "0.02",
        "--tile-bound",
        "0.1",
    ]);
    assert_eq!(other.code, Some(1), "{}{}", other.stdout, other.stderr);
}

#[test]
fn mistakes_are_shown_in_the_file_of_pbrt() {
    let workshop = Workshop::new();
    workshop.write(
        "a.pbrt",
        PBRT.replace("float radius\" 5", "float radus\" 5"),
    );
    let ran = workshop.run(&["render", "a.pbrt", "-o", "a.exr"]).refused();
    assert!(ran.stderr.contains("a.pbrt:11:16"), "{}", ran.stderr);
    assert!(
        ran.stderr.contains("did you mean `radius`?"),
        "{}",
        ran.stderr
    );
    workshop.write(
        "b.pbrt",
        PBRT.replace(
            "\"spot\" \"rgb I\"",
            "\"spot\" \"rgb I\" [ 1 1 1 ] \"rgb J\"",
        ),
    );
    let ran = workshop
        .run(&["render", "b.pbrt", "-D", "a=1", "-o", "a.exr"])
        .refused();
    assert!(
        ran.stderr.contains("scenes of pbrt have no parameters"),
        "{}",
        ran.stderr
    );
    assert_eq!(workshop.files(), ["a.pbrt", "b.pbrt"]);
}

#[test]
fn info_knows_its_scenes() {
    let workshop = Workshop::new();
    workshop.write("a.pbrt", PBRT);
    let ran = workshop.run(&["info", "a.pbrt"]).fine();
    assert!(ran.stdout.contains("32 × 24"), "{}", ran.stdout);
}

/// The scene as XML, with its mesh and its curve in files beside, has the very same picture. What was read is not written over, and where nothing can
/// be written nothing is.
#[test]
fn scenes_become_xml_of_the_same_picture() {
    let workshop = Workshop::new();
    let curve = r#"Shape "curve" "string type" "cylinder" "point3 P" [ -1 0 0  0 0 1  0.5 0 -0.5  1 0 1 ] "float width" 0.2"#;
    workshop.write("a.pbrt", format!("{PBRT}{curve}"));
    let converted = workshop
        .run(&["convert-scene", "a.pbrt", "b.xml"])
        .fine()
        .stdout;
    assert_eq!(converted, "b.xml and 2 files beside it\n");
    assert_eq!(
        workshop.files(),
        ["a.pbrt", "b-file-0.txt", "b-mesh-0.ply", "b.xml"]
    );
    for (scene, out) in [("a.pbrt", "a.exr"), ("b.xml", "b.exr")] {
        workshop
            .run(&["render", scene, "-q", "--spp", "16", "-o", out])
            .fine();
    }
    let planes = |name: &str| {
        let image = workshop.image(name).image;
        ["R", "G", "B"].map(|name| image.channel(name).expect("a channel").to_vec())
    };
    assert_eq!(planes("a.exr"), planes("b.exr"));
    for (arguments, said) in [
        (["a.pbrt", "a.pbrt"], "the name must end in .xml"),
        (["b.xml", "b.xml"], "is read from"),
        (["a.pbrt", "nowhere/b.xml"], "there is no such folder"),
        (["a.exr", "c.xml"], "is no scene"),
    ] {
        let [input, output] = arguments;
        let ran = workshop.run(&["convert-scene", input, output]).refused();
        assert!(ran.stderr.contains(said), "{}", ran.stderr);
    }
}
