//! A rolling shutter, from the description of its sensor.

use crate::reading::read_with;
use etalon_transport::World;
use glam::{UVec2, Vec2};

#[test]
fn rows_of_a_film_have_their_moments() {
    let scene = |parameters: &str| {
        let text = format!(
            "<scene version=\"3.0.0\"><shape type=\"sphere\"/><sensor type=\"perspective\">{parameters}\
             <film type=\"hdrfilm\"><integer name=\"width\" value=\"8\"/><integer name=\"height\" value=\"10\"/>\
             <integer name=\"crop_offset_y\" value=\"5\"/><integer name=\"crop_height\" value=\"5\"/></film>\
             </sensor></scene>"
        );
        let read = read_with(&text, &[]);
        assert_eq!(read.errors, Vec::<String>::new());
        read.compiled.expect("a scene without mistakes").scene
    };
    let kind = |kind: &str| format!("<string name=\"rolling_shutter_type\" value=\"{kind}\"/>");
    let duration = "<float name=\"rolling_shutter_duration\" value=\"0.4\"/>";
    let at = Vec2::new(3.0, 7.2);
    // Row 7 of 10, whatever the crop shows.
    let rolling = scene(&(kind("top") + duration));
    assert!((rolling.moment(at, 0.5) - (0.6 * 0.75 + 0.4 * 0.5)).abs() < 1e-6);
    let brief = scene(&kind("top"));
    assert!((brief.moment(at, 0.5) - (0.9 * 0.75 + 0.1 * 0.5)).abs() < 1e-6);
    for global in [kind("none") + duration, String::new()] {
        assert_eq!(scene(&global).moment(at, 0.5), 0.5);
    }
    let capabilities = |scene: &etalon_scene::Scene| scene.capabilities(UVec2::ZERO, UVec2::ONE);
    assert!(
        capabilities(&rolling)
            .rows_in_turn()
            .is_some_and(|reason| reason.fatal)
    );
    assert!(capabilities(&scene("")).rows_in_turn().is_none());
}
