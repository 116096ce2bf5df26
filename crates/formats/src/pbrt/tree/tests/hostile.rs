//! Values of all kinds in all places: mistakes are messages, never panics.

use super::*;
use proptest::prelude::*;
use std::fmt::Write;

/// Values that a parameter may be given.
const VALUES: [&str; 12] = [
    "0",
    "-1",
    "1e30",
    "[ 1 2 3 ]",
    "[ 0 1 2 3 ]",
    "[ 400 1 700 2 ]",
    "\"metal-Cu-eta\"",
    "\"stdillum-D65\"",
    "\"t\"",
    "\"nowhere\"",
    "true",
    "[ 0 0 0 1 0 0 0 1 0 1 1 3 ]",
];

const TYPES: [&str; 11] = [
    "float",
    "integer",
    "rgb",
    "spectrum",
    "blackbody",
    "texture",
    "string",
    "bool",
    "point3",
    "normal",
    "point2",
];

/// Names of parameters, some of which each entity has.
const NAMES: [&str; 40] = [
    "radius",
    "zmin",
    "zmax",
    "phimax",
    "height",
    "P",
    "N",
    "uv",
    "indices",
    "alpha",
    "filename",
    "L",
    "I",
    "scale",
    "power",
    "illuminance",
    "from",
    "to",
    "coneangle",
    "conedeltaangle",
    "eta",
    "k",
    "reflectance",
    "roughness",
    "uroughness",
    "normalmap",
    "displacement",
    "sigma_a",
    "sigma_s",
    "preset",
    "value",
    "tex1",
    "amount",
    "uscale",
    "mapping",
    "fov",
    "screenwindow",
    "maxdepth",
    "xradius",
    "cropwindow",
];

const ENTITIES: [&str; 16] = [
    "Shape \"sphere\"",
    "Shape \"disk\"",
    "Shape \"trianglemesh\"",
    "Shape \"bilinearmesh\"",
    "Shape \"plymesh\"",
    "LightSource \"point\"",
    "LightSource \"spot\"",
    "LightSource \"distant\"",
    "LightSource \"infinite\"",
    "AreaLightSource \"diffuse\"",
    "Material \"conductor\"",
    "Material \"coateddiffuse\"",
    "Material \"hair\"",
    "Material \"subsurface\"",
    "Material \"diffusetransmission\"",
    "Texture \"t\" \"spectrum\" \"imagemap\"",
];

const SETTINGS: [&str; 7] = [
    "Camera \"perspective\"",
    "Camera \"orthographic\"",
    "Film \"rgb\"",
    "PixelFilter \"sinc\"",
    "PixelFilter \"gaussian\"",
    "Integrator \"path\"",
    "Sampler \"stratified\"",
];

fn entity(of: &'static [&'static str]) -> impl Strategy<Value = String> {
    let one = (
        prop::sample::select(&TYPES[..]),
        prop::sample::select(&NAMES[..]),
        prop::sample::select(&VALUES[..]),
    );
    let parameters = prop::collection::vec(one, 0..4);
    (prop::sample::select(of), parameters).prop_map(|(entity, parameters)| {
        parameters
            .iter()
            .fold(entity.to_owned(), |text, (kind, name, value)| {
                format!("{text} \"{kind} {name}\" {value}")
            })
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, ..ProptestConfig::default() })]

    #[test]
    fn any_values(
        settings in prop::collection::vec(entity(&SETTINGS), 0..3),
        entities in prop::collection::vec(entity(&ENTITIES), 0..6),
    ) {
        let text = format!("{} WorldBegin {} Shape \"sphere\"", settings.join(" "), entities.join(" "));
        let outcome = read(&text);
        prop_assert_eq!(outcome.document.is_some(), !outcome.has_errors());
    }
}

#[test]
fn textures_of_shared_parts_are_not_exponential() {
    let mut text = "WorldBegin Texture \"t0\" \"float\" \"checkerboard\"\n".to_owned();
    for i in 1..60 {
        let last = i - 1;
        let _ = writeln!(
            text,
            "Texture \"t{i}\" \"float\" \"mix\" \"texture tex1\" \"t{last}\" \"texture tex2\" \"t{last}\""
        );
    }
    text += "Material \"dielectric\" \"texture roughness\" \"t59\" Shape \"sphere\"";
    assert!(read(&text).document.is_some());
}
