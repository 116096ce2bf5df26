//! A whole scene.

use super::*;

#[test]
fn a_scene_of_many_parts() {
    let text = r#"
        LookAt 0 1 5  0 1 0  0 1 0
        Camera "perspective" "float fov" 40
        Film "rgb" "integer xresolution" 64 "integer yresolution" 48 "string filename" "a.exr"
        Sampler "zsobol" "integer pixelsamples" 32
        PixelFilter "triangle" "float xradius" 1 "float yradius" 1
        Integrator "path" "integer maxdepth" 4 "string lightsampler" "power"
        Accelerator "bvh" "string splitmethod" "hlbvh"
        WorldBegin
        AttributeBegin
            AreaLightSource "diffuse" "rgb L" [ 10 9 8 ]
            Translate 0 2 0 Rotate 90 1 0 0 Shape "disk"
        AttributeEnd
        MakeNamedMaterial "red" "string type" "diffuse" "rgb reflectance" [ 0.8 0.1 0.1 ]
        NamedMaterial "red"
        Shape "trianglemesh" "point3 P" [ -1 0 -1  1 0 -1  1 0 1 ] "integer indices" [ 0 1 2 ]
    "#;
    let document = sound(text);
    let plugins: Vec<String> = (children(&document.root).iter())
        .map(|node| node.plugin.value.clone())
        .collect();
    assert_eq!(plugins, ["path", "perspective", "disk", "ply"]);
    assert_eq!(document.meshes.len(), 1);
}
