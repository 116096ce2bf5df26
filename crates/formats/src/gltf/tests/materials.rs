//! Materials, textures and what surfaces emit.

use super::*;

/// The shape with a material's XML.
fn shape(inner: &str) -> String {
    format!(
        r#"<shape type="ply"><string name="filename" value="mesh 0 of the scene file"/>
<transform name="to_world"/>{inner}</shape>"#
    )
}

#[track_caller]
fn assert_material(gltf: &str, inner: &str) {
    assert_same(&with_material(gltf), &shape(inner));
}

/// The XML of a texture.
fn bitmap(name: &str, more: &str) -> String {
    format!(
        r#"<texture type="bitmap" name="{name}"><string name="filename" value="file 0 of the scene file"/>{more}</texture>"#
    )
}

const PLAIN: &str = r#"<rgb name="base_color" value="1,1,1"/><float name="eta" value="1.5"/><string name="diffuse_model" value="lambert"/>
<float name="metallic" value="1"/><float name="roughness" value="1"/>"#;

fn two_sided(principled: &str) -> String {
    format!(r#"<bsdf type="twosided"><bsdf type="principled">{principled}</bsdf></bsdf>"#)
}

#[test]
fn factors_and_defaults() {
    assert_material("", &two_sided(PLAIN));
    let gltf = r#""pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 0, 1], "metallicFactor": 0.5, "roughnessFactor": 0.25},
        "extensions": {"KHR_materials_ior": {"ior": 1.25}}"#;
    let xml = r#"<rgb name="base_color" value="0.5,0.25,0"/><float name="metallic" value="0.5"/>
        <float name="roughness" value="0.25"/><float name="eta" value="1.25"/><string name="diffuse_model" value="lambert"/>"#;
    assert_material(gltf, &two_sided(xml));
    // A quarter of the reflectance 0.04 of the index 1.5: √F = 0.1.
    let gltf = r#""extensions": {"KHR_materials_specular": {"specularFactor": 0.25}}"#;
    let xml = PLAIN.replace("\"1.5\"", "\"1.2222222222222\"");
    assert_material(gltf, &two_sided(&xml));
}

#[test]
fn textures_are_multiplied() {
    let gltf = r#""pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 0, 1], "metallicFactor": 0.5,
        "baseColorTexture": {"index": 1, "extensions": {"KHR_texture_transform": {"offset": [0.5, 0.25], "scale": [2, 4]}}},
        "metallicRoughnessTexture": {"index": 0}}"#;
    let raw = r#"<boolean name="raw" value="true"/><string name="channel" value="C"/>"#;
    let looked = |name: &str, channel: &str| bitmap(name, &raw.replace('C', channel));
    let colour = bitmap(
        "b",
        r#"<transform name="to_uv"><scale x="2" y="4"/><translate x="0.5" y="0.25"/></transform>
        <string name="wrap_mode" value="clamp"/><string name="filter_type" value="nearest"/>"#,
    );
    let xml = format!(
        r#"<texture type="multiply" name="base_color"><rgb name="a" value="0.5,0.25,0"/>{colour}</texture>
        <float name="eta" value="1.5"/><string name="diffuse_model" value="lambert"/>
        <texture type="scale" name="metallic"><float name="scale" value="0.5"/>{}</texture>{}"#,
        looked("", "b"),
        looked("roughness", "g")
    );
    assert_material(gltf, &two_sided(&xml));
}

/// A turn by 90° counter-clockwise as one sees it, v pointing down: (1, 0) goes to (0, −1).
#[test]
fn coordinates_turn_against_the_clock() {
    let gltf = r#""pbrMetallicRoughness": {"baseColorTexture": {"index": 0,
        "extensions": {"KHR_texture_transform": {"rotation": 1.5707963705062866}}}}"#;
    let matrix = "0 1 0 0  -1 0 0 0  0 0 1 0  0 0 0 1";
    let turned = format!(r#"<transform name="to_uv"><matrix value="{matrix}"/></transform>"#);
    let xml = PLAIN.replace(
        r#"<rgb name="base_color" value="1,1,1"/>"#,
        &bitmap("base_color", &turned),
    );
    let found = sound(&with_material(gltf));
    let expected = xml_of(&shape(&two_sided(&xml)));
    assert_alike(&found, &expected);
}

/// Like the sines of both programs, the XML's matrix knows 90° to 10⁻⁷ only.
fn xml_of(text: &str) -> Document {
    let exact = f64::from(1.570_796_4_f32);
    let cos = etalon_math::float64::cos(exact);
    xml(&text.replace("0 1 0 0  -1 0 0 0", &format!("{cos} 1 0 0  -1 {cos} 0 0")))
}

#[test]
fn glass_absorbs_and_coats_shine() {
    let gltf = r#""extensions": {
        "KHR_materials_transmission": {"transmissionFactor": 1},
        "KHR_materials_volume": {"thicknessFactor": 1, "attenuationDistance": 0.5, "attenuationColor": [1, 0.5, 0.25]},
        "KHR_materials_clearcoat": {"clearcoatFactor": 0.5, "clearcoatRoughnessFactor": 0.1}}"#;
    let xml = format!(
        r#"<bsdf type="principled">{PLAIN}<float name="spec_trans" value="1"/>
        <float name="clearcoat" value="2"/><float name="clearcoat_gloss" value="0.90909090909"/></bsdf>
        <medium type="homogeneous" name="interior"><rgb name="sigma_t" value="0, 1.3862943611, 2.7725887222"/>
        <float name="albedo" value="0"/></medium>"#
    );
    assert_material(gltf, &xml);
}

#[test]
fn holes_and_normals() {
    let gltf = r#""alphaMode": "MASK", "alphaCutoff": 0.25, "normalTexture": {"index": 0, "scale": 0.5},
        "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}"#;
    let raw = r#"<boolean name="raw" value="true"/>"#;
    let alpha = bitmap(
        "alpha",
        &format!(r#"{raw}<string name="channel" value="a"/>"#),
    );
    let normals = bitmap("a", raw);
    let base = two_sided(&PLAIN.replace(
        r#"<rgb name="base_color" value="1,1,1"/>"#,
        &bitmap("base_color", ""),
    ));
    let three = |name: &str, value: &str| {
        format!(
            r#"<texture type="rawconstant" name="{name}"><vector name="value" value="{value}"/></texture>"#
        )
    };
    let xml = format!(
        r#"<bsdf type="mask"><texture type="expression" name="opacity">{alpha}<float name="cutoff" value="0.25"/>
        <string name="value" value="min(1, max(0, 1 + 1000000*(alpha - cutoff)))"/></texture>
        <bsdf type="normalmap"><texture type="add" name="normalmap">
        <texture type="multiply" name="a">{normals}{}</texture>{}</texture>{base}</bsdf></bsdf>"#,
        three("b", "0.5, 0.5, 1"),
        three("b", "0.25, 0.25, 0"),
    );
    assert_material(gltf, &xml);
    // What is constant needs no step.
    let gltf =
        r#""alphaMode": "MASK", "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.5]}"#;
    assert_material(gltf, &two_sided(PLAIN));
    let gltf = gltf.replace("MASK", "BLEND");
    let xml = format!(
        r#"<bsdf type="mask"><float name="opacity" value="0.5"/>{}</bsdf>"#,
        two_sided(PLAIN)
    );
    assert_material(&gltf, &xml);
}

#[test]
fn surfaces_shine_by_their_strength() {
    let gltf = r#""emissiveFactor": [1, 0.5, 0.25],
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 4}}"#;
    let light = r#"<emitter type="area"><rgb name="radiance" value="4,2,1"/></emitter>"#;
    assert_material(gltf, &(two_sided(PLAIN) + light));
    let gltf = format!(r#"{gltf}, "emissiveTexture": {{"index": 0}}"#);
    let light = format!(
        r#"<emitter type="area"><texture type="d65" name="radiance">
        <texture type="scale"><texture type="multiply"><rgb name="a" value="1,0.5,0.25"/>{}</texture>
        <float name="scale" value="4"/></texture></texture></emitter>"#,
        bitmap("b", "")
    );
    assert_material(&gltf, &(two_sided(PLAIN) + &light));
}

#[test]
fn all_textures_of_a_material_have_the_same_coordinates() {
    let gltf = r#""emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 0, "texCoord": 1},
        "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}"#;
    let said = read(&with_material(gltf)).lines();
    let expected = "`materials[0].emissiveTexture`: it is looked up by TEXCOORD_1, and \
                    `materials[0].pbrMetallicRoughness.baseColorTexture` by TEXCOORD_0";
    assert!(said.contains(expected), "{said}");
}
