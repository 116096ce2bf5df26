//! What estimators object to, and what they do not.

use super::*;

fn capabilities(all: u32, hittable: u32, chosen: u32, either: u32) -> SceneCapabilities {
    SceneCapabilities {
        lights: LightCount {
            all,
            hittable,
            chosen,
            either,
            beams: 0,
        },
        ..SceneCapabilities::default()
    }
}

fn fatal(capabilities: SceneCapabilities, finding: LightSearch) -> Option<bool> {
    capabilities
        .incompatibilities(finding)
        .first()
        .map(|o| o.fatal)
}

#[test]
fn all_light_missing_is_fatal_and_some_a_remark() {
    // Two point lights, a sky, and a lamp that is never chosen.
    let mixed = capabilities(4, 2, 3, 4);
    assert_eq!(fatal(mixed, LightSearch::Hitting), Some(false));
    assert_eq!(fatal(mixed, LightSearch::Choosing), Some(false));
    assert_eq!(fatal(mixed, LightSearch::Either), None);
    let points = capabilities(2, 0, 2, 2);
    assert_eq!(fatal(points, LightSearch::Hitting), Some(true));
    assert_eq!(fatal(points, LightSearch::Choosing), None);
    // A lamp, and a laser.
    let mut laser = capabilities(2, 1, 2, 2);
    laser.lights.beams = 1;
    for finding in [LightSearch::Connecting, LightSearch::FromCamera] {
        assert_eq!(fatal(laser, finding), Some(false));
    }
    assert_eq!(fatal(laser, LightSearch::Choosing), None);
    let unchosen_points = capabilities(2, 0, 0, 0);
    assert_eq!(fatal(unchosen_points, LightSearch::Either), Some(true));
}

#[test]
fn smooth_surfaces_alone_in_view_are_fatal_and_among_others_a_remark() {
    let seen = |scattering, smooth, lights| {
        let view = CameraProbe {
            rays: 10,
            scattering,
            smooth,
            lights,
            reached: scattering.max(lights),
            ..CameraProbe::default()
        };
        let capabilities = SceneCapabilities {
            view,
            ..SceneCapabilities::default()
        };
        capabilities
            .unconnected()
            .map(|incompatibility| incompatibility.fatal)
    };
    assert_eq!(seen(10, 0, 0), None);
    assert_eq!(seen(0, 0, 10), None);
    assert_eq!(seen(0, 10, 0), Some(true));
    assert_eq!(seen(0, 1, 0), Some(true));
    assert_eq!(seen(0, 9, 1), Some(false));
    assert_eq!(seen(9, 1, 0), Some(false));
    // A varnish, with what lies beneath.
    assert_eq!(seen(10, 10, 0), Some(false));
}

#[test]
fn a_camera_that_sees_nothing_to_connect_with_is_remarked_upon() {
    let seen = |rays, reached| {
        let view = CameraProbe {
            rays,
            reached,
            ..CameraProbe::default()
        };
        let incompatibilities = SceneCapabilities {
            view,
            ..capabilities(1, 0, 1, 1)
        }
        .incompatibilities(LightSearch::Either);
        incompatibilities
            .iter()
            .map(|o| o.fatal)
            .collect::<Vec<_>>()
    };
    assert_eq!(seen(10, 0), [false]);
    assert!(seen(10, 1).is_empty());
    // Nobody has looked.
    assert!(seen(0, 0).is_empty());
}

#[test]
fn light_behind_glass_is_missed_from_the_camera_alone() {
    let remarks = |veiled, finding| {
        let view = CameraProbe {
            rays: 10,
            reached: 10,
            veiled,
            ..CameraProbe::default()
        };
        let capabilities = SceneCapabilities {
            view,
            ..capabilities(1, 0, 1, 1)
        };
        let incompatibilities = capabilities.incompatibilities(finding);
        incompatibilities
            .iter()
            .map(|o| o.fatal)
            .collect::<Vec<_>>()
    };
    assert_eq!(remarks(1, LightSearch::FromCamera), [false]);
    assert!(remarks(0, LightSearch::FromCamera).is_empty());
    for finding in [LightSearch::Either, LightSearch::Choosing] {
        assert!(remarks(10, finding).is_empty());
    }
}

#[test]
fn darkness_is_remarked_upon() {
    for finding in [
        LightSearch::Hitting,
        LightSearch::Choosing,
        LightSearch::Either,
        LightSearch::FromCamera,
    ] {
        assert_eq!(fatal(SceneCapabilities::default(), finding), Some(false));
    }
}
