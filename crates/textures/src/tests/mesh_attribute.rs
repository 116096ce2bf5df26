//! Attributes of meshes as textures.

use super::*;

#[test]
fn mesh_attributes_come_from_the_shape() {
    let read = |name: &str| {
        let properties = vec![("name", text(name)), ("scale", Value::Float(0.5))];
        One::new(
            &Files::default(),
            &node("mesh_attribute", properties),
            SpectrumKind::Reflectance,
        )
    };
    let at = TexturePoint {
        shape: ShapeId(0),
        parameters: Vec2::new(0.25, 0.75),
        ..TexturePoint::at_uv(Vec2::ZERO)
    };
    let colour = read("vertex_color");
    let found = colour.set.colour(colour.id, &OneShape, &at);
    assert_eq!(found, Vec3::new(0.125, 0.375, 0.25));
    let upsampled = etalon_spectrum::RgbCoefficients::from_rgb([0.25, 0.75, 0.5]);
    let spectrum = colour.set.spectrum(colour.id, &OneShape, &at, LAMBDA);
    assert_eq!(spectrum, upsampled.eval(LAMBDA) * 0.5);
    // A grey attribute is a number; times the scale it is held to 1, as every reflectance.
    let grey = read("face_grey");
    assert_eq!(grey.set.number(grey.id, &OneShape, &at), 1.0);
    assert_eq!(
        grey.set.spectrum(grey.id, &OneShape, &at, LAMBDA),
        Vec4::ONE
    );
    assert_eq!(
        grey.set
            .attributes()
            .map(|(_, name, _)| name)
            .collect::<Vec<_>>(),
        ["face_grey"]
    );
    assert!(!grey.set.is_constant(grey.id));
}

/// What a quantity is decides which of its stored values it may take (issue: bytes for colours).
#[test]
fn mesh_attributes_are_held_to_their_role() {
    let at = TexturePoint {
        shape: ShapeId(0),
        ..TexturePoint::at_uv(Vec2::ZERO)
    };
    let read = |name: &str, scale: f64, role: SpectrumKind| {
        let properties = vec![("name", text(name)), ("scale", Value::Float(scale))];
        let one = One::new(&Files::default(), &node("mesh_attribute", properties), role);
        let colour = one.set.colour(one.id, &OneShape, &at);
        (colour, one.set.spectrum(one.id, &OneShape, &at, LAMBDA))
    };
    let close_to = |v: Vec3, w: Vec3| (v - w).abs().max_element() < 1e-6;
    let upsampled = |rgb: [f32; 3]| etalon_spectrum::RgbCoefficients::from_rgb(rgb).eval(LAMBDA);

    // (51, 102, −255) as a reflectance, as it stands and as bytes.
    let (colour, spectrum) = read("vertex_bytes", 1.0, SpectrumKind::Reflectance);
    assert_eq!(colour, Vec3::new(1.0, 1.0, 0.0));
    assert_eq!(spectrum, upsampled([1.0, 1.0, 0.0]));
    let (colour, spectrum) = read("vertex_bytes", 1.0 / 255.0, SpectrumKind::Reflectance);
    assert!(close_to(colour, Vec3::new(0.2, 0.4, 0.0)), "{colour}");
    assert!(close(
        spectrum,
        upsampled(colour.to_array()).to_array(),
        1e-5
    ));
    // Neither the colour nor any wavelength exceeds 1, whatever the scale.
    let (colour, spectrum) = read("vertex_bytes", 4.0, SpectrumKind::Reflectance);
    assert!(close_to(colour, Vec3::new(1.0, 1.0, 0.0)) && spectrum.max_element() <= 1.0);

    // As light they keep their brightness, as a bright `rgb` colour does.
    for role in [SpectrumKind::Emission, SpectrumKind::Unbounded] {
        let (colour, spectrum) = read("vertex_bytes", 2.0, role);
        assert_eq!(colour, Vec3::new(102.0, 204.0, 0.0));
        let bright = etalon_spectrum::RgbSpectrum::unbounded([51.0, 102.0, 0.0]);
        let bright = bright.expect("not negative");
        let expected = bright.coefficients().eval(LAMBDA) * bright.scale() * 2.0;
        assert!(close(spectrum / 100.0, (expected / 100.0).to_array(), 1e-5));
        let (colour, spectrum) = read("face_grey", 2.0, role);
        assert_eq!((colour, spectrum), (Vec3::splat(6.0), Vec4::splat(6.0)));
    }
    let negative = node(
        "mesh_attribute",
        vec![("name", text("vertex_a")), ("scale", Value::Float(-1.0))],
    );
    let (_, _, messages) = crate::tests::read(&Files::default(), &negative, SpectrumKind::Emission);
    assert_eq!(messages.len(), 1, "{messages:?}");
}
