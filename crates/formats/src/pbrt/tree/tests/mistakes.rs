//! What is refused, and where.

use super::*;

#[track_caller]
fn assert_refused(text: &str, expected: &str) {
    let outcome = world(text);
    assert_eq!(outcome.lines(), expected);
    assert!(outcome.document.is_none());
}

#[test]
fn what_has_no_equal_is_named_at_its_place() {
    assert_refused(
        "Shape \"loopsubdiv\" \"integer levels\" 14 \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"integer indices\" [ 0 1 2 ]",
        "a.pbrt:2:37: error: 1 triangles in 14 steps become more than 67108864",
    );
    assert_refused(
        "Shape \"loopsubdiv\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 0 0 1 ] \"integer indices\" [ 0 1 2 1 3 2 0 1 3 ]",
        "a.pbrt:2:77: error: the triangles around point 0 are no single fan, or are turned against each other: such a mesh cannot be subdivided",
    );
    assert_refused(
        "Material \"conductor\" \"spectrum eta\" \"metal-CuZn-eta\" \"spectrum k\" \"metal-CuZn-k\" Shape \"sphere\"",
        "a.pbrt:2:37: error: Etalon does not have pbrt's metal `CuZn` (accepted: metal-Ag, -Al, -Au, -Cu, -MgO, -TiO2 (each with -eta and -k), or pairs of a wavelength and a value)",
    );
}

#[test]
fn mistakes_of_values() {
    assert_refused(
        "Material \"diffuse\" \"rgb reflectance\" [ 1.5 0 0 ] Shape \"sphere\"",
        "a.pbrt:2:38: error: `reflectance` of `diffuse` cannot be (1.5, 0, 0) (accepted: numbers from 0 to 1)",
    );
    assert_refused(
        "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"integer indices\" [ 0 1 3 ]",
        "a.pbrt:2:73: error: `indices` of `trianglemesh` cannot be 3 (accepted: integers from 0 to 2)",
    );
    assert_refused(
        "Shape \"sphere\" \"float radus\" 2",
        "a.pbrt:2:16: error: `sphere` has no parameter `radus` (did you mean `radius`?)",
    );
    assert_refused(
        "Shape \"plymesh\" \"string filename\" \"nowhere.ply\"",
        "a.pbrt:2:35: error: the file `nowhere.ply` was not found (looked in the current folder)",
    );
}

#[test]
fn what_belongs_together() {
    assert_refused(
        "Material \"subsurface\" \"rgb sigma_a\" [ 1 1 1 ] Shape \"sphere\"",
        "a.pbrt:2:37: error: `sigma_a` and `sigma_s` need each other",
    );
    assert_refused(
        "LightSource \"infinite\" \"string filename\" \"a.exr\" \"rgb L\" [ 1 1 1 ]",
        "a.pbrt:2:42: error: a light has either `L` or `filename`",
    );
    assert_refused(
        "LightSource \"infinite\" \"string filename\" \"nowhere.exr\" \"float illuminance\" 1",
        "a.pbrt:2:42: error: the file `nowhere.exr` was not found (looked in the current folder)",
    );
    assert_refused(
        "Shape \"curve\" \"point3 P\" [ 0 0 0 1 0 0 1 1 0 1 1 1 2 2 2 ]",
        "a.pbrt:2:26: error: a curve of degree 3 cannot have 5 points `P`: it takes 4 and 3 for each further segment",
    );
    assert_refused(
        "Shape \"curve\" \"string type\" \"ribbon\" \"point3 P\" [ 0 0 0 1 0 0 1 1 0 1 1 1 ]",
        "a.pbrt:2:49: error: a ribbon of 1 segments takes 2 normals `N`, not 0",
    );
}

#[test]
fn several_mistakes_in_one_run() {
    let outcome = read(
        "Film \"rgb\" \"integer xresolution\" 0 PixelFilter \"sinc\" \"float tau\" 2.5 Camera \"realistic\" WorldBegin LightSource \"projection\" \"string filename\" \"a.png\" \"float fov\" 200 Shape \"curve\"",
    );
    assert_eq!(outcome.lines().lines().count(), 5, "{}", outcome.lines());
}

#[test]
fn options_of_the_command_line() {
    let options = ReadOptions {
        defines: vec![("a".to_owned(), "1".to_owned())],
        ..ReadOptions::default()
    };
    let outcome = pbrt::read_text("a.pbrt", "WorldBegin", &options);
    let expected = "error: scenes of pbrt have no parameters: `a` cannot be set by `-D`";
    assert_eq!(outcome.lines(), expected);
    let outcome = read("Option \"forcediffuse\" true WorldBegin");
    let expected =
        "a.pbrt:1:23: error: Etalon does not have pbrt's option `forcediffuse` (accepted: false)";
    assert_eq!(outcome.lines(), expected);
}

#[test]
fn places_are_those_of_the_parameters() {
    let document =
        sound("WorldBegin\nMaterial \"dielectric\"\n \"float eta\" 1.4\nShape \"sphere\"");
    let shape = children(&document.root).pop().expect("a shape");
    let glass = children(&shape).pop().expect("a material");
    let eta = glass
        .properties
        .iter()
        .find(|p| p.name == "int_ior")
        .expect("an index");
    assert_eq!((eta.span.start, eta.span.end), (46, 49));
}
