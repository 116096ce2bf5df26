//! Textures.

use super::*;

/// The value that a diffuse material has by a texture named `t`.
#[track_caller]
fn reflectance(texture: &str) -> String {
    let text = format!(
        "WorldBegin {texture} Material \"diffuse\" \"texture reflectance\" \"t\" Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ]"
    );
    value(&sound(&text), "reflectance")
}

/// The value that roughness has by one.
#[track_caller]
fn roughness(texture: &str) -> String {
    let text = format!(
        "WorldBegin {texture} Material \"dielectric\" \"texture roughness\" \"t\" \"bool remaproughness\" false Shape \"sphere\""
    );
    value(&sound(&text), "alpha")
}

fn value(document: &Document, name: &str) -> String {
    fn find(node: &Node, name: &str) -> Option<String> {
        node.properties
            .iter()
            .find_map(|property| match &property.value {
                value if property.name == name => Some(shown_value(value)),
                Value::Object(nested) => find(nested, name),
                _ => None,
            })
    }
    find(&document.root, name).expect("a property of that name")
}

fn texture(xml_text: &str) -> String {
    shown(&children(&xml(xml_text).root).remove(0))
}

#[test]
fn constants_and_arithmetic() {
    let a = r#"Texture "a" "spectrum" "constant" "rgb value" [ 0.2 0.4 0.6 ]"#;
    assert_eq!(
        reflectance(r#"Texture "t" "spectrum" "constant" "rgb value" [ 0.2 0.4 0.6 ]"#),
        "rgb 2.000000e-1 4.000000e-1 6.000000e-1"
    );
    assert_eq!(
        reflectance(&format!(
            r#"{a} Texture "t" "spectrum" "scale" "texture tex" "a" "float scale" 0.5"#
        )),
        "rgb 1.000000e-1 2.000000e-1 3.000000e-1"
    );
    assert_eq!(
        reflectance(&format!(
            r#"{a} Texture "t" "spectrum" "mix" "texture tex2" "a" "float amount" 0.25"#
        )),
        texture(
            r#"<texture type="mix"><float name="a" value="0"/><rgb name="b" value="0.2 0.4 0.6"/><float name="weight" value="0.25"/></texture>"#
        )
    );
}

#[test]
fn images_have_their_first_row_at_the_bottom() {
    assert_eq!(
        reflectance(
            r#"Texture "t" "spectrum" "imagemap" "string filename" "a.png" "float scale" 0.5 "string wrap" "clamp"
               "float uscale" 2 "float vscale" 3 "float vdelta" 0.25 "string filter" "point""#
        ),
        texture(
            r#"<texture type="scale"><float name="scale" value="0.5"/><texture type="bitmap">
                <string name="filename" value="a.png"/><string name="wrap_mode" value="clamp"/>
                <string name="filter_type" value="nearest"/>
                <transform name="to_uv"><scale x="2" y="3"/><translate y="0.25"/><scale y="-1"/><translate y="1"/></transform>
            </texture></texture>"#
        )
    );
    let raw = roughness(
        r#"Texture "t" "float" "imagemap" "string filename" "a.png" "string encoding" "linear""#,
    );
    assert!(raw.contains("raw: boolean true"), "{raw}");
}

#[test]
fn squares_of_colours_and_of_numbers() {
    assert_eq!(
        reflectance(
            r#"Texture "t" "spectrum" "checkerboard" "float uscale" 4 "float vscale" 4 "rgb tex1" [ 1 0 0 ]"#
        ),
        texture(
            r#"<texture type="checkerboard"><rgb name="color0" value="1 0 0"/><float name="color1" value="0"/>
                <transform name="to_uv"><scale x="2" y="2"/></transform></texture>"#
        )
    );
    assert_eq!(
        roughness(r#"Texture "t" "float" "checkerboard" "float tex1" 0.3 "float tex2" 0.1"#),
        texture(
            r#"<texture type="checkerboard"><float name="color0" value="0.1"/><float name="color1" value="0.3"/>
                <transform name="to_uv"><scale x="0.5" y="0.5"/></transform></texture>"#
        )
    );
}

#[test]
fn bilinear_colours() {
    let mixed = |a: f64, b: f64, along: &str| {
        format!(
            r#"<texture type="mix" name="N"><float name="a" value="{a}"/><float name="b" value="{b}"/>
                <texture type="expression" name="weight"><string name="value" value="{along}"/></texture></texture>"#
        )
    };
    let below = mixed(0.1, 0.3, "u").replace("\"N\"", "\"a\"");
    let above = mixed(0.2, 0.4, "u").replace("\"N\"", "\"b\"");
    assert_eq!(
        roughness(
            r#"Texture "t" "float" "bilerp" "float v00" 0.1 "float v01" 0.2 "float v10" 0.3 "float v11" 0.4"#
        ),
        texture(&format!(
            r#"<texture type="mix">{below}{above}
                <texture type="expression" name="weight"><string name="value" value="v"/></texture></texture>"#
        ))
    );
}

#[test]
fn images_of_other_codes_and_places() {
    assert_eq!(
        reflectance(
            r#"Translate 1 2 3 Texture "t" "spectrum" "imagemap" "string filename" "a.png" "string wrap" "black" "bool invert" true
               "string encoding" "gamma 2.2" "string mapping" "planar" "vector3 v1" [ 2 0 0 ] "vector3 v2" [ 0 0 1 ] "float udelta" 0.5"#
        ),
        texture(
            r#"<texture type="projected"><string name="mapping" value="planar"/><texture type="bitmap">
                <string name="filename" value="a.png"/>
                <transform name="to_uv"><translate x="0.5"/><scale y="-1"/><translate y="1"/></transform>
                <string name="wrap_mode" value="zero"/><boolean name="invert" value="true"/><float name="exponent" value="2.2"/></texture>
                <transform name="to_world"><matrix value="0.5 0 0 1  0 0 -0.5 2  0 1 0 3  0 0 0 1"/></transform></texture>"#
        )
    );
    let linear = reflectance(
        r#"Texture "t" "spectrum" "imagemap" "string filename" "a.png" "string encoding" "linear""#,
    );
    assert!(linear.contains("exponent: float 1"), "{linear}");
}

#[test]
fn what_has_no_equal_is_refused_by_name() {
    for (texture, expected) in [
        (
            r#""ptex" "string filename" "a.ptx""#,
            "pbrt's texture `ptex`",
        ),
        (r#""directionmix""#, "pbrt's texture `directionmix`"),
        (
            r#""imagemap" "string filename" "a.png" "string wrap" "octahedralsphere""#,
            "`wrap` `octahedralsphere`",
        ),
        (
            r#""imagemap" "string filename" "a.png" "bool invert" true "float scale" 2"#,
            "`scale` of inverted images",
        ),
        (
            r#""imagemap" "string filename" "a.png" "string encoding" "gamma two""#,
            "`encoding` of `imagemap` cannot be `gamma two`",
        ),
        (
            r#""checkerboard" "string mapping" "planar" "vector3 v1" [ 0 2 0 ]"#,
            "`v1` and `v2` of a planar mapping span no plane",
        ),
        (
            r#""checkerboard" "integer dimension" 4"#,
            "`dimension` of `checkerboard` cannot be 4",
        ),
        (
            r#""dots" "float vscale" 0"#,
            "`vscale` of `dots` cannot be 0",
        ),
        (
            r#""bilerp" "float uscale" 2 "rgb v00" [ 1 0 0 ]"#,
            "`bilerp` of colours beyond the unit square",
        ),
    ] {
        let text = format!(
            "Texture \"t\" \"spectrum\" {texture} Material \"diffuse\" \"texture reflectance\" \"t\" Shape \"sphere\""
        );
        let said = world(&text).lines();
        assert!(said.contains(expected), "{texture}: {said}");
    }
}

/// A pattern in space needs no texture coordinates: curves, which have none, may have it.
#[test]
fn patterns_in_space_are_for_every_shape() {
    let text = r#"WorldBegin Texture "t" "spectrum" "checkerboard" "string mapping" "spherical"
        Texture "n" "float" "scale" "float tex" 0.5
        Material "diffuse" "texture reflectance" "t" Shape "curve" "string type" "cylinder" "point3 P" [ 0 0 0  1 0 0  1 1 0  1 1 1 ]"#;
    assert_eq!(sound(text).meshes.len(), 0);
    // One by (u, v) is looked up along each segment; of hair it is not.
    let by_uv = text.replace("\"string mapping\" \"spherical\"", "");
    let outcome = pbrt::read_text("a.pbrt", &by_uv, &ReadOptions::default());
    assert!(
        outcome.lines().contains("note: v counts around this curve"),
        "{}",
        outcome.lines()
    );
    let shape = children(&outcome.document.expect("a document").root).pop();
    assert!(shown(&shape.expect("a curve")).contains("coordinates: string along"));
    let hair = by_uv.replace(
        "\"diffuse\" \"texture reflectance\"",
        "\"hair\" \"texture sigma_a\"",
    );
    let refused = pbrt::read_text("a.pbrt", &hair, &ReadOptions::default()).lines();
    assert!(
        refused.contains("texture coordinates of a `curve` of `hair`"),
        "{refused}"
    );
}

/// The number of an image that is not opaque is its opacity, that of a coloured one the mean of its channels.
#[test]
fn numbers_of_images() {
    use etalon_images::{Image, exr};
    let folder = tempfile::tempdir().expect("a temporary folder");
    let write = |name: &str, alpha: f32, blue: f32| {
        let image = [("R", 0.5), ("G", 0.5), ("B", blue), ("A", alpha)]
            .into_iter()
            .fold(Image::new(1, 1), |image, (channel, x)| {
                image.with(channel, vec![x])
            });
        let part = exr::Part {
            name: None,
            image,
            offset: [0, 0],
        };
        let mut bytes = std::io::Cursor::new(Vec::new());
        exr::encode(&mut bytes, &[part], [1, 1], "").expect("encoded");
        std::fs::write(folder.path().join(name), bytes.into_inner()).expect("written");
    };
    write("clear.exr", 0.25, 0.5);
    write("grey.exr", 1.0, 0.5);
    write("blue.exr", 1.0, 0.75);
    let channels = |name: &str| {
        let text = format!(
            "WorldBegin Texture \"t\" \"float\" \"imagemap\" \"string filename\" \"{name}\" Shape \"disk\" \"texture alpha\" \"t\""
        );
        let path = folder.path().join("a.pbrt");
        std::fs::write(&path, text).expect("written");
        let outcome = pbrt::read(&path, &ReadOptions::default());
        assert_eq!(outcome.lines(), "");
        let shown = value(&outcome.document.expect("a document"), "opacity");
        let channel = |line: &str| {
            line.trim()
                .strip_prefix("channel: string ")
                .map(str::to_owned)
        };
        shown.lines().filter_map(channel).collect::<Vec<_>>()
    };
    assert_eq!(channels("clear.exr"), ["a"]);
    assert_eq!(channels("grey.exr"), [""; 0]);
    assert_eq!(channels("blue.exr"), ["b", "g", "r"]);
}
