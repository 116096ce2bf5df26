//! Materials.

use super::evaluated::Evaluated;
use super::*;
use etalon_transport::SpectrumKind;
use glam::{Vec3, Vec4};

/// The BSDF of a sphere of a material without mistakes; notes are asserted.
#[track_caller]
fn bsdf(text: &str, notes: &str) -> String {
    let outcome = world(&format!("{text} Shape \"sphere\""));
    assert_eq!(outcome.lines(), notes);
    let document = outcome.document.expect("a document");
    let shape = children(&document.root)
        .into_iter()
        .find(|n| n.plugin.value == "sphere");
    let shape = shape.expect("a shape");
    children(&shape).iter().map(|node| shown(node)).collect()
}

#[track_caller]
fn assert_bsdf(text: &str, expected: &str) {
    let expected = children(&xml(expected).root).remove(0);
    assert_eq!(bsdf(text, ""), shown(&expected));
}

#[test]
fn matte_materials() {
    assert_bsdf(
        r#"Material "diffuse" "rgb reflectance" [ 0.1 0.2 0.3 ]"#,
        r#"<bsdf type="twosided"><bsdf type="diffuse"><rgb name="reflectance" value="0.1 0.2 0.3"/></bsdf></bsdf>"#,
    );
    assert_bsdf(
        r#"Material "diffuse" "spectrum reflectance" [ 400 0.1 700 0.5 ]"#,
        r#"<bsdf type="twosided"><bsdf type="diffuse"><spectrum name="reflectance" value="400:0.1, 700:0.5"/></bsdf></bsdf>"#,
    );
    assert_bsdf(
        r#"Material "diffusetransmission" "rgb reflectance" [ 0.6 0.1 0.1 ] "rgb transmittance" [ 0.2 0.2 0.1 ]"#,
        r#"<bsdf type="blendbsdf"><float name="weight" value="0.25"/>
            <bsdf type="twosided"><bsdf type="diffuse"><rgb name="reflectance" value="0.8 0.13333333333 0.13333333333"/></bsdf></bsdf>
            <bsdf type="difftrans"><rgb name="transmittance" value="0.8 0.8 0.4"/></bsdf></bsdf>"#,
    );
    assert_bsdf(
        r#"Material "measured" "string filename" "a.bsdf""#,
        r#"<bsdf type="twosided"><bsdf type="measured"><string name="filename" value="a.bsdf"/></bsdf></bsdf>"#,
    );
    assert_bsdf(r#"Material "interface""#, r#"<bsdf type="null"/>"#);
}

#[test]
fn metals() {
    let ggx =
        r#"<string name="distribution" value="ggx"/><string name="masking" value="correlated"/>"#;
    assert_bsdf(
        r#"Material "conductor""#,
        r#"<bsdf type="twosided"><bsdf type="conductor"><string name="material" value="Cu"/></bsdf></bsdf>"#,
    );
    assert_bsdf(
        r#"Material "conductor" "spectrum eta" "metal-Ag-eta" "spectrum k" "metal-Ag-k" "float roughness" 0.25"#,
        &format!(
            r#"<bsdf type="twosided"><bsdf type="roughconductor">{ggx}<float name="alpha" value="0.5"/>
                <string name="material" value="Ag"/></bsdf></bsdf>"#
        ),
    );
    assert_bsdf(
        r#"Material "conductor" "rgb eta" [ 1 2 3 ] "rgb k" [ 4 5 6 ] "float uroughness" 0.1 "float vroughness" 0.2
           "bool remaproughness" false"#,
        &format!(
            r#"<bsdf type="twosided"><bsdf type="roughconductor">{ggx}
                <float name="alpha_u" value="0.1"/><float name="alpha_v" value="0.2"/>
                <rgb name="eta" value="1 2 3"/><rgb name="k" value="4 5 6"/></bsdf></bsdf>"#
        ),
    );
    let mirror = bsdf(
        r#"Material "conductor" "spectrum reflectance" [ 360 0.5 830 0.5 ]"#,
        "",
    );
    // 2 √½ / √½
    assert!(
        mirror.contains("k: spectrum 3.600000e2 2.000000e0 3.610000e2 2.000000e0"),
        "{mirror}"
    );
    assert!(mirror.contains("eta: spectrum 1.000000e0"), "{mirror}");
}

/// The indices at 589.3 nm that handbooks state: rutile's of the ordinary ray, 2.613, and magnesia's, 1.737.
#[test]
fn oxides_have_their_stated_indices() {
    for (name, stated) in [("TiO2", 2.613), ("MgO", 1.737)] {
        let document = sound(&format!(
            "WorldBegin Material \"conductor\" \"spectrum eta\" \"metal-{name}-eta\" \"spectrum k\" \"metal-{name}-k\" Shape \"sphere\""
        ));
        let at = |part: &str| {
            let texture = Evaluated::of(&document, part, SpectrumKind::Index);
            texture.spectrum(Vec3::ZERO, Vec4::splat(589.3)).x
        };
        assert!((at("eta") - stated).abs() < 1e-3, "{name} {}", at("eta"));
        assert_eq!(at("k"), 0.0);
    }
}

/// k varies with the texture: of r = 0.2 it is 1, of r = 0.5 it is 2.
#[test]
fn metals_of_a_textured_reflectance() {
    let document = sound(
        r#"WorldBegin Texture "t" "spectrum" "checkerboard" "integer dimension" 3
            "spectrum tex1" [ 360 0.2 830 0.2 ] "spectrum tex2" [ 360 0.5 830 0.5 ]
            Material "conductor" "texture reflectance" "t" Shape "sphere""#,
    );
    let k = Evaluated::of(&document, "k", SpectrumKind::Index);
    for (place, expected) in [(0.5, 1.0), (1.5, 2.0)] {
        let found = k.spectrum(
            Vec3::new(place, 0.5, 0.5),
            Vec4::new(400.0, 500.0, 600.0, 700.0),
        );
        assert!((found - expected).abs().max_element() < 1e-4, "{found}");
    }
    let eta = Evaluated::of(&document, "eta", SpectrumKind::Index);
    assert_eq!(eta.spectrum(Vec3::ZERO, Vec4::splat(500.0)), Vec4::ONE);
}

#[test]
fn glass() {
    let air = r#"<float name="ext_ior" value="1"/>"#;
    assert_bsdf(
        r#"Material "dielectric" "float eta" 1.4"#,
        &format!(r#"<bsdf type="dielectric"><float name="int_ior" value="1.4"/>{air}</bsdf>"#),
    );
    assert_bsdf(
        r#"Material "dielectric" "float roughness" 0.2 "bool remaproughness" false"#,
        &format!(
            r#"<bsdf type="roughdielectric"><string name="distribution" value="ggx"/><string name="masking" value="correlated"/><float name="alpha" value="0.2"/>
                <float name="int_ior" value="1.5"/>{air}</bsdf>"#
        ),
    );
    assert_bsdf(
        r#"Material "thindielectric""#,
        &format!(r#"<bsdf type="thindielectric"><float name="int_ior" value="1.5"/>{air}</bsdf>"#),
    );
    let glass = bsdf(r#"Material "dielectric" "spectrum eta" "glass-BK7""#, "");
    assert!(
        glass.contains("int_ior: string sellmeier: 1.03961212 0.231792344"),
        "{glass}"
    );
}

#[test]
fn coats_are_layers() {
    let coat = |more: &str| {
        format!(
            r#"<float name="int_ior" value="1.5"/><float name="ext_ior" value="1"/>{more}<integer name="max_depth" value="10"/>
            <integer name="samples" value="1"/>"#
        )
    };
    let plain = r#"<float name="thickness" value="0.01"/><float name="albedo" value="0"/><float name="g" value="0"/>"#;
    let filled = r#"<float name="thickness" value="0.5"/><float name="albedo" value="0.9"/><float name="g" value="-0.2"/>"#;
    assert_bsdf(
        r#"Material "coateddiffuse" "float roughness" 0"#,
        &format!(
            r#"<bsdf type="twosided"><bsdf type="coateddiffuse">{}<float name="reflectance" value="0.5"/></bsdf></bsdf>"#,
            coat(plain)
        ),
    );
    assert_bsdf(
        r#"Material "coatedconductor" "float conductor.roughness" 0.04 "float interface.uroughness" 0.25
           "float thickness" 0.5 "float g" -0.2 "spectrum albedo" [ 400 0.9 700 0.9 ]"#,
        &format!(
            r#"<bsdf type="twosided"><bsdf type="coatedconductor"><float name="alpha_u" value="0.5"/>
                <float name="alpha_v" value="0"/>{}<string name="material" value="Cu"/>
                <float name="base_alpha" value="0.2"/></bsdf></bsdf>"#,
            coat(filled).replace(
                r#"<float name="albedo" value="0.9"/>"#,
                r#"<spectrum name="albedo" value="400:0.9, 700:0.9"/>"#
            )
        ),
    );
}

#[test]
fn mixtures_and_maps() {
    assert_bsdf(
        r#"MakeNamedMaterial "a" "string type" "dielectric" MakeNamedMaterial "b" "string type" "diffuse"
           Material "mix" "string materials" [ "a" "b" ] "float amount" 0.25"#,
        r#"<bsdf type="blendbsdf"><float name="weight" value="0.25"/>
            <bsdf type="dielectric"><float name="int_ior" value="1.5"/><float name="ext_ior" value="1"/></bsdf>
            <bsdf type="twosided"><bsdf type="diffuse"><float name="reflectance" value="0.5"/></bsdf></bsdf></bsdf>"#,
    );
    let turned = r#"<transform name="to_uv"><scale y="-1"/><translate y="1"/></transform>"#;
    assert_bsdf(
        r#"Texture "h" "float" "imagemap" "string filename" "h.png" "float scale" 0.1
           Material "diffuse" "string normalmap" "n.png" "texture displacement" "h""#,
        &format!(
            r#"<bsdf type="normalmap"><boolean name="use_shadowing_function" value="false"/>
                <texture type="bitmap" name="normalmap"><string name="filename" value="n.png"/>
                    <boolean name="raw" value="true"/>{turned}</texture>
                <bsdf type="bumpmap">
                    <texture type="scale"><texture type="bitmap"><string name="filename" value="h.png"/>{turned}</texture>
                        <float name="scale" value="0.1"/></texture>
                    <bsdf type="twosided"><bsdf type="diffuse"><float name="reflectance" value="0.5"/></bsdf></bsdf>
                </bsdf></bsdf>"#
        ),
    );
}

#[test]
fn hair_and_what_is_below_surfaces() {
    let hair = bsdf(r#"Material "hair" "float eumelanin" 0.3"#, "");
    assert!(hair.contains("eumelanin: float 3.000000e-1"), "{hair}");
    assert!(hair.contains("pheomelanin: float 0.000000e0"), "{hair}");
    let found = bsdf(
        r#"Material "subsurface" "string name" "Skin1" "float scale" 2"#,
        "a.pbrt:2:1: note: `randomwalk` stands in for pbrt's `subsurface` (it follows light below the surface instead of a profile)",
    );
    let expected = "subsurface randomwalk {
    boundary: string smooth
    ext_ior: float 1.000000e0
    int_ior: float 1.330000e0
    material: string Skin1
    scale: float 2.000000e0
}";
    assert_eq!(found, expected);
}
