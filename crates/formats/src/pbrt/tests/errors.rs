//! Messages, each with its place.

use super::{parsed, world};

/// The messages about a world, which begins in line 2.
fn lines(text: &str) -> String {
    world(text).lines()
}

#[test]
fn numbers_that_are_none() {
    assert_eq!(
        lines(r#"Shape "trianglemesh" "point3 P" [ 1 2 x, 4 ] "integer indices" [ 0 1.5 2 ]"#),
        "a.pbrt:2:39: error: `x,` is not a number (numbers are separated by blanks)\n\
         a.pbrt:2:68: error: `1.5` is not an integer"
    );
    assert_eq!(
        lines(r#"Shape "trianglemesh" "point3 P" [ 1 2 3 4 ]"#),
        "a.pbrt:2:33: error: \"point3 P\" has 4 numbers, which is not a multiple of 3 (accepted: 3 for each point3)"
    );
    assert_eq!(
        lines(r#"Translate 1 2 Shape "sphere" "float radius" 1 2"#),
        "a.pbrt:2:1: error: `Translate` needs 3 numbers\n\
         a.pbrt:2:47: error: `2` follows a value that stands without brackets (several values are written in `[ ]`)"
    );
    assert_eq!(
        lines("Transform [ 1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1 1 ]\nRotate 90 0 0 1e39"),
        "a.pbrt:2:48: error: expected `]` after 16 numbers\n\
         a.pbrt:3:15: error: `1e39` is more than a 32-bit float can hold (3.4e38)"
    );
}

#[test]
fn brackets_that_are_not_closed() {
    assert_eq!(
        lines("Shape \"sphere\" \"float radius\" [ 1\nShape \"dis\""),
        "a.pbrt:2:31: error: `[` is not closed\n\
         a.pbrt:3:7: error: there is no shape of the type `dis` (did you mean `disk`?)"
    );
    assert_eq!(
        lines(r#"Shape "sphere" "float radius" [ 1 "float zmin" [ -1 ] "float zmin" 2"#),
        "a.pbrt:2:31: error: `[` is not closed\n\
         a.pbrt:2:55: error: `zmin` is given twice"
    );
    assert_eq!(
        lines("Shape \"sphere\" \"float radius\" ["),
        "a.pbrt:2:31: error: `[` is not closed"
    );
}

#[test]
fn declarations_and_values() {
    assert_eq!(
        lines(r#"Shape "sphere" "flot radius" 1 "radius" [ 2 ] "float" 3 "color c" [ 1 1 1 ]"#),
        "a.pbrt:2:16: error: `flot` is not a type of a parameter (did you mean `float`?)\n\
         a.pbrt:2:32: error: `\"radius\"` declares no parameter (a parameter is declared by its type and its name, such as `\"float radius\"`)\n\
         a.pbrt:2:47: error: `\"float\"` declares no parameter (a parameter is declared by its type and its name, such as `\"float radius\"`)\n\
         a.pbrt:2:57: error: `color` is not a type of a parameter (pbrt-v3 called `color` what is `rgb` in pbrt-v4)"
    );
    assert_eq!(
        lines(
            r#"Shape "sphere" "float radius" "float zmin" 1 "bool a" "true" "bool b" [ yes ] "string s" [ x ]"#
        ),
        "a.pbrt:2:16: error: \"float radius\" has no value\n\
         a.pbrt:2:55: error: expected a bool, found the string `\"true\"` (pbrt-v4 writes `true` without quotes, unlike pbrt-v3)\n\
         a.pbrt:2:73: error: `yes` is not a bool (accepted: true, false)\n\
         a.pbrt:2:92: error: expected a string in quotes, found `x`"
    );
    assert_eq!(
        lines(r#"Shape "sphere" "string a" "C:\x" "integer b" [ "1" ] "float c" "1""#),
        "a.pbrt:2:30: error: `\\x` is not an escape (accepted: \\\\ \\\" \\' \\n \\t \\r \\b \\f; a backslash itself is written `\\\\`)\n\
         a.pbrt:2:48: error: expected an integer, found the string `\"1\"`\n\
         a.pbrt:2:64: error: expected a number, found the string `\"1\"`"
    );
    assert_eq!(
        lines("Shape \"sphere\nShape \"disk\" \"float radius"),
        "a.pbrt:2:7: error: the string does not end on its line (its closing quotation mark is missing)\n\
         a.pbrt:3:14: error: the string does not end on its line (its closing quotation mark is missing)"
    );
}

#[test]
fn directives_that_are_unknown_or_misplaced() {
    assert_eq!(
        lines("ActiveTransfrom All Shpe \"sphere\" 4 [ 5 ]\n\"x\" ] Scale 1 1 1"),
        "a.pbrt:2:1: error: `ActiveTransfrom` is not a directive (did you mean `ActiveTransform`?)\n\
         a.pbrt:2:21: error: `Shpe` is not a directive (did you mean `Shape`?)"
    );
    assert_eq!(
        lines("Camera \"perspective\" \"float fov\" 9\nWorldBegin\nActiveTransform None"),
        "a.pbrt:2:1: error: `Camera` must stand before `WorldBegin`\n\
         a.pbrt:3:1: error: `WorldBegin` is given twice\n\
         a.pbrt:4:17: error: `None` cannot follow `ActiveTransform` (accepted: All, StartTime, EndTime)"
    );
    assert_eq!(
        parsed("Shape \"sphere\" Shape \"disk\" Shape").lines(),
        "a.pbrt:1:1: error: `Shape` must stand after `WorldBegin`\n\
         a.pbrt:1:29: error: `Shape` needs a string in quotes"
    );
    assert_eq!(
        parsed("# nothing").lines(),
        "error: the scene has no `WorldBegin`"
    );
    let twice = parsed("Film \"rgb\" Film \"rgb\" WorldBegin");
    assert_eq!(
        twice.lines(),
        "a.pbrt:1:12: note: `Film` is given again; this one counts"
    );
    assert!(twice.sound().is_some());
}

#[test]
fn blocks_that_do_not_match() {
    assert_eq!(
        lines(
            "AttributeEnd\nAttributeBegin\nTransformBegin\nAttributeEnd\nObjectBegin \"a\"\nObjectBegin \"b\"\nObjectEnd"
        ),
        "a.pbrt:2:1: error: `AttributeEnd` without `AttributeBegin`\n\
         a.pbrt:3:1: error: `AttributeBegin` without `AttributeEnd`\n\
         a.pbrt:4:1: note: in pbrt-v4, `TransformBegin` is the same as `AttributeBegin` (it saves the material and all other attributes, too)\n\
         a.pbrt:5:1: error: `AttributeEnd` where `TransformEnd` is due\n\
         a.pbrt:6:1: error: `ObjectBegin` without `ObjectEnd`\n\
         a.pbrt:7:1: error: an object cannot be defined inside of the definition of another one (define it before, and put an `ObjectInstance` of it here)"
    );
    let mismatch = world("AttributeBegin TransformEnd");
    let [(place, remark)] = mismatch.diagnostics[0].related.as_slice() else {
        panic!("{:?}", mismatch.diagnostics);
    };
    assert_eq!(mismatch.sources.location(*place), "a.pbrt:2:1");
    assert_eq!(remark, "`AttributeBegin` is open");
}

#[test]
fn names_that_are_unknown_or_defined_twice() {
    assert_eq!(
        lines(
            r#"NamedMaterial "rad" MakeNamedMaterial "red" "string type" "diffuse"
MakeNamedMaterial "red" "string type" "diffuse" "texture reflectance" "wod"
Texture "wood" "spectrum" "constant" Texture "wood" "spectrum" "constant"
MediumInterface "fog" "" ObjectInstance "tree" CoordSysTransform "wold""#
        ),
        "a.pbrt:2:15: error: there is no material `rad` (did you mean `red`?)\n\
         a.pbrt:3:19: error: the material `red` is defined twice\n\
         a.pbrt:3:71: error: there is no texture `wod` (did you mean `wood`?)\n\
         a.pbrt:4:46: error: the spectrum texture `wood` is defined twice\n\
         a.pbrt:5:17: error: there is no medium `fog`\n\
         a.pbrt:5:41: error: there is no object `tree`\n\
         a.pbrt:5:66: error: there is no coordinate system `wold` (did you mean `world`?)"
    );
    assert_eq!(
        lines(
            r#"MakeNamedMaterial "a" "string type" "mix" "string materials" [ "b" "b" ]
MakeNamedMaterial "b" "string type" "mix" "string materials" [ "a" "a" ]
Texture "x" "float" "scale" "texture tex" "x" ObjectBegin "o" ObjectInstance "o" ObjectEnd"#
        ),
        "a.pbrt:2:19: error: materials contain each other: `a` → `b` → `a`\n\
         a.pbrt:4:9: error: the texture `x` contains itself\n\
         a.pbrt:4:59: error: the object `o` contains itself"
    );
}

#[test]
fn what_pbrt_v3_wrote() {
    assert_eq!(
        lines(
            r#"Material "matte" Shape "cone" Texture "t" "color" "imagemap"
MakeNamedMaterial "m" "string type" "plastic" MakeNamedMaterial "n" Material "none" WorldEnd"#
        ),
        "a.pbrt:2:10: error: the material `matte` is of pbrt-v3, not of pbrt-v4 (`pbrt --upgrade` of pbrt-v4 converts such files; it is now `diffuse`)\n\
         a.pbrt:2:24: error: the shape `cone` is of pbrt-v3, not of pbrt-v4 (`pbrt --upgrade` of pbrt-v4 converts such files; it is now a mesh)\n\
         a.pbrt:2:43: error: a texture cannot be of `color` (`pbrt --upgrade` of pbrt-v4 converts such files; it is now `spectrum`)\n\
         a.pbrt:3:37: error: the material `plastic` is of pbrt-v3, not of pbrt-v4 (`pbrt --upgrade` of pbrt-v4 converts such files; it is now `coateddiffuse`)\n\
         a.pbrt:3:47: error: the parameter `\"string type\"` is missing\n\
         a.pbrt:3:78: note: the material `\"none\"` is now called `interface`\n\
         a.pbrt:3:85: error: `WorldEnd` is of an earlier version, not of pbrt-v4 (`pbrt --upgrade` of pbrt-v4 converts such files; it is now the end of the file)"
    );
}

#[test]
fn options_and_state() {
    assert_eq!(
        lines(
            r#"Option "sed" 1 Option "seed" 1.5 Option "pixelstats" maybe Option "rendercoordsys" "moon"
ColorSpace "rec202" Attribute "shapes" "float alpha" 1 Rotate 90 0 0 0 LookAt 0 0 0 0 0 0 0 1 0
LookAt 0 0 0 0 1 0 0 1 0 Scale 1e30 1 1 Scale 1e30 1 1"#
        ),
        "a.pbrt:2:8: error: there is no option `sed` (did you mean `seed`?)\n\
         a.pbrt:2:30: error: `1.5` is not a value of the option `seed` (accepted: an integer)\n\
         a.pbrt:2:54: error: `maybe` is not a value of the option `pixelstats` (accepted: true, false)\n\
         a.pbrt:2:84: error: `moon` is not a value of the option `rendercoordsys` (accepted: camera, cameraworld, world)\n\
         a.pbrt:3:12: error: there is no colour space `rec202` (did you mean `rec2020`?)\n\
         a.pbrt:3:31: error: `shapes` is not a family of attributes (did you mean `shape`?)\n\
         a.pbrt:3:56: error: the axis of a rotation cannot be zero\n\
         a.pbrt:3:72: error: `LookAt` looks at the point that it stands at\n\
         a.pbrt:4:1: error: the up vector of `LookAt` is zero or parallel to the direction of view\n\
         a.pbrt:4:41: error: the transform overflows"
    );
    let flat = parsed("Scale 1 0 1 Camera \"perspective\" TransformTimes 1 1 WorldBegin");
    assert_eq!(
        flat.lines(),
        "a.pbrt:1:13: error: the transform of the camera flattens space\n\
         a.pbrt:1:34: error: the second of the `TransformTimes` must be later than the first"
    );
}
