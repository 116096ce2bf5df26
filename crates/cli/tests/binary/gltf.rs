//! Scenes of glTF: the pictures of Mitsuba twins, and messages that speak of the JSON.

use crate::workshop::Workshop;
use base64::Engine;
use base64::prelude::BASE64_STANDARD;

/// A square of two triangles in the xy plane, with normals and texture coordinates.
const SQUARE: [f32; 32] = [
    -1.0, -1.0, 0.0, 1.0, -1.0, 0.0, 1.0, 1.0, 0.0, -1.0, 1.0, 0.0, // positions
    0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, // normals
    0.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0, // texture coordinates
];

/// A floor with a picture, the same square twice more, one of which shines, and two lights.
fn model() -> String {
    let floats = SQUARE.iter().flat_map(|x| x.to_le_bytes());
    let bytes: Vec<u8> = floats.chain([0, 1, 2, 0, 2, 3]).collect();
    let part = |material| {
        format!(
            r#"{{"primitives": [{{"attributes": {{"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}}, "indices": 3, "material": {material}}}]}}"#
        )
    };
    format!(
        r#"{{"asset": {{"version": "2.0"}}, "extensionsUsed": ["KHR_lights_punctual"],
"nodes": [
  {{"mesh": 0, "scale": [3, 3, 1], "rotation": [-0.7071068, 0, 0, 0.7071068]}},
  {{"mesh": 1, "translation": [-1, 0.6, 0], "rotation": [0, 0.3826834, 0, 0.9238795], "scale": [0.5, 0.5, 0.5]}},
  {{"mesh": 1, "translation": [1, 0.5, -1], "scale": [0.4, 0.5, 0.4]}},
  {{"mesh": 2, "translation": [0, 2.5, 0], "rotation": [0.7071068, 0, 0, 0.7071068], "scale": [0.5, 0.5, 0.5]}},
  {{"camera": 0, "translation": [0, 1, 5], "rotation": [-0.0499792, 0, 0, 0.9987503]}},
  {{"translation": [1.5, 3, 1], "rotation": [-0.7071068, 0, 0, 0.7071068], "extensions": {{"KHR_lights_punctual": {{"light": 0}}}}}}],
"meshes": [{}, {}, {}],
"materials": [
  {{"pbrMetallicRoughness": {{"baseColorTexture": {{"index": 0}}, "metallicFactor": 0, "roughnessFactor": 0.8}}}},
  {{"pbrMetallicRoughness": {{"baseColorFactor": [0.8, 0.4, 0.2, 1], "metallicFactor": 0.5, "roughnessFactor": 0.4}}}},
  {{"emissiveFactor": [1, 0.8, 0.6], "pbrMetallicRoughness": {{"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0}}}}],
"textures": [{{"source": 0}}], "images": [{{"uri": "halves.ppm"}}],
"cameras": [{{"type": "perspective", "perspective": {{"yfov": 0.8, "aspectRatio": 1.3333333, "znear": 0.01}}}}],
"extensions": {{"KHR_lights_punctual": {{"lights": [
  {{"type": "spot", "intensity": 4098, "spot": {{"innerConeAngle": 0.2, "outerConeAngle": 0.6}}}}]}}}},
"accessors": [
  {{"bufferView": 0, "count": 4, "type": "VEC3", "componentType": 5126}},
  {{"bufferView": 0, "byteOffset": 48, "count": 4, "type": "VEC3", "componentType": 5126}},
  {{"bufferView": 0, "byteOffset": 96, "count": 4, "type": "VEC2", "componentType": 5126}},
  {{"bufferView": 0, "byteOffset": 128, "count": 6, "type": "SCALAR", "componentType": 5121}}],
"bufferViews": [{{"buffer": 0, "byteLength": 134}}],
"buffers": [{{"byteLength": 134, "uri": "data:;base64,{}"}}]}}"#,
        part(0),
        part(1),
        part(2),
        BASE64_STANDARD.encode(bytes)
    )
}

const TWIN: &str = r#"<scene version="3.0.0">
<integrator type="path"/>
<sensor type="perspective"><float name="fov" value="45.8366236"/><string name="fov_axis" value="y"/>
  <transform name="to_world"><lookat origin="0,1,5" target="0,0.9001664,4.0049958" up="0,1,0"/></transform>
  <film type="hdrfilm"><integer name="width" value="32"/><integer name="height" value="24"/></film>
  <sampler type="sobol"><integer name="sample_count" value="64"/></sampler>
</sensor>
<shape type="rectangle"><transform name="to_world"><scale x="3" y="3"/><rotate x="1" angle="-90"/></transform>
  <bsdf type="twosided"><bsdf type="principled"><float name="roughness" value="0.8"/><float name="eta" value="1.5"/><string name="diffuse_model" value="lambert"/>
    <texture type="bitmap" name="base_color"><string name="filename" value="halves.ppm"/>
      <transform name="to_uv"><scale y="-1"/><translate y="1"/></transform></texture></bsdf></bsdf></shape>
<bsdf type="twosided" id="part"><bsdf type="principled"><rgb name="base_color" value="0.8,0.4,0.2"/>
  <float name="roughness" value="0.4"/><float name="metallic" value="0.5"/><float name="eta" value="1.5"/><string name="diffuse_model" value="lambert"/></bsdf></bsdf>
<shape type="rectangle"><ref id="part"/>
  <transform name="to_world"><scale value="0.5"/><rotate y="1" angle="45"/><translate x="-1" y="0.6"/></transform></shape>
<shape type="rectangle"><ref id="part"/>
  <transform name="to_world"><scale x="0.4" y="0.5"/><translate x="1" y="0.5" z="-1"/></transform></shape>
<shape type="rectangle"><transform name="to_world"><scale value="0.5"/><rotate x="1" angle="90"/><translate y="2.5"/></transform>
  <bsdf type="diffuse"><float name="reflectance" value="0"/></bsdf>
  <emitter type="area"><rgb name="radiance" value="1,0.8,0.6"/></emitter></shape>
<emitter type="spot"><rgb name="intensity" value="6"/><float name="cutoff_angle" value="34.3774677"/><float name="beam_width" value="11.4591559"/>
  <string name="falloff" value="quadratic_in_cosine"/>
  <transform name="to_world"><lookat origin="1.5,3,1" target="1.5,0,1" up="0,0,-1"/></transform></emitter>
</scene>"#;

/// Two columns and two rows of texels.
const PICTURE: &str = "P3\n2 2\n255\n200 40 40  60 200 60  60 60 200  230 230 230\n";

/// `compare` shows that means are within 4 % and tiles within 10 % (its α is 10⁻³). Mutant rejected: a lamp of a fifth less.
#[test]
fn twins_have_the_same_picture() {
    let workshop = Workshop::new();
    workshop.write("halves.ppm", PICTURE);
    workshop.write("a.gltf", model());
    workshop.write("b.xml", TWIN);
    workshop.write("dim.gltf", model().replace("4098", "3278"));
    for (scene, seed) in [("a.gltf", "1"), ("b.xml", "2"), ("dim.gltf", "3")] {
        let out = format!("{scene}.exr");
        let arguments = [
            "render", scene, "-q", "--spp", "2048", "--size", "32x24", "--seed", seed, "-o", &out,
        ];
        workshop.run(&arguments).fine();
    }
    let compare = |other: &str| {
        let bounds = ["--bound", "0.02", "--tile-bound", "0.1"];
        workshop.run(&[&["compare", other, "b.xml.exr"], &bounds[..]].concat())
    };
    let same = compare("a.gltf.exr");
    assert_eq!(same.code, Some(0), "{}{}", same.stdout, same.stderr);
    let other = compare("dim.gltf.exr");
    assert_eq!(other.code, Some(1), "{}{}", other.stdout, other.stderr);
}

#[test]
fn mistakes_are_shown_in_the_json() {
    let workshop = Workshop::new();
    workshop.write(
        "a.gltf",
        model().replace("\"material\": 1", "\"material\": 9"),
    );
    let ran = workshop.run(&["render", "a.gltf", "-o", "a.exr"]).refused();
    let expected = "`meshes[1].primitives[0].material` is `9`: there is nothing of this number";
    assert!(ran.stderr.contains(expected), "{}", ran.stderr);
    assert!(ran.stderr.contains("a.gltf:9:"), "{}", ran.stderr);
    // A picture that is not there is told where the JSON names it.
    workshop.write("a.gltf", model());
    let ran = workshop.run(&["render", "a.gltf", "-o", "a.exr"]).refused();
    assert!(
        ran.stderr.contains("`halves.ppm` was not found"),
        "{}",
        ran.stderr
    );
    assert!(ran.stderr.contains("a.gltf:14:"), "{}", ran.stderr);
}

/// Other scenes say themselves what lights them.
#[test]
fn surroundings_are_an_option_of_gltf_alone() {
    let workshop = Workshop::new();
    workshop.write("sky.pfm", sky());
    workshop.write("halves.ppm", PICTURE);
    workshop.write("a.gltf", model());
    workshop.write("b.xml", TWIN);
    let with_sky = |scene| {
        let arguments = [
            "render",
            scene,
            "-q",
            "--spp",
            "16",
            "--size",
            "8x6",
            "--environment",
            "sky.pfm",
            "-o",
            "a.exr",
        ];
        workshop.run(&arguments)
    };
    with_sky("a.gltf").fine();
    let ran = with_sky("b.xml").refused();
    let expected = "the surroundings `sky.pfm` are for scenes of glTF";
    assert!(ran.stderr.contains(expected), "{}", ran.stderr);
}

/// An even picture of 2 × 1 pixels.
fn sky() -> Vec<u8> {
    let mut bytes = b"PF\n2 1\n-1.0\n".to_vec();
    bytes.extend([2.0_f32; 6].iter().flat_map(|x| x.to_le_bytes()));
    bytes
}
