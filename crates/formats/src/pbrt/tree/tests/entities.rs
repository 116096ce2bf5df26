//! Every type of entity that pbrt knows becomes a node, or an error that names it.

use super::super::super::kinds;
use super::*;

/// Asserts that a text with `kind` in it is mapped, perhaps with notes, or that an error names it.
fn assert_mapped_or_named(kind: &str, text: &str) {
    let outcome = read(text);
    let lines = outcome.lines();
    assert_eq!(
        outcome.document.is_some(),
        !outcome.has_errors(),
        "{text}: {lines}"
    );
    if outcome.document.is_none() {
        let named = "Etalon does not have pbrt's";
        let errors: Vec<&str> = lines
            .lines()
            .filter(|line| line.contains("error:"))
            .collect();
        let all = errors
            .iter()
            .all(|line| line.contains(named) && line.contains(&format!("`{kind}`")));
        assert!(all && !errors.is_empty(), "{text}: {lines}");
    }
}

#[test]
fn every_type_is_mapped_or_named() {
    let points = "\"point3 P\" [ 0 0 0 1 0 0 0 1 0 ]";
    for kind in kinds::CAMERA.names() {
        assert_mapped_or_named(kind, &format!("Camera \"{kind}\" WorldBegin"));
    }
    for kind in kinds::FILM.names() {
        assert_mapped_or_named(kind, &format!("Film \"{kind}\" WorldBegin"));
    }
    for kind in kinds::SAMPLER.names() {
        assert_mapped_or_named(kind, &format!("Sampler \"{kind}\" WorldBegin"));
    }
    for kind in kinds::FILTER.names() {
        assert_mapped_or_named(kind, &format!("PixelFilter \"{kind}\" WorldBegin"));
    }
    for kind in kinds::INTEGRATOR.names() {
        assert_mapped_or_named(kind, &format!("Integrator \"{kind}\" WorldBegin"));
    }
    for kind in kinds::ACCELERATOR.names() {
        assert_mapped_or_named(kind, &format!("Accelerator \"{kind}\" WorldBegin"));
    }
    for kind in kinds::LIGHT.names() {
        let file = if ["goniometric", "projection"].contains(kind) {
            "\"string filename\" \"a.exr\""
        } else {
            ""
        };
        assert_mapped_or_named(kind, &format!("WorldBegin LightSource \"{kind}\" {file}"));
    }
    for kind in kinds::AREA_LIGHT.names() {
        let text = format!("WorldBegin AreaLightSource \"{kind}\" Shape \"sphere\"");
        assert_mapped_or_named(kind, &text);
    }
    for kind in kinds::SHAPE.names() {
        let parameters = match *kind {
            "trianglemesh" | "loopsubdiv" => points,
            "curve" => "\"point3 P\" [ 0 0 0 1 0 0 0 1 0 1 1 0 ]",
            "bilinearmesh" => "\"point3 P\" [ 0 0 0 1 0 0 0 1 0 1 1 0 ]",
            // It needs a file; `shapes` has the test.
            "plymesh" => continue,
            _ => "",
        };
        assert_mapped_or_named(kind, &format!("WorldBegin Shape \"{kind}\" {parameters}"));
    }
    for kind in kinds::MEDIUM.names() {
        let parameters = match *kind {
            "uniformgrid" => "\"float density\" 1",
            "rgbgrid" => "\"rgb sigma_s\" [ 1 1 1 ]",
            "nanovdb" => "\"string filename\" \"a.nvdb\"",
            _ => "",
        };
        let text = format!(
            "WorldBegin MakeNamedMedium \"m\" \"string type\" \"{kind}\" {parameters} MediumInterface \"m\" \"\" Shape \"sphere\""
        );
        assert_mapped_or_named(kind, &text);
    }
    for kind in kinds::MATERIAL.names() {
        let parameters = match *kind {
            "measured" => "\"string filename\" \"a.bsdf\"",
            "mix" => "\"string materials\" [ \"a\" \"a\" ]",
            _ => "",
        };
        let text = format!(
            "WorldBegin MakeNamedMaterial \"a\" \"string type\" \"diffuse\" Material \"{kind}\" {parameters} Shape \"sphere\""
        );
        assert_mapped_or_named(kind, &text);
    }
    for (family, parameter, kinds) in [
        ("float", "alpha", &kinds::FLOAT_TEXTURE),
        ("spectrum", "reflectance", &kinds::SPECTRUM_TEXTURE),
    ] {
        for kind in kinds.names() {
            let (file, on_shape, on_material) = match (*kind, parameter) {
                ("imagemap", "alpha") => (
                    "\"string filename\" \"a.png\"",
                    "\"texture alpha\" \"t\"",
                    "",
                ),
                (_, "alpha") => ("", "\"texture alpha\" \"t\"", ""),
                ("imagemap", _) => (
                    "\"string filename\" \"a.png\"",
                    "",
                    "\"texture reflectance\" \"t\"",
                ),
                _ => ("", "", "\"texture reflectance\" \"t\""),
            };
            let text = format!(
                "WorldBegin Texture \"t\" \"{family}\" \"{kind}\" {file} Material \"diffuse\" {on_material} Shape \"sphere\" {on_shape}"
            );
            assert_mapped_or_named(kind, &text);
        }
    }
}
