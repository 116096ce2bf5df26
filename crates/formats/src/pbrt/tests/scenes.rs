//! What scenes mean: the graphics state, blocks, names and settings.

use super::super::{ColorSpace, TextureKind};
use super::scene;
use etalon_params::DVec3;

const SCENE: &str = r#"
    Option "disable-pixel-jitter" true Option "seed" 7 Option "msereferenceimage" "r.exr"
    LookAt 0 0 5  0 0 0  0 1 0
    Camera "perspective" "float fov" 45
    Film "rgb" "integer xresolution" [ 8 ] "integer yresolution" [ 4 ]
    ColorSpace "Rec2020"
    WorldBegin
    MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_s" [ 1 2 3 ]
    Texture "t" "float" "constant" "float value" .5
    Texture "t" "spectrum" "scale" "spectrum tex" [ 400 1 700 .5 ] "texture scale" "t"
    MakeNamedMaterial "red" "string type" [ "diffuse" ] "texture reflectance" "t"
    AttributeBegin
      Translate 1 0 0
      NamedMaterial "red"
      AreaLightSource "diffuse" "blackbody L" 5000
      MediumInterface "fog" ""
      ReverseOrientation
      ColorSpace "srgb"
      Shape "sphere" "float radius" 2
    AttributeEnd
    Shape "disk"
    LightSource "infinite"
"#;

#[test]
fn the_state_at_a_shape() {
    let scene = scene(SCENE);
    assert_eq!(scene.camera.entity.kind, "perspective");
    assert_eq!(scene.sampler.kind, "zsobol", "pbrt's default");
    let options = &scene.options;
    assert_eq!(
        options.disable_pixel_jitter.as_ref().map(|o| o.value),
        Some(true)
    );
    assert_eq!(options.seed.as_ref().map(|o| o.value), Some(7));
    let [sphere, disk] = scene.shapes.as_slice() else {
        panic!("{} shapes", scene.shapes.len());
    };
    let moved = sphere.placement.start.transform_point3(DVec3::ZERO);
    assert_eq!(moved, DVec3::X, "the CTM of the camera is gone");
    assert!(sphere.reverse_orientation && !sphere.placement.is_animated());
    let red = &scene.materials[sphere.material];
    assert_eq!(
        red.name.as_ref().map(|name| name.value.as_str()),
        Some("red")
    );
    assert_eq!(red.entity.kind, "diffuse");
    assert_eq!(
        sphere.area_light.as_ref().map(|light| light.kind),
        Some("diffuse")
    );
    assert_eq!((sphere.inside, sphere.outside), (Some(0), None));
    let fog = &scene.media[0].entity.params;
    let space = |name| fog.find(name).map(|parameter| parameter.color_space);
    assert_eq!(space("sigma_s"), Some(ColorSpace::Rec2020));
    let radius = sphere.entity.params.find("radius").expect("a radius");
    assert_eq!(radius.color_space, ColorSpace::Srgb);

    assert_eq!((disk.material, disk.inside, disk.outside), (0, None, None));
    assert_eq!(scene.materials[0].entity.kind, "diffuse", "pbrt's default");
    assert!(disk.area_light.is_none() && !disk.reverse_orientation);
    assert_eq!(scene.lights.len(), 1);
}

#[test]
fn float_and_spectrum_textures_have_names_of_their_own() {
    let scene = scene(SCENE);
    assert_eq!(scene.texture(TextureKind::Float, "t"), Some(0));
    assert_eq!(scene.texture(TextureKind::Spectrum, "t"), Some(1));
    // A spectrum texture that is scaled by the float texture of the same name contains not itself.
    assert_eq!(scene.texture_order, [0, 1]);
}

#[test]
fn names_may_be_used_before_they_are_defined() {
    let scene = scene(
        r#"WorldBegin
        Material "mix" "string materials" [ "b" "a" ]
        MediumInterface "fog"
        Texture "x" "float" "scale" "texture tex" "y"
        Texture "y" "float" "constant"
        NamedMaterial "b" Shape "sphere"
        ObjectInstance "later"
        MakeNamedMaterial "a" "string type" "diffuse"
        MakeNamedMaterial "b" "string type" "mix" "string materials" [ "a" "a" ]
        MakeNamedMedium "fog" "string type" "homogeneous"
        ObjectBegin "later" Shape "disk" ObjectEnd"#,
    );
    let place = |name: &str| {
        let named = |id: &usize| {
            let material = scene.materials[*id].name.as_ref();
            material.is_some_and(|material| material.value == name)
        };
        scene.material_order.iter().position(named)
    };
    assert!(place("a") < place("b"));
    assert_eq!(scene.texture_order, [1, 0]);
    assert_eq!(
        (scene.shapes[0].inside, scene.shapes[0].outside),
        (Some(0), Some(0))
    );
    assert_eq!(scene.objects[scene.instances[0].object].shapes.len(), 1);
}

#[test]
fn objects_keep_their_shapes_and_instances() {
    let scene = scene(
        r#"WorldBegin
        Translate 0 0 1
        ObjectBegin "inner" Material "interface" Translate 1 0 0 Shape "sphere" ObjectEnd
        ObjectBegin "outer" ObjectInstance "inner" Shape "disk" ObjectEnd
        Identity
        ObjectInstance "outer"
        Shape "cylinder""#,
    );
    assert_eq!((scene.shapes.len(), scene.instances.len()), (1, 1));
    let outer = &scene.objects[scene.instances[0].object];
    assert_eq!(outer.name.value, "outer");
    let inner = &scene.objects[outer.instances[0].object];
    assert_eq!((outer.shapes.len(), inner.shapes.len()), (1, 1));
    let centre = inner.shapes[0]
        .placement
        .start
        .transform_point3(DVec3::ZERO);
    assert_eq!(centre, DVec3::new(1.0, 0.0, 1.0));
    assert_eq!(scene.object_order, [0, 1]);
    // The block of the definition has its own material.
    assert_eq!(scene.shapes[0].material, 0);
}

#[test]
fn motion_has_two_transforms_and_their_times() {
    let scene = scene(
        r#"TransformTimes 1 3
        ActiveTransform EndTime Translate 0 0 9
        Camera "perspective"
        WorldBegin
        Translate 1 0 0 ActiveTransform EndTime Translate 0 2 0 CoordinateSystem "here"
        Shape "sphere"
        ActiveTransform All Identity Shape "sphere"
        ActiveTransform StartTime CoordSysTransform "here" Shape "sphere""#,
    );
    assert!(scene.camera.placement.is_animated());
    let places: Vec<[DVec3; 2]> = scene
        .shapes
        .iter()
        .map(|shape| {
            let place = |m: etalon_params::DMat4| m.transform_point3(DVec3::ZERO);
            [place(shape.placement.start), place(shape.placement.end)]
        })
        .collect();
    let moving = [DVec3::X, DVec3::new(1.0, 2.0, 0.0)];
    assert_eq!(places, [moving, [DVec3::ZERO; 2], moving]);
    assert_eq!(scene.shapes[0].placement.times, [1.0, 3.0]);
}

#[test]
fn coordinate_systems_of_the_camera_and_the_world() {
    let scene = scene(
        r#"Translate 0 0 5 Camera "perspective" WorldBegin
        CoordSysTransform "camera" LightSource "point"
        CoordSysTransform "world" Shape "sphere"
        Transform [ 1 0 0 0  0 1 0 0  0 0 1 0  7 8 9 1 ] Shape "sphere""#,
    );
    let place = |m: etalon_params::DMat4| m.transform_point3(DVec3::ZERO);
    assert_eq!(
        place(scene.lights[0].placement.start),
        DVec3::new(0.0, 0.0, -5.0)
    );
    assert_eq!(place(scene.shapes[0].placement.start), DVec3::ZERO);
    assert_eq!(
        place(scene.shapes[1].placement.start),
        DVec3::new(7.0, 8.0, 9.0)
    );
}

#[test]
fn attributes_hold_unless_an_entity_says_otherwise() {
    let scene = scene(
        r#"WorldBegin
        Attribute "shape" "float alpha" 1 "float radius" 1
        AttributeBegin
          Attribute "shape" "float radius" 2
          Shape "sphere"
          Shape "sphere" "float radius" 3
        AttributeEnd
        Shape "sphere""#,
    );
    let radius = |i: usize| match &scene.shapes[i]
        .entity
        .params
        .find("radius")
        .map(|p| &p.values)
    {
        Some(super::super::Values::Numbers(numbers)) => numbers[0],
        other => panic!("{other:?}"),
    };
    assert_eq!([radius(0), radius(1), radius(2)], [2.0, 3.0, 1.0]);
    assert!(scene.shapes[0].entity.params.find("alpha").is_some());
}
