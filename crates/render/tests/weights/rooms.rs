//! Three scenes: a ball on a floor before a wall, lamps of all kinds, a camera of each kind.

use etalon_render::pipeline::{LoadOptions, Loaded, load};
use std::path::Path;

const RECTANGLE: &str = r#"<shape type="rectangle">
    <transform name="to_world"><scale value="0.6"/><rotate x="1" angle="90"/>
        <translate y="3"/></transform>
    <emitter type="area"><rgb name="radiance" value="3, 2, 1"/></emitter>
</shape>"#;
const BULB: &str = r#"<shape type="sphere">
    <point name="center" x="-1.5" y="2" z="0.5"/><float name="radius" value="0.4"/>
    <emitter type="area"><rgb name="radiance" value="1, 2, 3"/></emitter>
</shape>"#;
/// Inside the ball.
const KERNEL: &str = r#"<shape type="sphere">
    <point name="center" x="0" y="0.9" z="0"/><float name="radius" value="0.35"/>
    <emitter type="area"><rgb name="radiance" value="2, 2, 1"/></emitter>
</shape>"#;
const POINT: &str = r#"<emitter type="point">
    <point name="position" x="1" y="2.5" z="1"/><rgb name="intensity" value="2, 1, 2"/>
</emitter>"#;
const PARALLEL: &str = r#"<emitter type="directional">
    <vector name="direction" x="0.3" y="-1" z="-0.4"/><rgb name="irradiance" value="1, 2, 1"/>
</emitter>"#;
const SKY: &str = r#"<emitter type="envmap"><string name="filename" value="sky.exr"/></emitter>"#;

const DIFFUSE: &str =
    r#"<bsdf type="diffuse"><rgb name="reflectance" value="0.7, 0.4, 0.2"/></bsdf>"#;
const PHONG: &str = r#"<bsdf type="phong"><float name="exponent" value="12"/>
    <rgb name="specular_reflectance" value="0.2, 0.3, 0.5"/></bsdf>"#;
const METAL: &str = r#"<bsdf type="roughconductor"><float name="alpha" value="0.35"/>
    <string name="material" value="Cu"/></bsdf>"#;
const MIRROR: &str = r#"<bsdf type="conductor"><string name="material" value="Au"/></bsdf>"#;
const FROSTED: &str = r#"<bsdf type="roughdielectric"><float name="alpha" value="0.3"/>
    <string name="int_ior" value="cauchy: 1.4 0.04"/></bsdf>"#;
const PRISM: &str =
    r#"<bsdf type="dielectric"><string name="int_ior" value="cauchy: 1.4 0.04"/></bsdf>"#;

const PINHOLE: &str = r#"type="perspective"><float name="fov" value="32"/>"#;
const LENS: &str = r#"type="thinlens"><float name="fov" value="32"/>
    <float name="aperture_radius" value="0.2"/><float name="focus_distance" value="4"/>"#;
const ORTHOGRAPHIC: &str = r#"type="orthographic">"#;

/// The scenes.
pub(crate) fn all() -> [Loaded; 3] {
    [
        room(
            &[RECTANGLE, KERNEL, POINT],
            PINHOLE,
            [DIFFUSE, PHONG, PRISM],
        ),
        room(&[SKY], LENS, [METAL, DIFFUSE, FROSTED]),
        room(&[BULB, PARALLEL], ORTHOGRAPHIC, [PHONG, METAL, MIRROR]),
    ]
}

/// Compiles a scene with these lamps, this camera and the materials of floor, wall and ball.
fn room(lamps: &[&str], camera: &str, [floor, wall, ball]: [&str; 3]) -> Loaded {
    // An orthographic camera is as wide as its transformation says.
    let scale = if camera == ORTHOGRAPHIC { 2.0 } else { 1.0 };
    let xml = format!(
        r#"<scene version="3.0.0">
<integrator type="path"/>
<sensor {camera}
    <transform name="to_world"><scale x="{scale}" y="{scale}" z="1"/>
        <lookat origin="0.5, 1.8, 4" target="0, 0.7, 0" up="0, 1, 0"/></transform>
    <film type="hdrfilm"><integer name="width" value="32"/><integer name="height" value="32"/>
        <rfilter type="box"/></film>
</sensor>
<shape type="rectangle"><transform name="to_world"><scale value="3"/>
    <rotate x="1" angle="-90"/></transform>{floor}</shape>
<shape type="rectangle"><transform name="to_world"><scale value="3"/>
    <translate z="-2"/></transform>{wall}</shape>
<shape type="sphere"><point name="center" x="0" y="0.9" z="0"/>
    <float name="radius" value="0.8"/>{ball}</shape>
{}
</scene>"#,
        lamps.concat()
    );
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let path = folder.path().join("scene.xml");
    std::fs::write(&path, xml).expect("a temporary file can be written");
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/spheres");
    let options = LoadOptions {
        data: vec![data],
        ..LoadOptions::default()
    };
    load(&path, &options).unwrap_or_else(|refusal| panic!("{:#?}", refusal.diagnostics))
}
